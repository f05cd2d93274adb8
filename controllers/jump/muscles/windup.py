"""The wind-up: how a body crouches until its muscles can give the force and the work that a jump asks for.

Ooi 2015, 3.1.2, mended as docs/glossary.md says: proportional-derivative control moves the hip by
u(i) = k_p E(i−1) + k_d (E(i−1) − E(i−2)), where E is the muscles' error, as metres down, and the
balance error, from the centre of mass to the middle of the support polygon. The legs follow by
cyclic coordinate descent, over planted feet; a heel rises only past the ankle's limit. Then centre
of mass, force and balance are found anew, until both errors are small.

The thesis's muscles err by force alone. But a small crouch may give the force and not for long
enough: what springs hold, ∫ τ dθ over their bends, has to cover ½ m v², and what the thrust
(`extension`) spends on the way, on lifting the body, on turning limbs, and on springs that are not
straight yet. The worse of both errors, as a share of what is needed, is the muscles' error.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...compiled import kernel
from ..body import (DEEP, GRAVITY, Physique, centre_kernel, flat_feet, frame, pose_kernel, stand_pelvis_kernel,
                    support_kernel)
from .spring_muscles import Arm, Muscle, Reading, force_kernel, muscle
from .strength import LEAST, between_kernel, held_kernel, squared_kernel, strength, upward

class Gains(NamedTuple):
    """The constants of the control (thesis, table 3.1).

    proportional, derivative: k_p, k_d; one step is a gain near 1 of the error, so
    0 < k_p and k_p + 2 k_d < 2 keep it stable. drop: by how many metres, at standard height, a
    muscles' error of 1 (all of it lacking) asks the hip to go down
    (faster, and heels rise before the balance is found).
    balance: w_b. muscle_error: ε as a share of force or work; balance_error: ε [m]. longest: of a step
    [m]. most: iterations.
    """

    proportional: float = 0.3
    derivative: float = 0.1
    drop: float = 0.6
    balance: float = 2.5
    muscle_error: float = 0.005
    balance_error: float = 0.01
    longest: float = 0.02
    most: int = 200


GAINS = Gains()


@dataclass(frozen=True, eq=False)
class History:
    """A wind-up, iteration by iteration, N of them. pelvis, centre: (N, 3) [m]. force, required: (N,)
    magnitudes [N]. work, needed: (N,) [J] that the springs hold, and that the jump takes. balance: (N,) [m] from the polygon's middle. margin: (N,) [m] inside the polygon."""

    pelvis: np.ndarray
    centre: np.ndarray
    force: np.ndarray
    required: np.ndarray
    work: np.ndarray
    needed: np.ndarray
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
    ground, by the muscles and for the jump. spring: the muscles'. margin: [m] inside the support polygon.
    converged: whether the muscles can give what is required: if not, this body can't make the jump.
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
    spring: Muscle
    margin: float
    history: History
    converged: bool

    @property
    def iterations(self) -> int:
        """How many times the hip was moved."""
        return len(self.history) - 1


