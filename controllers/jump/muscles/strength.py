"""What a body's muscles can do, by how deep it crouches: the force that they give, the work that they hold, and how much of
it a thrust (`extension`) makes into speed.

It is found once for a body, in a few milliseconds; where the control loop of `windup` will end follows from it in a few
microseconds.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ...compiled import kernel
from ..body import (DEEP, GRAVITY, Physique, centre_kernel, flat_feet, frame, pose_kernel, stand_pelvis_kernel,
                    support_kernel)
from .chain import CHAIN, COLUMNS, RUNGE_KUTTA, links_kernel, thrust_kernel
from .spring_muscles import Arm, Reading, force_kernel, muscle, work_kernel

LEAST = 0.06
"""The least a pelvis goes down for a jump [m], at standard height."""
DELAYS = np.array([0.0, 0.08, 0.16])
"""By when hip, knee and ankle push with all they have [s]: from the centre of mass outward, half of it 40 ms apart."""
DELAYS.setflags(write=False)
FORWARD = 0.25
"""Which share of a forward speed's energy the springs have to hold. People leave the ground faster in a standing long
jump than straight up: 3 to 4 m/s at 35 to 45 degrees against 2.5 to 2.9. The rest comes from arms that are
thrown forward and from falling ahead of the feet, which a chain balanced over them has not."""
STILL = np.zeros(3)
"""Of who falls nowhere [m/s]."""
STILL.setflags(write=False)
STEP = 1.0 / 240.0
"""Of a thrust, by Runge's and Kutta's method [s]."""


class Strength(NamedTuple):
    """What a body's muscles can do, by how deep it crouches, balanced over flat feet: N ≥ 1 depths, from hardly
    bent to as deep as its joints go.

    depth: (N,) [m] of the centre of mass below standing. force: (N,) [N] the ground force there.
    work: (N,) [J] that the springs hold. speed: (N,) [m/s] upward with which a fully active thrust
    (`extension`) leaves the floor. spent: (N,) [J] of the work, what is not ½ m v² then.
    """

    depth: np.ndarray
    force: np.ndarray
    work: np.ndarray
    speed: np.ndarray
    spent: np.ndarray


def strength(physique: Physique, reading: Reading = "wedge", arm: Arm = "constant", gravity: float = 9.81) -> Strength:
    """What a body's muscles can do under `gravity` [m/s²] downward; found once. A body too stiff to crouch has one depth, 0."""
    return _strength(physique, reading, arm, gravity)  # however it is called


@lru_cache(maxsize=64)
def _strength(physique, reading, arm, gravity):
    fixed, count, feet = frame(physique), len(physique.skeleton), flat_feet(physique)
    table, delays = np.zeros((64, 5)), DELAYS.copy()  # kernels are compiled anew for what is read only
    found = strength_kernel(fixed, muscle(physique, reading, arm), gravity, feet, np.tile(np.eye(3), (count, 1, 1)),
                            np.empty((count, 3)), np.empty((count, 3, 3)), 0.03 * physique.size, delays, table)
    return Strength(*np.ascontiguousarray(table[:found].T))


def crouch_depth(physique: Physique, velocity, rise: float, gravity=GRAVITY, reading: Reading = "wedge",
                 arm: Arm = "constant", passing: np.ndarray = STILL) -> float:
    """How deep [m] `crouch` will end, told from the body's `strength` in a few microseconds.

    velocity, rise, gravity, reading, arm: as in `crouch`. passing: (3,) [m/s] level, with which the body falls ahead as the push begins: no force
    has to give it that. NaN where the body is too weak for that take-off.
    """
    velocity, gravity = upward(velocity, 1.0), upward(gravity, -1.0)
    able = strength(physique, reading, arm, -float(gravity[1]))
    return depth_kernel(able, velocity, velocity - passing, float(rise), gravity, float(physique.mass), 0.02 * physique.size)


def strongest(physique: Physique, rise: float, gravity=GRAVITY, reading: Reading = "wedge", arm: Arm = "constant") -> float:
    """The greatest upward take-off speed [m/s] of a body, at its best depth: by force, v² = 2 d (F / m − g), and by
    its springs' work.

    rise, gravity, reading, arm: as in `crouch`. 0 for a body that can't rise against its own weight.
    """
    g = -float(upward(gravity, -1.0)[1])
    able = strength(physique, reading, arm, g)
    square = 2.0 * np.minimum((able.depth + rise) * (able.force / physique.mass - g), (able.work - able.spent) / physique.mass)
    return float(np.sqrt(max(square.max(), 0.0)))


def upward(value, sign: float) -> np.ndarray:
    """A vector (3,) as it is; a number as that much upward (`sign` 1) or downward (−1)."""
    value = np.asarray(value, float)
    return np.array([0.0, sign * float(value), 0.0]) if value.ndim == 0 else value


