"""Falls beside walls and on several levels: the way that is free, and what holds a falling body where none is.

A body falls most nearly the way that it goes, and aside where a wall stands or the ground ends there. A wall that it comes to all the same holds it: its feet slide away below it.
What is no higher than a step it lies on.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..body import centre_of_mass, end_positions, forward_kinematics, yaw
from ..compiled import kernel
from ..jump.body import Physique
from ..jump.motion import BONES, grounded_poses, sole_places
from .recorded_falls import RATE, Fall
from .surroundings import STEP, abyss_kernel, aside_kernel, tread_kernel

ASIDE = np.radians([0.0, 15.0, -15.0, 30.0, -30.0, 45.0, -45.0, 65.0, -65.0, 90.0, -90.0, 125.0, -125.0, 180.0])
"""So far from where it goes a body may fall [rad]; the nearest first."""
COSTS = 1.0, 8.0, 3.0
"""What it costs to be turned while one falls [1/rad], to go into a wall [1/m], and to lie with one's middle over an abyss."""
LOOKED = 6
"""Every so many moments of a recorded fall are looked at where a way is chosen."""
SPACED = 3
"""So many places of a bone are told of."""
GRAZE = 0.01
"""So much of its flesh a body may graze a wall with [m]."""
EARLY, SMOOTH = 0.10, 0.05
"""A wall is felt so long before it is met [s], and the body held as smoothly as means of so long are [s]."""


