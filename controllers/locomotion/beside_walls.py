"""Feet keep on their body's side of what is too high to step on: where they come down, and on their way there."""

from __future__ import annotations

import math


from ..compiled import kernel
from ..navigation.passing import STEP

BESIDE = 0.05
"""A foot's centre line keeps so far from what stands beside it [m]: half a shoe's width."""
FAR = 1.2
"""What is farther from a body's middle than this [m] no foot gets to."""
PASSED = 0.5
"""What hangs so much higher than a foot stands is passed under by it [m]."""
EDGE = 0.04
"""Right before something is so far from it [m]."""


@kernel
def out_of_walls(m, tops, floor, foot, line, out):
    """Write into `out` (2,) how far x, z in the world [m] a foot with a centre line (3, 2) must go to be clear of all tops that are too high for a step, never
    through them to their far side; whether it must."""
    stands, found = max(m.base[1 - foot], m.left[foot]), False
    out[0] = out[1] = 0.0
    for k in range(tops.shape[0]):
        if tops[k, 7] != 0.0 or tops[k, 6] - floor <= stands + STEP or tops[k, 8] - floor > stands + PASSED:
            continue
        c, s = tops[k, 2], tops[k, 3]
        x, z = m.ground[0] - tops[k, 0], m.ground[1] - tops[k, 1]
        across, along = c * x - s * z, s * x + c * z
        beside, before = abs(across) - tops[k, 4], abs(along) - tops[k, 5]
        if max(beside, before) <= 0.0 or max(beside, before) > FAR:  # it is over it, or far away
            continue
        if _stepped_onto(tops, k, across, along, beside, before):
            continue
        least, way_across, way_along = math.inf, 0.0, 0.0
        for side in range(4):  # out to the left and right, and by both ends, but not beyond
            sign = 1.0 - 2.0 * (side % 2)
            if (beside > 0.0 and sign * across < 0.0) if side < 2 else (before > 0.0 and sign * along < 0.0):
                continue
            need = 0.0
            for i in range(3):
                x, z = line[i, 0] + out[0] - tops[k, 0], line[i, 1] + out[1] - tops[k, 1]
                u, w = c * x - s * z, s * x + c * z
                if abs(u) < tops[k, 4] + BESIDE and abs(w) < tops[k, 5] + BESIDE:
                    need = max(need, (tops[k, 4] - sign * u if side < 2 else tops[k, 5] - sign * w) + BESIDE)
            if need < least:
                least, way_across, way_along = need, (sign * need if side < 2 else 0.0), (0.0 if side < 2 else sign * need)
        if 0.0 < least < math.inf:
            out[0] += c * way_across + s * way_along
            out[1] += -s * way_across + c * way_along
            found = True
    return found


@kernel
def _stepped_onto(tops, k, across, along, beside, before):
    """Whether somebody whose middle is across and along in top k's frame [m], so far outside its sides and ends, has something right before it that is no more than
    a step lower, as on stairs."""
    u = math.copysign(min(abs(across), tops[k, 4]) + (EDGE if beside >= before else 0.0), across)
    w = math.copysign(min(abs(along), tops[k, 5]) + (EDGE if before > beside else 0.0), along)
    c, s = tops[k, 2], tops[k, 3]
    x, z = tops[k, 0] + c * u + s * w, tops[k, 1] - s * u + c * w
    for i in range(tops.shape[0]):
        dx, dz = x - tops[i, 0], z - tops[i, 1]
        c, s = tops[i, 2], tops[i, 3]
        u, w = c * dx - s * dz, s * dx + c * dz
        high = tops[i, 6] + tops[i, 7] * w
        if abs(u) <= tops[i, 4] and abs(w) <= tops[i, 5] and tops[k, 6] - STEP <= high < tops[k, 6]:
            return True
    return False
