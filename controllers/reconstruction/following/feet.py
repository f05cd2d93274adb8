"""Feet that a belief has put below the floor, brought up again: by the leg alone, and the softer the less they were."""

from __future__ import annotations

import numpy as np

from ...body import Pose, Skeleton, contact_height, contact_points, pole_of, two_bone_turns

GIVE = 0.01
"""So deep [m] a foot may stay in the floor: the lift begins with no slope, so that nothing pops."""
FORWARD = 100.0
"""How many times as far as the foot goes up its knee is taken to lie forward of where it is."""


def lift(depth: np.ndarray) -> np.ndarray:
    """How far up [m] a foot goes that is `depth` [m] below the floor: depth² / 4 GIVE, and from 2 GIVE on depth − GIVE."""
    depth = np.maximum(depth, 0.0)
    return np.where(depth < 2.0 * GIVE, depth * depth / (4.0 * GIVE), depth - GIVE)


def above(skeleton: Skeleton, pose: Pose, positions: np.ndarray, orientations: np.ndarray, floor: float) -> Pose:
    """A pose whose feet are at most `GIVE` below the floor [m]; it may be the same one.

    positions (J, 3) [m] and orientations (J, 3, 3): the pose's joints. Feet keep their orientation in the world, hips
    their place; a leg that can't be bent so far stays deeper.
    """
    depth = floor + contact_height(skeleton) - contact_points(skeleton, positions, orientations)[:, 1]
    up = lift(depth.reshape(2, 2).max(-1))
    if not up.any():
        return pose
    rotations = np.array(pose.rotations, float)
    for side, by in zip(("Left", "Right"), up, strict=True):
        if by > 0.0:
            hip, knee, ankle = (skeleton.index(side + name) for name in ("UpLeg", "Leg", "Foot"))
            leg = positions[hip], positions[knee], positions[ankle]
            # where the knee is now, so that nothing turns at the least lift; then forward, for a leg that is straight
            # has its knee by chance a hair before or behind the line, and behind it would bend backwards
            pole = pole_of(*leg) + FORWARD * by * orientations[knee][:, 2]
            upper, lower = two_bone_turns(*leg, positions[ankle] + [0.0, by, 0.0], pole)
            thigh, shank = upper @ orientations[hip], lower @ orientations[knee]
            rotations[hip] = orientations[skeleton.parents[hip]].T @ thigh
            rotations[knee] = thigh.T @ shank
            rotations[ankle] = shank.T @ orientations[ankle]
    return Pose(pose.root, rotations)
