"""What walking to a goal costs: Mombaur, Truong and Laumond 2010, one stage of it with its derivatives.

J = ∫ α₀ + α₁ u_f² + α₂ u_ω² + α₃ u_l² + α₄ ψ² dt over a free time T. The accelerations u are those of the
velocities (v_f, ω, v_l) in the walker's own frame, ψ is the angle from the heading to the direction of the goal. As
the walker may move to any side (eq. 2 of Truong 2010) the way p(s) = (x, z, θ), s = t/T, tells all: with a = p″,
q = p′, f and l the unit vectors forward and to the left

    u_f = (a·f + θ′ q·l) / T²,   u_ω = θ″ / T²,   u_l = (a·l − θ′ q·f) / T².

Mended: at the goal ψ has no meaning, so that ψ² fades by 1 − exp(−d²/FADE²) with the distance d. Where something is in the way
the goal's direction is that of the way there, a little ahead, as nobody looks through walls.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...compiled import kernel

FADE = 0.3
"""How near to the goal the walker no longer cares where it lies [m]."""
NEAREST = 1e-9
"""Squared distances [m²] count as this at least: the direction of a goal that one stands on is any."""


class Weights(NamedTuple):
    """α₀ … α₄ of the cost: of time [1/s], of the squares of forward [s³/m²], turning [s³/rad²] and lateral
    acceleration [s³/m²], and of looking away from the goal [1/(s rad²)]."""

    time: float
    forward: float
    turning: float
    lateral: float
    facing: float


@kernel
def stage(y, aim, alpha, seconds, gradient, hessian, mixed):
    """One moment's cost per share of the time, ∂/∂T and ∂²/∂T².

    y: (9,) x, z, θ and their first and second derivatives by s. aim: (2,) x, z [m], the goal's or what is faced on the way there. alpha: (5,). seconds: T.
    gradient: (9,), hessian: (9, 9), mixed: (9,) ∂²/∂y∂T, all overwritten.
    """
    hessian[:] = 0.0
    sine, cosine = math.sin(y[2]), math.cos(y[2])
    turn = y[5]
    v_f, v_l = y[3] * sine + y[4] * cosine, y[3] * cosine - y[4] * sine
    a_f, a_l = y[6] * sine + y[7] * cosine, y[6] * cosine - y[7] * sine
    forward, lateral = a_f + turn * v_l, a_l - turn * v_f

    # accelerations: residuals forward, lateral, y[8], over T²
    by_f, by_l = np.zeros(9), np.zeros(9)
    by_f[2], by_f[3], by_f[4], by_f[5], by_f[6], by_f[7] = lateral, turn * cosine, -turn * sine, v_l, sine, cosine
    by_l[2], by_l[3], by_l[4], by_l[5], by_l[6], by_l[7] = -forward, -turn * sine, -turn * cosine, -v_f, cosine, -sine
    cube = 1.0 / seconds**3
    wf, ww, wl = 2.0 * alpha[1] * cube, 2.0 * alpha[2] * cube, 2.0 * alpha[3] * cube
    for i in range(2, 8):
        gradient[i] = wf * forward * by_f[i] + wl * lateral * by_l[i]
        for j in range(2, 8):
            hessian[i, j] = wf * by_f[i] * by_f[j] + wl * by_l[i] * by_l[j]
    gradient[0] = gradient[1] = 0.0
    gradient[8] = ww * y[8]
    hessian[8, 8] = ww
    rf, rl = wf * forward, wl * lateral
    hessian[2, 2] -= rf * forward + rl * lateral
    _both(hessian, 2, 6, rf * cosine - rl * sine)
    _both(hessian, 2, 7, -rf * sine - rl * cosine)
    _both(hessian, 5, 3, rf * cosine - rl * sine)
    _both(hessian, 5, 4, -rf * sine - rl * cosine)
    _both(hessian, 2, 3, turn * (-rf * sine - rl * cosine))
    _both(hessian, 2, 4, turn * (-rf * cosine + rl * sine))
    _both(hessian, 2, 5, -rf * v_f - rl * v_l)
    effort = alpha[1] * forward**2 + alpha[2] * y[8] ** 2 + alpha[3] * lateral**2
    for i in range(9):
        mixed[i] = -3.0 * gradient[i] / seconds

    away = _looking_away(y, aim, alpha[4], seconds, gradient, hessian, mixed)
    return (alpha[0] * seconds + effort * cube + away * seconds, alpha[0] - 3.0 * effort * cube / seconds + away,
            12.0 * effort * cube / seconds**2)


@kernel
def _both(matrix, i, j, value):
    matrix[i, j] += value
    matrix[j, i] += value


@kernel
def _looking_away(y, aim, weight, seconds, gradient, hessian, mixed):
    """α₄ ψ² with its fade, whose derivatives by x, z, θ are added."""
    dx, dz = aim[0] - y[0], aim[1] - y[1]
    square = max(dx * dx + dz * dz, NEAREST)
    psi = math.atan2(dx, dz) - y[2]
    psi -= 2.0 * math.pi * math.floor(psi / (2.0 * math.pi) + 0.5)
    left = math.exp(-square / FADE**2)
    fade, k = 1.0 - left, 2.0 / FADE**2
    p0, p1, p2 = -dz / square, dx / square, -1.0  # ∇ψ
    f0, f1 = -k * left * dx, -k * left * dz  # ∇fade
    g0, g1, g2 = f0 * psi**2 + 2 * fade * psi * p0, f1 * psi**2 + 2 * fade * psi * p1, 2 * fade * psi * p2
    bend = 2.0 * fade * psi / square**2
    scale = weight * seconds
    for i, g in ((0, g0), (1, g1), (2, g2)):
        gradient[i] += scale * g
        mixed[i] += weight * g
    hessian[0, 0] += scale * (psi**2 * k * left * (1 - k * dx * dx) + 4 * psi * f0 * p0 + 2 * fade * p0 * p0 - 2 * bend * dx * dz)
    hessian[1, 1] += scale * (psi**2 * k * left * (1 - k * dz * dz) + 4 * psi * f1 * p1 + 2 * fade * p1 * p1 + 2 * bend * dx * dz)
    hessian[2, 2] += scale * 2 * fade
    _both(hessian, 0, 1, scale * (-psi**2 * k * k * left * dx * dz + 2 * psi * (f0 * p1 + f1 * p0) + 2 * fade * p0 * p1
                                  + bend * (dx * dx - dz * dz)))
    _both(hessian, 0, 2, scale * (2 * psi * f0 * p2 + 2 * fade * p0 * p2))
    _both(hessian, 1, 2, scale * (2 * psi * f1 * p2 + 2 * fade * p1 * p2))
    return weight * fade * psi**2
