"""The tops of boxes and ramps that feet can step on, or must keep clear of, and how high the ground lies somewhere."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..compiled import kernel
from ..navigation import checked, is_box, is_pillar, of_the_same, slope
from ..navigation.passing import STEP

SEEN = 0.8
"""A foot comes down no more than a `STEP` higher or deeper than the other stands, and what is higher than this over the body's level is no ground [m]: feet go up two of the highest steps from one that stands."""
SAME = 0.02
"""Grounds nearer to each other than this are the same one [m]."""
SQUARE, ENDLESS = 0.5 * math.sqrt(math.pi), 1e3
"""Half as wide as a circle of radius 1 a square is that is as large; nobody stands on what is so high [m]."""
FLAT = np.zeros((0, 9))
"""No tops: the ground is the character's own floor."""


@of_the_same
def tops(around: Sequence[Any]) -> np.ndarray:
    """The tops (M, 9) of all boxes that stand around: middle x, z, cosine and sine of the heading, half sizes across and
    along [m], height [m], slope along, and how high they begin [m]; and pillars, as squares as large that nobody stands on.
    ValueError for what has no place or size, by its name."""
    rows = [(b.centre[0], b.centre[2], math.cos(b.heading), math.sin(b.heading), 0.5 * b.size[0], 0.5 * b.size[2],
             b.centre[1] + 0.5 * b.size[1], slope(b), b.centre[1] - 0.5 * b.size[1]) for b in around if is_box(b)]
    rows += [(p.foot[0], p.foot[2], 1.0, 0.0, SQUARE * p.radius, SQUARE * p.radius, ENDLESS, 0.0, p.foot[1]) for p in around if is_pillar(p) and p.height > STEP]
    found = np.array(rows, float) if rows else FLAT
    if not (math.isfinite(found.sum()) and (found[:, 4:6] >= 0.0).all() and (found[:, 6] >= found[:, 8]).all()):
        checked(around)
    return found


@kernel
def ground_kernel(tops, x, z, floor, level, out):
    """Write into `out` (3,) how high the ground lies at x, z over `floor` [m], and how it rises along x and z.

    floor: absolute. level: of the body, over the floor. Whether there is ground near it; what is not counts as level.
    """
    found = False
    out[0], out[1], out[2] = level, 0.0, 0.0
    if -floor - level <= SEEN:  # the world's own floor
        found, out[0] = True, -floor
    for k in range(tops.shape[0]):
        dx, dz = x - tops[k, 0], z - tops[k, 1]
        c, s = tops[k, 2], tops[k, 3]
        across, along = c * dx - s * dz, s * dx + c * dz
        if abs(across) > tops[k, 4] or abs(along) > tops[k, 5]:
            continue
        high = tops[k, 6] + tops[k, 7] * along - floor
        if high - level <= SEEN and (not found or high > out[0]):
            found = True
            out[0], out[1], out[2] = high, tops[k, 7] * s, tops[k, 7] * c
    return found
