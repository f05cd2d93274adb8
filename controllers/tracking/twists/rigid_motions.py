"""Rigid motions (..., 4, 4) and twists (..., 6) for whole arrays, through scipy. Compiled loops have `twist_kernels`.

Rosenhahn 2007 writes a twist as (v, ω) in the text and (ω, v) in eq. (3); here it is (v, ω) everywhere, and θξ is stored,
not ξ and θ apart.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import RigidTransform


def exp(twist: ArrayLike) -> np.ndarray:
    """The rigid motions (..., 4, 4) that twists (..., 6) generate, eq. (1) and (4)."""
    twist = np.asarray(twist, float)
    flat = twist.reshape(-1, 6)
    moved = RigidTransform.from_exp_coords(np.concatenate([flat[:, 3:], flat[:, :3]], 1)).as_matrix()
    return moved.reshape(*twist.shape[:-1], 4, 4)


def log(motion: ArrayLike) -> np.ndarray:
    """The twists (..., 6) of rigid motions (..., 4, 4), no more than half a turn, eq. (7) to (9)."""
    motion = np.asarray(motion, float)
    coords = RigidTransform.from_matrix(motion.reshape(-1, 4, 4)).as_exp_coords()
    return np.concatenate([coords[:, 3:], coords[:, :3]], 1).reshape(*motion.shape[:-2], 6)


def inverse(motion: ArrayLike) -> np.ndarray:
    """The inverses (..., 4, 4) of rigid motions."""
    motion = np.asarray(motion, float)
    out = np.zeros_like(motion)
    turned = np.swapaxes(motion[..., :3, :3], -1, -2)
    out[..., :3, :3] = turned
    out[..., :3, 3] = -np.einsum("...ij,...j->...i", turned, motion[..., :3, 3])
    out[..., 3, 3] = 1.0
    return out


def rigid(motion: ArrayLike) -> np.ndarray:
    """The nearest rigid motions (..., 4, 4) to matrices that rounding has led astray: predictions of predictions double it."""
    out = np.array(motion, float)
    u, _, vt = np.linalg.svd(out[..., :3, :3])
    out[..., :3, :3] = u @ vt
    return out


def hat(twist: ArrayLike) -> np.ndarray:
    """Twists (..., 6) as matrices (..., 4, 4), eq. (3)."""
    twist = np.asarray(twist, float)
    out = np.zeros((*twist.shape[:-1], 4, 4))
    out[..., :3, :3] = _cross(twist[..., 3:])
    out[..., :3, 3] = twist[..., :3]
    return out


def vee(matrix: ArrayLike) -> np.ndarray:
    """The twists (..., 6) of their matrices (..., 4, 4)."""
    m = np.asarray(matrix, float)
    return np.stack([m[..., 0, 3], m[..., 1, 3], m[..., 2, 3], m[..., 2, 1], m[..., 0, 2], m[..., 1, 0]], -1)


def adjoint(motion: ArrayLike) -> np.ndarray:
    """How motions (..., 4, 4) carry twists: (..., 6, 6), with M exp(ξ) M⁻¹ = exp(Ad(M) ξ)."""
    motion = np.asarray(motion, float)
    turned = motion[..., :3, :3]
    out = np.zeros((*motion.shape[:-2], 6, 6))
    out[..., :3, :3] = out[..., 3:, 3:] = turned
    out[..., :3, 3:] = _cross(motion[..., :3, 3]) @ turned
    return out


def bracket(twist: ArrayLike) -> np.ndarray:
    """The adjoint of the algebra (..., 6, 6): exp of it is the adjoint of exp."""
    twist = np.asarray(twist, float)
    out = np.zeros((*twist.shape[:-1], 6, 6))
    out[..., :3, :3] = out[..., 3:, 3:] = _cross(twist[..., 3:])
    out[..., :3, 3:] = _cross(twist[..., :3])
    return out


def _cross(v: np.ndarray) -> np.ndarray:
    """Matrices (..., 3, 3) that take the cross product with vectors (..., 3), eq. (2)."""
    out = np.zeros((*v.shape[:-1], 3, 3))
    out[..., 0, 1], out[..., 0, 2], out[..., 1, 2] = -v[..., 2], v[..., 1], -v[..., 0]
    out[..., 1, 0], out[..., 2, 0], out[..., 2, 1] = v[..., 2], -v[..., 1], v[..., 0]
    return out
