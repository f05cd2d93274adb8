"""Feet that a belief has put below the floor, brought up again: by the leg alone, and the softer the less they were."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from ...body import Pose, Skeleton, contact_height, heel_offset
from ...compiled import kernel
from ..footing import bend_kernel, legs_of

GIVE = 0.01
"""So deep [m] a foot may stay in the floor: the lift begins with no slope, so that nothing pops."""


@kernel
def lift_kernel(depth):
    """How far up [m] a foot goes that is `depth` [m] below the floor: depth² / 4 GIVE, and from 2 GIVE on depth − GIVE."""
    depth = max(depth, 0.0)
    return depth * depth / (4.0 * GIVE) if depth < 2.0 * GIVE else depth - GIVE


def above(skeleton: Skeleton, pose: Pose, positions: np.ndarray, orientations: np.ndarray, floor: float) -> Pose:
    """A pose whose feet are at most `GIVE` below the floor [m]; it may be the same one.

    positions (J, 3) [m] and orientations (J, 3, 3): the pose's joints. Feet keep their orientation in the world, hips
    their place; a leg that can't be bent so far stays deeper.
    """
    rotations = np.array(pose.rotations, float)
    lifted = above_kernel(positions, orientations, *_legs(skeleton), float(floor), rotations)
    return Pose(pose.root, rotations) if lifted else pose


@lru_cache
def _legs(skeleton):
    """Parents, the joints of both legs (2, 4), where the heel is in the foot (3,) and how high soles stand [m]."""
    return skeleton.parents, legs_of(skeleton), heel_offset(skeleton), contact_height(skeleton)


@kernel
def above_kernel(positions, orientations, parents, legs, heel, height, floor, rotations):
    """Rewrites the rotations (J, 3, 3) of legs whose feet are too deep, see `above`. Whether any is."""
    lifted, ankle = False, np.empty(3)
    for f in range(2):
        foot, toe = legs[f, 2], legs[f, 3]
        sole = positions[foot, 1] + orientations[foot, 1, 0] * heel[0] + orientations[foot, 1, 1] * heel[1] + orientations[foot, 1, 2] * heel[2]
        up = lift_kernel(floor + height - min(sole, positions[toe, 1]))
        if up > 0.0:
            ankle[:] = positions[foot]
            ankle[1] += up
            bend_kernel(positions, orientations, rotations, legs[f], parents, ankle, orientations[foot])
            lifted = True
    return lifted
