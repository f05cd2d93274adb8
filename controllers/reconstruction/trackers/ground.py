"""Placed poses, points and turns, as seen from the ground below the trackers."""

from __future__ import annotations

import numpy as np

from ...body import Pose
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
    off[YAW_RATE] = (off[YAW_RATE] + np.pi) % (2.0 * np.pi) - np.pi
    return off


def shown_as(pose: np.ndarray) -> Pose:
    """The pose of a placed one (D,) in the world."""
    return posed(pose, pose[GROUND])


def on(points: np.ndarray, ground: np.ndarray) -> np.ndarray:
    """Points (n, 3) [m] as seen from ground (3,)."""
    c, s = np.cos(ground[2]), np.sin(ground[2])
    x, z = points[:, 0] - ground[0], points[:, 2] - ground[1]
    return np.stack([c * x - s * z, points[:, 1], s * x + c * z], -1)


def turned_on(turns: np.ndarray, ground: np.ndarray) -> np.ndarray:
    """Turns (n, 3, 3) as seen from ground (3,)."""
    c, s = np.cos(ground[2]), np.sin(ground[2])
    return np.array([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]]) @ turns
