"""What of a way is walked next: to the goal, or to where a leap goes off."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np

from ...contract import CharacterState, Controller, Goal, Intent, Leap
from .journeys import LANDING, Crossing, journey, named
from .run_up import TRIES, farther, near, start_of
from .surfaces import levels_of

Refusal = Callable[[CharacterState, Intent], str | None]
"""Says why nobody could leap from a state as an intent says, as `Controller.refusal`."""


TOO_FAR = "too far"
"""How the reasons begin by which one leaps there only from a walk."""
NARROW = LANDING - 0.02
"""Walks between leaps, which end so near to edges, keep at least so far from them as their lengths are looked at [m]; ..."""
WALKS = 20
"""... so many of them take as long as to ask about a leap."""
HIGH, SHORT = 0.35, 0.03
"""Nobody comes to stand just where a leap is to go off: of one that leads up by more than the first [m] it is asked from so far [m] before that, lest it can be made from
there alone."""
RUN_UPS = 2
"""A leap that did not go off at so many run-ups is left."""


class Leg(NamedTuple):
    """A walk. place: (2,) x, z [m] where it leads. heading: [rad] to stand there, or None to stand as one comes. around: what is in its way.

    crossings: the leaps of the whole way that is left, the first at the end of this walk, or, where it leads back for a run-up, of the next. reason: why no
    way leads to the goal, or "".
    """

    place: np.ndarray
    heading: float | None
    around: Sequence[Any]
    crossings: tuple[Crossing, ...] = ()
    reason: str = ""
    back: bool = False


def next_leg(walker: Controller, state: CharacterState, goal: Goal, around: Sequence[Any], barred: Iterable[tuple[float, ...]] = (),
             refusal: Refusal | None = None, known: Sequence[Crossing] = (), stands: Sequence[tuple[float, ...]] = (), ask: Callable[[], None] = lambda: None) -> Leg:
    """How the way to a goal goes on, for a walker who stands in `state`. barred: leaps, as `named`, that he could not make. refusal: how the walker
    is asked for leaps, by default his own. known: the leaps that are left of a way that he is on: they are not sought again where they lead on from here.
    stands: leaps, as `named`, that did not go off from a walk, once for each time. ask: is called for what takes long, so often as it counts for leaps.
    """
    refusal, tried, told = walker.refusal if refusal is None else refusal, set[tuple[float, ...]](), dict[bytes, str | None]()
    shapes, walks = dict[int, np.ndarray](), 0
    levels, here = levels_of(around), np.asarray(state.ground, float)[:2]
    start = levels.under(here, float(state.floor))
    region = int(levels.regions[start])
    level = start == levels.floor and np.count_nonzero(levels.regions == region) == 1 and not levels.slopes.any()
    stops = around if level else levels.stops(region)
    end = levels.meant(goal.floor, region)
    if levels.regions[end] == region:
        return Leg(goal.floor, goal.heading, stops)

    def from_stand(leap: Crossing) -> str | None:
        if (which := leap.ground.tobytes() + leap.place.tobytes()) not in told:
            x, z, heading = leap.ground
            ground = (x - SHORT * np.sin(heading), z - SHORT * np.cos(heading), heading) if leap.asks[1] > HIGH else leap.ground
            told[which] = refusal(walker.start(ground, leap.height), Intent(leap=Leap(leap.place), around=around))
        return told[which]

    def pays(leap: Crossing) -> None:
        """What it takes to find its run-up counts once for all that go as far."""
        asks = tuple(np.round(leap.asks, 1))
        for _ in range(TRIES if asks not in tried else 0):
            ask()
        tried.add(asks)

    def able(leap: Crossing) -> str | None:
        why = from_stand(leap)
        if why is None or not why.startswith(TOO_FAR):
            return why
        pays(leap)
        return "" if farther(walker, leap, around) else why

    def walk(region: int, begins: np.ndarray, ends: np.ndarray) -> float:
        """How long [m] a walk in a region is; as if it were straight where no way is found."""
        from ..routes import shapes_of, ways  # who never goes to a goal loads no planner

        nonlocal walks
        walks += 1
        if walks % WALKS == 0:
            ask()
        if region not in shapes:
            shapes[region] = shapes_of(levels.stops(region))
        found = ways(begins, ends, shapes[region], NARROW, most=1)
        return float(np.linalg.norm(np.diff(found[0], axis=0), axis=1).sum()) if found else math.dist(begins, ends)

    def to(crossings: tuple[Crossing, ...]) -> Leg:
        """The walk to the first of them; back, where he is too near for the run-up without which it is too far."""
        first = crossings[0]
        if near(first, here) and stands.count(named(first)) < RUN_UPS and from_stand(first):
            pays(first)
            begins = start_of(walker, first, around)
            if begins is not None:
                return Leg(begins, float(first.ground[2]), stops, crossings, back=True)
        return Leg(first.ground[:2], float(first.ground[2]), stops, crossings)

    if known and levels.regions[levels.under(known[0].ground[:2], known[0].height)] == region:
        return to(tuple(known))
    from ..planning import unfit

    if why := unfit(goal.floor, levels.stops(int(levels.regions[end])), size=walker.size):
        return Leg(goal.floor, goal.heading, stops, (), why)  # before anybody leaps there
    way = journey(levels, here, start, goal.floor, end, able, barred, walk)
    return to(way.crossings) if way.crossings else Leg(goal.floor, goal.heading, stops, (), way.reason)
