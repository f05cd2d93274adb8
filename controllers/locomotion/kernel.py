"""The hot path, compiled: locate a query, weigh primitives, sum their series, pose the body.

Everything here is scalar code for one character, called in a loop over characters. Arrays are
float32, laid out so that the compiler vectorises: the columns of a series are all joints' x, then
y, then z components (padded to 24 joints), then hips, labels and duration: 80 columns in all.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from ..body.human import HEEL, human
from .control_space import EDGES, INSIDE, SCALE, ControlSpace
from .library import HIPS, Library

LANES = 24
"""Joints, padded so that each component fills whole vector registers."""
HIPS_AT, LABELS_AT, DURATION_AT, COLUMNS = 3 * LANES, 3 * LANES + 3, 3 * LANES + 7, 3 * LANES + 8
ACTIVE = np.float32(5e-4)
"""Weights below this are dropped: half a thousandth of a pose can't be seen."""


class Body(NamedTuple):
    """The skeleton as the kernels need it, float32. heel: (3,) in the foot's frame [m]."""

    parents: np.ndarray
    offsets: np.ndarray
    reference: np.ndarray
    heel: np.ndarray
    toe_end: np.ndarray


class Space(NamedTuple):
    """A control space as the kernels need it. vertices: (S, 4) numbers of primitives in the library."""

    vertices: np.ndarray
    neighbours: np.ndarray
    transform: np.ndarray
    hull: np.ndarray
    room: np.ndarray
    anchor: np.ndarray
    bend: np.ndarray


def body_tables(library: Library) -> Body:
    """The kernel's view of a library's skeleton."""
    skeleton = library.skeleton
    scale = skeleton.offsets[0, 1] / human().offsets[0, 1]
    toe = skeleton.end_offsets[skeleton.end_index["LeftToe"]]
    return Body(skeleton.parents.astype(np.int64), skeleton.offsets.astype(np.float32),
                library.reference.astype(np.float32), (HEEL * scale).astype(np.float32),
                toe.astype(np.float32))


def space_tables(space: ControlSpace, members: np.ndarray) -> Space:
    """The kernel's view of a control space over the library's primitives `members` (Q,)."""
    origin = space.anchor / SCALE
    room = -(space.hull[:, :3] @ origin + space.hull[:, 3])
    return Space(*(np.ascontiguousarray(a) for a in (
        members[space.simplices].astype(np.int64), space.neighbours, space.transform,
        space.hull[:, :3].copy(), room, origin, space.bend)))


def series_table(library: Library) -> np.ndarray:
    """The library's coefficients (P, 2N + 1, 80), float32, in the kernel's columns."""
    joints = len(library.skeleton)
    count, rows = library.coefficients.shape[:2]
    table = np.zeros((count, rows, COLUMNS), np.float32)
    chart = library.coefficients[..., :HIPS].reshape(count, rows, joints, 3)
    for axis in range(3):
        table[..., axis * LANES:axis * LANES + joints] = chart[..., axis]
    table[..., HIPS_AT:] = library.coefficients[..., HIPS:]
    return table


@njit(cache=True)
def clamp_kernel(space, v, out):
    """Write into `out` (3,) the scaled velocity `v` (3,), moved towards the anchor until inside."""
    reach = 1.0
    for h in range(space.room.shape[0]):
        along = 0.0
        for i in range(3):
            along += space.hull[h, i] * (v[i] - space.anchor[i])
        if along > reach * space.room[h] * INSIDE:
            reach = along / (space.room[h] * INSIDE)
    for i in range(3):
        out[i] = space.anchor[i] + (v[i] - space.anchor[i]) / reach


@njit(cache=True)
def locate_kernel(space, p, start, b):
    """The simplex around the scaled point `p` (3,), its barycentric weights into `b` (4,): eq. (4).

    Walks from simplex `start` across the face opposite to the most negative weight.
    """
    simplex = start
    for _ in range(space.neighbours.shape[0]):
        rest = 1.0
        least, worst = -1e-9, -1
        for i in range(3):
            b[i] = 0.0
            for j in range(3):
                b[i] += space.transform[simplex, i, j] * (p[j] - space.transform[simplex, 3, j])
            rest -= b[i]
        b[3] = rest
        for i in range(4):
            if b[i] < least:
                least, worst = b[i], i
        if worst < 0 or space.neighbours[simplex, worst] < 0:
            break
        simplex = space.neighbours[simplex, worst]
    total = 0.0
    for i in range(4):
        b[i] = max(b[i], 0.0)
        total += b[i]
    for i in range(4):
        b[i] /= total
    return simplex


