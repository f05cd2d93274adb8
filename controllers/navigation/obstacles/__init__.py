"""What stands about, how near it is, how high the ground lies under it, and how a walker slides along it."""

from .measured import clearance, floor_at, floors_at, gap, matters, nearest_kernel, slope_at
from .rays import free_way
from .sliding import ASKEW, CREVICE, DEPTH, HEAD, SHOULDER, room, rooms, slide
from .solids import of_the_same, solids_of
from .things import STEP, changed, checked, highest_step, is_box, is_pillar, ramp, slope, span, step_among

__all__ = ["ASKEW", "CREVICE", "DEPTH", "HEAD", "SHOULDER", "STEP", "changed", "checked", "clearance", "floor_at", "floors_at", "free_way", "gap", "highest_step", "is_box",
           "is_pillar", "matters", "nearest_kernel", "of_the_same", "ramp", "room", "rooms", "slide", "slope", "slope_at", "solids_of", "span", "step_among"]
