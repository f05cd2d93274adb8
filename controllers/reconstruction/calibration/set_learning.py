"""Learning the network that calibrates: performers that are simulated as they are needed, Adam, and a checkpoint now and then from which it
goes on, the same.

What it says is taught by its squared error, what it says of its sureness by the likelihood of that error, which does not touch the first.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from pathlib import Path

import numpy as np

from ..baselines import Adam, backward
from ..trackers import Moments
from .set_network import HEARING, SHAPES, SetNetwork, run
from .simulated import TARGETS, Performances, drawn

SIZE = 96
"""Performers in a batch."""
RATE = 1e-3
MEAN = 0.999
"""What is left of the weights' mean a batch later."""


def loss(found: np.ndarray, truth: np.ndarray, tells: np.ndarray) -> tuple[float, np.ndarray]:
    """The mean squared error of outputs (B, 2 TARGETS) where there is something to tell (B, TARGETS), and derivatives."""
    count = max(int(tells.sum()), 1)
    error, level = np.where(tells, found[:, :TARGETS] - truth, 0.0), np.clip(found[:, TARGETS:], -6.0, 3.0)
    surprise = np.where(tells, 1.0 - (error * np.exp(-level)) ** 2, 0.0)
    return float(np.sum(error ** 2)) / count, np.concatenate([2.0 * error, np.clip(surprise, -9.0, 1.0)], -1) / count


class SetLearner:
    """A network while it is learnt. moments: what performers do. batches: in all; the rate falls to nothing until then. seed: of all that is drawn."""

    def __init__(self, moments: Moments, batches: int, seed: int = 0, size: int = SIZE):
        self.moments, self.seed, self.size = moments, seed, size
        rng = np.random.default_rng([seed, 1])
        values = [rng.normal(0.0, math.sqrt(2.0 / a), (a, b)).astype(np.float32) for a, b in SHAPES]
        values[-1] *= 0.1
        values += [np.zeros(b, np.float32) for _, b in SHAPES]
        self.adam, self.means = Adam(values, batches, RATE), [value.copy() for value in values]

    @property
    def batch(self) -> int:
        """How many are done."""
        return self.adam.batch

    def step(self) -> float:
        """Learn from one batch more. Returns its mean squared error."""
        those = drawn(self.moments, self.size, self.seed, self.batch)
        error, slopes = learnt_by(self.adam.values, those)
        self.adam.step(slopes)
        for mean, value in zip(self.means, self.adam.values, strict=True):
            mean += np.float32(1.0 - MEAN) * (value - mean)
        return error

    def learn(self, path: Path, every: int, progress: Callable[[int, int, float], None] | None = None) -> None:
        """Go on to the last batch, with a checkpoint at path after `every` batches and at the end."""
        errors: list[float] = []
        while self.batch < self.adam.batches:
            errors.append(self.step())
            if self.batch % 50 == 0 and progress is not None:
                progress(self.batch, self.adam.batches, float(np.mean(errors)))
                errors.clear()
            if self.batch % every == 0 or self.batch == self.adam.batches:
                self.save(path)

    def save(self, path: Path) -> None:
        """Write a checkpoint; it is there whole or not at all."""
        kinds = {"values": self.adam.values, "means": self.means, "first": self.adam.first, "second": self.adam.second}
        own = path.with_name(f"{path.name}.{os.getpid()}.part")
        with own.open("wb") as file:
            np.savez(file, batch=self.batch, seed=self.seed, size=self.size,
                     **{f"{kind}{i}": value for kind, some in kinds.items() for i, value in enumerate(some)})  # type: ignore[arg-type]
        os.replace(own, path)

    def resume(self, path: Path) -> None:
        """Go on from a checkpoint. ValueError if it is of another seed, batch or network."""
        with np.load(path) as file:
            if (int(file["seed"]), int(file["size"])) != (self.seed, self.size) or any(
                    f"values{i}" not in file or file[f"values{i}"].shape != value.shape for i, value in enumerate(self.adam.values)):
                raise ValueError(f"{path}: is of another seed, batch size or width; give another folder to begin anew")
            for kind, some in (("values", self.adam.values), ("means", self.means), ("first", self.adam.first), ("second", self.adam.second)):
                for i, value in enumerate(some):
                    value[...] = file[f"{kind}{i}"]
            self.adam.batch = int(file["batch"])

    def network(self) -> SetNetwork:
        """The network as it is now: the weights' mean without its first steps."""
        return SetNetwork(tuple(self.means[:len(SHAPES)]), tuple(self.means[len(SHAPES):]), self.batch)


def learnt_by(values: list[np.ndarray], those: Performances) -> tuple[float, list[np.ndarray]]:
    """The mean squared error of a network's weights and biases, and derivatives of the loss by all of them."""
    depth, count = len(HEARING), len(SHAPES)
    weights, biases = values[:count], values[count:]
    found, share, said = run(weights, biases, those.frames, those.heard, those.stood.inputs)
    error, slope = loss(said[-1].astype(float), those.truth, those.tells)
    slope = slope.astype(np.float32)
    saying = backward(weights[depth:], said, slope)
    for number in range(count - 1, depth - 1, -1):
        slope = slope @ weights[number].T
        if number > depth:
            slope *= said[number - depth] > 0
    back = slope[:, None, :HEARING[-1]] * share[..., None]
    back = back.reshape(-1, HEARING[-1]) * (found[-1] > 0)
    hearing = backward(weights[:depth], found, back)
    return error, [*hearing[:depth], *saying[:count - depth], *hearing[depth:], *saying[count - depth:]]
