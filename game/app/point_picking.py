"""Points that one takes hold of on the screen: where they are seen, which one is under the pointer, where it is dragged.

Places on the screen are in parts of the picture's height from its top-left corner, as `hosts.events.MouseMove` has
them; depths [m] along the line of sight, square to which a point is dragged.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ..render import NEAR, look_at
from ..scene import Camera

GRAB = 0.035
"""How near to a point the pointer takes hold of it, in heights of the picture."""
NOTCH = 1.04
"""What a notch of the wheel does to the depth of a point that is held."""
PUSH = 2.5
"""How many times deeper, as a power of e, a drag over the height of the picture pushes with Shift."""
FARTHEST = 60.0
"""No point is pushed deeper than this [m]."""


def project(camera: Camera, aspect: float, points: np.ndarray) -> np.ndarray:
    """Places (..., 3) of points (..., 3) [m]: x, y on the screen and depth. aspect: width over height of the picture."""
    seen = _sight(camera)
    at = np.asarray(points, float) @ seen[:3, :3].T + seen[:3, 3]
    depth = -at[..., 2]
    half = np.where(np.abs(depth) > 1e-9, depth, 1e-9) * 2.0 * math.tan(0.5 * camera.fov)
    return np.stack([0.5 * aspect + at[..., 0] / half, 0.5 - at[..., 1] / half, depth], -1)


def unproject(camera: Camera, aspect: float, place: np.ndarray) -> np.ndarray:
    """The inverse: points (..., 3) [m] of places (..., 3), x, y and depth."""
    place, seen = np.asarray(place, float), _sight(camera)
    half = place[..., 2] * 2.0 * math.tan(0.5 * camera.fov)
    at = np.stack([(place[..., 0] - 0.5 * aspect) * half, (0.5 - place[..., 1]) * half, -place[..., 2]], -1)
    return (at - seen[:3, 3]) @ seen[:3, :3]


def nearest(camera: Camera, aspect: float, points: np.ndarray, x: float, y: float, within: float = GRAB) -> int | None:
    """Which of the points (n, 3) is seen nearest to x, y, the nearer one to the eye first; None if none is `within`."""
    seen = project(camera, aspect, points)
    away = np.hypot(seen[:, 0] - x, seen[:, 1] - y)
    away[~np.isfinite(away) | (seen[:, 2] < NEAR)] = np.inf
    if not len(away) or away.min() > within:
        return None
    close = np.flatnonzero(away <= away.min() + 0.2 * within)
    return int(close[np.argmin(seen[close, 2])])


@dataclass(frozen=True)
class Grip:
    """A point that is held. number: which. off: x, y from the pointer to it. depth: [m]."""

    number: int
    off: tuple[float, float]
    depth: float

    @staticmethod
    def of(camera: Camera, aspect: float, points: np.ndarray, number: int, x: float, y: float) -> Grip:
        """Hold of a point, with the pointer at x, y."""
        at = project(camera, aspect, points[number])
        return Grip(number, (float(at[0]) - x, float(at[1]) - y), float(at[2]))

    def pushed(self, notches: float) -> Grip:
        """Deeper by some notches of the wheel."""
        return self._at(self.depth * NOTCH ** min(max(notches, -10.0), 10.0))

    def slid(self, dx: float, dy: float) -> Grip:
        """Deeper by a drag with Shift, upwards away; it stays where it is seen."""
        return replace(self._at(self.depth * math.exp(-PUSH * min(max(dy, -1.0), 1.0))),
                       off=(self.off[0] - dx, self.off[1] - dy))

    def _at(self, depth: float) -> Grip:
        return replace(self, depth=min(max(depth, 2.0 * NEAR), FARTHEST))

    def place(self, camera: Camera, aspect: float, x: float, y: float) -> np.ndarray:
        """Where (3,) [m] the point is with the pointer at x, y."""
        return unproject(camera, aspect, np.array([x + self.off[0], y + self.off[1], self.depth]))


def _sight(camera: Camera) -> np.ndarray:
    return look_at(np.asarray(camera.eye, float), np.asarray(camera.target, float), np.asarray(camera.up, float))
