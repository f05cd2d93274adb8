"""What pose comes next, learnt from the neighbours of the last ones: weighted local regression (Mousas 2014, 4.1).

The paper regresses each degree of freedom by itself on the past frames. All of them share the same regressors,
so in the dual form they share one K × K factorisation as well. Its eigenvectors of C_ω (eq. 8) need no eigen-solver:
C_ω has rank one, and its one eigenvector is the direction of weighted least squares (`form="projection"`).
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.linalg import get_lapack_funcs

from ..pose_vector import FORWARD, HEIGHT, LEFTWARD, WIDTH, YAW_RATE
from .beliefs import Gaussian, compact
from .frame_kernel import regress_kernel

BANDWIDTHS = ("knn", "paper")
FORMS = ("auto", "dual", "primal", "projection")
COVARIANCES = ("diagonal", "full")
FLOOR = np.full(WIDTH, np.radians(0.3))
"""Least standard deviation of each column of the chart: 0.3° of every angle, 2 mm of height, and as much in a 60th second."""
FLOOR[HEIGHT], FLOOR[YAW_RATE], FLOOR[[FORWARD, LEFTWARD]] = 0.002, 60.0 * np.radians(0.3), 60.0 * 0.002
FLOOR.setflags(write=False)


@dataclass(frozen=True, eq=False)
class Regression:
    """How to learn from a neighbourhood.

    bandwidth: "knn" weights neighbours by their distance relative to the median one; "paper" by the distance itself
    (eq. 7, W the identity, radians). ridge: ρ, relative to the regressors' mean square over the neighbours.
    floor: least standard deviation, one for all or (D,). loosening: how many times larger than the leave-one-out
    covariance the belief's is; one step's error is far too small for a method that runs on its own output.
    form: "dual" (K × K), "primal" (P × P), "projection" (the paper's, eq. 8 and 9), or "auto", the smaller one.
    covariance: "diagonal" as in the paper, or "full": that the errors of joints go together.
    """

    bandwidth: str = "knn"
    ridge: float = 1e-2
    floor: float | np.ndarray = field(default_factory=lambda: FLOOR)
    loosening: float = 1000.0
    form: str = "auto"
    covariance: str = "diagonal"

    def __post_init__(self):
        for name, known in (("bandwidth", BANDWIDTHS), ("form", FORMS), ("covariance", COVARIANCES)):
            if getattr(self, name) not in known:
                raise ValueError(f"{name} '{getattr(self, name)}' is not known: there are {', '.join(known)}")
        for name in ("ridge", "floor", "loosening"):
            if not np.all(np.asarray(getattr(self, name)) > 0.0) or not np.all(np.isfinite(getattr(self, name))):
                raise ValueError(f"{name} must be above zero, not {getattr(self, name)}")


PAPER = Regression(bandwidth="paper", ridge=1e-4, loosening=1.0, form="projection")
"""As near to the letter as runs: without any ridge XᵀDX is singular, since there are fewer neighbours than regressors."""


@dataclass(frozen=True, eq=False)
class Fit:
    """A local regression at a query. mean: (D,). residuals: (K, D) of each neighbour, predicted by the others. weights: (K,)."""

    mean: np.ndarray
    residuals: np.ndarray
    weights: np.ndarray

    @property
    def sigma(self) -> np.ndarray:
        """The weighted standard deviation of the residuals (D,)."""
        return np.sqrt(self.weights @ self.residuals ** 2 / self.weights.sum())


def weights(distances: np.ndarray, bandwidth: str = "knn") -> np.ndarray:
    """The weight ω (K,) of each neighbour at its distance (K,) from the query (eq. 7), the nearest one's being 1.

    That common factor changes no regression, and keeps all of them from vanishing where the query lies far off.
    None falls below a millionth, which is as good as nothing but can be divided by.
    """
    square = np.asarray(distances, float) ** 2
    if bandwidth == "knn":
        square = square / max(np.partition(square, len(square) // 2)[len(square) // 2], 1e-12)
    return np.maximum(np.exp(-0.5 * (square - square.min())), 1e-6)


def regress(query: np.ndarray, X: np.ndarray, Y: np.ndarray, distances: np.ndarray | None = None,
            how: Regression = Regression()) -> Gaussian:
    """The belief about the frame after `query` (P,), from K segments X (K, P) and the frames Y (K, D) after them.

    distances: (K,) of X from the query; their Euclidean ones by default. The usual settings are compiled, and as exact.
    """
    if distances is not None and 2 <= len(X) and how.covariance == "diagonal" and (
            how.form == "dual" or how.form == "auto" and len(X) <= X.shape[1]):
        mean, variance = np.empty(Y.shape[1]), np.empty(Y.shape[1])
        floor = np.empty_like(mean)
        floor[:] = how.floor
        whole = (np.ascontiguousarray(value, X.dtype) for value in (query, X, Y, distances))
        if regress_kernel(*whole, how.bandwidth == "knn", how.ridge, floor, mean, variance):
            return Gaussian(mean, variance).loosened(how.loosening)
    return believe(fit(query, X, Y, distances, how), how)


def believe(fitted: Fit, how: Regression) -> Gaussian:
    """The belief that a fit amounts to: leave-one-out covariance, never below the floor, loosened."""
    if how.covariance == "full":
        errors = fitted.residuals * np.sqrt(fitted.weights / fitted.weights.sum())[:, None]
        variance = np.broadcast_to(np.asarray(how.floor) ** 2, fitted.mean.shape)
        return Gaussian(fitted.mean, variance, compact(errors)).loosened(how.loosening)
    return Gaussian(fitted.mean, np.maximum(fitted.sigma, how.floor) ** 2).loosened(how.loosening)


def fit(query: np.ndarray, X: np.ndarray, Y: np.ndarray, distances: np.ndarray | None = None,
        how: Regression = Regression()) -> Fit:
    """Weighted ridge regression of Y (K, D) on X (K, P), and its leave-one-out residuals in closed form.

    Computed in X's float type. Means are weighted, and are left out with the point that is left out; λ stays.
    ValueError for fewer than two neighbours.
    """
    if len(X) < 2:
        raise ValueError(f"a local regression needs two neighbours or more, not {len(X)}")
    away: np.ndarray = np.linalg.norm(X - query, axis=1) if distances is None else distances
    omega = weights(away, how.bandwidth).astype(X.dtype)
    share = omega / omega.sum()
    root = np.sqrt(omega)
    x_mean, y_mean = share @ X, share @ Y
    x, y, ahead = root[:, None] * (X - x_mean), root[:, None] * (Y - y_mean), query - x_mean
    ridge = max(how.ridge * float(np.einsum("kp,kp->", x, x)) / len(X), 1e-9)
    form = how.form if how.form != "auto" else "dual" if len(X) <= X.shape[1] else "primal"
    step, residuals = {"dual": _dual, "primal": _primal, "projection": _projection}[form](x, y, ahead, root, ridge)
    return Fit(y_mean + step, residuals, omega)


def _dual(x, y, ahead, root, ridge):
    """The prediction less the mean, and leave-one-out residuals, through the K × K Gram matrix.

    The constant is not shrunk: its direction, `root`, which x and y are orthogonal to, gets the Gram matrix' own
    size instead of λ, so that taking its share from the inverse's diagonal costs no digits.
    """
    gram = x @ x.T
    size = gram.trace() / len(x) + ridge
    square = root @ root
    gram += (size / square) * np.outer(root, root)
    gram[np.diag_indices(len(x))] += ridge
    inverse = _inverse(gram)
    solved = inverse @ y
    left = inverse.diagonal() - root ** 2 / (square * (size + ridge))
    return (ahead @ x.T) @ solved, solved / (left * root)[:, None]


def _primal(x, y, ahead, root, ridge):
    """As `_dual`, through the P × P covariance."""
    inverse = _covariance_inverse(x, ridge)
    coefficients = inverse @ (x.T @ y)
    return ahead @ coefficients, _left_out(x, y, root, inverse, coefficients)


def _projection(x, y, ahead, root, ridge):
    """The paper's way, one degree of freedom after the other: eq. (8)'s eigenvector u, then eq. (9) along it.

    C_ω = G⁻¹b bᵀ with G = XᵀDX + λ and b = XᵀDy: its eigenvector is G⁻¹b, here of unit length uᵀGu = 1.
    """
    gram = x.T @ x + ridge * np.eye(x.shape[1], dtype=x.dtype)
    inverse = _inverse(gram)
    coefficients = np.zeros((x.shape[1], y.shape[1]), x.dtype)
    for d, b in enumerate((x.T @ y).T):
        u = inverse @ b
        length = u @ b
        if length > 0.0:
            u /= np.sqrt(length)
            coefficients[:, d] = u * ((u @ b) / (u @ gram @ u))
    return ahead @ coefficients, _left_out(x, y, root, inverse, coefficients)


def _left_out(x, y, root, inverse, coefficients):
    """Residuals (K, D) of points that are left out, one at a time: residual / (1 − leverage)."""
    leverage = root ** 2 / (root @ root) + np.einsum("kp,pq,kq->k", x, inverse, x, optimize=True)
    return (y - x @ coefficients) / (np.maximum(1.0 - leverage, 1e-9) * root)[:, None]


def _covariance_inverse(x, ridge):
    return _inverse(x.T @ x + ridge * np.eye(x.shape[1], dtype=x.dtype))


def _inverse(matrix):
    """The inverse of a positive definite matrix, by Cholesky."""
    potrf, potri = get_lapack_funcs(("potrf", "potri"), (matrix,))
    lower, failed = potrf(matrix, lower=True)
    if failed:
        return np.linalg.pinv(matrix, hermitian=True)
    half, _ = potri(lower, lower=True)  # above the diagonal it is zero, as potrf left it
    diagonal = half.diagonal().copy()
    half = half + half.T
    half[np.diag_indices(len(half))] = diagonal
    return half
