"""The sun: what its shadow maps cover, and where on the floor shadows may fall. Pure arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from gambol.controllers.body import yaw

from ..scene import Box, Camera, Figure, Pillar

SUN = np.array([0.62, 0.75, -0.22]) / np.linalg.norm([0.62, 0.75, -0.22])
"""Towards the sun."""
_SIDE = np.cross([0.0, 1.0, 0.0], SUN) / np.linalg.norm(np.cross([0.0, 1.0, 0.0], SUN))
AXES = np.stack([_SIDE, np.cross(SUN, _SIDE), SUN])
"""A shadow map's two sides, of which the first is level, and the sun: rows."""
SIZE_STEP = 0.5
"""The shadow map of several figures grows by steps [m]."""
SHADOW_RANGE = 22.0
"""Figures nearer than this to the camera or to its target [m] cast shadows."""
REACH = 1.28
"""Radius [m] of the ball around a standard human's hips that holds any pose."""
STAGE_STEP, STAGE_LARGEST = 4.0, 64.0
"""The solids' map moves by these steps, and covers at most this much of a large stage [m]."""


@dataclass(frozen=True, eq=False)
class LightBox:
    """What a shadow map covers, in metres along `AXES` in the world.

    corner: (2,) the map's low corner. size: (2,) its sides. bottom, top: its depth along the sun.
    texels: along either side.
    """

    corner: np.ndarray
    size: np.ndarray
    bottom: float
    top: float
    texels: int

    @property
    def texel(self) -> float:
        """The larger side of a texel [m]."""
        return float(self.size.max() / self.texels)

    def matrix(self, origin: np.ndarray) -> np.ndarray:
        """(4, 4): positions counted from `origin` (3,) [m] to the map, 0 … 1 in all three."""
        shift, depth = AXES @ origin, self.top - self.bottom
        matrix = np.eye(4)
        matrix[:2, :3] = AXES[:2] / self.size[:, None]
        matrix[:2, 3] = (shift[:2] - self.corner) / self.size
        matrix[2, :3] = -AXES[2] / depth
        matrix[2, 3] = (self.top - shift[2]) / depth
        return matrix


def figures_box(camera: Camera, figures: Sequence[Figure], texels: int) -> LightBox | None:
    """The smallest light box around the figures nearby, or None where there is nobody.

    Its size comes in steps and its place in whole texels, so that a shadow's edge does not crawl
    as the figure moves. It follows from the scene alone: the same scene gives the same box.
    """
    balls = [ball for ball in map(_ball, figures) if _near(camera, ball[0])]
    if not balls:
        return None
    centres, radii = np.array([b[0] for b in balls]), np.array([b[1] for b in balls])
    seen = centres @ AXES.T
    low, high = (seen - radii[:, None]).min(0), (seen + radii[:, None]).max(0)
    size = (high - low)[:2]
    if len(balls) > 1:
        size = np.ceil(size / SIZE_STEP - 1e-6) * SIZE_STEP
    size = size * (1.0 + 2.0 / texels)  # room for moving by less than a texel
    texel = size / texels
    corner = np.floor((0.5 * (low + high)[:2] - 0.5 * size) / texel) * texel
    # where the box's four edges, followed along the sun, meet the floor
    square = corner + size * np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    along = -(square @ AXES[:2, 1]) / AXES[2, 1]
    return LightBox(corner, size, min(along.min(), low[2]) - 0.1, high[2] + 0.1, texels)


def solids_box(camera: Camera, solids: Sequence[Box | Pillar], texels: int) -> LightBox | None:
    """The light box of what stands still: all of it, or of a large stage the part around the camera's target.

    It hardly ever changes, so that its map need not be drawn anew for every frame.
    """
    if not solids:
        return None
    seen = np.concatenate([corners(solid) for solid in solids]) @ AXES.T
    low, high = seen.min(0) - 0.2, seen.max(0) + 0.2
    wanted = (high - low)[:2].max() + STAGE_STEP
    side = min(2.0 ** np.ceil(np.log2(wanted)), STAGE_LARGEST)
    middle = 0.5 * (low + high)[:2]
    if wanted > side:
        middle = np.clip(AXES[:2] @ camera.target, low[:2], high[:2])
    corner = np.round((middle - 0.5 * side) / STAGE_STEP) * STAGE_STEP
    square = corner + side * np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    along = -(square @ AXES[:2, 1]) / AXES[2, 1]
    return LightBox(corner, np.full(2, side), min(along.min(), low[2]) - 0.1, high[2] + 0.1, texels)


def outlines(points: np.ndarray, radii: np.ndarray, sides: int = 12) -> np.ndarray:
    """Where shadows of bodies may fall on the floor: convex outlines (N, sides, 3) [m], counter-clockwise
    from above, around the balls of `radii` (P,) [m] about `points` (N, P, 3) that hold each body.

    Every side touches its body's shadow, so that the outline is tight.
    """
    angle = 2.0 * np.pi * np.arange(sides) / sides
    normals = np.stack([np.cos(angle), np.sin(angle)], 1)
    reach = (points @ AXES[:2].T @ normals.T + radii[:, None]).max(1)
    # neighbouring sides n·x = h meet at one corner each
    sine, cosine = np.sin(angle[1]), np.cos(angle[1])
    across = np.stack([-normals[:, 1], normals[:, 0]], 1)
    rim = reach[..., None] * normals + ((np.roll(reach, -1, 1) - cosine * reach) / sine)[..., None] * across
    along = -(rim @ AXES[:2, 1]) / AXES[2, 1]
    return _counter_clockwise(rim @ AXES[:2] + along[..., None] * AXES[2])


@lru_cache(maxsize=256)
def corners(solid: Box | Pillar) -> np.ndarray:
    """The corners (8, 3) [m] of a box, or of the box around a pillar: x slowest and z fastest."""
    half = 0.5 * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    if isinstance(solid, Pillar):
        placed = (half + [0.0, 0.5, 0.0]) * [2 * solid.radius, solid.height, 2 * solid.radius] + solid.foot
    else:
        placed = (half * solid.size) @ yaw(solid.heading).T + solid.centre
    placed.setflags(write=False)
    return placed


def _counter_clockwise(rim: np.ndarray) -> np.ndarray:
    """Outlines (N, S, 3) laid on the floor, turned so that their upper side is in front."""
    rim = rim * [1.0, 0.0, 1.0]
    after = np.roll(rim, -1, 1)
    area = np.sum(rim[..., 2] * after[..., 0] - after[..., 2] * rim[..., 0], 1)
    return np.where((area < 0.0)[:, None, None], rim[:, ::-1], rim)


def _ball(figure: Figure):
    at = np.asarray(figure.positions, float)
    # one radius for all ordinary poses, so that the map keeps its size while somebody moves
    reach = np.linalg.norm(at - at[:1], axis=-1).max(initial=0.0) + 0.25
    return at[0], max(REACH, np.ceil(reach * 4.0) / 4.0) if reach > REACH else REACH


def _near(camera: Camera, at: np.ndarray) -> bool:
    return bool(np.isfinite(at).all() and min(np.linalg.norm(at - camera.eye), np.linalg.norm(at - camera.target))
                < SHADOW_RANGE)
