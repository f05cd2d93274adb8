"""Off which foot somebody leaps who goes on: slowly, aside or backward off one that keeps his speed; ahead, to a place, off the one under him."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ...body import yaw
from ...contract import CharacterState, Leap
from ...navigation import STEP, floor_at
from ..body import Physique, Start
from ..motion import LIKE, carried, moments
from .floors import UNDER, UP, ground
from .from_state import RUNNING, goes

SLOWLY = 0.12, LIKE[1]
"""Who is told to leap along his way, and is slower than the first [m/s], leaps on the spot; who is faster than the second as runners do."""
CLEAR = 0.015
"""A foot that has just left the floor, and is no higher than this over it [m], at standard height, would come into it as its body goes down."""
AHEAD = 0.95
"""Who goes ahead does so by at least this share of his speed."""
BETWEEN, HIGHEST = np.linspace(0.1, 1.0, 10), 2.0
"""Shares of his way at which the floor is looked at, for what is no higher over it than this [m]."""
STEEPLY, DOWNHILL = 0.21, -0.05
"""Up what rises by more than the first a metre no leg pushes off in so short a time, and down it a foot that strikes carries him on; hands wait for no other down what
falls by more than the second."""
SOON = 8.0
"""No foot of his next ones sends a walker to what is farther away than this [m], on Earth, up to standard height: what it can send him, and the way of his steps until then, come to 6 m at most."""
STEPS = 0.36
"""Onto what lies higher than this over his way, or lower [m], nobody leaps off the foot under him."""
BACK = 0.8
"""Who goes back by more than this share of his speed goes backward."""


def along_of(state: CharacterState, leap: Leap | None) -> bool:
    """Whether a leap is one of somebody who goes slowly, aside or backward, on his way."""
    return leap is not None and leap.along and SLOWLY[0] < float(np.hypot(state.velocity[0], state.velocity[2])) < SLOWLY[1]


def off_one(physique: Physique, start: Start, leap: Leap | None, state: CharacterState, gravity: float) -> Start:
    """The same start of somebody who leaps so, off the foot that keeps his speed best of those that stand flat; as it is where none does. gravity: [m/s²] downward."""
    if leap is None or not along_of(state, leap):
        return start
    contacts = np.asarray(state.contacts).reshape(2, 2)
    back = float(goes(state) @ yaw(start.heading)[:, 2]) < -BACK * float(np.linalg.norm(goes(state)))
    high = start.feet[:, 1] > float(state.floor) + physique.tables.sole + CLEAR * physique.size
    clear = high & ~contacts.any(1) if back else np.ones(2, bool)  # ahead of who goes back it stands on its heel, and would be drawn through the floor
    flat = np.flatnonzero(contacts.all(1) & clear[::-1])
    ways = [replace(start, single=int(side), along=True) for side in flat]
    found = [carried(physique, way, goes(state), float(state.floor), gravity, leap.waited) for way in ways]
    return min(zip(ways, found), key=lambda one: (not one[1].keeps, one[1].strays))[0] if ways else start


def walks_to(state: CharacterState, leap: Leap | None) -> bool:
    """Whether a leap is one of somebody who walks ahead to a place, in no time that he was told, and not to hop on."""
    ahead, _, aside = state.velocity
    pace = math.hypot(ahead, aside)
    return leap is not None and leap.place is not None and leap.airtime is None and leap.on is None and RUNNING < pace < SLOWLY[1] and ahead > AHEAD * pace


def leaves_under(state: CharacterState, leap: Leap | None, around: Sequence[Any]) -> bool:
    """Whether a leap is one of somebody who walks to a place that he can leap to off the foot under him: no higher or lower than scripts, or hands, have it."""
    if leap is None or not walks_to(state, leap):
        return False
    place = np.asarray(leap.place, float)
    return place.shape == (3,) and bool(np.isfinite(place).all()) and even(state, place, around, UP if leap.slack > 0.0 else STEPS)


def off_under(physique: Physique, start: Start, leap: Leap | None, state: CharacterState, gravity: float, around: Sequence[Any]) -> tuple[Start, bool]:
    """The same start of somebody who walks to a place, off the foot under him if this is the best moment; and whether that is to come. gravity: [m/s²] downward."""
    if leap is None or not leaves_under(state, leap, around):
        return start, False
    place, waits = np.asarray(leap.place, float), False
    if math.hypot(place[0] - state.ground[0], place[2] - state.ground[1]) > SOON * max(physique.size, 1.0) * max(math.sqrt(9.81 / gravity), 1.0):
        return start, False
    (level, slope), here, way = ground(state, around), np.asarray(state.ground, float)[:2], goes(state)
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
        now, later = moments(physique, off, way, place, floor(start.feet[side]), gravity, finds, steep, leap.slack > 0.0, float(state.velocity[1]))
        if now and contacts[side].all():
            return off, True
        waits = waits or later
    return start, waits


def even(state: CharacterState, place: np.ndarray, around: Sequence[Any], steps: float) -> bool:
    """Whether a place (3,) lies on the level or on the slope on which somebody goes, no steep one, or no more than `steps` [m] over or under it, and nothing stands higher on the way there."""
    (floor, slope), here = ground(state, around), np.asarray(state.ground, float)[:2]
    way = place[[0, 2]] - here
    up = float(place[1]) - floor - float(slope @ way)
    if abs(up) > steps or abs(float(slope @ way)) > STEEPLY * float(np.hypot(*way)):
        return False
    high = floor + UP + (max(up, 0.0) if abs(up) > UP else 0.0)
    return not len(around) or all(floor_at(x, z, around, floor + float(slope @ (share * way)) + HIGHEST) < high + float(slope @ (share * way))
                                  for share in BETWEEN for x, z in [here + share * way])
