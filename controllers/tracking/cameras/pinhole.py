"""A camera with a lens, as OpenCV has it: x to the right, y down, z ahead, pixels counted from the middle of the first one.

Distortion is Brown's: radial k1, k2, k3 and tangential p1, p2.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from ...compiled import kernel

BEYOND = 1.3
"""So much further out than the picture's corners is a lens still as calibrated; beyond, its distortion stays as there."""


@dataclass(frozen=True, eq=False)
class Lens:
    """A calibrated camera. size: width, height in pixels. matrix: (3, 3) intrinsics. distortion: (5,) k1, k2, p1, p2, k3.

    rotation, translation: (3, 3), (3,) [m] from the world (Y up) to the camera. ValueError for what is no camera.
    """

    name: str
    size: tuple[int, int]
    matrix: np.ndarray
    rotation: np.ndarray
    translation: np.ndarray
    distortion: np.ndarray

    def __post_init__(self):
        for name, shape in (("matrix", (3, 3)), ("rotation", (3, 3)), ("translation", (3,)), ("distortion", (5,))):
            value = np.array(getattr(self, name), float)
            if value.shape != shape or not np.isfinite(value).all():
                raise ValueError(f"{name}: needs {' × '.join(map(str, shape))} finite numbers")
            value.setflags(write=False)
            object.__setattr__(self, name, value)
        if not all(16 <= side <= 16384 for side in self.size):
            raise ValueError(f"size: needs a width and a height from 16 to 16384 pixels, not {self.size[0]} × {self.size[1]}")
        m = self.matrix
        if not (m[0, 0] > 0 and m[1, 1] > 0 and abs(m[0, 1]) <= 1e-3 * m[0, 0] and np.allclose(m[[1, 2, 2], [0, 0, 1]], 0) and np.isclose(m[2, 2], 1)):
            raise ValueError("matrix: needs [fx 0 cx; 0 fy cy; 0 0 1] with fx and fy above 0 and no skew")
        r = self.rotation
        if np.abs(r @ r.T - np.eye(3)).max() > 1e-4 or np.linalg.det(r) < 0:
            raise ValueError("rotation: its matrix is no rotation")

    @property
    def eye(self) -> np.ndarray:
        """Where it is (3,) [m]."""
        return -self.rotation.T @ self.translation

    @cached_property
    def numbers(self) -> np.ndarray:
        """All that a kernel needs (22,): fx, fy, cx, cy, rotation by rows, translation, distortion, the limit of r²."""
        m = self.matrix
        return np.concatenate([[m[0, 0], m[1, 1], m[0, 2], m[1, 2]], self.rotation.ravel(), self.translation, self.distortion,
                               [self._limit()]])

    def project(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Pixels (..., 2) and depths (...) [m] of points (..., 3) [m]; a depth of 0 or less is behind the camera."""
        points = np.asarray(points, float)
        flat = np.empty((points[..., 0].size, 3))
        project_kernel(np.ascontiguousarray(points.reshape(-1, 3)), self.numbers, flat)
        flat = flat.reshape(*points.shape[:-1], 3)
        return flat[..., :2], flat[..., 2]

    def directions(self, pixels: np.ndarray) -> np.ndarray:
        """Directions (..., 3) in the world, unit length, along which pixels (..., 2) look; distortion undone by Newton's way."""
        pixels = np.asarray(pixels, float)
        out = np.empty((pixels[..., 0].size, 3))
        direction_kernel(np.ascontiguousarray(pixels.reshape(-1, 2)), self.numbers, out)
        return out.reshape(*pixels.shape[:-1], 3)

    def rays(self, pixels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The Plücker lines (n, m) through pixels (..., 2): unit directions and moments (..., 3), m = eye × n."""
        directions = self.directions(pixels)
        return directions, np.cross(self.eye, directions)

    def scaled(self, width: int) -> Lens:
        """The same camera with pictures so wide, its height in proportion."""
        share = width / self.size[0]
        matrix = self.matrix.copy()
        matrix[:2, :2] *= share
        matrix[:2, 2] = (matrix[:2, 2] + 0.5) * share - 0.5  # a pixel's middle is a whole number
        return Lens(self.name, (width, round(self.size[1] * share)), matrix, self.rotation, self.translation, self.distortion)

    def _limit(self) -> float:
        """The r² up to which the distortion is taken as it is."""
        m, (width, height) = self.matrix, self.size
        x = max(abs(-0.5 - m[0, 2]), abs(width - 0.5 - m[0, 2])) / m[0, 0]
        y = max(abs(-0.5 - m[1, 2]), abs(height - 0.5 - m[1, 2])) / m[1, 1]
        return float(BEYOND**2 * (x * x + y * y))


def looking_at(name: str, size: tuple[int, int], eye: ArrayLike, target: ArrayLike, fov: float,
               distortion: ArrayLike = (0, 0, 0, 0, 0)) -> Lens:
    """A camera at `eye` that looks at `target` [m], upright. fov: vertical field of view [rad]. ValueError as of `Lens`."""
    ahead = np.asarray(target, float) - np.asarray(eye, float)
    if not np.linalg.norm(ahead) > 1e-6:
        raise ValueError("target: is where the camera is")
    if not 0.01 <= fov <= 2.8:
        raise ValueError(f"fov: needs 0.6 to 160 degrees, not {np.degrees(fov):g}")
    ahead /= np.linalg.norm(ahead)
    right = np.cross(ahead, [0.0, 1.0, 0.0])
    right = right / np.linalg.norm(right) if np.linalg.norm(right) > 1e-6 else np.array([-1.0, 0.0, 0.0])
    rotation = np.stack([right, np.cross(ahead, right), ahead])
    focal = 0.5 * size[1] / np.tan(0.5 * fov)
    matrix = np.array([[focal, 0, 0.5 * (size[0] - 1)], [0, focal, 0.5 * (size[1] - 1)], [0, 0, 1.0]])
    return Lens(name, size, matrix, rotation, -rotation @ np.asarray(eye, float), np.asarray(distortion, float))


def ring(count: int, radius: float, height: float, target: Sequence[float], size: tuple[int, int], fov: float) -> tuple[Lens, ...]:
    """So many cameras on a circle about a target, the first ahead and to the left of it."""
    turns = 2 * np.pi * (np.arange(count) + 0.5) / count
    return tuple(looking_at(f"cam{k + 1:02d}", size, (target[0] + radius * np.sin(a), height, target[2] + radius * np.cos(a)), target, fov)
                 for k, a in enumerate(turns))


@kernel
def _bend(x, y, n):
    """Where a lens bends a place on the plane at depth 1 to, and the derivative: u, v, du/dx, du/dy = dv/dx, dv/dy."""
    k1, k2, p1, p2, k3, limit = n[16], n[17], n[18], n[19], n[20], n[21]
    r2 = x * x + y * y
    s, share = r2, 1.0
    slope = 2.0 * (k1 + s * (2.0 * k2 + 3.0 * k3 * s))
    if r2 > limit:  # from there on radially as it is, and tangential terms, which grow with the square, as the place does
        s, share, slope = limit, math.sqrt(limit / r2), 0.0
    radial = 1.0 + s * (k1 + s * (k2 + s * k3))
    return (x * radial + share * (2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x)), y * radial + share * (p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y),
            radial + slope * x * x + share * (2.0 * p1 * y + 6.0 * p2 * x), slope * x * y + share * (2.0 * p1 * x + 2.0 * p2 * y),
            radial + slope * y * y + share * (6.0 * p1 * y + 2.0 * p2 * x))


@kernel(nogil=True)
def project_kernel(points, n, out):
    """Write pixels and depths (N, 3) of points (N, 3) [m] through a camera's `numbers`."""
    for i in range(len(points)):
        a, b, c = points[i, 0], points[i, 1], points[i, 2]
        x = n[4] * a + n[5] * b + n[6] * c + n[13]
        y = n[7] * a + n[8] * b + n[9] * c + n[14]
        z = n[10] * a + n[11] * b + n[12] * c + n[15]
        deep = z if abs(z) > 1e-9 else 1e-9
        u, v, _, _, _ = _bend(x / deep, y / deep, n)
        out[i, 0], out[i, 1], out[i, 2] = n[0] * u + n[2], n[1] * v + n[3], z


@kernel(nogil=True)
def direction_kernel(pixels, n, out):
    """Write the unit directions (N, 3) in the world along which pixels (N, 2) look, by Newton's way."""
    for i in range(len(pixels)):
        a, b = (pixels[i, 0] - n[2]) / n[0], (pixels[i, 1] - n[3]) / n[1]
        x, y = a, b
        for _ in range(20):
            u, v, xx, xy, yy = _bend(x, y, n)
            e, f, det = u - a, v - b, xx * yy - xy * xy
            if abs(det) < 1e-9:
                break
            x, y = x - (yy * e - xy * f) / det, y - (xx * f - xy * e) / det
            if e * e + f * f < 1e-26:
                break
        size = math.sqrt(x * x + y * y + 1.0)
        for k in range(3):
            out[i, k] = (n[4 + k] * x + n[7 + k] * y + n[10 + k]) / size
