"""ORCA's half-planes and its linear programs, after van den Berg, Guy, Lin and Manocha 2011, *Reciprocal n-body collision avoidance*.

A half-plane is (4,): a place on its edge and its inward normal; velocities w with (w − place) · normal ≥ 0 are allowed. All
velocities lie within a disc about none, too.
"""

from __future__ import annotations

import math

import numpy as np

from ...compiled import kernel

PARALLEL = 1e-9
"""Edges whose directions' sine is less than this never cross."""
SLACK = 1e-9
"""Velocities that break a half-plane by less than this [m/s] keep it."""


@kernel
def half_plane(px, pz, vx, vz, apart, horizon, soon, share, right, plane):
    """The velocities that ORCA leaves to A beside B, relative to A's own; plane: (4,) for them.

    px, pz: from A to B [m]. vx, vz: A's velocity less B's [m/s]. apart: the sum of their radii [m]. horizon: for how long
    no collision may come [s]; soon: who overlap part within this [s]. share: how much of the change that it takes, or of the room
    that is left, is A's (the paper: half). right: how far beside head-on [sine] they still pass each other on the right.
    """
    square = px * px + pz * pz
    if square > apart * apart:
        wx, wz = vx - px / horizon, vz - pz / horizon  # from the middle of the cut-off circle
        along, length = wx * px + wz * pz, math.hypot(wx, wz)
        if along < 0.0 and along * along > apart * apart * length * length:
            nx, nz = wx / length, wz / length
            far = apart / horizon - length
        else:  # on a leg of the velocity obstacle: n is its outward normal
            leg = math.sqrt(square - apart * apart)
            if px * wz - pz * wx > right * math.sqrt(square) * length:
                dx, dz = (px * leg - pz * apart) / square, (px * apart + pz * leg) / square
            else:
                dx, dz = -(px * leg + pz * apart) / square, (px * apart - pz * leg) / square
            nx, nz = -dz, dx
            far = -(vx * nx + vz * nz)
    else:  # away from each other, never through
        length = math.sqrt(square)
        if length > PARALLEL:
            nx, nz = -px / length, -pz / length
        else:
            nx, nz = 1.0, 0.0
        far = (apart - length) / soon - (vx * nx + vz * nz)
    plane[0], plane[1], plane[2], plane[3] = share * far * nx, share * far * nz, nx, nz


@kernel
def nearest(planes, count, fastest, wx, wz, towards, out):
    """The velocity out: (2,) nearest to the wish (wx, wz) in the disc and the first `count` half-planes (N, 4): the incremental
    linear program. towards: the wish is a direction instead, and the velocity farthest along it is sought.

    The number of half-planes that are kept: `count`, or the index of the first that can't be, with `out` the best before it.
    """
    speed = math.hypot(wx, wz)
    scale = 1.0
    if towards or speed > fastest:
        scale = fastest / speed if speed > 0.0 else 0.0
    out[0], out[1] = scale * wx, scale * wz
    for i in range(count):
        px, pz, nx, nz = planes[i, 0], planes[i, 1], planes[i, 2], planes[i, 3]
        if (out[0] - px) * nx + (out[1] - pz) * nz >= -SLACK:
            continue
        dx, dz = nz, -nx  # the best now lies on this edge
        middle = px * dx + pz * dz
        inside = fastest * fastest - (px * px + pz * pz) + middle * middle
        if inside < 0.0:
            return i
        root = math.sqrt(inside)
        low, high = -middle - root, -middle + root
        for j in range(i):
            slope = dx * planes[j, 2] + dz * planes[j, 3]
            over = (px - planes[j, 0]) * planes[j, 2] + (pz - planes[j, 1]) * planes[j, 3]
            if abs(slope) <= PARALLEL:
                if over < -SLACK:
                    return i
            elif slope > 0.0:
                low = max(low, -over / slope)
            else:
                high = min(high, -over / slope)
        if low > high + SLACK:
            return i
        if towards:
            t = high if dx * wx + dz * wz > 0.0 else low
        else:
            t = min(max((wx - px) * dx + (wz - pz) * dz, low), high)
        out[0], out[1] = px + t * dx, pz + t * dz
    return count


@kernel
def nearest_to_all(planes, hard, count, first, fastest, other, out):
    """Where no velocity keeps all half-planes: the one that breaks those from `hard` on by the least at most.

    first: the one that `nearest` could not keep, out: (2,) its answer. other: (N, 4) to work in. The first `hard` are kept.
    """
    worst = 0.0
    best = np.empty(2)
    for i in range(max(first, hard), count):
        px, pz, nx, nz = planes[i, 0], planes[i, 1], planes[i, 2], planes[i, 3]
        if -((out[0] - px) * nx + (out[1] - pz) * nz) <= worst:
            continue
        for j in range(hard):
            other[j] = planes[j]
        number = hard
        for j in range(hard, i):  # where i is broken no less than j
            mx, mz = planes[j, 2] - nx, planes[j, 3] - nz
            length = math.hypot(mx, mz)
            if length <= PARALLEL:  # the same direction: one of the two says it all
                continue
            level = (planes[j, 0] * planes[j, 2] + planes[j, 1] * planes[j, 3] - px * nx - pz * nz) / length
            other[number, 0], other[number, 1] = level * mx / length, level * mz / length
            other[number, 2], other[number, 3] = mx / length, mz / length
            number += 1
        if nearest(other, number, fastest, nx, nz, True, best) == number:
            out[0], out[1] = best[0], best[1]
        worst = -((out[0] - px) * nx + (out[1] - pz) * nz)
