"""What stands in a camera's way: rays that stop at props, and points moved out of them.

Props are swollen by a margin, so that an eye which stays outside sees no wall cut open by the
near plane. Everything here takes a whole fan of rays and all props at once.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from gambol.controllers.navigation import gap

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


def free_way(origin: np.ndarray, directions: np.ndarray, props: tuple[Prop, ...], margin: float = MARGIN) -> np.ndarray:
    """How far [m] from `origin`, (3,) or (W, 3), each ray (W, 3) of unit length is free: (W,), infinite without a prop.

    0 where the origin lies inside of one. Slab method (Kay and Kajiya 1986) in each box's own
    axes, and a quadratic for upright cylinders.
    """
    free = np.full(len(directions), np.inf)
    solids = _solids(props, margin)
    if solids is None:
        return free
    with np.errstate(divide="ignore", invalid="ignore"):
        origin = np.broadcast_to(origin, directions.shape)
        start = np.einsum("bij,bwj->bwi", solids.to_local, origin - solids.centre[:, None])
        ray = _no_zeros(np.einsum("bij,wj->bwi", solids.to_local, directions))
        half = solids.half[:, None]
        first, second = (-half - start) / ray, (half - start) / ray
        _stop(free, np.minimum(first, second).max(-1), np.maximum(first, second).min(-1))

        flat, rise = directions[:, [0, 2]], _no_zeros(directions[:, 1])
        across = origin[:, [0, 2]] - solids.axis[:, None]
        a = np.maximum((flat ** 2).sum(-1), 1e-18)
        b = (across * flat).sum(-1)
        root = np.sqrt(b * b - a * ((across ** 2).sum(-1) - solids.radius[:, None] ** 2))  # NaN: misses
        first, second = (solids.low[:, None] - origin[:, 1]) / rise, (solids.high[:, None] - origin[:, 1]) / rise
        _stop(free, np.maximum((-b - root) / a, np.minimum(first, second)),
              np.minimum((-b + root) / a, np.maximum(first, second)))
    return free


def as_far(origin: np.ndarray, way: np.ndarray, props: tuple[Prop, ...]) -> np.ndarray:
    """A way (3,) [m] from a point (3,), as far as it leads into nothing: what is looked at stays on this side of a wall and over the next tread."""
    far = float(np.linalg.norm(way))
    if far < 1e-6:
        return way
    return way * min(float(free_way(outside(origin, props), way[None] / far, props)[0]) / far, 1.0)


def outside(point: np.ndarray, props: tuple[Prop, ...], margin: float = MARGIN) -> np.ndarray:
    """The point (3,), moved to the nearest face of whatever it lies inside of, but not through the floor.

    Where props overlap so that no face leads out, it ends above them: never inside of one.
    """
    point = np.array(point, float)
    solids = _solids(props, margin)
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
    solids = _solids(props, MARGIN)
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
    at = np.asarray(point, float)[None]
    return next((i for i, prop in enumerate(props) if gap(at, prop)[0] < margin), None)


def _no_zeros(x: np.ndarray) -> np.ndarray:
    return np.where(np.abs(x) < 1e-12, 1e-12, x)


def _stop(free: np.ndarray, enter: np.ndarray, leave: np.ndarray) -> None:
    """Shorten `free` (W,) to where rays enter what they leave again; enter, leave: (N, W)."""
    enter = np.maximum(enter, 0.0)
    blocked = np.where(leave > enter + 1e-9, enter, np.inf)
    if len(blocked):
        np.minimum(free, blocked.min(0), out=free)


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
