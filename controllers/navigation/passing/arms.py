"""Arms drawn in, as people do who pass closely by something: without it hands swing farther than a walker's clearance.

What stands there is convex, so that all of it lies behind the plane through its place nearest to the body. An arm that comes to
that plane turns about its shoulder by what is missing. As that follows from the pose and the place alone, arms move as smoothly as the body
does; where things come, go or move in a step, so that arms would jump, what they jump by is remembered and fades: inertialisation.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from ...body import Pose, Skeleton, exp, log, relative_kernel, settle
from ...compiled import kernel
from ..routes import distance
from .walls import walls_of

ARMS = ("LeftArm", "LeftForeArm", "LeftHand"), ("RightArm", "RightForeArm", "RightHand")
THICK = 0.045, 0.04, 0.035
"""Elbows, wrists and finger tips are so thick [m]."""
FINGERS = 0.5
"""Finger tips are so much of a forearm beyond the wrist, straight on, of a skeleton that tells of no end of its hands."""
KEPT = 0.02
"""So much room is left beside them [m]."""
SOFT = 0.04
"""An arm begins to be drawn in so much before it has to [m]."""
MOST, AHEAD = 0.35, 0.9
"""No farther than this [rad]: across there is the trunk, and back or ahead a shoulder's own reach."""
FAR = 0.75
"""What is farther from the body's middle [m] no arm touches."""
LOW = 0.15
"""Arms that clear the top or underside of something by so much [m] are not drawn in at all."""

FAST, NEARER, RUNS, HALFLIFE = 4.0, 6.0, 1.5, 0.08
"""Arms that would have to go out faster than the first [rad/s], or come in by so much more for each m/s that the body is faster than the third, as of who comes to a wall at a run, go as fast as
that where it is the body that moves, and the rest of the way with this half-life [s]; all of it where things come, go or move."""
GONE = 1e-4
"""Less than this is nothing [rad]."""
SHAPE = 6
"""So many numbers tell where something stands, and how large it is."""


@dataclass(frozen=True, eq=False)
class Arms:
    """How far arms are drawn in. wanted: (2, 3) by how much [rad] upper arms turn for what stands there, rotation vectors in the chest's frame. left, rate: (2, 3) by how much
    more they are turned than that [rad], and how fast that changes [rad/s]. things: what was near, as of `_near`."""

    wanted: np.ndarray
    left: np.ndarray
    rate: np.ndarray
    things: tuple[tuple[float, ...], ...] = ()


_NONE = np.zeros((2, 3))
FREE = Arms(_NONE, _NONE, _NONE)


def drawn_on(skeleton: Skeleton, pose: Pose, ground: np.ndarray, around: Sequence[Any], arms: Arms | None, speed: float, dt: float) -> tuple[Pose, Arms | None]:
    """The pose as of `drawn_in`, without a jump where things came, went or moved in the step of dt seconds that led to it. arms: what this gave a step before; None of who was
    free. speed: of the body [m/s]."""
    things = tuple(_near(float(ground[0]), float(ground[1]), around))
    near = _drawn(skeleton, pose, ground, things)
    if arms is None and near is pose:
        return pose, None
    arms, upper = arms or FREE, [chain[0] for chain in _chains(skeleton.names)]
    own = np.asarray(pose.rotations, float)[upper]
    wanted = log(near.rotations[upper] @ np.swapaxes(own, -1, -2)) if near is not pose else FREE.wanted
    change = wanted - arms.wanted
    inwards = np.linalg.norm(wanted, axis=-1, keepdims=True) > np.linalg.norm(arms.wanted, axis=-1, keepdims=True)
    most, much = (FAST + NEARER * max(speed - RUNS, 0.0) * inwards) * dt, np.linalg.norm(change, axis=-1, keepdims=True)
    same = {thing[:SHAPE] for thing in things} == {thing[:SHAPE] for thing in arms.things}
    sudden = np.where(much > most, 1.0 - same * most / np.maximum(much, GONE), 0.0)
    left, rate = settle(arms.left - sudden * change, arms.rate, HALFLIFE, dt)
    if np.abs(left).max() < GONE:
        return near, None if near is pose else Arms(wanted, FREE.left, FREE.rate, things)
    rotations = np.array(pose.rotations)
    rotations[upper] = exp(wanted + left) @ own
    return Pose(pose.root, rotations), Arms(wanted, left, rate, things)


def drawn_in(skeleton: Skeleton, pose: Pose, ground: np.ndarray, around: Sequence[Any]) -> Pose:
    """The pose of one walker at a ground frame (3,) x, z [m], heading [rad], his arms drawn in where they come near to boxes and pillars. The very same
    where nothing is near, or where he stands in something."""
    return _drawn(skeleton, pose, ground, _near(float(ground[0]), float(ground[1]), around))


def _drawn(skeleton: Skeleton, pose: Pose, ground: np.ndarray, things: Sequence[tuple[float, ...]]) -> Pose:
    chains = _chains(skeleton.names)
    if not things or not len(chains):
        return pose
    rotations = np.array(pose.rotations)
    moved = draw_kernel(np.asarray(pose.root, float), rotations, skeleton.parents, skeleton.offsets, chains, _tips(skeleton), np.asarray(ground, float), np.array(things),
                        np.array(THICK))
    return Pose(pose.root, rotations) if moved else pose


def _near(x: float, z: float, around: Sequence[Any]) -> list[tuple[float, ...]]:
    """What is near enough: shapes of SHAPE numbers as of `shapes_of`, how low and how high they reach [m], ramps where they are nearest."""
    walls, found = walls_of(around), []
    for k in np.flatnonzero(np.hypot(walls[:, 0] - x, walls[:, 1] - z) < FAR + np.hypot(walls[:, 2], walls[:, 3]) + walls[:, 5]):
        *shape, low, high, slope = walls[k].tolist()
        along = math.sin(shape[4]) * (x - shape[0]) + math.cos(shape[4]) * (z - shape[1])
        rise = slope * min(max(along, -shape[3]), shape[3])
        found.append((*shape, low + rise, high + rise))
    return found


