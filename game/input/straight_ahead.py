"""What lies straight ahead of somebody: where he is to come to rest before it, and whether the floor rises there.

Nothing is played ahead here: it is asked in every step of who goes at something.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from gambol.controllers.contract import CharacterState
from gambol.controllers.navigation import STEP, clearance, floor_at, floors_at, in_world, room

TOUCHES = 0.19
"""Nearer to its middle nothing solid may come to a body that has not leapt yet [m]: walls hold up at 0.18 who treads on before them."""
BODY = 0.4, 1.0, 1.6
"""At these heights of it [m]."""
SHORT = 0.12, 0.3
"""He comes to rest so far before he would be too near to something solid, and before an edge [m]."""
PACE, FINE = 0.1, 0.01
"""Places straight ahead are looked at so far apart [m], and the last that is free is found to so much [m]."""
WIDE, FLAT = 0.5, 0.18
"""Who comes straight at something looks so far to either side of where he meets it [m]: what recedes there by more than the second [m], as a wall does that he meets
at more than 20° off its normal, or a pillar, he goes along, or round."""
STOPS = 0.6, 0.45
"""Straight ahead somebody looks so far [m], and farther by so much for the square of his speed over his agility [s²/m]: a run of 3 m/s stops in 2 m."""
UP = 0.95
"""A leap lands no higher than this over the feet [m], and no lower than a step."""
CLEARS = (STEP, 0.28), (0.28, 0.35), (0.33, 0.44), (0.38, 0.48)
"""Who leaps onto what is higher than the firsts [m] starts so far before it [m], at standard height: nearer, his knees, or his feet on the way up, would come against it."""
AGAIN = 0.12
"""Who can't from there goes so much farther back [m], at standard height."""
LEGS = 0.1
"""Either of his legs does, so far aside of his middle [m], at standard height: askew, one of them is nearer to it."""
LOW = 0.5
"""Who goes straight at what is no higher than this [m], at standard height, has leaping onto it in mind."""
BACK = 0.25
"""He makes room for that who has so much of it behind him [m]."""
EVEN, LEVEL = (0.25, 0.5, 0.75, 1.0, 1.25), 0.05
"""Who goes slowly leaps on over floor that is no higher or lower than the second [m] so far before him [m]."""
LANDS, OTHER = np.arange(0.65, 1.26, 0.05), 0.05
"""Who is held up before something and jumps lands at the first of these [m] ahead where there is room on what is higher or lower than his own floor by more than the second [m]."""
RISES = 0.12
"""What is so much higher than the floor [m] a runner brakes before, who would step on it as he walks: who holds a leap leaps."""


def before(controller: Any, state: CharacterState, velocity: Sequence[float], around: Sequence[Any], share: float = 1.0, more: float = 0.0) -> tuple[float, float] | None:
    """Where x, z [m] somebody who goes on with a velocity (2,) [m/s] in the world is to come to rest, so that he runs into nothing and over no edge; None
    where that is far away: farther than he looks, of which `share` counts, and so much `more` [m]."""
    met = _met(controller, state, velocity, around, share, more)
    return None if met is None else _short(controller, state, velocity, around, met, True)


def headlong(controller: Any, state: CharacterState, velocity: Sequence[float], around: Sequence[Any]) -> tuple[float, float] | None:
    """The same of somebody who goes so straight at what is ahead that he neither goes along it nor round it; None of everybody else, and of who is too near to something already."""
    met = _met(controller, state, velocity, around) if room(np.asarray(state.ground[:2], float), float(state.floor), around) > 0.0 else None
    if met is None:
        return None
    ahead = np.asarray(velocity, float) / math.hypot(*velocity)
    there, left = np.asarray(state.ground[:2], float) + (met.far + FLAT) * ahead, WIDE * np.array([ahead[1], -ahead[0]])
    low = floor_at(float(there[0]), float(there[1]), around, met.floor + UP) < met.floor + LOW * controller.size  # his leap begins where he rests
    return None if any(room(there + side, met.floor, around) > 0.0 for side in (left, -left)) else _short(controller, state, velocity, around, met, low)


class Met(NamedTuple):
    """What somebody comes to who goes straight on: how far he gets [m], how far away the first place is where he can't be, and how high the floor is before it [m]."""

    last: float
    far: float
    floor: float


def _met(controller: Any, state: CharacterState, velocity: Sequence[float], around: Sequence[Any], share: float = 1.0, more: float = 0.0) -> Met | None:
    """What somebody comes to who goes on as `before` has it; None where that is far away."""
    speed, floor, here = math.hypot(*velocity), float(state.floor), np.asarray(state.ground[:2], float)
    if speed < 1e-6 or not len(around):
        return None
    pace = float(np.hypot(state.velocity[0], state.velocity[2]))
    ahead = np.asarray(velocity, float) / speed
    for far in np.arange(1, 2 + int((share * (STOPS[0] + STOPS[1] * max(pace, speed)**2 / agility(controller)) + more) / PACE)) * PACE:
        if room(here + far * ahead, floor, around) <= 0.0:
            low, high = far - PACE, far
            while high - low > FINE:
                middle = 0.5 * (low + high)
                low, high = (low, middle) if room(here + middle * ahead, floor, around) <= 0.0 else (middle, high)
            return Met(low, high, floor)
        x, z = here + far * ahead
        floor = floor_at(float(x), float(z), around, floor + STEP)
    return None


