"""Ways as cubic B-splines over the share of time s ∈ [0, 1]: rest and pose at both ends are held by the outer coefficients."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy.interpolate import BSpline

from ...compiled import kernel

NODES, SHARES = np.polynomial.legendre.leggauss(2)
POINTS = len(NODES)
"""Places in each interval where cost and limits are looked at."""


class Basis(NamedTuple):
    """M intervals. values: (Q, 3, 4) the four cubics that count at each of Q places, and their first and second
    derivatives by s; place q lies in interval q // POINTS. weights: (Q,) of the quadrature, of sum 1. shares: (Q,) s.
    peaks: (M + 3,) where each cubic has its weight (Greville)."""

    values: np.ndarray
    weights: np.ndarray
    shares: np.ndarray
    peaks: np.ndarray


@lru_cache(maxsize=64)
def basis(intervals: int) -> Basis:
    """The uniform clamped cubic basis over [0, 1], with two Gauss points in each interval."""
    knots = knots_of(intervals)
    shares = ((np.arange(intervals)[:, None] + 0.5 + 0.5 * NODES) / intervals).ravel()
    first = np.repeat(np.arange(intervals), POINTS)[:, None] + np.arange(4)
    cubics = BSpline(knots, np.eye(intervals + 3), 3)
    values = np.stack([np.take_along_axis(cubics(shares, order), first, 1) for order in range(3)], 1)
    weights = np.tile(0.5 * SHARES, intervals) / intervals
    peaks = np.convolve(knots[1:-1], np.full(3, 1 / 3), "valid")
    return Basis(np.ascontiguousarray(values), weights, shares, peaks)


def knots_of(intervals: int) -> np.ndarray:
    """The knots (M + 7,) of the basis."""
    return np.concatenate([np.zeros(3), np.linspace(0.0, 1.0, intervals + 1), np.ones(3)])


@kernel
def at_place(values, first, coefficients, y):
    """Way, velocity and acceleration (9,) by the share of time at one place."""
    for order in range(3):
        for d in range(3):
            total = 0.0
            for k in range(4):
                total += values[order, k] * coefficients[first + k, d]
            y[3 * order + d] = total
