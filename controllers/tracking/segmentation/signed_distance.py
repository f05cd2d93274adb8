"""How far each pixel is from a mask's contour."""

from __future__ import annotations

import numpy as np

from ...compiled import kernel


def signed_distance(mask: np.ndarray, most: float) -> np.ndarray:
    """Φ₀ (H, W) float32 [pixels], above 0 in a mask (H, W) bool, no more than `most`; the contour runs between pixels."""
    out = np.empty(mask.shape, np.float32)
    distance_kernel(np.ascontiguousarray(mask).view(np.uint8), most, out)
    return out


@kernel(nogil=True, fastmath=True)
def distance_kernel(mask, most, out):
    """Write signed distances (H, W): along columns first, then the least over a row, as far as distances are told."""
    height, width = mask.shape
    reach = int(most) + 2
    far = np.float32(reach)
    zero, one = np.float32(0.0), np.float32(1.0)
    column = np.empty((2, height, width), np.float32)  # to the nearest pixel of a column that is 0, 1
    for kind in range(2):
        for y in range(height):
            row, above, pixels = column[kind, y], column[kind, max(y - 1, 0)], mask[y]
            for x in range(width):
                row[x] = zero if pixels[x] == kind else far if y == 0 else min(above[x] + one, far)
        for y in range(height - 2, -1, -1):
            row, below = column[kind, y], column[kind, y + 1]
            for x in range(width):
                row[x] = min(row[x], below[x] + one)
    square, best = np.empty(width, np.float32), np.empty((2, width), np.float32)
    for y in range(height):
        for kind in range(2):
            row, least = column[kind, y], best[kind]
            nearest = far
            for x in range(width):
                square[x] = row[x] * row[x]
                least[x] = square[x]
                nearest = min(nearest, row[x])
            if nearest == far:
                continue
            for d in range(1, min(reach, width)):
                more, many = np.float32(d * d), width - d
                right, left, before, after = least[d:], least[:many], square[:many], square[d:]
                for x in range(many):
                    right[x] = min(right[x], before[x] + more)
                for x in range(many):
                    left[x] = min(left[x], after[x] + more)
        here, there, line, pixels = best[0], best[1], out[y], mask[y]
        for x in range(width):
            inside = pixels[x] != 0
            value = min(np.sqrt(here[x] if inside else there[x]) - np.float32(0.5), np.float32(most))
            line[x] = value if inside else -value
