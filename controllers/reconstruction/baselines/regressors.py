"""Global regressors from the points' last half second to the frame: a ridge regression, and a small network."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..regression import FLOOR, Gaussian, Memory, compact
from .windows import Samples, window

_CHUNK = 8192


@dataclass(frozen=True, eq=False)
class Layers:
    """A network of fully connected layers, ReLU between them; one layer alone is a linear map.

    weights, biases: of the layers, (inputs, outputs) and (outputs,). ins, outs: (2, …) mean and deviation of inputs
    and outputs. errors: (D, D) whose rows' squares sum up to its errors' covariance on recordings that it did not see.
    loosening: of that covariance.
    """

    weights: tuple[np.ndarray, ...]
    biases: tuple[np.ndarray, ...]
    ins: np.ndarray
    outs: np.ndarray
    errors: np.ndarray
    loosening: float = 10.0

    def predict(self, inputs: np.ndarray) -> np.ndarray:
        """Frames (..., D) for inputs (..., P)."""
        return forward(self.weights, self.biases, (inputs - self.ins[0]) / self.ins[1])[0] * self.outs[1] + self.outs[0]

    def believe(self, memory: Memory, seen: np.ndarray, goals: np.ndarray) -> tuple[Gaussian, Any]:
        """See `method.Prior`."""
        mean = self.predict(window(memory, seen).astype(np.float32)).astype(float)
        return Gaussian(mean, FLOOR ** 2, self.errors).loosened(self.loosening), None

    def save(self, path: str | Path) -> None:
        """Write it as an .npz file."""
        arrays: dict[str, Any] = {f"weights{i}": w for i, w in enumerate(self.weights)}
        arrays |= {f"biases{i}": b for i, b in enumerate(self.biases)}
        with Path(path).open("wb") as file:
            np.savez(file, ins=self.ins, outs=self.outs, errors=self.errors, loosening=self.loosening, **arrays)

    @staticmethod
    def load(path: str | Path) -> Layers:
        """Read what `save` wrote. OSError or ValueError for anything else."""
        with np.load(path) as file:
            if "outs" not in file:
                raise ValueError(f"{path}: is no regressor")
            count = sum(name.startswith("weights") for name in file)
            return Layers(tuple(file[f"weights{i}"] for i in range(count)), tuple(file[f"biases{i}"] for i in range(count)),
                          file["ins"], file["outs"], file["errors"], float(file["loosening"]))


def ridge(samples: Samples, strength: float = 1e-3, seed: int = 0) -> Layers:
    """Ridge regression on every sample; λ is `strength` times their number."""
    learnt, rest = _split(samples)
    rng = np.random.default_rng(seed)
    ins, outs = _standard(samples, learnt, rng)
    size = len(ins[0])
    gram, across = np.zeros((size, size)), np.zeros((size, len(outs[0])))
    for chosen in _chunks(learnt):
        x, y = samples.draw(chosen, rng)
        x, y = (x - ins[0]) / ins[1], (y - outs[0]) / outs[1]
        gram += x.T @ x
        across += x.T @ y
    slope = np.linalg.solve(gram + strength * len(learnt) * np.eye(size), across)
    return _judged(samples, rest, Layers((slope,), (np.zeros(len(outs[0])),), ins, outs, np.eye(len(outs[0]))))


def network(samples: Samples, hidden: tuple[int, ...] = (384, 384), batches: int = 10_000, size: int = 256,
            rate: float = 1e-3, seed: int = 0,
            progress: Callable[[int, float], None] | None = None) -> Layers:
    """A small network, learnt by Adam (Kingma & Ba 2015) whose rate falls along a cosine; the same from the same seed.

    progress: called with each batch's number and mean squared error.
    """
    learnt, rest = _split(samples)
    rng = np.random.default_rng(seed)
    ins, outs = (a.astype(np.float32) for a in _standard(samples, learnt, rng))
    widths = (len(ins[0]), *hidden, len(outs[0]))
    values = starting(widths, rng)
    count, adam = len(widths) - 1, Adam(values, batches, rate)
    for batch in range(batches):
        x, y = samples.draw(rng.choice(learnt, size), rng)
        x, y = ((x - ins[0]) / ins[1]).astype(np.float32), ((y - outs[0]) / outs[1]).astype(np.float32)
        found, seen, own = forward(values[:count], values[count:], x)
        error = found - y
        adam.step(backward(values[:count], seen, own, error * (2 / error.size)))
        if progress is not None:
            progress(batch, float(np.mean(error ** 2)))
    return _judged(samples, rest, Layers(tuple(values[:count]), tuple(values[count:]), ins, outs, np.eye(widths[-1])))


class Adam:
    """Kingma & Ba 2015, at a rate that falls along a cosine to nothing in `batches` steps. values: changed in place."""

    def __init__(self, values: list[np.ndarray], batches: int, rate: float = 1e-3):
        self.values, self.batches, self.rate, self.batch = values, batches, rate, 0
        self._first, self._second = ([np.zeros_like(value) for value in values] for _ in range(2))

    def step(self, slopes: list[np.ndarray]) -> None:
        """Go on by the loss's derivatives by all values."""
        now = self.rate * 0.5 * (1 + math.cos(math.pi * self.batch / self.batches))
        self.batch += 1
        share, scale = now / (1 - 0.9 ** self.batch), 1 - 0.999 ** self.batch
        for value, slope, first, second in zip(self.values, slopes, self._first, self._second, strict=True):
            first += 0.1 * (slope - first)
            second += 0.001 * (slope * slope - second)
            value -= share * first / (np.sqrt(second / scale) + 1e-8)


