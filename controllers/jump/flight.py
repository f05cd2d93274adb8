"""The flight: the centre of mass on its parabola, angular momentum kept to rounding.

How the joints move is prescribed; how the whole body turns meanwhile follows from the momentum
it took off with. Each step's turn is solved so that the step conserves it (Ha 2012 steers by
changing the moment of inertia: here the joints do, and the take-off gives the rest).
"""

from __future__ import annotations

import numpy as np

from ..body.turning import exp_kernel
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
    omega = spin.copy()
    worst = 0.0
    roots[0] = 0.0
    float_kernel(body, centres[0], roots[0], local[0], before, turned_before)
    for n in range(1, len(centres)):
        error = 0.0
        for _ in range(12):
            exp_kernel(omega[0] * step, omega[1] * step, omega[2] * step, turn)
            local[n, 0] = turn @ local[n - 1, 0]
            roots[n] = 0.0
            float_kernel(body, centres[n], roots[n], local[n], after, turned_after)
            momentum_kernel(body, before, turned_before, after, turned_after, step, found, inertia)
            lacking = momentum - found
            error = np.abs(lacking).max()
            if error < tolerance:
                break
            omega += np.linalg.solve(inertia, lacking)
        worst = max(worst, error)
        before, after = after, before
        turned_before, turned_after = turned_after, turned_before
    return worst
