"""A ghost: one primitive of the library played beside the character, to see what it is."""

from __future__ import annotations

import numpy as np

from gambol.controllers.body import forward_kinematics, rotations as rot
from gambol.controllers.locomotion import HIPS, LABELS, Library, fourier

from ..scene import Figure

BESIDE = 0.85
"""How far to the right of its character it plays [m]."""
TINT = (0.30, 0.52, 0.60)


def ghost(library: Library, number: int, phase: float, ground: np.ndarray) -> Figure:
    """The figure of primitive `number` at a phase 0 … 1, beside whoever stands at ground (3,) x, z [m], heading."""
    row = fourier.evaluate(library.coefficients[number], np.array(phase))
    local = library.reference @ rot.exp(row[:HIPS].reshape(-1, 3))
    turn = rot.yaw(np.asarray(ground[2], float))
    local[0] = turn @ local[0]
    root = turn @ (row[HIPS:LABELS] - [BESIDE, 0.0, 0.0]) + [ground[0], 0.0, ground[1]]
    return Figure(*forward_kinematics(library.skeleton, root, local), TINT)
