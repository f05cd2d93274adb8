"""Points that are too far away to be taken hold of: how far apart they are, and the way to them."""

from __future__ import annotations

import numpy as np

from ...body import wrap
from ...contract import CharacterState

CLOSE = 0.3
"""Nobody walks to points that are so close [m]."""


def spread(points: np.ndarray) -> float:
    """The largest distance [m] between two of the points (n, 3) that are seen."""
    seen = points[np.isfinite(points).all(-1)]
    return float(np.linalg.norm(seen[:, None] - seen, axis=-1).max())


def towards(state: CharacterState, points: np.ndarray) -> np.ndarray:
    """The velocity (3,) with which a walker goes to points (n, 3) [m] that are too far away to be taken hold of.

    Zero where none is seen, or close by.
    """
    there = points[np.isfinite(points).all(-1)]
    if not len(there):
        return np.zeros(3)
    x, z, heading = (float(v) for v in state.ground)
    way = there.mean(0)[[0, 2]] - [x, z]
    distance = float(np.hypot(*way))
    if distance < CLOSE:
        return np.zeros(3)
    bearing = float(wrap(np.arctan2(way[0], way[1]) - heading))
    return np.array([min(1.4, distance) * max(np.cos(bearing), 0.0), np.clip(2.0 * bearing, -2.0, 2.0), 0.0])
