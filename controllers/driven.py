"""A body that is moved from outside, by points or by pictures: its ground frame, velocity and contacts are told from the body."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from .body import HEIGHT_GATE, RELEASE, WALK_SPEEDS, Pose, Skeleton, contact_height, contact_points, damp, forward_kinematics, heading_of, wrap
from .contract import CharacterState, but

SMOOTH = 0.1
"""Half-life of the ground frame's heading and of its velocity [s]."""


def driven(state: CharacterState, skeleton: Skeleton, pose: Pose, memory: Any, dt: float) -> CharacterState:
    """The state dt seconds later with another pose."""
    positions, orientations = forward_kinematics(skeleton, np.array([state.pose.root, pose.root], float), np.array([state.pose.rotations, pose.rotations], float))
    before, points = contact_points(skeleton, positions, orientations)
    middle = 0.5 * (positions[1, skeleton.index("LeftArm")] + positions[1, skeleton.index("RightArm")])
    heading = float(state.ground[2])
    heading += float(damp(0.0, wrap(heading_of(orientations[1, 0, :, 2]) - heading), SMOOTH, dt))
    c, s = math.cos(heading), math.sin(heading)
    x, _, z = ((pose.root - state.pose.root) / dt).tolist()
    now = np.array([s * x + c * z, (heading - float(state.ground[2])) / dt, c * x - s * z])
    slack = np.where(state.contacts, RELEASE, 1.0)
    stands = (points[:, 1] - state.floor - contact_height(skeleton) < HEIGHT_GATE * slack) & (
        np.linalg.norm(points - before, axis=-1) / dt < WALK_SPEEDS * slack)
    return but(state, ground=np.array([middle[0], middle[2], heading]), pose=pose, contacts=stands,
               velocity=damp(np.asarray(state.velocity, float), now, SMOOTH, dt), memory=memory)
