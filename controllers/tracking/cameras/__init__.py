"""Calibrated cameras: where a point is seen, which ray a pixel looks along, and the files that say so, OpenCV's and Qualisys's."""

from .calibration_files import CalibrationError, read_cameras, write_opencv, write_qualisys
from .pinhole import Lens, direction_kernel, looking_at, project_kernel, ring

__all__ = ["CalibrationError", "Lens", "direction_kernel", "looking_at", "project_kernel", "read_cameras", "ring", "write_opencv", "write_qualisys"]
