"""Cameras of films that nobody holds: fixed ones, and dollies on smooth rails."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from ..scene import Camera
from .line_of_sight import above_floor

_PIECES = 128
"""Samples between two points of a rail, from which its length is told."""


def fixed(eye, target, fov: float = 0.8) -> Camera:
    """A camera that stands still; eye, target: (3,) [m], the eye kept above the floor."""
    return Camera(above_floor(eye), np.asarray(target, float), fov=fov)


def dolly(rail: Sequence, target, progress: float, fov: float = 0.8) -> Camera:
    """A camera on a rail (see `on_rail`), gently set off and stopped; progress 0 … 1."""
    u = min(max(progress, 0.0), 1.0)
    return fixed(on_rail(rail, u * u * (3.0 - 2.0 * u)), target, fov)


def on_rail(rail: Sequence, part: float) -> np.ndarray:
    """The point (3,) [m] at `part` (0 … 1) of the length of a smooth rail through points (N, 3).

    A cubic spline over the centripetal parameter of Catmull and Rom (Yuksel et al. 2011), which
    makes no loops, gone along at one speed however the points are spaced.
    """
    lengths, points = _rail(tuple(tuple(map(float, point)) for point in rail))
    return np.array([np.interp(part * lengths[-1], lengths, axis) for axis in points.T])


@lru_cache(maxsize=64)
def _rail(rail: tuple) -> tuple[np.ndarray, np.ndarray]:
    """Lengths (M,) [m] from the start and points (M, 3) along a rail."""
    from scipy.interpolate import CubicSpline

    points = np.array(rail)
    apart = np.linalg.norm(np.diff(points, axis=0), axis=-1)
    points = points[np.concatenate([[True], apart > 1e-9])]
    if len(points) == 1:
        return np.array([0.0, 1.0]), np.repeat(points, 2, 0)
    knots = np.concatenate([[0.0], np.cumsum(np.sqrt(apart[apart > 1e-9]))])
    spline = CubicSpline(knots, points, bc_type="natural")
    sampled = spline(np.linspace(0.0, knots[-1], _PIECES * (len(points) - 1) + 1))
    steps = np.linalg.norm(np.diff(sampled, axis=0), axis=-1)
    return np.concatenate([[0.0], np.cumsum(steps)]), sampled
