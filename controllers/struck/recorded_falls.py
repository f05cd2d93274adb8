"""How people fall over and get up again: four recorded falls, forward, backward and to either side, as coefficients, and what they are on a body."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from gambol import assets

from ..body import centre_of_mass, exp, forward_kinematics
from ..jump.body import Physique, hermite, monotone
from ..jump.motion import FEET, TOUCHES, grounded_poses

DEFAULT = assets.path("library", "falls.npz")
RATE = 120.0
"""Moments a second."""
SPACED = 0.1
"""From one row of coefficients to the next [s]."""
SINKS = 0.015
"""A fall begins as its mass centre has sunk by this [m], at standard height."""


@dataclass(frozen=True, eq=False)
class Fall:
    """One recorded fall and getting up, on a body that begins at heading 0. rows: (R, J, 3) [rad] rotation vectors of all joints. begins: when its mass centre moves [s];
    strikes: when more than its feet touch the floor. far: how far the mass centre goes until it strikes [m]; way: whither [rad], to the left of ahead."""

    rows: np.ndarray
    begins: float
    strikes: float
    far: float
    way: float

    @property
    def lasts(self) -> float:
        """How long it takes [s]."""
        return (len(self.rows) - 1) * SPACED

    def turns(self, times: np.ndarray) -> np.ndarray:
        """All joints' rotations (N, J, 3, 3) at times (N,) [s]."""
        keys, flat = np.arange(len(self.rows)) * SPACED, self.rows.reshape(len(self.rows), -1)
        slopes = monotone(keys, flat)
        slopes[-1] = 0.0  # he has got up: recordings were cut while heads and arms still moved
        shown = hermite(keys, flat, slopes, np.clip(times, 0.0, keys[-1]))
        return exp(shown.reshape(len(times), -1, 3))


def falls(physique: Physique) -> tuple[Fall, ...]:
    """The recorded falls on a body; found once."""
    return _falls(physique)


@lru_cache(maxsize=16)
def _falls(physique: Physique) -> tuple[Fall, ...]:
    found = []
    with np.load(DEFAULT, allow_pickle=False) as file:
        every = [file[name].astype(float) for name in sorted(name for name in file.files if name.startswith("fall"))]
    for rows in every:
        fall = Fall(rows, 0.0, 0.0, 0.0, 0.0)
        times = np.arange(0.0, fall.lasts, 1.0 / RATE)
        local = fall.turns(times)
        roots, over = grounded_poses(physique, local, np.zeros(3), 0.0)
        centre = centre_of_mass(physique.anatomy, *forward_kinematics(physique.skeleton, roots, local))
        strikes = int(np.argmax(over[:, :-FEET].min(1) < TOUCHES * physique.size))
        begins = int(np.argmax(centre[:, 1] < centre[0, 1] - SINKS * physique.size))
        gone = centre[strikes] - centre[begins]
        found.append(Fall(rows, begins / RATE, strikes / RATE, float(np.hypot(gone[0], gone[2])), float(np.arctan2(gone[0], gone[2]))))
    return tuple(found)
