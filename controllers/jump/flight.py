"""The flight: the centre of mass on its parabola, angular momentum kept to rounding.

How the joints move is prescribed; how the whole body turns meanwhile follows from the momentum
it took off with. Each step's turn is solved so that the step conserves it (Ha 2012 steers by
changing the moment of inertia: here the joints do, and the take-off gives the rest).
"""

from __future__ import annotations

import numpy as np

from ..body.turning import exp_kernel, product_kernel
from ..compiled import kernel
from .dynamics import momentum_kernel
from .posture import float_kernel


@kernel
def flight_kernel(body, centres, local, spin, momentum, step, roots, tolerance):
    """Turn a flying body so that each step of `step` seconds keeps `momentum` (3,) [kg m²/s].

    centres: (N, 3) [m]. local: (N, J, 3, 3) all joints given, the pelvis' world orientation
    local[0, 0] at take-off; the others are written. spin: (3,) [rad/s] a first guess. roots:
    (N, 3) written. Returns the largest momentum error of a step [kg m²/s].
    """
    joints = local.shape[1]
    before, after = np.empty((joints, 3)), np.empty((joints, 3))
    turned_before, turned_after = np.empty((joints, 3, 3)), np.empty((joints, 3, 3))
    turn, found, inertia = np.empty((3, 3)), np.empty(3), np.empty((3, 3))
    omega, last = spin.copy(), spin.copy()
    worst = 0.0
    roots[0] = 0.0
    float_kernel(body, centres[0], roots[0], local[0], before, turned_before)
    for n in range(1, len(centres)):
        for i in range(3):  # it goes on turning as it did
            omega[i], last[i] = 2.0 * omega[i] - last[i], omega[i]
        error = 0.0
        for _ in range(12):
            exp_kernel(omega[0] * step, omega[1] * step, omega[2] * step, turn)
            product_kernel(turn, local[n - 1, 0], local[n, 0])
            roots[n] = 0.0
            float_kernel(body, centres[n], roots[n], local[n], after, turned_after)
            momentum_kernel(body, before, turned_before, after, turned_after, step, found, inertia)
            error = 0.0
            for i in range(3):
                found[i] = momentum[i] - found[i]
                error = max(error, abs(found[i]))
            if error < tolerance:
                break
            _turn_by(inertia, found, omega)
        worst = max(worst, error)
        before, after = after, before
        turned_before, turned_after = turned_after, turned_before
    return worst


@kernel
def _turn_by(inertia, momentum, omega):
    """Add to `omega` (3,) the spin that a momentum (3,) gives a body of this inertia (3, 3): Cramer's rule."""
    a, b, c = inertia[0, 0], inertia[0, 1], inertia[0, 2]
    d, e, f = inertia[1, 1], inertia[1, 2], inertia[2, 2]
    x, y, z = momentum[0], momentum[1], momentum[2]
    p, q, r = d * f - e * e, c * e - b * f, b * e - c * d  # the first row of the adjugate
    whole = a * p + b * q + c * r
    omega[0] += (p * x + q * y + r * z) / whole
    omega[1] += (q * x + (a * f - c * c) * y + (b * c - a * e) * z) / whole
    omega[2] += (r * x + (b * c - a * e) * y + (a * d - b * b) * z) / whole
