"""Ways over several levels: walks, and leaps where no walk leads on; the quickest by Dijkstra's search.

Leaps go off near where one surface ends and come down near where another begins. There are many such pairs of places; whether a body can
leap there is asked only of those that the quickest way so far has.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import NamedTuple

import numpy as np

from ..obstacles import SHOULDER
from .surfaces import Levels

INSET = SHOULDER + 0.06
"""Leaps begin so far from where a surface ends [m]: where walks lead to; ..."""
LANDING = 0.22
"""... and end so far from it: from there one walks on."""
CLEAR = SHOULDER + 0.02
"""Nothing that lets nobody stand there is nearer to where they begin and end than this [m]."""
ROOM = 0.5
"""Nobody leaps onto, or off, what is narrower than this [m]."""
APART = 0.5
"""From one place at a side to the next [m]."""
BESIDE = 0.48
"""Who leaps up onto a box, or down from it, stands, or lands, so far from it [m]."""
FARTHEST, HIGHEST = 2.6, 1.2
"""No leap is thought of that goes farther than this [m], or up higher."""
NEAREST = 6
"""Of the leaps from one box to another so many are thought of, the shortest."""
SPEED = 1.2
"""How fast one walks between them [m/s]."""
LEAP = 1.8, 1.5
"""What a leap counts for [s]: turning, crouching and getting up; and for each metre, up and down, too, more than to walk it, so that the shortest is
leapt and nobody goes down into a gap that he can leap over."""
ASKED = 60
"""About no more leaps is asked."""
ALIKE, BY, ALL = 2, 1.0, 6
"""Of leaps side by side, no farther from each other than this [m], as far and as high, so many are asked about that can't be made for the same reason,
and so many wherever they are."""
WALKED = 200
"""So many walks between leaps are looked at: the others count as straight ones."""
WEAK = "too "
"""How reasons begin by which nobody leaps farther or higher, either."""


class Crossing(NamedTuple):
    """A leap. ground: (3,) x, z [m], heading [rad] to leap from. place: (3,) [m] to land at. height: of the floor that it leaves [m]."""

    ground: np.ndarray
    place: np.ndarray
    height: float

    @property
    def asks(self) -> tuple[float, float]:
        """How far it goes, and how high up [m]."""
        return math.dist(self.ground[:2], self.place[[0, 2]]), max(float(self.place[1]) - self.height, 0.0)


class Journey(NamedTuple):
    """The leaps of the way, in order, between which one walks; none where a walk leads there, or nothing could be leapt. reason: why no leaps lead
    there, or ""."""

    crossings: tuple[Crossing, ...]
    reason: str = ""


def journey(levels: Levels, here: np.ndarray, start: int, goal: np.ndarray, end: int, able: Callable[[Crossing], str | None],
            barred: Iterable[tuple[float, ...]] = (), walk: Callable[[int, np.ndarray, np.ndarray], float] | None = None) -> Journey:
    """The quickest way from a place (2,) on one surface to a goal (2,) on another.

    able: says why nobody can leap so, "" where one can, None where nobody leaps at all. barred: leaps, as `named`, that are not to be tried again.
    walk: says how long [m] a walk is in a region from one place (2,) to another; straight, where nothing says it.
    """
    if levels.regions[start] == levels.regions[end]:
        return Journey(())
    from scipy.sparse.csgraph import dijkstra  # slow to load, and most ways lead over one floor

    barred = set(barred)
    leaps = [leap for leap in crossings(levels, np.array([here, goal])) if named(leap[0]) not in barred]
    times, from_, to, regions = _times(leaps, here, levels.regions[start], goal, levels.regions[end])
    good, faults, walked = set(), list[tuple[str, Crossing]](), set[tuple[int, int]]()
    while len(good) + len(faults) < ASKED:
        _, before = dijkstra(times, indices=0, return_predecessors=True)
        way, at = [], int(before[-1])
        while at > 0:
            way.insert(0, at - 1)
            at = int(before[at])
        if not way:
            break
        legs = [leg for leg in zip([0, *(k + 1 for k in way)], [*(k + 1 for k in way), -1]) if leg not in walked]
        if walk is not None and legs and len(walked) < WALKED:
            walked.update(legs)
            for i, j in legs:  # they were thought to be straight
                times[i, j] += max(walk(int(regions[i]), from_[i], to[j]) - math.dist(from_[i], to[j]), 0.0) / SPEED
            continue
        bad = next((k for k in way if k not in good and (why := able(leaps[k][0])) != ""), None)
        good.update(way if bad is None else way[:way.index(bad)])
        if bad is None:
            return Journey(tuple(leaps[k][0] for k in way))
        if why is None:
            return Journey(())  # nobody here leaps: whoever plans the walk says what is in its way
        faulty = leaps[bad][0]
        faults.append((why, faulty))
        apart = [_apart(leap, faulty) for other, leap in faults if other == why]
        near = np.inf if sum(far < np.inf for far in apart) >= ALL else BY if sum(far < BY for far in apart) >= ALIKE else 0.0
        for k, (leap, *_) in enumerate(leaps):
            worse = why.startswith(WEAK) and all(np.array(leap.asks) >= np.array(faulty.asks) - 1e-6)
            if k == bad or (worse or _apart(leap, faulty) < near) and k not in good:
                times[:, k + 1] = np.inf
    whys = [why for why, _ in faults]
    return Journey((), "no walk leads there, and no leap: " + max(sorted(set(whys)), key=whys.count) if whys else "")


def _apart(one: Crossing, other: Crossing) -> float:
    """How far from each other [m] leaps go off that go as far and as high, inf for others."""
    return math.dist(one.ground[:2], other.ground[:2]) if np.allclose(one.asks, other.asks, atol=0.01) else np.inf


def _times(leaps: list[tuple[Crossing, int, int]], here: np.ndarray, start: int, goal: np.ndarray,
           end: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """How long it takes (L + 2, L + 2) [s] from the start (0), or where each leap ends, over each next leap, or to the goal (the last), by straight walks;
    the places (L + 2, 2) that these begin at, and lead to, and the regions that they are in."""
    off, onto = (np.array([start, *(leap[k] for leap in leaps), end]) for k in (1, 2))
    from_, to = (np.array([end_, *(getattr(leap[0], name)[axes] for leap in leaps), goal])
                 for end_, name, axes in ((here, "place", [0, 2]), (goal, "ground", [0, 1])))
    spent = np.array([0.0, *(LEAP[0] + LEAP[1] * (leap[0].asks[0] + abs(leap[0].place[1] - leap[0].height)) for leap in leaps), 0.0])
    times = np.linalg.norm(from_[:, None] - to[None], axis=-1) / SPEED + spent + 1e-9
    times[onto[:, None] != off[None]] = np.inf
    times[-1], times[:, 0] = np.inf, np.inf
    np.fill_diagonal(times, np.inf)
    return times, from_, to, onto


def named(leap: Crossing) -> tuple[float, ...]:
    """A leap by its places, to a centimetre."""
    return tuple(round(float(value), 2) for value in (*leap.ground[:2], *leap.place))


def crossings(levels: Levels, ends: np.ndarray) -> list[tuple[Crossing, int, int]]:
    """All leaps that are worth asking about, with the regions that they leave and lead to. ends: (E, 2) places that straight ways lead from and to."""
    found: list[tuple[Crossing, int, int]] = []
    broad = [box for box in range(levels.floor) if 2.0 * levels.halves[box, [0, 2]].min() >= ROOM and not levels.slopes[box]]
    edges = {box: _edge(levels, box, ends) for box in broad}
    for box, (places, normals, height) in edges.items():
        if not len(places):
            continue
        without = places + (INSET + BESIDE) * normals
        which, ground = levels.ground(without, height)  # what is higher is another box's matter
        own, theirs = int(levels.regions[box]), levels.regions[which]
        free = ~levels.shut(without, ground, CLEAR) & (theirs != own) & _within(levels, which, without)
        for k in np.flatnonzero(free):
            here, there = (places[k], height), (without[k], float(ground[k]))
            _add(found, here, there, own, int(theirs[k]))
            _add(found, there, here, int(theirs[k]), own)
        for other in broad:
            if levels.regions[other] != own and len(edges[other][0]):
                onto = _nearest_on(levels, other, places, LANDING)
                shut = levels.shut(onto, np.full(len(onto), edges[other][2]), CLEAR)
                far = np.where(shut, np.inf, np.linalg.norm(onto - places, axis=1))
                detour = np.linalg.norm(places - ends[0], axis=1) + np.linalg.norm(onto - ends[1], axis=1)
                for k in np.argsort(far.round(2) + 1e-3 * detour, kind="stable")[:NEAREST]:  # of those as short the ones on the way
                    if far[k] > 0.1:
                        _add(found, (places[k], height), (onto[k], edges[other][2]), own, int(levels.regions[other]))
    return found


def _edge(levels: Levels, box: int, ends: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """Places (S, 2) near a box's sides that can be stood on, those among them that are nearest to the ends; outward normals (S, 2); its height [m]."""
    out = levels.outline(box, INSET, APART)
    nearest = _nearest_on(levels, box, ends)
    side = [int(np.linalg.norm(out.places - place, axis=1).argmin()) for place in nearest]
    normals = out.normals[side]
    nearest = nearest + np.sum((out.places[side] - nearest) * normals, axis=-1, keepdims=True) * normals  # who stands on it leaps from its side
    places, normals = np.concatenate([out.places, nearest]), np.concatenate([out.normals, normals])
    height = float(levels.centres[box, 1] + levels.halves[box, 1])
    free = (levels.ground(places)[0] == box) & ~levels.shut(places, np.full(len(places), height), CLEAR)
    return places[free], normals[free], height


