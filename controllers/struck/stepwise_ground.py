"""The ground about somebody who falls: what he comes to step by step, treads and ramps and low boxes; what is higher is a wall, what is lower an abyss."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..compiled import kernel
from .surroundings import STEP, aside_kernel, tread_kernel

CELL, HALF = 0.05, 64
"""The ground is looked at in cells of this size [m], so many to either side."""
OVER = 4
"""What a body touches lies no more cells aside."""
ROUNDED = 0.02
"""The ground is told of to this [m]."""


class Ground(NamedTuple):
    """The ground about a place. things: (K, 9) what stands about, as of `about`. corner: (2,) x, z [m] of the first cell's middle. levels: (C, C) how high the ground lies there [m],
    NaN where nobody comes step by step. caps: (C, C) what is higher [m] near there is a wall."""

    things: np.ndarray
    corner: np.ndarray
    levels: np.ndarray
    caps: np.ndarray

    @property
    def flat(self) -> bool:
        """Whether it lies on one level wherever one comes."""
        return bool(np.nanmax(self.levels) - np.nanmin(self.levels) < 1e-6)


def ground_about(things: np.ndarray, place: np.ndarray, floor: float) -> Ground:
    """The ground about a place (2,) x, z [m], that lies `floor` high [m] there."""
    from scipy.ndimage import maximum_filter  # no game waits for it at its start

    corner = np.asarray(place, float) - CELL * HALF
    levels = np.full((2 * HALF + 1, 2 * HALF + 1), np.nan)
    reach_kernel(things, corner, float(floor), levels)
    caps = maximum_filter(np.where(np.isnan(levels), -np.inf, levels), 2 * OVER + 1, mode="nearest") + ROUNDED
    return Ground(things, corner, levels, caps)


@kernel
def reach_kernel(things, corner, floor, levels):
    """Write how high the ground lies (C, C) where one comes from its middle in steps."""
    count, out = len(levels), np.empty(2)
    queue, first, last = np.empty((count * count, 2), np.int64), 0, 1
    queue[0] = count // 2
    levels[count // 2, count // 2] = tread_kernel(things, corner[0] + CELL * (count // 2), corner[1] + CELL * (count // 2), floor + STEP, floor)
    while first < last:
        i, k = queue[first]
        first += 1
        for way in range(4):
            a, b = i + (way == 0) - (way == 1), k + (way == 2) - (way == 3)
            if a < 0 or b < 0 or a >= count or b >= count or not math.isnan(levels[a, b]):
                continue
            x, z = corner[0] + CELL * a, corner[1] + CELL * b
            height = tread_kernel(things, x, z, levels[i, k] + STEP, levels[i, k])
            if height < levels[i, k] - STEP or aside_kernel(things, x, z, height + ROUNDED, height + 2.0 * STEP, out) < 0.0:
                continue
            levels[a, b] = height
            queue[last, 0], queue[last, 1] = a, b
            last += 1


@kernel
def cell_kernel(corner, cells, x, z, beyond):
    """What is told of the cell that a place is in; `beyond` outside."""
    i, k = int(round((x - corner[0]) / CELL)), int(round((z - corner[1]) / CELL))
    if i < 0 or k < 0 or i >= len(cells) or k >= len(cells):
        return beyond
    return cells[i, k]


@kernel
def rests_kernel(things, corner, caps, place, thick, aside, out):
    """How high [m] the middle of a ball of a radius `thick` [m] is that lies on the ground at a place (3,), on treads' edges, too. Where it is nearer to what is beside a tread than to its top, and
    may go `aside`, the way (2,) there is written instead [m]."""
    cap = cell_kernel(corner, caps, place[0], place[2], -math.inf)
    height, most = thick, 0.0
    out[:] = 0.0
    for k in range(len(things)):
        if things[k, 3] < 0.0:
            continue
        c, s = things[k, 4], things[k, 5]
        dx, dz = place[0] - things[k, 0], place[2] - things[k, 1]
        left, ahead = c * dx - s * dz, s * dx + c * dz
        a, b = abs(left) - things[k, 2], abs(ahead) - things[k, 3]
        far = math.hypot(max(a, 0.0), max(b, 0.0))
        top = things[k, 7] + things[k, 8] * min(max(ahead, -things[k, 3]), things[k, 3])
        if far >= thick or top > cap:
            continue
        lies = top + math.sqrt(thick * thick - far * far) * math.sqrt(1.0 + things[k, 8] ** 2)
        beside = thick - (far if far > 0.0 else max(a, b))
        across, along = (math.copysign(beside, left), 0.0) if a > b else (0.0, math.copysign(beside, ahead))
        x, z = c * across + s * along, c * along - s * across
        if aside and beside < lies - place[1] and not (  # hills are made of many ramps: there the ground goes on
                things[k, 8] != 0.0 and tread_kernel(things, place[0] + x, place[2] + z, top + STEP, 0.0) > top - STEP):
            if beside > most:
                most = beside
                out[0], out[1] = x, z
        else:
            height = max(height, lies)
    return height


@kernel
def rest_kernel(things, corner, caps, points, thick, aside, out, ways):
    """Write how high (N, P) [m] balls would lie at the places (N, P, 3) of their middles, and what leads them aside (N, P, 2) [m], see `rests_kernel`."""
    for n in range(len(points)):
        for p in range(len(thick)):
            out[n, p] = rests_kernel(things, corner, caps, points[n, p], thick[p], aside, ways[n, p])


@kernel
def level_kernel(corner, levels, centres, out):
    """Write how high (N,) the ground lies under places (N, 3); NaN where nobody comes."""
    for n in range(len(centres)):
        out[n] = cell_kernel(corner, levels, centres[n, 0], centres[n, 2], math.nan)
