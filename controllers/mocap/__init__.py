"""Motion files and other people's skeletons: BVH and Acclaim in, BVH out, every clip in metres with Y up."""

from .bvh import read_bvh
from .text import MotionFileError

__all__ = ["MotionFileError", "read_bvh"]
