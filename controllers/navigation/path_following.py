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


def follow(path: Path, ground, progress, speed, ahead: float = 0.6, brake: float = 0.7
           ) -> tuple[np.ndarray, np.ndarray]:
    """The wished world velocity (..., 2) [m/s] along a path, and the progress (...) [m] made.

    ground: (..., 3) x, z [m], heading. progress: (...) [m] what this function returned a step
    ago, 0 at first. speed: (...) [m/s]. ahead: how far ahead the character looks [m].
    brake: the wish fades over the last `brake` metres, so that the character arrives rather
    than overshoots.

    Only the stretch from `progress` to twice `ahead` beyond it counts as near, so that a path may
    cross itself and progress never runs backward.
    """
    ground, progress, speed = np.asarray(ground, float), np.asarray(progress, float), np.asarray(speed, float)
    shape = np.broadcast_shapes(ground.shape[:-1], progress.shape, speed.shape)
    wish, made = np.empty((*shape, 2)), np.empty(shape)
    follow_kernel(path.points, path.start, _rows(ground, (*shape, ground.shape[-1])).reshape(-1, ground.shape[-1]),
                  _rows(progress, shape).reshape(-1), _rows(speed, shape).reshape(-1), float(ahead), float(brake),
                  wish.reshape(-1, 2), made.reshape(-1))
    return wish, made[()]


def _rows(value: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    return np.ascontiguousarray(value if value.shape == shape else np.broadcast_to(value, shape))


@kernel
def follow_kernel(points, start, grounds, since, speeds, ahead, brake, wish, made):
    """Write wishes (M, 2) and progress (M,) of characters (M, ≥ 2) along a polyline, see `follow`."""
    for m in range(len(grounds)):
        x, z = grounds[m, 0], grounds[m, 1]
        made[m] = nearest_kernel(points, start, x, z, since[m], 2.0 * ahead)
        along = min(max(made[m] + ahead, 0.0), start[-1])
        n = min(max(np.searchsorted(start, along, side="right") - 1, 0), len(points) - 2)
        share = (along - start[n]) / (start[n + 1] - start[n])
        dx = points[n, 0] + share * (points[n + 1, 0] - points[n, 0]) - x
        dz = points[n, 1] + share * (points[n + 1, 1] - points[n, 1]) - z
        fast = speeds[m] * min(max((start[-1] - made[m]) / brake, 0.0), 1.0) / max(math.hypot(dx, dz), 1e-9)
        wish[m, 0], wish[m, 1] = dx * fast, dz * fast


@kernel
def nearest_kernel(points, start, x, z, since, reach):
    """How far along a polyline [m] the place nearest to x, z is, of the stretch from `since` to `since + reach`."""
    until, least = min(since + reach, start[-1]), np.inf
    nearest = min(since, start[-1])
    for n in range(len(points) - 1):
        if start[n + 1] < since or start[n] > until:
            continue
        length = start[n + 1] - start[n]
        along_x, along_z = (points[n + 1, 0] - points[n, 0]) / length, (points[n + 1, 1] - points[n, 1]) / length
        dx, dz = x - points[n, 0], z - points[n, 1]
        along = min(max(start[n] + dx * along_x + dz * along_z, since), until)
        along = min(max(along, start[n]), start[n + 1])
        gap = math.hypot(dx - (along - start[n]) * along_x, dz - (along - start[n]) * along_z)
        if gap < least:
            least, nearest = gap, along
    return nearest
