"""How people carry trunk, arms and legs in a jump: fitted to recorded jumps, conditioned on airtime, distance and pace."""

from .build import STRIDES, TAKES, fit, recorded_jumps, save
from .coefficients import ARMS, BETWEEN, COLUMNS, EACH, FEATURES, LEGS, ROWS, Prior, features_kernel, mirrored, swings_kernel
from .recorded import Recorded, carried, flights, jumps

__all__ = [
    "ARMS", "BETWEEN", "COLUMNS", "EACH", "FEATURES", "LEGS", "ROWS", "STRIDES", "TAKES", "Prior", "Recorded", "carried", "features_kernel", "fit", "flights", "jumps", "mirrored", "recorded_jumps", "save", "swings_kernel",
]
