"""How people carry trunk, arms and legs in a jump: fitted to recorded jumps, conditioned on airtime, distance and pace."""

from .build import TAKES, fit, recorded_jumps, save
from .coefficients import BETWEEN, EACH, LEGS, ROWS, Prior
from .recorded import Recorded, carried, flights, jumps

__all__ = [
    "BETWEEN", "EACH", "LEGS", "ROWS", "TAKES", "Prior", "Recorded", "carried", "fit", "flights", "jumps", "recorded_jumps", "save",
]
