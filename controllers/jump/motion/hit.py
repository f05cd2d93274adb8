"""What a flying body runs into, and what velocity that leaves it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...body import Pose, Skeleton, end_positions, forward_kinematics
from ...navigation import gap

BOUNCE, FRICTION = 0.05, 0.4
"""How much of the velocity into it something gives back, and how much along it it takes, as a share of that."""
CLOSING = 0.4
"""Slower than this [m/s] a body does not strike what it touches."""


@dataclass(frozen=True, eq=False)
class Hit:
    """What a flying body struck: where (3,) [m], and the way (3,) out of it."""

    place: np.ndarray
    normal: np.ndarray

    @property
    def reason(self) -> str:
        """In words."""
        x, y, z = self.place
        return f"it struck something in the air at ({x:.1f}, {y:.1f}, {z:.1f}) m"

    def after(self, velocity: np.ndarray) -> np.ndarray:
        """The velocity (3,) [m/s] that is left: a little back, and less along it."""
        into = min(float(velocity @ self.normal), 0.0)
        along = velocity - into * self.normal
        pace = float(np.linalg.norm(along))
        return along * (1.0 - min(FRICTION * -into / max(pace, 1e-9), 1.0)) - BOUNCE * into * self.normal


def struck(skeleton: Skeleton, pose: Pose, centre: np.ndarray, velocity: np.ndarray, around: Sequence[Any]) -> Hit | None:
    """What a body runs into whose centre of mass (3,) flies with `velocity` (3,) [m/s]; its feet may touch
    what they please. It is sent back as if its middle were in the way, so that nobody hangs on an edge."""
    positions, turned = forward_kinematics(skeleton, pose.root, pose.rotations)
    feet = [skeleton.index(side + part) for side in ("Left", "Right") for part in ("Foot", "Toe")]
    ends = [skeleton.end_index[name] for name in ("Head", "LeftHand", "RightHand")]
    body = np.concatenate([np.delete(positions, feet, 0), end_positions(skeleton, positions, turned)[ends]])
    for thing in around:
        deep = gap(body, thing)
        place = body[int(deep.argmin())]
        if deep.min() < 0.0:
            normal = out_of(np.array([centre[0], place[1], centre[2]]), thing)
            if velocity @ normal < -CLOSING:
                return Hit(place, normal)
    return None


def out_of(place: np.ndarray, thing) -> np.ndarray:
    """The way (3,) out of a thing from a place (3,)."""
    step = 1e-4 * np.eye(3)
    slope = gap(place + step, thing) - gap(place - step, thing)
    return slope / max(float(np.linalg.norm(slope)), 1e-12)
