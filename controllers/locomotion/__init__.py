"""Truong 2010: gait cycles → Fourier library → control space → blending → footing → controller."""

from . import fourier, first_stride_build, step
from .arms_apart import between_bones
from .blend import Blender
from .control_space import SCALE, ControlSpace, thin
from .controller import DEFAULT_LIBRARY, Locomotion
from .coverage import picture, report
from .cycles import ACCELERATION_RATE, joint_acceleration
from .kernel import COLUMNS, LABELS_AT, SCRATCH
from .library import HIPS, LABELS, Idle, Library, LibraryError, Primitive, Start, channels, reference_rotations
from .library_build import build_library, collect, gather, read_recipe
from .memory import RUN, Settings, memory_dtype, walks
from .selection import neighbours, select

__all__ = [
    "ACCELERATION_RATE", "COLUMNS", "DEFAULT_LIBRARY", "HIPS", "LABELS", "LABELS_AT", "RUN", "SCALE", "SCRATCH", "Blender",
    "ControlSpace", "Idle", "Library", "LibraryError", "Locomotion", "Primitive", "Settings", "Start", "between_bones", "build_library", "channels",
    "collect", "fourier", "gather", "joint_acceleration", "memory_dtype", "neighbours", "picture", "read_recipe",
    "reference_rotations", "report", "select", "first_stride_build", "step", "thin", "walks",
]
