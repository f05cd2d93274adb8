"""What a body can reach with a jump: plans that touch nothing, why there is none, the nearest place to which there is one."""

from .arcs import How
from .feasibility import BESIDE, HARD, MOMENTARY, PACE, SETS_FEET, TOO_NEAR, Refused, meant, too_weak
from .reach import DEAR, MOST, Found, Reach, goes_on
from .seeking import SHARE, Onward, Pieces, Seeking, Spread, counted, priced, whole
from .sweep import Touch, touch

__all__ = [
    "BESIDE", "DEAR", "Found", "HARD", "How", "MOMENTARY", "MOST", "Onward", "PACE", "Pieces", "Reach", "Refused", "SETS_FEET", "SHARE", "Seeking", "Spread", "TOO_NEAR", "Touch", "counted", "goes_on", "meant", "priced", "too_weak", "touch", "whole",
]
