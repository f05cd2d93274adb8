"""What explains the motion: bones, foot contacts, where somebody was and is going, and whatever is sketched."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from gambol.controllers.body import HEEL

from ..scene import Camera, Figure, Overlays
from . import gl, skin
from .sketches import sketched
from .view import scale_of

LIFT = 0.006
"""Marks lie this high above the floor [m], so that the two do not fight for the depth buffer."""
LEFT, RIGHT, MIDDLE = (0.12, 0.55, 0.95), (0.95, 0.45, 0.10), (0.85, 0.85, 0.80)
AHEAD = (0.85, 0.50, 0.02)
DISC, BAND, DASHES = 0.0, 1.0, 2.0
"""What a mark is; see mark.frag. `sketches` has more of them."""
THIN = 4.0
"""No trail or path is drawn thinner than this [pixels], from however far above it is seen."""
SOLE = 0.02
"""How high heels and balls stand over their floor [m]."""
_SIDES = np.array([LEFT if n.startswith("Left") else RIGHT if n.startswith("Right") else MIDDLE
                   for n in skin.STANDARD.names])


def bones(figure: Figure) -> np.ndarray:
    """A figure's bones, rows (B, 12): start, direction and half width [m], linear RGB."""
    at, turn = np.asarray(figure.positions, float), np.asarray(figure.orientations, float)
    parents = skin.STANDARD.parents[1:]
    scale = float(scale_of(at, skin.REST, skin.STANDARD.parents))
    ends = skin.STANDARD.end_parents
    start = np.concatenate([at[parents], at[ends]])
    tips = at[ends] + np.einsum("eij,ej->ei", turn[ends], skin.STANDARD.end_offsets) * scale
    along = np.concatenate([at[1:], tips]) - start
    frame = np.concatenate([turn[parents], turn[ends]])
    length = np.linalg.norm(along, axis=1, keepdims=True)
    unit = along / np.maximum(length, 1e-9)
    # the bone's width turns with its joint, so that a twist shows
    pick = np.abs(np.einsum("bij,bi->bj", frame, unit)).argmin(1)
    aside = frame[np.arange(len(frame)), :, pick]
    aside = aside - unit * np.sum(unit * aside, 1, keepdims=True)
    aside /= np.maximum(np.linalg.norm(aside, axis=1, keepdims=True), 1e-9)
    width = np.clip(0.11 * length, 0.006, 0.026 * max(scale, 0.1))
    colour = np.concatenate([_SIDES[1:], _SIDES[ends]])
    return np.concatenate([start, along, aside * width, colour], 1)


def discs(figure: Figure) -> np.ndarray:
    """Marks (K, 10) under heels and balls in contact: two triangles a disc."""
    at, turn = np.asarray(figure.positions, float), np.asarray(figure.orientations, float)
    scale = float(scale_of(at, skin.REST, skin.STANDARD.parents))
    rows, square = [], np.array([[-1, -1], [-1, 1], [1, 1], [-1, -1], [1, 1], [1, -1.0]])
    for side, (foot, toe), colour in ((0, ("LeftFoot", "LeftToe"), LEFT), (2, ("RightFoot", "RightToe"), RIGHT)):
        foot, toe = skin.STANDARD.index(foot), skin.STANDARD.index(toe)
        for k, place in enumerate((at[foot] + turn[foot] @ HEEL * scale, at[toe])):
            if figure.contacts[side + k]:
                radius = (0.075 if k == 0 else 0.085) * scale
                corners = np.zeros((6, 10))
                corners[:, [0, 2]] = place[[0, 2]] + square * radius
                corners[:, 1] = max(place[1] - SOLE * scale, 0.0) + LIFT
                corners[:, 3:6], corners[:, 6], corners[:, 7:9] = colour, 0.85, square
                rows.append(corners)
    return np.concatenate(rows) if rows else np.zeros((0, 10))


def smooth(points: np.ndarray, pieces: int = 4) -> np.ndarray:
    """A curve (M, 3) through the points (N, 3): centripetal enough for footpaths, no doubled points."""
    points = np.asarray(points, float)
    points = points[np.isfinite(points).all(1)]
    if len(points) > 1:
        keep = [0]
        for i in range(1, len(points)):
            if np.linalg.norm(points[i] - points[keep[-1]]) > 2e-3:
                keep.append(i)
        points = points[keep]
    if len(points) < 3:
        return points
    before = np.concatenate([2 * points[:1] - points[1:2], points, 2 * points[-1:] - points[-2:-1]])
    u = (np.arange(pieces) / pieces)[None, :, None]
    a, b, c, d = (before[i:len(before) - 3 + i, None] for i in range(4))
    curve = 0.5 * (2 * b + (c - a) * u + (2 * a - 5 * b + 4 * c - d) * u**2 + (3 * b - a - 3 * c + d) * u**3)
    return np.concatenate([curve.reshape(-1, 3), points[-1:]])


