"""Legs: small rigid-body kernels that bend a leg, turn a foot and bend a toe."""

from __future__ import annotations

import math

from ..body import relative_kernel, two_bone_kernel
from ..compiled import kernel
from .kernel import joint_kernel

REACH = 0.999
"""Legs straighten to this share of their length, and those that must give way a little earlier."""
FOLDED = 0.34
"""And they fold up no farther than that ankles are so near to hips, over how long legs are: knees bent by 140°, where recorded runners' are by 136."""
SOFTNESS = 0.0045
"""Legs slow down over about this length before they are straight [m]."""


@kernel
def frame_kernel(bone, side, out):
    """Write into `out` (3, 3) the frame whose columns are bone, side made orthogonal, and their cross."""
    size = 1.0 / math.sqrt(bone[0] ** 2 + bone[1] ** 2 + bone[2] ** 2 + 1e-20)
    for i in range(3):
        out[i, 0] = bone[i] * size
    dot = side[0] * out[0, 0] + side[1] * out[1, 0] + side[2] * out[2, 0]
    total = 0.0
    for i in range(3):
        out[i, 1] = side[i] - dot * out[i, 0]
        total += out[i, 1] ** 2
    size = 1.0 / math.sqrt(total + 1e-20)
    for i in range(3):
        out[i, 1] *= size
    out[0, 2] = out[1, 0] * out[2, 1] - out[2, 0] * out[1, 1]
    out[1, 2] = out[2, 0] * out[0, 1] - out[0, 0] * out[2, 1]
    out[2, 2] = out[0, 0] * out[1, 1] - out[1, 0] * out[0, 1]


@kernel
def carry_kernel(before, after, matrix, out):
    """Write after · beforeᵀ · matrix: `matrix` carried along as one frame became another. All (3, 3)."""
    for i in range(3):
        for k in range(3):
            total = 0.0
            for a in range(3):
                turn = 0.0
                for c in range(3):
                    turn += before[c, a] * matrix[c, k]
                total += after[i, a] * turn
            out[i, k] = total


@kernel
def leg_kernel(positions, orientations, hip, target, work):
    """Bend the leg of joints hip, hip + 1 (knee), hip + 2 (ankle) so that its ankle meets `target`, or is below it where the leg would fold up.

    The knee keeps its hinge; positions and orientations of thigh and shank are rewritten.
    work: (5, 3, 3) scratch.
    """
    a, b, c = positions[hip], positions[hip + 1], positions[hip + 2]
    upper = math.sqrt((b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2 + (b[2] - a[2]) ** 2)
    lower = math.sqrt((c[0] - b[0]) ** 2 + (c[1] - b[1]) ** 2 + (c[2] - b[2]) ** 2)
    pole, before, after, mid, end = work[0, 0], work[0, 1], work[0, 2], work[1, 0], work[1, 1]
    for i in range(3):  # the knee bends forward, which is +Z of the thigh
        pole[i] = orientations[hip, i, 2]
    aim, least = work[1, 2], FOLDED * (upper + lower)
    across = (target[0] - a[0]) ** 2 + (target[2] - a[2]) ** 2
    aim[0], aim[2] = target[0], target[2]
    aim[1] = min(target[1], a[1] - math.sqrt(least * least - across)) if across < least * least else target[1]
    two_bone_kernel(a, upper, lower, aim, pole, (1.0 - REACH) * (upper + lower), mid, end)
    _hinge(pole, a, c, before)
    _hinge(pole, a, end, after)
    _turn_bone(orientations[hip], a, b, before, a, mid, after, work)
    _turn_bone(orientations[hip + 1], b, c, before, mid, end, after, work)
    for i in range(3):
        b[i], c[i] = mid[i], end[i]


@kernel
def _turn_bone(orientation, start, stop, side, new_start, new_stop, new_side, work):
    """Carry an orientation along as its bone and hinge become the new ones."""
    bone = work[1, 2]
    for i in range(3):
        bone[i] = stop[i] - start[i]
    frame_kernel(bone, side, work[2])
    for i in range(3):
        bone[i] = new_stop[i] - new_start[i]
    frame_kernel(bone, new_side, work[3])
    carry_kernel(work[2], work[3], orientation, work[4])
    for i in range(3):
        for k in range(3):
            orientation[i, k] = work[4, i, k]


@kernel
def _hinge(pole, start, end, out):
    x, y, z = end[0] - start[0], end[1] - start[1], end[2] - start[2]
    out[0] = pole[1] * z - pole[2] * y
    out[1] = pole[2] * x - pole[0] * z
    out[2] = pole[0] * y - pole[1] * x


@kernel
def tilt_kernel(matrix, axis, angle, out):
    """Write the rotation about the unit `axis` (3,) by `angle`, times `matrix` (3, 3), into `out`."""
    c, s = math.cos(angle), math.sin(angle)
    for k in range(3):
        x, y, z = matrix[0, k], matrix[1, k], matrix[2, k]
        dot = (axis[0] * x + axis[1] * y + axis[2] * z) * (1.0 - c)
        out[0, k] = c * x + s * (axis[1] * z - axis[2] * y) + dot * axis[0]
        out[1, k] = c * y + s * (axis[2] * x - axis[0] * z) + dot * axis[1]
        out[2, k] = c * z + s * (axis[0] * y - axis[1] * x) + dot * axis[2]


@kernel
def leg_length(body, hip):
    """Thigh and shank of the leg whose hip joint that is, together [m]."""
    return -body.offsets[hip + 1, 1] - body.offsets[hip + 2, 1]


@kernel
def soft_reach(distance, reach, softness):
    """The length [m] of a leg asked for `distance`: itself while short, smoothly up to `reach`, over about `softness` [m].

    A knee's angle changes infinitely fast where its leg runs into a hard limit.
    """
    return distance - softness * math.log1p(math.exp((distance - reach) / softness))


@kernel
def toe_kernel(body, a, height, bent, positions, orientations, local, work):
    """Bend the toe joint a + 1 up about the foot's lateral axis by `bent` [rad], and on until the toe's end is not below the floor; by how much in all.

    Twice, since on a rolled foot the first turn falls short.
    """
    t = a + 1
    joint_kernel(body, t, local, positions, orientations)
    length = math.sqrt(body.toe_end[0] ** 2 + body.toe_end[1] ** 2 + body.toe_end[2] ** 2)
    axis, turned = work[0, 0], work[1]
    for i in range(3):
        axis[i] = orientations[a, i, 0]
    angle = bent
    for k in range(3):
        if angle != 0.0:
            tilt_kernel(orientations[t], axis, -angle, turned)
            for i in range(3):
                for j in range(3):
                    orientations[t, i, j] = turned[i, j]
        if k == 2:
            break
        now = (orientations[t, 1, 0] * body.toe_end[0] + orientations[t, 1, 1] * body.toe_end[1]
               + orientations[t, 1, 2] * body.toe_end[2]) / length
        least = (height - positions[t, 1]) / length
        angle = math.asin(min(max(least, -1.0), 1.0)) - math.asin(min(max(now, -1.0), 1.0)) if now < least else 0.0
        bent += angle
    relative_kernel(orientations[a], orientations[t], local[t])
    return bent
