"""Twists and kinematic chains for compiled loops: one at a time, nothing checked. `rigid_motions` has the same for arrays."""

from __future__ import annotations

import math

import numpy as np

from ...body import exp_kernel, log_kernel, product_kernel, relative_kernel
from ...compiled import kernel

SMALL = 0.2
"""Below so large an angle [rad] differences of nearly equal numbers are replaced by their series."""


@kernel
def twist_exp_kernel(twist, out):
    """Write the motion (4, 4) of a twist (6,): eq. (4), with its translation as the series' sum V(θ) v, exact at θ = 0."""
    x, y, z = twist[3], twist[4], twist[5]
    exp_kernel(x, y, z, out)
    square = x * x + y * y + z * z
    angle = math.sqrt(square)
    half = 0.5 * angle
    if angle < SMALL:
        b = 0.5 - square * (1 / 24 - square * (1 / 720 - square * (1 / 40320 - square / 3628800)))
        c = 1 / 6 - square * (1 / 120 - square * (1 / 5040 - square * (1 / 362880 - square / 39916800)))
    else:
        b = 2.0 * math.sin(half) ** 2 / square
        c = (angle - math.sin(angle)) / (square * angle)
    u, v, w = twist[0], twist[1], twist[2]
    cu, cv, cw = y * w - z * v, z * u - x * w, x * v - y * u
    out[0, 3] = u + b * cu + c * (y * cw - z * cv)
    out[1, 3] = v + b * cv + c * (z * cu - x * cw)
    out[2, 3] = w + b * cw + c * (x * cv - y * cu)
    out[3, 0], out[3, 1], out[3, 2], out[3, 3] = 0.0, 0.0, 0.0, 1.0


@kernel
def twist_log_kernel(motion, out):
    """Write the twist (6,) of a motion (4, 4), no more than half a turn: eq. (8) and (9), the matrix A inverted by hand."""
    log_kernel(motion, out[3:])
    x, y, z = out[3], out[4], out[5]
    square = x * x + y * y + z * z
    if square < SMALL * SMALL:
        c = 1 / 12 + square * (1 / 720 + square * (1 / 30240 + square * (1 / 1209600 + square / 47900160)))
    else:
        half = 0.5 * math.sqrt(square)
        c = (1.0 - half * math.cos(half) / math.sin(half)) / square
    u, v, w = motion[0, 3], motion[1, 3], motion[2, 3]
    cu, cv, cw = y * w - z * v, z * u - x * w, x * v - y * u
    out[0] = u - 0.5 * cu + c * (y * cw - z * cv)
    out[1] = v - 0.5 * cv + c * (z * cu - x * cw)
    out[2] = w - 0.5 * cw + c * (x * cv - y * cu)


@kernel
def turn_kernel(axes, count, angles, out):
    """Write the rotation (3, 3) of a joint with `count` degrees of freedom: hinges one after the other, or a ball's vector."""
    if count == 3:
        exp_kernel(angles[0], angles[1], angles[2], out)
        return
    for i in range(3):
        for k in range(3):
            out[i, k] = 1.0 if i == k else 0.0
    one, other = np.empty((3, 3)), np.empty((3, 3))
    for d in range(count):
        exp_kernel(axes[d, 0] * angles[d], axes[d, 1] * angles[d], axes[d, 2] * angles[d], one)
        other[:] = out
        product_kernel(other, one, out)


@kernel
def chain_kernel(parents, offsets, first, count, axes, root, angles, positions, orientations, columns):
    """Write all joints' positions (J, 3) and orientations (J, 3, 3), and each degree's twist (D, 6) in the world, eq. (10).

    first, count: (J,) of each joint its first degree of freedom and how many. root: (4, 4). A twist is the adjoint of
    all that comes before it, applied to the axis: what δθ of it does to every point that hangs on it. A ball's three
    are turns about its own axes.
    """
    local, one, turned = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    for j in range(len(parents)):
        p = parents[j]
        before = root if p < 0 else orientations[p]
        for i in range(3):
            if p < 0:
                positions[j, i] = root[i, 3]
            else:
                positions[j, i] = (positions[p, i] + before[i, 0] * offsets[j, 0] + before[i, 1] * offsets[j, 1]
                                   + before[i, 2] * offsets[j, 2])
        at, many = first[j], count[j]
        turn_kernel(axes[at:at + many], many, angles[at:at + many], local)
        product_kernel(before, local, orientations[j])
        for i in range(3):
            for k in range(3):
                one[i, k] = orientations[j, i, k] if many == 3 else before[i, k]
        for d in range(at, at + many):
            x, y, z = axes[d, 0], axes[d, 1], axes[d, 2]
            for i in range(3):
                columns[d, 3 + i] = one[i, 0] * x + one[i, 1] * y + one[i, 2] * z
            columns[d, 0] = positions[j, 1] * columns[d, 5] - positions[j, 2] * columns[d, 4]
            columns[d, 1] = positions[j, 2] * columns[d, 3] - positions[j, 0] * columns[d, 5]
            columns[d, 2] = positions[j, 0] * columns[d, 4] - positions[j, 1] * columns[d, 3]
            if many != 3:
                exp_kernel(x * angles[d], y * angles[d], z * angles[d], local)
                turned[:] = one
                product_kernel(turned, local, one)


@kernel
def retract_kernel(first, count, step, root, angles, lower, upper):
    """Go a step (6 + D,) of the tangent space, in place: root ← exp(δξ) root, angles along theirs, within the limits."""
    moved, old = np.empty((4, 4)), root.copy()
    twist_exp_kernel(step[:6], moved)
    for i in range(3):
        for k in range(4):
            root[i, k] = moved[i, 0] * old[0, k] + moved[i, 1] * old[1, k] + moved[i, 2] * old[2, k] + moved[i, 3] * old[3, k]
    a, b, c = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    for j in range(len(first)):
        at = first[j]
        if count[j] == 3:
            exp_kernel(angles[at], angles[at + 1], angles[at + 2], a)
            exp_kernel(step[6 + at], step[7 + at], step[8 + at], b)
            product_kernel(a, b, c)
            log_kernel(c, angles[at:at + 3])
        else:
            for d in range(at, at + count[j]):
                angles[d] += step[6 + d]
        for d in range(at, at + count[j]):
            angles[d] = min(max(angles[d], lower[d]), upper[d])


@kernel
def turn_log_kernel(first, count, start, end, out):
    """Write the tangent (D,) that leads from angles `start` to `end` (D,): a ball's log(Rᵀ R'), else the difference."""
    a, b, c = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    for j in range(len(first)):
        at = first[j]
        if count[j] == 3:
            exp_kernel(start[at], start[at + 1], start[at + 2], a)
            exp_kernel(end[at], end[at + 1], end[at + 2], b)
            relative_kernel(a, b, c)
            log_kernel(c, out[at:at + 3])
        else:
            for d in range(at, at + count[j]):
                away = end[d] - start[d]
                out[d] = away - 2.0 * math.pi * round(away / (2.0 * math.pi))
