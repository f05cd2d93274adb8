"""What is believed of the coming frame before its points are seen: normal distributions, and several of them in one."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.linalg import get_lapack_funcs

from ...body import brief
from .frame_kernel import fuse_kernel


@dataclass(frozen=True, eq=False)
class Gaussian:
    """A belief about the next frame of the chart: normal about mean (..., D), covariance diag(variance) + factorᵀ·factor.

    variance: (..., D). factor: (..., R, D); by default R is 0.
    """

    __repr__ = brief

    mean: np.ndarray
    variance: np.ndarray
    factor: np.ndarray = field(default_factory=lambda: np.empty(0))

    def __post_init__(self):
        if self.factor.shape == (0,):
            object.__setattr__(self, "factor", np.zeros((*np.shape(self.mean)[:-1], 0, np.shape(self.mean)[-1])))

    @property
    def covariance(self) -> np.ndarray:
        """(..., D, D)."""
        return (self.variance[..., None] * np.eye(self.variance.shape[-1])
                + np.swapaxes(self.factor, -1, -2) @ self.factor)

    def loosened(self, times: float) -> Gaussian:
        """The same mean, believed less: the covariance `times` as large."""
        return Gaussian(self.mean, self.variance * times, self.factor * np.sqrt(times))


def fuse(*beliefs: Gaussian) -> Gaussian:
    """What independent beliefs (without batch axes) say together: precisions add up.

    A singular one keeps the answer in its subspace. ValueError for none.
    """
    if not beliefs:
        raise ValueError("nothing to fuse")
    together = beliefs[0]
    for belief in beliefs[1:]:
        if belief.factor.size and together.factor.size:
            together = _fuse_full(together, belief)
        elif belief.factor.size:
            together = _fuse_plain(belief, together)
        else:
            together = _fuse_plain(together, belief)
    return together


def _fuse_plain(belief, plain):
    """Fuse with a belief that has no factor: in the small form of the factor's rows.

    The belief is mean + √variance·ε + factorᵀ·η. Given η all columns are apart; and η itself is told from plain.mean.
    """
    if not belief.factor.size:
        gain = belief.variance / (belief.variance + plain.variance)
        return Gaussian(belief.mean + gain * (plain.mean - belief.mean), gain * plain.variance, belief.factor)
    mean, variance = np.empty(len(belief.mean)), np.empty(len(belief.mean))
    given = (np.ascontiguousarray(value, float) for value in
             (belief.mean, belief.variance, belief.factor, plain.mean, plain.variance))
    factor = fuse_kernel(*given, mean, variance)
    return Gaussian(mean, variance, factor)


def _fuse_full(a, b):
    """Fuse two beliefs that both have factors: Σ = Σ₁ − Σ₁(Σ₁ + Σ₂)⁻¹Σ₁."""
    first = a.covariance
    lower = np.linalg.cholesky(first + b.covariance)
    half = _unfold(lower, first)
    mean = a.mean + _unfold(lower, b.mean - a.mean) @ half
    return Gaussian(mean, np.zeros(len(mean)), _rows(first - half.T @ half))


def _unfold(lower, right):
    """L⁻¹ · right for a lower triangular matrix L."""
    trtrs, = get_lapack_funcs(("trtrs",), (lower, right))
    return trtrs(lower, right, lower=True)[0]


def compact(errors: np.ndarray) -> np.ndarray:
    """Rows R (≤ D, D) with RᵀR = EᵀE, for many errors E (K, D)."""
    if len(errors) <= errors.shape[1]:
        return errors
    errors = errors.astype(float)
    return _rows(errors.T @ errors)


def _rows(covariance):
    """Rows R (D, D) with RᵀR = covariance, which may be singular."""
    try:
        return np.linalg.cholesky(covariance).T
    except np.linalg.LinAlgError:
        values, vectors = np.linalg.eigh((covariance + covariance.T) / 2)
        return np.sqrt(np.maximum(values, 0.0))[:, None] * vectors.T