def starting(widths: tuple[int, ...], rng: np.random.Generator) -> list[np.ndarray]:
    """The weights and then the biases of layers before any learning (He et al. 2015), the last ones small."""
    weights = [rng.normal(0, np.sqrt(2 / a), (a, b)).astype(np.float32) for a, b in zip(widths, widths[1:], strict=False)]
    weights[-1] *= 0.1
    return [*weights, *(np.zeros(b, np.float32) for b in widths[1:])]


def forward(weights, biases, x, added=False, kept=None):
    """What comes out (B, outputs) of x (B, inputs), and what each layer saw and gave. added: whether layers between the first and the last add to what they
    are given (He et al. 2016). kept: what each hidden layer's sum is multiplied by."""
    seen, own, last = [], [], len(weights) - 1
    for i, (w, b) in enumerate(zip(weights, biases, strict=True)):
        seen.append(x)
        y = x @ w + b
        own.append(np.maximum(y, 0, out=y) if i < last else y)
        x = x + y if added and 0 < i < last else y
        if kept is not None and i < last:
            x = x * kept[i]
    return x, seen, own


def backward(weights, seen, own, slope, added=False, kept=None):
    """Derivatives of the loss by all weights, then all biases, from that by what came out (B, outputs)."""
    by_weights, by_biases, last = [], [], len(weights) - 1
    for i in range(last, -1, -1):
        if kept is not None and i < last:
            slope = slope * kept[i]
        through = slope if i == last else slope * (own[i] > 0)
        by_weights.insert(0, seen[i].T @ through)
        by_biases.insert(0, through.sum(0))
        below = through @ weights[i].T
        slope = below + slope if added and 0 < i < last else below
    return by_weights + by_biases


def _split(samples):
    """Samples to learn from, and those of every twentieth recording to judge by; of a single one, all for both."""
    recordings = np.unique(samples.recording)
    apart = np.isin(samples.recording, recordings[::20])
    if len(recordings) == 1:
        return np.arange(len(samples)), np.arange(len(samples))
    return np.flatnonzero(~apart), np.flatnonzero(apart)


def _chunks(chosen):
    return np.array_split(chosen, max(1, len(chosen) // _CHUNK))


def _standard(samples, learnt, rng):
    """Mean and deviation (2, …) of inputs and outputs, from some samples."""
    drawn = samples.draw(rng.choice(learnt, min(len(learnt), _CHUNK), replace=False), rng)
    return tuple(np.stack([a.mean(0), np.maximum(a.std(0), 1e-3)]) for a in drawn)


def _judged(samples, rest, layers):
    """The same layers with their errors on the samples held out."""
    rng, errors = np.random.default_rng(1), np.zeros((0, len(layers.outs[0])))
    for chosen in _chunks(rest):
        x, y = samples.draw(chosen, rng)
        errors = compact(np.concatenate([errors, (layers.predict(x) - y) / np.sqrt(len(rest))]))
    return replace(layers, errors=errors)
