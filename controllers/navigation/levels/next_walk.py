"""What of a way is walked next: to the goal, or to where a leap goes off."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np

from ...contract import CharacterState, Controller, Goal, Intent, Leap
from .journeys import Crossing, journey
from .run_up import farther
from .surfaces import levels_of


class Leg(NamedTuple):
    """A walk. place: (2,) x, z [m] where it leads. heading: [rad] to stand there, or None to stand as one comes. around: what is in its way.

    crossings: the leaps of the whole way that is left, the first at the end of this walk. reason: why no way leads to the goal, or "".
    """

    place: np.ndarray
    heading: float | None
    around: Sequence[Any]
    crossings: tuple[Crossing, ...] = ()
    reason: str = ""


def next_leg(walker: Controller, state: CharacterState, goal: Goal, around: Sequence[Any], barred: Iterable[tuple[float, ...]] = ()) -> Leg:
    """How the way to a goal goes on, for a walker who stands in `state`. barred: leaps, as `named`, that he could not make."""
    levels, here = levels_of(around), np.asarray(state.ground, float)[:2]
    start = levels.under(here, float(state.floor))
    region = int(levels.regions[start])
    level = start == levels.floor and np.count_nonzero(levels.regions == region) == 1 and not levels.slopes.any()
    stops = around if level else levels.stops(region)
    end = levels.meant(goal.floor, region)
    if levels.regions[end] == region:
        return Leg(goal.floor, goal.heading, stops)

    def able(leap: Crossing) -> str | None:
        why = walker.refusal(walker.start(leap.ground, leap.height), Intent(leap=Leap(leap.place), around=around))
        return "" if why and farther(walker, leap, around) else why

    way = journey(levels, here, start, goal.floor, end, able, barred)
    if way.crossings:
        first = way.crossings[0].ground
        return Leg(first[:2], float(first[2]), stops, way.crossings)
    return Leg(goal.floor, goal.heading, stops, (), way.reason)
