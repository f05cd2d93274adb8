"""A jumper's body as masses: centre of mass and momenta, compiled for the loops of a plan."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from numbers import Real
from typing import Literal, NamedTuple

import numpy as np

from ...body import (STATURE, Anatomy, Skeleton, anatomy, contact_height, exp_kernel, heel_offset, human, log_kernel,
                     product_kernel)
from ...compiled import kernel

GRAVITY = np.array([0.0, -9.81, 0.0])
"""On Earth [m/s²]."""
MASS = 73.0
"""An adult's [kg], of standard height."""


@dataclass(frozen=True)
class Physique:
    """Whose body jumps: mass [kg], height [m], strength and flexibility as shares of an adult's, sex.

    mass: by default None, for as much as an adult of that height, see `mass_of`. It is a number from then on, which `dataclasses.replace` keeps, whatever the
    height becomes: `replace(physique, height=1.2, mass=None)` is built as an adult again. Strength counts per kilogram: 1 is an adult who jumps 0.4 m high.
    ValueError for values that no body has.
    """

    mass: float = None  # pyright: ignore[reportAssignmentType]  # a number once it is made
    height: float = STATURE
    strength: float = 1.0
    flexibility: float = 1.0
    sex: Literal["male", "female"] = "male"

    def __post_init__(self):
        for name, low, high in (("height", 0.5, 3.0), ("mass", 1.0, 400.0), ("strength", 0.05, 20.0),
                                ("flexibility", 0.3, 2.0)):
            value = getattr(self, name)
            if name == "mass" and value is None:
                value = mass_of(self.height)
            # typeshed's Real is only compared with its like, which it has no float for
            if (isinstance(value, bool) or not isinstance(value, Real)
                    or not low <= value <= high):  # pyright: ignore[reportOperatorIssue]
                raise ValueError(f"{name} must be a number within {low:g} … {high:g}, got {value!r}")
            object.__setattr__(self, name, float(value))  # kernels are compiled anew for other kinds of numbers
        if self.sex not in ("male", "female"):
            raise ValueError(f"sex must be male or female, got {self.sex!r}")

    @property
    def size(self) -> float:
        """Its height over an adult's: what lengths told at standard height are multiplied by."""
        return self.height / STATURE

    @cached_property
    def skeleton(self) -> Skeleton:
        """The standard human at this height."""
        return human(self.height)

    @cached_property
    def anatomy(self) -> Anatomy:
        """Its masses (de Leva 1996)."""
        return anatomy(self.skeleton, self.mass, self.sex)

    @cached_property
    def tables(self) -> BodyTables:
        """The same for compiled loops."""
        skeleton, masses = self.skeleton, self.anatomy
        hip = np.array([skeleton.index("LeftUpLeg"), skeleton.index("RightUpLeg")])
        offsets = skeleton.offsets
        return BodyTables(
            skeleton.parents, offsets, masses.joints, masses.masses, masses.centres, masses.inertias, float(self.mass),
            hip, -offsets[hip[0] + 1, 1], -offsets[hip[0] + 2, 1], offsets[hip[0] + 3], heel_offset(skeleton),
            skeleton.end_offsets[skeleton.end_index["LeftToe"]], contact_height(skeleton), float(self.size))


def mass_of(height: float) -> float:
    """How heavy [kg] somebody so tall [m] is who is built as an adult: by the cube of the height."""
    return MASS * (height / STATURE) ** 3


class BodyTables(NamedTuple):
    """A body for compiled loops. Joints of a leg follow each other: hip, knee, ankle, ball.

    parents, offsets: of the skeleton. joint, mass, centre, inertia: of the segments. hip: (2,)
    numbers of the hip joints. thigh, shank: [m]. toe, heel: ball and heel in the foot's frame.
    tip: the toes' end in the toe's frame. sole: how high balls and heels stand [m]. size: as in `Physique`.
    """

    parents: np.ndarray
    offsets: np.ndarray
    joint: np.ndarray
    mass: np.ndarray
    centre: np.ndarray
    inertia: np.ndarray
    total: float
    hip: np.ndarray
    thigh: float
    shank: float
    toe: np.ndarray
    heel: np.ndarray
    tip: np.ndarray
    sole: float
    size: float


