"""Poses over planted feet, from how a body carries itself and where its mass centre is."""

from __future__ import annotations

import numpy as np

from ...body import exp_kernel, product_kernel
from ...compiled import kernel
from ..body import carriage, stand_kernel

FREE = -1.0
"""A foot's freedom (see `planted_pose.leg_kernel`) if its leg is posed by joints: the swing leg of a run."""


@kernel
def ground_kernel(body, flex, angles, joints, offsets, turns, centres, feet, root, roots, local):
    """Poses over planted feet: angles (N, 11), what is left of the start (N, J, 3), the pelvis' turns
    (N, 3, 3), centres of mass (N, 3), feet (N, 2, 6), or (N, 2, 8) on a slope, whose pitch is written.

    root: (3,) a first guess. roots: (N, 3) and local: (N, J, 3, 3) are written.
    """
    count = local.shape[1]
    positions, orientations = np.empty((count, 3)), np.empty((count, 3, 3))
    for n in range(len(centres)):
        carry_on_kernel(angles[n], joints, offsets[n], local[n])
        local[n, 0] = turns[n]
        for i in range(3):  # the pelvis goes on as it went, seen from the centre of mass
            if n > 1:
                root[i] = centres[n, i] + 2.0 * (roots[n - 1, i] - centres[n - 1, i]) - (roots[n - 2, i] - centres[n - 2, i])
            elif n == 1:
                root[i] += centres[1, i] - centres[0, i]
        stand_kernel(body, centres[n], feet[n], flex, root, local[n], positions, orientations)
        roots[n] = root


@kernel
def carry_on_kernel(angles, joints, offsets, local):
    """Write the local rotations (J, 3, 3) of a body carried by `angles` (11,), what is left of the start (J, 3)
    added; neither the pelvis nor, where nothing is left, joints that are not carried are touched."""
    turn, carried = np.empty((3, 3)), np.empty((3, 3))
    for j in range(1, len(local)):  # poses are made anew, whatever an earlier round left
        if offsets[j, 0] != 0.0 or offsets[j, 1] != 0.0 or offsets[j, 2] != 0.0:
            exp_kernel(0.0, 0.0, 0.0, local[j])
    carriage.carry_kernel(angles, joints, local)
    for j in range(1, len(local)):
        if offsets[j, 0] != 0.0 or offsets[j, 1] != 0.0 or offsets[j, 2] != 0.0:
            exp_kernel(offsets[j, 0], offsets[j, 1], offsets[j, 2], turn)
            carried[:] = local[j]
            product_kernel(turn, carried, local[j])


@kernel
def carry_all_kernel(angles, joints, offsets, local):
    """The same of poses (N, J, 3, 3), carried by angles (N, 11), with what is left of the start (N, J, 3)."""
    for n in range(len(angles)):
        carry_on_kernel(angles[n], joints, offsets[n], local[n])
