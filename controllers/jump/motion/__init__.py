"""The motion of a jump: the estimated path of the centre of mass (Ooi 2015, 3.1.1), where and with which push it takes off,
the flight, the landing, and the fall of who is struck in the air; `plan` is what is played.
"""

from .airborne import HEEL, PLANT, SAME
from .as_shown import LASTS, Shown, as_shown
from .bound import Stands, changes, moments
from .capsules import capsule_places, deepest, deepest_kernel, near
from .clearing import depths, lifts, spread
from .edges import STANDS, hangs, over_nothing, steps_over
from .fall import fall
from .flying_legs import COLUMNS, flying_legs_kernel
from .footing import FADE, faded, heels_down, settling, swivels
from .flight import flight_kernel
from .ground_kernels import FREE, ground_kernel
from .going_slowly import LIKE, Carried, carried
from .grounded import grounded
from .hit import struck
from .ledge import over_ledge
from .lying import BONES, FEET, TOUCHES, grounded_poses, places, sole_places
from .path_estimate import SPINS, Course, Path, path
from .plan import Plan, between_kernel
from .pushing import Pushing
from .rolling import SPACED as ROLL_SPACED
from .rolling import rolled, rolls, room, tumbled
from .swinging import CLEARS, lifted, lowest
from .thrust import Push, push

__all__ = [
    "BONES", "CLEARS", "FADE", "Carried", "FEET", "FREE", "HEEL", "LASTS", "LIKE", "PLANT", "ROLL_SPACED", "SAME", "SPINS", "TOUCHES", "COLUMNS", "Course", "Path", "Plan", "Push", "Pushing", "STANDS", "Shown", "Stands", "as_shown",
    "between_kernel", "capsule_places", "carried", "changes", "deepest", "deepest_kernel", "depths", "faded", "fall", "flight_kernel", "flying_legs_kernel", "ground_kernel", "grounded", "grounded_poses", "hangs", "heels_down", "lifted", "lifts", "lowest", "moments", "near", "over_ledge", "over_nothing", "path", "places", "push", "rolled", "rolls", "room",
    "settling", "sole_places", "spread", "steps_over", "struck", "swivels", "tumbled",
]
