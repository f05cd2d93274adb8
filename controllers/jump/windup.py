"""The wind-up: how a body crouches until its muscles can give the force that a jump asks for.

Ooi 2015, 3.1.2, read as in READINGS A2: proportional-derivative control moves the hip by
u(i) = k_p E(i−1) + k_d (E(i−1) − E(i−2)), where E is the force error, as metres down, and the
balance error, from the centre of mass to the middle of the support polygon. The legs follow by
cyclic coordinate descent, over planted feet; a heel rises only past the ankle's limit. Then centre
of mass, force and balance are found anew, until both errors are small.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ..body.human import STATURE
from ..compiled import kernel
from .dynamics import GRAVITY, Physique, centre_kernel
from .muscles import Reading
from .poise import DEEP, flat_feet, force_kernel, frame, pose_kernel, stand_pelvis_kernel, support_kernel

LEAST = 0.06
"""The least a pelvis goes down for a jump [m], at standard height."""


class Gains(NamedTuple):
    """The constants of the control (thesis, table 3.1).

    proportional, derivative: k_p, k_d; one step is a gain near 1 of the error, so
    0 < k_p and k_p + 2 k_d < 2 keep it stable. drop: by how many metres, at standard height, a
    force error of 1 (all of it lacking) asks the hip to go down (0.2 takes twice the iterations).
    balance: w_b. force_error: ε as a share of the force; balance_error: ε [m]. longest: of a step
    [m]. most: iterations.
    """

    proportional: float = 0.3
    derivative: float = 0.1
    drop: float = 0.6
    balance: float = 2.5
    force_error: float = 0.01
    balance_error: float = 0.01
    longest: float = 0.02
    most: int = 200


GAINS = Gains()


@dataclass(frozen=True, eq=False)
class History:
    """A wind-up, iteration by iteration, N of them. pelvis, centre: (N, 3) [m]. force, required: (N,)
    magnitudes [N]. balance: (N,) [m] from the polygon's middle. margin: (N,) [m] inside the polygon."""

    pelvis: np.ndarray
    centre: np.ndarray
    force: np.ndarray
    required: np.ndarray
    balance: np.ndarray
    margin: np.ndarray

    def __len__(self) -> int:
        return len(self.force)


@dataclass(frozen=True, eq=False)
class Crouch:
    """Where a wind-up ends.

    pelvis, centre: (3,) [m] hips and centre of mass. depth: [m] of the centre of mass below
    standing. rotations: (J, 3, 3) the pose. feet: (2, 6) as in `posture`, heels risen if they had
    to. bends, torques: (6,) [rad, N m] see `muscles.MUSCLES`. force, required: (3,) [N] of the
    ground, by the muscles and for the jump. margin: [m] inside the support polygon. converged:
    whether the muscles can give what is required: if not, this body can't make the jump.
    """

    pelvis: np.ndarray
    centre: np.ndarray
    depth: float
    rotations: np.ndarray
    feet: np.ndarray
    bends: np.ndarray
    torques: np.ndarray
    force: np.ndarray
    required: np.ndarray
    margin: float
    history: History
    converged: bool

    @property
    def iterations(self) -> int:
        """How many times the hip was moved."""
        return len(self.history) - 1


