"""How far rays are free: what is seen, and what comes between."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ...compiled import kernel
from .solids import solids_of

STRAIGHT = 1e-12
"""Parts of a ray's direction that are smaller lead nowhere."""
THIN = 1e-9
"""What a ray is in for no longer than this [m] it does not meet."""


def free_way(origin: np.ndarray, directions: np.ndarray, around: Sequence[Any], margin: float = 0.0) -> np.ndarray:
    """How far [m] from `origin`, (3,) or (W, 3), each ray (W, 3) of unit length is free of boxes and pillars that are swollen by a margin [m]: (W,), endless where it meets none.

    0 where the origin lies inside of one. Slab method (Kay and Kajiya 1986) in each box's own axes, and a quadratic for upright cylinders.
    """
    directions = np.ascontiguousarray(directions, float)
    out, (boxes, pillars) = np.empty(len(directions)), solids_of(around)
    rays_kernel(np.ascontiguousarray(np.broadcast_to(origin, directions.shape), float), directions, boxes, pillars, float(margin), out)
    return out


@kernel
def rays_kernel(origins, directions, boxes, pillars, margin, out):
    """Write how far rays (W, 3) from origins (W, 3) are free of `solids_of`, see `free_way`."""
    for n in range(len(directions)):
        out[n] = ray_kernel(origins[n], directions[n], boxes, pillars, margin)


@kernel
def ray_kernel(origin, way, boxes, pillars, margin):
    """How far a ray (3,) from an origin (3,) is free of `solids_of` [m], see `free_way`."""
    free = np.inf
    for k in range(len(boxes)):
        c, s, slope = boxes[k, 6], boxes[k, 7], boxes[k, 8]
        dx, dy, dz = origin[0] - boxes[k, 0], origin[1] - boxes[k, 1], origin[2] - boxes[k, 2]
        along, ahead = s * dx + c * dz, s * way[0] + c * way[2]
        enters, leaves = _between(c * dx - s * dz, c * way[0] - s * way[2], 0.5 * boxes[k, 3] + margin, 0.0, np.inf)
        enters, leaves = _between(dy - slope * along, way[1] - slope * ahead, 0.5 * boxes[k, 4] + margin, enters, leaves)
        enters, leaves = _between(along, ahead, 0.5 * boxes[k, 5] + margin, enters, leaves)
        if leaves > enters + THIN:
            free = min(free, enters)
    for k in range(len(pillars)):
        x, z, radius = origin[0] - pillars[k, 0], origin[2] - pillars[k, 2], pillars[k, 3] + margin
        a, b = max(way[0] ** 2 + way[2] ** 2, 1e-18), x * way[0] + z * way[2]
        meets = b * b - a * (x * x + z * z - radius * radius)
        if meets >= 0.0:
            root, half = math.sqrt(meets), 0.5 * pillars[k, 4]
            enters, leaves = _between(origin[1] - pillars[k, 1] - half, way[1], half + margin, max((-b - root) / a, 0.0), (-b + root) / a)
            if leaves > enters + THIN:
                free = min(free, enters)
    return free


@kernel
def _between(start, goes, half, enters, leaves):
    """When a ray is in a slab that reaches `half` [m] to either side, and was in all before from when it `enters` to when it `leaves`."""
    goes = goes if abs(goes) >= STRAIGHT else STRAIGHT
    first, second = (-half - start) / goes, (half - start) / goes
    return max(enters, min(first, second)), min(leaves, max(first, second))
