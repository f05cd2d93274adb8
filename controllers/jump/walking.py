"""Who walks ahead and leaps to a place: whether he may do so off the foot under him, and whether this is the moment."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..contract import CharacterState, Leap
from ..navigation import STEP, floor_at
from .body import Physique, Start
from .motion import moments
from .starting import RUNNING, SLOWLY, UNDER, UP, goes, ground_under

AHEAD = 0.95
"""Who goes ahead does so by at least this share of his speed."""
BETWEEN, HIGHEST = np.linspace(0.1, 1.0, 10), 2.0
"""Shares of his way at which the floor is looked at, for what is no higher over it than this [m]."""
STEEPLY, DOWNHILL = 0.21, -0.05
"""Up what rises by more than the first a metre no leg pushes off in so short a time, and down it a foot that strikes carries him on; hands wait for no other down what
falls by more than the second."""
STEPS = 0.4
"""Onto what lies higher than this over his way, or lower [m], nobody leaps off the foot under him."""


def walks_to(state: CharacterState, leap: Leap | None) -> bool:
    """Whether a leap is one of somebody who walks ahead to a place, in no time that he was told, and not to hop on."""
    ahead, _, aside = state.velocity
    pace = math.hypot(ahead, aside)
    return leap is not None and leap.place is not None and leap.airtime is None and leap.on is None and RUNNING < pace < SLOWLY[1] and ahead > AHEAD * pace


def off_under(physique: Physique, start: Start, leap: Leap | None, state: CharacterState, gravity: float, around: Sequence[Any]) -> tuple[Start, bool]:
    """The same start of somebody who walks to a place, off the foot under him if this is the best moment; and whether that is to come. gravity: [m/s²] downward."""
    if leap is None or not walks_to(state, leap):
        return start, False
    place, waits = np.asarray(leap.place, float), False
    if place.shape != (3,) or not np.isfinite(place).all() or not even(state, place, around, UP if leap.slack > 0.0 else STEPS):
        return start, False
    (level, slope), here, way = ground_under(state, around), np.asarray(state.ground, float)[:2], goes(state)
    steep = float(slope @ way[[0, 2]]) / float(np.linalg.norm(way))
    if leap.slack > 0.0 and steep < DOWNHILL:
        return start, False

    def floor(foot: np.ndarray) -> float:
        """How high [m] the ground on which he goes is at a place (3,)."""
        return level + float(slope @ (foot[[0, 2]] - here))

    def finds(foot: np.ndarray) -> bool:
        """Whether a foot finds floor there."""
        return not len(around) or abs(floor_at(foot[0], foot[2], around, floor(foot) + STEP) - floor(foot)) < UNDER
    contacts = np.asarray(state.contacts).reshape(2, 2)
    for side in np.flatnonzero(contacts.any(1)):
        off = replace(start, single=int(side), along=True, bound=True)
        now, later = moments(physique, off, way, place, floor(start.feet[side]), gravity, finds, steep, leap.slack > 0.0)
        if now and contacts[side].all():
            return off, True
        waits = waits or later
    return start, waits


def even(state: CharacterState, place: np.ndarray, around: Sequence[Any], steps: float) -> bool:
    """Whether a place (3,) lies on the level or on the slope on which somebody goes, no steep one, or no more than `steps` [m] over or under it, and nothing stands higher on the way there."""
    (floor, slope), here = ground_under(state, around), np.asarray(state.ground, float)[:2]
    way = place[[0, 2]] - here
    up = float(place[1]) - floor - float(slope @ way)
    if abs(up) > steps or abs(float(slope @ way)) > STEEPLY * float(np.hypot(*way)):
        return False
    high = floor + UP + (max(up, 0.0) if abs(up) > UP else 0.0)
    return not len(around) or all(floor_at(x, z, around, floor + float(slope @ (share * way)) + HIGHEST) < high + float(slope @ (share * way))
                                  for share in BETWEEN for x, z in [here + share * way])