@kernel
def depth_kernel(able, velocity, gained, rise, gravity, mass, least):
    """The first depth [m] of a body's `Strength` whose force and work are enough, NaN for none; see `crouch_depth`. gained: (3,) [m/s] of the
    velocity, in the push; least: [m] of the push."""
    kinetic, last = 0.5 * mass * squared_kernel(velocity), 0.0
    for n in range(len(able.depth)):
        way, square = max(able.depth[n] + rise, least), 0.0
        for i in range(3):
            square += (gained[i] * gained[1] / (2.0 * way) - gravity[i]) ** 2
        spare = min(able.force[n] / (mass * math.sqrt(square)), able.work[n] / max(kinetic + able.spent[n], 1e-9)) - 1.0
        if spare >= 0.0:
            if n == 0:
                return able.depth[0]
            return able.depth[n - 1] + last / (last - spare) * (able.depth[n] - able.depth[n - 1])
        last = spare
    return math.nan


@kernel
def squared_kernel(velocity):
    """The square [m²/s²] of a take-off velocity (3,) as far as the springs have to bring it up."""
    return velocity[1] ** 2 + FORWARD * (velocity[0] ** 2 + velocity[2] ** 2)


@kernel
def held_kernel(bends, spring):
    """The work [J] that springs over bends (2, 3) [rad] hold."""
    work = 0.0
    for side in range(2):
        for k in range(3):
            work += work_kernel(bends[side, k], spring)
    return work


@kernel
def between_kernel(depth, values, at):
    """The value of a table (N,) at a depth [m]; beyond its ends, as at its ends."""
    if at <= depth[0]:
        return values[0]
    for n in range(1, len(depth)):
        if at < depth[n]:
            part = (at - depth[n - 1]) / (depth[n] - depth[n - 1])
            return values[n - 1] + part * (values[n] - values[n - 1])
    return values[-1]


@kernel
def strength_kernel(fixed, spring, gravity, feet, local, positions, orientations, step, delays, table):
    """Write depth, force, work, speed and spent (N, 5) of `Strength` as the pelvis goes down by `step` [m], the last
    as deep as it goes; returns how many were possible, standing being one if nothing lower is."""
    pelvis, turns = np.empty(3), np.zeros((2, 3, 3))
    standing = stand_pelvis_kernel(fixed, feet, pelvis, turns, local, positions, orientations)
    top, least, found = pelvis[1], LEAST * fixed.deep / DEEP, 0
    safe, low = pelvis.copy(), 0.0
    for n in range(len(table) - 1):
        low = least + n * step
        pelvis[1] = top - low
        if not _balance(fixed, pelvis, top, feet, turns, local, positions, orientations):
            break
        safe[:] = pelvis
        _strong(fixed, spring, gravity, feet, standing, local, positions, orientations, delays, table[found])
        found += 1
    good, bad = (low - step if found else 0.0), low
    for _ in range(6):  # as deep as its joints go
        pelvis[:] = safe
        pelvis[1] = top - 0.5 * (good + bad)
        if _balance(fixed, pelvis, top, feet, turns, local, positions, orientations):
            good = 0.5 * (good + bad)
            safe[:] = pelvis
        else:
            bad = 0.5 * (good + bad)
    _balance(fixed, safe, top, feet, turns, local, positions, orientations)
    _strong(fixed, spring, gravity, feet, standing, local, positions, orientations, delays, table[found])
    if found and table[found, 0] - table[found - 1, 0] < 1e-3:
        return found  # the row before is as deep
    return found + 1


@kernel
def _balance(fixed, pelvis, top, feet, turns, local, positions, orientations):
    """Move a pelvis (3,) level until the body is balanced; whether it can be."""
    centre, middle = np.empty(3), np.empty(2)
    for _ in range(20):
        if pose_kernel(fixed, pelvis, top, feet, turns, local, positions, orientations) > 2e-3:
            return False
        centre_kernel(fixed.body, positions, orientations, centre)
        support_kernel(fixed.body, feet, centre, middle)
        if math.hypot(middle[0] - centre[0], middle[1] - centre[2]) < 2e-3:
            return True
        pelvis[0] += middle[0] - centre[0]
        pelvis[2] += middle[1] - centre[2]
    return False


@kernel
def _strong(fixed, spring, gravity, feet, standing, local, positions, orientations, delays, row):
    """Write depth, force, work, speed and spent (5,) of a body as it is placed."""
    body, centre = fixed.body, np.empty(3)
    bends, torques, forces, rows = np.empty((2, 3)), np.empty((2, 3)), np.empty((2, 3)), np.empty((1, COLUMNS))
    centre_kernel(body, positions, orientations, centre)
    row[0] = standing - centre[1]
    row[1] = force_kernel(body, spring, feet, centre, positions, orientations, bends, torques, forces)
    row[2] = held_kernel(bends, spring)
    links = links_kernel(body, feet, positions, orientations, bends)
    thrust_kernel(links, spring, gravity, 1.0, delays, CHAIN, RUNGE_KUTTA, STEP, 360, rows)
    row[3] = max(rows[0, 11], 0.0)
    row[4] = row[2] - 0.5 * body.total * row[3] ** 2
