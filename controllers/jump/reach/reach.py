"""What a jumper can reach: a plan that touches nothing, or why there is none, and the nearest place to which there is one."""

from __future__ import annotations

import math
from collections.abc import Generator, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from ...navigation import floor_at, gap
from ..body import FLAT, Physique, Start, landing_feet, soles
from ..motion import Path, Plan, grounded, path, rolled, rolls, room
from ..planner import plan
from ..prior import Prior
from .feasibility import HARD, STEEP, fault, stopped, wrong
from .sweep import Touch, touch

HEIGHTS = 1.0, 1.12, 1.26, 1.42, 1.6
"""What the airtime is multiplied by until the arc clears what stands in its way."""
WAYS = (False, False), (False, True), (True, True)
"""With which arms, down or not, and legs, drawn up or not, a body tries to pass what is in its way."""
GRID, FARTHEST = 0.02, 10.0
"""The nearest place is sought so finely [m], and no farther away than nobody leaps on Earth [m]."""
BACK = 1.0, 0.85, 0.6
"""A place that is offered instead of another is planned, too: if something would be touched there, less far on the way."""
KEPT = 32
"""So many plans are known for a while: who asks whether a leap can be made makes it soon."""
TRIES = 3
"""With so many plans at most: who was refused shall not wait for the reason."""
CARRIED = (0.75,), (0.6,), (0.95,), (1.2,)
"""For so long [s] a run would carry a body that leaps without effort, on Earth, at standard height: the usual first."""
LITTLE, RISES = 0.06, 0.03
"""Who leaves in haste is elsewhere by so much at most [m]; and a body that flies higher by no more than the rise of its arc and the second [m]."""
FLUSH = 0.03
"""A target lies on the floor if it is no farther from it than this [m]; only told where something stands about."""


