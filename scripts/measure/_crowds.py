"""Scenes in which crowds are measured: a hall, a corridor, flows that cross, doors."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from gambol.game.scene import Box, Pillar


class Scene(NamedTuple):
    """start: (N, 3) ground frames. goal: the goal (2,) of walker i after so many arrivals, None to stay. around: what stands there."""

    start: np.ndarray
    goal: Callable[[int, int, np.random.Generator], np.ndarray | None]
    around: list

def spread(count: int, low, high, rng, apart: float = 0.8) -> np.ndarray:
    """Places (count, 2) in a rectangle, none nearer to another than `apart` [m]."""
    places = np.zeros((0, 2))
    for _ in range(100000):
        if len(places) == count:
            return places
        place = rng.uniform(low, high)
        if not len(places) or np.linalg.norm(places - place, axis=1).min() > apart:
            places = np.vstack([places, place])
    raise SystemExit("too many people for this scene: give fewer --people")


def facing(places, goals) -> np.ndarray:
    """Ground frames (N, 3) at places, looking to goals."""
    offset = goals - places
    return np.column_stack([places, np.arctan2(offset[:, 0], offset[:, 1])])


def hall(count: int, rng) -> Scene:
    """A hall of 18 × 18 m with four pillars, everybody to one place after the other."""
    pillars = [Pillar((x, 0.0, z), 0.3, 3.0) for x in (-4.0, 4.0) for z in (-4.0, 4.0)]
    start = spread(count + 12, (-8.5, -8.5), (8.5, 8.5), rng, 0.9)
    start = start[np.argsort(np.linalg.norm(np.abs(start) - 4.0, axis=1) < 0.8, kind="stable")][:count]  # nobody begins in a pillar

    def goal(who, number, rng):
        place = rng.uniform(-8.0, 8.0, 2)
        while np.hypot(*(np.abs(place) - 4.0)) < 1.2:
            place = rng.uniform(-8.0, 8.0, 2)
        return place
    return Scene(np.column_stack([start, rng.uniform(-np.pi, np.pi, count)]), goal, pillars)


def walls(*stretches) -> list:
    """Walls 0.2 m thick and 2.5 m high along stretches x, z to x, z [m]."""
    made = []
    for ax, az, bx, bz in stretches:
        made.append(Box(((ax + bx) / 2, 1.25, (az + bz) / 2), (0.2 + abs(bx - ax), 2.5, 0.2 + abs(bz - az))))
    return made


def corridor(count: int, rng) -> Scene:
    """A corridor of 4 × 30 m, half of them against the other half, each once along it and out."""
    half = count // 2
    one, other = spread(half, (-1.5, -19.0), (1.5, -3.0), rng), spread(count - half, (-1.5, 3.0), (1.5, 19.0), rng)
    start = np.concatenate([one, other])
    ends = np.concatenate([spread(half, (-5.0, 23.0), (5.0, 38.0), rng, 1.2), spread(count - half, (-5.0, -38.0), (5.0, -23.0), rng, 1.2)])
    return Scene(facing(start, ends), lambda who, number, rng: ends[who] if number == 0 else None,
                 walls((-2.1, -20.0, -2.1, 20.0), (2.1, -20.0, 2.1, 20.0)))


def crossing(count: int, rng) -> Scene:
    """Two streams that cross at a right angle, each 5 m wide."""
    half = count // 2
    one, other = spread(half, (-2.5, -20.0), (2.5, -4.0), rng), spread(count - half, (-20.0, -2.5), (-4.0, 2.5), rng)
    start = np.concatenate([one, other])
    ends = start + np.where(np.arange(count)[:, None] < half, [[0.0, 34.0]], [[34.0, 0.0]])
    return Scene(facing(start, ends), lambda who, number, rng: ends[who] if number == 0 else None, [])


ROOMS = (-10.0, -16.0, -10.0, 16.0), (10.0, -16.0, 10.0, 16.0), (-10.0, -16.0, 10.0, -16.0), (-10.0, 16.0, 10.0, 16.0)


def door(count: int, rng) -> Scene:
    """Everybody through a door of 1.3 m, to a place behind it."""
    start = spread(count, (-5.0, -9.0), (5.0, -1.5), rng)
    ends = spread(count, (-9.0, 4.0), (9.0, 14.0), rng, 1.1)
    return Scene(facing(start, ends), lambda who, number, rng: ends[who] if number == 0 else None,
                 walls((-10.0, 0.0, -0.75, 0.0), (0.75, 0.0, 10.0, 0.0), *ROOMS))


def two_ways(count: int, rng) -> Scene:
    """Half of them through a door of 1.8 m against the other half: people at doors take turns, ORCA knows nothing of that."""
    half = count // 2
    start = np.concatenate([spread(half, (-5.0, -9.0), (5.0, -1.5), rng), spread(count - half, (-5.0, 1.5), (5.0, 9.0), rng)])
    ends = np.concatenate([spread(half, (-7.0, 4.0), (7.0, 14.0), rng, 1.1), spread(count - half, (-7.0, -14.0), (7.0, -4.0), rng, 1.1)])
    return Scene(facing(start, ends), lambda who, number, rng: ends[who] if number == 0 else None,
                 walls((-10.0, 0.0, -1.0, 0.0), (1.0, 0.0, 10.0, 0.0), *ROOMS))


SCENES = {"hall": hall, "corridor": corridor, "crossing": crossing, "door": door, "two_ways": two_ways}