def _short(controller: Any, state: CharacterState, velocity: Sequence[float], around: Sequence[Any], met: Met, leaps: bool) -> tuple[float, float]:
    """Where x, z [m] to come to rest before what one comes to straight on. leaps: with a leap in mind."""
    here, ahead = np.asarray(state.ground[:2], float), np.asarray(velocity, float) / math.hypot(*velocity)
    far = met.last - SHORT[is_edge(here + met.far * ahead, met.floor, around)]
    far -= lacking(here + far * ahead, ahead, met.floor, around, controller.size) if leaps else 0.0
    x, z = here + max(far, 0.0) * ahead
    return float(x), float(z)


def lacking(place: np.ndarray, ahead: np.ndarray, floor: float, around: Sequence[Any], size: float, within: float = math.inf, more: float = 0.0) -> float:
    """How much farther [m] a body of a size at a place (2,) on a floor [m] would have to be from what lies ahead (2,) of it, no farther than `within` [m], to leap onto that, and
    `more` [m] at standard height farther."""
    lacks, risen, left = 0.0, 0.0, LEGS * size * np.array([ahead[1], -ahead[0]])
    far_on = np.arange(0.0, min((CLEARS[-1][1] + more) * size, within), FINE)
    legs = place + far_on[:, None, None] * ahead + np.array([left, -left])
    for far, rise in zip(far_on, floors_at(legs, around, floor + UP).max(-1) - floor):
        if rise > risen:
            risen = rise
            clear = clear_of(rise, size)
            lacks = max(lacks, clear + more * size - far if clear else 0.0)
    return lacks


def clear_of(rise: float, size: float = 1.0) -> float:
    """How far [m] before what rises so high [m] a body of a size starts that leaps onto it."""
    return max((clear * size for high, clear in CLEARS if high * size < rise), default=0.0)


def cramped(controller: Any, state: CharacterState, place: Sequence[float], around: Sequence[Any], again: bool = False) -> float:
    """How much farther [m] somebody would have to be from what he wants to leap onto, whose ring lies at a place (2,) [m]; 0 where he is far enough, and where he has
    no room to go back. again: whether he found that he can't from where he thought so."""
    here, floor = np.asarray(state.ground[:2], float), float(state.floor)
    way = np.asarray(place, float) - here
    ahead = way / max(float(np.hypot(*way)), 1e-9)
    lacks = lacking(here, ahead, floor, around, controller.size, float(np.hypot(*way)), AGAIN * again)
    behind = here - (BACK + lacks) * ahead
    return lacks if lacks and room(behind, floor, around) > 0.0 and abs(floor_at(float(behind[0]), float(behind[1]), around, floor + STEP) - floor) < RISES else 0.0


def onto(state: CharacterState, way: Sequence[float], around: Sequence[Any]) -> tuple[float, float] | None:
    """Where x, z [m] from somebody who stands, held up before something on his way (2,), his ring lies at first: on what he stands before, or below the edge; None where
    there is no room, or the same floor as his own."""
    floor, goes = float(state.floor), math.hypot(*way)
    for far in LANDS if goes > 0.0 else ():
        x, z = (float(far) * part / goes for part in way)
        there = np.asarray(state.ground[:2], float) + (x, z)
        high = floor_at(float(there[0]), float(there[1]), around, floor + UP)
        if abs(high - floor) > OTHER and room(there, high, around) > 0.0:
            return x, z
    return None


def rises(controller: Any, state: CharacterState, velocity: Sequence[float], around: Sequence[Any], share: float = 1.0, more: float = 0.0) -> bool:
    """Whether the floor rises by more than a runner takes in stride where somebody goes with a velocity (2,) [m/s] in the world, no farther away than `before` looks."""
    floor, ahead, speed = float(state.floor), np.asarray(velocity, float), math.hypot(*velocity)
    count = 2 + int((share * (STOPS[0] + STOPS[1] * speed**2 / agility(controller)) + more) / PACE)
    places = np.asarray(state.ground[:2], float) + np.arange(1, count)[:, None] * PACE * ahead / speed
    return bool((floors_at(places, around, floor + UP) > floor + RISES).any())


def agility(controller: Any) -> float:
    """How agile somebody is, beside a person, whose number is 1, and no more than that."""
    return min(getattr(controller.settings, "agility", 1.0), 1.0)


def is_edge(place: np.ndarray, floor: float, around: Sequence[Any]) -> bool:
    """Whether there is no room at a place (2,) because the floor ends there, and not because something stands there."""
    return not touches(place, floor, around, 0.3)


def touches(place: np.ndarray, floor: float, around: Sequence[Any], near: float = TOUCHES) -> bool:
    """Whether something solid is as near to a body at a place (2,)."""
    body = np.array([[place[0], floor + height, place[1]] for height in BODY])
    return bool((clearance(body, around) < near).any())


def even_ahead(state: CharacterState, around: Sequence[Any]) -> bool:
    """Whether the floor is even, and free, as far before somebody who goes as a small leap leads him."""
    way, floor = np.array(in_world(state.ground, state.velocity)), float(state.floor)
    pace = max(float(np.hypot(*way)), 1e-9)
    for far in EVEN if len(around) else ():
        place = np.asarray(state.ground, float)[:2] + far * way / pace
        if abs(floor_at(place[0], place[1], around, floor + UP) - floor) > LEVEL or room(place, floor, around) <= 0.0:
            return False
    return True
