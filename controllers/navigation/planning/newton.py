"""The optimal control problem solved: Newton's method on banded normal equations, compiled.

Unknown are the spline's inner coefficients and the time T: the ends are held by construction, so that without limits
nothing is constrained. Each step solves (H + μD) δ = −g with the whole Hessian (Gauss-Newton's stalls where the goal
lies behind, as ψ is large there), μ as of Levenberg and Marquardt; H is banded but for the row of T.
"""

from __future__ import annotations

import math

import numpy as np

from ...compiled import kernel
from .limits import keep_clear, keep_velocity
from .splines import at_place
from .walking_cost import stage

BAND = 12
"""Coefficients four apart, three numbers each, share no interval."""
HOPE = 5.0
"""A search that is to gain less than so many times what its next step promises is given up for a better one; on a pass
between two ways a step promises little."""
LEASH = 0.3
"""Among things that stand about a way moves by so much in a step, at most [m]; and turns, where he has to turn aside to pass [rad]."""


@kernel
def _hold(coefficients, start, speed, goal, leave, seconds):
    """The outer coefficients, which hold pose and velocity at the start and at the goal."""
    last = coefficients.shape[0] - 1
    reach = seconds / (3.0 * (last - 2))
    for d in range(3):
        coefficients[0, d] = start[d]
        coefficients[1, d] = start[d] + reach * speed[d]
        coefficients[last - 1, d] = goal[d] - reach * leave[d]
        coefficients[last, d] = goal[d]


@kernel
def assemble(coefficients, seconds, speed, leave, aims, alpha, values, weights, planes, shapes, girth,
             by_plane, by_shape, stiff_speed, stiff_space, band, column, gradient):
    """Cost with penalties, and all derivatives by the free coefficients and T; also the cost alone, and the worst violations.

    speed, leave: (3,) how he moves at both ends. aims: (Q, 2) what the walker likes to face, place by place [m]. band: (n, BAND) lower band by rows, column: (n,) of T, gradient: (n + 1,), overwritten. Returns also ∂²/∂T².
    """
    intervals = coefficients.shape[0] - 3
    n = column.shape[0]
    band[:], column[:], gradient[:] = 0.0, 0.0, 0.0
    y, g, mixed, moved = np.empty(9), np.empty(9), np.empty(9), np.zeros(9)
    h, part = np.empty((9, 9)), np.empty((4, 9, 3))
    cost, penalty, corner, fast, near = 0.0, 0.0, 0.0, 0.0, 0.0
    for place in range(weights.shape[0]):
        first = place * intervals // weights.shape[0]
        base, weight = values[place], weights[place]
        at_place(base, first, coefficients, y)
        c, by_t, by_tt = stage(y, aims[place], alpha, seconds, g, h, mixed)
        cost += weight * c
        if planes.shape[0]:
            p, t, tt, worst = keep_velocity(y, seconds, planes, by_plane[place], stiff_speed, 1.0, g, h, mixed)
            penalty, by_t, by_tt, fast = penalty + weight * p, by_t + t, by_tt + tt, max(fast, worst)
        if shapes.shape[0]:
            p, worst = keep_clear(y, shapes, girth, by_shape[place], stiff_space, 1.0, g, h)
            penalty, near = penalty + weight * p, max(near, worst)
        if first < 2 or first >= intervals - 2:  # the second coefficient moves with T, and the last but one
            for order in range(3):
                for d in range(3):
                    by = base[order, 1 - first] * speed[d] if first < 2 else -base[order, intervals + 1 - first] * leave[d]
                    moved[3 * order + d] = by / (3.0 * intervals)
            for i in range(9):
                by_t += g[i] * moved[i]
                by_tt += 2.0 * mixed[i] * moved[i]
                for j in range(9):
                    by_tt += moved[i] * h[i, j] * moved[j]
            for i in range(9):
                for j in range(9):
                    mixed[i] += h[i, j] * moved[j]
        gradient[n] += weight * by_t
        corner += weight * by_tt
        for k in range(4):
            for i in range(9):
                for d in range(3):
                    part[k, i, d] = weight * (base[0, k] * h[i, d] + base[1, k] * h[i, 3 + d] + base[2, k] * h[i, 6 + d])
        for k in range(4):
            row = 3 * (first + k - 2)
            if row < 0 or row >= n:
                continue
            for d in range(3):
                at = row + d
                gradient[at] += weight * (base[0, k] * g[d] + base[1, k] * g[3 + d] + base[2, k] * g[6 + d])
                column[at] += weight * (base[0, k] * mixed[d] + base[1, k] * mixed[3 + d] + base[2, k] * mixed[6 + d])
                for m in range(k + 1):
                    other = 3 * (first + m - 2)
                    if other < 0:
                        continue
                    for e in range(3):
                        if other + e <= at:
                            band[at, at - other - e] += (base[0, k] * part[m, d, e] + base[1, k] * part[m, 3 + d, e]
                                                         + base[2, k] * part[m, 6 + d, e])
    return cost, penalty, corner, fast, near


