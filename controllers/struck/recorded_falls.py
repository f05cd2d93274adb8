"""How people fall over and get up again: four recorded falls, forward, backward and to either side, as coefficients, and what they are on a body."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from gambol import assets

from ..body import centre_of_mass, contact_height, end_positions, exp, forward_kinematics, heel_offset
from ..jump.body import Physique, hermite, monotone

DEFAULT = assets.path("library", "falls.npz")
RATE = 120.0
"""Moments a second."""
SPACED = 0.1
"""From one row of coefficients to the next [s]."""
BONES = (("UpLeg", "Leg", 0.06), ("Leg", "Foot", 0.045), ("Arm", "ForeArm", 0.04), ("ForeArm", "Hand", 0.035), ("Hand", "", 0.03), ("Hips", "Spine2", 0.10),
         ("Spine2", "Neck", 0.09), ("Head", "", 0.09))
"""Bones as capsules: from which joint to which or to its end, how thick [m] at standard height."""
TOUCHES = 0.012
"""What is no farther over the floor than this [m], at standard height, lies or stands on it, the less the farther."""
SINKS = 0.015
"""A fall begins as its mass centre has sunk by this [m], at standard height."""
FEET = 6
"""So many of the places that may touch the floor are feet, the last ones: heel, ball and tip of either."""


@dataclass(frozen=True, eq=False)
class Fall:
    """One recorded fall and getting up, on a body that begins at heading 0. rows: (R, J, 3) [rad] rotation vectors of all joints. begins: when its mass centre moves [s];
    strikes: when more than its feet touch the floor; lies: when it is lowest. far: how far the mass centre goes until it strikes [m]; way: whither [rad], to the left of ahead."""

    rows: np.ndarray
    begins: float
    strikes: float
    lies: float
    far: float
    way: float

    @property
    def lasts(self) -> float:
        """How long it takes [s]."""
        return (len(self.rows) - 1) * SPACED

    def turns(self, times: np.ndarray) -> np.ndarray:
        """All joints' rotations (N, J, 3, 3) at times (N,) [s]."""
        keys, flat = np.arange(len(self.rows)) * SPACED, self.rows.reshape(len(self.rows), -1)
        shown = hermite(keys, flat, monotone(keys, flat), np.clip(times, 0.0, keys[-1]))
        return exp(shown.reshape(len(times), -1, 3))


def places(physique: Physique, positions: np.ndarray, turned: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where (N, P, 3) [m] a placed body may touch the floor, the ends of its capsules and its soles, and how far (N, P) these are over y = 0 [m]."""
    skeleton, at, out, over = physique.skeleton, physique.skeleton.index, [], []
    ends = end_positions(skeleton, positions, turned)
    for first, last, radius in BONES:
        for side in ("",) if first in skeleton.names else ("Left", "Right"):
            stop = ends[:, skeleton.end_index[side + first]] if not last else positions[:, at(last if last in skeleton.names else side + last)]
            for place in (positions[:, at(side + first)], stop):
                out.append(place)
                over.append(place[:, 1] - radius * physique.size)
    for place, low in sole_places(physique, positions, turned):
        out.append(place)
        over.append(low)
    return np.stack(out, 1), np.stack(over, 1)


def sole_places(physique: Physique, positions: np.ndarray, turned: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Heel, ball and tip (N, 3) [m] of either foot, and how far (N,) its sole is over y = 0 there [m]."""
    skeleton, at, found = physique.skeleton, physique.skeleton.index, []
    for side in ("Left", "Right"):
        foot, toe = at(side + "Foot"), at(side + "Toe")
        for joint, from_it in ((foot, heel_offset(skeleton)), (toe, np.zeros(3)), (toe, skeleton.end_offsets[skeleton.end_index[side + "Toe"]])):
            place = positions[:, joint] + turned[:, joint] @ from_it
            found.append((place, place[:, 1] - contact_height(skeleton)))
    return found


def grounded(physique: Physique, local: np.ndarray, start: np.ndarray, floor: float) -> tuple[np.ndarray, np.ndarray]:
    """Roots (N, 3) of poses (N, J, 3, 3) that lie or stand on a floor [m]: nothing is below it, what touches it is left where it is as far as that can be. The first has its x and z from
    `start` (3,). And how far (N, P) `places` are over the floor."""
    positions, turned = forward_kinematics(physique.skeleton, np.zeros((len(local), 3)), local)
    where, over = places(physique, positions, turned)
    roots = np.empty((len(local), 3))
    roots[:, 1] = floor - over.min(1)
    over = over - over.min(1)[:, None]
    presses = np.exp(-((over / (TOUCHES * physique.size)) ** 2)) + 1e-9
    presses = presses[1:] * presses[:-1]
    gone = np.einsum("np,npi->ni", presses, np.diff(where[..., [0, 2]], axis=0)) / presses.sum(1)[:, None]
    roots[0, [0, 2]] = start[[0, 2]]
    roots[1:, [0, 2]] = start[[0, 2]] - np.cumsum(gone, 0)
    return roots, over


def falls(physique: Physique) -> tuple[Fall, ...]:
    """The recorded falls on a body; found once."""
    return _falls(physique)


@lru_cache(maxsize=16)
def _falls(physique: Physique) -> tuple[Fall, ...]:
    found = []
    with np.load(DEFAULT, allow_pickle=False) as file:
        every = [file[name].astype(float) for name in sorted(name for name in file.files if name.startswith("fall"))]
    for rows in every:
        fall = Fall(rows, 0.0, 0.0, 0.0, 0.0, 0.0)
        times = np.arange(0.0, fall.lasts, 1.0 / RATE)
        local = fall.turns(times)
        roots, over = grounded(physique, local, np.zeros(3), 0.0)
        centre = centre_of_mass(physique.anatomy, *forward_kinematics(physique.skeleton, roots, local))
        strikes = int(np.argmax(over[:, :-FEET].min(1) < TOUCHES * physique.size))
        begins = int(np.argmax(centre[:, 1] < centre[0, 1] - SINKS * physique.size))
        gone = centre[strikes] - centre[begins]
        found.append(Fall(rows, begins / RATE, strikes / RATE, int(centre[:, 1].argmin()) / RATE, float(np.hypot(gone[0], gone[2])), float(np.arctan2(gone[0], gone[2]))))
    return tuple(found)
