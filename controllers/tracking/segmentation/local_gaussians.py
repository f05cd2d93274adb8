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
    """Write 1 for each pixel (H, W) of a picture (H, W × C) uint8 that two of its eight neighbours are like, else 0."""
    height, width = out.shape
    for y in range(height):
        for x in range(width):
            alike, left = 0, max(x - 1, 0)
            v, u = max(y - 1, 0), left
            while v < min(y + 2, height) and alike < 3:  # it is like itself
                away = np.int32(0)
                for c in range(channels):
                    away += abs(np.int32(picture[y, x * channels + c]) - np.int32(picture[v, u * channels + c]))
                if away <= apart:
                    alike += 1
                u += 1
                if u == min(x + 2, width):
                    v, u = v + 1, left
            out[y, x] = 1.0 if alike > 2 else 0.0


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


@kernel(nogil=True, fastmath=True)
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


@kernel(nogil=True, fastmath=True)
def ratio_kernel(features, empty, gaussians, stray, out):
    """Write log p₁ − log p₂ (H, W); each no less than `stray`, the density of what is neither's. empty: what p₂ is of."""
    channels, height, width = features.shape
    planes, rows, columns = gaussians.shape[1], gaussians.shape[2], gaussians.shape[3]
    line = np.empty((2, planes, columns), np.float32)
    least = np.float32(stray)
    for y in range(height):
        at = min(max((y + 0.5) / COARSE - 0.5, 0.0), rows - 1.0)
        v = min(int(at), max(rows - 2, 0))
        w, f = min(v + 1, rows - 1), np.float32(at - v)
        for side in range(2):
            for k in range(planes):
                for u in range(columns):
                    line[side, k, u] = gaussians[side, k, v, u] + f * (gaussians[side, k, w, u] - gaussians[side, k, v, u])
        for x in range(width):
            at = min(max((x + 0.5) / COARSE - 0.5, 0.0), columns - 1.0)
            u = min(int(at), max(columns - 2, 0))
            n, g = min(u + 1, columns - 1), np.float32(at - u)
            one = line[0, 0, u] + g * (line[0, 0, n] - line[0, 0, u])
            other = line[1, 0, u] + g * (line[1, 0, n] - line[1, 0, u])
            for c in range(1, channels + 1):
                d = channels + c
                a = features[c - 1, y, x] - (line[0, c, u] + g * (line[0, c, n] - line[0, c, u]))
                b = empty[c - 1, y, x] - (line[1, c, u] + g * (line[1, c, n] - line[1, c, u]))
                one -= a * a * (line[0, d, u] + g * (line[0, d, n] - line[0, d, u]))
                other -= b * b * (line[1, d, u] + g * (line[1, d, n] - line[1, d, u]))
            out[y, x] = max(one, least) - max(other, least)
