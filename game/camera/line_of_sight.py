"""What stands in a camera's way: rays that stop at props, and points moved out of them.

Props are swollen by a margin, so that an eye which stays outside sees no wall cut open by the
near plane.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from gambol.controllers.navigation import clearance, free_way

from ..scene import Box, Pillar, Prop

MARGIN = 0.18
"""How far an eye stays from whatever is solid [m]; no less than the near plane's corners."""
FLOOR = 0.15
"""An eye stays above this height [m]."""
_HAIR, _SKIN = 1e-6, 1e-4


def above_floor(point: np.ndarray) -> np.ndarray:
    """The point (3,), no lower than an eye may be."""
    return np.array([point[0], max(point[1], FLOOR), point[2]])


@dataclass(frozen=True, eq=False)
class _Solids:
    """Swollen props as arrays. centre, half: (B, 3) and to_local: (B, 3, 3) of boxes.

    axis: (P, 2) x, z, radius: (P,), low, high: (P,) of pillars.
    """

    centre: np.ndarray
    half: np.ndarray
    to_local: np.ndarray
    axis: np.ndarray
    radius: np.ndarray
    low: np.ndarray
    high: np.ndarray


@lru_cache(maxsize=64)
def _solids(props: tuple[Prop, ...], margin: float) -> _Solids | None:
    boxes = [p for p in props if isinstance(p, Box)]
    pillars = [p for p in props if isinstance(p, Pillar)]
    if not boxes and not pillars:
        return None
    heading = np.array([b.heading for b in boxes])
    cosine, sine, zero = np.cos(heading), np.sin(heading), np.zeros(len(boxes))
    slope = np.array([b.slope for b in boxes])
    to_local = np.stack([cosine, zero, -sine, -slope * sine, zero + 1.0, -slope * cosine, sine, zero, cosine], -1).reshape(-1, 3, 3)
    foot = np.array([p.foot for p in pillars], float).reshape(-1, 3)
    return _Solids(np.array([b.centre for b in boxes], float).reshape(-1, 3),
                   0.5 * np.array([b.size for b in boxes], float).reshape(-1, 3) + margin, to_local,
                   foot[:, [0, 2]], np.array([p.radius for p in pillars], float) + margin,
                   foot[:, 1] - margin, foot[:, 1] + np.array([p.height for p in pillars], float) + margin)


def as_far(origin: np.ndarray, way: np.ndarray, props: tuple[Prop, ...]) -> np.ndarray:
    """A way (3,) [m] from a point (3,), as far as it leads into nothing: what is looked at stays on this side of a wall and over the next tread."""
    far = float(np.linalg.norm(way))
    if far < 1e-6:
        return way
    return way * min(float(free_way(outside(origin, props), way[None] / far, props, MARGIN)[0]) / far, 1.0)


def outside(point: np.ndarray, props: tuple[Prop, ...], margin: float = MARGIN) -> np.ndarray:
    """The point (3,), moved to the nearest face of whatever it lies inside of, but not through the floor.

    Where props overlap so that no face leads out, it ends above them: never inside of one.
    """
    point = np.array(point, float)
    solids = _solids(props, margin) if _near(point, props, margin) else None
    if solids is None:
        return point
    for _ in range(6):
        push = _way_out(point, solids)
        if push is None:
            return point
        point = point + push
    while (top := _top_around(point, solids)) is not None:
        point[1] = top + _HAIR
    return point


