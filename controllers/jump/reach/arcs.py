"""The arcs to a place: the usual one, others where something is in the way, and why each can't be gone; nothing is planned."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ...contract import level
from ...navigation import clearance, floor_at, slope_at
from ..body import FLAT, LEVEL, Physique, Start, landing_feet, soles
from ..motion import Path, grounded, over_ledge, path
from ..prior import Prior
from .feasibility import HARD, PACE, RUNS_ON, begins, fault, hopeless, meant
from .seeking import PATH, Pieces, whole

HEIGHTS = 1.0, 1.12, 1.26, 1.42, 1.6
"""What the airtime is multiplied by until the arc clears what stands in its way."""
LOWER, FASTER = (0.9, 0.8, 0.7), 1.25
"""And of who leaps off one foot that can't push as usual, so that he leaps lower, as long as he need not leave so many times as fast as he runs."""
WAYS = (False, False), (False, True), (True, True)
"""With which arms, down or not, and legs, drawn up or not, a body tries to pass what is in its way."""
LITTLE, RISES = 0.06, 0.03
"""Who leaves in haste is elsewhere by so much at most [m]; and a body that flies higher by no more than the rise of its arc and the second [m]."""
WITHIN, BEFORE = 0.018, "too soon for this pace: the foot that pushes would have to press outside its sole"
"""Who leaps along his way presses no farther outside the sole than the first [m], at standard height: he can wait for a better moment."""
FLUSH = 0.03
"""A target lies on the floor if it is no farther from it than this [m]; only told where something stands about."""
STEEPEST = 0.4
"""Nobody leaps off ground that rises by more than this a metre, or onto it."""


class How(NamedTuple):
    """What tells an arc from others to the same place: its airtime [s] or None for the usual one, arms down or not, legs drawn up or not, and in which
    haste, see `Start`."""

    airtime: float | None
    low_arms: bool
    tucked: bool
    haste: int


class Arc(NamedTuple):
    """A path to a place, why it can't be gone, if so, and how it is found from elsewhere."""

    path: Path
    why: str
    how: How


Looks = Generator[Arc | int, float | None, None]


