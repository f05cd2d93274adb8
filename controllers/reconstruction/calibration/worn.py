"""A calibration: how somebody wears trackers, what their bones are like, and how sure that is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...body import STATURE, Skeleton, exp
from ..pose_vector import SKELETON
from .calibration_network import CalibrationNetwork
from .simulated import heard_as, told
from .stood import WORN, Stood


@dataclass(frozen=True, eq=False)
class Calibration:
    """stood: how they stood, alone (1, …). bones: (J, 3) the body's offsets, lengths as of a standard body. offsets: (S, 3) where trackers are from
    their joints, in the joints' frames as standing told them; mounts: (S, 3, 3) how joints are turned in their trackers' frames.
    floor: how high the floor is in the room. unsure: of bones, offsets and floor, a standard deviation, lengths as of a standard body.
    heard: how many moments of moving there were.
    """

    stood: Stood
    bones: np.ndarray
    offsets: np.ndarray
    mounts: np.ndarray
    floor: float
    unsure: tuple[float, np.ndarray, float]
    heard: int = 0

    @property
    def height(self) -> float:
        """About how tall the performer is [m]: legs, trunk and head upon each other, beside the standard body's."""
        up = [SKELETON.index(name) for name in ("Spine", "Spine1", "Spine2", "Neck", "Head", "LeftLeg", "LeftFoot")]
        return STATURE * float(np.linalg.norm(self.bones[up], axis=-1).sum() / np.linalg.norm(SKELETON.offsets[up], axis=-1).sum() / self.stood.scale[0])

    @property
    def skeleton(self) -> Skeleton:
        """The performer's, lengths as of a standard body."""
        return Skeleton(SKELETON.names, SKELETON.parents, self.bones, SKELETON.end_parents, SKELETON.end_offsets)

    def joints(self, places: np.ndarray, turns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Joints (..., S, 3), lengths as of a standard body on a floor at 0, and their turns (..., S, 3, 3), below trackers at places (..., S, 3) [m] in the
        room with turns (..., S, 3, 3); NaN of a tracker whose turn is not known."""
        standing = turns @ self.stood.mounts[0]
        points = self.stood.scale[0] * places - np.einsum("...sij,...sj->...si", standing, self.offsets)
        return points - [0.0, self.floor, 0.0], turns @ self.mounts


def calibrated(network: CalibrationNetwork, stood: Stood, places: np.ndarray | None = None, turns: np.ndarray | None = None) -> Calibration:
    """What standing, and moments of moving in pairs of frames if there are any, tell of one person.

    places: (F, 2, S, 3) [m] above the room's floor, turns: (F, 2, S, 3, 3), `simulated.BEFORE` frames apart, newest first; those that are not known
    whole, but for trackers that are not worn, are left out; and all of them where they are like nothing that people do.
    """
    there = stood.there
    if places is None or turns is None:
        places, turns = np.zeros((1, 2, len(WORN), 3)), np.tile(np.eye(3), (1, 2, len(WORN), 1, 1))
        heard = np.zeros((1, 1), bool)
    else:
        known = np.asarray(np.isfinite(places).all(-1) & np.isfinite(turns).all((-1, -2)))
        heard = np.all(known | ~there[:, None], axis=(1, 2))[None]
        places, turns = np.where(known[..., None], places, 0.0), np.where(known[..., None, None], turns, np.eye(3))
    inputs = heard_as(stood, places[None], turns[None], heard)
    if heard.any() and network.strange(inputs)[0]:
        return calibrated(network, stood)
    found, deviations = network.predict(inputs)
    bones, away, turned, floor = told(found[0])
    unsure = told(deviations[0])
    worn = there[0]
    return Calibration(stood, SKELETON.offsets + bones, stood.offsets[0] + np.where(worn[:, None], away, 0.0),
                       stood.mounts[0] @ exp(np.where(worn[:, None], turned, 0.0)), float(floor),
                       (float(np.sqrt(np.mean(unsure[0][1:] ** 2))), np.linalg.norm(unsure[1], axis=-1), float(unsure[3])), int(heard.sum()))
