"""Uniform cubic B-splines of a pose's columns, as kernels read them."""

from __future__ import annotations

import numpy as np

from ..compiled import kernel
from .kernel import COLUMNS, HIPS_AT, LANES


def in_columns(rows: np.ndarray) -> np.ndarray:
    """Rows (..., 3 J + 3) of joints and hips in the kernels' columns (..., COLUMNS), float32; labels and duration are 0."""
    joints = rows.shape[-1] // 3 - 1
    table = np.zeros(rows.shape[:-1] + (COLUMNS,), np.float32)
    for axis in range(3):
        table[..., axis * LANES:axis * LANES + joints] = rows[..., axis:3 * joints:3]
    table[..., HIPS_AT:HIPS_AT + 3] = rows[..., 3 * joints:]
    return table


@kernel
def spline_kernel(coefficients, d, at):
    """Column d of a spline with coefficients (K, COLUMNS) and its rate by coefficient, at coefficient number `at`."""
    k = min(int(at), coefficients.shape[0] - 4)
    t = at - k
    a, b, c, e = coefficients[k, d], coefficients[k + 1, d], coefficients[k + 2, d], coefficients[k + 3, d]
    u = 1.0 - t
    value = (u * u * u * a + (3.0 * t * t * t - 6.0 * t * t + 4.0) * b
             + (-3.0 * t * t * t + 3.0 * t * t + 3.0 * t + 1.0) * c + t * t * t * e) / 6.0
    rate = 0.5 * (-u * u * a + (3.0 * t * t - 4.0 * t) * b + (-3.0 * t * t + 2.0 * t + 1.0) * c + t * t * e)
    return value, rate
