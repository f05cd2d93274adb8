"""What a body can reach with a jump: plans that touch nothing, why there is none, the nearest place to which there is one."""

from .feasibility import BESIDE, Refused, meant, too_weak
from .reach import Found, Reach
from .seeking import SHARE, Onward, Pieces, Seeking, whole
from .sweep import Touch

__all__ = [
    "BESIDE", "Found", "Onward", "Pieces", "Reach", "Refused", "SHARE", "Seeking", "Touch", "meant", "too_weak", "whole",
]
