"""When somebody who walks leaps to a place: off the foot that is under him, at the moment at which he leaves there with the least change of how he goes.

A foot that has just struck is a step's half ahead of him, and brakes him until he is past it. In the next quarter of a second of his walk he comes over it, and past it, with the place the nearer;
how fast he would leave off it at each of these moments is told as for who goes slowly.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from ...body import yaw
from ..body import FLAT, Physique, Start, apex_airtime
from .going_slowly import PUSHES, TRAILS, airtime, sent

FLIES = 0.34, 0.44
"""Who goes to a place flies as long as his speed takes there, at most so long [s], and no shorter than the first, or than a skip as fast where that is shorter; on Earth, at standard height."""
RISES = 0.04
"""He rises so much at least [m], at standard height, and higher than where he lands by as much."""
LOWER = 0.08
"""So much lower than he leaves he lands on level ground [m], at standard height."""
USUAL, MOST = 2.1, 1.6
"""Who leaves upward faster than the first [m/s], on Earth, at standard height, pushes longer by the square of that, up to the second: as hard as no leg pushes, else."""
UNTIL, EACH = 0.1, 0.03
"""He leaps no later than this past the foot [m], at standard height; and the walk until there is looked at so often [m]."""
LEAVES, MISSES = (0.85, 0.9, 1.38), (0.05, 0.09)
"""He leaves no slower than the first times as he goes, in a moment to come than the second, and no faster than the last; and his foot sends him there within so much of how he goes, along his way and aside."""
ASIDE = 0.45, 0.15
"""And no faster aside of his way than so much of how fast he goes, in a moment that is, and in one to come: how he sways by then is not foretold."""
AS_GOOD = 0.06, (0.15, 0.3)
"""A moment is the best one if no later one off this foot changes his speed by so much less of it, nor one off one of the next by so much less, the second
where hands wait for it."""
STRIDE, LANDS, FEET = (0.28, 0.34), -0.36, 3
"""His next foot comes down so far ahead of this one [m], and farther by so much for each m/s, as he is so far past it [m], at standard height; and so many feet are looked at."""


def flies(far: np.ndarray | float, up: float, velocity: np.ndarray, size: float, gravity: float) -> np.ndarray:
    """How long (...) [s] somebody of a size over an adult's flies who goes so fast (3,) [m/s] and is to fly so far (...), and so far up [m]: as long as his speed takes, if he can."""
    scale, pace = math.sqrt(size * 9.81 / gravity), max(float(np.linalg.norm(velocity * FLAT)), 1e-9)
    usual = np.clip(far / pace, min(airtime(velocity, size), FLIES[0]) * scale, FLIES[1] * scale)
    return np.maximum(usual, apex_airtime(np.zeros(3), np.array([0.0, up, 0.0]), max(up, 0.0) + RISES * size, np.array([0.0, -gravity, 0.0])))


def longer(rises: np.ndarray | float, size: float, gravity: float) -> np.ndarray:
    """By what (...) the push of somebody of a size over an adult's takes longer who leaves upward so fast (...) [m/s]."""
    return np.clip(rises / (USUAL * math.sqrt(size * gravity / 9.81)), 1.0, math.sqrt(MOST))**2


def changes(physique: Physique, start: Start, goes: np.ndarray, place: np.ndarray, floor: float, gravity: float, gone: np.ndarray | float = 0.0, now: bool = False) -> np.ndarray:
    """By how much (...) of his speed somebody changes it who goes so fast (3,) [m/s] and, so far (...) [m] on, leaps off the foot that stands to a place (3,), off a floor [m]; infinite where that foot does not
    send him there. now: whether that moment is, or to come."""
    size, pace = physique.size, max(float(np.linalg.norm(goes)), 1e-9)
    centre = start.centre + np.asarray(gone)[..., None] * goes / pace
    scale, way = math.sqrt(size * 9.81 / gravity), (place - centre) * FLAT
    up, pushed, speed = float(place[1]) - floor - LOWER * size, 0.5 * PUSHES * scale, start.velocity * FLAT
    time = flies(np.linalg.norm(way - pushed * (speed + goes) - TRAILS * goes, axis=-1), up, start.velocity, size, gravity)
    lasts = longer(up / time + 0.5 * gravity * time, size, gravity)
    pushes = (pushed * lasts)[..., None]
    wanted = (way - pushes * speed) / (pushes + time[..., None] + TRAILS)
    velocity, _ = sent(physique, start, wanted, floor, gravity, time, lasts, centre)
    (along, aside), (ahead, beside) = _parts(wanted, goes, pace), _parts(velocity - wanted, goes, pace)
    sends = (LEAVES[not now] <= along) & (along <= LEAVES[2]) & (aside <= ASIDE[not now]) & (np.abs(ahead) <= MISSES[0])
    return np.where(sends & (beside <= (MISSES[1] if now else math.inf)), np.abs(along - 1.0), math.inf)


