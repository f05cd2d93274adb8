"""Ground on several levels: what is walked from one to the other, where it ends, and which leaps lead on."""

from .journeys import Crossing, Journey, journey, named
from .next_walk import RUN_UPS, Leg, next_leg
from .run_up import SHARE, SOON, TRIES, approach, onto, quickened, runs, start_of, take_offs
from .surfaces import Levels, levels_of

__all__ = [
    "RUN_UPS", "SHARE", "SOON", "TRIES", "Crossing", "Journey", "Leg", "Levels", "approach", "journey", "levels_of", "named", "next_leg", "onto", "quickened", "runs", "start_of", "take_offs",
]
