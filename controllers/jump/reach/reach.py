"""What a jumper can reach: a plan that touches nothing, or why there is none, and the nearest place to which there is one."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from ...contract import level
from ...navigation import floor_at
from ..body import FLAT, Physique, Start
from ..motion import Plan, rolled, rolls, room
from ..planner import drafted, plan
from ..prior import Prior
from .arcs import HEIGHTS, Arc, Arcs, How, following
from .feasibility import STEEP, begins, meant, stopped, wrong
from .seeking import PLAN, Pieces, counted, weighed, whole
from .sweep import Touch, surely, touch

GRID, FARTHEST = 0.02, 10.0
"""The nearest place is sought so finely [m], and no farther away than nobody leaps on Earth [m]."""
BACK = 1.0, 0.85, 0.6
"""A place that is offered instead of another is planned, too: if something would be touched there, less far on the way."""
SHORT, EVEN = (0.15, 0.3), 0.02
"""Who stands, and can't reach a place higher or lower, is offered one on the same floor first, to so much [m], that is so much nearer [m]: on the way there the floor may
lie anywhere."""
KEPT = 32
"""So many plans are known for a while: who asks whether a leap can be made makes it soon."""
DEAR = 8
"""What is found out about a leap counts once more for each so much that it costs, in pieces."""
TRIES = 3
"""With so many plans at most: who was refused shall not wait for the reason."""
MOST = 8
"""Who goes on looks at so many plans at most at one moment of his stride: of 134 leaps that random hands found so none took more than 7, and refusals up to 31, for half a second."""
CARRIED = (0.75,), (0.6,), (0.95,), (1.2,)
"""For so long [s] a run would carry a body that leaps without effort, on Earth, at standard height: the usual first."""
SENDS = 4.2
"""Each metre that a foot stands aside of who pushes off it, at standard height, sends him so much faster [m/s] to the other side: runners lean into arcs."""
WALKS = 0.3
"""Who goes no faster than this [m/s] is carried nowhere; and who pushes off both feet is in a moment where he is now."""


class Found(NamedTuple):
    """A plan, along which arc, and to which place (3,) [m]."""

    made: Plan
    arc: Arc
    place: np.ndarray


class Reach(Arcs):
    """Looks for jumps of one body under one gravity.

    physique: whose body. gravity: (3,) [m/s²], straight down. prior: how people carry themselves.
    """

    def __init__(self, physique: Physique, gravity: np.ndarray, prior: Prior):
        super().__init__(physique, gravity, prior)
        self._lately: tuple[tuple[Any, Sequence[Any], tuple[tuple[Found | None, str], int]], ...] = ()

    def attempt(self, start: Start, place: np.ndarray, floor: float, airtime: float | None,
                around: Sequence[Any], tries: int | None = None, ask: Callable[[], None] = lambda: None) -> tuple[Plan | None, str]:
        """A plan that touches nothing, or None and why there is none. Where something is in the way of its limbs, they are drawn up, or
        it jumps higher. tries: so many plans at most. What was asked just now is not planned again.
        ask: is called once more for each `DEAR` that it costs, or cost."""
        found, why = counted(self.seen(start, place, floor, airtime, around, False, tries), DEAR, ask)
        return found and found.made, why

    def seen(self, start: Start, place: np.ndarray, floor: float, airtime: float | None, around: Sequence[Any],
             parted: bool, tries: int | None = None) -> Pieces[tuple[Found | None, str]]:
        """What `planned` gives, in its pieces. Not parted, what was asked just now is not planned again, and costs at once what it cost."""
        if parted:
            return (yield from self.planned(start, place, floor, airtime, around, tries))
        asked = _asked(start, place, floor, airtime, tries)
        known = self._known(asked, around)
        if known is None:
            known = yield from weighed(self.planned(start, place, floor, airtime, around, tries))
            self._lately = (*self._lately[1 - KEPT:], (asked, around, known))
        else:
            yield known[1]
        return known[0]

    def _known(self, asked: tuple[Any, ...], around: Sequence[Any]) -> tuple[tuple[Found | None, str], int] | None:
        """What came of the same question, if that was asked just now, and what it cost."""
        return next((found for known, things, found in self._lately if known == asked and (things is around or list(things) == list(around))), None)

    def planned(self, start: Start, place: np.ndarray, floor: float, airtime: float | None,
                around: Sequence[Any], tries: int | None = None) -> Pieces[tuple[Found | None, str]]:
        """What `attempt` gives, in pieces, and along which arc."""
        start = self.onto(start, place, floor, around)
        why = self.footing(start, place, floor, around)
        if why:
            return None, why
        if tries is None and goes_on(start):
            tries = MOST
        told, count, arcs = "", 0, self.arcs(start, place, floor, airtime, around)
        arc = yield from following(arcs)
        while arc is not None:
            why, hit = arc.why, None
            if not why:
                yield PLAN
                made, why, hit = self._made(start, place, floor, around, arc)
                if made is not None:
                    return Found(made, arc, place), ""
                count += 1
            told = told or why
            if count == tries or hit is not None and hit.however:
                break
            arc = yield from following(arcs, hit and hit.deep)
        return None, told

    def again(self, how: How, start: Start, place: np.ndarray, floor: float, airtime: float | None, around: Sequence[Any]) -> Found | None:
        """The plan along an arc that was found from elsewhere; None where there is none."""
        known = self._known(_asked(start, place, floor, airtime, None), around)
        found = None if known is None else known[0][0]
        if found is not None and found.arc.how == how:
            return found
        start = self.onto(start, place, floor, around)
        if self.footing(start, place, floor, around):
            return None
        arc = self.arc(start, place, floor, around, how)
        made = None if arc.why else self._made(start, place, floor, around, arc)[0]
        return None if made is None else Found(made, arc, place)

    def _made(self, start: Start, place: np.ndarray, floor: float, around: Sequence[Any], arc: Arc) -> tuple[Plan | None, str, Touch | None]:
        """The plan along an arc; None, why not, and what it touches, if it does, where there is none."""
        start = replace(start, haste=arc.how.haste)
        draft = drafted(self.physique, start, arc.path, place, floor)
        hit = surely(self.physique, start, draft.turning, around)
        if hit is not None:
            return None, hit.reason, hit
        made, why = self._down(draft.plan(), around)
        why = why or wrong(self.physique, made)
        hit = None if why else touch(self.physique, made, around)
        return (None, why, None) if why else (None, hit.reason, hit) if hit is not None else (made, "", None)

    def _down(self, made: Plan, around: Sequence[Any]) -> tuple[Plan, str]:
        """A plan as it comes down: with a roll where that is so hard that people roll, if there is room; why it can't come down, if so."""
        if rolls(self.physique, made.path):
            rolling = rolled(self.physique, made)
            if room(self.physique, rolling, around):
                return rolling, ""
            if stopped(self.physique, made.path):
                return made, STEEP + "; there is no room to roll"
        return made, ""

    def touching(self, start: Start, place: np.ndarray, floor: float, airtime: float | None = None, around: Sequence[Any] = ()) -> Touch | None:
        """What the usual jump to a place (3,) would touch, and how the body would lie in it; None if nothing, or if there is no such jump."""
        start = self.onto(start, place, floor, around)
        arc = whole(following(self.arcs(start, place, floor, airtime, around)))
        assert arc is not None  # there is always one
        way = arc.path
        if way.push is None or way.course is None or not np.isfinite(np.concatenate([way.low, way.leave, way.land, way.velocity, [way.course.outside]])).all():
            return None
        made = plan(self.physique, replace(start, haste=arc.how.haste), way, place, floor)
        return None if wrong(self.physique, made) else touch(self.physique, made, around)

    def nearest(self, start: Start, place: np.ndarray, floor: float, airtime: float | None = None,
                around: Sequence[Any] = ()) -> np.ndarray | None:
        """The place (3,) [m] that can be reached nearest to another: that one, if it can be. It is sought by bisection on the way there from right above it, where
        it lies lower, or from one that takes no effort: where it stands, or where a walk or run would carry the body; to `GRID`, however far the other is. None if
        none of those can be reached, as in the midst of a stride. It is looked for along arcs of the usual height alone: who would have to fly higher to get
        farther is offered a nearer one.
        Refused for what is no place, ValueError for what is no floor or no start."""
        start, place, floor = begins(start), meant(place, airtime), float(level(floor))
        if self.attempt(start, place, floor, airtime, around)[0] is not None:
            return place.copy()
        return whole(self.nearby(start, place, floor, airtime, around))[0]

    def nearby(self, start: Start, place: np.ndarray, floor: float, airtime: float | None,
               around: Sequence[Any], within: float = math.inf) -> Pieces[tuple[np.ndarray | None, Found | None]]:
        """What `nearest` gives of a place that can't be reached, in pieces, and the plan to there. within: it is of no use farther than this from it [m]."""
        def ground(there: np.ndarray) -> float:
            """How high the floor is there: no higher than the place and than the slope on which it stands, as it goes on."""
            return floor_at(there[0], there[2], around, max(place[1], floor, floor + float(start.rise(there))) + 1e-6)

        def reached(there: np.ndarray) -> Pieces[bool]:
            if len(around):
                there[1] = ground(there)
            return not (yield from self.surveyed(start, there, floor, airtime, around, HEIGHTS[:1]))[1]
        for back in SHORT if len(around) and not goes_on(start) and abs(place[1] - floor) > EVEN else ():
            way = (place - self.middle(start, floor)) * FLAT
            there = place - back / max(float(np.linalg.norm(way)), 1e-9) * way
            if abs(ground(there) - place[1]) < EVEN:
                planned = (yield from self.planned(start, there, floor, airtime, around))[0]
                if planned is not None:
                    return there, planned
        found, deep = None, place[1] < floor and not len(around)  # who can't get as deep is told how deep he can get there
        for there in ([place * FLAT + [0.0, floor, 0.0]] if deep else []) + list(self.easy(start, floor)) + list(self.carried(start, floor)):
            if (yield from reached(there)):
                found = there
                break
        if found is None:
            return None, None
        begun, way = found.copy(), place - found
        length = max(float(np.linalg.norm(way)), 1e-9)
        low, high = 0, math.ceil(min(length, FARTHEST * max(1.0, 9.81 / -self.gravity[1])) / GRID)
        if within < length:
            low = min(int((length - within) / GRID), high)
            found = begun + low * GRID / length * way
            if not (yield from reached(found)):
                return None, None
        while high - low > 1:
            middle = (low + high) // 2
            there = begun + middle * GRID / length * way
            if (yield from reached(there)):
                low, found = middle, there
            else:
                high = middle
        for share in BACK:
            there = begun + share * (found - begun)
            there[1] = found[1] if not len(around) else ground(there)
            planned = (yield from self.planned(start, there, floor, airtime, around, TRIES))[0]
            if planned is not None:
                return there, planned
        return None, None

    def easy(self, start: Start, floor: float) -> np.ndarray:
        """The places (n, 3) to which it takes no effort to jump: where it stands, or where a run would carry the body."""
        if start.single is None:
            return self.middle(start, floor)[None]
        sent, off = self._sent(start, floor)
        return self.middle(start, floor) + off + self._carries(start.velocity + sent)

    def carried(self, start: Start, floor: float) -> np.ndarray:
        """The places (n, 3) to which a walk would carry the body, if no step off where it stands is easy: who pushes off both feet as he goes; none of others."""
        walks = start.single is None and math.hypot(start.velocity[0], start.velocity[2]) > WALKS
        return self.middle(start, floor) + self._carries(start.velocity) if walks else np.zeros((0, 3))

    def _carries(self, velocity: np.ndarray) -> np.ndarray:
        """By how much (n, 3) [m] the body would be carried by how fast (3,) [m/s] it goes."""
        return np.array(CARRIED) * velocity * FLAT * np.sqrt(9.81 * self.physique.size / -self.gravity[1])

    def _sent(self, start: Start, floor: float) -> tuple[np.ndarray, np.ndarray]:
        """By how much (3,) [m/s] the foot that pushes somebody off sends him aside of how he goes, and how far (3,) [m] aside of the middle of his feet he is himself."""
        way = start.velocity * FLAT
        left = np.array([way[2], 0.0, -way[0]]) / max(float(np.linalg.norm(way)), 1e-9)
        off, off_middle = (float((start.centre - place) @ left) * left for place in (start.feet[start.single, :3], self.middle(start, floor)))
        return SENDS * math.sqrt(-self.gravity[1] / (9.81 * self.physique.size)) * off, off_middle


def goes_on(start: Start) -> bool:
    """Whether somebody goes on as he leaps, so that the next moment is another."""
    return start.single is not None or math.hypot(start.velocity[0], start.velocity[2]) > WALKS


def _asked(start: Start, place: np.ndarray, floor: float, airtime: float | None, tries: int | None) -> tuple[Any, ...]:
    """A question, to be compared with others."""
    return (*(part if part is None or isinstance(part, float | int) else part.tobytes() for part in vars(start).values()), place.tobytes(), floor, airtime, tries)
