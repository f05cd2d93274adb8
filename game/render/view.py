"""Cameras as matrices, and parts of a picture as pixels. Pure arrays; columns act on (x, y, z, 1)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..scene import Camera

NEAR, FAR = 0.1, 400.0
"""The depth range of a camera [m]."""
FOG = 30.0, 60.0
"""Where the floor is half fog [m]: for cameras near what they look at, and at most."""
TILE = 2.0
"""The floor's pattern repeats every so many metres, and so may the frame's origin move."""

Rectangle = tuple[int, int, int, int]
"""Left, bottom, width, height in pixels, from the bottom-left corner as OpenGL counts."""


def part_of(part: Sequence[float], size: tuple[int, int]) -> tuple[Rectangle, Rectangle]:
    """The pixels of a scene's part (left, top, width, height of the picture, 0 … 1), and those inside its line.

    Parts that share a border in the scene share it in pixels. The line runs along all borders but the
    picture's own, so that between two parts it is twice as wide. ValueError if nothing is left.
    """
    left, top, width, height = part
    if not (-1e-6 <= left <= left + width <= 1.0 + 1e-6 and -1e-6 <= top <= top + height <= 1.0 + 1e-6):
        raise ValueError(f"a part is left, top, width, height within 0 … 1, got {tuple(part)}")
    x0, x1, y0, y1 = (round(v * s) for v, s in ((left, size[0]), (left + width, size[0]),
                                                (1.0 - top - height, size[1]), (1.0 - top, size[1])))
    line = max(1, round(size[1] / 720))
    a0, b0 = x0 + line * (x0 > 0), y0 + line * (y0 > 0)
    a1, b1 = x1 - line * (x1 < size[0]), y1 - line * (y1 < size[1])
    if a1 <= a0 or b1 <= b0:
        raise ValueError(f"a part of {tuple(part)} has no pixels in a picture of {size[0]} × {size[1]}")
    return (x0, y0, x1 - x0, y1 - y0), (a0, b0, a1 - a0, b1 - b0)


def perspective(fov: float, aspect: float, near: float = NEAR, far: float = FAR) -> np.ndarray:
    """The projection (4, 4) for a vertical field of view [rad]; depth −1 at `near`, 1 at `far`."""
    f = 1.0 / np.tan(0.5 * fov)
    return np.array([[f / aspect, 0, 0, 0], [0, f, 0, 0],
                     [0, 0, (far + near) / (near - far), 2 * far * near / (near - far)], [0, 0, -1.0, 0]])


def look_at(eye: np.ndarray, target: np.ndarray, up: np.ndarray) -> np.ndarray:
    """World to camera (4, 4), the camera looking along its −z.

    An eye on its target looks along +Z; an `up` along the line of sight is replaced.
    """
    forward = _unit(np.asarray(target, float) - eye, np.array([0.0, 0.0, 1.0]))
    right = np.cross(forward, up)
    if np.linalg.norm(right) < 1e-6:
        right = np.cross(forward, np.eye(3)[np.argmin(np.abs(forward))])
    right = _unit(right, np.array([1.0, 0.0, 0.0]))
    matrix = np.eye(4)
    matrix[:3, :3] = right, np.cross(right, forward), -forward
    matrix[:3, 3] = -matrix[:3, :3] @ eye
    return matrix


def clear_air(camera: Camera) -> float:
    """Where the floor is half fog [m], seen from a camera: what a distant one looks at stays clear."""
    away = float(np.linalg.norm(np.asarray(camera.target, float) - camera.eye))
    return min(max(FOG[0], 2.0 * away), FOG[1])


def origin_of(camera: Camera) -> np.ndarray:
    """The point (3,) on the floor near the camera from which a frame's positions count.

    It moves by whole repeats of the floor's pattern, which therefore stays where it is.
    """
    near = np.round(np.asarray(camera.eye, float) / TILE) * TILE
    return np.array([near[0], 0.0, near[2]])


def scale_of(positions: np.ndarray, standard: np.ndarray, parents: np.ndarray) -> np.ndarray:
    """The sizes (...) of figures with joints at (..., J, 3) over the standard's (J, 3): sums of bones."""
    def length(at):
        return np.linalg.norm(at[..., 1:, :] - at[..., parents[1:], :], axis=-1).sum(-1)
    return length(positions) / length(standard)


def _unit(v: np.ndarray, spare: np.ndarray) -> np.ndarray:
    length = np.linalg.norm(v)
    return v / length if length > 1e-9 else spare
