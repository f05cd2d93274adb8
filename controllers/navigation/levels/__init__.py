"""Ground on several levels: what is walked from one to the other, where it ends, and which leaps lead on."""

from .journeys import Crossing, Journey, journey, named
from .next_walk import Leg, next_leg
from .run_up import SOON, onto, runs, take_off
from .surfaces import Levels, levels_of

__all__ = ["SOON", "Crossing", "Journey", "Leg", "Levels", "journey", "levels_of", "named", "next_leg", "onto", "runs", "take_off"]
