"""A network that hears a set of moments: each goes through the same layers, their mean beside what standing told goes through others (deep sets,
Zaheer 2017), and says what standing got wrong, and how sure that is.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from zipfile import BadZipFile

import numpy as np

from .... import assets
from ...files import reason
from ..baselines import forward
from .moved import PER_FRAME
from .simulated import TARGETS
from .stood import STANDING_INPUTS, WORN

SHIPPED = assets.path("reconstruction", "calibration.npz")
"""Learnt from CMU's motion; see PROVENANCE.md beside it."""
HEARING, SAYING = (256, 256), (320, 256)
"""Widths of the layers that hear a moment, and of those that say what all of them told."""
HEARD = HEARING[-1] + STANDING_INPUTS + 1
SHAPES = tuple(zip((PER_FRAME, *HEARING[:-1], HEARD, *SAYING), (*HEARING, *SAYING, 2 * TARGETS), strict=True))
"""Of the weights, (inputs, outputs)."""
VERSION = 1
"""Of what the numbers in a file mean."""


@dataclass(frozen=True, eq=False)
class SetNetwork:
    """weights, biases: of all layers, float32: first those that hear a moment, ReLU after each, then those that say. learnt: batches."""

    weights: tuple[np.ndarray, ...]
    biases: tuple[np.ndarray, ...]
    learnt: int = 0

    def predict(self, frames: np.ndarray, heard: np.ndarray, standing: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """What standing got wrong (B, TARGETS), see `simulated.numbers`, and standard deviations (B, TARGETS) of what is left.

        frames: (B, F, PER_FRAME), those of heard (B, F) bool; there may be none. standing: (B, STANDING_INPUTS).
        """
        found = run(self.weights, self.biases, frames.astype(np.float32), heard, standing)[-1][-1].astype(float)
        return found[:, :TARGETS], np.exp(np.clip(found[:, TARGETS:], -6.0, 3.0))

    def save(self, path: str | Path) -> None:
        """Write it as an .npz file of half-precision numbers."""
        arrays = {f"weights{i}": w.astype(np.float16) for i, w in enumerate(self.weights)}
        arrays |= {f"biases{i}": b.astype(np.float32) for i, b in enumerate(self.biases)}
        with Path(path).open("wb") as file:
            np.savez_compressed(file, version=VERSION, worn=np.array(WORN), learnt=self.learnt, **arrays)  # type: ignore[arg-type]

    @staticmethod
    def load(path: str | Path = SHIPPED) -> SetNetwork:
        """Read what `save` wrote. ValueError, naming the file and what is wrong with it, for anything else."""
        try:
            with np.load(path, allow_pickle=False) as file:
                arrays = {name: file[name] for name in file.files}
        except OSError as error:
            raise ValueError(f"{path}: can't be read: {reason(error)}") from None
        except (ValueError, AttributeError, EOFError, BadZipFile):
            raise ValueError(f"{path}: is no network of a calibration, or damaged") from None
        if int(arrays.get("version", 0)) != VERSION or tuple(arrays.get("worn", np.empty(0)).tolist()) != WORN:
            raise ValueError(f"{path}: is of another version of Gambol; scripts/build/calibration.py makes one")
        for i, shape in enumerate(SHAPES):
            for name, wanted in ((f"weights{i}", shape), (f"biases{i}", shape[1:])):
                there = arrays.get(name)
                if there is None or there.shape != wanted:
                    raise ValueError(f"{path}: {name} of shape {None if there is None else there.shape}, expected {wanted}")
                if not np.isfinite(there).all():
                    raise ValueError(f"{path}: {name} has numbers that are not finite")
        weights, biases = (tuple(arrays[f"{kind}{i}"].astype(np.float32) for i in range(len(SHAPES))) for kind in ("weights", "biases"))
        return SetNetwork(weights, biases, int(arrays["learnt"]))


def run(weights, biases, frames, heard, standing):
    """What the layers that hear give out, each (B F, …), what all that is heard is on the average, and what the layers that say give out."""
    count, depth = len(frames), len(HEARING)
    found = [frames.reshape(-1, PER_FRAME)]
    for w, b in zip(weights[:depth], biases[:depth], strict=True):
        x = found[-1] @ w + b
        found.append(np.maximum(x, 0.0, out=x))
    share = (heard / np.maximum(heard.sum(-1, keepdims=True), 1)).astype(np.float32)
    mean = np.matmul(share[:, None], found[-1].reshape(count, -1, HEARING[-1]))[:, 0]
    said = np.concatenate([mean, standing, heard.any(-1)[:, None]], -1).astype(np.float32)
    return found, share, forward(weights[depth:], biases[depth:], said)