@njit(cache=True)
def query_kernel(space, velocity, start, correct, b, target, moved):
    """The simplex and weights `b` (4,) whose blend moves at `velocity` (3,) SI.

    `correct` fixed-point steps subtract what the quadratic element says the blend has too much.
    `target`, `moved`: (3,) scratch.
    """
    for i in range(3):
        moved[i] = velocity[i] / SCALE[i]
    clamp_kernel(space, moved, target)
    for i in range(3):
        moved[i] = target[i]
    simplex = locate_kernel(space, moved, start, b)
    for _ in range(correct):
        for i in range(3):
            moved[i] = target[i]
            for e in range(6):
                moved[i] -= 4.0 * b[EDGES[e, 0]] * b[EDGES[e, 1]] * space.bend[simplex, e, i] / SCALE[i]
        clamp_kernel(space, moved, moved)
        simplex = locate_kernel(space, moved, simplex, b)
    return simplex


@njit(cache=True, fastmath=True)
def series_kernel(table, weights, phase, row):
    """Write into `row` (80,) the weighted sum of all primitives' series at `phase`: eq. (5) and (6)."""
    rows = table.shape[1]
    c1, s1 = math.cos(2 * math.pi * phase), math.sin(2 * math.pi * phase)
    for d in range(COLUMNS):
        row[d] = np.float32(0.0)
    for p in range(table.shape[0]):
        w = weights[p]
        if w <= 0.0:
            continue
        c, s = 1.0, 0.0
        for d in range(COLUMNS):
            row[d] += w * table[p, 0, d]
        for k in range(1, rows, 2):  # cos kφ and sin kφ by rotation
            c, s = c * c1 - s * s1, s * c1 + c * s1
            a, b = np.float32(w * c), np.float32(w * s)
            for d in range(COLUMNS):
                row[d] += a * table[p, k, d] + b * table[p, k + 1, d]


@njit(cache=True, fastmath=True)
def pose_kernel(body, row, local, positions, orientations, scratch):
    """Local rotations (J, 3, 3), positions (J, 3) and orientations (J, 3, 3) of a series row.

    In the ground frame. The exponential map's two quotients are their Taylor series in the
    squared angle, exact to float32 below π and free of branches. scratch: (2, LANES).
    """
    one = np.float32(1.0)
    for j in range(LANES):
        x, y, z = row[j], row[LANES + j], row[2 * LANES + j]
        t = x * x + y * y + z * z
        a, b = one, one
        for n in range(9, 0, -1):
            a = one - a * t * np.float32(1.0 / ((2 * n) * (2 * n + 1)))
            b = one - b * t * np.float32(1.0 / ((2 * n + 1) * (2 * n + 2)))
        scratch[0, j] = a
        scratch[1, j] = b * np.float32(0.5)
    for j in range(local.shape[0]):
        x, y, z = row[j], row[LANES + j], row[2 * LANES + j]
        a, b = scratch[0, j], scratch[1, j]
        e00, e01, e02 = one - b * (y * y + z * z), b * x * y - a * z, b * x * z + a * y
        e10, e11, e12 = b * x * y + a * z, one - b * (x * x + z * z), b * y * z - a * x
        e20, e21, e22 = b * x * z - a * y, b * y * z + a * x, one - b * (x * x + y * y)
        for i in range(3):
            r0, r1, r2 = body.reference[j, i, 0], body.reference[j, i, 1], body.reference[j, i, 2]
            local[j, i, 0] = r0 * e00 + r1 * e10 + r2 * e20
            local[j, i, 1] = r0 * e01 + r1 * e11 + r2 * e21
            local[j, i, 2] = r0 * e02 + r1 * e12 + r2 * e22
    for i in range(3):
        positions[0, i] = row[HIPS_AT + i]
        for k in range(3):
            orientations[0, i, k] = local[0, i, k]
    for j in range(1, local.shape[0]):
        joint_kernel(body, j, local, positions, orientations)


@njit(cache=True, fastmath=True, inline="always")
def joint_kernel(body, j, local, positions, orientations):
    """Place joint j from its parent's place and its own local rotation."""
    p = body.parents[j]
    for i in range(3):
        a, b, c = orientations[p, i, 0], orientations[p, i, 1], orientations[p, i, 2]
        positions[j, i] = (positions[p, i] + a * body.offsets[j, 0] + b * body.offsets[j, 1]
                           + c * body.offsets[j, 2])
        for k in range(3):
            orientations[j, i, k] = a * local[j, 0, k] + b * local[j, 1, k] + c * local[j, 2, k]
