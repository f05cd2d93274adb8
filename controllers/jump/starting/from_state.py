"""What a jump needs to know of a state: mass centre, feet and joints, and how fast they move."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from ...body import Pose, Skeleton, centre_of_mass, forward_kinematics, wrap
from ...contract import CharacterState
from ...navigation import in_world
from ..body import Physique, Start, vectors

RUNNING = 0.95
"""Faster than this [m/s] one foot pushes and the jump waits for it to strike."""


def start_of(physique: Physique, state: CharacterState, crouched: bool = False) -> Start:
    """What a jump of a body needs to know of a state. crouched: whether it crouches already. Found once for a state: whether a leap can start is asked of it several times in a step."""
    return _start_of(physique, state, crouched)  # however it is called


@lru_cache(maxsize=8)
def _start_of(physique: Physique, state: CharacterState, crouched: bool) -> Start:
    skeleton, masses = physique.skeleton, physique.anatomy
    pose = Pose(np.asarray(state.pose.root, float), np.asarray(state.pose.rotations, float))
    positions, turned = forward_kinematics(skeleton, pose.root, pose.rotations)
    centre = centre_of_mass(masses, positions, turned)
    velocity, rates, feet_rates = np.zeros(3), np.zeros((len(skeleton), 3)), np.zeros((2, 5))
    feet = _feet(skeleton, positions, turned)
    if state.previous is not None and state.elapsed > 0.0:
        before = forward_kinematics(skeleton, np.asarray(state.previous.root, float), np.asarray(state.previous.rotations, float))
        velocity = (centre - centre_of_mass(masses, *before)) / state.elapsed
        moved = feet - _feet(skeleton, *before)
        moved[:, 3:] = wrap(moved[:, 3:])
        heels, balls = np.asarray(state.contacts).reshape(2, 2).T
        feet_rates = np.where((heels | balls)[:, None], 0.0, moved / state.elapsed)
        rolls = heels & ~balls  # a foot comes down on over its heel
        feet_rates[rolls, 1], feet_rates[rolls, 4] = np.minimum(moved[rolls, 1], 0.0) / state.elapsed, np.maximum(moved[rolls, 4], 0.0) / state.elapsed
        rates = vectors(pose.rotations @ np.swapaxes(np.asarray(state.previous.rotations, float), -1, -2)) / state.elapsed
    return Start(pose.root, pose.rotations, rates, centre, velocity, feet, float(state.ground[2]), feet_rates, _single(state), crouched)


def goes(state: CharacterState) -> np.ndarray:
    """How fast (3,) [m/s] somebody goes in the world."""
    x, z = in_world(state.ground, state.velocity)
    return np.array([x, 0.0, z])


def _feet(skeleton: Skeleton, positions: np.ndarray, turned: np.ndarray) -> np.ndarray:
    """The feet (2, 5) of a placed body: balls, yaw, pitch. Yaw is where a foot points that is turned level about its own x axis: a runner's heel comes up until toes point down
    and back, and where those point turns round then."""
    feet = np.zeros((2, 5))
    for side, name in enumerate(("Left", "Right")):
        foot = turned[skeleton.index(name + "Foot")]
        feet[side, :3] = positions[skeleton.index(name + "Toe")]
        pitch = np.arctan2(-foot[1, 2], foot[1, 1])
        ahead = foot[:, 2] * np.cos(pitch) + foot[:, 1] * np.sin(pitch)
        feet[side, 3:] = np.arctan2(ahead[0], ahead[2]), pitch
    return feet


def _single(state: CharacterState) -> int | None:
    """The foot that pushes a runner off: the one that stands, if the other is in the air."""
    if np.hypot(state.velocity[0], state.velocity[2]) < RUNNING:
        return None
    standing = np.asarray(state.contacts).reshape(2, 2).any(1)
    return int(np.argmax(standing)) if standing.sum() == 1 else None
