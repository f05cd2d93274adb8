"""How much likelier each pixel is inside than outside: Gaussians of colour whose means and spreads differ from place to place.

Colours are brightness and two differences, square to each other, each with a spread of its own. Statistics are sums over
squares of `COARSE` pixels, blurred by two boxes.
"""

from __future__ import annotations

import numpy as np

from ...compiled import kernel

COARSE = 4
"""Statistics are of squares of so many pixels' side: they vary slowly."""
ALIKE = 25
"""Neighbours' levels differ by so much of 256 on average, and are still alike."""
ELSEWHERE = 0.01
"""What the whole region counts for where none of it is near."""


def features_of(picture: np.ndarray) -> np.ndarray:
    """A picture (H, W, 3) or (H, W) uint8 as features (C, H, W) float32."""
    flat, channels = _flat(picture)
    out = np.empty((channels, *picture.shape[:2]), np.float32)
    feature_kernel(flat, out)
    return out


def in_company(picture: np.ndarray) -> np.ndarray:
    """1 for pixels (H, W) float32 of a picture (H, W, 3) or (H, W) uint8 that have two neighbours like them, 0 for others, which say nothing."""
    flat, channels = _flat(picture)
    out = np.empty(picture.shape[:2], np.float32)
    company_kernel(flat, channels, ALIKE * channels, out)
    return out


def _flat(picture: np.ndarray) -> tuple[np.ndarray, int]:
    height, width = picture.shape[:2]
    return np.ascontiguousarray(picture).reshape(height, -1), picture.size // (height * width)


