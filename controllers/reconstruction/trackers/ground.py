"""Placed poses and turns, as seen from the ground below the trackers."""

from __future__ import annotations

import numpy as np

from ...body import Pose, wrap, yaw
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


def turned_on(turns: np.ndarray, ground: np.ndarray) -> np.ndarray:
    """Turns (n, 3, 3) as seen from ground (3,)."""
    return yaw(-ground[2]) @ turns
