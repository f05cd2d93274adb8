"""Motion files and other people's skeletons: BVH and Acclaim in, BVH out, every clip in metres with Y up."""

from .acclaim import AcclaimSkeleton, read_asf
from .acclaim_motion import read_amc
from .bvh import read_bvh, write_bvh
from .detect import Detected, detect, load, read, standardise
from .text import MotionFileError

__all__ = ["AcclaimSkeleton", "Detected", "MotionFileError", "detect", "load", "read", "read_amc",
           "read_asf", "read_bvh", "standardise", "write_bvh"]
