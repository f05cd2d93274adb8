"""The edge over which somebody leaps who lands higher or lower than he leaves: his legs clear it on both sides.

What is known of it is where his way crosses it, and that the floor is as high as where he leaves on this side and as where he lands on the other.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ...navigation import floor_at
from ..body import Ledge, Start

EACH, HIGHER = 0.02, 0.06
"""The way is looked at so often [m]; and who lands no more than the second higher or lower [m] leaps over no edge."""
BESIDE = 0.02, 0.08
"""Feet are as high as the upper floor already so far before it [m], at standard height; the second those that are looked at seldom."""


def over_ledge(start: Start, place: np.ndarray, floor: float, around: Sequence[Any]) -> Start:
    """The same start of one who leaps off a floor [m] to a place (3,), with the edge on his way; as it is where he leaps over none."""
    up = float(place[1]) - floor
    if start.single is None or not len(around) or abs(up) < HIGHER:
        return start
    here = start.feet[start.single, [0, 2]]
    way = place[[0, 2]] - here
    far = float(np.hypot(*way))
    if far < EACH:
        return start
    way, high = way / far, max(floor, float(place[1])) + HIGHER
    middle = 0.5 * (floor + float(place[1]))
    for gone in np.arange(0.0, far, EACH):
        x, z = here + gone * way
        if (floor_at(x, z, around, high) - middle) * up > 0.0:
            toward = math.copysign(1.0, up)
            return replace(start, ledge=Ledge(float(x), float(z), float(toward * way[0]), float(toward * way[1]), abs(up)))
    return start


def over_lower(ledge: Ledge | None, places: np.ndarray, size: float, seldom: bool = False) -> np.ndarray:
    """How much higher (...) [m] the floor at places (..., 3) is than the lower of both, beside an edge; 0 beside none. size: over an adult's. seldom: whether they are looked at seldom."""
    if ledge is None:
        return np.zeros(places.shape[:-1])
    beyond = (places[..., 0] - ledge.x) * ledge.up_x + (places[..., 2] - ledge.z) * ledge.up_z
    return np.where(beyond > -BESIDE[seldom] * size, ledge.high, 0.0)
