"""Getting somewhere: from a wish in the world to an intent, along a path, past what stands about."""

from .goal import Following, arrived, wish
from .navigator import going
from .obstacles import DEPTH, STEP, changed, checked, clearance, floor_at, floors_at, free_way, gap, is_box, is_pillar, matters, nearest_kernel, of_the_same, ramp, room, rooms, slide, slope, slope_at, solids_of, span
from .path_following import Path, follow
from .steering import Reach, Steering, drift, in_frame, in_world, steer, turn_towards
from .thinking import SHARE, Going, shrunk, speeds

__all__ = [
    "DEPTH", "SHARE", "Following", "Going", "Path", "Reach", "STEP", "Steering", "arrived", "changed", "checked", "clearance", "drift", "floor_at", "floors_at", "follow", "free_way", "gap", "going", "in_frame", "in_world",
    "is_box", "is_pillar", "matters", "nearest_kernel", "of_the_same", "ramp", "room", "rooms", "shrunk", "slide", "slope", "slope_at", "solids_of", "span", "speeds", "steer", "turn_towards", "wish",
]
