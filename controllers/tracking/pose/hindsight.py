"""Poses in hindsight, where they may come some frames late: those of the last frames are solved for together.

Each frame says by its own normal equations how surely cameras saw every degree of freedom, and jitter is penalised over the
frames on both sides: accelerations change as little as what was seen allows (people move with the least jerk, Flash and Hogan
1985). What no camera showed for a while follows from before and after; what all of them showed hardly moves.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_solve_banded, cholesky_banded

from ...body import exp_kernel, log_kernel, product_kernel
from ...compiled import kernel
from ..twists import Chain, Configuration, retract_kernel, turn_log_kernel
from .penaliser import bounds

CALM = 30.0
"""How firmly accelerations are kept from changing, times what their bounds say. Tuned on run 16_55, squats and cartwheel 49_06."""
USUAL = 60.0
"""Frames a second at which an acceleration may change by its whole bound from one frame to the next."""
ROUNDS = 2
"""Gauss-Newton steps: turns are nearly linear from one frame to the next."""


@dataclass(frozen=True, eq=False)
class Glimpse:
    """What one frame says. where: the pose found. matrix (6 + D, 6 + D), vector (6 + D,): what a step away from it costs,
    ½ δᵀ M δ − vᵀ δ; the root's part is a shift of the hips and a turn about them. Zeros where no camera was believed."""

    where: Configuration
    matrix: np.ndarray
    vector: np.ndarray


def in_hindsight(chain: Chain, frames: Sequence[Glimpse], rate: float) -> list[Configuration]:
    """The likeliest poses of T frames in a row, `rate` of them a second, by what was seen in all of them."""
    if len(frames) < 4:
        return [one.where for one in frames]
    seen_roots, seen_angles = np.stack([one.where.root for one in frames]), np.stack([one.where.angles for one in frames])
    matrices, vectors = np.stack([one.matrix for one in frames]), np.stack([one.vector for one in frames])
    weights = CALM / (bounds(chain, rate) * max(USUAL / rate, 1.0)) ** 2
    count = len(frames)
    third = np.diff(np.eye(count), 3, axis=0)
    coupled = third.T @ third
    factor = cholesky_banded(_banded(matrices, weights, coupled), overwrite_ab=True, lower=True, check_finite=False), True
    roots, angles = seen_roots.copy(), seen_angles.copy()
    away, pace = np.empty(vectors.shape), np.empty((count - 1, len(weights)))
    for _ in range(ROUNDS):
        motions_kernel(chain.first, chain.count, roots[:-1], angles[:-1], roots[1:], angles[1:], pace)
        motions_kernel(chain.first, chain.count, seen_roots, seen_angles, roots, angles, away)
        pull = vectors - np.einsum("tij,tj->ti", matrices, away) - weights * (third.T @ np.diff(pace, 2, axis=0))
        step = cho_solve_banded(factor, pull.ravel(), check_finite=False).reshape(pull.shape)
        moved_kernel(chain.first, chain.count, step, roots, angles, chain.lower, chain.upper)
    return [Configuration(root, turned) for root, turned in zip(roots, angles)]


def _banded(matrices: np.ndarray, weights: np.ndarray, coupled: np.ndarray) -> np.ndarray:
    """The normal equations of T frames, each its own (T, n, n), and what binds them (T, T): the lower half by diagonals (3 n + 1, T n)."""
    count, size = len(matrices), len(weights)
    out = np.zeros((3 * size + 1, count, size))
    for d in range(size):
        out[d, :, :size - d] = np.diagonal(matrices, d, 1, 2)
    for k in range(4):
        out[k * size, :count - k] += np.diagonal(coupled, k)[:, None] * weights
    out[0] += 1e-9 * weights
    return out.reshape(3 * size + 1, count * size)


@kernel
def motions_kernel(first, count, roots, angles, other_roots, other_angles, out):
    """Write what leads from poses to others (T, 6 + D): a shift of the hips, a turn about them, in the world, and the joints' turns."""
    turn = np.empty((3, 3))
    for t in range(len(roots)):
        for i in range(3):
            out[t, i] = other_roots[t, i, 3] - roots[t, i, 3]
            for k in range(3):
                turn[i, k] = 0.0
                for m in range(3):
                    turn[i, k] += other_roots[t, i, m] * roots[t, k, m]
        log_kernel(turn, out[t, 3:6])
        turn_log_kernel(first, count, angles[t], other_angles[t], out[t, 6:])


@kernel
def moved_kernel(first, count, steps, roots, angles, lower, upper):
    """Go such steps (T, 6 + D) from poses, in place, joints within their limits."""
    turn, old, none = np.empty((3, 3)), np.empty((3, 3)), np.eye(4)
    only = np.zeros(steps.shape[1])
    for t in range(len(roots)):
        exp_kernel(steps[t, 3], steps[t, 4], steps[t, 5], turn)
        old[:] = roots[t, :3, :3]
        product_kernel(turn, old, roots[t, :3, :3])
        for i in range(3):
            roots[t, i, 3] += steps[t, i]
        only[6:] = steps[t, 6:]
        retract_kernel(first, count, only, none, angles[t], lower, upper)
