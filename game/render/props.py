"""What stands on the stage: boxes and pillars, which are solid, and goals, which are light."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..scene import Box, Goal, Pillar
from . import gl
from .occlusion import solid_rows

SIDES = 64
"""Of a pillar."""
COLUMN = 2.4
"""Height of a goal's column of light [m]."""


class Solids:
    """Draws boxes and pillars; made once per context."""

    def __init__(self, ctx: Any, taps: int):
        self.programs = {"body": gl.program(ctx, "solid.vert", "solid.frag", TAPS=taps),
                         "shadow": gl.program(ctx, "solid_shadow.vert", "depth.frag")}
        shapes = {Box: _cube(), Pillar: _cylinder()}
        self.shapes = {kind: ctx.buffer(shape.astype(np.float32).tobytes()) for kind, shape in shapes.items()}
        self.streams, self.counts = {kind: gl.Stream(ctx) for kind in shapes}, dict.fromkeys(shapes, 0)
        self.arrays = {(kind, use): ctx.vertex_array(program, [
            (self.shapes[kind], "3f", "position"),
            (self.streams[kind].buffer, "4f 4f 4f 3f/i", "place", "half_size", "turn", "tint") if use == "body" else
            (self.streams[kind].buffer, "4f 4f 4f 12x/i", "place", "half_size", "turn")])
            for kind in shapes for use, program in self.programs.items()}

    def prepare(self, solids: Sequence[Box | Pillar], origin: np.ndarray) -> None:
        for kind, stream in self.streams.items():
            chosen = [solid for solid in solids if isinstance(solid, kind)]
            self.counts[kind] = len(chosen)
            if chosen:
                rows = np.concatenate([solid_rows(chosen), [solid.tint for solid in chosen]], 1)
                rows[:, :3] -= origin
                stream.write(rows.astype(np.float32).tobytes())

    def draw(self, use: str) -> None:
        """Draw the prepared solids: "body", or "shadow" (into the shadow map)."""
        for kind, count in self.counts.items():
            if count:
                self.arrays[kind, use].render(instances=count)

    def release(self) -> None:
        for part in (*self.arrays.values(), *self.programs.values(), *self.shapes.values(), *self.streams.values()):
            part.release()


class Goals:
    """Draws goals, blended over all that is solid; made once per context."""

    def __init__(self, ctx: Any):
        self.program, self.stream = gl.program(ctx, "goal.vert", "goal.frag"), gl.Stream(ctx)
        square = np.array([[-1, 0, -1], [-1, 0, 1], [1, 0, 1], [-1, 0, -1], [1, 0, 1], [1, 0, -1]]) * 1.15
        self.shape = ctx.buffer(np.concatenate([square, _tube()]).astype(np.float32).tobytes())
        self.array = ctx.vertex_array(self.program, [
            (self.shape, "3f", "position"), (self.stream.buffer, "4f 4f/i", "place", "tint")])

    def draw(self, goals: Sequence[Goal], origin: np.ndarray) -> None:
        if goals:
            rows = np.array([(*(np.array(goal.place) - origin), goal.radius, *goal.tint, COLUMN) for goal in goals])
            self.stream.write(rows.astype(np.float32).tobytes())
            self.array.render(instances=len(goals))

    def release(self) -> None:
        for part in (self.array, self.program, self.stream, self.shape):
            part.release()


def _cube() -> np.ndarray:
    """The cube −1 … 1: 36 corners of triangles, counter-clockwise from outside."""
    rows = []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            n, u, v = (np.eye(3)[(axis + k) % 3] for k in range(3))
            u = u * sign
            corners = [n * sign - u - v, n * sign + u - v, n * sign + u + v, n * sign - u + v]
            rows += [corners[i] for i in (0, 1, 2, 0, 2, 3)]
    return np.array(rows)


def _tube() -> np.ndarray:
    """A cylinder's wall of radius 1, −1 … 1 high: triangles, counter-clockwise from outside."""
    angle = 2.0 * np.pi * np.arange(SIDES + 1) / SIDES
    ring = np.stack([np.sin(angle), np.zeros(SIDES + 1), np.cos(angle)], 1)
    low, high = ring - [0, 1, 0], ring + [0, 1, 0]
    return np.stack([low[:-1], low[1:], high[1:], low[:-1], high[1:], high[:-1]], 1).reshape(-1, 3)


def _cylinder() -> np.ndarray:
    """The tube with its two lids."""
    wall = _tube().reshape(-1, 6, 3)
    low, low_next, high_next, _, _, high = np.swapaxes(wall, 0, 1)
    middle = np.zeros_like(low)
    lids = [np.stack([middle + [0, 1, 0], high, high_next], 1), np.stack([middle - [0, 1, 0], low_next, low], 1)]
    return np.concatenate([wall.reshape(-1, 3), *(lid.reshape(-1, 3) for lid in lids)])
