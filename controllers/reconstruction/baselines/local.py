"""Local models of others: components of the poses (Chai & Hodgins 2005), components of the past (Liu 2011), the nearest pose."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..neighbours import Neighbourhood
from ..pose_vector import FORWARD, HEIGHT, LEFTWARD, WIDTH, YAW_RATE
from ..regression import FLOOR, Gaussian, Memory, fuse, weights

LOOSE = np.zeros(WIDTH)
"""How far the root may leave the local poses' subspace: 2 cm and 2° in a frame, as standard deviations of the columns."""
LOOSE[HEIGHT], LOOSE[HEIGHT + 1:YAW_RATE] = 0.02, np.radians(2.0)
LOOSE[YAW_RATE], LOOSE[[FORWARD, LEFTWARD]] = 60.0 * np.radians(2.0), 60.0 * 0.02
LOOSE.setflags(write=False)


@dataclass(frozen=True, eq=False)
class LocalPCA:
    """Poses q = p̄ + U w of the neighbours' principal subspace, wᵀΛ⁻¹w small and q near the way of the last two frames.

    share: of the variance that U keeps. most: components at most. loosening: 1/α, times Λ. smoothness: √(1/β), the
    standard deviation of q − 2q₋₁ + q₋₂ in units of `FLOOR`; None for no such term, which did best on recorded
    takes: on a method's own output it keeps errors going. root: how far the root may
    leave the subspace, as standard deviations (D,); without any, a body that has strayed from the neighbours explodes.
    """

    share: float = 0.999
    most: int = 12
    loosening: float = 3.0
    smoothness: float | None = None
    root: np.ndarray = field(default_factory=lambda: LOOSE)

    def believe(self, feature: np.ndarray, near: Neighbourhood, memory: Memory) -> Gaussian:
        """See `LocalModel`. Columns are compared in units of `FLOOR`, so that metres and radians mix."""
        mean = near.Y.mean(0, dtype=float)
        away = (near.Y - mean) / (FLOOR * np.sqrt(max(len(near.Y) - 1, 1)))
        size, across = _components(away.T @ away)
        kept = min(self.most, 1 + int(np.searchsorted(np.cumsum(size), self.share * np.sum(size))), len(size))
        factor = np.sqrt(self.loosening * size[:kept, None]) * across[:, :kept].T * FLOOR
        belief = Gaussian(mean, np.asarray(self.root) ** 2, factor)
        if self.smoothness is None:
            return belief
        return fuse(belief, Gaussian(2.0 * memory.frames[0] - memory.frames[1], (self.smoothness * FLOOR) ** 2))


@dataclass(frozen=True, eq=False)
class LocalPCR:
    """Linear regression on the principal components of the neighbours' past.

    share: of the past's variance that the components keep. floor, loosening, bandwidth: as in `Regression`; Liu 2011
    has no weights, which None stands for.
    """

    share: float = 0.99
    floor: np.ndarray = field(default_factory=lambda: FLOOR)
    loosening: float = 300.0
    bandwidth: str | None = "knn"

    def believe(self, feature: np.ndarray, near: Neighbourhood, memory: Memory) -> Gaussian:
        """See `LocalModel`."""
        count = len(near.X)
        omega = np.ones(count) if self.bandwidth is None else weights(near.distances, self.bandwidth)
        root, part = np.sqrt(omega)[:, None], omega / omega.sum()
        x_mean, y_mean = part @ near.X, part @ near.Y
        x, y = root * (near.X - x_mean), root * (near.Y - y_mean)
        size, scores = _components(x @ x.T)
        energy = np.cumsum(size)
        # as many as keep the share, but none that is nothing, and fewer than points, lest nothing be left to tell σ
        kept = min(1 + int(np.searchsorted(energy, self.share * energy[-1])), int(np.sum(size > 1e-10 * size[0])), count // 2)
        scores = scores[:, :kept]
        slope = scores.T @ y
        mean = y_mean + ((feature - x_mean) @ x.T @ scores / size[:kept]) @ slope
        leverage = part + np.sum(scores ** 2, 1)
        left_out = (y - scores @ slope) / (root * np.maximum(1.0 - leverage, 1e-6)[:, None])
        sigma = np.sqrt(part @ left_out ** 2)
        return Gaussian(mean, np.maximum(sigma, self.floor) ** 2).loosened(self.loosening)


@dataclass(frozen=True, eq=False)
class Nearest:
    """The frame that followed the nearest segment, believed within `spread` (D,) standard deviations."""

    spread: np.ndarray = field(default_factory=lambda: 10.0 * FLOOR)

    def believe(self, feature: np.ndarray, near: Neighbourhood, memory: Memory) -> Gaussian:
        """See `LocalModel`."""
        return Gaussian(near.Y[0].astype(float), np.asarray(self.spread) ** 2)


def _components(gram):
    """Eigenvalues and eigenvectors (columns) of a positive matrix, the greatest first."""
    values, vectors = np.linalg.eigh(gram)
    return np.maximum(values[::-1], 0.0), vectors[:, ::-1]
