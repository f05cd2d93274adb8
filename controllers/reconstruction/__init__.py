"""Whole bodies from a few points: motion databases, local regression and the pose that explains the points best (Mousas 2014)."""

from .database import Database, DatabaseError
from .database_build import build
from .features import Weights
from .segments import Neighbourhood, Segments

__all__ = ["Database", "DatabaseError", "Neighbourhood", "Segments", "Weights", "build"]