def crouch(physique: Physique, velocity, rise: float, gravity=GRAVITY, *, feet: np.ndarray | None = None,
           gains: Gains = GAINS, reading: Reading = "wedge") -> Crouch:
    """Wind up for a take-off with `velocity` [m/s], (3,) or upward.

    rise: [m] how far above standing the centre of mass leaves the floor: the push covers that and
    the crouch's depth d, at a mean acceleration of v v_y / 2d; F_req = m (a − g). gravity: (3,) or
    downward [m/s²]. feet: (2, 6) where they stand, flat_feet by default.
    ValueError for numbers that are not finite or feet that are no (2, 6).
    """
    velocity, gravity = upward(velocity, 1.0), upward(gravity, -1.0)
    feet = np.array(flat_feet(physique) if feet is None else feet, float)
    if not (np.isfinite(velocity).all() and np.isfinite(gravity).all() and math.isfinite(rise)):
        raise ValueError(f"velocity, rise and gravity must be finite, got {velocity}, {rise}, {gravity}")
    if feet.shape != (2, 6) or not np.isfinite(feet).all():
        raise ValueError(f"feet must be (2, 6) and finite, got {feet.shape}")
    fixed, count = frame(physique, reading), len(physique.skeleton)
    pelvis, turns = np.empty(3), np.zeros((2, 3, 3))
    local = np.tile(np.eye(3), (count, 1, 1))
    positions, orientations = np.empty((count, 3)), np.empty((count, 3, 3))
    bends, torques, forces = np.empty((2, 3)), np.empty((2, 3)), np.empty((2, 3))
    required, history = np.empty(3), np.empty((gains.most + 1, 10))
    standing = stand_pelvis_kernel(fixed, feet, pelvis, turns, local, positions, orientations)
    used, converged = windup_kernel(fixed, gains, velocity, float(rise), gravity, standing, feet, pelvis, turns, local,
                                    positions, orientations, bends, torques, forces, required, history)
    record = history[:used]
    return Crouch(pelvis, record[-1, 3:6].copy(), float(standing - record[-1, 4]), local, feet, bends.ravel(),
                  torques.ravel(), forces.sum(0), required, float(record[-1, 9]),
                  History(record[:, :3], record[:, 3:6], record[:, 6], record[:, 7], record[:, 8], record[:, 9]),
                  bool(converged))


class Strength(NamedTuple):
    """What a body's muscles can do. depth: (N,) [m] of the centre of mass below standing, from hardly
    bent to as deep as its joints go. force: (N,) [N] the ground force there."""

    depth: np.ndarray
    force: np.ndarray


@lru_cache(maxsize=64)
def strength(physique: Physique, reading: Reading = "wedge") -> Strength:
    """The ground force that a body gives, by how deep it crouches, balanced over flat feet."""
    fixed, count, feet = frame(physique, reading), len(physique.skeleton), flat_feet(physique)
    depth, force = np.empty(120), np.empty(120)
    found = strength_kernel(fixed, feet, np.tile(np.eye(3), (count, 1, 1)), np.empty((count, 3)),
                            np.empty((count, 3, 3)), 0.01 * physique.height / STATURE, depth, force)
    return Strength(depth[:found], force[:found])


def crouch_depth(physique: Physique, velocity, rise: float, gravity=GRAVITY) -> float:
    """How deep [m] `crouch` will end, told from the body's `strength` in a few microseconds.

    velocity, rise, gravity: as in `crouch`. NaN where the body is too weak for that take-off.
    """
    able, velocity, gravity = strength(physique), upward(velocity, 1.0), upward(gravity, -1.0)
    way = np.maximum(able.depth + rise, 0.02 * physique.height / STATURE)[:, None]
    required = physique.mass * np.linalg.norm(velocity * velocity[1] / (2.0 * way) - gravity, axis=-1)
    spare = able.force - required
    enough = np.flatnonzero(spare >= 0.0)
    if not len(enough):
        return math.nan
    n = int(enough[0])
    if n == 0:
        return float(able.depth[0])
    part = spare[n - 1] / (spare[n - 1] - spare[n])
    return float(able.depth[n - 1] + part * (able.depth[n] - able.depth[n - 1]))


def strongest(physique: Physique, rise: float, gravity=GRAVITY) -> float:
    """The greatest upward take-off speed [m/s] of a body: v² = 2 d (F / m − g), at its best depth.

    rise, gravity: as in `crouch`. 0 for a body that can't rise against its own weight.
    """
    able, g = strength(physique), -float(upward(gravity, -1.0)[1])
    square = 2.0 * (able.depth + rise) * (able.force / physique.mass - g)
    return float(np.sqrt(max(square.max(initial=0.0), 0.0)))


def upward(value, sign: float) -> np.ndarray:
    """A vector (3,) as it is; a number as that much upward (`sign` 1) or downward (−1)."""
    value = np.asarray(value, float)
    return np.array([0.0, sign * float(value), 0.0]) if value.ndim == 0 else value