@kernel
def _factor(band, factor):
    """Cholesky's factor of a banded matrix; False where it is not positive definite."""
    n = band.shape[0]
    for i in range(n):
        for back in range(min(i, BAND - 1), -1, -1):
            j = i - back
            total = band[i, back]
            for k in range(max(0, i - BAND + 1), j):
                total -= factor[i, i - k] * factor[j, j - k]
            if back:
                factor[i, back] = total / factor[j, 0]
            elif total > 1e-12:
                factor[i, 0] = math.sqrt(total)
            else:
                return False
    return True


@kernel
def _solve(factor, b):
    """L Lᵀ x = b, in place."""
    n = b.shape[0]
    for i in range(n):
        total = b[i]
        for k in range(max(0, i - BAND + 1), i):
            total -= factor[i, i - k] * b[k]
        b[i] = total / factor[i, 0]
    for i in range(n - 1, -1, -1):
        total = b[i]
        for k in range(i + 1, min(n, i + BAND)):
            total -= factor[k, k - i] * b[k]
        b[i] = total / factor[i, 0]


@kernel
def _step(band, column, corner, gradient, damping, shifted, factor, border, step):
    """The damped Newton step (n + 1,); False where the damped Hessian is not positive definite."""
    n = column.shape[0]
    for i in range(n):
        for k in range(BAND):
            shifted[i, k] = band[i, k]
        shifted[i, 0] += damping * (abs(band[i, 0]) + 1e-6)
        border[i] = column[i]
        step[i] = -gradient[i]
    if not _factor(shifted, factor):
        return False
    _solve(factor, border)
    _solve(factor, step[:n])
    below, along = corner + damping * (abs(corner) + 1e-6), -gradient[n]
    for i in range(n):
        below -= column[i] * border[i]
        along -= column[i] * step[i]
    if below <= 1e-12:
        return False
    step[n] = along / below
    for i in range(n):
        step[i] -= border[i] * step[n]
    return True


@kernel
def minimise(coefficients, seconds, start, speed, goal, leave, aims, alpha, values, weights, planes, shapes, girth,
             by_plane, by_shape, stiff_speed, stiff_space, most, tolerance, best):
    """Newton's method from a guess, in place. Returns T, the cost, that with penalties, the worst violations, the steps taken, and
    whether it converged. It gives up where it is not to come below `best`."""
    n = 3 * (coefficients.shape[0] - 4)
    band, shifted, factor = np.empty((n, BAND)), np.empty((n, BAND)), np.empty((n, BAND))
    column, border = np.empty(n), np.empty(n)
    gradient, step = np.empty(n + 1), np.empty(n + 1)
    kept = coefficients.copy()
    _hold(coefficients, start, speed, goal, leave, seconds)
    cost, penalty, corner, fast, near = assemble(coefficients, seconds, speed, leave, aims, alpha, values, weights, planes, shapes, girth,
                                                 by_plane, by_shape, stiff_speed, stiff_space, band, column, gradient)
    damping = 1e-4
    fresh = True
    for count in range(most):
        if not _step(band, column, corner, gradient, damping, shifted, factor, border, step):
            damping = max(8.0 * damping, 1e-4)
            if damping > 1e12:
                return seconds, cost, cost + penalty, fast, near, count, False
            continue
        promised = 0.0
        for i in range(n + 1):
            promised -= gradient[i] * step[i]
        if 0.5 * promised < tolerance * (cost + penalty) and damping < 1e-2:
            return seconds, cost, cost + penalty, fast, near, count, True
        if cost + penalty - HOPE * promised > best and damping < 1e-2:
            return seconds, cost, cost + penalty, fast, near, count, False
        share = min(1.0, 0.5 * seconds / abs(step[n])) if step[n] != 0.0 else 1.0
        if shapes.shape[0]:  # lest the way jumps to another side of something
            for i in range(n):
                if (i % 3 < 2 or girth[1] < girth[0]) and share * abs(step[i]) > LEASH:
                    share = LEASH / abs(step[i])
        kept[:] = coefficients
        before = seconds
        seconds += share * step[n]
        for i in range(n):
            coefficients[2 + i // 3, i % 3] += share * step[i]
        _hold(coefficients, start, speed, goal, leave, seconds)
        new = assemble(coefficients, seconds, speed, leave, aims, alpha, values, weights, planes, shapes, girth,
                       by_plane, by_shape, stiff_speed, stiff_space, band, column, gradient)
        gained = (cost + penalty) - (new[0] + new[1])
        if gained > 1e-4 * share * promised * 0.5:
            cost, penalty, corner, fast, near = new
            damping = damping / 8.0 if gained > 0.25 * share * promised else damping
            if damping < 1e-8:
                damping = 0.0
        else:
            if promised < 1e-9 * (cost + penalty):
                fresh = False
            coefficients[:] = kept
            seconds = before
            cost, penalty, corner, fast, near = assemble(coefficients, seconds, speed, leave, aims, alpha, values, weights, planes, shapes, girth,
                                                         by_plane, by_shape, stiff_speed, stiff_space, band, column, gradient)
            if not fresh:
                return seconds, cost, cost + penalty, fast, near, count, True
            damping = max(8.0 * damping, 1e-4)
    return seconds, cost, cost + penalty, fast, near, most, False
