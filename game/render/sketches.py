"""Sketches as triangles: lines, arrows, dots and patches in the air or lying on something.

Rows (K, 10) of position [m], linear RGB, opacity and shape, as the shader mark.frag takes them.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..scene import Arrow, Camera, Dot, Figure, Line, Overlays, Patch

DASHES, RIMMED, HEAD, DOT, QUARTERS, FILL, BALL, RING = 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0
"""What a mark is; see mark.frag."""
LEAST = 2.2
"""No line is drawn thinner than this [pixels]."""
DASH = 0.07
"""From one dash to the next [m]."""
UP = np.array([0.0, 1.0, 0.0])
_SQUARE = np.array([(-1, -1), (-1, 1), (1, 1), (-1, -1), (1, 1), (1, -1)], float)


def sketched(figures: Sequence[Figure], shown: Overlays, camera: Camera, metre: float) -> tuple[np.ndarray, np.ndarray]:
    """The rows of all sketches whose layer is shown: those that bodies may hide, and those that they can't.

    metre: how many pixels a metre has that is one metre away.
    """
    rows: tuple[list, list] = [np.zeros((0, 10))], [np.zeros((0, 10))]
    for sketch in (s for figure in figures for s in figure.sketches):
        if getattr(shown, sketch.layer):
            through = isinstance(sketch, Arrow) or getattr(sketch, "through", False)
            rows[through].append(triangles(sketch, np.asarray(camera.eye, float), metre))
    return np.concatenate(rows[0]), np.concatenate(rows[1])


def triangles(sketch, eye: np.ndarray, metre: float) -> np.ndarray:
    """One sketch, seen from `eye` (3,)."""
    match sketch:
        case Line():
            return _line(sketch, eye, metre)
        case Arrow():
            return _arrow(sketch, eye, metre)
        case Dot():
            return _dot(sketch, eye, metre)
        case Patch():
            corners = np.asarray(sketch.corners, float)
            if len(corners) < 3 or not np.isfinite(corners).all():
                return np.zeros((0, 10))
            fan = np.stack([np.broadcast_to(corners[0], corners[2:].shape), corners[1:-1], corners[2:]], 1)
            return _rows(fan.reshape(-1, 3), sketch.tint, sketch.opacity, np.zeros((3 * len(fan), 2)), FILL)
    raise TypeError(f"no sketch: {sketch!r}")


def _rows(places, tint, opacity, shape, kind: float) -> np.ndarray:
    rows = np.empty((len(places), 10))
    rows[:, :3], rows[:, 3:6], rows[:, 6], rows[:, 7:9], rows[:, 9] = places, tint, opacity, shape, kind
    return rows


def _line(line: Line, eye: np.ndarray, metre: float) -> np.ndarray:
    points = np.asarray(line.points, float)
    if len(points) < 2 or not np.isfinite(points).all():
        return np.zeros((0, 10))
    run = np.gradient(points, axis=0)
    if np.allclose(points[0], points[-1]):  # it closes
        run[0] = run[-1] = points[1] - points[-2]
    sight = eye - points
    away = np.linalg.norm(sight, axis=1, keepdims=True)
    across = _unit(np.cross(run, UP if line.flat else sight))
    half = np.maximum(0.5 * line.width, 0.5 * LEAST * away / metre)
    far = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    opacity = np.linspace(*line.opacity, len(points))
    edges = np.empty((len(points), 2, 10))
    for k, side in enumerate((-1.0, 1.0)):
        shape = np.stack([far / DASH, np.full(len(points), side)], 1)
        edges[:, k] = _rows(points + side * half * across, line.tint, opacity, shape, DASHES if line.dashed else RIMMED)
    a, b, c, d = edges[:-1, 0], edges[:-1, 1], edges[1:, 1], edges[1:, 0]
    return np.stack([a, b, c, a, c, d], 1).reshape(-1, 10)


def _arrow(arrow: Arrow, eye: np.ndarray, metre: float) -> np.ndarray:
    start, along = np.asarray(arrow.start, float), np.asarray(arrow.along, float)
    length = float(np.linalg.norm(along))
    if not np.isfinite(length) or length < 1e-3:
        return np.zeros((0, 10))
    unit = along / length
    width = max(arrow.width, LEAST * float(np.linalg.norm(eye - start)) / metre)
    head = min(3.2 * width, 0.6 * length)
    neck = start + (length - head) * unit
    across = _unit(np.cross(unit, eye - neck)[None])[0] * 0.55 * head
    shaft = _line(Line(arrow.layer, np.stack([start, neck]), arrow.tint, min(width, 0.35 * head)), eye, metre)
    u, v = 0.5 + 0.5 * _SQUARE[:, :1], _SQUARE[:, 1:]
    return np.concatenate([shaft, _rows(neck + u * head * unit + v * across, arrow.tint, 1.0, np.hstack([u, v]), HEAD)])


def _dot(dot: Dot, eye: np.ndarray, metre: float) -> np.ndarray:
    place = np.asarray(dot.place, float)
    if not np.isfinite(place).all():
        return np.zeros((0, 10))
    sight = eye - place
    if dot.flat:
        right, up = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
    else:
        right = _unit(np.cross(UP, sight)[None])[0]
        up = _unit(np.cross(sight, right)[None])[0]
    radius = max(dot.radius, LEAST * float(np.linalg.norm(sight)) / metre)
    at = place + radius * (_SQUARE[:, :1] * right + _SQUARE[:, 1:] * up)
    kind = QUARTERS if dot.quartered else {"disc": DOT, "ball": BALL, "ring": RING}[dot.look]
    return _rows(at, dot.tint, dot.opacity, _SQUARE, kind)


def _unit(v: np.ndarray) -> np.ndarray:
    return v / np.maximum(np.linalg.norm(v, axis=1, keepdims=True), 1e-9)
