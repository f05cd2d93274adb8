"""How far places are from what stands about, and how high the ground lies there."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...compiled import kernel
from .solids import solids_of
from .things import is_box


def matters(things: Sequence[Any], here: ArrayLike, there: ArrayLike, way: float) -> bool:
    """Whether any of some things is so near that a way past it from one place (2,) x, z to another could be shorter than `way` [m]."""
    ends = np.array([[here[0], 0.0, here[1]], [there[0], 0.0, there[1]]], float)  # type: ignore[index]
    for thing in things:
        ends[:, 1] = thing.centre[1] if is_box(thing) else thing.foot[1] + 0.5 * thing.height
        if float(np.maximum(gap(ends, thing), 0.0).sum()) < way:
            return True
    return False


def gap(points: np.ndarray, thing: Any) -> np.ndarray:
    """How far points (N, 3) [m] are from a box or a pillar: 0 on its surface, negative inside; endless from what stops nobody."""
    return clearance(points, [thing])


def clearance(points: np.ndarray, around: Sequence[Any]) -> np.ndarray:
    """How far points (..., 3) [m] are from the nearest of all boxes and pillars: (...) 0 on its surface, negative inside; endless where there are none."""
    points = np.ascontiguousarray(points, float)
    out = np.empty(points.shape[:-1])
    solids = solids_of(around)
    clearance_kernel(points.reshape(-1, 3), solids.boxes, solids.pillars, out.reshape(-1))
    return out


@kernel
def clearance_kernel(points, boxes, pillars, out):
    """Write how far points (N, 3) are from the nearest of `solids_of`, see `clearance`."""
    for n in range(len(points)):
        out[n] = nearest_kernel(points[n, 0], points[n, 1], points[n, 2], boxes, pillars)


@kernel
def nearest_kernel(x, y, z, boxes, pillars):
    """How far a point is from the nearest of `solids_of` [m], see `clearance`."""
    nearest = np.inf
    for k in range(len(boxes)):
        c, s = boxes[k, 6], boxes[k, 7]
        dx, dy, dz = x - boxes[k, 0], y - boxes[k, 1], z - boxes[k, 2]
        across, along = c * dx - s * dz, s * dx + c * dz
        over = abs(dy - boxes[k, 8] * along) - 0.5 * boxes[k, 4]
        across, along = abs(across) - 0.5 * boxes[k, 3], abs(along) - 0.5 * boxes[k, 5]
        outside = math.sqrt(max(across, 0.0) ** 2 + max(over, 0.0) ** 2 + max(along, 0.0) ** 2)
        nearest = min(nearest, outside + min(max(across, over, along), 0.0))
    for k in range(len(pillars)):
        aside = math.hypot(x - pillars[k, 0], z - pillars[k, 2]) - pillars[k, 3]
        over = abs(y - pillars[k, 1] - 0.5 * pillars[k, 4]) - 0.5 * pillars[k, 4]
        nearest = min(nearest, math.hypot(max(aside, 0.0), max(over, 0.0)) + min(max(aside, over), 0.0))
    return nearest


def floor_at(x: float, z: float, around: Sequence[Any], below: float = np.inf) -> float:
    """The height [m] of the highest box or the floor at a place, no higher than `below`."""
    return ground_kernel(float(x), float(z), solids_of(around).boxes, float(below))[0]


def floors_at(places: np.ndarray, around: Sequence[Any], below: float = np.inf) -> np.ndarray:
    """The same at places (..., 2): (...) [m]."""
    places = np.ascontiguousarray(places, float)
    out = np.empty(places.shape[:-1])
    grounds_kernel(places.reshape(-1, 2), solids_of(around).boxes, float(below), out.reshape(-1))
    return out


def slope_at(x: float, z: float, around: Sequence[Any], below: float = np.inf) -> np.ndarray:
    """How (2,) the highest box or the floor at a place rises along x and z [m/m], if it is no higher there than `below` [m]."""
    boxes = solids_of(around).boxes
    which = ground_kernel(float(x), float(z), boxes, float(below))[1]
    return np.zeros(2) if which < 0 else boxes[which, 8] * boxes[which, [7, 6]]


@kernel
def ground_kernel(x, z, boxes, below):
    """The height [m] of the highest of boxes, as `solids_of` has them, or the floor at a place, no higher than `below`, and which box that is; -1 for the floor."""
    height, highest = 0.0, -1
    for k in range(len(boxes)):
        dx, dz = x - boxes[k, 0], z - boxes[k, 2]
        along = boxes[k, 7] * dx + boxes[k, 6] * dz
        top = boxes[k, 1] + 0.5 * boxes[k, 4] + boxes[k, 8] * along
        if height < top <= below and abs(boxes[k, 6] * dx - boxes[k, 7] * dz) <= 0.5 * boxes[k, 3] and abs(along) <= 0.5 * boxes[k, 5]:
            height, highest = top, k
    return height, highest


@kernel
def grounds_kernel(places, boxes, below, out):
    """Write how high the ground lies at places (N, 2), see `floors_at`."""
    for n in range(len(places)):
        out[n] = ground_kernel(places[n, 0], places[n, 1], boxes, below)[0]
