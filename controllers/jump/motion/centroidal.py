"""Where the ground pushes so that a body gets where it wants to: centroidal trajectory optimisation along the floor.

For a given way up and down of the centre of mass its way along the floor is linear in the centre of pressure p: ẍ = r (x − p) with
r = (ÿ + g) / y, the upward force over mass and height. The p(t) which leads from the start to an arc that ends over the target, which
stays within the soles that stand at each moment, and is as calm and as near to a first guess as can be, is a convex quadratic
programme. The alternating direction method of multipliers solves it (Boyd et al. 2011, 5.2): each round is one
tridiagonal solve, under the two ends, and one projection onto each moment's soles.
"""

from __future__ import annotations

import math

import numpy as np

from ...compiled import kernel

CALM, PENALTY, OVER = 1.0, 0.3, 1.7
"""How much counts that pressure moves from knot to knot; the method's penalty on what is outside the soles, and its over-relaxation."""
LOOSE = 0.3
"""How little it minds to leave elsewhere than was guessed; 0 would hold it there."""
ROUNDS, EXACT = 120, 5e-4
"""At most so many rounds, until the pressure is within the soles to this [m], and what is nearest in them moves no more."""


@kernel
def course_kernel(step, rates, start, flight, land, leave, guess, near, hulls, counts, place, velocity, pressed):
    """Write the way along the floor, `place`, `velocity`, and the centre of pressure `pressed` (N, 2) x, z at N knots.

    step: [s] between knots. rates: (2 N − 1,) [1/s²], r at the knots and half-way. start: (2, 2) place and velocity at first. flight: [s] of
    the arc that follows, land: (2,) where it ends. leave: (2,), guess: (N, 2) near which it leaves and presses; near: (N,) how much that counts.
    hulls: (N, H, 2) the soles' corners, counter-clockwise, of which counts (N,) are used. Returns how far [m] outside them it presses at most:
    the ends are kept, whatever the soles allow.
    """
    count = len(guess)
    moves, speeds = np.empty(count + 2), np.empty(count + 2)
    _ends(step, rates, moves, speeds)
    rows, away = np.empty((2, count)), np.empty((2, count))
    for n in range(count):
        rows[0, n], rows[1, n] = moves[n] + flight * speeds[n], moves[n]
    factor, given, right = np.empty(count), np.empty(count), np.empty(count)
    for n in range(count):
        diagonal = near[n] + PENALTY + CALM * (1.0 if n == 0 or n == count - 1 else 2.0)
        factor[n] = 1.0 / (diagonal - (CALM * CALM * factor[n - 1] if n > 0 else 0.0))
    for k in range(2):
        _solve(factor, rows[k], away[k])
    a, b, c = rows[0] @ away[0], rows[0] @ away[1], rows[1] @ away[1] + LOOSE
    whole = a * c - b * b
    held, owed, at, before, lacks = guess.copy(), np.zeros((count, 2)), np.empty(2), np.empty(2), np.empty((2, 2))
    for i in range(2):
        gone = moves[count] * start[0, i] + moves[count + 1] * start[1, i]
        fast = speeds[count] * start[0, i] + speeds[count + 1] * start[1, i]
        lacks[0, i], lacks[1, i] = land[i] - gone - flight * fast, leave[i] - gone
    for n in range(count):
        _project(guess[n], hulls[n], counts[n], held[n])
    outside = 0.0
    for _ in range(ROUNDS):
        for i in range(2):
            for n in range(count):
                right[n] = near[n] * guess[n, i] + PENALTY * (held[n, i] - owed[n, i])
            _solve(factor, right, given)
            e, f = lacks[0, i] - rows[0] @ given, lacks[1, i] - rows[1] @ given
            first, second = (c * e - b * f) / whole, (a * f - b * e) / whole
            for n in range(count):
                pressed[n, i] = given[n] + first * away[0, n] + second * away[1, n]
        outside, moved = 0.0, 0.0
        for n in range(count):
            for i in range(2):
                before[i] = held[n, i]
                at[i] = OVER * pressed[n, i] + (1.0 - OVER) * before[i] + owed[n, i]
            _project(at, hulls[n], counts[n], held[n])
            for i in range(2):
                owed[n, i] = at[i] - held[n, i]
            outside = max(outside, math.hypot(pressed[n, 0] - held[n, 0], pressed[n, 1] - held[n, 1]))
            moved = max(moved, math.hypot(held[n, 0] - before[0], held[n, 1] - before[1]))
        if max(outside, moved) < EXACT:
            break
    for i in range(2):
        place[0, i], velocity[0, i] = start[0, i], start[1, i]
        for n in range(count - 1):
            place[n + 1, i], velocity[n + 1, i] = _step(step, rates, n, place[n, i], velocity[n, i], pressed[n, i], pressed[n + 1, i])
    return outside


