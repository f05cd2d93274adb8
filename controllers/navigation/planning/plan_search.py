"""Many guesses at once, each brought to the nearest best way within its limits."""

from __future__ import annotations

import numpy as np

from ...compiled import kernel
from .limits import too_fast, too_near
from .newton import minimise
from .splines import at_place

SOFT = (10.0, 10000.0)
"""How stiff limits on velocities and distances are at first: the cost rises by half of it where one unit [m/s, m] is missing ..."""
TIGHT = 3e5
"""... where he has to turn aside to pass, the distance so stiff at once ..."""
SHY, WIDER = 4e3, 0.15
"""... but at first, where it is only so stiff, and he so much wider [m], lest he turns back: who stands straight in a gap no longer feels which way helps ..."""
SPARED = 1.2
"""... and there he is given up only where he costs so many times more than another ..."""
STIFFER = 8.0
"""... how much stiffer they become as long as they are broken ..."""
STIFFEST = 1e6
"""... and how stiff at most."""
ROUNDS = 9
"""So often multipliers are renewed."""


@kernel(nogil=True)
def search(guesses, seconds, starts, speeds, goals, leaves, aims, alpha, values, weights, planes, shapes, girth, allowed, most, tolerance,
           whose, spare, ceilings, rough, costs, faults, steps):
    """Every guess (S, M + 3, 3) with its time (S,) [s] becomes the least cost near it, in place.

    starts, speeds, goals, leaves: (S, 3), speeds, and those at the goals, as of (x, z, θ). aims: (S, Q, 2) what is faced, place by place. planes (H, 4), shapes (K, 6), girth (3,) [m]: the limits. allowed: (2,)
    how far velocities and distances may break them. whose: (S,) whose guess it is, in order: a guess is given up where it would cost more
    than another of the same one that keeps to its limits, or than his ceiling (S,). most: steps for a guess; spare: (S,) for all guesses of the same
    one together. rough: whether guesses are not ways yet, which are mended. costs: (S,). faults: (S, 2) the worst violations. steps: (S,) taken;
    negative where the search did not settle.
    """
    places = weights.shape[0]
    by_plane, by_shape = np.empty((places, planes.shape[0])), np.empty((places, shapes.shape[0]))
    best, tight, held, spent = np.inf, girth[1] < girth[0], girth.copy(), 0
    for s in range(guesses.shape[0]):
        if s and whose[s] != whose[s - 1]:
            best, spent = np.inf, 0
        by_plane[:], by_shape[:] = 0.0, 0.0
        stiff = np.array(SOFT)
        if tight:
            stiff[1] = TIGHT
        last = np.full(2, np.inf)
        total, settled, owed = 0, False, 0.0
        fast = near = costs[s] = faults[s, 0] = faults[s, 1] = np.inf
        left = min(most, spare[s] - spent)
        for lap in range(ROUNDS if left > 0 else 0):
            shy = lap == 0 and tight and rough
            held[0] = girth[0] + (WIDER if shy else 0.0)
            dearest = min(best, ceilings[s])
            seconds[s], costs[s], dual, fast, near, count, settled = minimise(
                guesses[s], seconds[s], starts[s], speeds[s], goals[s], leaves[s], aims[s], alpha, values, weights, planes, shapes, held,
                by_plane, by_shape, stiff[0], SHY if shy else stiff[1], left - total, tolerance if lap else 10.0 * tolerance,
                np.inf if shy else best + owed)
            total += count
            faults[s, 0], faults[s, 1] = fast, near
            if shy and costs[s] <= SPARED * dearest:
                continue
            if (fast <= allowed[0] and near <= allowed[1]) or total >= left or dual - owed > dearest:
                break
            renew(guesses[s], seconds[s], values, planes, shapes, girth, by_plane, by_shape, stiff)
            for i in range(2):
                if faults[s, i] > allowed[i] and faults[s, i] > 0.25 * last[i]:
                    stiff[i] = min(STIFFER * stiff[i], STIFFEST)
                last[i] = faults[s, i]
            owed = 0.0  # what the multipliers have the penalty begin with
            for place in range(places):
                owed += weights[place] * (0.5 * np.sum(by_plane[place] ** 2) / stiff[0] + 0.5 * np.sum(by_shape[place] ** 2) / stiff[1])
        if fast <= allowed[0] and near <= allowed[1]:
            best = min(best, costs[s])
        spent += total
        steps[s] = total if settled else -total


@kernel
def renew(coefficients, seconds, values, planes, shapes, girth, by_plane, by_shape, stiff):
    """The multipliers of all limits, after a minimum was found."""
    y = np.empty(9)
    for place in range(values.shape[0]):
        at_place(values[place], place * (coefficients.shape[0] - 3) // values.shape[0], coefficients, y)
        for h in range(planes.shape[0]):
            by_plane[place, h] = max(0.0, by_plane[place, h] + stiff[0] * too_fast(y, seconds, planes[h]))
        for k in range(shapes.shape[0]):
            by_shape[place, k] = max(0.0, by_shape[place, k] + stiff[1] * too_near(y[0], y[1], y[2], shapes[k], girth))
