"""Following a path: pure pursuit along a polyline, with the progress made as the only memory."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from ..compiled import kernel


@dataclass(frozen=True, eq=False)
class Path:
    """A polyline on the ground.

    points: (N, 2) x, z [m], N ≥ 2, no two neighbours the same. start: (N,) [m] how far along
    the path each point lies. ValueError for points that make no path.
    """

    points: np.ndarray
    start: np.ndarray = field(init=False)

    def __post_init__(self):
        points = np.array(self.points, float)
        if points.ndim != 2 or points.shape[1] != 2 or len(points) < 2:
            raise ValueError(f"a path needs at least two points [x, z], got shape {points.shape}")
        steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
        if not np.all(steps > 1e-9):
            raise ValueError("a path's neighbouring points must differ")
        start = np.concatenate([[0.0], np.cumsum(steps)])
        for name, value in (("points", points), ("start", start)):
            value.setflags(write=False)
            object.__setattr__(self, name, value)

    @property
    def length(self) -> float:
        """Its length [m]."""
        return float(self.start[-1])

    def at(self, along) -> np.ndarray:
        """Points (..., 2) [m] at distances `along` (...) [m] from its start, held at its ends."""
        return np.stack([np.interp(along, self.start, self.points[:, i]) for i in range(2)], -1)

    def nearest(self, position, since, reach: float) -> np.ndarray:
        """Distances along the path (...) [m] nearest to `position` (..., 2) [m].

        Only the stretch from `since` (...) to `since + reach` counts, so that a path may cross
        itself and progress never runs backward.
        """
        position, since = np.asarray(position, float), np.asarray(since, float)
        shape = np.broadcast_shapes(position.shape[:-1], since.shape)
        out = np.empty(shape)
        nearest_kernel(self.points, self.start, np.ascontiguousarray(np.broadcast_to(position, (*shape, 2))).reshape(-1, 2),
                       np.ascontiguousarray(np.broadcast_to(since, shape)).reshape(-1), float(reach), out.reshape(-1))
        return out[()]


@kernel
def nearest_kernel(points, start, positions, since, reach, out):
    """Write how far along a polyline the places nearest to positions (M, 2) are, see `Path.nearest`."""
    for m in range(len(positions)):
        until, least = min(since[m] + reach, start[-1]), np.inf
        out[m] = min(since[m], start[-1])
        for n in range(len(points) - 1):
            if start[n + 1] < since[m] or start[n] > until:
                continue
            length = start[n + 1] - start[n]
            x, z = (points[n + 1, 0] - points[n, 0]) / length, (points[n + 1, 1] - points[n, 1]) / length
            dx, dz = positions[m, 0] - points[n, 0], positions[m, 1] - points[n, 1]
            along = min(max(start[n] + dx * x + dz * z, since[m]), until)
            along = min(max(along, start[n]), start[n + 1])
            gap = math.hypot(dx - (along - start[n]) * x, dz - (along - start[n]) * z)
            if gap < least:
                least, out[m] = gap, along


def follow(path: Path, ground, progress, speed, ahead: float = 0.6, brake: float = 0.5
           ) -> tuple[np.ndarray, np.ndarray]:
    """The wished world velocity (..., 2) [m/s] along a path, and the progress (...) [m] made.

    ground: (..., 3) x, z [m], heading. progress: (...) [m] what this function returned a step
    ago, 0 at first. speed: (...) [m/s]. ahead: how far ahead the character looks [m].
    brake: the wish fades over the last `brake` metres, so that the character arrives rather
    than overshoots.
    """
    position = np.asarray(ground, float)[..., :2]
    progress = path.nearest(position, progress, reach=2.0 * ahead)
    aim = path.at(progress + ahead)
    offset = aim - position
    gap = np.linalg.norm(offset, axis=-1, keepdims=True)
    speed = np.asarray(speed, float) * np.clip((path.length - progress) / brake, 0.0, 1.0)
    return offset / np.maximum(gap, 1e-9) * np.asarray(speed)[..., None], progress
