"""Who walks as he is told comes to a stop before what is solid, or goes along it: scripts see nothing of what stands about."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from gambol.controllers.contract import CharacterState, Intent, but
from gambol.controllers.navigation import floor_at, gap, in_world, is_box, slope

STEPS, HEAD = 0.26, 1.7
"""What is no higher over the floor is stepped on, what hangs higher is walked under [m]."""
NEAR = 0.18
"""How near to its middle a body lets solid things come [m]."""
EDGE = 0.04
"""Right before something is so far from it [m]."""
STOPS = 0.45
"""How long it takes to stop: nobody goes towards something faster than by what is left of the way in that time [s]."""


def stopped(state: CharacterState, intent: Intent, around: Sequence[Any]) -> Intent:
    """The same intent, its walk no faster towards anything solid than it could stop; as it is of who leaps, or goes to a goal round everything."""
    if not len(around) or intent.goal is not None or intent.leap is not None or intent.aim is not None or state.active == "jump":
        return intent
    velocity, slower = in_world(state.ground, intent.velocity), False
    for thing in around:
        low, high = _heights(thing)
        floor = float(state.floor)
        if high <= floor + STEPS or low >= floor + HEAD:
            continue
        place = np.array([state.ground[0], min(max(floor + 1.0, low), high), state.ground[1]])
        out, far = _out(place, thing), float(gap(place[None], thing)[0])
        into = -float(velocity @ out) - max(far - NEAR, 0.0) / STOPS
        if into > 0.0 and high > _before(place, out, far, high, around) + STEPS:
            velocity, slower = velocity + into * out, True
    if not slower:
        return intent
    c, s = np.cos(state.ground[2]), np.sin(state.ground[2])
    return but(intent, velocity=np.array([s * velocity[0] + c * velocity[1], intent.velocity[1], c * velocity[0] - s * velocity[1]]))


def _heights(thing: Any) -> tuple[float, float]:
    """From where to where [m] something stands in the way: a ramp, and what is no solid thing, nowhere."""
    if hasattr(thing, "foot"):
        return thing.foot[1], thing.foot[1] + thing.height
    if is_box(thing) and not slope(thing):
        return thing.centre[1] - 0.5 * thing.size[1], thing.centre[1] + 0.5 * thing.size[1]
    return 0.0, -np.inf


def _before(place: np.ndarray, out: np.ndarray, far: float, high: float, around: Sequence[Any]) -> float:
    """How high [m] the floor lies right before something that is `far` [m] away and so high: stairs lead up, step by step."""
    x, z = place[[0, 2]] - (far - EDGE) * out
    return floor_at(float(x), float(z), around, high - EDGE)


def _out(place: np.ndarray, thing: Any) -> np.ndarray:
    """The way (2,) along the floor out of a thing from a place (3,): a unit vector, or nothing where it only lies below or above."""
    step = 1e-4 * np.eye(3)[[0, 2]]
    away = gap(place + step, thing) - gap(place - step, thing)
    return away / max(float(np.hypot(*away)), 1e-9) * (np.hypot(*away) > 1e-5)
