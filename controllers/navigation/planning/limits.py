"""What a way must keep to, as an augmented Lagrangian: velocities within half-spaces, distance from what stands about.

Every limit is c ≤ 0. A multiplier λ ≥ 0 and a stiffness ρ for each give the penalty ½ρ max(0, c + λ/ρ)² − ½λ²/ρ; after
each minimum λ becomes max(0, λ + ρc) (Nocedal and Wright 2006, chapter 17).
"""

from __future__ import annotations

import math

import numpy as np

from ...compiled import kernel
from ..routes import distance


@kernel
def too_fast(y, seconds, plane):
    """How far a velocity lies beyond a half-space (4,), negative within it."""
    sine, cosine = math.sin(y[2]), math.cos(y[2])
    v_f, v_l = y[3] * sine + y[4] * cosine, y[3] * cosine - y[4] * sine
    return (plane[0] * v_f + plane[1] * y[5] + plane[2] * v_l) / seconds + plane[3]


@kernel
def keep_velocity(y, seconds, planes, multipliers, stiffness, weight, gradient, hessian, mixed):
    """The penalty of velocities beyond half-spaces, its ∂/∂T and ∂²/∂T², and the worst violation.

    y: (9,) as of `stage`. planes: (H, 4), n·(v_f, ω, v_l) + d ≤ 0. multipliers: (H,). Derivatives are added, times weight.
    """
    sine, cosine = math.sin(y[2]), math.cos(y[2])
    v_f, v_l, turn = y[3] * sine + y[4] * cosine, y[3] * cosine - y[4] * sine, y[5]
    cost, by_t, by_tt, worst = 0.0, 0.0, 0.0, 0.0
    by = np.zeros(9)
    for h in range(planes.shape[0]):
        n0, n1, n2 = planes[h, 0], planes[h, 1], planes[h, 2]
        speed = (n0 * v_f + n1 * turn + n2 * v_l) / seconds
        c = speed + planes[h, 3]
        worst = max(worst, c)
        push = stiffness * c + multipliers[h]
        if push <= 0.0:
            continue
        cost += weight * 0.5 * push * push / stiffness
        by[2] = (n0 * v_l - n2 * v_f) / seconds
        by[3], by[4] = (n0 * sine + n2 * cosine) / seconds, (n0 * cosine - n2 * sine) / seconds
        by[5] = n1 / seconds
        t = -speed / seconds
        for i in range(2, 6):
            gradient[i] += weight * push * by[i]
            mixed[i] += weight * (stiffness * by[i] * t - push * by[i] / seconds)
            for j in range(2, 6):
                hessian[i, j] += weight * stiffness * by[i] * by[j]
        by_t += weight * push * t
        by_tt += weight * (stiffness * t * t + 2.0 * push * speed / seconds**2)
    return cost, by_t, by_tt, worst


@kernel
def reach(nx, nz, heading, girth, by):
    """How far [m] a walker turned to a heading [rad] reaches against (nx, nz), of length 1; by: (2,) its first and second derivative by the heading.

    girth: (3,) how far he reaches aside, a, arms and all, and ahead and back, b [m]. With q the sine by which he is turned, r² = a² − (a² − b²) q⁸: between the
    two he is hardly narrower than at his widest, as who goes aslant swings his feet out.
    """
    by[0], by[1] = 0.0, 0.0
    if girth[1] >= girth[0] and girth[2] >= girth[0]:
        return girth[0]
    sine, cosine = math.sin(heading), math.cos(heading)
    p, q = cosine * nx - sine * nz, sine * nx + cosine * nz
    depth = girth[2] if q > 0.0 else girth[1]  # (nx, nz) points away from what is near
    spare = girth[0] ** 2 - depth**2
    r = math.sqrt(girth[0] ** 2 - spare * q**8)
    by[0] = -4.0 * spare * q**7 * p / r
    by[1] = (-spare * (28.0 * q**6 * p * p - 4.0 * q**8) - by[0] ** 2) / r
    return r


@kernel
def too_near(x, z, heading, shape, girth):
    """How much farther [m] from a shape a walker would have to be, negative where he is far enough."""
    slope, by = np.empty(3), np.empty(2)
    there = distance(x, z, shape, slope)
    return reach(slope[0], slope[1], heading, girth, by) - there


@kernel
def keep_clear(y, shapes, girth, multipliers, stiffness, weight, gradient, hessian):
    """The penalty of walkers of a girth (3,) [m], see `reach`, too near to shapes (K, 6), and the worst violation [m].

    n being the slope of the distance, t across it and κ the bend of its level line, n turns by κ t with the place, and the reach with n as with the heading.
    """
    cost, worst = 0.0, 0.0
    out, by, slope, bend = np.empty(3), np.empty(2), np.empty(3), np.empty((3, 3))
    for k in range(shapes.shape[0]):
        far = abs(shapes[k, 2]) + abs(shapes[k, 3]) + max(shapes[k, 5], 0.0) + girth[0]
        if multipliers[k] == 0.0 and (y[0] - shapes[k, 0]) ** 2 + (y[1] - shapes[k, 1]) ** 2 > far * far:
            continue  # it is nowhere near, which is quickly told
        there = distance(y[0], y[1], shapes[k], out)
        c = reach(out[0], out[1], y[2], girth, by) - there
        worst = max(worst, c)
        push = stiffness * c + multipliers[k]
        if push <= 0.0:
            continue
        cost += weight * 0.5 * push * push / stiffness
        n, t, curved = (out[0], out[1]), (-out[1], out[0]), out[2]
        for i in range(2):
            slope[i] = by[0] * curved * t[i] - n[i]
            bend[i, 2] = bend[2, i] = by[1] * curved * t[i]
            for j in range(2):
                bend[i, j] = (by[1] * curved - 1.0) * curved * t[i] * t[j] - by[0] * curved**2 * (t[i] * n[j] + n[i] * t[j])
        slope[2], bend[2, 2] = by[0], by[1]
        for i in range(3):
            gradient[i] += weight * push * slope[i]
            for j in range(3):
                hessian[i, j] += weight * (stiffness * slope[i] * slope[j] + push * bend[i, j])
    return cost, worst
