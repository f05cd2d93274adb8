"""The motion of a jump: the estimated path of the centre of mass (Ooi 2015, 3.1.1), where and with which push it takes off,
the flight, the landing, and the fall of who is struck in the air; `plan` is what is played.
"""

from .airborne import FADE, FREE, GROUND_RATE, HEEL, PLANT, SAME, Airborne, faded, ground_kernel
from .descent import descent
from .fall import fall, over_nothing, struck
from .flight import flight_kernel
from .path_estimate import SPINS, Path, path
from .plan import Plan
from .thrust import Push, push

__all__ = [
    "FADE", "FREE", "GROUND_RATE", "HEEL", "PLANT", "SAME", "SPINS", "Airborne", "Path", "Plan", "Push", "descent", "faded", "fall",
    "flight_kernel", "ground_kernel", "over_nothing", "path", "push", "struck",
]
