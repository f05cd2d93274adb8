"""The network itself: layers from what trackers say to a placed pose and four contacts, how far off it is, and its file."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .... import assets
from ...files import ArraysError, arrays
from ..ours import layer_kernel
from ..pose_vector import ANGLES, WIDTH
from .slots import INPUTS, PLACES

SHIPPED = assets.path("reconstruction", "trackers.npz")
"""Learnt from CMU's motion; see PROVENANCE.md beside it."""
OUTPUTS = WIDTH + 4
VERSION = 1
"""Of what the numbers in a file mean."""


@dataclass(frozen=True, eq=False)
class Network:
    """weights, biases: of the layers, float32 (inputs, outputs) and (outputs,), ReLU between them. outs: (2, WIDTH) mean and
    deviation of placed poses. kinds: (K, 2 S) bool, for which trackers, placed and turned, `factors` (K, R, WIDTH) and `rests`
    (K, WIDTH) are known: rows whose squares sum up to the errors' covariance, and what is left of it. lower, upper: (ANGLES,) the range
    of joints' rotation vectors in recordings [rad]. learnt: batches.
    """

    weights: tuple[np.ndarray, ...]
    biases: tuple[np.ndarray, ...]
    outs: np.ndarray
    kinds: np.ndarray
    factors: np.ndarray
    rests: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    learnt: int = 0

    def predict(self, inputs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Placed poses (..., WIDTH) and the probabilities (..., 4) that heels and balls stand, for inputs (..., INPUTS)."""
        x = np.ascontiguousarray(inputs, np.float32)
        last = len(self.weights) - 1
        for number, (weights, biases) in enumerate(zip(self.weights, self.biases, strict=True)):
            if x.ndim == 1:
                x = layer_kernel(x, weights, biases, number < last)
            else:
                x = x @ weights + biases
                x = np.maximum(x, 0.0) if number < last else x
        found = x.astype(float)
        return found[..., :WIDTH] * self.outs[1] + self.outs[0], 1.0 / (1.0 + np.exp(-np.clip(found[..., WIDTH:], -30.0, 30.0)))

    def spread(self, placed: np.ndarray, turned: np.ndarray) -> np.ndarray:
        """The covariance (WIDTH, WIDTH) of its errors with trackers placed and turned (S,) bool: of the most alike ones that it was told for."""
        apart = (self.kinds != np.concatenate([placed, turned])).sum(-1)
        kind = int(np.argmin(apart))
        factor = self.factors[kind].astype(float)
        return factor.T @ factor + np.diag(self.rests[kind].astype(float))

    def save(self, path: str | Path) -> None:
        """Write it as an .npz file of half-precision numbers."""
        layers: dict[str, Any] = {f"weights{i}": w.astype(np.float16) for i, w in enumerate(self.weights)}
        layers |= {f"biases{i}": b.astype(np.float32) for i, b in enumerate(self.biases)}
        with Path(path).open("wb") as file:
            np.savez_compressed(file, version=VERSION, places=np.array(PLACES), outs=self.outs.astype(np.float32), kinds=self.kinds,
                                factors=self.factors.astype(np.float32), rests=self.rests.astype(np.float32),
                                lower=self.lower.astype(np.float32), upper=self.upper.astype(np.float32), learnt=self.learnt, **layers)

    @staticmethod
    def load(path: str | Path = SHIPPED) -> Network:
        """Read what `save` wrote. ArraysError, naming the file and what is wrong with it, for anything else."""
        found = arrays(path, "network of trackers", {"version": VERSION, "places": [*PLACES]}, "`gambol database tune`")
        count = sum(name.startswith("weights") for name in found)
        try:
            weights, biases = (tuple(found[f"{kind}{i}"].astype(np.float32) for i in range(count)) for kind in ("weights", "biases"))
            outs, factors, rests, lower, upper = (found[name].astype(float) for name in ("outs", "factors", "rests", "lower", "upper"))
            made = Network(weights, biases, outs, found["kinds"], factors, rests, lower, upper, int(found["learnt"]))
        except KeyError as error:
            raise ArraysError(f"{path}: lacks {error}") from None
        made.check(path)
        return made

    def check(self, path: str | Path) -> None:
        """ArraysError, naming the file and the array, for one of the wrong shape or with numbers that are none."""
        width = INPUTS
        for number, (weights, biases) in enumerate(zip(self.weights, self.biases, strict=True)):
            if weights.ndim != 2 or weights.shape[0] != width or biases.shape != weights.shape[1:]:
                raise ArraysError(f"{path}: weights{number} of shape {weights.shape}, expected ({width}, …) and as many biases")
            width = weights.shape[1]
        if width != OUTPUTS:
            raise ArraysError(f"{path}: has {width} outputs, expected {OUTPUTS}")
        kinds = len(self.kinds)
        for name, value, shape in (("outs", self.outs, (2, WIDTH)), ("kinds", self.kinds, (kinds, 2 * len(PLACES))),
                                   ("rests", self.rests, (kinds, WIDTH)), ("lower", self.lower, (ANGLES,)),
                                   ("upper", self.upper, (ANGLES,)), ("factors", self.factors, (kinds, *self.factors.shape[1:2], WIDTH))):
            if value.shape != shape or not kinds:
                raise ArraysError(f"{path}: {name} of shape {value.shape}, expected {shape}")
        for value in (*self.weights, *self.biases, self.outs, self.factors, self.rests, self.lower, self.upper):
            if not np.isfinite(value).all():
                raise ArraysError(f"{path}: has numbers that are not finite")
