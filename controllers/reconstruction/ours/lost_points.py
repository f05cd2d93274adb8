"""What lost points very likely are: their mean given those that are seen, by the points' moments in recordings."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..baselines import Samples
from ..regression import in_world
from .networks import LAGS, draw, view

NOISE = 0.02
"""How far off [m] seen inputs are taken to be: the points of other bodies, of other motion."""
_SAMPLED = 20_000


@dataclass(frozen=True, eq=False)
class LostPoints:
    """Of what networks see (`learning.view`). mean: (P,) [m]. covariance: (P, P)."""

    mean: np.ndarray
    covariance: np.ndarray

    @staticmethod
    def of(samples: Samples) -> LostPoints:
        """Told from some of the samples."""
        inputs, _ = draw(samples, np.random.default_rng(0).permutation(len(samples))[:_SAMPLED])
        return LostPoints(inputs.mean(0), np.cov(inputs.T))

    def given(self, inputs: np.ndarray, known: np.ndarray) -> np.ndarray:
        """Inputs (P,) where they are known (P,) bool, and elsewhere their conditional mean, if all were normal."""
        out = np.where(known, inputs, self.mean)
        if known.any() and not known.all():
            seen = self.covariance[np.ix_(known, known)] + NOISE ** 2 * np.eye(known.sum())
            out[~known] += self.covariance[np.ix_(~known, known)] @ np.linalg.solve(seen, (inputs - self.mean)[known])
        return out

    def complete(self, points: np.ndarray, known: np.ndarray, heading: float) -> np.ndarray:
        """Points (len(LAGS), n, 3) [m] in the world, where they are not known (len(LAGS), n) told from the others.

        Their places so far only tell where the middle is that all are seen from, and after the first pass no longer.
        What is told is no more than that: it never runs away, as the body's own places would that follow from it.
        """
        if known.all():
            return points
        for _ in range(2):
            inputs, ground = view(points, np.asarray(heading))
            told = self.given(inputs, np.repeat(known.ravel(), 3)).reshape(points.shape)
            points = np.where(known[..., None], points, in_world(told, ground))
        return points

    def save(self, path: Path) -> None:
        """Write them as an .npz file."""
        with path.open("wb") as file:
            np.savez(file, mean=self.mean, covariance=self.covariance)

    @staticmethod
    def load(path: Path) -> LostPoints:
        """Read what `save` wrote. OSError or ValueError for anything else."""
        with np.load(path) as file:
            if file["mean"].shape[0] % (3 * len(LAGS)) or file["covariance"].shape != 2 * file["mean"].shape:
                raise ValueError(f"{path}: holds no moments")
            return LostPoints(file["mean"], file["covariance"])
