"""Style-based inverse kinematics (Grochow, Martin, Hertzmann & Popović 2004): a scaled Gaussian process latent variable model.

A Gaussian process maps a latent place x to a frame's columns, its features y: f(x) with one variance σ²(x), scaled by
w_k for each. Learning finds x, w and the kernel of an active set; reconstruction finds the frame and its x together
(their sections 5 and 6). Their features hold velocities as well; on takes of many kinds those blurred all the rest, so
here a second belief, that a frame is not far from the one before, keeps the motion in one piece.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from scipy.optimize import minimize

from ..database import Database
from ..regression import FLOOR, Gaussian, Memory, Solver

_CANDIDATES = 4000


@dataclass(frozen=True, eq=False)
class Process:
    """A learnt process. latent: (N, q). features: (N, F), less their mean. mean: (F,). scales: (F,) w.

    kernel: (α, β, γ) of α exp(−γ|x − x'|² / 2) + δ / β. energy: its negative log posterior.
    floor: (F,) standard deviation that comes on top. loosening: of the variance.
    """

    latent: np.ndarray
    features: np.ndarray
    mean: np.ndarray
    scales: np.ndarray
    kernel: tuple[float, float, float]
    energy: float
    floor: np.ndarray | float = 0.0
    loosening: float = 1.0
    _inverse: np.ndarray = field(init=False, repr=False)
    _map: np.ndarray = field(init=False, repr=False)

    def __post_init__(self):
        alpha, beta, gamma = self.kernel
        away = np.sum((self.latent[:, None] - self.latent) ** 2, -1)
        inverse = np.linalg.inv(alpha * np.exp(-gamma / 2 * away) + np.eye(len(away)) / beta)
        object.__setattr__(self, "_inverse", inverse)
        object.__setattr__(self, "_map", inverse @ self.features)

    def predict(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """At a latent place (q,): features (F,), their variances σ² / w² + floor² (F,), and both's derivatives (F, q)."""
        alpha, beta, gamma = self.kernel
        away = x - self.latent
        k = alpha * np.exp(-gamma / 2 * np.sum(away ** 2, 1))
        slope = -gamma * k[:, None] * away
        drawn = self._inverse @ k
        scale = self.loosening / self.scales ** 2
        variance = scale * max(alpha + 1 / beta - k @ drawn, 0.0) + self.floor ** 2
        return self.mean + k @ self._map, variance, self._map.T @ slope, np.outer(scale, -2.0 * drawn @ slope)

    def misfit(self, x: np.ndarray, y: np.ndarray) -> float:
        """Σ (y − f(x))² / 2σ² + ln σ + |x|² / 2 of features (F,) at a latent place."""
        mean, variance, _, _ = self.predict(x)
        return float(np.sum((y - mean) ** 2 / variance + np.log(variance)) / 2 + x @ x / 2)

    def near(self, step: np.ndarray) -> np.ndarray:
        """A latent step, no longer than the kernel sees: farther off nothing is known, and no slope leads back."""
        return step * min(1.0, 0.5 / (np.sqrt(self.kernel[2]) * max(np.linalg.norm(step), 1e-9)))

    def place(self, y: np.ndarray, x: np.ndarray, steps: int = 4) -> np.ndarray:
        """The latent place (q,) of features (F,): damped Gauss-Newton of `misfit` from x."""
        best, damping = self.misfit(x, y), 1e-3
        for _ in range(steps):
            mean, variance, slope, widening = self.predict(x)
            error, widening = y - mean, widening / variance[:, None]
            gradient = -slope.T @ (error / variance) + (1 - error ** 2 / variance) @ widening / 2 + x
            curve = slope.T @ (slope / variance[:, None]) + widening.T @ widening / 2 + np.eye(len(x))
            step = self.near(np.linalg.solve(curve + damping * np.diag(np.diag(curve)), -gradient))
            reached = self.misfit(x + step, y)
            if reached < best:
                x, best, damping = x + step, reached, damping / 4
            else:
                damping = max(10 * damping, 0.1)
        return x


def learn(features: np.ndarray, dimensions: int = 3, iterations: int = 300) -> Process:
    """The process of an active set's features (N, F), by L-BFGS from their principal components.

    Minimises (F/2) ln|K| + ½ Σ w_k² y_kᵀK⁻¹y_k + ½ Σ|x|² + ln αβγ − N Σ ln w_k; w has a closed form.
    """
    mean = features.mean(0)
    y = features - mean
    count = len(y)
    u, size, _ = np.linalg.svd(y / np.maximum(y.std(0), 1e-6), full_matrices=False)
    start = np.zeros((count, dimensions))
    start[:, :min(dimensions, len(size))] = u[:, :dimensions] * np.sqrt(count)
    away = np.sum((start[:, None] - start) ** 2, -1)[np.triu_indices(count, 1)]
    begin = np.concatenate([start.ravel(), np.log([1.0, 0.05, 1.0 / max(np.median(away), 1e-6)])])
    found = minimize(energy, begin, (y, dimensions), jac=True, method="L-BFGS-B", options={"maxiter": iterations},
                     bounds=[(None, None)] * start.size + [(0.0, 0.0), (-9.0, 3.0), (-6.0, 6.0)])  # w has α's size already
    x, (alpha, noise, gamma) = found.x[:-3].reshape(count, dimensions), np.exp(found.x[-3:])
    kernel = alpha * np.exp(-gamma / 2 * np.sum((x[:, None] - x) ** 2, -1)) + noise * np.eye(count)
    return Process(x, y, mean, _scales(y, np.linalg.solve(kernel, y)), (alpha, 1 / noise, gamma), float(found.fun))


def energy(z: np.ndarray, y: np.ndarray, dimensions: int) -> tuple[float, np.ndarray]:
    """What `learn` minimises, and its gradient. z: N latent places, and the logarithms of α, 1/β, γ. y: (N, F) less its mean."""
    count, width = y.shape
    x, (alpha, noise, gamma) = z[:-3].reshape(count, dimensions), np.exp(z[-3:])
    difference = x[:, None] - x
    away = np.sum(difference ** 2, -1)
    k = alpha * np.exp(-gamma / 2 * away)
    lower = np.linalg.cholesky(k + noise * np.eye(count))
    inverse = np.linalg.inv(lower)
    inverse = inverse.T @ inverse
    solved = inverse @ y
    w = _scales(y, solved)
    value = (width * np.sum(np.log(np.diag(lower))) + 0.5 * np.sum(w ** 2 * np.sum(y * solved, 0))
             + 0.5 * np.sum(x ** 2) + np.log(alpha / noise * gamma) - count * np.sum(np.log(w)))
    by_kernel = 0.5 * (width * inverse - (solved * w ** 2) @ solved.T)
    pulled = by_kernel * k
    by_x = -2 * gamma * np.einsum("ij,ijq->iq", pulled, difference) + x
    by_log = np.array([pulled.sum(), noise * np.trace(by_kernel), -gamma / 2 * np.sum(pulled * away)]) + [1.0, -1.0, 1.0]
    return float(value), np.concatenate([by_x.ravel(), by_log])


def _scales(y, solved):
    """The w (F,) that are best for a kernel, whose inverse times y is given."""
    return np.sqrt(len(y) / np.maximum(np.sum(y * solved, 0), 1e-9))


def active_set(features: np.ndarray, count: int) -> np.ndarray:
    """Numbers (count,) of features (N, F) that lie far from each other, the first nearest to the mean."""
    chosen = [int(np.argmin(np.sum((features - features.mean(0)) ** 2, 1)))]
    least = np.full(len(features), np.inf)
    while len(chosen) < min(count, len(features)):
        least = np.minimum(least, np.sum((features - features[chosen[-1]]) ** 2, 1))
        chosen.append(int(np.argmax(least)))
    return np.array(chosen)


@dataclass(frozen=True, eq=False)
class SGPLVM:
    """The prior of a process. rounds: how often frame and latent place take turns.

    change: (D,) how far a frame is from the one before, as a standard deviation.
    """

    process: Process
    solver: Solver
    change: np.ndarray
    rounds: int = 3

    @staticmethod
    def of(database: Database, solver: Solver, active: int = 150, dimensions: int = 3,
           loosening: float = 10.0, apart: float = 1.0, seed: int = 0) -> SGPLVM:
        """Learnt from `active` frames of a database, chosen to be diverse: a kernel matrix of more is too slow.

        apart: `change`, as a multiple of what the database has.
        """
        last = database.segments(1)
        last = np.random.default_rng(seed).permutation(last)[:_CANDIDATES]
        frames = database.frames[last + 1].astype(float)
        change = np.sqrt(np.mean((frames - database.frames[last]) ** 2, 0)) + FLOOR
        process = learn(frames[active_set(frames / np.maximum(frames.std(0), 1e-6), active)], dimensions)
        return SGPLVM(replace(process, floor=FLOOR, loosening=loosening), solver, apart * change)

    def believe(self, memory: Memory, seen: np.ndarray, goals: np.ndarray) -> tuple[Gaussian, Any]:
        """See `method.Prior`. The hint is the latent place."""
        before = memory.frames[0]
        away = self.process.scales * (self.process.features + self.process.mean - before)
        # from the nearest active frame too: the way there may lead over places where nothing is known
        places = [self.process.latent[np.argmin(np.sum(away ** 2, 1))], *([] if memory.hint is None else [memory.hint])]
        x = min((self.process.place(before, place) for place in places), key=lambda x: self.process.misfit(x, before))
        for _ in range(self.rounds - 1):
            frame = self.solver.solve(self._around(x, before), goals).frame
            x = self.process.place(frame, x)
        return self._around(x, before), x

    def _around(self, x, before):
        """What is believed of the frame where x may move a little: linear in x, so that both are found at once.

        Given x, process and last frame are two beliefs; where they disagree, x had better move.
        """
        mean, here, slope, _ = self.process.predict(x)
        gap, there = mean - before, self.change ** 2
        weighted = slope / (here + there)[:, None]
        free = np.linalg.inv(np.eye(len(x)) + slope.T @ weighted)
        move = self.process.near(-free @ (x + weighted.T @ gap))
        share = here / (here + there)  # of the last frame's belief
        slope = slope * (1.0 - share)[:, None]
        return Gaussian(mean - share * gap + slope @ move, share * there, np.linalg.cholesky(free).T @ slope.T)