class Reach:
    """Looks for jumps of one body under one gravity.

    physique: whose body. gravity: (3,) [m/s²], straight down. prior: how people carry themselves.
    """

    def __init__(self, physique: Physique, gravity: np.ndarray, prior: Prior):
        self.physique, self.gravity, self.prior = physique, gravity, prior
        self._lately: tuple[tuple[Any, Sequence[Any], tuple[Plan | None, str]], ...] = ()

    def attempt(self, start: Start, place: np.ndarray, floor: float, airtime: float | None,
                around: Sequence[Any], tries: int | None = None) -> tuple[Plan | None, str]:
        """A plan that touches nothing, or None and why there is none. Where something is in the way of its limbs, they are drawn up, or
        it jumps higher. tries: so many plans at most. What was asked just now is not planned again."""
        asked = (*(part if part is None or isinstance(part, float | int) else part.tobytes() for part in vars(start).values()),
                 place.tobytes(), floor, airtime, tries)
        for known, things, made in self._lately:
            if known == asked and (things is around or list(things) == list(around)):
                return made
        made = self._planned(start, place, floor, airtime, around, tries)
        self._lately = (*self._lately[1 - KEPT:], (asked, around, made))
        return made

    def _planned(self, start: Start, place: np.ndarray, floor: float, airtime: float | None,
                 around: Sequence[Any], tries: int | None) -> tuple[Plan | None, str]:
        """What `attempt` gives, planned."""
        why = self.footing(start, place, floor, around)
        if why:
            return None, why
        told, count, arcs = "", 0, self.arcs(start, place, floor, airtime, around)
        found: tuple[Path, str, int] | None = next(arcs)
        while found is not None:
            (way, why, haste), deep = found, None
            if not why:
                made, count = plan(self.physique, replace(start, haste=haste), way, place, floor), count + 1
                made, why = self._down(made, around)
                why = why or wrong(self.physique, made)
                if not why:
                    hit = touch(self.physique, made, around)
                    if hit is None:
                        return made, ""
                    why, deep = hit.reason, hit.deep
            told = told or why
            if count == tries:
                break
            found = _next(arcs, deep)
        return None, told

    def _down(self, made: Plan, around: Sequence[Any]) -> tuple[Plan, str]:
        """A plan as it comes down: with a roll where that is so hard that people roll, if there is room; why it can't come down, if so."""
        if rolls(self.physique, made.path):
            rolling = rolled(self.physique, made)
            if room(self.physique, rolling, around):
                return rolling, ""
            if stopped(self.physique, made.path):
                return made, STEEP + "; there is no room to roll"
        return made, ""

    def survey(self, start: Start, place: np.ndarray, floor: float, airtime: float | None = None,
               around: Sequence[Any] = (), heights: Sequence[float] = HEIGHTS) -> tuple[Path, str]:
        """The path to a place (3,) off a floor [m], and why it can't be gone, if so: a look at the place, then `arcs`; nothing is planned."""
        why = self.footing(start, place, floor, around)
        if why:
            return self.path(start, place, floor, airtime), why
        first = None
        for way, why, _ in self.arcs(start, place, floor, airtime, around, heights):
            first = first or (way, why)
            if not why:
                return way, ""
        assert first is not None  # there is always one
        return first

    def touching(self, start: Start, place: np.ndarray, floor: float, airtime: float | None = None, around: Sequence[Any] = ()) -> Touch | None:
        """What the usual jump to a place (3,) would touch, and how the body would lie in it; None if nothing, or if there is no such jump."""
        way, _, haste = next(self.arcs(start, place, floor, airtime, around))
        if way.push is None or way.course is None or not np.isfinite(np.concatenate([way.low, way.leave, way.land, way.velocity, [way.course.outside]])).all():
            return None
        made = plan(self.physique, replace(start, haste=haste), way, place, floor)
        return None if wrong(self.physique, made) else touch(self.physique, made, around)

    def footing(self, start: Start, place: np.ndarray, floor: float, around: Sequence[Any]) -> str:
        """Why nobody can stand at a place (3,), if so."""
        around = [thing for thing in around if not hasattr(thing, "place")]
        if any(gap(place[None] + [0.0, 0.05, 0.0], thing)[0] < 0.0 for thing in around):
            return "that place is inside something solid"
        below = floor_at(place[0], place[2], around, place[1] + FLUSH)
        if around and below < place[1] - FLUSH:
            return f"there is nothing to land on at {place[1]:.2f} m; the floor there lies at {below:.2f} m"
        body = self.physique.tables
        corners = soles(landing_feet(place, start.lands, body), body)
        if around and min(floor_at(x, z, around, place[1] + FLUSH) for x, _, z in corners) < place[1] - FLUSH:
            return "too near an edge: only part of its feet would find floor"
        return ""

    def arcs(self, start: Start, place: np.ndarray, floor: float, airtime: float | None = None,
             around: Sequence[Any] = (), heights: Sequence[float] = HEIGHTS) -> Generator[tuple[Path, str, int], float | None, None]:
        """The paths to a place, why each can't be gone, if so, and in which haste, see `Start`: the usual one first; where something stands about then with
        the legs drawn up and the arms down and, without an airtime, higher: by `heights` times the airtime, which begin with 1. None is gone in more haste than it takes. Who is told (by `send`) how deep [m] something lay
        in the plan along the last of them leaves out those along which it would as well."""
        first, hits = None, dict[bool, tuple[float, float]]()
        for higher in heights:
            flight = airtime if first is None else first.airtime * higher
            for low, tucked in WAYS if len(around) else WAYS[:1]:
                if first is not None and higher > 1.0 and (not tucked or low in hits and self._still(*hits[low], first.airtime * higher)):
                    continue
                arc = partial(self._arc, start, place, floor, around, flight, low, tucked)
                quick, deep, slower = None, None, (0, 1)
                if higher == 1.0:
                    (way, why), slower = arc(0), (1,)
                    deep = yield way, why, 0
                if not slower[0] or why:  # who can't go it in all haste is not asked whether he can otherwise
                    quick = arc(2)
                    for haste in slower if not quick[1] else ():
                        way, why = arc(haste)
                        if not why:
                            deep = yield way, why, haste
                            break
                if deep is None or deep < LITTLE or start.runs and higher == 1.0:  # who runs flies lower then
                    way, why = quick or arc(2)
                    deep = yield way, why, 2
                first = first or way
                if deep is not None:
                    hits[low] = way.airtime, deep
                if not way.strong or why.startswith(HARD):
                    return
            if airtime is not None or not len(around):
                return

    def _still(self, airtime: float, deep: float, longer: float) -> bool:
        """Whether something that lay so deep [m] in a plan would still lie in one that flies longer [s], and so much higher."""
        return deep > RISES - 0.125 * float(self.gravity[1]) * (longer**2 - airtime**2)

    def _arc(self, start: Start, place: np.ndarray, floor: float, around: Sequence[Any], airtime: float | None, low_arms: bool, tucked: bool,
             haste: int) -> tuple[Path, str]:
        """One path to a place, and why it can't be gone, if so."""
        start = replace(start, haste=haste)
        way = grounded(self.physique, start, self.path(start, place, floor, airtime, low_arms, tucked), floor)
        return way, fault(self.physique, way, around, floor)

    def nearest(self, start: Start, place: np.ndarray, floor: float, airtime: float | None = None,
                around: Sequence[Any] = ()) -> np.ndarray | None:
        """The place (3,) [m] that can be reached nearest to a refused one, by bisection on the way there from one that takes
        no effort: where it stands, or where a run would carry the body; to `GRID`, however far the refused one is. None if that can't be
        reached either. It is looked for along arcs of the usual height alone: who would have to fly higher to get farther is offered a nearer one."""
        here = self.middle(start, floor)

        def reached(there: np.ndarray) -> bool:
            if len(around):
                there[1] = floor_at(there[0], there[2], around, max(place[1], floor) + 1e-6)
            return not self.survey(start, there, floor, airtime, around, HEIGHTS[:1])[1]
        run = start.velocity * FLAT * np.sqrt(9.81 * self.physique.size / -self.gravity[1])
        easy = here + np.array([[0.0]] if start.single is None else CARRIED) * run
        found = next((there for there in easy if reached(there)), None)
        if found is None:
            return None
        begun, way = found.copy(), place - found
        length = max(float(np.linalg.norm(way)), 1e-9)
        low, high = 0, math.ceil(min(length, FARTHEST * max(1.0, 9.81 / -self.gravity[1])) / GRID)
        while high - low > 1:
            middle = (low + high) // 2
            there = begun + middle * GRID / length * way
            if reached(there):
                low, found = middle, there
            else:
                high = middle
        for share in BACK:
            there = begun + share * (found - begun)
            there[1] = found[1] if not len(around) else floor_at(there[0], there[2], around, max(place[1], floor) + 1e-6)
            if self.attempt(start, there, floor, airtime, around, TRIES)[0] is not None:
                return there
        return None

    def middle(self, start: Start, floor: float) -> np.ndarray:
        """The middle (3,) of both soles as they come to stand on a floor [m]: where a jump straight up lands."""
        body = self.physique.tables
        return soles(start.planted(floor, body), body).mean(0) * FLAT + [0.0, floor, 0.0]

    def path(self, start: Start, place: np.ndarray, floor: float, airtime: float | None = None, low_arms: bool = False,
             tucked: bool = False) -> Path:
        """The path estimate alone: the arc to draw while aiming."""
        body = self.physique.tables
        feet = start.planted(floor, body)
        pushing = feet if start.single is None else feet[start.single:start.single + 1]
        return path(self.physique, start, pushing, landing_feet(place, start.lands, body), floor,
                    self.gravity, airtime, low_arms, self.prior, tucked)


def _next(arcs: Generator[tuple[Path, str, int], float | None, None], deep: float | None) -> tuple[Path, str, int] | None:
    """The next of some paths, told how deep something lay in the last one's plan; None where there is none."""
    try:
        return arcs.send(deep)
    except StopIteration:
        return None
