"""The flight: the centre of mass on its parabola, angular momentum kept to rounding.

How the joints move is prescribed; how the whole body turns meanwhile follows from the momentum
it took off with. Each step's turn is solved so that the step conserves it (Ha 2012 steers by
changing the moment of inertia: here the joints do, and the take-off gives the rest).
"""

from __future__ import annotations

import numpy as np

from ...body import exp_kernel, product_kernel
from ...compiled import kernel
from ..body import momentum_kernel, parts_kernel, place_kernel


@kernel
def flight_kernel(body, centres, local, spin, momentum, step, roots, tolerance):
    """Turn a flying body so that each step of `step` seconds keeps `momentum` (3,) [kg m²/s].

    centres: (N, 3) [m]. local: (N, J, 3, 3) all joints given, the pelvis' world orientation
    local[0, 0] at take-off; the others are written. spin: (3,) [rad/s] a first guess. roots:
    (N, 3) written. Returns the largest momentum error of a step [kg m²/s].
    """
    joints, parts = local.shape[1], len(body.mass)
    positions, orientations = np.empty((joints, 3)), np.empty((joints, 3, 3))
    before, after, still = np.empty((parts, 3)), np.empty((parts, 3)), np.empty((parts, 3))
    turned_before, turned_after, turned_still = np.empty((parts, 3, 3)), np.empty((parts, 3, 3)), np.empty((parts, 3, 3))
    turn, turned, found, inertia, centre = np.empty((3, 3)), local[0, 0].copy(), np.empty(3), np.empty((3, 3)), np.empty(3)
    omega, last = spin.copy(), spin.copy()
    worst = 0.0
    for n in range(len(centres)):
        for i in range(3):
            for k in range(3):
                local[n, 0, i, k] = 1.0 if i == k else 0.0
        place_kernel(body, np.zeros(3), local[n], positions, orientations)
        parts_kernel(body, positions, orientations, centre, still, turned_still)
        if n == 0:
            local[0, 0] = turned
            _rotate(turned, still, turned_still, before, turned_before)
        else:
            for i in range(3):  # it goes on turning as it did
                omega[i], last[i] = 2.0 * omega[i] - last[i], omega[i]
            error = 0.0
            for _ in range(12):
                exp_kernel(omega[0] * step, omega[1] * step, omega[2] * step, turn)
                product_kernel(turn, local[n - 1, 0], turned)
                _rotate(turned, still, turned_still, after, turned_after)
                momentum_kernel(body, before, turned_before, after, turned_after, step, found, inertia)
                error = 0.0
                for i in range(3):
                    found[i] = momentum[i] - found[i]
                    error = max(error, abs(found[i]))
                if error < tolerance:
                    break
                _turn_by(inertia, found, omega)
            local[n, 0] = turned
            worst = max(worst, error)
            before, after = after, before
            turned_before, turned_after = turned_after, turned_before
        for i in range(3):
            roots[n, i] = centres[n, i] - turned[i, 0] * centre[0] - turned[i, 1] * centre[1] - turned[i, 2] * centre[2]
    return worst


@kernel
def _rotate(turn, places, turned, out, turned_out):
    """Write places (S, 3) and turns (S, 3, 3) of a body that is turned (3, 3) as a whole."""
    for s in range(len(places)):
        for i in range(3):
            out[s, i] = turn[i, 0] * places[s, 0] + turn[i, 1] * places[s, 1] + turn[i, 2] * places[s, 2]
        product_kernel(turn, turned[s], turned_out[s])


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
