"""How people carry trunk, head, arms and legs in a jump: coefficients fitted to recorded jumps, and what they say of one.

A jump's time is warped so that its events fall on 0 … 5: start, lowest, take-off, touch-down, lowest, upright again. Five rows
of angles lie between two events; each is a linear function of how fast the body leaves the floor (or comes down),
how far it goes and how fast it came.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from os import PathLike
from typing import Any

import numpy as np

from gambol import assets

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
        found = np.array([1.0, 2.0 * speed / (9.81 * size**0.5), far / size, pace / size**0.5])
        return np.clip(found, self.least[int(single)], self.most[int(single)])

    def swings(self, airtime: float, pace: float, size: float, single: bool) -> float:
        """How far arms swing in a jump of an airtime [s] and a pace [m/s], beside recorded ones: less in shorter and slower leaps off one foot than anybody was
        recorded in, or they would have to be faster."""
        if not single:
            return 1.0
        least = self.least[1]
        return float(min(airtime / size**0.5 / least[1], 1.0) * np.clip(pace / size**0.5 / least[3], 0.0, 1.0))

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

    def row(self, number: int, features: np.ndarray, single: int | None = None, swings: float = 1.0) -> np.ndarray:
        """One row (COLUMNS,) [rad] for features that hold there."""
        fitted = self.two if single is None else self.one
        found = features @ fitted[:, number]
        if swings < 1.0 and AIR.start < number < AIR.stop:
            part = (number - AIR.start) / (2 * BETWEEN)
            found[ARMS] += (1.0 - swings) * (features @ ((1.0 - part) * fitted[:, AIR.start, ARMS] + part * fitted[:, AIR.stop - 1, ARMS]) - found[ARMS])
        return mirrored(found) if single == 0 else found

    def crouch(self, leaving: np.ndarray) -> float:
        """How far down [m] an adult's mass centre goes before such a jump off both feet."""
        return float(leaving @ self.depth)


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
