"""The body's flesh as capsules about its bones, and how deep it lies in what stands about."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from ...body import Skeleton, end_positions, forward_kinematics, sole_corners
from ...compiled import kernel
from ...navigation import clearance, gap, nearest_kernel
from ..body import Physique

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


def deepest(physique: Physique, roots: np.ndarray, local: np.ndarray, around: Sequence[Any]) -> np.ndarray:
    """How deep (N,) [m] bodies in poses (N, 3), (N, J, 3, 3) lie in what stands about, beyond what they may graze; 0 where nowhere."""
    positions, turned = forward_kinematics(physique.skeleton, roots, local)
    _, _, every, thick = capsule_places(physique, positions, turned)
    return np.maximum((thick - clearance(every, around)).max(-1), 0.0)


def near(physique: Physique, centres: np.ndarray, around: Sequence[Any]) -> list[Any]:
    """What of the things around a body can touch whose mass centre comes by places (N, 3) [m]."""
    far = NEAR * physique.size
    return [thing for thing in around if gap(centres, thing).min() < far] if clearance(centres, around).min() < far else []


def capsule_places(physique: Physique, positions: np.ndarray, turned: np.ndarray) -> tuple[list[str], list[int], np.ndarray, np.ndarray]:
    """Of placed bodies (N, J, 3), (N, J, 3, 3): names of parts, how many places each has, all places (N, P, 3), and how thick (P,) [m] the body is there."""
    skeleton, size = physique.skeleton, physique.size
    ends = end_positions(skeleton, positions, turned)
    parts = [("feet", sole_corners(skeleton, positions, turned), -SOLES * size)]
    for part, first, second, end, radius in _bones(skeleton):
        begin, stop = positions[:, first], ends[:, second] if end else positions[:, second]
        count = max(int(np.ceil(float(np.linalg.norm(stop[0] - begin[0])) / (SPACED * size))), 1) + 1
        parts.append((part, begin[:, None] + np.linspace(0.0, 1.0, count)[:, None] * (stop - begin)[:, None], radius * size - GRAZE))
    widths = [places.shape[1] for _, places, _ in parts]
    return [part for part, _, _ in parts], widths, np.concatenate([places for _, places, _ in parts], 1), np.repeat([thick for _, _, thick in parts], widths)


@kernel
def deepest_kernel(every, thick, boxes, pillars, where, place):
    """How deep [m] a body lies in a thing where it lies deepest in it, beyond how deep each of its places does at first; 0 where nowhere.

    every: (N, P, 3) [m] its places, pose after pose, between which it is looked at half-way, too. thick: (P,) [m] it is there. boxes, pillars: of `solids_of`.
    where: (2,) in which pose, and which of its places; place: (3,) [m], both are written.
    """
    deepest, allowed = 0.0, np.empty(every.shape[1])
    for p in range(len(allowed)):
        allowed[p] = max(thick[p] - nearest_kernel(every[0, p, 0], every[0, p, 1], every[0, p, 2], boxes, pillars), 0.0)
    for n in range(1, len(every)):
        for share in (0.5, 1.0):
            for p in range(len(allowed)):
                before, here = every[n - 1, p], every[n, p]
                x, y, z = before[0] + share * (here[0] - before[0]), before[1] + share * (here[1] - before[1]), before[2] + share * (here[2] - before[2])
                deep = thick[p] - nearest_kernel(x, y, z, boxes, pillars) - allowed[p]
                if deep > deepest:
                    deepest = deep
                    where[0], where[1] = n, p
                    place[0], place[1], place[2] = x, y, z
    return deepest
