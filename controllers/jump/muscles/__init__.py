"""The thesis's wind-up and thrust (Ooi 2015, 3.1.2-3.1.4): spring muscles across hip, knee and ankle, how strong they are
at every depth, the crouch by PD control (`windup`) or by `sampling`, and the per-joint thrust (`extension`).
"""

from .extension import extend, shoot
from .sampling import sample
from .spring_muscles import POINTED, STIFFNESS, WIDTH, Muscle, muscle, spring_bend, spring_force
from .strength import between_kernel, crouch_depth, depth_kernel, strength, strongest
from .windup import GAINS, Crouch, crouch

__all__ = [
    "GAINS", "POINTED", "STIFFNESS", "WIDTH", "Crouch", "Muscle", "between_kernel", "crouch", "crouch_depth", "depth_kernel", "extend", "muscle", "sample",
    "shoot", "spring_bend", "spring_force", "strength", "strongest",
]
