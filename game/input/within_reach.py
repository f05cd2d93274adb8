"""Where the ring of who aims from a stand stops: a little beyond what his body reaches, on the floor and on what is higher."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

from gambol.controllers.contract import CharacterState
from gambol.controllers.navigation import STEP, floor_at

from .on_top import past_edge
from .straight_ahead import UP, clear_of

BEYOND = 0.2
"""On a floor no lower the ring stops so far beyond what the body reaches there [m]: from everywhere it can be, one leaps as far as one can."""
ONTO, STEADY = 0.05, 0.02
"""And on a box so far beyond what it reaches [m]: who aims farther is off later, as he looks for where he can land instead. There it lies on a grid so fine [m], lest another leap be asked, and
looked for anew, with each millimetre that somebody still glides."""
CLIMBS = 1.5
"""Each metre that a box is higher takes so much off where the ring stops [m]: what leaps onto boxes fall short by, and a reserve."""
OVER_EDGE = 0.86, 1.9
"""And it stops so far past the edge of a box: this share of how far the body leaps over level ground, and so much less for each metre up [m]. From near by legs clear no more of a high one."""
FROM_NEAR = 0.35, 2.0
"""Nor farther past the edge than the first [m] of who is as near to that as one can be for a leap, and so many times as far as he is farther off: legs and arms swing too low over it."""
LOWER = 0.05
"""Floor that is lower by more than this [m] may be reached from farther off."""

Reaches = Callable[[float], float]
"""About how far a standing body leaps [m], so far aside [rad] of the way it faces."""


def anywhere(aside: float) -> float:
    """What nobody knows of is no limit."""
    return math.inf


def stopped_at(place: tuple[float, float], heading: float | None, state: CharacterState, around: Sequence[Any], reaches: Reaches) -> tuple[float, float]:
    """A place x, z [m] to which somebody pushed the ring, or where on the way there it stops. heading: in which he wants to land [rad]; None where he said none."""
    floor = float(state.floor)
    x, z = (place[k] - float(state.ground[k]) for k in (0, 1))
    aside = 0.0 if heading is None else math.atan2(x, z) - float(state.ground[2])  # who says no heading turns to the ring, and to one on something first
    there = floor_at(*place, around, floor + UP)
    far, up, reach = math.hypot(x, z), max(there - floor, 0.0), reaches(aside)
    stops = reach - CLIMBS * up + (ONTO if up > LOWER else BEYOND)
    if LOWER < up and reach < math.inf:
        past = past_edge(place, (float(state.ground[0]), float(state.ground[1])), there, around)
        over = min(OVER_EDGE[0] * reach - OVER_EDGE[1] * up, FROM_NEAR[0] + FROM_NEAR[1] * (far - past - clear_of(up)) if up > STEP else math.inf)
        stops = min(stops, far - max(past - max(over, 0.0), 0.0))
    share = stops / max(far, 1e-9)
    if share >= 1.0 or there < floor - LOWER:
        return place
    near = float(state.ground[0]) + share * x, float(state.ground[1]) + share * z
    near = near if up <= LOWER else (STEADY * round(near[0] / STEADY), STEADY * round(near[1] / STEADY))
    return near if floor_at(*near, around, floor + UP) > there - LOWER else place  # else it is too far off for any leap, which is told