def likelihood_ratio(features: np.ndarray, inside: np.ndarray, outside: np.ndarray, window: int, floor: float, stray: float,
                     plate: np.ndarray | None = None) -> np.ndarray:
    """log p₁ − log p₂ (H, W) of features (C, H, W).

    inside, outside: (H, W) how much each pixel counts for either region's statistics. window: of the blurring boxes, squares
    to each side. floor: the least standard deviation. stray: so many pixels are neither's, and may have any colour.
    plate: (C, H, W) what is there when nobody is; then the outside's statistics are of what differs from it.
    """
    channels, height, width = features.shape
    shape = -(-height // COARSE), -(-width // COARSE)
    empty = features - plate if plate is not None else features
    sums = np.zeros((2, 1 + 2 * channels, *shape), np.float32)
    for side, (weight, seen) in enumerate(((inside, features), (outside, empty))):
        sum_kernel(seen, np.ascontiguousarray(weight, np.float32), sums[side])
    everywhere = sums.mean((2, 3), keepdims=True)
    blurred, room = np.empty_like(sums[0]), np.empty_like(sums[0])
    gaussians = np.empty((2, 1 + 2 * channels, *shape), np.float32)
    for side in range(2):
        blur_kernel(sums[side], window, room, blurred)
        blur_kernel(blurred, window, room, sums[side])
        gaussian_kernel(sums[side] + np.float32(ELSEWHERE) * everywhere[side], floor, gaussians[side])
    out = np.empty((height, width), np.float32)
    ratio_kernel(features, empty, gaussians, np.log(stray) - channels * np.log(256.0), out)
    return out


@kernel(nogil=True)
def company_kernel(picture, channels, apart, out):
    """Write 1 for each pixel (H, W) of a picture (H, W × C) uint8 that two of its eight neighbours are like, else 0.

    Each pair of neighbours is compared once, a row at a time and colour by colour, as processors do many of at once.
    """
    height, width = out.shape
    rows = np.empty((2, channels, width), np.int32)
    alike, away = np.zeros((2, width), np.int32), np.empty(width, np.int32)
    for c in range(channels):
        for x in range(width):
            rows[0, c, x] = picture[0, x * channels + c]
    for y in range(height):
        here, below = y % 2, (y + 1) % 2
        own, under = alike[here], alike[below]
        under[:] = 0
        if y + 1 < height:
            for c in range(channels):
                for x in range(width):
                    rows[below, c, x] = picture[y + 1, x * channels + c]
        for kind in range(4 if y + 1 < height else 1):  # the next of the row, then three of the row below
            other, side = (here, 1) if kind == 0 else (below, kind - 2)
            many, i, j = width - abs(side), max(-side, 0), max(side, 0)
            away[:many] = 0
            for c in range(channels):
                a, b = rows[here, c, i:i + many], rows[other, c, j:j + many]
                for x in range(many):
                    away[x] += abs(a[x] - b[x])
            mine, theirs = own[i:i + many], alike[other, j:j + many]
            for x in range(many):
                away[x] = np.int32(1) if away[x] <= apart else np.int32(0)
                mine[x] += away[x]
            for x in range(many):
                theirs[x] += away[x]
        line = out[y]
        for x in range(width):
            line[x] = 1.0 if own[x] >= 2 else 0.0


@kernel(nogil=True, fastmath=True)
def feature_kernel(picture, out):
    """Write features (C, H, W) of a picture (H, W × C) uint8: three colours turned so that grey is an axis, else as they are."""
    channels, height, width = out.shape
    for y in range(height):
        for x in range(width):
            if channels == 3:
                r, g, b = np.float32(picture[y, 3 * x]), np.float32(picture[y, 3 * x + 1]), np.float32(picture[y, 3 * x + 2])
                out[0, y, x] = (r + g + b) * np.float32(3.0**-0.5)
                out[1, y, x] = (r - b) * np.float32(2.0**-0.5)
                out[2, y, x] = (r - g - g + b) * np.float32(6.0**-0.5)
            else:
                for c in range(channels):
                    out[c, y, x] = picture[y, channels * x + c]


@kernel(nogil=True, fastmath=True)
def sum_kernel(features, weights, out):
    """Add up weights, weighted features and their squares (1 + 2 C, h, w) of each square of features (C, H, W)."""
    channels, height, width = features.shape
    for y in range(height):
        v = y // COARSE
        for x in range(width):
            w, u = weights[y, x], x // COARSE
            if w == 0.0:
                continue
            out[0, v, u] += w
            for c in range(channels):
                value = features[c, y, x]
                out[1 + c, v, u] += w * value
                out[1 + channels + c, v, u] += w * value * value


@kernel(nogil=True, fastmath=True)
def blur_kernel(values, window, room, out):
    """Write the sums over a box, `window` to each side, of values (K, h, w). room: as large as they are."""
    planes, height, width = values.shape
    for k in range(planes):
        for y in range(height):
            total = np.float32(0.0)
            for x in range(min(window, width)):
                total += values[k, y, x]
            for x in range(width):
                if x + window < width:
                    total += values[k, y, x + window]
                if x - window - 1 >= 0:
                    total -= values[k, y, x - window - 1]
                room[k, y, x] = total
        for x in range(width):
            out[k, 0, x] = 0.0
        for y in range(min(window + 1, height)):
            for x in range(width):
                out[k, 0, x] += room[k, y, x]
        for y in range(1, height):
            for x in range(width):
                value = out[k, y - 1, x]
                if y + window < height:
                    value += room[k, y + window, x]
                if y - window - 1 >= 0:
                    value -= room[k, y - window - 1, x]
                out[k, y, x] = value


@kernel(nogil=True, fastmath=True, error_model="numpy")
def gaussian_kernel(sums, floor, out):
    """Write means (C), halves of inverse variances (C) and the logarithm of the peak, (1 + 2 C, h, w), the peak first."""
    planes, height, width = sums.shape
    channels = (planes - 1) // 2
    for y in range(height):
        for x in range(width):
            weight = max(sums[0, y, x], np.float32(1e-6))
            peak = 0.0
            for c in range(channels):
                mean = sums[1 + c, y, x] / weight
                spread = max(sums[1 + channels + c, y, x] / weight - mean * mean, floor * floor)
                out[1 + c, y, x] = mean
                out[1 + channels + c, y, x] = 0.5 / spread
                peak -= 0.5 * np.log(2.0 * np.pi * spread)
            out[0, y, x] = peak


@kernel(nogil=True, fastmath=True, error_model="numpy")
def ratio_kernel(features, empty, gaussians, stray, out):
    """Write log p₁ − log p₂ (H, W); each no less than `stray`, the density of what is neither's. empty: what p₂ is of.

    Gaussians are drawn out to the picture's width once for each of their rows; all the rest is done a row of pixels at a time.
    """
    channels, height, width = features.shape
    planes, rows, columns = gaussians.shape[1], gaussians.shape[2], gaussians.shape[3]
    drawn, line = np.empty((2, 2, planes, width), np.float32), np.empty((2, width), np.float32)
    which, share = np.empty(width, np.int64), np.empty(width, np.float32)
    for x in range(width):
        at = min(max((x + 0.5) / COARSE - 0.5, 0.0), columns - 1.0)
        which[x] = min(int(at), max(columns - 2, 0))
        share[x] = at - which[x]
    least, known = np.float32(stray), -1
    for y in range(height):
        at = min(max((y + 0.5) / COARSE - 0.5, 0.0), rows - 1.0)
        v = min(int(at), max(rows - 2, 0))
        f = np.float32(at - v)
        while known < min(v + 1, rows - 1):
            known += 1
            for side in range(2):
                for k in range(planes):
                    flat, wide = gaussians[side, k, known], drawn[known % 2, side, k]
                    for x in range(width):
                        u = which[x]
                        wide[x] = flat[u] + share[x] * (flat[min(u + 1, columns - 1)] - flat[u])
        upper, lower = drawn[v % 2], drawn[min(v + 1, rows - 1) % 2]
        for side in range(2):
            total, one, two = line[side], upper[side, 0], lower[side, 0]
            for x in range(width):
                total[x] = one[x] + f * (two[x] - one[x])
            for c in range(1, channels + 1):
                seen = features[c - 1, y] if side == 0 else empty[c - 1, y]
                one, two, third, fourth = upper[side, c], lower[side, c], upper[side, channels + c], lower[side, channels + c]
                for x in range(width):
                    away = seen[x] - (one[x] + f * (two[x] - one[x]))
                    total[x] -= away * away * (third[x] + f * (fourth[x] - third[x]))
        one, two, ratio = line[0], line[1], out[y]
        for x in range(width):
            ratio[x] = max(one[x], least) - max(two[x], least)
