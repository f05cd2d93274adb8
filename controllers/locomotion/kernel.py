"""The hot path, compiled: locate a query, weigh primitives, sum their series, pose the body.

Everything here is scalar code for one character, called in a loop over characters. Arrays are
float32, laid out so that the compiler vectorises: the columns of a series are all joints' x, then
y, then z components (padded to 24 joints), then hips, labels and duration: 80 columns in all.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..body import heel_offset
from ..compiled import kernel
from .control_space import EDGES, INSIDE, SCALE, ControlSpace
from .library import HIPS, Library

LANES = 24
"""Joints, padded so that each component fills whole vector registers."""
HIPS_AT, LABELS_AT, DURATION_AT, COLUMNS = 3 * LANES, 3 * LANES + 3, 3 * LANES + 7, 3 * LANES + 8
ACTIVE = np.float32(5e-4)
"""Weights below this are dropped: half a thousandth of a pose can't be seen."""


class Body(NamedTuple):
    """The skeleton as the kernels need it, float32.

    reference: (9, LANES) the reference rotations' entries, all joints side by side. heel: (3,) in
    the foot's frame, toe_end: (3,) in the toe's [m].
    """

    parents: np.ndarray
    offsets: np.ndarray
    reference: np.ndarray
    heel: np.ndarray
    toe_end: np.ndarray


class Space(NamedTuple):
    """A control space as the kernels need it, in scaled velocity. vertices: (S, 4) numbers in the library."""

    vertices: np.ndarray
    neighbours: np.ndarray
    transform: np.ndarray
    hull: np.ndarray
    anchor: np.ndarray
    lane: np.ndarray
    straight: np.ndarray
    bend: np.ndarray


def body_tables(library: Library) -> Body:
    """The kernel's view of a library's skeleton."""
    skeleton = library.skeleton
    toe = skeleton.end_offsets[skeleton.end_index["LeftToe"]]
    reference = np.zeros((9, LANES), np.float32)
    reference[:, :len(skeleton)] = library.reference.reshape(-1, 9).T
    return Body(skeleton.parents.astype(np.int64), skeleton.offsets.astype(np.float32), reference,
                heel_offset(skeleton).astype(np.float32), toe.astype(np.float32))


def space_tables(space: ControlSpace, members: np.ndarray) -> Space:
    """The kernel's view of a control space over the library's primitives `members` (Q,)."""
    return Space(*(np.ascontiguousarray(a) for a in (
        members[space.simplices].astype(np.int64), space.neighbours, space.transform,
        space.hull, space.anchor / SCALE, space.lane / SCALE[0], np.array(space.straight()) / SCALE[0], space.bend / SCALE)))


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


@kernel
def locate_kernel(space, p, towards, start, b):
    """The simplex around the scaled point `p` (3,), its barycentric weights into `b` (4,): eq. (4).

    Walks from simplex `start` across the face opposite to the most negative weight. A point
    outside the hull is moved to it, `towards` (3,) a point inside (`p` is rewritten), when the walk
    leaves the triangulation.
    """
    simplex = start
    for _ in range(2 * space.neighbours.shape[0]):
        rest = 1.0
        least, worst = -1e-7, -1
        for i in range(3):
            b[i] = 0.0
            for j in range(3):
                b[i] += space.transform[simplex, i, j] * (p[j] - space.transform[simplex, 3, j])
            rest -= b[i]
        b[3] = rest
        for i in range(4):
            if b[i] < least:
                least, worst = b[i], i
        if worst < 0:
            break
        if space.neighbours[simplex, worst] >= 0:
            simplex = space.neighbours[simplex, worst]
        elif not clamp_kernel(space, p, towards):
            break
    total = 0.0
    for i in range(4):
        b[i] = max(b[i], 0.0)
        total += b[i]
    for i in range(4):
        b[i] /= total
    return simplex


@kernel
def clamp_kernel(space, p, towards):
    """Move the scaled point `p` (3,) towards an inner one until it is in the hull; whether it was not."""
    reach = 1.0
    for h in range(space.hull.shape[0]):
        along, room = 0.0, -space.hull[h, 3]
        for i in range(3):
            along += space.hull[h, i] * (p[i] - towards[i])
            room -= space.hull[h, i] * towards[i]
        room = max(room, 1e-12) * INSIDE
        if along > reach * room:
            reach = along / room
    if reach > 1.0:
        for i in range(3):
            p[i] = towards[i] + (p[i] - towards[i]) / reach
    return reach > 1.0


