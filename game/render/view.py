"""Cameras and the sun's view as matrices. Pure arrays; columns act on (x, y, z, 1)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from controllers.body.rotations import yaw

from ..scene import Box, Camera, Figure

NEAR, FAR = 0.1, 400.0
"""The depth range of a camera [m]."""
SUN = np.array([0.62, 0.75, -0.22]) / np.linalg.norm([0.62, 0.75, -0.22])
"""Towards the sun."""
_SIDE = np.cross([0.0, 1.0, 0.0], SUN) / np.linalg.norm(np.cross([0.0, 1.0, 0.0], SUN))
AXES = np.stack([_SIDE, np.cross(SUN, _SIDE), SUN])
"""The shadow map's two sides, of which the first is level, and the sun: rows."""
SIZE_STEP = 0.5
"""The shadow map of several figures grows by steps [m]."""
TILE = 2.0
"""The floor's pattern repeats every so many metres, and so may the frame's origin move."""
SHADOW_RANGE = 22.0
"""Figures nearer than this to the camera or to its target [m] cast shadows."""
REACH = 1.28
"""Radius [m] of the ball around a standard human's hips that holds any pose."""


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


def origin_of(camera: Camera) -> np.ndarray:
    """The point (3,) on the floor near the camera from which a frame's positions count.

    It moves by whole repeats of the floor's pattern, which therefore stays where it is.
    """
    near = np.round(np.asarray(camera.eye, float) / TILE) * TILE
    return np.array([near[0], 0.0, near[2]])


@dataclass(frozen=True, eq=False)
class LightBox:
    """What the shadow map covers.

    matrix: (4, 4) world to map, 0 … 1 in all three. texel: [m] the larger side of a texel.
    size: (2,) [m] what the map's sides measure.
    """

    matrix: np.ndarray
    texel: float
    size: np.ndarray


def light_box(camera: Camera, figures: Sequence[Figure], boxes: Sequence[Box], texels: int,
              origin: np.ndarray | None = None) -> LightBox | None:
    """The smallest light box around the figures nearby, or None where there is nobody.

    Its size comes in steps and its place in whole texels, so that a shadow's edge does not crawl
    as the figure moves. It follows from the scene alone: the same scene gives the same box.
    Boxes do not widen it, or a wall would make all shadows coarse; they only find room in its depth.
    The result counts from `origin` (3,) [m], on the floor; by default from the world's.
    """
    balls = [ball for ball in map(_ball, figures) if _near(camera, ball[0])]
    if not balls:
        return None
    centres, radii = np.array([b[0] for b in balls]), np.array([b[1] for b in balls])
    seen = centres @ AXES.T
    low, high = (seen - radii[:, None]).min(0), (seen + radii[:, None]).max(0)
    size = (high - low)[:2]
    if len(balls) > 1:
        size = np.ceil(size / SIZE_STEP - 1e-6) * SIZE_STEP
    size = size * (1.0 + 2.0 / texels)  # room for moving by less than a texel
    texel = size / texels
    corner = np.floor((0.5 * (low + high)[:2] - 0.5 * size) / texel) * texel
    # where the box's four edges, followed along the sun, meet the floor
    square = corner + size * np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    along = -(square @ AXES[:2, 1]) / AXES[2, 1]
    tops = [high[2]] + [box_corners(box) @ AXES[2] for box in boxes]
    bottom, top = min(along.min(), low[2]) - 0.1, np.concatenate([np.ravel(t) for t in tops]).max() + 0.1
    shift = AXES @ (np.zeros(3) if origin is None else origin)
    corner, bottom, top = corner - shift[:2], bottom - shift[2], top - shift[2]
    matrix = np.eye(4)
    matrix[:2, :3] = AXES[:2] / size[:, None]
    matrix[:2, 3] = -corner / size
    matrix[2, :3] = -AXES[2] / (top - bottom)
    matrix[2, 3] = top / (top - bottom)
    return LightBox(matrix, float(texel.max()), size)


