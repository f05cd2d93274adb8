"""Room to walk in: how near a walker may come to what stands about, by how he is turned, and the ways that this leaves him."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy.interpolate import BSpline

from ...compiled import kernel
from ..routes import distance, grid_way, separation, ways
from .limits import reach, too_near
from .splines import knots_of

DETOUR = 1.15
"""Narrow ways are looked for where the others are so much longer than a straight line, or lead nowhere ..."""
SHORTER = 0.9
"""... and taken into account where they are this much shorter."""


class Ways(NamedTuple):
    """Ways (n, 2) [m] each, round shapes (K, 6) as they count for one walk, for a girth (3,) [m], see `reach`."""

    routes: list[np.ndarray]
    shapes: np.ndarray
    girth: np.ndarray


def ways_of(start: np.ndarray, goal: np.ndarray, shapes: np.ndarray, girth: np.ndarray, margin: float) -> list[Ways]:
    """Ways from start to goal (3,), a margin [m] wider than need be: those of somebody as wide as he is, and those that he has to turn aside for where these
    are long or none. Who stands where there is only room aside begins so."""
    wide, full = np.full(3, girth[0]), girth + margin
    near = round_ends(start, goal, shapes, wide + margin)
    found = Ways(_routes(start, goal, near, full[0]), near, wide)
    if girth[1] >= girth[0] or not len(shapes):
        return [found]
    squeezed = _missing(start, shapes, wide) > 0.0 >= _missing(start, shapes, girth)
    shortest = far(found.routes[0]) if found.routes else np.inf
    if not squeezed and shortest <= DETOUR * float(np.hypot(*(goal - start)[:2])):
        return [found]
    near = round_ends(start, goal, shapes, full)
    slim = Ways([way for way in _routes(start, goal, near, float(full[1:].mean())) if squeezed or far(way) < SHORTER * shortest], near, girth)
    return [Ways(found.routes + slim.routes, near, girth)] if squeezed else [found, slim]


def _routes(start, goal, shapes: np.ndarray, clearance: float) -> list[np.ndarray]:
    found = ways(start[:2], goal[:2], shapes, clearance)
    return found or [way for way in [grid_way(start[:2], goal[:2], shapes, clearance)] if len(way)]


def far(way: np.ndarray) -> float:
    """How long a way (n, 2) is [m]."""
    return float(np.linalg.norm(np.diff(way, axis=0), axis=1).sum())


def _missing(pose: np.ndarray, shapes: np.ndarray, girth: np.ndarray) -> float:
    return max((too_near(pose[0], pose[1], pose[2], shape, girth) for shape in shapes), default=-np.inf)


def round_ends(start: np.ndarray, goal: np.ndarray, shapes: np.ndarray, girth: np.ndarray, slack: float = 0.0) -> np.ndarray:
    """The shapes, those smaller that the walker starts, or ends, nearer to than his girth; and these by a slack [m] more."""
    near = shapes.copy()
    for shape in near:
        missing = max(too_near(pose[0], pose[1], pose[2], shape, girth) for pose in (start, goal))
        shape[5] -= (missing + slack if missing > 0.0 else 0.0) + 1e-6
    return near


@kernel
def narrow(places, shapes, width):
    """Whether there is no room of half a width [m] at places (P, 2), nor beside them: what stands on one side only can be stepped away from."""
    found, slope = np.zeros(len(places), np.bool_), np.empty(3)
    for n in range(len(places)):
        x, z = places[n, 0], places[n, 1]
        least, nx, nz = width, 0.0, 0.0
        for k in range(shapes.shape[0]):
            there = distance(x, z, shapes[k], slope)
            if there < least:
                least, nx, nz = there, slope[0], slope[1]
        if least < width:
            x, z = x + (width - least) * nx, z + (width - least) * nz
            for k in range(shapes.shape[0]):
                found[n] |= distance(x, z, shapes[k], slope) < width - 1e-6
    return found


def room_on(spline: np.ndarray, shapes: np.ndarray, girth: np.ndarray, parts: int = 8) -> float:
    """How much room [m] is left beside a walker of a girth (3,) on the way of a spline (M + 3, 3) past shapes (K, 6), by straight stretches between `parts`
    places in each interval; inf where there are none."""
    return _least(np.ascontiguousarray(spline), _fine(len(spline) - 3, parts), shapes, girth)


@lru_cache(maxsize=64)
def _fine(intervals: int, parts: int) -> np.ndarray:
    """The basis (8M + 1, M + 3) at even shares."""
    return BSpline.design_matrix(np.linspace(0.0, 1.0, parts * intervals + 1), knots_of(intervals), 3).toarray()


@kernel
def _least(spline, table, shapes, girth):
    least, places = np.inf, table @ spline
    slope, by = np.empty(3), np.empty(2)
    for k in range(shapes.shape[0]):
        before = 0.0
        for n in range(len(places)):
            distance(places[n, 0], places[n, 1], shapes[k], slope)
            needs = reach(slope[0], slope[1], places[n, 2], girth, by)
            if n:
                there = separation(places[n - 1, 0], places[n - 1, 1], places[n, 0], places[n, 1], shapes[k])
                least = min(least, there - max(before, needs))
            before = needs
    return least
