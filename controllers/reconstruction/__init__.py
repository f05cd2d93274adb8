"""Whole bodies from a few points: motion databases, local regression and the pose that explains the points best (Mousas 2014)."""

from . import control_points
from .control_points import NAMES, SETS, ControlPoints, parse
from .controller import Following, Reconstruction
from .following import towards
from .database import Database, DatabaseError, build
from .neighbours import Neighbourhood, Segments, Weights
from .pose_vector import ANGLES, HEIGHT, JOINTS, SKELETON, WIDTH, decode, encode

__all__ = [
    "ANGLES", "HEIGHT", "JOINTS", "NAMES", "SETS", "SKELETON", "WIDTH", "ControlPoints", "Database", "DatabaseError", "Following",
    "Neighbourhood", "Reconstruction", "Segments", "Weights", "build", "control_points", "decode", "encode", "parse", "towards",
]
