"""The floor, the sky above it and the boxes on it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from controllers.body import end_positions
from controllers.body.rotations import yaw

from ..scene import Box, Figure
from . import gl, skin
from .view import LightBox, outlines, scale_of

EXTENT = 250.0
"""How far the floor reaches [m]: beyond, it would be all fog."""


# how far flesh reaches around each joint and bone end, for the outline of a shadow [m]
_GIRTH = np.concatenate([[0.17 if n in ("Hips", "Spine", "Spine1", "Spine2", "Head") else 0.12
                          for n in skin.STANDARD.names], [0.09] * len(skin.STANDARD.end_parents)])


def shaded_floor(box: LightBox | None, figures: Sequence[Figure], boxes: Sequence[Box], origin: np.ndarray
                 ) -> np.ndarray:
    """Triangles (K, 3) [m] of the floor on which shadows may fall; only these pay for looking.

    They may overlap, as all of them are drawn alike. Counted from `origin`.
    """
    if box is None:
        return np.zeros((0, 3))
    found = []
    if figures:
        at = np.stack([f.positions for f in figures]).astype(float)
        turn = np.stack([f.orientations for f in figures]).astype(float)
        scale = scale_of(at, skin.REST, skin.STANDARD.parents).max()
        tips = end_positions(skin.STANDARD, at, turn)
        found.append(outlines(np.concatenate([at, tips], 1) - origin, _GIRTH * max(scale, 1.0) * 1.1, box.axes))
    if boxes:
        half = 0.5 * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        corners = np.stack([(half * b.size) @ yaw(b.heading).T + b.centre for b in boxes])
        found.append(outlines(corners - origin, np.full(8, 0.02), box.axes))
    fans = [rows[:, [0, i, i + 1]] for rows in found for i in range(1, rows.shape[1] - 1)]
    return np.concatenate(fans).reshape(-1, 3)


class Ground:
    """Draws the floor and the sky; made once per context."""

    def __init__(self, ctx: Any, taps: int):
        self.programs = [gl.program(ctx, "floor.vert", "floor.frag", TAPS=taps, SHADOWED=1),
                         gl.program(ctx, "floor.vert", "floor.frag", TAPS=taps, SHADOWED=0),
                         gl.program(ctx, "sky.vert", "sky.frag")]
        self.ctx, self.stream = ctx, gl.Stream(ctx)
        corners = EXTENT * np.array([[-1, 0, -1], [-1, 0, 1], [1, 0, 1], [-1, 0, -1], [1, 0, 1], [1, 0, -1]], "f4")
        self.plain = ctx.buffer(corners.tobytes())
        self.arrays = [ctx.vertex_array(program, [(buffer, "3f", "position")])
                       for program, buffer in zip(self.programs, (self.stream.buffer, self.plain))]
        self.sky = ctx.vertex_array(self.programs[2], [])

    def draw(self, shaded: np.ndarray, inverse: np.ndarray) -> None:
        """Fill what the bodies leave of the picture.

        shaded: (K, 3) triangles from `shaded_floor`. inverse: (4, 4) of the view-projection.
        """
        if len(shaded):
            self.stream.write(shaded.astype(np.float32).tobytes())
            self.arrays[0].render(vertices=len(shaded))
        # the plain floor lies a hair behind, and so loses wherever the other is
        self.ctx.polygon_offset = 1.0, 4.0
        self.arrays[1].render(vertices=6)
        self.ctx.polygon_offset = 0.0, 0.0
        self.programs[2]["inverse_view_projection"].write(inverse.T.astype(np.float32).tobytes())
        self.sky.render(vertices=3)

    def release(self) -> None:
        for part in (*self.arrays, self.sky, *self.programs, self.stream, self.plain):
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
