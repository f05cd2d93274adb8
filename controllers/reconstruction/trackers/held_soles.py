"""Soles that stand: which heels and balls the network says do, where each came down, and how firmly it is held there."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..pose_vector import FORWARD, HEIGHT, JOINTS, LEFTWARD, SKELETON, WIDTH
from ..regression import in_world, on_ground

TAKES, LEAVES = 0.6, 0.4
"""A point takes hold where the network is surer than this that it stands, and lets go where it is less sure than that."""
EXACT = 0.01
"""How exactly a point stays where it stands [m], a standard deviation."""
FOLLOWS = 0.03
"""Which share of what is missing the place where it stands gives way by in a frame: a place that was told wrong is not kept for ever."""
SLIPPED = 0.06
"""A point that is pulled farther than this from where it stands [m] does not stand."""
EASE = 0.25
"""How much of the way to its full firmness a hold comes in a frame."""


def _legs_alone():
    """The precision (D, D) of a pose whose legs give way to soles that stand: by 10° a joint, while trunk and arms do by a third of a degree,
    and the hips by 3 mm."""
    deviation = np.full(WIDTH, np.radians(0.3))
    for name in ("UpLeg", "Leg", "Foot"):
        for side in ("Left", "Right"):
            column = 3 * int(np.flatnonzero(JOINTS == SKELETON.index(side + name))[0])
            deviation[column:column + 3] = np.radians(10.0)
    deviation[[HEIGHT, FORWARD, LEFTWARD]] = 0.003
    return np.diag(deviation ** -2.0)


LEGS_ALONE = _legs_alone()


@dataclass(frozen=True, eq=False)
class Soles:
    """places: (4, 3) [m] in the world where heels and balls came down, NaN in the air. firm: (4,) in 0 … 1, how firmly each is held."""

    places: np.ndarray
    firm: np.ndarray

    @staticmethod
    def none() -> Soles:
        """Both feet in the air."""
        return Soles(np.full((4, 3), np.nan), np.zeros(4))

    @property
    def held(self) -> np.ndarray:
        """Which are held (4,) bool."""
        return np.isfinite(self.places[:, 0])

    def told(self, standing: np.ndarray) -> Soles:
        """After what the network says of the coming frame, probabilities (4,)."""
        there = self.held
        stays = there & (standing > LEAVES)
        takes = ~there & (standing > TAKES)
        firm = np.where(stays, self.firm + EASE * (1.0 - self.firm), 0.0)
        return Soles(np.where(stays[:, None], self.places, np.nan), np.where(takes, -1.0, firm))  # below zero: comes down now

    def goals(self, ground: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Places (4, 3) [m] seen from ground (3,), and 1/σ² (4,) of each, 0 where it is not held."""
        return on_ground(self.places, ground), np.where(self.held, np.maximum(self.firm, 0.0), 0.0) / EXACT ** 2

    def found(self, points: np.ndarray, ground: np.ndarray, height: float) -> Soles:
        """After the frame was solved with them at points (4, 3), seen from ground. height: [m] at which they stand."""
        world = in_world(points, ground)
        takes = self.firm < 0.0
        places = self.places + FOLLOWS * (world - self.places)
        places[:, 1] += FOLLOWS * (height - places[:, 1])
        slipped = np.linalg.norm(world - self.places, axis=-1) > SLIPPED
        places = np.where(takes[:, None], world, np.where(slipped[:, None], np.nan, places))
        return replace(self, places=places, firm=np.where(slipped, 0.0, np.maximum(self.firm, 0.0)))