def crouch(physique: Physique, velocity, rise: float, gravity=GRAVITY, *, feet: np.ndarray | None = None,
           gains: Gains = GAINS, reading: Reading = "wedge", arm: Arm = "constant") -> Crouch:
    """Wind up for a take-off with `velocity` [m/s], (3,) or upward.

    rise: [m] how far above standing the centre of mass leaves the floor: the push covers that and
    the crouch's depth d, at a mean acceleration of v v_y / 2d; F_req = m (a − g). gravity: (3,) or
    downward [m/s²]. feet: (2, 6) or (2, 5) where they stand, as in `posture`, flat_feet by default.
    ValueError for numbers that are not finite, other feet or an unknown reading.
    """
    velocity, gravity = upward(velocity, 1.0), upward(gravity, -1.0)
    if not (np.isfinite(velocity).all() and np.isfinite(gravity).all() and math.isfinite(rise)):
        raise ValueError(f"velocity, rise and gravity must be finite, got {velocity}, {rise}, {gravity}")
    feet, able = planted(physique, feet), strength(physique, reading, arm, -float(gravity[1]))
    fixed, count, spring = frame(physique), len(physique.skeleton), muscle(physique, reading, arm)
    pelvis, turns = np.empty(3), np.zeros((2, 3, 3))
    local = np.tile(np.eye(3), (count, 1, 1))
    positions, orientations = np.empty((count, 3)), np.empty((count, 3, 3))
    bends, torques, forces = np.empty((2, 3)), np.empty((2, 3)), np.empty((2, 3))
    required, history = np.empty(3), np.empty((gains.most + 1, 12))
    standing = stand_pelvis_kernel(fixed, feet, pelvis, turns, local, positions, orientations)
    used, converged = windup_kernel(fixed, spring, gains, velocity, float(rise), gravity, able.depth, able.spent, standing, feet,
                                    pelvis, turns, local, positions, orientations, bends, torques, forces, required, history)
    record = history[:used]
    return Crouch(pelvis, record[-1, 3:6].copy(), float(standing - record[-1, 4]), local, feet, bends.ravel(),
                  torques.ravel(), forces.sum(0), required, spring, float(record[-1, 11]),
                  History(record[:, :3], record[:, 3:6], *record.T[6:]), bool(converged))


def planted(physique: Physique, feet: np.ndarray | None) -> np.ndarray:
    """Feet (2, 6) of our own from (2, 5), (2, 6) or nothing, which is `flat_feet`. ValueError for any other."""
    feet = np.array(flat_feet(physique) if feet is None else feet, float)
    if feet.shape == (2, 5):
        feet = np.column_stack([feet, np.ones(2)])
    if feet.shape != (2, 6) or not np.isfinite(feet).all():
        raise ValueError(f"feet must be (2, 6) or (2, 5) and finite, got {feet.shape}")
    return feet


@kernel
def windup_kernel(fixed, spring, gains, velocity, rise, gravity, depths, spent, standing, feet, pelvis, turns, local,
                  positions, orientations, bends, torques, forces, required, history):
    """Wind a standing body up; see `crouch`. depths, spent: (N,) of its `Strength`. standing: [m] its centre of
    mass's height, `pelvis` (3,) its pelvis. history: (most + 1, 12) rows of pelvis, centre, force, required, work,
    needed, balance, margin.

    Returns how many rows there are, and whether both errors became small.
    """
    body = fixed.body
    top = pelvis[1]
    size = fixed.deep / DEEP
    centre, middle = np.empty(3), np.empty(2)
    error, before, step = np.zeros(3), np.zeros(3), np.empty(3)
    safe, leeway = pelvis.copy(), gains.longest
    floor = -math.inf  # below this the joints do not go
    kinetic = 0.5 * body.total * squared_kernel(velocity)
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
        force = force_kernel(body, spring, feet, centre, positions, orientations, bends, torques, forces)
        push = max(standing - centre[1] + rise, 0.02 * size)
        strong = 0.0
        for i in range(3):
            required[i] = body.total * (velocity[i] * velocity[1] / (2.0 * push) - gravity[i])
            strong += required[i] ** 2
        strong = math.sqrt(strong)
        work, needed = held_kernel(bends, spring), kinetic + between_kernel(depths, spent, standing - centre[1])
        lacking = 0.0
        if strong > 0.0 and needed > 0.0:
            lacking = max((strong - force) / strong, (needed - work) / needed)
        error[0], error[2] = gains.balance * (middle[0] - centre[0]), gains.balance * (middle[1] - centre[2])
        error[1] = -gains.drop * size * lacking
        row = history[rows]
        row[0:3], row[3:6] = pelvis, centre
        row[6], row[7], row[8], row[9] = force, strong, work, needed
        row[10], row[11] = math.hypot(middle[0] - centre[0], middle[1] - centre[2]), margin
        rows += 1
        least = abs(top - LEAST * size - pelvis[1]) < 1e-6  # the smallest crouch may be more than enough
        if row[10] < gains.balance_error and (abs(lacking) < gains.muscle_error or (least and lacking <= 0.0)):
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