def flesh(physique: Physique, positions: np.ndarray, turned: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Places (N, P, 3) [m] on a placed body's bones and soles, and how thick (P,) it is there [m]."""
    skeleton, at = physique.skeleton, physique.skeleton.index
    ends, places, thick = end_positions(skeleton, positions, turned), [], []
    for first, last, radius in BONES:
        for side in ("",) if first in skeleton.names else ("Left", "Right"):
            begin = positions[:, at(side + first)]
            stop = ends[:, skeleton.end_index[side + first]] if not last else positions[:, at(last if last in skeleton.names else side + last)]
            places += [begin + share * (stop - begin) for share in np.linspace(0.0, 1.0, SPACED)]
            thick += [radius * physique.size] * SPACED
    soles = [place for place, _ in sole_places(physique, positions, turned)]
    return np.stack([*places, *soles], 1), np.array(thick + [0.02 * physique.size] * len(soles))


def chosen(physique: Physique, every: Sequence[Fall], place: np.ndarray, way: float, heading: float, floor: float, things: np.ndarray) -> tuple[Fall, float]:
    """Of falls the one, and how far [rad] it is turned as it topples, of a body at a place (3,) that goes `way` [rad] in the world and faces `heading`: that which is turned least and nearest
    to its way, but not into walls, nor over an edge where there is another."""
    best, least = (every[0], 0.0), math.inf
    for fall in every:
        points, thick, centre = _sampled(physique, fall) if len(things) else (np.zeros((0, 0, 3)), np.zeros(0), np.zeros((0, 3)))
        for aside in ASIDE if len(things) else ASIDE[:1]:
            turn = math.remainder(way + aside - heading - fall.way, math.tau)
            cost = COSTS[0] * (abs(turn) + abs(aside))
            if len(things) and cost < least:
                facing, here = yaw(heading + turn).T, np.array([place[0], floor, place[2]])
                deep, lost = looked_kernel(things, points @ facing + here, thick, centre @ facing + here, floor)
                cost += COSTS[1] * deep + COSTS[2] * lost
            if cost < least:
                best, least = (fall, turn), cost
    return best


def _sampled(physique: Physique, fall: Fall) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A fall's flesh (N, P, 3) over a floor at 0, as it begins over the middle, facing ahead; how thick (P,) that is; and where (M, 3) its mass centre is from when it strikes the floor on."""
    times = np.arange(fall.begins, fall.lasts, LOOKED / RATE)
    local = fall.turns(times)
    roots, _ = grounded_poses(physique, local, np.zeros(3), 0.0)
    placed = forward_kinematics(physique.skeleton, roots, local)
    centre = centre_of_mass(physique.anatomy, *placed)
    return *flesh(physique, *placed), centre[times >= fall.strikes]


@kernel
def looked_kernel(things, points, thick, centre, floor):
    """How deep places (N, P, 3) with flesh (P,) go into walls at most [m], and for what share of the moments a mass centre (M, 3) is over an abyss."""
    deep, lost, out = 0.0, 0, np.empty(2)
    for n in range(len(points)):
        for p in range(len(thick)):
            low = max(points[n, p, 1] - thick[p], floor + STEP)
            deep = max(deep, thick[p] - aside_kernel(things, points[n, p, 0], points[n, p, 2], low, max(points[n, p, 1] + thick[p], low + 1e-6), out))
    for n in range(len(centre)):
        lost += abyss_kernel(things, centre[n, 0], centre[n, 2], floor)
    return deep, lost / max(len(centre), 1)


def held(points: np.ndarray, thick: np.ndarray, floor: float, things: np.ndarray) -> np.ndarray:
    """How far (N, 3) [m] a body is led off in every moment, whose flesh is (P,) thick at places (N, P, 3): away from walls, where it stays, and up onto what is a step."""
    from scipy.ndimage import gaussian_filter1d, maximum_filter1d  # no game waits for it at its start

    off = np.zeros((len(points), 3))
    held_kernel(things, points, thick, floor, off)
    early = min(round(EARLY * RATE), len(off) - 1)
    off[:, [0, 2]] = np.concatenate([off[early:, [0, 2]], np.repeat(off[-1:, [0, 2]], early, 0)])
    if len(off) > 1:
        off[:, [0, 2]] = off[:, [0, 2]] - off[0, [0, 2]] * np.clip(1.0 - np.arange(len(off)) / (2.0 * early + 1.0), 0.0, 1.0)[:, None]
    off[:, [0, 2]] = gaussian_filter1d(off[:, [0, 2]], SMOOTH * RATE, axis=0, mode="nearest")
    moved, lifts = points + off[:, None] * [1.0, 0.0, 1.0], np.zeros(len(off))
    lift_kernel(things, moved, thick, floor, lifts)
    wide = round(2.0 * EARLY * RATE)
    off[:, 1] = gaussian_filter1d(maximum_filter1d(lifts, 2 * wide + 1, mode="nearest"), 0.5 * wide, mode="nearest")
    off[:, 1] *= np.clip(np.arange(len(off)) / (1.5 * wide), 0.0, 1.0)
    return off


@kernel
def held_kernel(things, points, thick, floor, off):
    """Write into `off` (N, 3) how far along the floor places (N, P, 3) are led out of walls: no nearer again once they were led off."""
    out = np.empty(2)
    for n in range(len(points)):
        if n > 0:
            off[n] = off[n - 1]
        for _ in range(6):
            deep, ox, oz = 0.0, 0.0, 0.0
            for p in range(len(thick)):
                low = max(points[n, p, 1] - thick[p], floor + STEP)
                gap = aside_kernel(things, points[n, p, 0] + off[n, 0], points[n, p, 2] + off[n, 2], low, max(points[n, p, 1] + thick[p], low + 1e-6), out)
                if thick[p] - gap > deep:
                    deep, ox, oz = thick[p] - gap, out[0], out[1]
            if deep <= 1e-4:
                break
            off[n, 0] += deep * ox
            off[n, 2] += deep * oz


@kernel
def lift_kernel(things, points, thick, floor, lifts):
    """Write how far (N,) places (N, P, 3) with flesh (P,) are below what is no higher than a step."""
    for n in range(len(points)):
        for p in range(len(thick)):
            lifts[n] = max(lifts[n], tread_kernel(things, points[n, p, 0], points[n, p, 2], floor + STEP, floor) + thick[p] - points[n, p, 1])


def under(things: np.ndarray, centres: np.ndarray, floor: float) -> np.ndarray:
    """How high (N,) [m] the ground lies under mass centres (N, 3); where something stands there, as high as the floor [m]."""
    levels = np.full(len(centres), floor)
    under_kernel(things, centres, floor, levels)
    return levels


@kernel
def under_kernel(things, centres, floor, levels):
    """Write how high the ground lies, see `under`."""
    for n in range(len(centres)):
        level = tread_kernel(things, centres[n, 0], centres[n, 2], floor + STEP, floor)
        if level > floor - STEP or abyss_kernel(things, centres[n, 0], centres[n, 2], floor):
            levels[n] = level
