"""Leaps from a walk: which may go off so, and at which step they do. The others go off from a stand."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from ...contract import CharacterState, Controller, Intent, Leap, but
from ..goal import wish
from .journeys import CLEAR, Crossing
from .surfaces import levels_of

if TYPE_CHECKING:  # who leaps from a walk has planned it
    from ..planning import Plan

SHARE = 0.9
"""Plans keep to this share of what is walked: what is left serves to catch up."""
PACES = 1.35, 1.6, 1.9
"""So fast one may walk as one leaps on [m/s], as slowly as will do; slower, and both feet push off as from a stand, faster, and legs run."""
FAR, UP = 2.3, 0.5
"""Nobody leaps from a walk farther than this [m], or higher up."""
LONG = 1.65
"""Who leaps from a walk leaps so far at least [m]: landing nearer, he would come to a stand."""
RUN = 0.95
"""So far before the leap he begins to walk to it, at least [m] ..."""
BACKS = 1.9, 1.6, 1.4, 1.3, 1.2, 1.1
"""... or goes back for it, so far, where there is room, and where from a stand there one of his steps ends where the leap goes off; ..."""
ELSEWHERE = 0.07
"""No run-up begins so near to where another began from which no leap goes off [m]."""
ROOM = 1.8
"""... and has so far to come to a stand behind where he lands [m]."""
SPARE = 1.04
"""Plans of run-ups may be so many times as fast as they end: what is late is caught up."""
SOON = 0.65
"""So long before he would be at the edge he looks at which of his steps he can leap [s]; then he can still stop."""
READY = 1.0
"""What a jump bids that could go off at once."""
ENOUGH = 2
"""A run-up is counted on from which the leap could go off at so many moments: one may be missed."""
PAST = 0.08
"""No farther beyond where the leap was to go off it does [m]."""
EVERY = 3
"""About every so manieth step is asked [steps]."""
ROUND = np.stack([np.sin(np.arange(8) * math.pi / 4.0), np.cos(np.arange(8) * math.pi / 4.0)], axis=-1)
"""Ways (8, 2) all round."""
LEVEL = 0.05
"""Where one walks up to a leap, the ground is no higher or lower than where it goes off [m]."""
FINE, HIGH = 0.05, 0.1
"""Run-ups are measured for leaps as far, and as high up, as so much more or less [m]."""
TRIES = 4
"""What measuring a run-up counts for, in leaps that are asked about."""


def runs(leap: Crossing, here: np.ndarray, around: Sequence[Any], planes: np.ndarray) -> bool:
    """Whether somebody at a place (2,) may come to a leap at a walk: not where there is no room, where it is too far or high, or where he walks too slowly."""
    return _top(planes) >= PACES[0] and not near(leap, here) and _room(leap, around)


def quickened(planes: np.ndarray, pace: float) -> np.ndarray:
    """The half-spaces (H, 4) of velocities that a run-up keeps to which ends so fast [m/s]."""
    return planes / np.array([max(SPARE * pace / _top(planes), 1.0), 1.0, 1.0, 1.0])


def _top(planes: np.ndarray) -> float:
    """How fast one walks straight on [m/s]."""
    return float(np.min(-planes[:, 3] / np.maximum(planes[:, 0], 1e-9), initial=np.inf, where=planes[:, 0] > 1e-9))


def start_of(walker: Controller, leap: Crossing, around: Sequence[Any], but_for: np.ndarray | None = None) -> np.ndarray | None:
    """Where (2,) who can leap only from a walk begins to walk to it; None where there is no room, or he could leap from nowhere. but_for: (2,) not there."""
    levels = levels_of(around)
    far, up = leap.asks
    for back in BACKS:
        begins = leap.ground[:2] - back * _ahead(leap)
        if but_for is not None and math.dist(begins, but_for) < ELSEWHERE:
            continue
        places = np.concatenate([leap.ground[:2] - np.linspace(0.0, back, 7)[:, None] * _ahead(leap), begins + CLEAR * ROUND])
        which, heights = levels.ground(places, leap.height + levels.step)
        walked = (levels.regions[which] == levels.regions[which[0]]) & ~levels.shut(places, heights) & (abs(heights - leap.height) <= levels.step)
        if walked.all() and np.all(abs(heights[:7] - leap.height) <= LEVEL) and not levels.shut(begins[None], heights[6:7], CLEAR)[0] \
                and goes_off(walker, FINE * math.ceil(far / FINE - 1e-6), HIGH * math.ceil(up / HIGH - 1e-6), back):
            return begins
    return None


def near(leap: Crossing, here: np.ndarray) -> bool:
    """Whether a place (2,) is too near to a leap to come to it at a walk."""
    return bool((leap.ground[:2] - here) @ _ahead(leap) < RUN)


def farther(walker: Controller, leap: Crossing, around: Sequence[Any]) -> bool:
    """Whether a leap that is too far from a stand could be made from a walk; what it might touch is not looked at."""
    return _room(leap, around) and start_of(walker, leap, around) is not None


@lru_cache(maxsize=256)
def goes_off(walker: Controller, far: float, up: float, back: float) -> bool:
    """Whether a leap so far and so high up [m] goes off after a run-up so long [m] from a stand, on a level floor, played ahead."""
    planes, leap = walker.limits(SHARE), Crossing(np.zeros(3), np.array([0.0, up, far]), 0.0)
    if planes is None or _top(planes) < PACES[0]:
        return False
    return approach(walker, walker.start((0.0, -back, 0.0)), leap, Intent(), planes, (), 1 / 60, ENOUGH)[0] > 0.0


def approach(walker: Controller, state: CharacterState, leap: Crossing, intent: Intent, planes: np.ndarray, stops: Sequence[Any], dt: float,
             least: int = 1) -> tuple[float, Plan]:
    """How fast [m/s] he walks as he leaps, and the plan that leads there, played ahead to the leap: the slowest that will do; 0 where at none the leap could go off at so many moments at least.

    planes: (H, 4) half-spaces of the velocities that he walks with. stops: what is in the way of his walk.
    """
    from ..planning import plan_in_time

    best: tuple[int, float, Plan | None] = (0, 0.0, None)
    for pace in PACES:
        made = plan_in_time(state.ground, leap.ground, state.velocity, quickened(planes, pace), stops, float(state.floor), leaving=np.array([pace, 0.0, 0.0]), size=walker.size)
        if made.reason:
            return 0.0, made
        moments = len(take_offs(walker, state, made, 0.0, leap, intent, dt, ENOUGH))
        if best[2] is None or moments > best[0]:
            best = moments, pace if moments >= least else 0.0, made
        if moments >= ENOUGH:
            break
    assert best[2] is not None
    return best[1], best[2]


def _ahead(leap: Crossing) -> np.ndarray:
    return np.array([np.sin(leap.ground[2]), np.cos(leap.ground[2])])


def _room(leap: Crossing, around: Sequence[Any]) -> bool:
    """Whether a leap is one for who walks, and leaves room to stop behind it."""
    far, up = leap.asks
    if far > FAR or up > UP:
        return False
    ahead, levels = _ahead(leap), levels_of(around)
    beyond = leap.place[[0, 2]] + max(LONG - far, 0.0) * ahead + np.linspace(0.0, ROOM, 6)[:, None] * ahead
    which, heights = levels.ground(beyond)
    on = (levels.regions[which] == levels.regions[levels.under(leap.place[[0, 2]], float(leap.place[1]))]) & ~levels.shut(beyond, heights, CLEAR)
    return bool(on.all()) and abs(float(heights[0]) - float(leap.place[1])) <= LEVEL


def onto(leap: Crossing, pace: float) -> np.ndarray:
    """Where (3,) [m] a leap lands: from a walk no nearer than keeps one walking."""
    missing = max(LONG - leap.asks[0], 0.0) if pace else 0.0
    return leap.place + missing * np.array([np.sin(leap.ground[2]), 0.0, np.cos(leap.ground[2])])


def take_offs(walker: Controller, state: CharacterState, plan: Plan, time: float, leap: Crossing, intent: Intent, dt: float, most: int = 1) -> list[int]:
    """After how many steps of dt [s] of a plan, `time` [s] into it, the leap can be made: the last such, at most so many. His walk is played ahead."""
    ahead = _ahead(leap)
    asked = but(intent, goal=None, aside=None, leap=Leap(onto(leap, PACES[0])))
    states: list[tuple[CharacterState, Intent]] = []
    while (state.ground - leap.ground)[:2] @ ahead < PAST and time < plan.seconds + SOON:
        states.append((state, but(asked, velocity=wish(plan, time, state.ground, state.velocity))))
        time += dt * float(walker.readiness(state))
        state, _ = walker.step(state, but(states[-1][1], leap=None), dt)
    found: list[int] = []
    for number in range(len(states) - 1, max(len(states) - round(SOON / dt), 0) - 1, -EVERY):
        at, intent = states[number]
        if walker.precondition(at, intent) >= READY and walker.refusal(at, intent) == "" and walker.step(at, intent, dt)[0].active != at.active:
            found.append(number)
            if len(found) >= most:
                break
    return found
