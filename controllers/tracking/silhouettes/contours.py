"""The contour of a mask: the covered pixels that touch an uncovered one, and which way is out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...compiled import kernel

REACH = 3
"""So many pixels round about say which way is out."""
MOST = 20_000
"""So many pixels of a contour at most; a mask of noise has no more to say."""


@dataclass(frozen=True, eq=False)
class Contour:
    """pixels: (N, 2) x, y. normals: (N, 2) unit, outwards."""

    pixels: np.ndarray
    normals: np.ndarray

    def __len__(self) -> int:
        return len(self.pixels)


def contour_of(mask: np.ndarray, box: tuple[int, int, int, int] | None = None) -> Contour:
    """The contour of a mask (H, W) bool, within a box of left, top, right, bottom pixels. The picture's own border is none."""
    mask = np.ascontiguousarray(mask).view(np.uint8)
    left, top, right, bottom = box or extent_of(mask)
    out = np.empty((min(mask.size, MOST), 4))
    count = contour_kernel(mask, left, top, right, bottom, out)
    return Contour(out[:count, :2].copy(), out[:count, 2:].copy())


def extent_of(mask: np.ndarray) -> tuple[int, int, int, int]:
    """Within which left, top, right, bottom pixels a mask (H, W) bool or uint8 covers anything; right and bottom excluded, all 0 for nothing."""
    left, top, right, bottom = extent_kernel(np.ascontiguousarray(mask).view(np.uint8))
    return int(left), int(top), int(right), int(bottom)


@kernel(nogil=True)
def extent_kernel(mask):
    """Left, top, right, bottom of a mask (H, W) uint8; whole rows at once, as most have nothing."""
    height, width = mask.shape
    across = np.zeros(width, np.uint8)
    top, bottom = height, 0
    for y in range(height):
        row, some = mask[y], np.uint8(0)
        for x in range(width):
            some |= row[x]
        if some:
            top, bottom = min(top, y), y + 1
            for x in range(width):
                across[x] |= row[x]
    if top >= bottom:
        return 0, 0, 0, 0
    left, right = 0, width
    while not across[left]:
        left += 1
    while not across[right - 1]:
        right -= 1
    return left, top, right, bottom


@kernel(nogil=True)
def contour_kernel(mask, left, top, right, bottom, out):
    """Write x, y and the normal of a mask's contour (N, 4); N. mask: (H, W) uint8, 0 where nothing is."""
    height, width = mask.shape
    count = 0
    for y in range(max(top, 1), min(bottom, height - 1)):
        for x in range(max(left, 1), min(right, width - 1)):
            if mask[y, x] == 0 or (mask[y, x - 1] and mask[y, x + 1] and mask[y - 1, x] and mask[y + 1, x]):
                continue
            gx, gy = 0.0, 0.0
            for b in range(max(y - REACH, 0), min(y + REACH + 1, height)):
                for a in range(max(x - REACH, 0), min(x + REACH + 1, width)):
                    if mask[b, a] == 0:
                        gx += a - x
                        gy += b - y
            size = (gx * gx + gy * gy) ** 0.5
            if size < 1e-6 or count == len(out):
                continue
            out[count, 0], out[count, 1], out[count, 2], out[count, 3] = x, y, gx / size, gy / size
            count += 1
    return count
