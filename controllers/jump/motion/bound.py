"""When somebody who walks leaps to a place: off the foot that is under him, at the moment at which he leaves there with the least change of how he goes.

A foot that has just struck is a step's half ahead of him, and brakes him until he is past it. In the next quarter of a second of his walk he comes over it, and past it, with the place the nearer;
how fast he would leave off it at each of these moments is told as for who goes slowly.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from ...body import yaw
from ...compiled import kernel
from ..body import FLAT, Physique, Start
from .going_slowly import PUSHES, TRAILS, airtime, sent_kernel

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


class Stands(NamedTuple):
    """What of a start tells how somebody leaves off the foot that stands: centre, velocity (3,) [m, m/s] of his mass, his feet (2, 5) as they stand, and which of them does, 0 left, 1 right."""

    centre: np.ndarray
    velocity: np.ndarray
    feet: np.ndarray
    single: int


def flies_between(velocity: np.ndarray, size: float, gravity: float) -> tuple[float, float]:
    """How long [s] somebody of a size over an adult's flies at least and at most who goes so fast (3,) [m/s]."""
    scale = math.sqrt(size * 9.81 / gravity)
    return min(airtime(velocity, size), FLIES[0]) * scale, FLIES[1] * scale


@kernel
def flies_kernel(far, up, pace, least, most, size, gravity):
    """How long [s] somebody of a size over an adult's flies who goes so fast [m/s] and is to fly so far, and so far up [m]: as long as his speed takes, if he can. least, most: see `flies_between`."""
    rises = max(up, 0.0) + RISES * size
    return max(min(max(far / max(pace, 1e-9), least), most), math.sqrt(2.0 * rises / gravity) + math.sqrt(2.0 * max(rises - up, 0.0) / gravity))


@kernel
def longer_kernel(rises, size, gravity):
    """By what the push of somebody of a size over an adult's takes longer who leaves upward so fast [m/s]."""
    return min(max(rises / (USUAL * math.sqrt(size * gravity / 9.81)), 1.0), math.sqrt(MOST))**2


def changes(physique: Physique, stands: Stands, goes: np.ndarray, place: np.ndarray, floor: float, gravity: float, gone: np.ndarray | None = None) -> float:
    """By how much of his speed somebody changes it who goes so fast (3,) [m/s] and leaps off the foot that stands to a place (3,), off a floor [m]; infinite where that foot does not
    send him there. gone: (N,) [m] so far on, in moments to come, of which the best is told; None of the moment that is."""
    least, most = flies_between(stands.velocity, physique.size, gravity)
    return changes_kernel(physique.size, physique.tables.tip, stands.centre, stands.velocity, stands.feet[stands.single], goes, place, floor, gravity, least, most,
                          np.zeros(1) if gone is None else gone, gone is None)


@kernel
def changes_kernel(size, tip, centre, velocity, foot, goes, place, floor, gravity, least, most, gone, now):
    """See `changes`. foot: (5,) that stands. least, most: [s] as in `flies_between`. now: whether that moment is, or to come."""
    pace, runs = max(math.hypot(goes[0], goes[2]), 1e-9), math.hypot(velocity[0], velocity[2])
    pushed, up, best = 0.5 * PUSHES * math.sqrt(size * 9.81 / gravity), place[1] - floor - LOWER * size, math.inf
    there, wanted, out = centre.copy(), np.zeros(3), np.empty(4)
    for n in range(len(gone)):
        for i in (0, 2):
            there[i] = centre[i] + gone[n] * goes[i] / pace
        x, z = place[0] - there[0], place[2] - there[2]
        far = math.hypot(x - pushed * (velocity[0] + goes[0]) - TRAILS * goes[0], z - pushed * (velocity[2] + goes[2]) - TRAILS * goes[2])
        time = flies_kernel(far, up, runs, least, most, size, gravity)
        lasts = longer_kernel(up / time + 0.5 * gravity * time, size, gravity)
        pushes = pushed * lasts
        wanted[0], wanted[2] = (x - pushes * velocity[0]) / (pushes + time + TRAILS), (z - pushes * velocity[2]) / (pushes + time + TRAILS)
        sent_kernel(size, tip, there, velocity, foot, wanted, floor, gravity, time, lasts, out)
        along, aside = _parts(wanted[0], wanted[2], goes, pace)
        ahead, beside = _parts(out[0] - wanted[0], out[1] - wanted[2], goes, pace)
        sends = LEAVES[0 if now else 1] <= along <= LEAVES[2] and aside <= ASIDE[0 if now else 1] and abs(ahead) <= MISSES[0]
        if sends and (not now or beside <= MISSES[1]):
            best = min(best, abs(along - 1.0))
    return best


