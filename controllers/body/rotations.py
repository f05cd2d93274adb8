"""Rotations: the exponential chart, headings, and the alignments that motion data needs.

`scipy.spatial.transform.Rotation` does the general work (it takes any batch shape);
here stand only the few pieces the rest of the library shares.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation


def exp(rotvec: ArrayLike) -> np.ndarray:
    """Rotation matrices (..., 3, 3) of rotation vectors (..., 3) [rad]."""
    return Rotation.from_rotvec(rotvec).as_matrix()


def log(matrix: np.ndarray) -> np.ndarray:
    """Rotation vectors (..., 3) [rad], |v| ≤ π, of rotation matrices (..., 3, 3)."""
    return Rotation.from_matrix(matrix).as_rotvec()


def yaw(angle: ArrayLike) -> np.ndarray:
    """Rotation matrices (..., 3, 3) about +Y by `angle` (...) [rad], counter-clockwise from above."""
    angle = np.asarray(angle, float)
    out = np.zeros(angle.shape + (3, 3))
    out[..., 0, 0] = out[..., 2, 2] = np.cos(angle)
    out[..., 0, 2] = np.sin(angle)
    out[..., 2, 0] = -out[..., 0, 2]
    out[..., 1, 1] = 1.0
    return out


def heading_of(direction: np.ndarray) -> np.ndarray:
    """Heading (...) [rad] of directions (..., 3): 0 along +Z, +π/2 along +X."""
    return np.arctan2(direction[..., 0], direction[..., 2])


def wrap(angle: ArrayLike) -> np.ndarray:
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


def carried(a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """What heading carries vectors a (..., n, 3) nearest to b (..., n, 3), as arctan2(across, along) of the parts (...) along and across that
    are given: Procrustes about the vertical. Parts of several sets add up."""
    return (np.sum(a[..., 0] * b[..., 0] + a[..., 2] * b[..., 2], -1),
            np.sum(b[..., 0] * a[..., 2] - b[..., 2] * a[..., 0], -1))


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
