"""The jumper's body: its masses and limits, how it stands, crouches and balances, how it carries trunk and arms,
and where a jump starts. Nothing here plans a jump.
"""

from . import carriage
from .balance import DEEP, FLEX, flat_feet, frame, pose_kernel, stand_pelvis_kernel, support_kernel
from .ballistics import airtime_kernel, along, apex_airtime, least_effort, take_off_velocity
from .curves import hermite, hermite_kernel, monotone, monotone_kernel
from .dynamics import (GRAVITY, MASS, BodyTables, Physique, centre_kernel, mass_of, momentum_kernel, parts_kernel, place_kernel, turns,
                       vectors)
from .sloped_feet import LEVEL, landing_feet, raised, rise, soles, standing, striding_feet, uphill
from .planted_pose import bend_kernel, nearest_kernel, stand_kernel, swivelled_kernel
from .start import (FLAT, FOOT_FADE, HEEL_UP, TAKE_OFF_REACH, TOES_DOWN, TOUCH_REACH, TRAIL, TURNED, Ledge, Measures, Start, airtime_up, carried, carried_kernel,
                    measures, over, stretched_kernel)

__all__ = [
    "DEEP", "FLAT", "FLEX", "FOOT_FADE", "GRAVITY", "HEEL_UP", "LEVEL", "MASS", "Ledge", "TAKE_OFF_REACH", "TOES_DOWN", "TOUCH_REACH", "TRAIL", "TURNED", "BodyTables",
    "Measures", "Physique", "Start", "airtime_kernel", "airtime_up", "along", "apex_airtime", "bend_kernel", "carriage", "carried", "carried_kernel", "centre_kernel", "flat_feet",
    "frame", "hermite", "hermite_kernel", "landing_feet", "least_effort", "mass_of", "measures", "momentum_kernel", "monotone", "monotone_kernel", "nearest_kernel",
    "over", "parts_kernel", "place_kernel", "pose_kernel", "raised", "rise", "soles", "stand_kernel", "stand_pelvis_kernel", "standing", "stretched_kernel", "striding_feet",
    "support_kernel", "swivelled_kernel", "take_off_velocity", "turns", "uphill", "vectors",
]
