"""Motion files and other people's skeletons: BVH and Acclaim in, BVH out, every clip in metres with Y up."""

from .acclaim import AcclaimSkeleton, read_asf
from .acclaim_motion import read_amc
from .bvh import read_bvh, write_bvh
from .calibration import Calibration, calibrate, has_limbs, zero_positions
from .captured import Captured, captured
from .hinges import elbows, hinged
from .joint_names import NoHuman, Roles, plain, roles
from .parsing import MotionFileError
from .reading import JUDGED, Reading
from .retarget import retarget
from .rig import Moved, Rig
from .t_pose import complete, to_t_pose, upright
from .units_and_axes import Detected, detect, load, read, standardise

__all__ = [
    "JUDGED", "AcclaimSkeleton", "Calibration", "Captured", "Detected", "MotionFileError", "Moved", "NoHuman", "Reading", "Rig", "Roles", "calibrate", "captured", "complete", "detect", "elbows", "has_limbs", "hinged",
    "load", "plain", "read", "read_amc", "read_asf", "read_bvh", "retarget", "roles", "standardise", "to_t_pose", "upright", "write_bvh", "zero_positions",
]