def ribbon(points: np.ndarray, colour, opacity: tuple[float, float], half: float, kind: float, dash: float = 0.12,
           eye: np.ndarray | None = None, metre: float = math.inf) -> np.ndarray:
    """Marks (K, 10) of a flat band along points (N, 3) [m]; opacity: its ends' two values.

    eye: (3,) from where it is seen, no thinner than THIN; metre: how many pixels a metre has that is one metre away.
    """
    points = smooth(points)
    if len(points) < 2:
        return np.zeros((0, 10))
    flat = points[:, [0, 2]]
    run = np.gradient(flat, axis=0)
    run /= np.maximum(np.linalg.norm(run, axis=1, keepdims=True), 1e-9)
    away = 0.0 if eye is None else np.linalg.norm(points - eye, axis=1, keepdims=True)
    across = np.stack([run[:, 1], -run[:, 0]], 1) * np.maximum(half, 0.5 * THIN * away / metre)
    far = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(flat, axis=0), axis=1))])
    edges = np.zeros((len(points), 2, 10))
    for k, sign in enumerate((-1.0, 1.0)):
        edges[:, k, [0, 2]] = flat + sign * across
        edges[:, k, 8] = sign
    edges[..., 1] = np.maximum(points[:, 1:2], LIFT)
    edges[..., 3:6], edges[..., 7], edges[..., 9] = colour, (far / dash)[:, None], kind
    edges[..., 6] = np.linspace(opacity[0], opacity[1], len(points))[:, None]
    a, b, c, d = edges[:-1, 0], edges[:-1, 1], edges[1:, 1], edges[1:, 0]
    return np.stack([a, b, c, a, c, d], 1).reshape(-1, 10)


def marks(figures: Sequence[Figure], shown: Overlays, eye: np.ndarray | None = None, metre: float = math.inf) -> np.ndarray:
    """All that lies on the floor: rows (K, 10) of position [m], linear RGB, opacity, shape (3); eye, metre: see `ribbon`."""
    rows = [np.zeros((0, 10))]
    for figure in figures:
        tint = np.asarray(figure.tint, float)
        if shown.trail:
            rows.append(ribbon(figure.trail, tint**2.2, (0.25, 1.0), 0.028, BAND, eye=eye, metre=metre))
        if shown.path:
            rows.append(ribbon(figure.path, AHEAD, (1.0, 0.35), 0.028, DASHES, eye=eye, metre=metre))
        if shown.contacts:
            rows.append(discs(figure))
    return np.concatenate(rows)


class OverlayPass:
    """Draws bones and marks; made once per context."""

    def __init__(self, ctx: Any):
        self.programs = [gl.program(ctx, "bone.vert", "bone.frag"), gl.program(ctx, "mark.vert", "mark.frag"),
                         gl.program(ctx, "mark.vert", "mark.frag", THROUGH=1)]
        self.shape, self.bones, self.marks = ctx.buffer(_octahedron().tobytes()), gl.Stream(ctx), gl.Stream(ctx)
        self.bone_array = ctx.vertex_array(self.programs[0], [
            (self.shape, "3f 3f", "position", "normal"),
            (self.bones.buffer, "3f 3f 3f 3f/i", "start", "along", "aside", "tint")])
        self.mark_arrays = [ctx.vertex_array(program, [(self.marks.buffer, "3f 4f 3f", "position", "tint", "shape")])
                            for program in self.programs[1:]]

    def draw_bones(self, figures: Sequence[Figure], origin: np.ndarray) -> None:
        if not figures:
            return
        rows = np.concatenate([bones(figure) for figure in figures])
        rows[:, :3] -= origin
        self.bones.write(rows.astype(np.float32).tobytes())
        self.bone_array.render(instances=len(rows))

    def draw_marks(self, figures: Sequence[Figure], shown: Overlays, origin: np.ndarray, camera: Camera,
                   metre: float) -> None:
        """metre: how many pixels a metre has that is one metre away."""
        within, through = sketched(figures, shown, camera, metre)
        first = np.concatenate([marks(figures, shown, np.asarray(camera.eye, float), metre), within])
        rows = np.concatenate([first, through])
        if len(rows):
            rows[:, :3] -= origin
            self.marks.write(rows.astype(np.float32).tobytes())
            for array, start, count in zip(self.mark_arrays, (0, len(first)), (len(first), len(through))):
                if count:
                    array.render(vertices=count, first=start)

    def release(self) -> None:
        for part in (self.bone_array, *self.mark_arrays, *self.programs, self.shape, self.bones, self.marks):
            part.release()


def _octahedron() -> np.ndarray:
    """A bone along +Y, 24 rows of position and normal, widest a seventh of the way up."""
    ring = [np.array([x, 0.14, z]) for x, z in ((1, 0), (0, 1), (-1, 0), (0, -1))]
    rows = []
    for i in range(4):
        a, b = ring[i], ring[(i + 1) % 4]
        for triangle in ((np.zeros(3), a, b), (np.array([0.0, 1.0, 0.0]), b, a)):
            n = np.cross(triangle[1] - triangle[0], triangle[2] - triangle[0])
            rows += [np.concatenate([p, n / np.linalg.norm(n)]) for p in triangle]
    return np.array(rows, np.float32)
