"""Legs in the air: as recorded, out of the push and to how they touch down."""

from __future__ import annotations

import numpy as np

from ...body import log_kernel
from ...compiled import kernel
from ..body import hermite_kernel, monotone_kernel, stand_kernel
from ..prior import EACH

STRAIGHTEST = 0.06
"""Knees of legs that swing are bent by this at least [rad]."""
LEAVES = 1.0, 0.55, 0.2, 0.0, 0.0, 0.0
"""How much is left in the air, from row to row, of what legs differed by from recorded ones as they left; as they land, the other way round."""
SWINGS_ON = 0.15
"""So long at most [s] legs go on in the air as the push swung them, and begin to give before they touch down."""
MEET = 0.5, 14.0
"""How much of the speed that the ground bends them with legs have as they touch down, and at most [rad/s]."""
COLUMNS = 24
"""Both legs have eight joints, which turn about three axes."""


@kernel
def touching_kernel(body, flex, turn, land, falling, step, feet, posed, legs, end, bending):
    """Write how legs are turned (8, 3) [rad] as a body touches down, and how fast they bend then (8, 3) [rad/s]: they begin to give before the floor makes them.

    turn: (3, 3) how the body is turned. land, falling: (3,) where its mass centre is [m] and how it moves [m/s]. feet: (2, 2, 9) as it touches down and a `step` [s] later.
    posed: (2, J, 3, 3) its local rotations then, whose pelvis and legs that stand are written. legs: (8,) their joints.
    """
    count = posed.shape[1]
    positions, turned = np.empty((count, 3)), np.empty((count, 3, 3))
    centre, root, later = land.copy(), land.copy(), np.empty(3)
    root[1] -= 0.05
    for k in range(2):
        posed[k, 0] = turn
        stand_kernel(body, centre, feet[k], flex, root, posed[k], positions, turned)
        for i in range(3):
            centre[i] += step * falling[i]
    for n in range(len(legs)):
        log_kernel(posed[0, legs[n]], end[n])
        log_kernel(posed[1, legs[n]], later)
        for i in range(3):
            bending[n, i] = min(max(MEET[0] / step * (later[i] - end[n, i]), -MEET[1]), MEET[1])


@kernel
def flying_legs_kernel(times, airtime, keys, rows, before, last, step, end, bending, out):
    """Write how legs are turned (N, COLUMNS) [rad] at times (N,) [s] in the air.

    keys: (K,) [s] when rows (K, 2 EACH) [rad] of recorded hips, knees and ankles are due. before, last: (COLUMNS,) [rad] how they were turned a `step` [s] before they left,
    and as they did; end, bending: (COLUMNS,) how they touch down [rad] and bend then [rad/s].
    """
    final = len(keys) - 1
    values, slopes = np.empty((final + 1, COLUMNS)), np.empty((final + 1, COLUMNS))
    for k in range(final + 1):
        share = k / final
        for m in range(COLUMNS):  # what was not recorded goes straight
            values[k, m] = (1.0 - share) * last[m] + share * end[m]
        for column in range(2 * EACH):
            m = COLUMNS // 2 * (column // EACH) + 3 * (column % EACH)
            values[k, m] = rows[k, column] + LEAVES[k] * (last[m] - rows[0, column]) + LEAVES[final - k] * (end[m] - rows[final, column])
            if column % EACH == 1:
                values[k, m] = max(values[k, m], STRAIGHTEST)
    values[0], values[final] = last, end
    monotone_kernel(keys, values, slopes)
    hermite_kernel(keys, values, slopes, times, out)
    lasts = min(SWINGS_ON, keys[1])
    for m in range(COLUMNS):
        leaves, comes = (last[m] - before[m]) / step, bending[m]
        if m % (COLUMNS // 2) == 3:  # a knee, that does not bend back
            leaves, comes = max(leaves, -3.0 * (last[m] - 0.5 * STRAIGHTEST) / lasts), min(comes, 3.0 * (end[m] - 0.5 * STRAIGHTEST) / lasts)
        # what is faster than the way to the next row is spent soon, and gained late, however long a flight takes: a cubic without a value at either end
        leaves, comes = leaves - slopes[0, m], comes - slopes[final, m]
        for n in range(len(times)):
            gone, left = min(times[n] / lasts, 1.0), min((airtime - times[n]) / lasts, 1.0)
            out[n, m] += lasts * (leaves * gone * (1.0 - gone)**2 - comes * left * (1.0 - left)**2)