@lru_cache(maxsize=8)
def _chains(names: tuple[str, ...]) -> np.ndarray:
    """The joints (2, 3) of both arms; none (0, 3) of a skeleton without such arms."""
    return np.array([[names.index(name) for name in chain] for chain in ARMS if all(name in names for name in chain)], np.int64).reshape(-1, 3)


@lru_cache(maxsize=8)
def _tips(skeleton: Skeleton) -> np.ndarray:
    """Where finger tips (2, 3) are in their hands' frames [m]: hands are bent as they hang, so that these are elsewhere than straight on."""
    hands = [chain[2] for chain in _chains(skeleton.names)]
    return np.array([skeleton.end_offsets[end] if (end := skeleton.end_index.get(skeleton.names[hand])) is not None else FINGERS * skeleton.offsets[hand] for hand in hands])


@kernel
def draw_kernel(root, local, parents, offsets, chains, tips, ground, things, thick):
    """Turn the upper arms in local rotations (J, 3, 3), in place; whether any was. tips: (2, 3) as of `_tips`; things: (K, 8) as of `_near`."""
    count = local.shape[0]
    places, turned = np.empty((count, 3)), np.empty((count, 3, 3))
    for j in range(count):
        p = parents[j]
        for i in range(3):
            places[j, i] = root[i]
            for k in range(3):
                turned[j, i, k] = local[j, i, k]
        if p >= 0:
            for i in range(3):
                places[j, i] = places[p, i]
                for k in range(3):
                    places[j, i] += turned[p, i, k] * offsets[j, k]
                    turned[j, i, k] = 0.0
                    for m in range(3):
                        turned[j, i, k] += turned[p, i, m] * local[j, m, k]
    points, slope, axis, moved = np.empty((3, 3)), np.empty(3), np.empty(3), False
    for arm in range(chains.shape[0]):
        shoulder, hand = chains[arm, 0], chains[arm, 2]
        for i in range(3):
            points[0, i], points[1, i] = places[chains[arm, 1], i], places[hand, i]
            points[2, i] = points[1, i] + turned[hand, i, 0] * tips[arm, 0] + turned[hand, i, 1] * tips[arm, 1] + turned[hand, i, 2] * tips[arm, 2]
        for n in range(things.shape[0]):
            there = distance(ground[0], ground[1], things[n, :6], slope)
            if there <= 0.0:
                continue
            most, worst = 0.0, -1
            for k in range(3):
                missing = thick[k] + KEPT - there - slope[0] * (points[k, 0] - ground[0]) - slope[1] * (points[k, 2] - ground[1])
                if missing <= -SOFT:
                    continue
                over = max(points[k, 1] - things[n, 7], things[n, 6] - points[k, 1], 0.0)
                missing = missing if missing >= SOFT else (missing + SOFT) ** 2 / (4.0 * SOFT)
                dx, dy, dz = points[k, 0] - places[shoulder, 0], points[k, 1] - places[shoulder, 1], points[k, 2] - places[shoulder, 2]
                lever = math.sqrt((dy * slope[1]) ** 2 + (dz * slope[0] - dx * slope[1]) ** 2 + (dy * slope[0]) ** 2)
                turn = max(1.0 - max(over - thick[k], 0.0) / LOW, 0.0) * missing / max(lever, 0.1)
                if turn > most:
                    most, worst = turn, k
            if worst < 0:
                continue
            dx, dy, dz = points[worst, 0] - places[shoulder, 0], points[worst, 1] - places[shoulder, 1], points[worst, 2] - places[shoulder, 2]
            axis[0], axis[1], axis[2] = dy * slope[1], dz * slope[0] - dx * slope[1], -dy * slope[0]
            length = math.sqrt(axis[0] ** 2 + axis[1] ** 2 + axis[2] ** 2)
            if length < 1e-6:
                continue
            along = (slope[0] * math.sin(ground[2]) + slope[1] * math.cos(ground[2])) ** 2
            limit = MOST + (AHEAD - MOST) * along
            angle = limit * math.tanh(most / limit)
            _turn(axis / length, angle, turned[shoulder])
            for k in range(3):
                _turn_point(axis / length, angle, places[shoulder], points[k])
            moved = True
        relative_kernel(turned[parents[shoulder]], turned[shoulder], local[shoulder])
    return moved


@kernel
def _turn_point(axis, angle, about, point):
    """Turn a place (3,) about an axis (3,) of length 1 through another place, in place: Rodrigues."""
    c, s = math.cos(angle), math.sin(angle)
    x, y, z = point[0] - about[0], point[1] - about[1], point[2] - about[2]
    along = (1.0 - c) * (axis[0] * x + axis[1] * y + axis[2] * z)
    point[0] = about[0] + c * x + s * (axis[1] * z - axis[2] * y) + along * axis[0]
    point[1] = about[1] + c * y + s * (axis[2] * x - axis[0] * z) + along * axis[1]
    point[2] = about[2] + c * z + s * (axis[0] * y - axis[1] * x) + along * axis[2]


@kernel
def _turn(axis, angle, frame):
    """Turn a frame (3, 3) about an axis (3,) of length 1, in place."""
    column, about = np.empty(3), np.zeros(3)
    for k in range(3):
        for i in range(3):
            column[i] = frame[i, k]
        _turn_point(axis, angle, about, column)
        for i in range(3):
            frame[i, k] = column[i]
