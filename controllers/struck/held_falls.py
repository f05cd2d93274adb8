"""Falls beside walls and on several levels: the way that is free, and what holds a falling body where none is.

A body falls most nearly the way that it goes, and aside where a wall stands or the ground ends there. A wall that it comes to all the same holds it: its feet slide away below it.
What one comes to step by step is no wall: it lies on that (`settled`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from ..body import centre_of_mass, forward_kinematics, yaw
from ..compiled import kernel
from ..jump.body import Physique
from ..jump.motion import grounded_poses
from .flesh import flesh
from .recorded_falls import RATE, Fall
from .stepwise_ground import Ground, cell_kernel
from .surroundings import STEP, aside_kernel

ASIDE = np.radians([0.0, 15.0, -15.0, 30.0, -30.0, 45.0, -45.0, 65.0, -65.0, 90.0, -90.0, 125.0, -125.0, 180.0])
"""So far from where it goes a body may fall [rad]; the nearest first."""
COSTS = 1.0, 8.0, 3.0
"""What it costs to be turned while one falls [1/rad], to go into a wall [1/m], and to lie with one's middle over an abyss."""
LOOKED = 6
"""Every so many moments of a recorded fall are looked at where a way is chosen."""
GRAZE = 0.01
"""So much of its flesh a body may graze a wall with [m]."""
EARLY, SMOOTH = 0.10, 0.05
"""A wall is felt so long before it is met [s], and the body held as smoothly as means of so long are [s]."""


def chosen(physique: Physique, every: Sequence[Fall], place: np.ndarray, way: float, heading: float, floor: float, ground: Ground | None) -> tuple[Fall, float]:
    """Of falls the one, and how far [rad] it is turned as it topples, of a body at a place (3,) that goes `way` [rad] in the world and faces `heading`: that which is turned least and nearest
    to its way, but not into walls, nor over an edge where there is another."""
    best, least = (every[0], 0.0), math.inf
    for fall in every:
        points, thick, centre = _sampled(physique, fall) if ground is not None else (np.zeros((0, 0, 3)), np.zeros(0), np.zeros((0, 3)))
        for aside in ASIDE if ground is not None else ASIDE[:1]:
            turn = math.remainder(way + aside - heading - fall.way, math.tau)
            cost = COSTS[0] * (abs(turn) + abs(aside))
            if ground is not None and cost < least:
                facing, here = yaw(heading + turn).T, np.array([place[0], floor, place[2]])
                deep, lost = looked_kernel(*ground, points @ facing + here, thick, centre @ facing + here, floor)
                cost += COSTS[1] * deep + COSTS[2] * lost
            if cost < least:
                best, least = (fall, turn), cost
    return best


@lru_cache(maxsize=64)
def _sampled(physique: Physique, fall: Fall) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A fall's flesh (N, P, 3) over a floor at 0, as it begins over the middle, facing ahead; how thick (P,) that is; and where (M, 3) its mass centre is from when it strikes the floor on."""
    times = np.arange(fall.begins, fall.lasts, LOOKED / RATE)
    local = fall.turns(times)
    roots, _ = grounded_poses(physique, local, np.zeros(3), 0.0)
    placed = forward_kinematics(physique.skeleton, roots, local)
    centre = centre_of_mass(physique.anatomy, *placed)
    return *flesh(physique, *placed), centre[times >= fall.strikes]


@kernel
def wall_kernel(things, corner, caps, floor, place, thick, out):
    """How far a ball of a radius `thick` [m] about a place (3,) is from walls, its middle, see `aside_kernel`: from what stands higher than what one comes to step by step."""
    low = max(place[1] - thick, cell_kernel(corner, caps, place[0], place[2], floor))
    low = max(low, floor + STEP) if low == floor or low == -math.inf else low
    return aside_kernel(things, place[0], place[2], low, max(place[1] + thick, low + 1e-6), out)


@kernel
def looked_kernel(things, corner, levels, caps, points, thick, centre, floor):
    """How deep places (N, P, 3) with flesh (P,) go into walls at most [m], and for what share of the moments a mass centre (M, 3) is where nobody comes step by step."""
    deep, lost, out = 0.0, 0, np.empty(2)
    for n in range(len(points)):
        for p in range(len(thick)):
            deep = max(deep, thick[p] - wall_kernel(things, corner, caps, floor, points[n, p], thick[p], out))
    for n in range(len(centre)):
        lost += math.isnan(cell_kernel(corner, levels, centre[n, 0], centre[n, 2], math.nan))
    return deep, lost / max(len(centre), 1)


def held(points: np.ndarray, thick: np.ndarray, floor: float, ground: Ground) -> np.ndarray:
    """How far (N, 3) [m] a body is led off along the floor in every moment, whose flesh is (P,) thick at places (N, P, 3): away from walls, where it stays."""
    from scipy.ndimage import gaussian_filter1d  # no game waits for it at its start

    off = np.zeros((len(points[::2]), 3))
    held_kernel(ground.things, ground.corner, ground.caps, points[::2], thick, floor, off)
    off = np.repeat(off, 2, 0)[:len(points)]  # smoothed below
    early = min(round(EARLY * RATE), len(off) - 1)
    off = np.concatenate([off[early:], np.repeat(off[-1:], early, 0)])
    if len(off) > 1:
        off = off - off[0] * np.clip(1.0 - np.arange(len(off)) / (2.0 * early + 1.0), 0.0, 1.0)[:, None]
    return gaussian_filter1d(off, SMOOTH * RATE, axis=0, mode="nearest")


@kernel
def held_kernel(things, corner, caps, points, thick, floor, off):
    """Write into `off` (N, 3) how far along the floor places (N, P, 3) are led out of walls: no nearer again once they were led off."""
    out = np.empty(2)
    for n in range(len(points)):
        if n > 0:
            off[n] = off[n - 1]
        for _ in range(6):
            deep, ox, oz = 0.0, 0.0, 0.0
            for p in range(len(thick)):
                gap = wall_kernel(things, corner, caps, floor, points[n, p] + off[n], thick[p], out)
                if thick[p] - gap > deep:
                    deep, ox, oz = thick[p] - gap, out[0], out[1]
            if deep <= 1e-4:
                break
            off[n, 0] += deep * ox
            off[n, 2] += deep * oz
