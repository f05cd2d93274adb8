"""The floor, the sky above it and the boxes on it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from controllers.body import end_positions

from ..scene import Box, Figure
from . import gl, skin
from .view import box_shadows, outlines, scale_of

EXTENT = 250.0
"""How far the floor reaches [m]: beyond, it would be all fog."""


# how far flesh reaches around each joint and bone end, for the outline of a shadow [m]
_GIRTH = np.concatenate([[0.17 if n in ("Hips", "Spine", "Spine1", "Spine2", "Head") else 0.12
                          for n in skin.STANDARD.names], [0.09] * len(skin.STANDARD.end_parents)])


def shaded_floor(figures: Sequence[Figure], origin: np.ndarray) -> np.ndarray:
    """Where on the floor figures' shadows may fall; only there are they looked for.

    Triangles (K, 3) [m] counted from `origin`. They may overlap, as all of them are drawn alike.
    """
    if not figures:
        return np.zeros((0, 3))
    at = np.stack([f.positions for f in figures]).astype(float)
    tips = end_positions(skin.STANDARD, at, np.stack([f.orientations for f in figures]).astype(float))
    scale = scale_of(at, skin.REST, skin.STANDARD.parents).max()
    return _fans(outlines(np.concatenate([at, tips], 1) - origin, _GIRTH * max(scale, 1.0) * 1.1))


def dark_floor(boxes: Sequence[Box], origin: np.ndarray) -> np.ndarray:
    """The boxes' own shadows on the floor: triangles (K, 3) [m] counted from `origin`."""
    return _fans(box_shadows(boxes) - [origin[0], 0.0, origin[2]])


def _fans(rims):
    """Triangles (K, 3) of convex outlines (N, S, 3)."""
    sides = rims.shape[1]
    return rims[:, [c for i in range(1, sides - 1) for c in (0, i, i + 1)]].reshape(-1, 3)


class Ground:
    """Draws the floor and the sky; made once per context."""

    def __init__(self, ctx: Any, taps: int):
        self.floors = [gl.program(ctx, "floor.vert", "floor.frag", TAPS=taps, SUNLIT=n) for n in range(3)]
        self.above = gl.program(ctx, "sky.vert", "sky.frag")
        self.ctx, self.streams = ctx, [gl.Stream(ctx), gl.Stream(ctx), gl.Stream(ctx)]
        self.arrays = [ctx.vertex_array(program, [(stream.buffer, "3f", "position")])
                       for program, stream in zip(self.floors, self.streams)]
        self.plain = EXTENT * np.array([[-1, 0, -1], [-1, 0, 1], [1, 0, 1], [-1, 0, -1], [1, 0, 1], [1, 0, -1]], "f4")
        self.sky = ctx.vertex_array(self.above, [])

    def draw(self, dark: np.ndarray, shaded: np.ndarray, inverse: np.ndarray) -> None:
        """Fill what the bodies leave of the picture.

        dark, shaded: triangles of the floor in a box's shadow, and where figures' shadows may be.
        inverse: (4, 4) of the view-projection.
        """
        # each layer lies a hair behind the one before, and so loses wherever they overlap
        for array, stream, triangles, behind in zip(self.arrays, self.streams, (dark, shaded, self.plain),
                                                    ((0.0, -4.0), (0.0, 0.0), (1.0, 4.0))):
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


class Boxes:
    """Draws the boxes of a scene; made once per context."""

    def __init__(self, ctx: Any, taps: int):
        self.programs = {"body": gl.program(ctx, "box.vert", "box.frag", TAPS=taps),
                         "shadow": gl.program(ctx, "box_shadow.vert", "depth.frag")}
        self.cube, self.stream, self.count = ctx.buffer(_cube().tobytes()), gl.Stream(ctx), 0
        self.arrays = {
            "body": ctx.vertex_array(self.programs["body"], [
                (self.cube, "3f 3f", "position", "normal"),
                (self.stream.buffer, "4f 4f 2f 3f/i", "place", "extent", "turn", "tint")]),
            "shadow": ctx.vertex_array(self.programs["shadow"], [
                (self.cube, "3f 12x", "position"),
                (self.stream.buffer, "4f 4f 2f 12x/i", "place", "extent", "turn")])}

    def prepare(self, boxes: Sequence[Box], origin: np.ndarray) -> None:
        rows = np.zeros((len(boxes), 13), np.float32)
        for row, box in zip(rows, boxes):
            row[0:3], row[4:7] = np.asarray(box.centre) - origin, box.size
            row[8:10], row[10:13] = (np.cos(box.heading), np.sin(box.heading)), box.tint
        self.count = len(boxes)
        if self.count:
            self.stream.write(rows.tobytes())

    def draw(self, kind: str) -> None:
        if self.count:
            self.arrays[kind].render(instances=self.count)

    def release(self) -> None:
        for part in (*self.arrays.values(), *self.programs.values(), self.cube, self.stream):
            part.release()


def _cube() -> np.ndarray:
    """A unit cube about the origin: 36 rows of position and normal."""
    rows = []
    for axis in range(3):
        for sign in (-0.5, 0.5):
            u, v = np.eye(3)[(axis + 1) % 3] * 0.5, np.eye(3)[(axis + 2) % 3] * 0.5
            n = np.eye(3)[axis] * sign
            if sign < 0:
                u, v = v, u
            corners = [n - u - v, n + u - v, n + u + v, n - u + v]
            rows += [np.concatenate([corners[i], 2 * n]) for i in (0, 1, 2, 0, 2, 3)]
    return np.array(rows, np.float32)
