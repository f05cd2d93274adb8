"""A wooden doll that walks, for trackers that nobody recorded; and the network that ships."""

from functools import lru_cache

import numpy as np

from gambol.controllers.body import contact_height, contact_points, exp, forward_kinematics
from gambol.controllers.reconstruction import SKELETON
from gambol.controllers.reconstruction.trackers import Network

DT = 1 / 60


@lru_cache
def shipped():
    return Network.load()


def strides(count=240, pace=1.1):
    """Root (T, 3) and rotations (T, J, 3, 3) of somebody who walks like a wooden doll: the lower foot is on the floor."""
    phase = 2.0 * np.pi * 0.95 * np.arange(count) * DT
    vectors = np.zeros((count, len(SKELETON), 3))
    for side, sign in (("Left", 1.0), ("Right", -1.0)):
        swing = sign * np.sin(phase)
        vectors[:, SKELETON.index(side + "UpLeg"), 0] = -0.1 - 0.35 * swing
        vectors[:, SKELETON.index(side + "Leg"), 0] = 0.15 + 0.5 * np.maximum(sign * np.cos(phase), 0.0) ** 2
        vectors[:, SKELETON.index(side + "Arm"), 2] = -sign * 1.3
        vectors[:, SKELETON.index(side + "ForeArm"), 1] = -sign * (0.3 + 0.15 * swing)
    rotations, root = exp(vectors), np.zeros((count, 3))
    root[:, 2] = pace * DT * np.arange(count)
    soles = contact_points(SKELETON, *forward_kinematics(SKELETON, root, rotations))[..., 1]
    root[:, 1] = contact_height(SKELETON) - soles.min(-1)
    return root, rotations