@kernel
def windup_kernel(fixed, gains, velocity, rise, gravity, standing, feet, pelvis, turns, local, positions,
                  orientations, bends, torques, forces, required, history):
    """Wind a standing body up; see `crouch`. standing: [m] its centre of mass's height, `pelvis` (3,) its
    pelvis. history: (most + 1, 10) rows of pelvis, centre, force, required, balance, margin.

    Returns how many rows there are, and whether both errors became small.
    """
    body = fixed.body
    top = pelvis[1]
    size = fixed.deep / DEEP
    centre, middle = np.empty(3), np.empty(2)
    error, before, step = np.zeros(3), np.zeros(3), np.empty(3)
    safe, leeway = pelvis.copy(), gains.longest
    floor = -math.inf  # below this the joints do not go
    rows, converged = 0, False
    for iteration in range(gains.most + 1):
        gap = pose_kernel(fixed, pelvis, top, feet, turns, local, positions, orientations)
        if gap > 2e-3:  # not a pose of this body: stay, and come no nearer than half as far
            floor = max(floor, 0.5 * (pelvis[1] + safe[1]))
            pelvis[:] = safe
            pose_kernel(fixed, pelvis, top, feet, turns, local, positions, orientations)
            leeway *= 0.5
        else:
            safe[:] = pelvis
        centre_kernel(body, positions, orientations, centre)
        margin = support_kernel(body, feet, centre, middle)
        force = force_kernel(fixed, feet, centre, positions, orientations, bends, torques, forces)
        push = max(standing - centre[1] + rise, 0.02 * size)
        needed = 0.0
        for i in range(3):
            required[i] = body.total * (velocity[i] * velocity[1] / (2.0 * push) - gravity[i])
            needed += required[i] ** 2
        needed = math.sqrt(needed)
        lacking = (needed - force) / needed if needed > 0.0 else 0.0
        error[0], error[2] = gains.balance * (middle[0] - centre[0]), gains.balance * (middle[1] - centre[2])
        error[1] = -gains.drop * size * lacking
        row = history[rows]
        row[0:3], row[3:6] = pelvis, centre
        row[6], row[7] = force, needed
        row[8], row[9] = math.hypot(middle[0] - centre[0], middle[1] - centre[2]), margin
        rows += 1
        least = abs(top - LEAST * size - pelvis[1]) < 1e-6  # the smallest crouch may be more than enough
        if row[8] < gains.balance_error and (abs(lacking) < gains.force_error or (least and lacking <= 0.0)):
            converged = True
            break
        if leeway < 5e-4 or (iteration > 1 and row[0] == history[rows - 2, 0] and row[1] == history[rows - 2, 1]
                             and row[2] == history[rows - 2, 2]):
            break  # its joints go no further
        for i in range(3):
            step[i] = gains.proportional * error[i]
            if iteration > 0:
                step[i] += gains.derivative * (error[i] - before[i])
            before[i] = error[i]
        step[1] = max(min(step[1], max(top - LEAST * size - pelvis[1], -leeway)), floor - pelvis[1])
        length = math.sqrt(step[0] ** 2 + step[1] ** 2 + step[2] ** 2)
        scale = min(1.0, leeway / length) if length > 0.0 else 0.0
        for i in range(3):
            pelvis[i] += scale * step[i]
    return rows, converged


@kernel
def strength_kernel(fixed, feet, local, positions, orientations, step, depth, force):
    """Write depth and force (N,) as the pelvis goes down by `step` [m]; returns how many were possible."""
    pelvis, turns = np.empty(3), np.zeros((2, 3, 3))
    centre, middle = np.empty(3), np.empty(2)
    bends, torques, forces = np.empty((2, 3)), np.empty((2, 3)), np.empty((2, 3))
    standing = stand_pelvis_kernel(fixed, feet, pelvis, turns, local, positions, orientations)
    top, found = pelvis[1], 0
    for n in range(len(depth)):
        pelvis[1] = top - LEAST * fixed.deep / DEEP - n * step
        balanced = False
        for _ in range(20):
            if pose_kernel(fixed, pelvis, top, feet, turns, local, positions, orientations) > 2e-3:
                break
            centre_kernel(fixed.body, positions, orientations, centre)
            support_kernel(fixed.body, feet, centre, middle)
            balanced = math.hypot(middle[0] - centre[0], middle[1] - centre[2]) < 2e-3
            if balanced:
                break
            pelvis[0] += middle[0] - centre[0]
            pelvis[2] += middle[1] - centre[2]
        if not balanced:
            break
        depth[n] = standing - centre[1]
        force[n] = force_kernel(fixed, feet, centre, positions, orientations, bends, torques, forces)
        found += 1
    return found
