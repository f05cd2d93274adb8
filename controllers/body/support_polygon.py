"""What a body stands on: the support polygon, and how far inside it a point lies.

The polygon is the convex hull of the corners of whatever stands on the floor (Ooi 2015, 3.1.2.2:
outer edges of the feet, a line across the toes and one across the heels), seen from above. Hulls
of one point, of a line and of nothing are polygons too, with no inside.
"""

from __future__ import annotations

import math

import numpy as np

from ..compiled import kernel
from .contact import contact_height, heel_offset
from .human import CONTACT_HEIGHT
from .skeleton import Skeleton

HALF_SOLE = 0.045
"""Half the width of a sole [m] of a body of standard height."""
CORNERS = 12
"""Of two soles: of each foot two at the heel, two at the ball, two at the toes' tip."""


def sole_corners(skeleton: Skeleton, positions: np.ndarray, orientations: np.ndarray) -> np.ndarray:
    """The corners (..., 12, 3) [m] of both soles, from what forward kinematics returned.

    Left foot first; of each the heel's two, the ball's two, the tip's two, the left one (+X) first.
    """
    down = contact_height(skeleton)
    half = HALF_SOLE * down / CONTACT_HEIGHT
    corners = []
    for side in ("Left", "Right"):
        toe = skeleton.end_offsets[skeleton.end_index[side + "Toe"]]
        for joint, at in ((side + "Foot", heel_offset(skeleton)), (side + "Toe", np.zeros(3)), (side + "Toe", toe)):
            j = skeleton.index(joint)
            for aside in (half, -half):
                corners.append(positions[..., j, :] + orientations[..., j, :, :] @ (at + [aside, -down, 0.0]))
    return np.stack(corners, -2)


def standing_corners(contacts: np.ndarray) -> np.ndarray:
    """Which of the 12 corners stand (..., 12) bool, told from the contacts (..., 4) of heels and balls."""
    contacts = np.asarray(contacts, bool)
    return np.repeat(contacts, (2, 4, 2, 4), axis=-1)


def hull(points: np.ndarray) -> np.ndarray:
    """The corners (H, 2) of the convex hull of points (N, 2) [m], in turn, counter-clockwise by x, y.

    The smallest first; H is 0 for no points, 1 where all are one, 2 on a line.
    ValueError for points that are not finite.
    """
    points = np.ascontiguousarray(points, float)
    if points.size and points.shape[1:] != (2,):
        raise ValueError(f"the points under a support polygon are (N, 2), seen from above; got shape {points.shape}")
    points = points.reshape(-1, 2)
    if not np.isfinite(points).all():
        raise ValueError("the points under a support polygon must be finite")
    corners = np.empty((len(points) + 1, 2))
    return corners[:hull_kernel(points.copy(), len(points), corners)].copy()


def margin(corners: np.ndarray, point: np.ndarray) -> np.ndarray:
    """How far (...) [m] points (..., 2) are inside a hull (H, 2): the distance to its nearest edge.

    Negative outside, then the distance to the hull; −∞ where nothing stands.
    """
    corners, point = np.ascontiguousarray(corners, float), np.asarray(point, float)
    flat = point.reshape(-1, 2)
    return np.array([margin_kernel(corners, len(corners), p[0], p[1]) for p in flat]).reshape(point.shape[:-1])


def centroid(corners: np.ndarray) -> np.ndarray:
    """The centre (2,) [m] of a hull's area; of a line its middle. ValueError where nothing stands."""
    if not len(corners):
        raise ValueError("nothing stands: there is no support polygon")
    out = np.empty(2)
    centroid_kernel(np.ascontiguousarray(corners, float), len(corners), out)
    return out


@kernel
def hull_kernel(points, count, out):
    """Write the hull of the first `count` points (N, 2), which are sorted on the way (monotone chain).

    out: (N + 1, 2). Returns how many corners there are.
    """
    for i in range(1, count):  # by x, then y: a dozen points, and half sorted already
        x, y = points[i, 0], points[i, 1]
        j = i - 1
        while j >= 0 and (points[j, 0] > x or (points[j, 0] == x and points[j, 1] > y)):
            points[j + 1, 0], points[j + 1, 1] = points[j, 0], points[j, 1]
            j -= 1
        points[j + 1, 0], points[j + 1, 1] = x, y
    size = 0.0
    for i in range(count):
        size = max(size, abs(points[i, 0] - points[0, 0]), abs(points[i, 1] - points[0, 1]))
    if count == 0 or size == 0.0:
        for _ in range(min(count, 1)):
            out[0, 0], out[0, 1] = points[0, 0], points[0, 1]
        return min(count, 1)
    flat = 1e-12 * size * size  # turns by less are rounding
    n = 0
    for i in range(count):
        n = _turn_left(out, n, 2, points[i], flat)
    lower = n + 1
    for i in range(count - 2, -1, -1):
        n = _turn_left(out, n, lower, points[i], flat)
    return n - 1


@kernel
def _turn_left(out, n, least, point, flat):
    while n >= least and ((out[n - 1, 0] - out[n - 2, 0]) * (point[1] - out[n - 2, 1])
                          - (out[n - 1, 1] - out[n - 2, 1]) * (point[0] - out[n - 2, 0])) <= flat:
        n -= 1
    out[n, 0], out[n, 1] = point[0], point[1]
    return n + 1


@kernel
def margin_kernel(corners, count, x, y):
    """The signed margin [m] of a point in the hull of the first `count` corners."""
    nearest, inside = math.inf, count > 2
    for i in range(count):
        ax, ay = corners[i, 0], corners[i, 1]
        k = i + 1 if i + 1 < count else 0
        ex, ey = corners[k, 0] - ax, corners[k, 1] - ay
        px, py = x - ax, y - ay
        inside = inside and ex * py - ey * px >= 0.0
        square = ex * ex + ey * ey
        part = min(max((px * ex + py * ey) / square, 0.0), 1.0) if square > 0.0 else 0.0
        nearest = min(nearest, math.hypot(px - part * ex, py - part * ey))
    return nearest if inside else -nearest


@kernel
def centroid_kernel(corners, count, out):
    """Write the centre (2,) of the hull of the first `count` corners, at least one."""
    middle_x, middle_y = 0.0, 0.0
    for i in range(count):
        middle_x += corners[i, 0] / count
        middle_y += corners[i, 1] / count
    area, x, y = 0.0, 0.0, 0.0
    for i in range(count):
        k = i + 1 if i + 1 < count else 0
        ax, ay = corners[i, 0] - middle_x, corners[i, 1] - middle_y
        bx, by = corners[k, 0] - middle_x, corners[k, 1] - middle_y
        cross = ax * by - ay * bx
        area += cross
        x += cross * (ax + bx) / 3.0
        y += cross * (ay + by) / 3.0
    out[0], out[1] = middle_x, middle_y
    if count > 2 and area > 0.0:
        out[0] += x / area
        out[1] += y / area