def off_faces(point: np.ndarray, room: float, props: tuple[Prop, ...]) -> np.ndarray:
    """The point (3,) outside of props, led so far off those nearer than `room` [m] that it is no nearer, as far as there is room for that: smoothly as
    it moves, on the way between two as on the way past a corner."""
    solids = _solids(props, MARGIN) if _near(point, props, MARGIN + room) else None
    if solids is None:
        return point
    local = np.einsum("bij,bj->bi", solids.to_local, point - solids.centre)
    skin = solids.half - _SKIN  # on a face it is beyond it
    beyond = local - np.clip(local, -skin, skin)
    across = point[[0, 2]] - solids.axis
    away = np.linalg.norm(across, axis=-1, keepdims=True)
    aside = across * np.maximum(1.0 - solids.radius[:, None] / np.maximum(away, 1e-9), 0.0)
    over = point[1] - np.clip(point[1], solids.low, solids.high)
    ways = np.concatenate([np.einsum("bij,bi->bj", solids.to_local, beyond), np.stack([aside[:, 0], over, aside[:, 1]], -1)])
    far = np.linalg.norm(ways, axis=-1, keepdims=True)
    return point + as_far(point, (ways / np.maximum(far, 1e-12) * np.where(far > 0.0, np.maximum(room - far, 0.0), 0.0)).sum(0), props)


def blocked(point: np.ndarray, props: tuple[Prop, ...], margin: float = 0.1) -> int | None:
    """The number of a prop that a point (3,) lies inside of, or nearer to than `margin` [m], if there is one."""
    return next((i for i, prop in enumerate(props) if clearance(point, (prop,)) < margin), None) if clearance(point, props) < margin else None


def _near(point: np.ndarray, props: tuple[Prop, ...], margin: float) -> bool:
    """Whether a point (3,) may lie in something that is swollen by a margin [m], whose corners are farther away."""
    return bool(clearance(point, props) < 2.0 * margin)


def _way_out(point: np.ndarray, solids: _Solids) -> np.ndarray | None:
    """The shortest way (3,) out of the first prop around a point, not through the floor."""
    local = np.einsum("bij,bj->bi", solids.to_local, point - solids.centre)
    depth = solids.half - np.abs(local)
    for i in np.flatnonzero(depth.min(-1) > 0.0):
        side, room = np.where(local[i] < 0.0, -1.0, 1.0), depth[i].copy()
        if side[1] < 0.0 and solids.centre[i, 1] - solids.half[i, 1] < FLOOR:
            side[1], room[1] = 1.0, solids.half[i, 1] - local[i, 1]
        axis = int(room.argmin())
        return solids.to_local[i, axis] * side[axis] * (room[axis] + _HAIR)
    across = point[[0, 2]] - solids.axis
    away = np.linalg.norm(across, axis=-1)
    within = (away < solids.radius) & (solids.low < point[1]) & (point[1] < solids.high)
    for i in np.flatnonzero(within):
        up, out = solids.high[i] - point[1], solids.radius[i] - away[i]
        if up < out:
            return np.array([0.0, up + _HAIR, 0.0])
        x, z = across[i] / away[i] if away[i] > 1e-9 else (1.0, 0.0)
        return np.array([x, 0.0, z]) * (out + _HAIR)
    return None


def _top_around(point: np.ndarray, solids: _Solids) -> float | None:
    """The highest top of the props around a point, if there are any."""
    local = np.abs(np.einsum("bij,bj->bi", solids.to_local, point - solids.centre))
    tops = (solids.centre[:, 1] + solids.half[:, 1])[(local < solids.half).all(-1)]
    away = np.linalg.norm(point[[0, 2]] - solids.axis, axis=-1)
    within = (away < solids.radius) & (solids.low < point[1]) & (point[1] < solids.high)
    tops = np.concatenate([tops, solids.high[within]])
    return float(tops.max()) if len(tops) else None


def beside(eye: np.ndarray, ground: np.ndarray, radius: float = 0.5, height: float = 2.0) -> np.ndarray:
    """An eye (3,) moved out of the upright cylinder that somebody at `ground` (3,) stands in."""
    x, z = eye[0] - ground[0], eye[2] - ground[1]
    away = math.hypot(x, z)
    if away >= radius or eye[1] >= height:
        return eye
    x, z = (x / away, z / away) if away > 1e-6 else (-math.sin(ground[2]), -math.cos(ground[2]))
    return np.array([ground[0] + radius * x, eye[1], ground[1] + radius * z])
