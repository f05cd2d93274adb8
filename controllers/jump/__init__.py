"""Ooi 2015: jumping to a target. Path estimate, spring muscles, wind-up, thrust, and beyond the thesis
flight, landing, and take-offs from a run. A jump is planned whole, then played; see `planner`.
"""

from .body import GRAVITY, Physique, mass_of
from .controller import Jump
from .crouching import Crouching
from .motion import LIKE
from .reach import BESIDE, HARD, MOMENTARY, PACE, SETS_FEET, TOO_NEAR, Pieces, Refused, Spread, priced
from .starting import FRESH, RUNNING, SLOWLY, Jumping, goes, leaves_under, start_of, stands, stayed, walks_to
from .warm_up import rehearse

__all__ = [
    "BESIDE", "Crouching", "FRESH", "GRAVITY", "HARD", "LIKE", "MOMENTARY", "PACE", "RUNNING", "SETS_FEET", "SLOWLY", "TOO_NEAR", "Jump", "Jumping", "Physique", "Pieces", "Refused", "Spread", "goes", "leaves_under", "mass_of", "priced", "rehearse", "stands", "start_of",
    "stayed", "walks_to",
]
