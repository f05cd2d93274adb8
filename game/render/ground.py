"""The floor, the sky above it and the boxes on it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..scene import Box
from . import gl
from .view import LightBox

EXTENT = 250.0
"""How far the floor reaches [m]: beyond, it would be all fog."""


def floor_patches(shadow: LightBox | None, eye: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Triangles (K, 3), (M, 3) [m] of the floor within the shadow map's outline and without.

    Only the inner ones pay for shadows. Both share the outline's corners, so no crack shows.
    """
    eye = np.array([eye[0], 0.0, eye[2]])
    if shadow is None:
        outer = eye + EXTENT * np.array([[-1, 0, -1], [-1, 0, 1], [1, 0, 1], [1, 0, -1.0]])
        return np.zeros((0, 3)), outer[[0, 1, 2, 0, 2, 3]]
    inner = shadow.footprint - [0.0, 1.0, 0.0] * shadow.footprint
    area = np.sum(inner[:, 2] * np.roll(inner[:, 0], -1) - inner[:, 0] * np.roll(inner[:, 2], -1))
    if area < 0:  # counter-clockwise seen from above
        inner = inner[::-1]
    centre = inner.mean(0)
    edges = np.roll(inner, -1, 0) - inner
    normals = np.stack([edges[:, 2], -edges[:, 0]], -1) / np.linalg.norm(edges, axis=1, keepdims=True)
    inradius = np.abs(np.sum((inner - centre)[:, [0, 2]] * normals, 1)).min()
    outer = centre + (inner - centre) * (EXTENT + np.linalg.norm(centre - eye)) / inradius
    ring = []
    for i in range(4):
        k = (i + 1) % 4
        ring += [inner[i], outer[i], outer[k], inner[i], outer[k], inner[k]]
    return inner[[0, 1, 2, 0, 2, 3]], np.array(ring)


class Ground:
    """Draws the floor and the sky; made once per context."""

    def __init__(self, ctx: Any, taps: int):
        self.programs = [gl.program(ctx, "floor.vert", "floor.frag", TAPS=taps, SHADOWED=1),
                         gl.program(ctx, "floor.vert", "floor.frag", TAPS=taps, SHADOWED=0),
                         gl.program(ctx, "sky.vert", "sky.frag")]
        self.streams = [gl.Stream(ctx), gl.Stream(ctx)]
        self.arrays = [ctx.vertex_array(program, [(stream.buffer, "3f", "position")])
                       for program, stream in zip(self.programs, self.streams)]
        self.sky = ctx.vertex_array(self.programs[2], [])

    def draw(self, shadow: LightBox | None, eye: np.ndarray, inverse: np.ndarray) -> None:
        """Fill what the bodies leave of the picture. inverse: (4, 4) of the view-projection."""
        for triangles, stream, array in zip(floor_patches(shadow, eye), self.streams, self.arrays):
            if len(triangles):
                stream.write(triangles.astype(np.float32).tobytes())
                array.render(vertices=len(triangles))
        self.programs[2]["inverse_view_projection"].write(inverse.T.astype(np.float32).tobytes())
        self.sky.render(vertices=3)

    def release(self) -> None:
        for part in (*self.arrays, self.sky, *self.programs, *self.streams):
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
