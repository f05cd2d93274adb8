"""How people carry trunk, head, arms and legs in a jump: coefficients fitted to recorded jumps, and what they say of one.

A jump's time is warped so that its events fall on 0 … 5: start, lowest, take-off, touch-down, lowest, upright again. Five rows
of angles lie between two events; each is a linear function of how fast the body leaves the floor (or comes down),
how far it goes and how fast it came.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from os import PathLike
from typing import Any

import numpy as np

from gambol import assets

from ...compiled import kernel
from ..body import carriage

BETWEEN = 5
"""Rows from one event to the next."""
ROWS = 5 * BETWEEN + 1
EACH = 3
"""Hip, knee and ankle of a leg, how far each is bent about x."""
LEGS = len(carriage.ANGLES)
"""The first column of the legs, after those of `carriage`: left, then right."""
COLUMNS = LEGS + 2 * EACH
ARMS, AIR = slice(3, LEGS), slice(2 * BETWEEN, 4 * BETWEEN + 1)
"""The columns of the arms; the rows from take-off to the lowest point of the landing."""
ELBOWS = [carriage.ANGLES.index(side + " elbow") for side in ("left", "right")]
FEATURES = 4
"""One, airtime [s], distance [m] and pace [m/s] of a standard adult on Earth."""
DEFAULT = assets.path("library", "jumps.npz")


@dataclass(frozen=True, eq=False)
class Prior:
    """What was fitted. two: (FEATURES, ROWS, COLUMNS) [rad] off both feet; one: off the right foot out of a run, to its left;
    depth: (FEATURES,) [m] how far the mass centre goes down. least, most: (2, FEATURES) of what was recorded, off both and off one foot:
    beyond, as at the nearest. takes: whence."""

    two: np.ndarray
    one: np.ndarray
    depth: np.ndarray
    least: np.ndarray
    most: np.ndarray
    takes: tuple[str, ...] = ()

    @staticmethod
    def load(path: str | PathLike[str] | None = None) -> Prior:
        """From a file; the shipped one by default."""
        return _load(str(path or DEFAULT))

    def features(self, speed: float, far: float, pace: float, size: float, single: bool) -> np.ndarray:
        """The features (FEATURES,) of a jump that leaves or lands with `speed` upward or downward [m/s], goes `far` [m]
        ahead and comes with `pace` [m/s], of a body of a size over an adult's."""
        found = np.empty(FEATURES)
        features_kernel(speed, far, pace, size, self.least[int(single)], self.most[int(single)], found)
        return found

    def keys(self, leaving: np.ndarray, landing: np.ndarray, single: int | None = None, swings: float = 1.0) -> np.ndarray:
        """The rows (ROWS, COLUMNS) [rad] of a jump with these features as it leaves and as it lands. single: the foot that it
        leaves, 0 left, 1 right; swings: how far arms swing, beside recorded ones."""
        fitted = self.two if single is None else self.one
        share = np.clip(np.linspace(0.0, 5.0, ROWS) - 2.0, 0.0, 1.0)[:, None]
        keys = (1.0 - share) * np.tensordot(leaving, fitted, 1) + share * np.tensordot(landing, fitted, 1)
        if swings < 1.0:
            part = np.linspace(0.0, 1.0, 2 * BETWEEN + 1)[:, None]
            keys[AIR, ARMS] += (1.0 - swings) * ((1.0 - part) * keys[AIR.start, ARMS] + part * keys[AIR.stop - 1, ARMS] - keys[AIR, ARMS])
        return mirrored(keys) if single == 0 else keys

    def unswung(self, number: int, single: bool) -> np.ndarray:
        """What (FEATURES, COLUMNS) [rad] is added to a row in the air for each feature where arms do not swing: so that they go straight from how they leave to how they land."""
        fitted, part = self.one if single else self.two, (number - AIR.start) / (2 * BETWEEN)
        more = np.zeros((FEATURES, COLUMNS))
        more[:, ARMS] = (1.0 - part) * fitted[:, AIR.start, ARMS] + part * fitted[:, AIR.stop - 1, ARMS] - fitted[:, number, ARMS]
        return more


@kernel
def features_kernel(speed, far, pace, size, least, most, found):
    """Write `Prior.features` (FEATURES,). least, most: (FEATURES,) of what was recorded."""
    root = math.sqrt(size)
    found[0], found[1], found[2], found[3] = 1.0, 2.0 * speed / (9.81 * root), far / size, pace / root
    for n in range(len(found)):
        found[n] = min(max(found[n], least[n]), most[n])


@kernel
def swings_kernel(pace, size, least):
    """How far arms swing in a leap off one foot of a pace [m/s], beside recorded ones, which had these features at least (FEATURES,): less in slower ones."""
    return min(max(pace / math.sqrt(size) / least[3], 0.0), 1.0)


@lru_cache(maxsize=4)
def _load(path: str) -> Prior:
    with np.load(path, allow_pickle=False) as file:
        parts: dict[str, Any] = {name: file[name].astype(float) for name in ("two", "one", "depth", "least", "most")}
        return Prior(**parts, takes=tuple(str(take) for take in file["takes"]))


def mirrored(keys: np.ndarray) -> np.ndarray:
    """The same keys (..., COLUMNS) with left and right exchanged."""
    out = keys.copy()
    out[..., 3:7], out[..., 7:11] = keys[..., 7:11], keys[..., 3:7]
    out[..., [4, 5, 8, 9]] *= -1.0
    out[..., LEGS:LEGS + EACH], out[..., LEGS + EACH:] = keys[..., LEGS + EACH:], keys[..., LEGS:LEGS + EACH]
    return out
