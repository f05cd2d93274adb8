"""A finished plan swept through what stands about: every bone as a capsule, from the wind-up until the body stands."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from ...body import Skeleton, centre_of_mass, end_positions, forward_kinematics, sole_corners
from ...navigation import gap
from ..body import Physique
from ..motion import Plan

RATE = 72.0
"""So many poses a second are looked at, and half-way between them."""
NEAR = 1.3
"""What is farther from the centre of mass [m], at standard height, is out of reach."""
SPACED = 0.07
"""From one place on a bone to the next [m], at standard height."""
GRAZE, SOLES = 0.015, 0.006
"""So much of its flesh, and of its soles, a body may graze things with [m]."""
CAPSULES = (("legs", "UpLeg", "Leg", 0.06), ("legs", "Leg", "Foot", 0.045), ("hands", "Arm", "ForeArm", 0.04), ("hands", "ForeArm", "Hand", 0.035),
            ("hands", "Hand", "", 0.03), ("trunk", "Hips", "Spine2", 0.11), ("trunk", "Spine2", "Neck", 0.09), ("head", "Head", "", 0.09))
"""What is told of them, from which joint to which or to its end, how thick [m] at standard height."""


@lru_cache(maxsize=8)
def _bones(skeleton: Skeleton) -> tuple[tuple[str, int, int, bool, float], ...]:
    """Part, first joint, last joint or end, whether it is an end, radius."""
    out = []
    for part, first, last, radius in CAPSULES:
        for side in ("",) if first in skeleton.names else ("Left", "Right"):
            at = skeleton.index(side + first)
            out.append((part, at, skeleton.index(side + last) if last else skeleton.end_index[side + first], not last, radius))
    return tuple(out)


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
    things = [thing for thing in around if not hasattr(thing, "place")]
    if not things:
        return None
    last = min(made.duration, made.through)
    chosen = np.unique(np.searchsorted(made.times, np.arange(0.0, last, 1.0 / RATE)))
    chosen = chosen[chosen < len(made.times)]
    skeleton, size = physique.skeleton, physique.size
    positions, turned = forward_kinematics(skeleton, made.roots[chosen], made.local[chosen])
    centre = centre_of_mass(physique.anatomy, positions, turned)
    things = [thing for thing in things if gap(centre, thing).min() < NEAR * size]
    if not things:
        return None
    ends = end_positions(skeleton, positions, turned)
    parts = [("feet", sole_corners(skeleton, positions, turned), 0.0)]
    for part, first, second, end, radius in _bones(skeleton):
        begin, stop = positions[:, first], ends[:, second] if end else positions[:, second]
        count = max(int(np.ceil(float(np.linalg.norm(stop[0] - begin[0])) / (SPACED * size))), 1) + 1
        parts.append((part, begin[:, None] + np.linspace(0.0, 1.0, count)[:, None] * (stop - begin)[:, None], radius * size))
    widths = [places.shape[1] for _, places, _ in parts]
    every = np.concatenate([places for _, places, _ in parts], 1)
    every = np.concatenate([every[:1], np.stack([0.5 * (every[:-1] + every[1:]), every[1:]], 1).reshape(-1, *every.shape[1:])])
    thick = np.repeat([radius - GRAZE for _, _, radius in parts], widths)
    thick[:widths[0]] = -SOLES * size
    for thing in things:
        deep = thick - gap(every.reshape(-1, 3), thing).reshape(len(every), -1)
        deep -= np.maximum(deep[0], 0.0)
        if deep.max() > 0.0:
            moment, place = np.unravel_index(int(deep.argmax()), deep.shape)
            part = parts[int(np.searchsorted(np.cumsum(widths), place, "right"))][0]
            ahead = float(np.linalg.norm((every[moment, place] - every[0, place])[[0, 2]]))
            pose = chosen[(moment + 1) // 2]
            return Touch(f"its {part} would hit something {ahead:.1f} m ahead", made.roots[pose], made.local[pose], every[moment, place], float(deep[moment, place]))
    return None
