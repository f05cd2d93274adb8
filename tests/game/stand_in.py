"""A controller that needs no motion library: a T-pose that glides, with every part of the contract."""

from dataclasses import dataclass, field

import numpy as np

from gambol.controllers.body import Pose, Skeleton, human
from gambol.controllers.body.rotations import yaw
from gambol.controllers.contract import CharacterState, Controller, Intent, Status
from gambol.controllers.navigation import drift


@dataclass(frozen=True, eq=False)
class Glide(Controller):
    """Approaches the wished velocity with a half-life [s]; forward kinematics needs nothing else."""

    halflife: float = 0.1
    skeleton: Skeleton = field(default_factory=human)

    def start(self, ground=(0.0, 0.0, 0.0), floor=0.0) -> CharacterState:
        ground = np.array(ground, float)
        return CharacterState(ground, np.zeros(ground.shape), self._pose(ground), np.ones(ground.shape[:-1] + (4,), bool),
                              floor=floor)

    def precondition(self, state, intent) -> float:
        return 1.0

    def enter(self, state, intent) -> CharacterState:
        return state

    def status(self, state) -> Status:
        return Status()

    def step(self, state: CharacterState, intent: Intent, dt: float):
        left = 0.5 ** (dt / self.halflife)
        velocity = intent.velocity + left * (state.velocity - intent.velocity)
        ground = drift(state.ground, velocity, np.array([dt]))[..., 0, :]
        pose = self._pose(ground)
        return CharacterState(ground, velocity, pose, state.contacts), pose

    def _pose(self, ground) -> Pose:
        height = np.full(ground.shape[:-1], self.skeleton.offsets[0, 1])
        rotations = np.broadcast_to(np.eye(3), ground.shape[:-1] + (len(self.skeleton), 3, 3)).copy()
        rotations[..., 0, :, :] = yaw(ground[..., 2])
        return Pose(np.stack([ground[..., 0], height, ground[..., 1]], -1), rotations)


def same(one, other) -> bool:
    """Whether everybody is where he is in another world, to the bit."""
    return all(np.array_equal(x.state.ground, y.state.ground) and np.array_equal(x.state.pose.root, y.state.pose.root)
               and np.array_equal(x.state.pose.rotations, y.state.pose.rotations)
               for x, y in zip(one.characters, other.characters, strict=True))
