"""Poise: a body at rest over planted feet, wherever its pelvis is, and its balance.

The hip is moved, the legs follow by cyclic coordinate descent within their limits, the feet stay,
and a heel rises only past the ankle's limit (Ooi 2015, 3.1.2). Trunk and arms follow how deep the
pelvis is.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ...body import (HALF_SOLE, ccd_kernel, centroid_kernel, exp_kernel, foot_turn_kernel, hull_kernel, joint_limits,
                     margin_kernel)
from ...compiled import kernel
from . import carriage
from .dynamics import BodyTables, Physique, centre_kernel, place_kernel
from .planted_pose import ankle_kernel, bend_kernel, foot_kernel

FLEX = math.radians(40.0)
"""How far a loaded ankle bends before the heel rises [rad]; times flexibility. It reaches 35 … 40°."""
STAND_REACH = 0.98
"""How straight standing legs are, as a share of their length."""
DEEP = 0.39
"""How far down [m] the pelvis is, at standard height, when trunk and arms are as in `carriage.CROUCH`."""
SPLAY = 0.2
"""How far hips turn and spread in a crouch [rad]: knees that part further push across the jump."""
HALF_STANCE = 0.10
"""From the middle to a foot [m], at standard height."""


class Frame(NamedTuple):
    """What does not change while a body winds up. The rest is as in `BodyTables`.

    lower, upper: (2, 3, 3) [rad] limits of hip, knee and ankle of both legs; the knees are hinges.
    flex: of the ankles [rad]. deep: [m] see DEEP. joints: that `carriage.carry_kernel` turns.
    bones: (2, 3) thigh and shank.
    """

    body: BodyTables
    lower: np.ndarray
    upper: np.ndarray
    flex: float
    deep: float
    joints: np.ndarray
    bones: np.ndarray


@lru_cache(maxsize=64)
def frame(physique: Physique) -> Frame:
    """The frame of a body. Flexibility widens hips, knees (to 160° at most) and ankles."""
    body, skeleton = physique.tables, physique.skeleton
    limits = joint_limits(skeleton)
    numbers = body.hip[:, None] + np.arange(3)
    lower, upper = limits.lower[numbers] * physique.flexibility, limits.upper[numbers] * physique.flexibility
    lower[:, 0, 1:], upper[:, 0, 1:] = -SPLAY, SPLAY
    lower[:, 1], upper[:, 1] = 0.0, 0.0
    upper[:, 1, 0] = min(limits.upper[numbers[0, 1], 0] * physique.flexibility, math.radians(160.0))
    flex = FLEX * physique.flexibility
    lower[:, 2, 0] = -flex - 0.01  # a little play: the heel's rise is found to 1e-4
    return Frame(body, lower, upper, flex, DEEP * physique.size, carriage.joints_of(skeleton),
                 np.array([[0.0, -body.thigh, 0.0], [0.0, -body.shank, 0.0]]))


def flat_feet(physique: Physique) -> np.ndarray:
    """Two feet (2, 6) side by side around the origin, pointing along +Z, with heels free to rise."""
    body, size = physique.tables, physique.size
    middle = 0.5 * (body.heel[2] - body.toe[2] + body.tip[2])
    return np.array([[sign * HALF_STANCE * size, body.sole, -middle, 0.0, 0.0, 1.0] for sign in (1.0, -1.0)])


@kernel
def pose_kernel(fixed, pelvis, standing, feet, turns, local, positions, orientations):
    """Pose a body whose pelvis is at `pelvis` (3,) over planted feet (2, 6), their pitch written.

    standing: the pelvis' height [m] at rest; trunk and arms follow how far below it is. turns:
    (2, 3, 3) [rad] hips, knees and ankles, from the last pose. Returns how far the worst foot is
    from where it stands [m], a metre to the radian.
    """
    body = fixed.body
    share = min(max((standing - pelvis[1]) / fixed.deep, 0.0), 1.0)
    carriage.carry_kernel(carriage.STAND + share * (carriage.CROUCH - carriage.STAND), fixed.joints, local)
    lean = carriage.STAND[0] + share * (carriage.CROUCH[0] - carriage.STAND[0])
    heading = math.atan2(math.sin(feet[0, 3]) + math.sin(feet[1, 3]), math.cos(feet[0, 3]) + math.cos(feet[1, 3]))
    foot_kernel(heading, lean, local[0])
    place_kernel(body, pelvis, local, positions, orientations)
    chain, bones, goal, turned = np.empty((3, 3)), np.empty((2, 3, 3)), np.empty(3), np.empty((3, 3))
    worst = 0.0
    for side in range(2):
        hip, foot = body.hip[side], feet[side]
        foot[4] = 0.0
        gap = 0.0
        for _ in range(6):
            foot_kernel(foot[3], foot[4], turned)
            ankle_kernel(body, foot, turned, goal)
            gap = ccd_kernel(positions[hip], orientations[0], fixed.bones, fixed.lower[side, :2], fixed.upper[side, :2],
                             goal, 30, 1e-4, turns[side, :2], chain, bones)
            excess = -bend_kernel(bones[1], turned) - fixed.flex
            if foot[5] <= 0.0 or excess < 1e-4 or foot[4] >= 1.25:
                break
            foot[4] = min(foot[4] + 1.05 * excess, 1.25)
        held = foot_turn_kernel(bones[1], turned, fixed.lower[side, 2], fixed.upper[side, 2], turns[side, 2],
                                orientations[hip + 2])
        worst = max(worst, gap, held)
        for k in range(3):
            positions[hip, k], positions[hip + 1, k], positions[hip + 2, k] = chain[0, k], chain[1, k], chain[2, k]
            positions[hip + 3, k] = chain[2, k]
            for m in range(3):
                positions[hip + 3, k] += orientations[hip + 2, k, m] * body.toe[m]
        orientations[hip], orientations[hip + 1] = bones[0], bones[1]
        foot_kernel(foot[3], 0.0, orientations[hip + 3])  # toes stay level
        for k in range(3):
            exp_kernel(turns[side, k, 0], turns[side, k, 1], turns[side, k, 2], local[hip + k])
        local[hip + 3] = orientations[hip + 2].T @ orientations[hip + 3]
    return worst


@kernel
def support_kernel(body, feet, centre, middle):
    """Write the middle (2,) x, z of the support polygon of two feet (2, 6), risen heels left out.

    Returns the margin [m] of the centre of mass (3,) in it.
    """
    points, corners = np.empty((12, 2)), np.empty((13, 2))
    half = HALF_SOLE * body.size
    count = 0
    for side in range(2):
        foot = feet[side]
        s, c = math.sin(foot[3]), math.cos(foot[3])
        for k in range(3):
            if k == 0 and foot[4] > 0.02:
                continue
            along = (body.heel[2] - body.toe[2], 0.0, body.tip[2])[k]
            for aside in (half, -half):
                points[count, 0] = foot[0] + aside * c + along * s
                points[count, 1] = foot[2] - aside * s + along * c
                count += 1
    size = hull_kernel(points, count, corners)
    centroid_kernel(corners, size, middle)
    return margin_kernel(corners, size, centre[0], centre[2])


@kernel
def stand_pelvis_kernel(fixed, feet, pelvis, turns, local, positions, orientations):
    """Write the pelvis (3,) of a body that stands over its feet, balanced, and its pose.

    Returns the height of the centre of mass [m]; the pelvis' own is pelvis[1].
    """
    body = fixed.body
    centre, middle = np.empty(3), np.empty(2)
    length = STAND_REACH * (body.thigh + body.shank)
    for i in range(3):
        pelvis[i] = 0.5 * (feet[0, i] + feet[1, i])
    pelvis[1] += length - body.toe[1] - body.offsets[body.hip[0], 1]
    turns[:] = 0.0
    turns[:, 1, 0] = 0.2
    for _ in range(40):
        pose_kernel(fixed, pelvis, pelvis[1], feet, turns, local, positions, orientations)
        centre_kernel(body, positions, orientations, centre)
        support_kernel(body, feet, centre, middle)
        pelvis[0] += middle[0] - centre[0]
        pelvis[2] += middle[1] - centre[2]
        short = math.inf
        for side in range(2):
            hip = body.hip[side]
            ankle = positions[hip + 2]
            across = (positions[hip, 0] - ankle[0]) ** 2 + (positions[hip, 2] - ankle[2]) ** 2
            short = min(short, math.sqrt(max(length**2 - across, 0.0)) - positions[hip, 1] + ankle[1])
        pelvis[1] += short
        if abs(short) + abs(middle[0] - centre[0]) + abs(middle[1] - centre[2]) < 1e-5:
            break
    pose_kernel(fixed, pelvis, pelvis[1], feet, turns, local, positions, orientations)
    centre_kernel(body, positions, orientations, centre)
    return centre[1]
