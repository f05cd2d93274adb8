"""Getting somewhere: from a wish in the world to an intent, along a path, past what stands about."""

from .goal import Following, arrived, wish
from .navigator import going
from .obstacles import DEPTH, STEP, changed, checked, floor_at, gap, is_box, is_pillar, matters, ramp, room, slide, slope, slope_at, span
from .path_following import Path, follow
from .steering import Reach, Steering, drift, in_frame, in_world, steer, turn_towards
from .thinking import SHARE, Going, shrunk, speeds

__all__ = [
    "DEPTH", "SHARE", "Following", "Going", "Path", "Reach", "STEP", "Steering", "arrived", "changed", "checked", "drift", "floor_at", "follow", "gap", "going", "in_frame", "in_world",
    "is_box", "is_pillar", "matters", "ramp", "room", "shrunk", "slide", "slope", "slope_at", "span", "speeds", "steer", "turn_towards", "wish",
]