def _parts(velocity: np.ndarray, goes: np.ndarray, pace: float) -> tuple[np.ndarray, np.ndarray]:
    """How much (...) of a velocity (..., 3) is along a way that is gone so fast (3,) [m/s], and beside it, over its pace."""
    along = velocity @ goes / pace**2
    return along, np.linalg.norm(velocity - along[..., None] * goes, axis=-1) / pace


def moments(physique: Physique, start: Start, goes: np.ndarray, place: np.ndarray, floor: float, gravity: float, finds: Callable[[np.ndarray], bool], steep: float = 0.0, hands: bool = False,
            turns: float = 0.0) -> tuple[bool, bool]:
    """Whether somebody who walks so fast (3,) [m/s] is in the best moment to leap off the foot that stands to a place (3,), and whether a better one is to come, off this foot or off one of the
    next. finds: whether a foot finds floor at a place (3,). steep: how the floor rises on his way [m/m]. hands: whether hands wait for it. turns: how fast he turns [rad/s]: to the place, he has turned farther by the
    next steps."""
    assert start.single is not None
    size, pace = physique.size, max(float(np.linalg.norm(goes)), 1e-9)
    way, foot = goes / pace, start.feet[start.single, :3]
    past = float((start.centre - foot) @ way)

    def to_come() -> Iterator[tuple[np.ndarray, float]]:
        """The changes (N,) of moments to come, and by how much less they may be: from where he is now off this foot, and then off each of the next ones."""
        def passing(start: Start, way: np.ndarray, past: float, floor: float) -> np.ndarray:
            return changes(physique, start, pace * way, place, floor, gravity, np.arange(0.0, UNTIL * size - past, EACH))
        yield passing(_gone(start, EACH * way), way, past + EACH, floor), AS_GOOD[0]
        other, stride, lands, ahead = start, STRIDE[0] * size + STRIDE[1] * pace * math.sqrt(size), LANDS * size, way
        for number in range(1, FEET + 1):
            step = _turned(start if number == 1 else other, ahead, place, turns * stride / pace)
            assert other.single is not None
            there = other.feet[other.single, :3]
            other, ahead = _round(other, step, there), yaw(step) @ ahead
            if not finds(there + stride * ahead):
                return
            other = _stepped(_gone(other, (lands - past) * ahead) if number == 1 else other, stride, ahead)
            yield passing(other, ahead, lands, floor + number * stride * steep), AS_GOOD[1][hands]
    now, better = float(changes(physique, start, goes, place, floor, gravity, now=True)), False
    good = now < math.inf
    for change, less in to_come():
        least = float(change.min(initial=math.inf))
        better, good = better or least < math.inf, good and now <= least + less
        if better and not good:  # more would say no more
            break
    return good, better


def _stepped(start: Start, far: float, way: np.ndarray) -> Start:
    """The same start a step so far [m] on along a way (3,), over the other foot."""
    assert start.single is not None
    feet = start.feet.copy()
    left = np.array([way[2], 0.0, -way[0]])
    feet[1 - start.single, :3] = feet[start.single, :3] + far * way + 2.0 * float((start.centre - feet[start.single, :3]) @ left) * left
    feet[1 - start.single, 3:] = feet[start.single, 3:]
    velocity = start.velocity - 2.0 * float(start.velocity @ left) * left
    return replace(_gone(start, far * way), feet=feet, feet_rates=np.zeros((2, 5)), single=1 - start.single, velocity=velocity)


def _turned(start: Start, way: np.ndarray, place: np.ndarray, turn: float) -> float:
    """How far [rad] somebody turns in a step who goes a way (3,) and turns so far in one: no farther than to a place (3,), and not away from it."""
    to = (place - start.centre) * FLAT
    left = math.atan2(float(to @ [way[2], 0.0, -way[0]]), float(to @ way))
    return max(min(turn, left), 0.0) if left > 0.0 else min(max(turn, left), 0.0)


def _round(start: Start, turn: float, about: np.ndarray) -> Start:
    """The same start turned [rad] about a place (3,)."""
    if not turn:
        return start
    turned, feet = yaw(turn), start.feet.copy()
    feet[:, :3] = about + (feet[:, :3] - about) @ turned.T
    feet[:, 3] += turn
    return replace(start, root=about + turned @ (start.root - about), centre=about + turned @ (start.centre - about), velocity=turned @ start.velocity, feet=feet, heading=start.heading + turn)


def _gone(start: Start, way: np.ndarray) -> Start:
    """The same start a way (3,) [m] on."""
    return replace(start, root=start.root + way, centre=start.centre + way)