@kernel
def _parts(x, z, goes, pace):
    """How much of a velocity x, z is along a way that is gone so fast (3,) [m/s], and beside it, over its pace."""
    along = (x * goes[0] + z * goes[2]) / pace**2
    return along, math.hypot(x - along * goes[0], z - along * goes[2]) / pace


def moments(physique: Physique, start: Start, goes: np.ndarray, place: np.ndarray, floor: float, gravity: float, finds: Callable[[np.ndarray], bool], steep: float = 0.0, hands: bool = False,
            turns: float = 0.0) -> tuple[bool, bool]:
    """Whether somebody who walks so fast (3,) [m/s] is in the best moment to leap off the foot that stands to a place (3,), and whether a better one is to come, off this foot or off one of the
    next. finds: whether a foot finds floor at a place (3,). steep: how the floor rises on his way [m/m]. hands: whether hands wait for it. turns: how fast he turns [rad/s]: to the place, he has turned farther by the
    next steps."""
    assert start.single is not None
    size, pace = physique.size, max(float(np.linalg.norm(goes)), 1e-9)
    way, foot = goes / pace, start.feet[start.single, :3]
    past = float((start.centre - foot) @ way)

    def planted(feet: np.ndarray) -> Stands:
        """How he stands now, on feet (2, 5)."""
        assert start.single is not None
        return Stands(start.centre, start.velocity, feet, start.single)

    def to_come() -> Iterator[tuple[float, float]]:
        """The least change of moments to come, and by how much less it may be: from where he is now off this foot, and then off each of the next ones."""
        def passing(stands: Stands, way: np.ndarray, past: float, floor: float) -> float:
            return changes(physique, stands, pace * way, place, floor, gravity, np.arange(0.0, UNTIL * size - past, EACH))
        settled = start.planted(floor, physique.tables)
        yield passing(_gone(planted(settled), EACH * way), way, past + EACH, floor), AS_GOOD[0]
        other, stride, lands, ahead = planted(start.feet), STRIDE[0] * size + STRIDE[1] * pace * math.sqrt(size), LANDS * size, way
        for number in range(1, FEET + 1):
            step = _turned(other, ahead, place, turns * stride / pace)
            there = other.feet[other.single, :3]
            other, ahead = _round(other, step, there), yaw(step) @ ahead
            if not finds(there + stride * ahead):
                return
            other = _stepped(_gone(other, (lands - past) * ahead) if number == 1 else other, stride, ahead)
            yield passing(other, ahead, lands, floor + number * stride * steep), AS_GOOD[1][hands]
    now, better = changes(physique, planted(start.planted(floor, physique.tables)), goes, place, floor, gravity), False
    good = now < math.inf
    for least, less in to_come():
        better, good = better or least < math.inf, good and now <= least + less
        if better and not good:  # more would say no more
            break
    return good, better


def _stepped(stands: Stands, far: float, way: np.ndarray) -> Stands:
    """The same a step so far [m] on along a way (3,), over the other foot."""
    feet, single = stands.feet.copy(), stands.single
    left = np.array([way[2], 0.0, -way[0]])
    feet[1 - single, :3] = feet[single, :3] + far * way + 2.0 * float((stands.centre - feet[single, :3]) @ left) * left
    feet[1 - single, 3:] = feet[single, 3:]
    return Stands(stands.centre + far * way, stands.velocity - 2.0 * float(stands.velocity @ left) * left, feet, 1 - single)


def _turned(stands: Stands, way: np.ndarray, place: np.ndarray, turn: float) -> float:
    """How far [rad] somebody turns in a step who goes a way (3,) and turns so far in one: no farther than to a place (3,), and not away from it."""
    to = (place - stands.centre) * FLAT
    left = math.atan2(float(to @ [way[2], 0.0, -way[0]]), float(to @ way))
    return max(min(turn, left), 0.0) if left > 0.0 else min(max(turn, left), 0.0)


def _round(stands: Stands, turn: float, about: np.ndarray) -> Stands:
    """The same turned [rad] about a place (3,)."""
    if not turn:
        return stands
    turned, feet = yaw(turn), stands.feet.copy()
    feet[:, :3] = about + (feet[:, :3] - about) @ turned.T
    feet[:, 3] += turn
    return Stands(about + turned @ (stands.centre - about), turned @ stands.velocity, feet, stands.single)


def _gone(stands: Stands, way: np.ndarray) -> Stands:
    """The same a way (3,) [m] on."""
    return stands._replace(centre=stands.centre + way)
