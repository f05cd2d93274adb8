"""The network that says what standing got wrong of a calibration, and how sure that is, from what standing and moving told."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .... import assets
from ...files import ArraysError, arrays
from ..baselines import Adam, backward, forward, starting
from ..trackers import Moments
from .simulated import INPUTS, TARGETS, drawn
from .stood import STANDING_INPUTS, WORN

SHIPPED = assets.path("reconstruction", "calibration.npz")
"""Learnt from CMU's motion; see PROVENANCE.md beside it."""
HIDDEN = (256, 256)
WIDTHS = (INPUTS, *HIDDEN, 2 * TARGETS)
CLIPPED = 4.0
"""No input counts for more deviations from its mean than this."""
STRANGE = 2.5
"""Moving whose inputs are off their means by more deviations squared than this, on the average, is like nothing that was learnt from: people's have about 1."""
VERSION = 1
"""Of what the numbers in a file mean."""
_DRAWN, _SIZE, _ROUNDS, _RATE, _DECAY, _BLUR = 400, 256, 20, 6e-4, 0.05, 0.1
"""Performers drawn at once and in a batch; how often each is learnt from; the rate; what weights lose, a share of that; how much inputs are blurred."""


@dataclass(frozen=True, eq=False)
class CalibrationNetwork:
    """weights, biases: of its layers, float32, ReLU between them. ins: (2, INPUTS) mean and deviation of inputs. people: how many it was learnt from."""

    weights: tuple[np.ndarray, ...]
    biases: tuple[np.ndarray, ...]
    ins: np.ndarray
    people: int = 0

    def predict(self, inputs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """What standing got wrong (B, TARGETS), see `simulated.numbers`, and standard deviations (B, TARGETS) of what is left, of inputs (B, INPUTS)."""
        found = forward(self.weights, self.biases, scaled(inputs, self.ins))[0].astype(float)
        return found[:, :TARGETS], np.exp(np.clip(found[:, TARGETS:], -6.0, 3.0))

    def strange(self, inputs: np.ndarray) -> np.ndarray:
        """Whether moving (B,) was so unlike what it was learnt from that nothing is to be told of it."""
        return np.mean(scaled(inputs, self.ins)[:, STANDING_INPUTS:-1] ** 2, -1) > STRANGE

    def save(self, path: str | Path) -> None:
        """Write it as an .npz file of half-precision weights."""
        layers = {f"weights{i}": w.astype(np.float16) for i, w in enumerate(self.weights)}
        layers |= {f"biases{i}": b.astype(np.float32) for i, b in enumerate(self.biases)}
        with Path(path).open("wb") as file:
            np.savez_compressed(file, version=VERSION, worn=np.array(WORN), ins=self.ins.astype(np.float32), people=self.people, **layers)  # type: ignore[arg-type]

    @staticmethod
    def load(path: str | Path = SHIPPED) -> CalibrationNetwork:
        """Read what `save` wrote. ArraysError, naming the file and what is wrong with it, for anything else."""
        found = arrays(path, "network of a calibration", {"version": VERSION, "worn": [*WORN]}, "scripts/build/calibration/network.py")
        wanted = {"ins": (2, INPUTS), "people": ()}
        for i, shape in enumerate(zip(WIDTHS, WIDTHS[1:], strict=False)):
            wanted |= {f"weights{i}": shape, f"biases{i}": shape[1:]}
        for name, shape in wanted.items():
            if name not in found or found[name].shape != shape:
                raise ArraysError(f"{path}: {name} of shape {found[name].shape if name in found else None}, expected {shape}")
            if not np.isfinite(found[name]).all():
                raise ArraysError(f"{path}: {name} has numbers that are not finite")
        weights, biases = (tuple(found[f"{kind}{i}"].astype(np.float32) for i in range(len(WIDTHS) - 1)) for kind in ("weights", "biases"))
        return CalibrationNetwork(weights, biases, found["ins"].astype(float), int(found["people"]))


def scaled(inputs: np.ndarray, ins: np.ndarray) -> np.ndarray:
    """Inputs (B, INPUTS) as the first layer sees them."""
    return np.clip((inputs - ins[0]) / ins[1], -CLIPPED, CLIPPED).astype(np.float32)


def loss(found: np.ndarray, truth: np.ndarray, tells: np.ndarray) -> tuple[float, np.ndarray]:
    """The mean squared error of outputs (B, 2 TARGETS) where there is something to tell (B, TARGETS), and the slopes to learn by: what is said by
    its squared error, its sureness by the likelihood of that error, which does not touch the first."""
    count = max(int(tells.sum()), 1)
    error, level = np.where(tells, found[:, :TARGETS] - truth, 0.0), np.clip(found[:, TARGETS:], -6.0, 3.0)
    surprise = np.where(tells, 1.0 - (error * np.exp(-level)) ** 2, 0.0)
    return float(np.sum(error ** 2)) / count, np.concatenate([2.0 * error, np.clip(surprise, -9.0, 1.0)], -1) / count


def learnt(moments: Moments, people: int, seed: int = 0, progress: Callable[[str, int, int, float], None] | None = None) -> CalibrationNetwork:
    """A network learnt from so many simulated performers; the same for the same seed.

    progress: called with what is done, how much of it, of how much, and the mean squared error.
    """
    told = progress or (lambda *_: None)
    inputs, truth, tells = np.empty((people, INPUTS), np.float32), np.empty((people, TARGETS), np.float32), np.empty((people, TARGETS), bool)
    for number, begin in enumerate(range(0, people, _DRAWN)):
        those = drawn(moments, min(_DRAWN, people - begin), seed, number)
        part = slice(begin, begin + len(those.inputs))
        inputs[part], truth[part], tells[part] = those.inputs, those.truth, those.tells
        told("drawn", part.stop, people, 0.0)
    ins = np.stack([inputs.mean(0, dtype=float), np.maximum(inputs.std(0, dtype=float), 1e-3)])
    rng = np.random.default_rng([seed, 1])
    values, depth = starting(WIDTHS, rng), len(WIDTHS) - 1
    batches = _ROUNDS * max(1, people // _SIZE)
    adam, errors = Adam(values, batches, _RATE), []
    for batch in range(batches):
        chosen = rng.integers(0, people, _SIZE)
        x = scaled(inputs[chosen], ins)
        x += np.float32(_BLUR) * rng.standard_normal(x.shape, np.float32)
        found, seen, own = forward(values[:depth], values[depth:], x)
        error, slopes = loss(found.astype(float), truth[chosen], tells[chosen])
        slopes = backward(values[:depth], seen, own, slopes.astype(np.float32))
        rate = adam.rate * 0.5 * (1.0 + np.cos(np.pi * batch / batches))
        adam.step(slopes)
        for weights in values[:depth]:
            weights -= np.float32(_DECAY * rate) * weights
        errors.append(error)
        if (batch + 1) % 200 == 0 or batch + 1 == batches:
            told("batch", batch + 1, batches, float(np.mean(errors)))
            errors.clear()
    return CalibrationNetwork(tuple(values[:depth]), tuple(values[depth:]), ins, people)