def _nearest_on(levels: Levels, box: int, places: np.ndarray, inset: float = INSET) -> np.ndarray:
    """The places (P, 2) on a box, an inset [m] from its sides, that are nearest to others (P, 2)."""
    half = np.maximum(levels.halves[box, [0, 2]] - inset, 0.0)
    c, s = np.cos(levels.headings[box]), np.sin(levels.headings[box])
    return np.clip(levels.local(places)[:, box], -half, half) @ np.array([[c, -s], [s, c]]) + levels.centres[box, [0, 2]]


def _within(levels: Levels, which: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Whether places (P, 2) on surfaces (P,) are an inset from where these end: there walks lead to. The floor ends nowhere."""
    return np.array([box == levels.floor or np.allclose(_nearest_on(levels, box, place[None])[0], place) for box, place in zip(which, places)], bool)


def _add(found: list, here: tuple[np.ndarray, float], there: tuple[np.ndarray, float], off: int, onto: int) -> None:
    way, up = there[0] - here[0], there[1] - here[1]
    if np.hypot(*way) <= FARTHEST and up <= HIGHEST:
        heading = math.atan2(way[0], way[1])
        found.append((Crossing(np.array([*here[0], heading]), np.array([there[0][0], there[1], there[0][1]]), here[1]), off, onto))
