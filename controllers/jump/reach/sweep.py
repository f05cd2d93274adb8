"""A finished plan swept through what stands about: every bone as a capsule, from the wind-up until the body stands."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ...body import centre_of_mass, forward_kinematics
from ...navigation import gap
from ..body import Physique
from ..motion import Plan, capsule_places, near
from .feasibility import hits

RATE = 72.0
"""So many poses a second are looked at, and half-way between them."""


class Touch(NamedTuple):
    """What a body would hit in a plan, where it would lie deepest in it: in words, in which pose, root (3,) [m] and local rotations (J, 3, 3),
    where (3,) [m] and how deep [m]."""

    reason: str
    root: np.ndarray
    local: np.ndarray
    place: np.ndarray
    deep: float


def touch(physique: Physique, made: Plan, around: Sequence[Any]) -> Touch | None:
    """What a body would hit in a plan, where it would lie deepest in it; None if nothing. What it touches as it begins, it may touch
    as much all along."""
    if all(hasattr(thing, "place") for thing in around):
        return None
    last = min(made.duration, made.through)
    chosen = np.unique(np.searchsorted(made.times, np.arange(0.0, last, 1.0 / RATE)))
    chosen = chosen[chosen < len(made.times)]
    positions, turned = forward_kinematics(physique.skeleton, made.roots[chosen], made.local[chosen])
    centre = centre_of_mass(physique.anatomy, positions, turned)
    things = near(physique, centre, around)
    if not things:
        return None
    names, widths, every, thick = capsule_places(physique, positions, turned)
    every = np.concatenate([every[:1], np.stack([0.5 * (every[:-1] + every[1:]), every[1:]], 1).reshape(-1, *every.shape[1:])])
    for thing in things:
        deep = thick - gap(every.reshape(-1, 3), thing).reshape(len(every), -1)
        deep -= np.maximum(deep[0], 0.0)
        if deep.max() > 0.0:
            moment, place = np.unravel_index(int(deep.argmax()), deep.shape)
            part = names[int(np.searchsorted(np.cumsum(widths), place, "right"))]
            ahead = float(np.linalg.norm((every[moment, place] - centre[0])[[0, 2]]))  # of the body: a foot that swings comes from far behind
            pose = chosen[(moment + 1) // 2]
            return Touch(hits(part, ahead), made.roots[pose], made.local[pose], every[moment, place], float(deep[moment, place]))
    return None