@kernel
def inner_kernel(space, p, inner):
    """Write the point (3,) of the space's lane that the scaled point `p` (3,) is clamped towards."""
    for i in range(3):
        inner[i] = space.anchor[i]
    inner[0] = min(max(p[0], space.lane[0]), space.lane[1])


@kernel
def query_kernel(space, velocity, start, correct, b, target, moved):
    """The simplex and weights `b` (4,) whose blend moves at `velocity` (3,) SI.

    `correct` fixed-point steps subtract what the quadratic element says the blend has too much.
    `target`, `moved`: (3,) scratch.
    """
    for i in range(3):
        target[i] = velocity[i] / SCALE[i]
    inner_kernel(space, target, moved)
    simplex = locate_kernel(space, target, moved, np.int64(start), b)  # a game keeps it as int32
    for _ in range(correct):
        for i in range(3):
            moved[i] = target[i]
        for e in range(6):
            pair = 4.0 * b[EDGES[e, 0]] * b[EDGES[e, 1]]
            for i in range(3):
                moved[i] -= pair * space.bend[simplex, e, i]
        simplex = locate_kernel(space, moved, target, simplex, b)
    return simplex


@kernel(fastmath=True)
def series_kernel(table, weights, phase, row):
    """Write into `row` (80,) the weighted sum of all primitives' series at `phase`: eq. (5) and (6)."""
    rows = table.shape[1]
    c1, s1 = math.cos(2 * math.pi * phase), math.sin(2 * math.pi * phase)
    c2, s2 = c1 * c1 - s1 * s1, 2.0 * s1 * c1
    for d in range(COLUMNS):
        row[d] = np.float32(0.0)
    for p in range(table.shape[0]):
        w = weights[p]
        if w <= 0.0:
            continue
        for d in range(COLUMNS):
            row[d] += w * table[p, 0, d]
        ca, sa, cb, sb = c1, s1, c2, s2
        for k in range(1, rows - 3, 4):  # two harmonics a pass: half the loads and stores of the row
            a0, b0, a1, b1 = np.float32(w * ca), np.float32(w * sa), np.float32(w * cb), np.float32(w * sb)
            for d in range(COLUMNS):
                row[d] += (a0 * table[p, k, d] + b0 * table[p, k + 1, d]
                           + a1 * table[p, k + 2, d] + b1 * table[p, k + 3, d])
            ca, sa = ca * c2 - sa * s2, sa * c2 + ca * s2
            cb, sb = cb * c2 - sb * s2, sb * c2 + cb * s2
        if (rows - 1) % 4:  # an odd number of harmonics leaves one
            for d in range(COLUMNS):
                row[d] += np.float32(w * ca) * table[p, rows - 2, d] + np.float32(w * sa) * table[p, rows - 1, d]


@kernel
def duration_kernel(table, weights, phase):
    """The duration [s] that the weighted sum of all primitives' series has at `phase`: one column of `series_kernel`."""
    c1, s1 = math.cos(2 * math.pi * phase), math.sin(2 * math.pi * phase)
    total = 0.0
    for p in range(table.shape[0]):
        w = weights[p]
        if w <= 0.0:
            continue
        total += w * table[p, 0, DURATION_AT]
        c, s = c1, s1
        for k in range(1, table.shape[1] - 1, 2):
            total += w * (c * table[p, k, DURATION_AT] + s * table[p, k + 1, DURATION_AT])
            c, s = c * c1 - s * s1, s * c1 + c * s1
    return total


@kernel
def time_kernel(table, weights, phase, share):
    """How long [s] the weighted sum of all primitives' series takes from `phase` on for that share of a cycle: the integral of `duration_kernel`, exactly."""
    c1, s1 = math.cos(2 * math.pi * phase), math.sin(2 * math.pi * phase)
    c2, s2 = math.cos(2 * math.pi * (phase + share)), math.sin(2 * math.pi * (phase + share))
    total = 0.0
    for p in range(table.shape[0]):
        w = weights[p]
        if w <= 0.0:
            continue
        total += w * share * table[p, 0, DURATION_AT]
        c, s, d, t = c1, s1, c2, s2
        for k in range(1, table.shape[1] - 1, 2):
            total += w * ((t - s) * table[p, k, DURATION_AT] - (d - c) * table[p, k + 1, DURATION_AT]) / (math.pi * (k + 1))
            c, s, d, t = c * c1 - s * s1, s * c1 + c * s1, d * c2 - t * s2, t * c2 + d * s2
    return total