def outlines(points: np.ndarray, radii: np.ndarray, sides: int = 12) -> np.ndarray:
    """Where shadows of bodies may fall on the floor: convex outlines (N, sides, 3) [m], counter-clockwise
    from above, around the balls of `radii` (P,) [m] about `points` (N, P, 3) that hold each body.

    Every side touches its body's shadow, so that the outline is tight.
    """
    angle = 2.0 * np.pi * np.arange(sides) / sides
    normals = np.stack([np.cos(angle), np.sin(angle)], 1)
    reach = (points @ AXES[:2].T @ normals.T + radii[:, None]).max(1)
    # neighbouring sides n·x = h meet at one corner each
    sine, cosine = np.sin(angle[1]), np.cos(angle[1])
    across = np.stack([-normals[:, 1], normals[:, 0]], 1)
    corners = reach[..., None] * normals + ((np.roll(reach, -1, 1) - cosine * reach) / sine)[..., None] * across
    along = -(corners @ AXES[:2, 1]) / AXES[2, 1]
    return _counter_clockwise(corners @ AXES[:2] + along[..., None] * AXES[2])


def box_shadows(boxes: Sequence[Box]) -> np.ndarray:
    """The shadows of boxes on the floor, exactly: hexagons (N, 6, 3) [m], counter-clockwise from above."""
    if not boxes:
        return np.zeros((0, 6, 3))
    corners = np.stack([box_corners(box) for box in boxes])
    corners[..., 1] = np.maximum(corners[..., 1], 0.0)
    flat = (corners - SUN * (corners[..., 1:2] / SUN[1]))[..., [0, 2]]
    # the shadow of a box is what its three edges, as shadows, sweep out: go round by direction
    edges = flat[:, [4, 2, 1]] - flat[:, :1]
    backwards = (edges[..., 1] < 0) | ((edges[..., 1] == 0) & (edges[..., 0] < 0))
    edges = np.where(backwards[..., None], -edges, edges)
    order = np.argsort(np.arctan2(edges[..., 1], edges[..., 0]), 1)
    edges = np.take_along_axis(edges, order[..., None], 1)
    start = flat.mean(1) - 0.5 * edges.sum(1)
    rim = start[:, None] + np.cumsum(np.concatenate([np.zeros_like(edges[:, :1]), edges, -edges[:, :2]], 1), 1)
    return _counter_clockwise(np.stack([rim[..., 0], np.zeros(rim.shape[:2]), rim[..., 1]], -1))


def box_corners(box: Box) -> np.ndarray:
    """The corners (8, 3) [m] of a box, x slowest and z fastest."""
    half = 0.5 * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    return (half * box.size) @ yaw(box.heading).T + box.centre


def _counter_clockwise(rim: np.ndarray) -> np.ndarray:
    """Outlines (N, S, 3) laid on the floor, turned so that their upper side is in front."""
    rim = rim * [1.0, 0.0, 1.0]
    after = np.roll(rim, -1, 1)
    area = np.sum(rim[..., 2] * after[..., 0] - after[..., 2] * rim[..., 0], 1)
    return np.where((area < 0.0)[:, None, None], rim[:, ::-1], rim)


def scale_of(positions: np.ndarray, standard: np.ndarray, parents: np.ndarray) -> np.ndarray:
    """The sizes (...) of figures with joints at (..., J, 3) over the standard's (J, 3): sums of bones."""
    def length(at):
        return np.linalg.norm(at[..., 1:, :] - at[..., parents[1:], :], axis=-1).sum(-1)
    return length(positions) / length(standard)


def _ball(figure: Figure):
    at = np.asarray(figure.positions, float)
    # one radius for all ordinary poses, so that the map keeps its size while somebody moves
    reach = np.linalg.norm(at - at[:1], axis=-1).max(initial=0.0) + 0.25
    return at[0], max(REACH, np.ceil(reach * 4.0) / 4.0) if reach > REACH else REACH


def _near(camera: Camera, at: np.ndarray) -> bool:
    return bool(np.isfinite(at).all() and min(np.linalg.norm(at - camera.eye), np.linalg.norm(at - camera.target))
                < SHADOW_RANGE)


def _unit(v: np.ndarray, spare: np.ndarray) -> np.ndarray:
    length = np.linalg.norm(v)
    return v / length if length > 1e-9 else spare
