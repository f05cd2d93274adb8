"""The network itself: layers from what trackers say to a placed pose and four contacts, how far off it is, and its file."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from .... import assets
from ...files import ArraysError, arrays
from ..pose_vector import ANGLES, WIDTH
from .layers import rounded, rounded_kernel
from .slots import INPUTS, PLACES

SHIPPED = assets.path("reconstruction", "trackers.npz")
"""Learnt from CMU's motion; see PROVENANCE.md beside it."""
OUTPUTS = WIDTH + 4
VERSION = 2
"""Of what the numbers in a file mean; the first one had half-precision weights."""


@dataclass(frozen=True, eq=False)
class Network:
    """weights, biases: of the layers, float32 (inputs, outputs) and (outputs,), ReLU between them. outs: (2, WIDTH) mean and
    deviation of placed poses. kinds: (K, 2 S) bool, for which trackers, placed and turned, `factors` (K, R, WIDTH) and `rests`
    (K, WIDTH) are known: rows whose squares sum up to the errors' covariance, and what is left of it. lower, upper: (ANGLES,) the range
    of joints' rotation vectors in recordings [rad]. learnt: batches, of 512 samples. added: whether layers between the first and the last add to
    what they are given.
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
    added: bool = False

    def predict(self, inputs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Placed poses (..., WIDTH) and the probabilities (..., 4) that heels and balls stand, for inputs (..., INPUTS)."""
        x = np.ascontiguousarray(inputs, np.float32)
        last = len(self.weights) - 1
        for number, (weights, biases) in enumerate(zip(self.weights, self.biases, strict=True)):
            if x.ndim == 1:
                y = rounded_kernel(x, *self._rounded[number], biases, number < last)
            else:
                y = x @ weights + biases
                y = np.maximum(y, 0.0) if number < last else y
            x = x + y if self.added and 0 < number < last else y
        found = x.astype(float)
        return found[..., :WIDTH] * self.outs[1] + self.outs[0], 1.0 / (1.0 + np.exp(-np.clip(found[..., WIDTH:], -30.0, 30.0)))

    def spread(self, placed: np.ndarray, turned: np.ndarray) -> np.ndarray:
        """The covariance (WIDTH, WIDTH) of its errors with trackers placed and turned (S,) bool: of the most alike ones that it was told for."""
        apart = (self.kinds != np.concatenate([placed, turned])).sum(-1)
        kind = int(np.argmin(apart))
        factor = self.factors[kind].astype(float)
        return factor.T @ factor + np.diag(self.rests[kind].astype(float))

    def save(self, path: str | Path) -> None:
        """Write it as an .npz file of weights as whole numbers up to 127, with a scale for each output of a layer."""
        layers: dict[str, Any] = {f"biases{i}": b.astype(np.float32) for i, b in enumerate(self.biases)}
        for i, (weights, scales) in enumerate(self._rounded):
            layers |= {f"weights{i}": weights, f"scales{i}": scales}
        with Path(path).open("wb") as file:
            np.savez_compressed(file, version=VERSION, places=np.array(PLACES), outs=self.outs.astype(np.float32), kinds=self.kinds,
                                factors=self.factors.astype(np.float32), rests=self.rests.astype(np.float32), lower=self.lower.astype(np.float32),
                                upper=self.upper.astype(np.float32), learnt=self.learnt, added=self.added, **layers)

    @staticmethod
    def load(path: str | Path = SHIPPED) -> Network:
        """Read what `save` wrote, now or in version 1. ArraysError, naming the file and what is wrong with it, for anything else."""
        found = arrays(path, "network of trackers", {"places": [*PLACES]}, "`gambol database tune`")
        count = sum(name.startswith("weights") for name in found)
        try:
            if found["version"].tolist() not in (1, VERSION):
                raise ArraysError(f"{path}: is of another version of Gambol; `gambol database tune` makes one")
            scales = (found[f"scales{i}"] if f"scales{i}" in found else np.float32(1.0) for i in range(count))
            weights = tuple(np.ascontiguousarray(found[f"weights{i}"] * scale, np.float32) for i, scale in enumerate(scales))
            biases = tuple(found[f"biases{i}"].astype(np.float32) for i in range(count))
            outs, factors, rests, lower, upper = (found[name].astype(float) for name in ("outs", "factors", "rests", "lower", "upper"))
            made = Network(weights, biases, outs, found["kinds"], factors, rests, lower, upper, int(found["learnt"]), bool(found.get("added", False)))
        except KeyError as error:
            raise ArraysError(f"{path}: lacks {error}") from None
        made.check(path)
        return made

    @cached_property
    def _rounded(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """Each layer's weights as they are written, see `rounded`."""
        return [rounded(weights) for weights in self.weights]

    def check(self, path: str | Path) -> None:
        """ArraysError, naming the file and the array, for one of the wrong shape or with numbers that are none."""
        width = INPUTS
        for number, (weights, biases) in enumerate(zip(self.weights, self.biases, strict=True)):
            if weights.ndim != 2 or weights.shape[0] != width or biases.shape != weights.shape[1:]:
                raise ArraysError(f"{path}: weights{number} of shape {weights.shape}, expected ({width}, …) and as many biases")
            if self.added and 0 < number < len(self.weights) - 1 and weights.shape[1] != width:
                raise ArraysError(f"{path}: weights{number} of shape {weights.shape}, expected ({width}, {width})")
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
