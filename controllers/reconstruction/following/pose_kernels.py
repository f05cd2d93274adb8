"""Poses against each other, compiled: what carries one on to another, and how far apart that leaves their joints."""

from __future__ import annotations

import math

import numpy as np

from ...body import exp_kernel, log_kernel, product_kernel, relative_kernel
from ...compiled import kernel

ROUNDED = 1e-12
"""By so much a product of two rotations of double precision is none."""


@kernel
def nearest_kernel(matrix, work):
    """Make a matrix (3, 3), nearly a rotation, the nearest one: the mean of it and its inverse, transposed, again and again (Higham 1986). work: (3, 3)."""
    for _ in range(8):
        skew = 0.0
        for i in range(3):
            for k in range(3):
                product = matrix[i, 0] * matrix[k, 0] + matrix[i, 1] * matrix[k, 1] + matrix[i, 2] * matrix[k, 2]
                skew = max(skew, abs(product - (1.0 if i == k else 0.0)))
        if not skew > ROUNDED:
            return
        for i in range(3):
            for k in range(3):
                work[i, k] = (matrix[(i + 1) % 3, (k + 1) % 3] * matrix[(i + 2) % 3, (k + 2) % 3]
                              - matrix[(i + 1) % 3, (k + 2) % 3] * matrix[(i + 2) % 3, (k + 1) % 3])
        size = matrix[0, 0] * work[0, 0] + matrix[0, 1] * work[0, 1] + matrix[0, 2] * work[0, 2]
        for i in range(3):
            for k in range(3):
                matrix[i, k] = 0.5 * (matrix[i, k] + work[i, k] / size)


@kernel
def way_kernel(start, to, out, work):
    """Write the rotation vector (3,) [rad] of startᵀ · to, which carries one orientation (3, 3) on to another. work: (2, 3, 3)."""
    relative_kernel(start, to, work[0])
    nearest_kernel(work[0], work[1])
    log_kernel(work[0], out)


@kernel
def difference_kernel(root, rotations, start, turned, out):
    """Fills out (1 + J, 3), see `difference`: to root (3,) and rotations (J, 3, 3) from start (3,) and turned (J, 3, 3)."""
    work = np.empty((2, 3, 3))
    for i in range(3):
        out[0, i] = root[i] - start[i]
    for j in range(len(rotations)):
        way_kernel(turned[j], rotations[j], out[1 + j], work)


@kernel
def moved_kernel(root, rotations, by, place, turned):
    """Fills place (3,) and turned (J, 3, 3): root (3,) and rotations (J, 3, 3) moved by (1 + J, 3), see `moved`."""
    turn = np.empty((3, 3))
    for i in range(3):
        place[i] = root[i] + by[0, i]
    for j in range(len(rotations)):
        exp_kernel(by[1 + j, 0], by[1 + j, 1], by[1 + j, 2], turn)
        product_kernel(rotations[j], turn, turned[j])


@kernel
def placed_kernel(parents, offsets, root, rotations, by, positions, orientations):
    """Fills positions (J, 3) [m] and orientations (J, 3, 3): of the joints of a pose that is moved by (1 + J, 3)."""
    place, turned = np.empty(3), np.empty_like(rotations)
    moved_kernel(root, rotations, by, place, turned)
    for j in range(len(parents)):
        p = parents[j]
        if p < 0:
            positions[j], orientations[j] = place, turned[j]
        else:
            product_kernel(orientations[p], turned[j], orientations[j])
            for i in range(3):
                positions[j, i] = (positions[p, i] + orientations[p, i, 0] * offsets[j, 0] + orientations[p, i, 1] * offsets[j, 1]
                                   + orientations[p, i, 2] * offsets[j, 2])


@kernel
def apart_kernel(parents, offsets, root, rotations, by, there, out):
    """Fills out (J,) [m]: how far from there (J, 3) [m] the joints are of a pose that is moved by (1 + J, 3)."""
    positions, orientations = np.empty_like(there), np.empty_like(rotations)
    placed_kernel(parents, offsets, root, rotations, by, positions, orientations)
    for j in range(len(parents)):
        out[j] = math.sqrt((there[j, 0] - positions[j, 0]) ** 2 + (there[j, 1] - positions[j, 1]) ** 2 + (there[j, 2] - positions[j, 2]) ** 2)


@kernel
def missed_kernel(parents, offsets, root, rotations, by, joints, beside, seen, out):
    """Fills out (n,) [m]: how far from where they are seen (n, 3) [m] points are, beside (n, 3) [m] joints (n,) of a pose that is moved by (1 + J, 3)."""
    positions, orientations = np.empty((len(parents), 3)), np.empty_like(rotations)
    placed_kernel(parents, offsets, root, rotations, by, positions, orientations)
    for n in range(len(joints)):
        j, square = joints[n], 0.0
        for i in range(3):
            there = positions[j, i] + orientations[j, i, 0] * beside[n, 0] + orientations[j, i, 1] * beside[n, 1] + orientations[j, i, 2] * beside[n, 2]
            square += (seen[n, i] - there) ** 2
        out[n] = math.sqrt(square)


@kernel
def bent_kernel(turn, bone, axis):
    """How far [rad] a joint turned by (3, 3) bends a bone (3,) about an axis (3,)."""
    x = turn[0, 0] * bone[0] + turn[0, 1] * bone[1] + turn[0, 2] * bone[2]
    y = turn[1, 0] * bone[0] + turn[1, 1] * bone[1] + turn[1, 2] * bone[2]
    z = turn[2, 0] * bone[0] + turn[2, 1] * bone[1] + turn[2, 2] * bone[2]
    across = (bone[1] * z - bone[2] * y) * axis[0] + (bone[2] * x - bone[0] * z) * axis[1] + (bone[0] * y - bone[1] * x) * axis[2]
    return math.atan2(across, bone[0] * x + bone[1] * y + bone[2] * z)


@kernel
def back_kernel(rotations, others, joints, bones, axes, out):
    """Fills out (H,) [rad]: by how much joints (H,) with bones and axes (H, 3) bend farther back than straight, or than the other pose's. Whether any does."""
    broken = False
    for n in range(len(joints)):
        j = joints[n]
        out[n] = max(min(bent_kernel(others[j], bones[n], axes[n]), 0.0) - bent_kernel(rotations[j], bones[n], axes[n]), 0.0)
        broken = broken or out[n] > 0.0
    return broken
