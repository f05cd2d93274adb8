"""What a body can reach with a jump: plans that touch nothing, why there is none, the nearest place to which there is one."""

from .feasibility import Refused
from .reach import TRIES, Reach
from .sweep import Touch

__all__ = [
    "TRIES", "Reach", "Refused", "Touch",
]
