"""Rotations: the exponential chart, headings, and the alignments that motion data needs.

`scipy.spatial.transform.Rotation` does the general work (it takes any batch shape); here stand
only the few pieces the rest of the library shares. The scalar kernels at the end are compiled
by numba and are what the per-frame loops call; they are tested against scipy.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.spatial.transform import Rotation

from ..compiled import kernel


def exp(rotvec: np.ndarray) -> np.ndarray:
    """Rotation matrices (..., 3, 3) of rotation vectors (..., 3) [rad]."""
    return Rotation.from_rotvec(rotvec).as_matrix()


def log(matrix: np.ndarray) -> np.ndarray:
    """Rotation vectors (..., 3) [rad], |v| ≤ π, of rotation matrices (..., 3, 3)."""
    return Rotation.from_matrix(matrix).as_rotvec()


def yaw(angle: np.ndarray) -> np.ndarray:
    """Rotation matrices (..., 3, 3) about +Y by `angle` (...) [rad], counter-clockwise from above."""
    angle = np.asarray(angle, float)
    c, s, o, i = np.cos(angle), np.sin(angle), np.zeros_like(angle), np.ones_like(angle)
    return np.stack([c, o, s, o, i, o, -s, o, c], -1).reshape(angle.shape + (3, 3))


def heading_of(direction: np.ndarray) -> np.ndarray:
    """Heading (...) [rad] of directions (..., 3): 0 along +Z, +π/2 along +X."""
    return np.arctan2(direction[..., 0], direction[..., 2])


def wrap(angle: np.ndarray) -> np.ndarray:
    """Angles brought into (-π, π] [rad]."""
    return math.pi - np.mod(math.pi - np.asarray(angle), 2 * math.pi)


def continuous(rotvecs: np.ndarray, axis: int = 0) -> np.ndarray:
    """The same rotations with rotation vectors that do not jump along `axis`.

    A rotation vector v and v·(1 − 2π/|v|) are the same rotation; each sample takes the copy
    that lies nearest to the one before it. Shape kept: (..., 3).
    """
    v = np.moveaxis(np.array(rotvecs, float), axis, 0)
    for previous, current in zip(v[:-1], v[1:]):
        angle = np.linalg.norm(current, axis=-1, keepdims=True)
        unit = current / np.maximum(angle, 1e-12)
        turns = np.round((np.sum(unit * previous, -1, keepdims=True) - angle) / (2 * np.pi))
        current += unit * turns * 2 * np.pi
    return np.moveaxis(v, 0, axis)


def mean(matrix: np.ndarray, axis: int = 0) -> np.ndarray:
    """The chordal mean of rotation matrices (..., 3, 3) over one batch axis.

    The nearest rotation to the arithmetic mean in the Frobenius norm.
    """
    u, _, vt = np.linalg.svd(np.mean(matrix, axis=axis))
    u[..., 2] *= np.linalg.det(u @ vt)[..., None]
    return u @ vt


def between(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The smallest rotations (..., 3, 3) that carry directions a onto b, both (..., 3).

    Opposite directions turn by π about any perpendicular axis.
    """
    a = a / np.linalg.norm(a, axis=-1, keepdims=True)
    b = b / np.linalg.norm(b, axis=-1, keepdims=True)
    cross, dot = np.cross(a, b), np.sum(a * b, -1, keepdims=True)
    sine = np.linalg.norm(cross, axis=-1, keepdims=True)
    least = np.eye(3)[np.argmin(np.abs(a), -1)]
    spare = np.cross(a, least)
    axis = np.where(sine > 1e-9, cross / np.maximum(sine, 1e-12),
                    spare / np.linalg.norm(spare, axis=-1, keepdims=True))
    return exp(axis * np.arctan2(sine, dot))


@kernel(fastmath=True)
def exp_kernel(x, y, z, out):
    """Write exp of the rotation vector (x, y, z) [rad] into `out` (3, 3); any float type."""
    angle2 = x * x + y * y + z * z
    if angle2 < 1e-6:  # Taylor: below this the quotients lose half their digits in float32
        a = 1.0 - angle2 / 6.0
        b = 0.5 - angle2 / 24.0
    else:
        angle = math.sqrt(angle2)
        a = math.sin(angle) / angle
        b = (1.0 - math.cos(angle)) / angle2
    out[0, 0] = 1.0 - b * (y * y + z * z)
    out[0, 1] = b * x * y - a * z
    out[0, 2] = b * x * z + a * y
    out[1, 0] = b * x * y + a * z
    out[1, 1] = 1.0 - b * (x * x + z * z)
    out[1, 2] = b * y * z - a * x
    out[2, 0] = b * x * z - a * y
    out[2, 1] = b * y * z + a * x
    out[2, 2] = 1.0 - b * (x * x + y * y)


@kernel(fastmath=True)
def log_kernel(r, out):
    """Write the rotation vector of matrix `r` (3, 3) into `out` (3,); |v| ≤ π, any float type."""
    x, y, z = r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]
    sine = 0.5 * math.sqrt(x * x + y * y + z * z)
    cosine = 0.5 * (r[0, 0] + r[1, 1] + r[2, 2] - 1.0)
    angle = math.atan2(sine, cosine)
    if cosine > -0.5 and sine > 1e-4:
        scale = 0.5 * angle / sine
        out[0], out[1], out[2] = scale * x, scale * y, scale * z
    elif cosine > 0.0:
        out[0], out[1], out[2] = 0.5 * x, 0.5 * y, 0.5 * z
    else:  # near π the antisymmetric part vanishes; the symmetric one, less cos·I, is (1 − cos)·axis·axisᵀ
        k = 0
        if r[1, 1] > r[0, 0]:
            k = 1
        if r[2, 2] > r[k, k]:
            k = 2
        a, b, c = 0.5 * (r[0, k] + r[k, 0]), 0.5 * (r[1, k] + r[k, 1]), 0.5 * (r[2, k] + r[k, 2])
        if k == 0:
            a -= cosine
        elif k == 1:
            b -= cosine
        else:
            c -= cosine
        scale = angle / math.sqrt(a * a + b * b + c * c)
        if a * x + b * y + c * z < 0.0:
            scale = -scale
        out[0], out[1], out[2] = scale * a, scale * b, scale * c