@kernel
def place_kernel(body, root, local, positions, orientations):
    """Forward kinematics of one body: positions (J, 3), orientations (J, 3, 3)."""
    for j in range(local.shape[0]):
        p = body.parents[j]
        if p < 0:
            positions[j] = root
            orientations[j] = local[j]
            continue
        for i in range(3):
            a, b, c = orientations[p, i, 0], orientations[p, i, 1], orientations[p, i, 2]
            positions[j, i] = positions[p, i] + a * body.offsets[j, 0] + b * body.offsets[j, 1] + c * body.offsets[j, 2]
            for k in range(3):
                orientations[j, i, k] = a * local[j, 0, k] + b * local[j, 1, k] + c * local[j, 2, k]


@kernel
def centre_kernel(body, positions, orientations, out):
    """Write the whole body's centre of mass (3,) [m]."""
    out[:] = 0.0
    for s in range(len(body.mass)):
        j = body.joint[s]
        for i in range(3):
            at = positions[j, i]
            for k in range(3):
                at += orientations[j, i, k] * body.centre[s, k]
            out[i] += body.mass[s] / body.total * at


@kernel
def parts_kernel(body, positions, orientations, centre, places, turned):
    """Write the whole body's centre of mass (3,) and, seen from there, each segment's (S, 3) [m]; and how the segments are
    turned (S, 3, 3)."""
    centre_kernel(body, positions, orientations, centre)
    for s in range(len(body.mass)):
        j = body.joint[s]
        turned[s] = orientations[j]
        for i in range(3):
            at = positions[j, i] - centre[i]
            for k in range(3):
                at += orientations[j, i, k] * body.centre[s, k]
            places[s, i] = at


@kernel
def momentum_kernel(body, before, turned_before, after, turned_after, dt, angular, inertia):
    """Angular momentum (3,) [kg m²/s] about the centre of mass over the step between two placements of the segments
    (S, 3), (S, 3, 3) as in `parts_kernel`, and the whole body's inertia (3, 3) [kg m²] about it in the middle of the step.

    Each segment's mean velocity and mean angular velocity over the step count, so that a motion
    whose steps conserve this conserves it to rounding, however long the steps are.
    """
    angular[:] = 0.0
    inertia[:] = 0.0
    mean, rate, turn, middle = np.empty(3), np.empty(3), np.empty((3, 3)), np.empty((3, 3))
    for s in range(len(body.mass)):
        m = body.mass[s]
        for i in range(3):
            mean[i], rate[i] = 0.5 * (before[s, i] + after[s, i]), (after[s, i] - before[s, i]) / dt
        angular[0] += m * (mean[1] * rate[2] - mean[2] * rate[1])
        angular[1] += m * (mean[2] * rate[0] - mean[0] * rate[2])
        angular[2] += m * (mean[0] * rate[1] - mean[1] * rate[0])
        square = mean[0] ** 2 + mean[1] ** 2 + mean[2] ** 2
        for i in range(3):
            inertia[i, i] += m * square
            for k in range(3):
                inertia[i, k] -= m * mean[i] * mean[k]
                turn[i, k] = 0.0
                middle[i, k] = 0.5 * (turned_before[s, i, k] + turned_after[s, i, k])
                for n in range(3):
                    turn[i, k] += turned_after[s, i, n] * turned_before[s, k, n]
        log_kernel(turn, rate)
        # the segment's own inertia, turned into the world: R I Rᵀ
        product_kernel(middle, body.inertia[s], turn)
        for i in range(3):
            for k in range(3):
                own = turn[i, 0] * middle[k, 0] + turn[i, 1] * middle[k, 1] + turn[i, 2] * middle[k, 2]
                inertia[i, k] += own
                angular[i] += own * rate[k] / dt


def turns(vectors: np.ndarray) -> np.ndarray:
    """Rotation matrices (..., 3, 3) of rotation vectors (..., 3) [rad]: scipy's, without its checks."""
    flat = np.ascontiguousarray(vectors, float).reshape(-1, 3)
    out = np.empty((len(flat), 3, 3))
    _turns(flat, out)
    return out.reshape(np.shape(vectors) + (3,))


def vectors(matrices: np.ndarray) -> np.ndarray:
    """Rotation vectors (..., 3) [rad] of rotation matrices (..., 3, 3) by less than half a turn."""
    flat = np.ascontiguousarray(matrices, float).reshape(-1, 3, 3)
    out = np.empty((len(flat), 3))
    _vectors(flat, out)
    return out.reshape(np.shape(matrices)[:-1])


@kernel
def _turns(flat, out):
    for n in range(len(flat)):
        exp_kernel(flat[n, 0], flat[n, 1], flat[n, 2], out[n])


@kernel
def _vectors(flat, out):
    for n in range(len(flat)):
        log_kernel(flat[n], out[n])