class Arcs:
    """The arcs of one body under one gravity.

    physique: whose body. gravity: (3,) [m/s²], straight down. prior: how people carry themselves.
    """

    def __init__(self, physique: Physique, gravity: np.ndarray, prior: Prior):
        self.physique, self.gravity, self.prior = physique, gravity, prior

    def onto(self, start: Start, place: np.ndarray, floor: float, around: Sequence[Any]) -> Start:
        """The same start of one who leaps off a floor [m] to a place (3,), as the ground rises there; of a walker, and over which edge."""
        slope = slope_at(place[0], place[2], around, place[1] + FLUSH) if len(around) else LEVEL
        if slope.any() or start.lands_on.any():
            return replace(start, lands_on=slope)
        return over_ledge(start, place, floor, around) if start.bound and not start.slope.any() else start

    def footing(self, start: Start, place: np.ndarray, floor: float, around: Sequence[Any]) -> str:
        """Why nobody can stand at a place (3,), if so."""
        for slope, way in ((start.slope, "off"), (start.lands_on, "onto")):
            if np.hypot(*slope) > STEEPEST:
                return f"too steep to leap {way}: {np.degrees(np.arctan(np.hypot(*slope))):.0f}°, where {np.degrees(np.arctan(STEEPEST)):.0f}° can be"
        around = [thing for thing in around if not hasattr(thing, "place")]
        if clearance(place + [0.0, 0.05, 0.0], around) < 0.0:
            return "that place is inside something solid"
        below = floor_at(place[0], place[2], around, place[1] + FLUSH)
        if around and below < place[1] - FLUSH:
            return f"there is nothing to land on at {place[1]:.2f} m; the floor there lies at {below:.2f} m"
        body = self.physique.tables
        corners = soles(landing_feet(place, start.lands, body, start.lands_on), body, start.lands_on)
        if around and min(floor_at(x, z, around, y + FLUSH) - y for x, y, z in corners) < -FLUSH:
            return "too near an edge: only part of its feet would find floor"
        return ""

    def arcs(self, start: Start, place: np.ndarray, floor: float, airtime: float | None = None,
             around: Sequence[Any] = (), heights: Sequence[float] = HEIGHTS) -> Looks:
        """The arcs to a place, the usual one first; where something stands about then with
        the legs drawn up and the arms down and, without an airtime, higher: by `heights` times the airtime, which begin with 1; of a runner whose foot can't push so,
        lower. None is gone in more haste than it takes. Who is told (by `send`) how deep [m] something lay
        in the plan along the last of them leaves out those along which it would as well. Before each path that is made, what that costs."""
        if start.along:  # in no haste: the next moment may do
            for low, tucked in WAYS if len(around) else WAYS[:1]:
                yield PATH
                arc = self.arc(start, place, floor, around, How(airtime, low, tucked, 0))
                course = arc.path.course
                yield arc._replace(why=arc.why or BEFORE) if course is not None and course.outside > WITHIN * self.physique.size else arc
            return
        usual = yield from self._arcs(start, place, floor, airtime, around, heights)
        if usual is None or airtime is not None:
            return
        faster = float(np.linalg.norm(usual.velocity * FLAT)) / max(float(np.linalg.norm(start.velocity * FLAT)), 1e-6)
        for share in LOWER:
            if faster > FASTER * share or (yield from self._arcs(start, place, floor, share * usual.airtime, around, heights[:1])) is None:
                return

    def _arcs(self, start: Start, place: np.ndarray, floor: float, airtime: float | None, around: Sequence[Any],
              heights: Sequence[float]) -> Generator[Arc | int, float | None, Path | None]:
        """The same of one usual airtime [s], None for that of least effort. What comes of it is the usual path of a runner whose foot can't push so, else None."""
        first, hits = None, dict[bool, tuple[float, float]]()
        for higher in heights:
            flight = airtime if first is None else first.airtime * higher
            for low, tucked in WAYS if len(around) else WAYS[:1]:
                if first is not None and higher > 1.0 and (not tucked or low in hits and self._still(*hits[low], first.airtime * higher)):
                    continue
                how = partial(How, flight, low, tucked)

                def arc(haste: int, how: Callable[[int], How] = how) -> Arc:
                    return self.arc(start, place, floor, around, how(haste))
                quick, deep, slower = None, None, (0, 1)
                if higher == 1.0:
                    yield PATH
                    tried, slower = arc(0), (1,)
                    deep = yield tried
                if not slower[0] or tried.why:  # who can't go it in all haste is not asked whether he can otherwise
                    if start.runs and flight is not None and higher == 1.0 and place[1] >= floor:  # a runner's haste tells how long he flies
                        quick = Arc(tried.path, tried.why, how(2))
                    else:
                        yield PATH
                        quick = arc(2)
                    for haste in slower if not quick.why else ():
                        yield PATH
                        tried = arc(haste)
                        if not tried.why:
                            deep = yield tried
                            break
                if deep is None or deep < LITTLE or start.runs and higher == 1.0:  # who runs flies lower then
                    if quick is None:
                        yield PATH
                    tried = quick or arc(2)
                    deep = yield tried
                first = first or tried.path
                if deep is not None:
                    hits[low] = tried.path.airtime, deep
                if start.runs and first is tried.path and tried.path.strong and tried.why.startswith((HARD, *PACE)) and deep is None:
                    return first
                if not tried.path.strong or tried.why.startswith(HARD):
                    return None
            if airtime is not None or not len(around):
                return None
        return None

    def _still(self, airtime: float, deep: float, longer: float) -> bool:
        """Whether something that lay so deep [m] in a plan would still lie in one that flies longer [s], and so much higher."""
        return deep > RISES - 0.125 * float(self.gravity[1]) * (longer**2 - airtime**2)

    def arc(self, start: Start, place: np.ndarray, floor: float, around: Sequence[Any], how: How) -> Arc:
        """One of them."""
        start = replace(start, haste=how.haste)
        way = self.path(start, place, floor, how.airtime, how.low_arms, how.tucked)
        if not hopeless(self.physique, way):
            way = grounded(self.physique, start, way, floor)
        return Arc(way, RUNS_ON if start.stays and start.cramped and way.lands is not None else fault(self.physique, way, around, floor), how)

    def survey(self, start: Start, place: np.ndarray, floor: float, airtime: float | None = None,
               around: Sequence[Any] = (), heights: Sequence[float] = HEIGHTS) -> tuple[Path, str]:
        """The path to a place (3,) off a floor [m], and why it can't be gone, if so: a look at the place, then `arcs`; nothing is planned. Refused for what is no
        place, ValueError for what is no floor or no start."""
        return whole(self.surveyed(begins(start), meant(place, airtime), float(level(floor)), airtime, around, heights))

    def surveyed(self, start: Start, place: np.ndarray, floor: float, airtime: float | None, around: Sequence[Any],
                  heights: Sequence[float]) -> Pieces[tuple[Path, str]]:
        """What `survey` gives, in pieces."""
        start = self.onto(start, place, floor, around)
        why = self.footing(start, place, floor, around)
        if why:
            return self.path(start, place, floor, airtime), why
        arcs, first = self.arcs(start, place, floor, airtime, around, heights), None
        while (arc := (yield from following(arcs))) is not None:
            first = first or arc
            if not arc.why:
                return arc.path, ""
        assert first is not None  # there is always one
        return first.path, first.why

    def middle(self, start: Start, floor: float) -> np.ndarray:
        """The middle (3,) of both soles as they come to stand on a floor [m]: where a jump straight up lands."""
        body = self.physique.tables
        middle = soles(start.planted(floor, body), body).mean(0)
        return middle * FLAT + [0.0, floor + start.rise(middle), 0.0]

    def path(self, start: Start, place: np.ndarray, floor: float, airtime: float | None = None, low_arms: bool = False,
             tucked: bool = False) -> Path:
        """The path estimate alone: the arc to draw while aiming."""
        body = self.physique.tables
        feet = start.planted(floor, body)
        pushing = feet if start.single is None else feet[start.single:start.single + 1]
        return path(self.physique, start, pushing, landing_feet(place, start.lands, body, start.lands_on), floor,
                    self.gravity, airtime, low_arms, self.prior, tucked)


def following(arcs: Looks, deep: float | None = None) -> Pieces[Arc | None]:
    """The next of some arcs, told how deep something lay in the last one's plan; None where there is none."""
    try:
        arc = arcs.send(deep)
        while isinstance(arc, int):
            yield arc
            arc = next(arcs)
    except StopIteration:
        return None
    return arc
