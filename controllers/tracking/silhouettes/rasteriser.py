"""Pixels that a mesh covers, with its depth and its triangles: on the processor, where reading back from a graphics card
takes longer than drawing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...compiled import kernel
from ..cameras import Lens, project_kernel

NEAREST = 0.05
"""What is nearer to a camera than this [m] is not drawn."""
FAR = np.float32(np.inf)


@dataclass(frozen=True, eq=False)
class View:
    """What a camera sees. depth: (H, W) float32 [m], infinite where there is nothing. triangles: (H, W) int32, -1 there.

    box: left, top, right, bottom pixels within which anything is, right and bottom excluded.
    """

    depth: np.ndarray
    triangles: np.ndarray
    box: tuple[int, int, int, int]

    @property
    def mask(self) -> np.ndarray:
        """Which pixels are covered (H, W) bool."""
        out = np.zeros(self.triangles.shape, bool)
        left, top, right, bottom = self.box
        np.greater_equal(self.triangles[top:bottom, left:right], 0, out=out[top:bottom, left:right])
        return out

    @staticmethod
    def empty(lens: Lens) -> View:
        """Nothing seen."""
        width, height = lens.size
        return View(np.full((height, width), FAR), np.full((height, width), -1, np.int32), (0, 0, 0, 0))


def rendered(lens: Lens, vertices: np.ndarray, triangles: np.ndarray, over: View | None = None, closed: bool = True, first: int = 0) -> View:
    """A mesh seen by a camera. vertices: (V, 3) [m]. triangles: (T, 3), counter-clockwise from outside.

    over: a view that is drawn on, in place. closed: whether only outsides are seen. first: the number of triangle 0 in the view.
    """
    view = over or View.empty(lens)
    seen = np.empty((len(vertices), 3))
    project_kernel(np.ascontiguousarray(vertices, float), lens.numbers, seen)
    left, top, right, bottom = raster_kernel(seen, np.ascontiguousarray(triangles, np.int32), closed, first, view.depth, view.triangles)
    if right > left and view.box[2] > view.box[0]:
        left, top = min(left, view.box[0]), min(top, view.box[1])
        right, bottom = max(right, view.box[2]), max(bottom, view.box[3])
    elif right <= left:
        left, top, right, bottom = view.box
    return View(view.depth, view.triangles, (left, top, right, bottom))


def redrawn(lens: Lens, vertices: np.ndarray, triangles: np.ndarray, kept: View | None) -> View:
    """A mesh seen by a camera as of `rendered`, in the arrays of a view that is not needed any more, if there is one."""
    if kept is not None:
        left, top, right, bottom = kept.box
        kept.depth[top:bottom, left:right] = np.inf
        kept.triangles[top:bottom, left:right] = -1
        kept = View(kept.depth, kept.triangles, (0, 0, 0, 0))
    return rendered(lens, vertices, triangles, kept)


@kernel(nogil=True, error_model="numpy")
def raster_kernel(seen, triangles, closed, first, depth, numbers):
    """Draw triangles (T, 3) of vertices seen at (V, 3), pixels and depth [m], where they are nearer than what is there.

    A pixel is covered where its middle is. depth: (H, W) float32. numbers: (H, W) int32, of the triangle plus `first`.
    Left, top, right, bottom of what was drawn.
    """
    height, width = depth.shape
    left, top, right, bottom = width, height, 0, 0
    for t in range(len(triangles)):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        ax, ay, bx, by, cx, cy = seen[a, 0], seen[a, 1], seen[b, 0], seen[b, 1], seen[c, 0], seen[c, 1]
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if area == 0.0 or area > 0.0 and closed:  # y runs down: an outside turns the other way
            continue
        za, zb, zc = seen[a, 2], seen[b, 2], seen[c, 2]
        if min(za, zb, zc) < NEAREST:
            continue
        low_x, high_x = min(ax, bx, cx), max(ax, bx, cx)
        low_y, high_y = min(ay, by, cy), max(ay, by, cy)
        if high_x < 0.0 or high_y < 0.0 or low_x > width - 1 or low_y > height - 1:
            continue
        x0, x1 = max(int(np.ceil(low_x)), 0), min(int(np.floor(high_x)), width - 1)
        y0, y1 = max(int(np.ceil(low_y)), 0), min(int(np.floor(high_y)), height - 1)
        if x0 > x1 or y0 > y1:
            continue
        inverse = 1.0 / area
        ia, ib, ic = 1.0 / za, 1.0 / zb, 1.0 / zc
        xa, ya, xb, yb = (by - cy) * inverse, (cx - bx) * inverse, (cy - ay) * inverse, (ax - cx) * inverse  # weights' slopes
        ia, ib = ia - ic, ib - ic
        for y in range(y0, y1 + 1):
            fa, fb = ya * (y - cy) - xa * cx, yb * (y - cy) - xb * cx
            for x in range(x0, x1 + 1):
                wa, wb = fa + xa * x, fb + xb * x
                if wa < 0.0 or wb < 0.0 or wa + wb > 1.0:
                    continue
                deep = np.float32(1.0 / (ic + wa * ia + wb * ib))
                if deep < depth[y, x]:
                    depth[y, x] = deep
                    numbers[y, x] = first + t
                    left, top = min(left, x), min(top, y)
                    right, bottom = max(right, x + 1), max(bottom, y + 1)
    return left, top, right, bottom
