"""Our own method: small networks that see the points' last half second, joined with the local regression; what lost points
very likely are, and filters for noise; trackers that tell how they are turned as three points each.
"""

from .combined import cells, ours
from .filters import Motion, noise
from .networks import ANGLE, DISTANCE, cross_kernel, handed_on_kernel, learn, placed, seen_from
from .virtual_points import Turning, turning, virtual

__all__ = [
    "ANGLE", "DISTANCE", "Motion", "Turning", "cells", "cross_kernel", "handed_on_kernel", "learn", "noise", "ours", "placed", "seen_from", "turning", "virtual",
]