@kernel
def _step(step, rates, n, x, v, before, after):
    """Place and velocity a knot after the n-th, pressed from `before` to `after`: Runge's and Kutta's method."""
    middle = 0.5 * (before + after)
    a1 = rates[2 * n] * (x - before)
    v2, a2 = v + 0.5 * step * a1, rates[2 * n + 1] * (x + 0.5 * step * v - middle)
    v3, a3 = v + 0.5 * step * a2, rates[2 * n + 1] * (x + 0.5 * step * v2 - middle)
    v4, a4 = v + step * a3, rates[2 * n + 2] * (x + step * v3 - after)
    return x + step * (v + 2.0 * v2 + 2.0 * v3 + v4) / 6.0, v + step * (a1 + 2.0 * a2 + 2.0 * a3 + a4) / 6.0


@kernel
def _ends(step, rates, moves, speeds):
    """Write what place and velocity at the end (N + 2,) owe to a metre of pressure at each of N knots, of place, and to a metre a second at first."""
    count = len(moves) - 2
    for m in range(count + 2):
        x, v = 1.0 if m == count else 0.0, 1.0 if m == count + 1 else 0.0
        for n in range(max(m - 1, 0) if m < count else 0, count - 1):
            x, v = _step(step, rates, n, x, v, 1.0 if n == m else 0.0, 1.0 if n + 1 == m else 0.0)
        moves[m], speeds[m] = x, v


@kernel
def _solve(factor, right, out):
    """Thomas's method for a tridiagonal system with −CALM beside its diagonal, whose pivots' inverses are `factor` (N,)."""
    count = len(right)
    out[0] = right[0]
    for n in range(1, count):
        out[n] = right[n] + CALM * factor[n - 1] * out[n - 1]
    out[count - 1] *= factor[count - 1]
    for n in range(count - 2, -1, -1):
        out[n] = factor[n] * (out[n] + CALM * out[n + 1])


@kernel
def _project(point, corners, count, out):
    """Write the place (2,) in a polygon of `count` corners (H, 2), counter-clockwise, that is nearest to a point (2,); the point itself if
    there are no corners."""
    out[0], out[1] = point[0], point[1]
    x, y, best, inside = point[0], point[1], math.inf, True
    for i in range(count):
        k = i + 1 if i + 1 < count else 0
        ex, ey = corners[k, 0] - corners[i, 0], corners[k, 1] - corners[i, 1]
        px, py = x - corners[i, 0], y - corners[i, 1]
        if count > 2 and ex * py - ey * px >= 0.0:
            continue
        inside = False
        part = min(max((px * ex + py * ey) / max(ex * ex + ey * ey, 1e-12), 0.0), 1.0)
        far = (px - part * ex) ** 2 + (py - part * ey) ** 2
        if far < best:
            best = far
            out[0], out[1] = corners[i, 0] + part * ex, corners[i, 1] + part * ey
    if inside:
        out[0], out[1] = x, y
