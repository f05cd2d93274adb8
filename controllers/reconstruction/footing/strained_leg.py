"""Legs that bend after their feet, and what a foot does whose leg is too short: its heel goes up about its ball."""

from __future__ import annotations

import math

import numpy as np

from ...body import exp_kernel, product_kernel, relative_kernel, two_bone_turns_kernel
from ...compiled import kernel

SOFT, REACH = 0.95, 0.985
"""A leg that is pulled straight slows down from the first share of its length on, and is never straighter than the second unless the method has it so."""
RAISED = 0.7
"""A heel goes up by no more than this [rad]."""
FORWARD = 100.0
"""How many times as far as its foot is moved a knee is taken to lie forward of where it is."""


@kernel
def long_kernel(v):
    """The length of a vector (3,)."""
    return math.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])


@kernel
def flat_kernel(a, b):
    """How far apart two places (3,) are along the floor."""
    return math.hypot(a[0] - b[0], a[2] - b[2])


@kernel
def carried_kernel(matrix, v, out):
    """Write a vector (3,) carried by a matrix (3, 3)."""
    for i in range(3):
        out[i] = matrix[i, 0] * v[0] + matrix[i, 1] * v[1] + matrix[i, 2] * v[2]


@kernel
def raise_heel_kernel(hip, ball, sole, arm, limit, turned, work):
    """Turn a foot's orientation (3, 3) about its ball until its ankle is within `limit` [m] of the hip, or its heel is up by `RAISED`.

    sole, arm: (3,) [m] from heel and ankle to the ball. work: (3, 3) scratch. |hip − ball − R(θ)(ankle − ball)| = limit about the foot's own
    axis to the left is A cos θ + B sin θ = C.
    """
    level = math.hypot(sole[0], sole[2])
    if level < 1e-6:
        return
    axis, leg = np.array([sole[2] / level, 0.0, -sole[0] / level]), hip - ball
    beside, aside = -(arm @ axis), leg @ axis
    flat = -arm - beside * axis
    along, across = leg @ flat, leg @ np.cross(axis, flat)
    size = math.hypot(along, across)
    if size < 1e-9:
        return
    wanted = (0.5 * (leg @ leg + arm @ arm - limit * limit) - aside * beside) / size
    middle, half = math.atan2(across, along), math.acos(min(max(wanted, -1.0), 1.0))
    angle = middle - half if abs(middle - half) < abs(middle + half) else middle + half
    angle, before = min(max(angle, 0.0), RAISED), turned.copy()
    exp_kernel(angle * axis[0], 0.0, angle * axis[2], work)
    product_kernel(work, before, turned)


@kernel
def bend_kernel(positions, orientations, local, leg, parents, ankle, turned):
    """Rewrite the local rotations (J, 3, 3) of a leg, joints (4,), so that its ankle is at (3,) and its foot's orientation is `turned` (3, 3)."""
    hip, knee, foot = leg[0], leg[1], leg[2]
    line, moved = positions[foot] - positions[hip], long_kernel(ankle - positions[foot])
    # where the knee is now, so that nothing turns at the least move; then forward, for a leg that is straight
    # has its knee by chance a hair before or behind the line, and behind it would bend backwards
    pole = positions[knee] - positions[hip] - line * ((positions[knee] - positions[hip]) @ line / max(line @ line, 1e-12))
    for i in range(3):
        pole[i] += FORWARD * moved * orientations[knee, i, 2]
    upper, lower = np.empty((1, 3, 3)), np.empty((1, 3, 3))
    two_bone_turns_kernel(positions[hip:hip + 1], positions[knee:knee + 1], positions[foot:foot + 1], ankle.reshape(1, 3), pole.reshape(1, 3), 0.0,
                          upper, lower)
    thigh, shank = np.empty((3, 3)), np.empty((3, 3))
    product_kernel(upper[0], orientations[hip], thigh)
    product_kernel(lower[0], orientations[knee], shank)
    relative_kernel(orientations[parents[hip]], thigh, local[hip])
    relative_kernel(thigh, shank, local[knee])
    relative_kernel(shank, turned, local[foot])
