"""What a leap that is asked says of its start: on which feet it lands and turned how far, and whether there is room to run on."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ...contract import Leap
from ...navigation import floor_at, room
from ..body import Start
from .floors import UP

HALF_TURN = 1e-3
"""So little short of half a turn [rad] is one."""
FEET = "left", "right", "both"
"""On which feet one may land to hop on."""
BEYOND, EACH, BRAKES = 1.0, 0.2, 2.8
"""Who runs on from where he lands needs floor and room so far beyond [m], looked at so often [m]; and who wants to stay there as far as he goes braking so hard [m/s²]."""


def turning(start: Start, leap: Leap | None) -> Start:
    """The same start of one who lands on the feet and in the heading that a leap says, if it says any: the shorter way round, to the left where both
    are half a turn."""
    if leap is not None and leap.on in FEET:
        start = replace(start, onto=FEET.index(leap.on))
    if leap is not None and leap.stays:
        start = replace(start, stays=True)
    if leap is None or leap.heading is None or not math.isfinite(leap.heading):
        return start
    turn = math.remainder(leap.heading - start.heading, math.tau)
    return replace(start, turn=turn + math.tau if turn < -math.pi + HALF_TURN else turn)


def cramped(start: Start, leap: Leap | None, ground: np.ndarray, around: Sequence[Any]) -> Start:
    """The same start of one who has no room to run on beyond where he lands: before a wall, or an edge that he wants to stay on. ground: where x, z [m] he is."""
    if leap is None or leap.place is None or start.single is None or not len(around):
        return start
    place = np.asarray(leap.place, float)
    if place.shape != (3,) or not np.isfinite(place).all():
        return start
    there, high = place[[0, 2]], float(place[1])
    ahead = (there - ground[:2]) / max(float(np.hypot(*(there - ground[:2]))), 1e-9)
    stops = float(start.velocity[[0, 2]] @ start.velocity[[0, 2]]) / (2.0 * BRAKES) if leap.stays else 0.0
    for far in np.arange(EACH, max(BEYOND, stops) + 0.5 * EACH, EACH):
        x, z = there + far * ahead
        if room(np.array([x, z]), high, around) > 0.0:
            high = floor_at(x, z, around, high + UP)  # as slopes and treads go on
            continue
        return replace(start, cramped=leap.stays or floor_at(x, z, around, high + UP) >= high - UP)
    return start
