"""Cameras and the sun's view as matrices. Pure arrays; columns act on (x, y, z, 1)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..scene import Box, Camera, Figure

NEAR, FAR = 0.1, 400.0
"""The depth range of a camera [m]."""
SUN = np.array([0.62, 0.75, -0.22]) / np.linalg.norm([0.62, 0.75, -0.22])
"""Towards the sun."""
TILE = 2.0
"""The floor's pattern repeats every so many metres, and so may the frame's origin move."""
SHADOW_RANGE = 22.0
"""Figures nearer than this to the camera or to its target [m] cast shadows."""
REACH = 1.28
"""Radius [m] of the ball around a standard human's hips that holds any pose."""


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
    axes: (3, 3) the map's two sides and the direction to the sun, as rows.
    """

    matrix: np.ndarray
    axes: np.ndarray
    texel: float
    size: np.ndarray


def light_box(camera: Camera, figures: tuple[Figure, ...], boxes: tuple[Box, ...], texels: int,
              sun: np.ndarray = SUN, origin: np.ndarray | None = None) -> LightBox | None:
    """The smallest light box around what casts shadows, or None where nothing near does.

    Its size comes in steps and its place in whole texels, so that a shadow's edge does not crawl
    as the figure moves. It follows from the scene alone: the same scene gives the same box.
    The result counts from `origin` (3,) [m], on the floor; by default from the world's.
    """
    balls = [ball for ball in map(_ball, figures) if _near(camera, ball[0])]
    balls += [ball for ball in map(_box_ball, boxes)
              if ball[1] < 4.0 and _near(camera, ball[0])]
    if not balls:
        return None
    centres, radii = np.array([b[0] for b in balls]), np.array([b[1] for b in balls])
    side = _unit(np.cross([0.0, 1.0, 0.0], sun), np.array([1.0, 0.0, 0.0]))
    axes = np.stack([side, np.cross(sun, side), sun])
    seen = centres @ axes.T
    low, high = (seen - radii[:, None]).min(0), (seen + radii[:, None]).max(0)
    step = 0.5
    size = np.maximum(np.ceil((high - low)[:2] / step - 1e-6) * step, step)
    if len(balls) == 1:
        size = (high - low)[:2]
    texel = size / texels
    size = size + 2 * texel
    texel = size / texels
    corner = np.floor((0.5 * (low + high)[:2] - 0.5 * size) / texel) * texel
    # where the box's four edges, followed along the sun, meet the floor
    square = corner + size * np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    along = -(square @ axes[:2, 1]) / axes[2, 1]
    shift = axes @ (np.zeros(3) if origin is None else origin)
    corner, along, low, high = corner - shift[:2], along - shift[2], low - shift, high - shift
    bottom, top = min(along.min(), low[2]) - 0.1, high[2] + 0.1
    matrix = np.eye(4)
    matrix[:2, :3] = axes[:2] / size[:, None]
    matrix[:2, 3] = -corner / size
    matrix[2, :3] = -axes[2] / (top - bottom)
    matrix[2, 3] = top / (top - bottom)
    return LightBox(matrix, axes, float(texel.max()), size)


def outlines(points: np.ndarray, radii: np.ndarray, axes: np.ndarray, sides: int = 12) -> np.ndarray:
    """Where shadows of bodies may fall on the floor: convex outlines (N, sides, 3) [m], counter-clockwise
    from above, around the balls of `radii` (P,) [m] about `points` (N, P, 3) that hold each body.

    axes: as in `LightBox`. Every side touches its body's shadow, so that the outline is tight.
    """
    angle = 2.0 * np.pi * np.arange(sides) / sides
    normals = np.stack([np.cos(angle), np.sin(angle)], 1)
    reach = (points @ axes[:2].T @ normals.T + radii[:, None]).max(1)
    after = np.roll(reach, -1, 1)
    # neighbouring sides n·x = h meet at one corner each
    sine, cosine = np.sin(angle[1]), np.cos(angle[1])
    across = np.stack([-normals[:, 1], normals[:, 0]], 1)
    corners = reach[..., None] * normals + ((after - cosine * reach) / sine)[..., None] * across
    along = -(corners @ axes[:2, 1]) / axes[2, 1]
    flat = corners @ axes[:2] + along[..., None] * axes[2]
    flat[..., 1] = 0.0
    area = np.sum(flat[..., 2] * np.roll(flat[..., 0], -1, -1) - flat[..., 0] * np.roll(flat[..., 2], -1, -1), -1)
    return np.where((area < 0.0)[:, None, None], flat[:, ::-1], flat)


def scale_of(positions: np.ndarray, standard: np.ndarray, parents: np.ndarray) -> np.ndarray:
    """The sizes (...) of figures with joints at (..., J, 3) over the standard's (J, 3): sums of bones."""
    def length(at):
        return np.linalg.norm(at[..., 1:, :] - at[..., parents[1:], :], axis=-1).sum(-1)
    return length(positions) / length(standard)


def _ball(figure: Figure):
    at = np.asarray(figure.positions, float)
    # the hips' own height in the standard pose is the simplest measure of a figure's size
    reach = np.linalg.norm(at - at[:1], axis=-1).max(initial=0.0) + 0.25
    return at[0], max(REACH, np.ceil(reach * 4.0) / 4.0) if reach > REACH else REACH


def _box_ball(box: Box):
    return np.array(box.centre, float), float(0.5 * np.linalg.norm(box.size))


def _near(camera: Camera, at: np.ndarray) -> bool:
    return bool(np.isfinite(at).all() and min(np.linalg.norm(at - camera.eye), np.linalg.norm(at - camera.target))
                < SHADOW_RANGE)


def _unit(v: np.ndarray, spare: np.ndarray) -> np.ndarray:
    length = np.linalg.norm(v)
    return v / length if length > 1e-9 else spare
