"""A finished plan swept through what stands about: every bone as a capsule, from the wind-up until the body stands."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ...body import centre_of_mass, forward_kinematics
from ...navigation import solids_of
from ..body import Physique, Start
from ..motion import Plan, capsule_places, deepest_kernel, near
from ..planner import Turning
from .feasibility import hits

RATE = 72.0
"""So many poses a second are looked at, and half-way between them."""
SURELY = 0.08
"""What lies so deep [m] in something, at standard height, in every third pose of a flight, would as the plan is finished."""

LANDING, HOWEVER = ("feet", "legs", "trunk"), 0.01
"""Legs and trunks that lie deeper than this [m], at standard height, in something as a body lands on both feet would whatever way it comes there: of a hundred searches that
went on after that none found another."""


class Touch(NamedTuple):
    """What a body would hit in a plan, where it would lie deepest in it: in words, in which pose, root (3,) [m] and local rotations (J, 3, 3),
    where (3,) [m] and how deep [m]; and whether it does as it lands, whatever way it comes."""

    reason: str
    root: np.ndarray
    local: np.ndarray
    place: np.ndarray
    deep: float
    however: bool = False


def touch(physique: Physique, made: Plan, around: Sequence[Any]) -> Touch | None:
    """What a body would hit in a plan, where it would lie deepest in it; None if nothing. What it touches as it begins, it may touch
    as much all along."""
    last = min(made.duration, made.through)
    chosen = np.unique(np.searchsorted(made.times, np.arange(0.0, last, 1.0 / RATE)))
    chosen = chosen[chosen < len(made.times)]
    landing = int(np.searchsorted(made.times[chosen], made.touch_down)) if made.path.lands is None else len(chosen)
    return _touch(physique, made.roots[chosen], made.local[chosen], around, landing)


def surely(physique: Physique, start: Start, flight: Turning, around: Sequence[Any]) -> Touch | None:
    """The same of a flight alone, of a plan that is not finished, where that touches something deeply."""
    found = _touch(physique, np.concatenate([start.root[None], flight.roots]), np.concatenate([start.rotations[None], flight.local]), around)
    return None if found is None or found.deep < SURELY * physique.size else found


def _touch(physique: Physique, roots: np.ndarray, local: np.ndarray, around: Sequence[Any], landing: int | None = None) -> Touch | None:
    """The same of poses (N, 3), (N, J, 3, 3), from `landing` on on both feet."""
    if all(hasattr(thing, "place") for thing in around):
        return None
    positions, turned = forward_kinematics(physique.skeleton, roots, local)
    centre = centre_of_mass(physique.anatomy, positions, turned)
    things = near(physique, centre, around)
    if not things:
        return None
    names, widths, every, thick = capsule_places(physique, positions, turned)
    where, place = np.empty(2, int), np.empty(3)
    for thing in things:
        solids = solids_of([thing])
        deep = deepest_kernel(every, thick, solids.boxes, solids.pillars, where, place)
        if deep > 0.0:
            part = names[int(np.searchsorted(np.cumsum(widths), where[1], "right"))]
            ahead = float(np.linalg.norm((place - centre[0])[[0, 2]]))  # of the body: a foot that swings comes from far behind
            however = landing is not None and where[0] > landing and part in LANDING and deep > HOWEVER * physique.size
            return Touch(hits(part, ahead), roots[where[0]], local[where[0]], place, deep, however)
    return None
