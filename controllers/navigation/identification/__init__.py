"""Which weights people walk by: inverse optimal control on recorded walks (Mombaur 2010)."""

from .fit import FIRST, fit, left_out
from .human_paths import HumanPaths, PathsError, read_paths
from .likeness import Likeness, likeness, planned_like, straight
from .picture import picture

__all__ = ["FIRST", "HumanPaths", "Likeness", "PathsError", "fit", "left_out", "likeness", "picture", "planned_like", "read_paths", "straight"]
