"""Placed poses and turns, as seen from the ground below the trackers."""

from __future__ import annotations

import math

import numpy as np

from ...body import Pose, wrap
from ...compiled import kernel
from ..pose_vector import FORWARD, LEFTWARD, YAW_RATE
from ..regression import SPAN, posed

GROUND = [LEFTWARD, FORWARD, YAW_RATE]
"""A placed pose's columns that are x, z [m] and heading [rad]."""


def nothing(slots: int) -> tuple[np.ndarray, np.ndarray]:
    """Places (SPAN, slots, 3) and turns (SPAN, slots, 3, 3) of a past that nothing is known of."""
    return np.full((SPAN, slots, 3), np.nan), np.full((SPAN, slots, 3, 3), np.nan)


def less(pose: np.ndarray, other: np.ndarray) -> np.ndarray:
    """A placed pose (D,) less another, the heading's difference the short way."""
    off = pose - other
    off[YAW_RATE] = wrap(off[YAW_RATE])
    return off


def shown_as(pose: np.ndarray) -> Pose:
    """The pose of a placed one (D,) in the world."""
    return posed(pose, pose[GROUND])


@kernel
def goals_kernel(points, turns, ground, firm, stiff, goals, spun, hold, keep):
    """Fills goals (n, 3) and spun (n, 3, 3): points and turns as seen from ground (3,); and hold, keep (n,): firm and stiff where they are known, else 0."""
    c, s = math.cos(ground[2]), math.sin(ground[2])
    for n in range(len(points)):
        x, z = points[n, 0] - ground[0], points[n, 2] - ground[1]
        goals[n, 0], goals[n, 1], goals[n, 2] = c * x - s * z, points[n, 1], c * z + s * x
        for k in range(3):
            spun[n, 0, k] = c * turns[n, 0, k] - s * turns[n, 2, k]
            spun[n, 1, k] = turns[n, 1, k]
            spun[n, 2, k] = s * turns[n, 0, k] + c * turns[n, 2, k]
        hold[n] = firm if np.isfinite(points[n]).all() else 0.0
        keep[n] = stiff if np.isfinite(turns[n]).all() else 0.0