# sin x / x and (1 − cos x) / x² as polynomials in x²: Taylor, exact to float32 for |x| < π
_SINC = tuple(np.float32((-1) ** n / math.factorial(2 * n + 1)) for n in range(10))
_VERS = tuple(np.float32((-1) ** n / math.factorial(2 * n + 2)) for n in range(10))
SCRATCH = (18, LANES)
"""Shape of the float32 scratch of `pose_kernel`."""


@kernel(fastmath=True)
def pose_kernel(body, row, local, positions, orientations, scratch):
    """Local rotations (J, 3, 3), positions (J, 3) and orientations (J, 3, 3) of a series row.

    In the ground frame. All joints' exponentials are taken side by side, without branches, so
    that they vectorise; only the chain of parents is walked joint by joint.
    """
    e, r = scratch[:9], scratch[9:]
    one = np.float32(1.0)
    for j in range(LANES):
        x, y, z = row[j], row[LANES + j], row[2 * LANES + j]
        t = x * x + y * y + z * z
        a = _SINC[9]
        b = _VERS[9]
        a, b = a * t + _SINC[8], b * t + _VERS[8]
        a, b = a * t + _SINC[7], b * t + _VERS[7]
        a, b = a * t + _SINC[6], b * t + _VERS[6]
        a, b = a * t + _SINC[5], b * t + _VERS[5]
        a, b = a * t + _SINC[4], b * t + _VERS[4]
        a, b = a * t + _SINC[3], b * t + _VERS[3]
        a, b = a * t + _SINC[2], b * t + _VERS[2]
        a, b = a * t + _SINC[1], b * t + _VERS[1]
        a, b = a * t + _SINC[0], b * t + _VERS[0]
        e[0, j], e[1, j], e[2, j] = one - b * (y * y + z * z), b * x * y - a * z, b * x * z + a * y
        e[3, j], e[4, j], e[5, j] = b * x * y + a * z, one - b * (x * x + z * z), b * y * z - a * x
        e[6, j], e[7, j], e[8, j] = b * x * z - a * y, b * y * z + a * x, one - b * (x * x + y * y)
    for i in range(3):
        for k in range(3):
            for j in range(LANES):
                r[3 * i + k, j] = (body.reference[3 * i, j] * e[k, j] + body.reference[3 * i + 1, j] * e[3 + k, j]
                                   + body.reference[3 * i + 2, j] * e[6 + k, j])
    for j in range(local.shape[0]):
        for i in range(3):
            for k in range(3):
                local[j, i, k] = r[3 * i + k, j]
    for i in range(3):
        positions[0, i] = row[HIPS_AT + i]
        for k in range(3):
            orientations[0, i, k] = local[0, i, k]
    for j in range(1, local.shape[0]):
        joint_kernel(body, j, local, positions, orientations)


@kernel(fastmath=True)
def joint_kernel(body, j, local, positions, orientations):
    """Place joint j from its parent's place and its own local rotation."""
    p = body.parents[j]
    x, y, z = body.offsets[j, 0], body.offsets[j, 1], body.offsets[j, 2]
    # the local rotation in scalars: the compiler can't know that the arrays don't overlap
    l00, l01, l02 = local[j, 0, 0], local[j, 0, 1], local[j, 0, 2]
    l10, l11, l12 = local[j, 1, 0], local[j, 1, 1], local[j, 1, 2]
    l20, l21, l22 = local[j, 2, 0], local[j, 2, 1], local[j, 2, 2]
    for i in range(3):
        a, b, c = orientations[p, i, 0], orientations[p, i, 1], orientations[p, i, 2]
        positions[j, i] = positions[p, i] + a * x + b * y + c * z
        orientations[j, i, 0] = a * l00 + b * l10 + c * l20
        orientations[j, i, 1] = a * l01 + b * l11 + c * l21
        orientations[j, i, 2] = a * l02 + b * l12 + c * l22
