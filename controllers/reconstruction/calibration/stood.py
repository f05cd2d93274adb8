"""What a standing pose tells of trackers worn anyhow: heading, size, and how each one sits, if its wearer stands like the standard body.

Whoever stands is seen once, so all that a tracker is off by counts as its mount; what of it are arms held lower, or bones of other
lengths, is told by moving (`believed`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...body import carried, yaw
from ..live import stances
from ..pose_vector import SKELETON

WORN = ("Hips", "Head", "LeftHand", "RightHand", "LeftFoot", "RightFoot")
"""Where trackers that are calibrated are worn."""
JOINTS = np.array([SKELETON.index(name) for name in WORN])
"""Their numbers."""
STANCES = tuple(part[:, JOINTS] for part in stances())
"""Places (2, S, 3) [m] and turns (2, S, 3, 3) of these joints on the standard body: in T-pose, and with the arms down."""
INSIDE = 0.1
"""Mounts are told over this [m], and size over `_SIZE` as a share."""
_SIZE = 0.06
STANDING_INPUTS = 4 * len(WORN) + 2


@dataclass(frozen=True, eq=False)
class Stood:
    """How people stood (..., of any shape) with S trackers. heading: [rad] that carries the room's onto the standard body's, scale: the
    standard body's size over theirs, which: of `STANCES`. offsets: (..., S, 3) where trackers are from their joints, in the joints' frames, lengths
    as of a standard body. mounts: (..., S, 3, 3) how joints are turned in their trackers' frames. there: (..., S) bool, which are worn.
    """

    heading: np.ndarray
    scale: np.ndarray
    which: np.ndarray
    offsets: np.ndarray
    mounts: np.ndarray
    there: np.ndarray

    @staticmethod
    def of(places: np.ndarray, turns: np.ndarray, there: np.ndarray) -> Stood:
        """What trackers at places (..., S, 3) [m] above the room's floor with turns (..., S, 3, 3) say; what is not there is never read."""
        worn = there[..., None]
        places = np.where(worn, places, 0.0)
        weight = there / np.maximum(there.sum(-1, keepdims=True), 1)
        flat = np.array([1.0, 0.0, 1.0])
        middle = np.sum(weight[..., None] * places, -2) * flat
        a = np.where(worn, places - middle[..., None, :], 0.0)
        found = []
        for points, orientations in zip(*STANCES, strict=True):
            goal = np.sum(weight[..., None] * points, -2) * flat
            b = np.where(worn, points - goal[..., None, :], 0.0)
            along, across = carried(a, b)
            heading = np.arctan2(across, along)
            scale = (np.hypot(along, across) + np.sum(a[..., 1] * b[..., 1], -1)) / np.maximum(np.sum(a * a, (-2, -1)), 1e-12)
            turn = yaw(heading)
            away = scale[..., None, None] * a @ np.swapaxes(turn, -1, -2) - b
            back = np.swapaxes(orientations, -1, -2)
            offsets = np.where(worn, np.einsum("sij,...sj->...si", back, away), 0.0)
            mounts = np.swapaxes(turn[..., None, :, :] @ np.where(worn[..., None], turns, np.eye(3)), -1, -2) @ orientations
            found.append((np.sum(weight * np.linalg.norm(away, axis=-1), -1), heading, scale, offsets, mounts))
        which = (found[1][0] < found[0][0]).astype(int)
        heading, scale, offsets, mounts = (np.where(which.reshape(which.shape + (1,) * (one.ndim - which.ndim)), other, one)
                                           for one, other in zip(found[0][1:], found[1][1:], strict=True))
        return Stood(heading, scale, which, offsets, mounts, there)

    def corrected(self, places: np.ndarray, turns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Joints (..., F, S, 3), lengths as of a standard body, and their turns (..., F, S, 3, 3) below trackers in F frames, as they are
        worn for all that standing tells; the room's heading stays."""
        turned = turns @ self.mounts[..., None, :, :, :]
        return (self.scale[..., None, None, None] * places - np.einsum("...fsij,...sj->...fsi", turned, self.offsets)), turned

    @property
    def inputs(self) -> np.ndarray:
        """What is told of it (..., STANDING_INPUTS)."""
        shape = *self.there.shape[:-1], -1
        return np.concatenate([np.reshape(self.offsets / INSIDE, shape), self.there, self.which[..., None],
                               -np.log(self.scale)[..., None] / _SIZE], -1)
