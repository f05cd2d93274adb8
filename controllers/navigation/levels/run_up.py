"""Leaps from a walk: which may go off so, and at which step they do. The others go off from a stand."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from ...contract import CharacterState, Controller, Intent, Leap
from ..goal import wish
from ..obstacles import SHOULDER, STEP
from .journeys import Crossing
from .surfaces import levels_of

if TYPE_CHECKING:  # who leaps from a walk has planned it
    from ..planning import Plan

PACE = 1.35
"""How fast one walks as one leaps on [m/s]: slower, and both feet push off as from a stand."""
FAR, UP = 2.0, 0.1
"""Nobody leaps from a walk farther than this [m], or higher up."""
LONG = 1.65
"""Who leaps from a walk leaps so far at least [m]: landing nearer, he would come to a stand."""
RUN = 1.2
"""So far before the leap he begins to walk to it, at least [m] ..."""
BACKS = 1.9, 1.3
"""... or goes back for it, so far, where there is room: from a stand there one of his steps ends where the leap goes off; ..."""
ROOM = 1.8
"""... and has so far to come to a stand behind where he lands [m]."""
SOON = 0.65
"""So long before he would be at the edge he looks at which of his steps he can leap [s]; then he can still stop."""
STEPS = 120
"""So many steps of 1/60 s somebody walks until he goes evenly, and through two strides."""
READY = 1.0
"""What a jump bids that could go off at once."""
MOST = 0.5
"""Who could leap at more than this share of the moments at which a jump could go off counts on it."""
PAST = 0.08
"""No farther beyond where the leap was to go off it does [m]."""
EVERY = 3
"""About every so manieth step is asked [steps]."""


def runs(leap: Crossing, here: np.ndarray, around: Sequence[Any], planes: np.ndarray) -> float:
    """How fast [m/s] somebody at a place (2,) would walk as he leaps; 0 for who leaps from a stand: where there is no room, or it is too far or high."""
    top = float(np.min(-planes[:, 3] / np.maximum(planes[:, 0], 1e-9), initial=np.inf, where=planes[:, 0] > 1e-9))
    if top < PACE or near(leap, here):
        return 0.0
    return PACE if _room(leap, around) else 0.0


def start_of(leap: Crossing, around: Sequence[Any]) -> np.ndarray | None:
    """Where (2,) who can leap only from a walk begins to walk to it; None where there is no room."""
    levels = levels_of(around)
    for back in BACKS:
        places = leap.ground[:2] - np.linspace(0.0, back + SHOULDER, 8)[:, None] * _ahead(leap)
        which, heights = levels.ground(places, leap.height + STEP)
        if np.all(levels.regions[which] == levels.regions[which[0]]) and not levels.shut(places, heights).any():
            return leap.ground[:2] - back * _ahead(leap)
    return None


def near(leap: Crossing, here: np.ndarray) -> bool:
    """Whether a place (2,) is too near to a leap to come to it at a walk."""
    return bool((leap.ground[:2] - here) @ _ahead(leap) < RUN)


def farther(walker: Controller, leap: Crossing, around: Sequence[Any], refusal: Callable[[CharacterState, Intent], str | None]) -> bool:
    """Whether a leap that is too far from a stand could be made from a walk, at most of the steps; what it might touch is not looked at."""
    if not _room(leap, around) or start_of(leap, around) is None:
        return False
    asked = [(state, Leap(np.array([state.ground[0], 0.0, state.ground[1] + leap.asks[0]]))) for state in _walking(walker)]
    asked = [(state, one) for state, one in asked if walker.precondition(state, Intent(leap=one)) >= READY]
    can, left = 0, len(asked)
    for state, one in asked:
        can, left = can + (refusal(state, Intent(leap=one)) == ""), left - 1
        if can > MOST * len(asked) or can + left <= MOST * len(asked):
            break
    return can > MOST * len(asked)


@lru_cache(maxsize=8)
def _walking(walker: Controller) -> tuple[CharacterState, ...]:
    """Somebody on a level floor, who walks along z, through two steps: at every third of them."""
    state, states = walker.start(), []
    for number in range(STEPS):
        state, _ = walker.step(state, Intent(np.array([PACE, 0.0, 0.0])), 1 / 60)
        states += [state] if number >= STEPS // 2 and number % EVERY == 0 else []
    return tuple(states)


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
    on = (levels.regions[which] == levels.regions[levels.under(leap.place[[0, 2]], float(leap.place[1]))]) & ~levels.shut(beyond, heights)
    return bool(on.all()) and abs(float(heights[0]) - float(leap.place[1])) < 0.05


def onto(leap: Crossing, pace: float) -> np.ndarray:
    """Where (3,) [m] a leap lands: from a walk no nearer than keeps one walking."""
    missing = max(LONG - leap.asks[0], 0.0) if pace else 0.0
    return leap.place + missing * np.array([np.sin(leap.ground[2]), 0.0, np.cos(leap.ground[2])])


def take_off(walker: Controller, state: CharacterState, plan: Plan, time: float, leap: Crossing, intent: Intent, dt: float) -> int | None:
    """After how many steps of dt [s] of a plan, `time` [s] into it, the leap can be made: the last such. None if at none: his walk is played ahead."""
    ahead = _ahead(leap)
    asked = replace(intent, goal=None, aside=None, leap=Leap(onto(leap, PACE)))
    states = []
    while (state.ground - leap.ground)[:2] @ ahead < PAST and len(states) < 2.0 * SOON / dt:
        states.append((state, replace(asked, velocity=wish(plan, time, state.ground, state.velocity))))
        time += dt * float(walker.readiness(state))
        state, _ = walker.step(state, replace(states[-1][1], leap=None), dt)
    for number in range(len(states) - 1, -1, -EVERY):
        at, intent = states[number]
        if walker.refusal(at, intent) == "" and walker.step(at, intent, dt)[0].active != at.active:
            return number
    return None
