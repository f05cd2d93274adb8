"""What makes bodies of trackers steady: points, what the network expects, and poses are filtered, each by how unsteady it is."""

from __future__ import annotations

import numpy as np

from ...contract import but
from ..ours import Motion, noise
from ..pose_vector import WIDTH
from ..regression import seen_kernel
from .ground import less

ACCELERATION = 10.0
"""How fast velocities change in human motion [m/s²], and in joints [rad/s²] as far as filters may smooth them."""
WAVERING = 0.006
"""How much what the network expects wavers [m, rad]."""
ROUGH = 0.002
"""How unsteady poses are even where trackers are not [m, rad]."""
RECENT = 15
"""So many frames tell how noisy points are."""
_LITTLE = 2.0  # frames that velocities rest on at first
_JUMP = 1.0  # rad or m, beyond which the chart has jumped: nothing to be smoothed
_WORLD = np.zeros(3)


def begun(place: np.ndarray, change: np.ndarray | None = None) -> Motion:
    """A motion of which little is known yet."""
    return Motion(place, np.zeros_like(place) if change is None else change, _LITTLE)


def quiet(filtered: Motion | None, recent: np.ndarray, points: np.ndarray, dt: float) -> tuple[Motion, np.ndarray, float]:
    """Points (n, 3) [m] without their noise: their motion, where they are, and how much noise there is [m].

    filtered: their motion a frame before, None of none. recent: (T, n, 3) raw ones, these the last.
    """
    if filtered is None:
        filtered = begun(np.where(np.isfinite(points), points, 0.0))
    fresh = ~np.isfinite(recent[-2]) & np.isfinite(points)
    filtered = but(filtered, place=np.where(fresh, points - filtered.change, filtered.place))
    level = noise(recent)
    filtered = filtered.towards(points, ACCELERATION * dt ** 2 / level if level > 0.0 else np.inf)
    return filtered, np.where(np.isfinite(points), filtered.place, np.nan), level


def calmed(before: Motion | None, same: bool, expected: np.ndarray, ground: np.ndarray, dt: float) -> tuple[Motion, np.ndarray]:
    """What the network expects (D,), seen from ground (3,), without what wavers of it: in the world, as filtered, and seen from ground again.

    before: a frame before, None of none. same: whether slots tell what they told then; else the network expects something else at once.
    """
    place, seen = np.empty(WIDTH), np.empty(WIDTH)
    seen_kernel(expected, ground, _WORLD, place)
    if before is None or np.abs(less(place, before.place)).max() > _JUMP:
        calm = begun(place)
    elif same:
        calm = before.towards(before.place + less(place, before.place), ACCELERATION * dt ** 2 / WAVERING)
    else:
        calm = but(before, place=place)
    seen_kernel(calm.place, _WORLD, ground, seen)
    return calm, seen


def smoothed(before: Motion, found: np.ndarray, level: float, dt: float) -> Motion:
    """The motion of placed poses (D,) after the newest, of points with so much noise [m]."""
    off = less(found, before.place)
    if np.abs(off).max() > _JUMP:
        return begun(found)
    return before.towards(before.place + off, ACCELERATION * dt ** 2 / (ROUGH + 2.0 * level))
