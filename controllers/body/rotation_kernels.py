"""The exponential chart of rotations for compiled loops: one matrix at a time, nothing checked.

`rotations` has the same for whole arrays, through scipy.
"""

from __future__ import annotations

import math

import numpy as np

from ..compiled import kernel


@kernel
def exp_kernel(x, y, z, out):
    """Write the rotation matrix (3, 3) of a rotation vector [rad]."""
    square = x * x + y * y + z * z
    angle = math.sqrt(square)
    if angle < 1e-4:  # Taylor, to rounding
        s, c = 1.0 - square / 6.0, 0.5 - square / 24.0
    else:
        s, c = math.sin(angle) / angle, (1.0 - math.cos(angle)) / square
    out[0, 0], out[0, 1], out[0, 2] = 1.0 - c * (y * y + z * z), c * x * y - s * z, c * x * z + s * y
    out[1, 0], out[1, 1], out[1, 2] = c * x * y + s * z, 1.0 - c * (x * x + z * z), c * y * z - s * x
    out[2, 0], out[2, 1], out[2, 2] = c * x * z - s * y, c * y * z + s * x, 1.0 - c * (x * x + y * y)


@kernel
def product_kernel(a, b, out):
    """Write a b of two matrices (3, 3): BLAS takes ten times as long for so few numbers. `out` is neither of them."""
    for i in range(3):
        for k in range(3):
            out[i, k] = a[i, 0] * b[0, k] + a[i, 1] * b[1, k] + a[i, 2] * b[2, k]


@kernel
def relative_kernel(parent, child, out):
    """Write parentᵀ child (3, 3): how a child is turned in its parent's frame. `out` is neither of them."""
    for i in range(3):
        for k in range(3):
            out[i, k] = parent[0, i] * child[0, k] + parent[1, i] * child[1, k] + parent[2, i] * child[2, k]


@kernel
def quaternion_kernel(matrix, out):
    """Write a quaternion (4,) x, y, z, w of a rotation matrix (3, 3), of any length, by its largest part (Shepperd 1978)."""
    m, q = matrix, out
    trace = m[0, 0] + m[1, 1] + m[2, 2]
    if trace > 0.0:
        q[3] = 1.0 + trace
        q[0], q[1], q[2] = m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]
    else:
        i = 0
        if m[1, 1] > m[0, 0]:
            i = 1
        if m[2, 2] > m[i, i]:
            i = 2
        j, k = (i + 1) % 3, (i + 2) % 3
        q[i] = 1.0 + m[i, i] - m[j, j] - m[k, k]
        q[j], q[k], q[3] = m[j, i] + m[i, j], m[k, i] + m[i, k], m[k, j] - m[j, k]


@kernel
def log_kernel(matrix, out):
    """Write the rotation vector (3,) [rad], at most π long, of a rotation matrix (3, 3): exact up to half a turn."""
    q = np.empty(4)
    quaternion_kernel(matrix, q)
    if q[3] < 0.0:
        q = -q
    sine = math.sqrt(q[0] ** 2 + q[1] ** 2 + q[2] ** 2)
    scale = 2.0 / q[3] if sine < 1e-12 * abs(q[3]) else 2.0 * math.atan2(sine, q[3]) / sine
    out[0], out[1], out[2] = scale * q[0], scale * q[1], scale * q[2]
