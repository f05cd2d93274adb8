"""A planned jump: wind-up, thrust, flight and landing, sampled as one motion to play."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...body import Pose, exp_kernel, log_kernel, product_kernel, relative_kernel
from ...compiled import kernel
from .path_estimate import Path


@dataclass(frozen=True, eq=False)
class Plan:
    """A jump as a motion of N samples.

    times: (N,) [s]. roots: (N, 3), local: (N, J, 3, 3) poses. centres, velocities: (N, 3) of the
    centre of mass. forces: (N, 3) [N] of the ground. contacts: (N, 4) bool. push_off, take_off,
    touch_down, lowest: times [s] of the events; through: when a body that can't stop
    over its feet walks on, infinite for one that stops. feet: (2, 5) where they land. momentum: (3,)
    [kg m²/s] in flight. path: what was estimated first. rolls: until when it rolls [s], 0 if it stays on its feet.
    """

    times: np.ndarray
    roots: np.ndarray
    local: np.ndarray
    centres: np.ndarray
    velocities: np.ndarray
    forces: np.ndarray
    contacts: np.ndarray
    push_off: float
    take_off: float
    touch_down: float
    lowest: float
    through: float
    feet: np.ndarray
    momentum: np.ndarray
    path: Path
    rolls: float = 0.0

    @property
    def duration(self) -> float:
        """Seconds until the jumper stands again."""
        return float(self.times[-1])

    def moving(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Where (3,) [m] the centre of mass is `time` [s] after the start, and how fast (3,) [m/s] it moves."""
        n, part = self._between(time)
        return tuple(rows[n] + part * (rows[n + 1] - rows[n]) for rows in (self.centres, self.velocities))

    def _between(self, time: float) -> tuple[int, float]:
        """The sample before a time [s], and which share of the way to the next one it is on."""
        n = int(np.clip(np.searchsorted(self.times, time, "right") - 1, 0, len(self.times) - 2))
        return n, float(np.clip((time - self.times[n]) / (self.times[n + 1] - self.times[n]), 0.0, 1.0))

    def at(self, time: float) -> Pose:
        """The pose `time` [s] after the start, between the two samples around it."""
        n, part = self._between(time)
        root, local = np.empty(3), np.empty_like(self.local[0])
        between_kernel(self.roots[n], self.roots[n + 1], self.local[n], self.local[n + 1], part, root, local)
        return Pose(root, local)


@kernel
def between_kernel(root_a, root_b, a, b, part, root, local):
    """Write the pose `part` (0 … 1) of the way from one to the next nearby one."""
    turned, way = np.empty((3, 3)), np.empty(3)
    for i in range(3):
        root[i] = root_a[i] + part * (root_b[i] - root_a[i])
    for j in range(len(a)):
        relative_kernel(a[j], b[j], turned)
        log_kernel(turned, way)
        exp_kernel(part * way[0], part * way[1], part * way[2], turned)
        product_kernel(a[j], turned, local[j])
