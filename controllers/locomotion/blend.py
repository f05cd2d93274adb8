"""The paper's synthesis and nothing else: velocity and phase in, blended pose out, without memory.

For those who bring their own root motion and feet, and for measuring: locate (eq. 4), blend the
series (eq. 5 and 6), pose the joints. The controller adds command shaping, root and footing.
"""

from __future__ import annotations

import numpy as np

from ..compiled import kernel
from .kernel import COLUMNS, SCRATCH, pose_kernel, query_kernel, series_kernel


class Blender:
    """Poses of the walking family in the ground frame, for any number of velocities and phases."""

    def __init__(self, locomotion, correct: int = 0):
        if not hasattr(locomotion, "tables"):
            raise ValueError(f"a Blender takes a Locomotion, whose tables it reads; got a {type(locomotion).__name__}")
        self._tables = locomotion.tables
        self._count = len(locomotion.library.primitives)
        self._joints = len(locomotion.skeleton)
        self._correct = correct

    def output(self, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Arrays to write into: positions (N, J, 3), orientations and local rotations (N, J, 3, 3)."""
        shape = (count, self._joints, 3)
        return np.empty(shape, np.float32), np.empty(shape + (3,), np.float32), np.empty(shape + (3,), np.float32)

    def __call__(self, velocity: np.ndarray, phase: np.ndarray, simplex: np.ndarray | None = None, output=None):
        """Blend N velocities (N, 3) [m/s, rad/s, m/s] at phases (N,) float32.

        simplex: (N,) int64 where each was located before, updated in place. Returns `output`.
        """
        output = self.output(len(phase)) if output is None else output
        simplex = np.zeros(len(phase), np.int64) if simplex is None else simplex
        body, walk, table = self._tables.body, self._tables.walk, self._tables.series
        _blend(body, walk, table, self._count, self._correct, velocity, phase, simplex, *output)
        return output


@kernel(nogil=True)
def _blend(body, space, table, count, correct, velocity, phase, simplex, positions, orientations, local):
    b, target, moved = np.empty(4), np.empty(3), np.empty(3)
    weights, row = np.zeros(count, np.float32), np.empty(COLUMNS, np.float32)
    scratch = np.empty(SCRATCH, np.float32)
    for n in range(phase.shape[0]):
        simplex[n] = query_kernel(space, velocity[n], simplex[n], correct, b, target, moved)
        for i in range(4):
            weights[space.vertices[simplex[n], i]] = b[i]
        series_kernel(table, weights, phase[n], row)
        for i in range(4):
            weights[space.vertices[simplex[n], i]] = 0.0
        pose_kernel(body, row, local[n], positions[n], orientations[n], scratch)
