"""How much room a walker has, and how he slides along what stands about."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...compiled import kernel
from .measured import ground_kernel, nearest_kernel
from .solids import solids_of
from .things import STEP

HEAD = 1.9
"""What hangs higher than this over the floor is walked under [m]."""
KNEE = 0.05
"""What stands lower than a step and this beside a walker is in nobody's way [m]."""
SHOULDER = 0.30
"""A walker keeps so far from walls [m] ..."""
DEPTH = 0.25, 0.20
"""... where he faces them, and where they are behind him, so far: what a body takes that side-steps [m] ..."""
BODY = STEP + SHOULDER + KNEE, 1.0, HEAD - SHOULDER
"""... at these heights over the floor [m]."""
CREVICE = 0.25
"""One steps over what is no wider than this [m] ..."""
ASKEW = 0.4
"""... along his way, who comes to it askew."""
EDGES = np.arange(0.01, ASKEW, 0.03)
"""Where its edges are looked for [m]."""
LOOK, LEAST = 0.75, 0.25
"""... and looks so far ahead [s], and no less than so far [m]: about what stopping from a run takes."""
PACE = 0.15
"""How far apart the places are that are looked at [m]."""
DEVIATIONS = np.radians([0.0, 25.0, -25.0, 50.0, -50.0, 75.0, -75.0, 88.0, -88.0])
"""The directions that are tried beside the wished one, the nearest first [rad]."""


def slide(place: ArrayLike, velocity: ArrayLike, floor: float, around: Sequence[Any], agile: float = 1.0) -> np.ndarray:
    """The velocity (2,) along x and z [m/s] nearest to the wished one that runs into nothing and over no edge.

    place: (2,) x, z [m]. velocity: (2,) wished. floor: how high the walker stands [m]. A walker that
    finds no way stops, who is `agile` times as agile as people so much sooner; one that came too near to something, as its own speed carried it, may only leave.
    """
    (x, z), velocity = np.asarray(place, float), np.array(velocity, float)
    if len(around):
        boxes, pillars = solids_of(around)
        slide_kernel(x, z, velocity, float(floor), boxes, pillars, float(agile))
    return velocity


def room(place: ArrayLike, floor: float, around: Sequence[Any], way: ArrayLike | None = None) -> float:
    """How much room a walker has left at a place (2,) x, z [m] on a floor so high [m]: [m], negative where a wall is too near, or the floor does not go on.

    way: (2,) where he goes, who steps over crevices.
    """
    return float(rooms(np.asarray(place, float), floor, around, way))


def rooms(places: np.ndarray, floor: float, around: Sequence[Any], way: ArrayLike | None = None) -> np.ndarray:
    """The same at places (..., 2): (...) [m]."""
    places = np.ascontiguousarray(places, float)
    out, (boxes, pillars) = np.empty(places.shape[:-1]), solids_of(around)
    x, z = (0.0, 0.0) if way is None else map(float, way)  # type: ignore[misc]
    rooms_kernel(places.reshape(-1, 2), float(floor), boxes, pillars, x, z, way is not None, out.reshape(-1))
    return out


@kernel
def rooms_kernel(places, floor, boxes, pillars, x, z, goes, out):
    """Write how much room there is at places (N, 2), see `room`. goes: whether along x, z."""
    for n in range(len(places)):
        out[n] = room_kernel(places[n, 0], places[n, 1], floor, boxes, pillars, x, z, goes)


@kernel
def room_kernel(x, z, floor, boxes, pillars, way_x, way_z, goes):
    """How much room a walker has at a place [m], see `room`."""
    here = ground_kernel(x, z, boxes, floor + STEP)[0]
    if abs(here - floor) > STEP:
        if not goes or not over_crevice(x, z, way_x, way_z, floor, boxes):
            return -SHOULDER
        here = floor
    nearest = np.inf
    for height in BODY:
        nearest = min(nearest, nearest_kernel(x, here + height, z, boxes, pillars))
    return nearest - SHOULDER


@kernel
def over_crevice(x, z, way_x, way_z, floor, boxes):
    """Whether what lies lower than the floor [m] at a place is so narrow, along the way, that one steps over it."""
    speed = max(math.hypot(way_x, way_z), 1e-9)
    wide = 0.0
    for sign in (1.0, -1.0):
        ends = np.inf
        for far in EDGES:
            if abs(ground_kernel(x + sign * far * way_x / speed, z + sign * far * way_z / speed, boxes, floor + STEP)[0] - floor) <= STEP:
                ends = far
                break
        wide += ends
    return wide <= ASKEW


@kernel
def slide_kernel(x, z, velocity, floor, boxes, pillars, agile):
    """Turn the velocity (2,) wished at a place into that which runs into nothing, see `slide`."""
    wished_x, wished_z = velocity
    speed = math.hypot(wished_x, wished_z)
    if speed < 1e-6:
        return
    left = room_kernel(x, z, floor, boxes, pillars, wished_x, wished_z, True)
    # as far as it takes to stop, looked at step by step, lest a thin wall be missed
    count, pace = 1 + int(max(LOOK * speed / agile, LEAST) / PACE), PACE / speed
    for turn in DEVIATIONS:
        c, s = math.cos(turn), math.sin(turn)
        to_x, to_z = c * (c * wished_x + s * wished_z), c * (c * wished_z - s * wished_x)
        free = (free_kernel(x, z, to_x, to_z, count, pace, floor, boxes, pillars) if left > 0.0
                else room_kernel(x + pace * to_x, z + pace * to_z, floor, boxes, pillars, to_x, to_z, True) > left)
        if free:
            velocity[0], velocity[1] = to_x, to_z
            return
    velocity[:] = 0.0


@kernel
def free_kernel(x, z, to_x, to_z, count, pace, floor, boxes, pillars):
    """Whether there is room wherever one comes who goes with a velocity, after so many paces of so long [s], going up and down steps and ramps as they come."""
    for k in range(1, count + 1):
        there_x, there_z = x + k * pace * to_x, z + k * pace * to_z
        if room_kernel(there_x, there_z, floor, boxes, pillars, to_x, to_z, True) <= 0.0:
            return False
        below = ground_kernel(there_x, there_z, boxes, floor + STEP)[0]
        floor = below if floor - below <= STEP else floor  # over a crevice
    return True
