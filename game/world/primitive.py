"""One primitive of a library as it was recorded, without blend and foot lock: for a ghost, and for who walks before a walk is compiled."""

from __future__ import annotations

import numpy as np

from gambol.controllers.body import forward_kinematics, rotations as rot
from gambol.controllers.locomotion import HIPS, LABELS, Library, fourier


def nearest(library: Library, velocity) -> int:
    """The number of the walk whose velocity is nearest to v_f, ω, v_l (3,)."""
    walks = library.family("walk")
    return int(walks[np.argmin(np.linalg.norm(library.velocities[walks] - np.asarray(velocity, float), axis=-1))])


def posed(library: Library, number: int, phase: float, ground: np.ndarray, right: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """World positions (J, 3) [m] and orientations (J, 3, 3) of primitive `number` at a phase 0 … 1.

    ground: (3,) x, z [m], heading [rad] of whom it is beside, so far to the right [m].
    """
    row = fourier.evaluate(library.coefficients[number], np.array(phase))
    local = library.reference @ rot.exp(row[:HIPS].reshape(-1, 3))
    turn = rot.yaw(np.asarray(ground[2], float))
    local[0] = turn @ local[0]
    root = turn @ (row[HIPS:LABELS] - [right, 0.0, 0.0]) + [ground[0], 0.0, ground[1]]
    return forward_kinematics(library.skeleton, root, local)
