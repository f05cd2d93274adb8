"""Ooi 2015: jumping to a target. Path estimate, spring muscles, wind-up, thrust, and beyond the thesis
flight, landing, and take-offs from a run. A jump is planned whole, then played; see `planner`.
"""

from .controller import Jump, Jumping
from .dynamics import GRAVITY, Physique
from .reach import Refused

__all__ = ["GRAVITY", "Jump", "Jumping", "Physique", "Refused"]
