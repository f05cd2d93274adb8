"""The exponential chart of rotations for compiled loops: one matrix at a time, nothing checked.

`rotations` has the same for whole arrays, through scipy.
"""

from __future__ import annotations

import math


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
def quaternion_of(m):
    """The quaternion x, y, z, w of a rotation matrix (3, 3), of any length, by its largest part (Shepperd 1978)."""
    trace = m[0, 0] + m[1, 1] + m[2, 2]
    if trace > 0.0:
        return 1.0 * (m[2, 1] - m[1, 2]), 1.0 * (m[0, 2] - m[2, 0]), 1.0 * (m[1, 0] - m[0, 1]), 1.0 + trace
    if m[2, 2] > max(m[0, 0], m[1, 1]):
        return 1.0 * (m[0, 2] + m[2, 0]), 1.0 * (m[1, 2] + m[2, 1]), 1.0 + m[2, 2] - m[0, 0] - m[1, 1], 1.0 * (m[1, 0] - m[0, 1])
    if m[1, 1] > m[0, 0]:
        return 1.0 * (m[0, 1] + m[1, 0]), 1.0 + m[1, 1] - m[2, 2] - m[0, 0], 1.0 * (m[1, 2] + m[2, 1]), 1.0 * (m[0, 2] - m[2, 0])
    return 1.0 + m[0, 0] - m[1, 1] - m[2, 2], 1.0 * (m[0, 1] + m[1, 0]), 1.0 * (m[0, 2] + m[2, 0]), 1.0 * (m[2, 1] - m[1, 2])


@kernel
def quaternion_kernel(matrix, out):
    """Write it (4,)."""
    out[0], out[1], out[2], out[3] = quaternion_of(matrix)


@kernel
def log_kernel(matrix, out):
    """Write the rotation vector (3,) [rad], at most π long, of a rotation matrix (3, 3): exact up to half a turn."""
    x, y, z, w = quaternion_of(matrix)
    if w < 0.0:
        x, y, z, w = -x, -y, -z, -w
    sine = math.sqrt(x ** 2 + y ** 2 + z ** 2)
    scale = 2.0 / w if sine < 1e-12 * w else 2.0 * math.atan2(sine, w) / sine
    out[0], out[1], out[2] = scale * x, scale * y, scale * z
