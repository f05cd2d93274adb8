"""How far each pixel is from a mask's contour."""

from __future__ import annotations

import numpy as np

from ...compiled import kernel


def signed_distance(mask: np.ndarray, most: float) -> np.ndarray:
    """Φ₀ (H, W) float32 [pixels], above 0 in a mask (H, W) bool, no more than `most`; the contour runs between pixels."""
    out = np.empty(mask.shape, np.float32)
    distance_kernel(np.ascontiguousarray(mask).view(np.uint8), most, out)
    return out


@kernel(nogil=True)
def distance_kernel(mask, most, out):
    """Write signed distances (H, W): along columns first, then the least over a row (Meijster 2000), which ends where it can."""
    height, width = mask.shape
    far = np.int32(most) + 2
    column = np.empty((2, height, width), np.int32)  # to the nearest pixel of a column that is 0, 1
    for kind in range(2):
        for x in range(width):
            column[kind, 0, x] = 0 if mask[0, x] == kind else far
        for y in range(1, height):
            for x in range(width):
                column[kind, y, x] = 0 if mask[y, x] == kind else min(column[kind, y - 1, x] + 1, far)
        for y in range(height - 2, -1, -1):
            for x in range(width):
                column[kind, y, x] = min(column[kind, y, x], column[kind, y + 1, x] + 1)
    first = np.empty((2, width), np.int32)  # how far along a row the next column is that has anything near
    for y in range(height):
        for kind in range(2):
            first[kind, 0] = 0 if column[kind, y, 0] < far else far
            for x in range(1, width):
                first[kind, x] = 0 if column[kind, y, x] < far else min(first[kind, x - 1] + 1, far)
            for x in range(width - 2, -1, -1):
                first[kind, x] = min(first[kind, x], first[kind, x + 1] + 1)
        for x in range(width):
            inside = mask[y, x] != 0
            kind = 0 if inside else 1
            row = column[kind, y]
            best = row[x] * row[x]
            d = max(first[kind, x], 1)
            while d * d < best and d < far:
                if x >= d:
                    best = min(best, row[x - d] * row[x - d] + d * d)
                if x + d < width:
                    best = min(best, row[x + d] * row[x + d] + d * d)
                d += 1
            value = min(np.sqrt(np.float32(best)) - np.float32(0.5), np.float32(most))
            out[y, x] = value if inside else -value
