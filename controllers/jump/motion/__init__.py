"""The motion of a jump: the estimated path of the centre of mass (Ooi 2015, 3.1.1), where and with which push it takes off,
the flight, the landing, and the fall of who is struck in the air; `plan` is what is played.
"""

from .airborne import GROUND_RATE, HEEL, PLANT, SAME, Airborne
from .clearing import ROWS as LIFT_ROWS
from .clearing import depths, lifts, spread
from .descent import sinking
from .edges import over_nothing, steps_over
from .fall import fall, struck
from .footing import FADE, MOMENT, RUNNERS_HEEL, faded, heels_rise, heels_up, settling, swivels
from .flight import flight_kernel
from .ground_kernels import FREE, ground_kernel
from .grounded import grounded
from .lying import BONES, FEET, TOUCHES, grounded_poses, places, sole_places
from .path_estimate import SPINS, Course, Path, path
from .plan import Plan, between_kernel
from .rolling import SPACED as ROLL_SPACED
from .rolling import rolled, rolls, room, tumbled
from .swinging import CLEARS, lifted, lowest
from .thrust import Push, push

__all__ = [
    "BONES", "CLEARS", "FADE", "FEET", "FREE", "GROUND_RATE", "HEEL", "LIFT_ROWS", "MOMENT", "PLANT", "ROLL_SPACED", "RUNNERS_HEEL", "SAME", "SPINS", "TOUCHES", "Airborne", "Course", "Path", "Plan", "Push",
    "between_kernel", "depths", "faded", "fall", "flight_kernel", "ground_kernel", "grounded", "grounded_poses", "heels_rise", "heels_up", "lifted", "lifts", "lowest", "over_nothing", "path", "places", "push", "rolled", "rolls", "room",
    "settling", "sinking", "sole_places", "spread", "steps_over", "struck", "swivels", "tumbled",
]
