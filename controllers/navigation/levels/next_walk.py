"""What of a way is walked next: to the goal, or to where a leap goes off."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np

from ...contract import CharacterState, Controller, Goal, Intent, Leap
from .journeys import Crossing, journey
from .run_up import farther
from .surfaces import levels_of

Refusal = Callable[[CharacterState, Intent], str | None]
"""Says why nobody could leap from a state as an intent says, as `Controller.refusal`."""


class Leg(NamedTuple):
    """A walk. place: (2,) x, z [m] where it leads. heading: [rad] to stand there, or None to stand as one comes. around: what is in its way.

    crossings: the leaps of the whole way that is left, the first at the end of this walk. reason: why no way leads to the goal, or "".
    """

    place: np.ndarray
    heading: float | None
    around: Sequence[Any]
    crossings: tuple[Crossing, ...] = ()
    reason: str = ""


def next_leg(walker: Controller, state: CharacterState, goal: Goal, around: Sequence[Any], barred: Iterable[tuple[float, ...]] = (),
             refusal: Refusal | None = None, known: Sequence[Crossing] = ()) -> Leg:
    """How the way to a goal goes on, for a walker who stands in `state`. barred: leaps, as `named`, that he could not make. refusal: how the walker
    is asked for leaps, by default his own. known: the leaps that are left of a way that he is on: they are not sought again where they lead on from here.
    """
    refusal = walker.refusal if refusal is None else refusal
    levels, here = levels_of(around), np.asarray(state.ground, float)[:2]
    start = levels.under(here, float(state.floor))
    region = int(levels.regions[start])
    level = start == levels.floor and np.count_nonzero(levels.regions == region) == 1 and not levels.slopes.any()
    stops = around if level else levels.stops(region)
    end = levels.meant(goal.floor, region)
    if levels.regions[end] == region:
        return Leg(goal.floor, goal.heading, stops)

    if known and levels.regions[levels.under(known[0].ground[:2], known[0].height)] == region:
        return Leg(known[0].ground[:2], float(known[0].ground[2]), stops, tuple(known))

    def able(leap: Crossing) -> str | None:
        why = refusal(walker.start(leap.ground, leap.height), Intent(leap=Leap(leap.place), around=around))
        return "" if why and farther(walker, leap, around, refusal) else why

    way = journey(levels, here, start, goal.floor, end, able, barred)
    if way.crossings:
        first = way.crossings[0].ground
        return Leg(first[:2], float(first[2]), stops, way.crossings)
    return Leg(goal.floor, goal.heading, stops, (), way.reason)
