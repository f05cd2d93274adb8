"""Which soles stand, where they do, and the pose that has them there.

A method's feet are where it believes them, and that changes while they stand. What is shown differs from it by an offset and a turn of each
foot: all of what is needed while a foot stands, and what fades once it has left (inertialisation, Bollo 2016). A foot that is carried off
farther than a body would bear it takes a step: it is lifted, and comes down where the method has it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...body import Pose, Skeleton, contact_height, forward_kinematics, heel_offset
from .foot_kernel import plant_kernel


@dataclass(frozen=True, eq=False)
class Feet:
    """Left heel, left ball, right heel, right ball, in the world. points: (4, 3) [m] where they were shown last, moving at speeds (4, 3) [m/s];
    believed: (4, 3) where the method had them, NaN before the first frame. held: (4,) bool, which stand.

    offsets, turns: (2, 3) [m], [rad] how balls and feet as they are shown differ from the method's; rates, spins: their changes [1/s]. steps: (2,) bool,
    which feet take a step. away: (2,) [m] how long the offset was as a foot was let go.
    """

    points: np.ndarray
    speeds: np.ndarray
    believed: np.ndarray
    held: np.ndarray
    offsets: np.ndarray
    rates: np.ndarray
    turns: np.ndarray
    spins: np.ndarray
    steps: np.ndarray
    away: np.ndarray

    @staticmethod
    def none() -> Feet:
        """Before anything was shown."""
        four, two = np.zeros((4, 3)), np.zeros((2, 3))
        return Feet(four, four, np.full((4, 3), np.nan), np.zeros(4, bool), two, two, two, two, np.zeros(2, bool), np.zeros(2))


def legs_of(skeleton: Skeleton) -> np.ndarray:
    """The joints (2, 4) of both legs: hip, knee, foot and toe."""
    return np.array([[skeleton.index(side + name) for name in ("UpLeg", "Leg", "Foot", "Toe")] for side in ("Left", "Right")])


@dataclass(frozen=True, eq=False)
class Footing:
    """Plants the feet of bodies with a skeleton, on a floor at height 0."""

    skeleton: Skeleton

    def step(self, feet: Feet, pose: Pose, standing: np.ndarray, told: np.ndarray, dt: float) -> tuple[Feet, Pose]:
        """The pose with its feet where they stand, dt [s] after the last one. standing: (4,) how probable it is that each point stands. told: (2,) bool,
        which feet a tracker tells of: such a one is soon where it is told.

        Trunk and arms stay as they are, and so do hips: legs alone hold feet.
        """
        after = Feet(feet.points.copy(), feet.speeds.copy(), feet.believed.copy(), feet.held.copy(), feet.offsets.copy(), feet.rates.copy(),
                     feet.turns.copy(), feet.spins.copy(), feet.steps.copy(), feet.away.copy())
        rotations = np.array(pose.rotations, float)
        positions, orientations = forward_kinematics(self.skeleton, pose.root, rotations)
        legs, offsets, parents, heel, height = self._body
        plant_kernel(positions, orientations, rotations, np.asarray(standing, float), told, dt, legs, offsets, parents, heel, height, after.points,
                     after.speeds, after.believed, after.held, after.offsets, after.rates, after.turns, after.spins, after.steps, after.away)
        return after, Pose(pose.root, rotations)

    def told(self, joints: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Which feet (2,) bool trackers on joints (n,) tell of, that are at points (n, 3), NaN where not seen."""
        seen = set(joints[np.isfinite(points).all(-1)].tolist())
        return np.array([not seen.isdisjoint(leg) for leg in self._feet])

    @cached_property
    def _feet(self):
        """Foot and toe joint of both feet."""
        return self._body[0][:, 2:].tolist()

    @cached_property
    def _body(self):
        """Joints of both legs (2, 4), bones, parents, where the heel is in the foot, how high soles stand."""
        return (legs_of(self.skeleton), np.array(self.skeleton.offsets, float), np.array(self.skeleton.parents), np.array(heel_offset(self.skeleton), float),
                float(contact_height(self.skeleton)))
