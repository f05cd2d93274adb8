"""One step of least squares by which a lying body is bent to uneven ground, over all its moments at once: Gauss and Newton, compiled.

Every place of the body pulls on the joints that move it; moments are joined by how evenly joints are to bend, so that the equations are a band.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ..body import exp, exp_kernel, forward_kinematics, log_kernel, product_kernel
from ..compiled import kernel
from ..jump.body import Physique
from ..jump.motion import FEET
from .flesh import flesh
from .stepwise_ground import rests_kernel

DAMPED, FARTHEST = 0.05, 0.12
"""Each step is damped by so much, and lets no place rise or sink by more than this [m]."""
HANGS = 0.25
"""What is farther over the ground than this [m], where something else lies on it, hangs."""
HARD, SINKS, LIGHT = 3.0, 0.15, 1e-4
"""What is below the ground weighs so many times as much as what is to rise, what is over it this; what weighs less than the last is left out."""
STIFF, UPRIGHT, PLACED, EVEN = 1e-2, 0.3, 3.0, 0.15
"""What it costs to bend a joint by 1 rad; to turn the pelvis of who does not lie, and to lead him aside by 1 m; and that either changes its rate by 1 rad between moments."""
LEAST, LOCKED = 0.03, 3.0
"""Knees and elbows are bent by no less [rad], and how firmly so."""
FIRM = 1e6
"""How firmly it begins as it was."""


class Bends(NamedTuple):
    """What bends: B joints or hinges. joints: (B,); axes: (B,) 0, 1, 2 in the parent's frame, or, of what turns about that alone, in its own; whole: (B,) whether its joint turns about all
    three, one after the other; hinges: (B,) 0 of none, else the sense in which it bends. parents: (B,) of the joints, −1 of the root. moves: (P, B) which places of the flesh it moves."""

    joints: np.ndarray
    axes: np.ndarray
    whole: np.ndarray
    hinges: np.ndarray
    parents: np.ndarray
    moves: np.ndarray


@lru_cache(maxsize=16)
def bends_of(physique: Physique) -> Bends:
    """What bends of a body: pelvis, spine, neck, hips, shoulders, knees, elbows and ankles."""
    skeleton = physique.skeleton
    rows = [(skeleton.index(name), axis, True, 0.0) for name in ("Hips", "Spine", "Neck", "LeftUpLeg", "RightUpLeg", "LeftArm", "RightArm") for axis in range(3)]
    for side, sense in (("Left", -1.0), ("Right", 1.0)):
        rows += [(skeleton.index(side + "Leg"), 0, False, 1.0), (skeleton.index(side + "ForeArm"), 1, False, sense), (skeleton.index(side + "Foot"), 0, False, 0.0)]
    joints, axes, whole, hinges = (np.array(column) for column in zip(*rows))
    # a place is moved by a joint if it moves as that joint turns
    still = np.tile(np.eye(3), (1, len(skeleton), 1, 1))
    base = flesh(physique, *forward_kinematics(skeleton, np.zeros((1, 3)), still))[0][0]
    moves = np.zeros((len(base), len(rows)), bool)
    for joint in set(joints.tolist()):
        moved = np.zeros(len(base), bool)
        for axis in np.eye(3):
            other = still.copy()
            other[0, joint] = exp(0.3 * axis)
            moved |= np.linalg.norm(flesh(physique, *forward_kinematics(skeleton, np.zeros((1, 3)), other))[0][0] - base, axis=1) > 1e-9
        moves[:, joints == joint] = moved[:, None]
    return Bends(joints, axes, whole, hinges, skeleton.parents[joints], moves)


def turned(bends: Bends, local: np.ndarray, by: np.ndarray) -> np.ndarray:
    """Rotations (N, J, 3, 3), bent by (N, B) [rad]."""
    out = np.array(local, float)
    turn_kernel(bends, by, out)
    return out


@kernel
def turn_kernel(bends, by, local):
    """Bend rotations (N, J, 3, 3) by (N, B) [rad], in place."""
    turn, was = np.empty((3, 3)), np.empty((3, 3))
    for n in range(len(local)):
        b = 0
        while b < len(bends.joints):
            joint = bends.joints[b]
            was[:] = local[n, joint]
            if bends.whole[b]:
                exp_kernel(by[n, b], by[n, b + 1], by[n, b + 2], turn)
                product_kernel(turn, was, local[n, joint])
                b += 3
            else:
                axis = bends.axes[b]
                exp_kernel(by[n, b] * (axis == 0), by[n, b] * (axis == 1), by[n, b] * (axis == 2), turn)
                product_kernel(was, turn, local[n, joint])
                b += 1


@kernel
def pull_kernel(bends, positions, turned, point, p, way, heavy, short, row, square, right):
    """Add to the equations (W, W), (W,) of a moment that the place p is to go `short` [m] along `way` (3,), with the weight `heavy`. row: (W,) room."""
    wide = len(row)
    row[:3] = way
    for b in range(wide - 3):
        row[3 + b] = 0.0
        if not bends.moves[p, b]:
            continue
        joint, axis, frame = bends.joints[b], bends.axes[b], bends.parents[b] if bends.whole[b] else bends.joints[b]
        x, y, z = 1.0 * (axis == 0), 1.0 * (axis == 1), 1.0 * (axis == 2)
        if frame >= 0:
            x, y, z = turned[frame, 0, axis], turned[frame, 1, axis], turned[frame, 2, axis]
        dx, dy, dz = point[0] - positions[joint, 0], point[1] - positions[joint, 1], point[2] - positions[joint, 2]
        row[3 + b] = way[0] * (y * dz - z * dy) + way[1] * (z * dx - x * dz) + way[2] * (x * dy - y * dx)
    for a in range(wide):
        if row[a] != 0.0:
            pulls = heavy * row[a]
            right[a] += pulls * short
            for b in range(a + 1):
                square[a, b] += pulls * row[b]


@kernel
def moment_kernel(bends, things, corner, caps, thick, aside, positions, turned, points, local, clear, near, lies, bent, square, right):
    """Write the equations (W, W), (W,) of one moment, without what joins it to others."""
    count, wide = len(thick), len(right)
    lacks, miss, weight, ways, row, way, vector = np.empty(count), np.empty(count), np.empty(count), np.empty((count, 2)), np.empty(wide), np.zeros(3), np.empty(3)
    square[:], right[:] = 0.0, 0.0
    for p in range(count):
        lacks[p] = rests_kernel(things, corner, caps, points[p], thick[p], aside, ways[p]) - points[p, 1]
        miss[p] = lacks[p] + clear[p]
    most = min(miss.max(), 0.0)
    for p in range(count):
        weight[p] = SINKS * near[p] * math.exp(-((min(miss[p] - most, 0.0) / HANGS) ** 2))
    for first in range(count - FEET, count, FEET // 2):  # a sole sinks as far as all of it can
        miss[first:first + FEET // 2] = miss[first:first + FEET // 2].max()
    for p in range(count):
        if miss[p] > 0.0:
            weight[p] = near[p]
        if lacks[p] > 0.0:
            weight[p], miss[p] = HARD, lacks[p] + min(clear[p], 0.0)
        if weight[p] > LIGHT:
            way[0], way[1], way[2] = 0.0, 1.0, 0.0
            pull_kernel(bends, positions, turned, points[p], p, way, weight[p], min(max(miss[p], -FARTHEST), FARTHEST), row, square, right)
        far = math.hypot(ways[p, 0], ways[p, 1])
        if far > 0.0:
            way[0], way[1], way[2] = ways[p, 0] / far, 0.0, ways[p, 1] / far
            pull_kernel(bends, positions, turned, points[p], p, way, HARD, min(far, FARTHEST), row, square, right)
    for a in range(wide):
        cost = STIFF
        if a < 3:
            cost = (STIFF + PLACED * (1.0 - lies)) * (a != 1)
        elif a < 6:
            cost = 0.1 * STIFF + UPRIGHT * (1.0 - lies)
        right[a] -= cost * bent[a]
        square[a, a] += cost + DAMPED
    for b in range(wide - 3):
        if bends.hinges[b] != 0.0:
            log_kernel(local[bends.joints[b]], vector)
            short = LEAST - vector[bends.axes[b]] * bends.hinges[b]
            if short > 0.0:
                right[3 + b] += LOCKED * short * bends.hinges[b]
                square[3 + b, 3 + b] += LOCKED


@kernel
def equations_kernel(bends, things, corner, caps, thick, aside, firm, positions, turned, points, local, clear, near, lies, bent, band, right):
    """Write the equations of one step over N moments: the lower band (N W, 2 W + 1), a row's diagonal last, and the right side (N W,). The first `firm` moments stay as they are."""
    count, wide = bent.shape
    square = np.empty((wide, wide))
    band[:] = 0.0
    for n in range(count):
        if n < firm:
            square[:] = 0.0
            for a in range(wide):
                square[a, a], right[n * wide + a] = FIRM, 0.0
        else:
            moment_kernel(bends, things, corner, caps, thick, aside, positions[n], turned[n], points[n], local[n], clear[n], near[n], lies[n], bent[n], square,
                          right[n * wide:(n + 1) * wide])
        for a in range(wide):
            for b in range(a + 1):
                band[n * wide + a, 2 * wide + b - a] = square[a, b]
    for n in range(1, count - 1):  # that each rate goes on evenly: (1, −2, 1)² of three moments
        for a in range(wide):
            changes = bent[n - 1, a] - 2.0 * bent[n, a] + bent[n + 1, a]
            for k in range(-1, 2):
                own = (n + k) * wide + a
                share = -2.0 if k == 0 else 1.0
                if n + k >= firm:
                    right[own] -= EVEN * share * changes
                for m in range(-1, k + 1):
                    band[own, 2 * wide + (m - k) * wide] += EVEN * share * (-2.0 if m == 0 else 1.0)


@kernel(fastmath=True)
def band_kernel(band, right):
    """Solve A x = right in place by Cholesky. band: (N, W + 1) rows of A's lower band, the diagonal last; it is overwritten."""
    count, wide = len(band), band.shape[1] - 1
    for i in range(count):
        for j in range(max(i - wide, 0), i + 1):
            first, total = max(i - wide, 0), band[i, wide + j - i]
            own, other = band[i, wide + first - i:wide + j - i], band[j, wide + first - j:wide]
            for k in range(j - first):
                total -= own[k] * other[k]
            band[i, wide + j - i] = math.sqrt(total) if i == j else total / band[j, wide]
        first = max(i - wide, 0)
        for k in range(first, i):
            right[i] -= band[i, wide + k - i] * right[k]
        right[i] /= band[i, wide]
    for i in range(count - 1, -1, -1):
        right[i] /= band[i, wide]
        for k in range(max(i - wide, 0), i):
            right[k] -= band[i, wide + k - i] * right[i]
