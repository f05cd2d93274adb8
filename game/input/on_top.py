"""Where the ring of a standing body may lie: both feet find floor of one height there, or it lies a little beside where hands left it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from gambol.controllers.contract import CharacterState
from gambol.controllers.navigation import floor_at, floors_at, slope_at

from .straight_ahead import RISES, UP, onto

ROUND = np.stack([np.sin(np.arange(8) * math.pi / 4.0), np.cos(np.arange(8) * math.pi / 4.0)], axis=-1)
"""Ways (8, 2) all round."""
SOLES = 0.19
"""Both soles side by side lie within so much of their middle [m]."""
ASIDE, FINE = 0.3, 0.05
"""The ring is moved by no more than this, and is looked for so finely [m]."""
STEPS = 0.1, 0.0125
"""The edge of what the ring lies on is looked for in such steps back to the body, and found to so much [m]."""
LEVEL = 0.03
"""Floor of one height is no more uneven than this [m]."""
AT_HAND = np.arange(0.15, 0.71, 0.05)
"""What rises no farther before somebody than the last of these [m] he stands before, or will in a moment, ..."""
WALKS = 1.8
"""... if he goes no faster than this [m/s]."""


def on_top(place: tuple[float, float], floor: float, around: Sequence[Any]) -> tuple[float, float]:
    """The nearest place x, z [m] to another at which both feet find floor of one height, that lies no higher over a body's own [m] than can be leapt to; the same place
    where there is none near, and on a slope."""
    if not len(around) or slope_at(*place, around, floor + UP).any() or _even(place, floor, around):
        return place
    places = (np.asarray(place) + np.arange(FINE, ASIDE + 0.5 * FINE, FINE)[:, None, None] * ROUND).reshape(-1, 2)  # the nearest first
    return next(((float(x), float(z)) for x, z in places if _even((x, z), floor, around)), place)


def at_hand(state: CharacterState, way: Sequence[float], around: Sequence[Any]) -> tuple[float, float] | None:
    """Where x, z [m] from somebody who stands, or walks, right before what he can leap onto, on the way (2,) that he holds his stick, his ring lies at first: on that, where both feet fit; None where there is
    no such thing."""
    floor, goes = float(state.floor), math.hypot(*way)
    if goes == 0.0 or not len(around) or math.hypot(state.velocity[0], state.velocity[2]) > WALKS:
        return None
    here = np.asarray(state.ground[:2], float)
    if not (floors_at(here + AT_HAND[:, None] * np.asarray(way, float) / goes, around, floor + UP) > floor + RISES).any():
        return None
    lies = onto(state, way, around)
    if lies is None:
        return None
    place = on_top((float(here[0] + lies[0]), float(here[1] + lies[1])), floor, around)
    high = floor_at(*place, around, floor + UP)
    return lies if high > floor + RISES and not slope_at(*place, around, high + LEVEL).any() and _even(place, floor, around) else None


def past_edge(place: tuple[float, float], here: tuple[float, float], high: float, around: Sequence[Any]) -> float:
    """How far [m] a place (2,) on what is `high` [m] lies past the edge of that, on the straight way from a body here (2,)."""
    far = math.dist(place, here)
    back = (np.asarray(here, float) - place) / max(far, 1e-9)

    def on_it(past: float) -> bool:
        x, z = np.asarray(place) + past * back
        return floor_at(float(x), float(z), around, high + LEVEL) > high - LEVEL
    past = 0.0
    for step in STEPS[0] * 0.5**np.arange(math.log2(STEPS[0] / STEPS[1]) + 0.5):
        while past < far and on_it(past + step):
            past += float(step)
    return past


def _even(place: tuple[float, float], floor: float, around: Sequence[Any]) -> bool:
    """Whether the floor is of one height all round a place (2,)."""
    round_it = floors_at(np.asarray(place) + SOLES * ROUND, around, floor + UP)
    return bool((abs(round_it - floor_at(*place, around, floor + UP)) < LEVEL).all())
