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
def keep_clear(y, shapes, clearance, multipliers, stiffness, weight, gradient, hessian):
    """The penalty of places nearer than `clearance` [m] to shapes (K, 6), and the worst violation [m]."""
    cost, worst = 0.0, 0.0
    out = np.empty(3)
    for k in range(shapes.shape[0]):
        c = clearance - distance(y[0], y[1], shapes[k], out)
        worst = max(worst, c)
        push = stiffness * c + multipliers[k]
        if push <= 0.0:
            continue
        cost += weight * 0.5 * push * push / stiffness
        across = (-out[1], out[0])
        for i in range(2):
            gradient[i] -= weight * push * out[i]
            for j in range(2):
                hessian[i, j] += weight * (stiffness * out[i] * out[j] - push * out[2] * across[i] * across[j])
    return cost, worst
