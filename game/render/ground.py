"""The floor and the sky above it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from gambol.controllers.body import end_positions

from ..scene import Box, Figure, Pillar
from . import gl, occlusion, skin
from .sun import corners, outlines
from .view import scale_of
from .wear import bulk

EXTENT = 390.0
"""How far the floor reaches [m]: beyond, it would be all fog."""
SQUARE = 0.25
"""The side of the squares that the floor is cut into where something is near [m]."""
MOST = 1000.0
"""Beyond so many square metres around solids, all of the floor is cheaper."""
WHOLE = EXTENT * np.array([[-1, 0, -1], [-1, 0, 1], [1, 0, 1], [-1, 0, -1], [1, 0, 1], [1, 0, -1.0]])
CREASE = 0.40
"""How far from a solid the floor is darker [m]; a little more than in occlusion.glsl."""

# how far flesh reaches around each joint and bone end, for the outline of a shadow [m]
_GIRTH = np.concatenate([[0.17 if n in ("Hips", "Spine", "Spine1", "Spine2", "Head") else 0.12
                          for n in skin.STANDARD.names], [0.09] * len(skin.STANDARD.end_parents)])
_FEET = np.array([i for i, n in enumerate(skin.STANDARD.names) if n.endswith(("Foot", "Toe"))])


def touched_floor(figures: Sequence[Figure], solids: Sequence[Box | Pillar], origin: np.ndarray) -> np.ndarray:
    """Where on the floor there may be shadows or darker corners; only there are they looked for.

    Triangles (K, 3) [m] counted from `origin`, which do not overlap.
    """
    rims = []
    if figures:
        at = np.stack([f.positions for f in figures]).astype(float)
        tips = end_positions(skin.STANDARD, at, np.stack([f.orientations for f in figures]).astype(float))
        scale = max(scale_of(at, skin.REST, skin.STANDARD.parents).max(), 1.0) * 1.1
        scale *= max((bulk(f.body) for f in figures if f.body is not None), default=1.0)
        under = at[:, _FEET] * [1.0, 0.0, 1.0]
        points = np.concatenate([at, tips, under], 1)
        rims += [*outlines(points - origin, np.concatenate([_GIRTH * scale, np.full(len(_FEET), occlusion.REACH)]))]
    if solids:
        ends = np.stack([corners(solid) for solid in solids])
        ends[..., 1] = np.maximum(ends[..., 1], 0.0)
        points = np.concatenate([ends, ends * [1.0, 0.0, 1.0]], 1)
        near = outlines(points - origin, np.full(16, CREASE), sides=24)
        if np.prod(np.ptp(near, axis=1)[:, [0, 2]], axis=1).sum() > MOST:
            return WHOLE
        rims += [*near]
    return covered(rims)


def covered(rims: Sequence[np.ndarray]) -> np.ndarray:
    """The squares of the floor that convex outlines (S, 3), counter-clockwise from above, touch: triangles (K, 3)."""
    squares = [np.zeros((0, 2), int)]
    for rim in rims:
        flat, side = rim[:, [0, 2]], np.roll(rim, -1, 0)[:, [0, 2]] - rim[:, [0, 2]]
        low, high = np.floor(flat.min(0) / SQUARE), np.floor(flat.max(0) / SQUARE)
        ranges = (np.arange(a, b + 1) for a, b in zip(low, high))
        cells = np.stack(np.meshgrid(*ranges, indexing="ij"), -1).reshape(-1, 2)
        inward = np.stack([side[:, 1], -side[:, 0]], 1)
        # of a square's corners, the innermost for each side decides
        depth = (cells @ inward.T + np.maximum(inward, 0.0).sum(1)) * SQUARE - np.sum(flat * inward, 1)
        squares.append(cells[(depth >= 0.0).all(1)].astype(int))
    squares = _different(np.concatenate(squares))
    corner = SQUARE * (squares[:, None] + [[0, 0], [0, 1], [1, 1], [0, 0], [1, 1], [1, 0]])
    return np.stack([corner[..., 0], np.zeros(corner.shape[:2]), corner[..., 1]], -1).reshape(-1, 3)


def _different(pairs: np.ndarray) -> np.ndarray:
    """The different pairs (N, 2) of whole numbers below 2³⁰, in order; numpy takes six times as long over rows."""
    numbers = np.unique((pairs[:, 0] << 31) + pairs[:, 1])
    high = (numbers + (1 << 30)) >> 31
    return np.stack([high, numbers - (high << 31)], 1)


class Ground:
    """Draws the floor and the sky; made once per context."""

    def __init__(self, ctx: Any, taps: int):
        self.floors = [gl.program(ctx, "floor.vert", "floor.frag", TAPS=taps, TOUCHED=n) for n in (1, 0)]
        self.above = gl.program(ctx, "sky.vert", "sky.frag")
        self.ctx, self.streams = ctx, [gl.Stream(ctx), gl.Stream(ctx)]
        self.arrays = [ctx.vertex_array(program, [(stream.buffer, "3f", "position")])
                       for program, stream in zip(self.floors, self.streams)]
        self.sky = ctx.vertex_array(self.above, [])

    def draw(self, touched: np.ndarray, inverse: np.ndarray) -> None:
        """Fill what the bodies leave of the picture.

        touched: triangles of the floor as of `touched_floor`. inverse: (4, 4) of the view-projection.
        """
        # the plain floor lies a hair behind, and so loses wherever the two overlap
        for array, stream, triangles, behind in zip(self.arrays, self.streams, (touched, WHOLE),
                                                    ((0.0, 0.0), (1.0, 4.0))):
            if len(triangles):
                stream.write(triangles.astype(np.float32).tobytes())
                self.ctx.polygon_offset = behind
                array.render(vertices=len(triangles))
        self.ctx.polygon_offset = 0.0, 0.0
        self.above["inverse_view_projection"].write(inverse.T.astype(np.float32).tobytes())
        self.sky.render(vertices=3)

    def release(self) -> None:
        for part in (*self.arrays, self.sky, *self.floors, self.above, *self.streams):
            part.release()
