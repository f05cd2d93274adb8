"""Points that are too far away to be taken hold of: how far apart they are, and the way to them."""

from __future__ import annotations

import numpy as np

from ...body import wrap
from ...contract import CharacterState, Unable

FAR = 1.5
"""Points that are farther from the body than this on the average [m] can't be taken hold of; a body that is farther from where
it begins anew is there at once."""
APART = 2.5
"""No two points of a standard body are farther apart [m]."""
CLOSE = 0.3
"""Nobody walks to points that are so close [m]."""


def spread(points: np.ndarray) -> float:
    """The largest distance [m] between two of the points (n, 3) that are seen."""
    seen = points[np.isfinite(points).all(-1)]
    return float(np.linalg.norm(seen[:, None] - seen, axis=-1).max())


def reached(seen: np.ndarray, body: np.ndarray, factor: float = 1.0, far: float = FAR) -> float:
    """How far points (n, 3) [m], some of them seen, are from the body's (n, 3) on the average [m].

    factor: how much larger the world's lengths are than these, to tell them. Unable unless they can be of this body, no more than far [m] away.
    """
    there = np.isfinite(seen).all(-1)
    if not there.any():
        raise Unable("no point is seen")
    away = float(np.linalg.norm(seen - body, axis=-1)[there].mean())
    if away > far:
        raise Unable(f"the points are {away * factor:.1f} m away from the body")
    apart = spread(seen[there])
    if apart > APART:
        raise Unable(f"two points are {apart * factor:.1f} m apart, which no body is")
    return away


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
