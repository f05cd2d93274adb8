"""A linear inverted pendulum over the soles that stand: what pressure under them, and walls, do to a mass centre."""

from __future__ import annotations

import math

import numpy as np

from ..body import HALF_SOLE, hull_kernel, margin_kernel
from ..compiled import kernel
from .surroundings import hold_kernel

RATE = 120.0
"""Moments a second."""
INSIDE = 0.85
"""Pressure stays within this share of the soles."""
TRACKS, LAGS = 4.0, 0.04
"""The capture point is led to where it shall be with this rate [1/s]; pressure follows what is wanted with this time constant [s]."""


@kernel
def sole_kernel(body, foot, points, first):
    """Write the four corners of what pressure may use of a sole whose ball is at `foot` (3,) into points[first:]; how many there are then."""
    half, s, c = INSIDE * HALF_SOLE * body.size, math.sin(foot[2]), math.cos(foot[2])
    back, tip = body.heel[2] - body.toe[2], body.tip[2]
    middle, reach = 0.5 * (back + tip), 0.5 * INSIDE * (tip - back)
    for along in (middle - reach, middle + reach):
        for aside in (half, -half):
            points[first, 0] = foot[0] + aside * c + along * s
            points[first, 1] = foot[1] - aside * s + along * c
            first += 1
    return first


@kernel
def middle_kernel(body, foot, out):
    """Write the middle (2,) of a sole whose ball is at `foot` (3,)."""
    along = 0.5 * (body.heel[2] - body.toe[2] + body.tip[2])
    out[0], out[1] = foot[0] + along * math.sin(foot[2]), foot[1] + along * math.cos(foot[2])


@kernel
def support_kernel(body, feet, free, points, corners):
    """Write the hull of the soles that stand into corners (9, 2); how many corners it has."""
    count = 0
    for side in range(2):
        if not free[side]:
            count = sole_kernel(body, feet[side], points, count)
    return hull_kernel(points, count, corners)


@kernel
def into_kernel(corners, count, p):
    """Bring a point (2,) into a hull by the shortest way."""
    if margin_kernel(corners, count, p[0], p[1]) >= 0.0:
        return
    nearest, x, z = math.inf, p[0], p[1]
    for i in range(count):
        k = i + 1 if i + 1 < count else 0
        ex, ez = corners[k, 0] - corners[i, 0], corners[k, 1] - corners[i, 1]
        px, pz = p[0] - corners[i, 0], p[1] - corners[i, 1]
        square = ex * ex + ez * ez
        part = min(max((px * ex + pz * ez) / square, 0.0), 1.0) if square > 0.0 else 0.0
        far = math.hypot(px - part * ex, pz - part * ez)
        if far < nearest:
            nearest, x, z = far, corners[i, 0] + part * ex, corners[i, 1] + part * ez
    p[0], p[1] = x, z


@kernel
def sway_kernel(things, floor, size, x, v, p, goal, corners, count, rate, dt):
    """Lead mass centre, velocity and pressure (2,) on by dt: the pendulum exactly, its pressure evenly to where it leads the capture point to `goal` (2,). No corners: in the air.
    Walls (`surroundings`) hold it."""
    wanted, follows = np.empty(2), 1.0 - math.exp(-dt / LAGS)
    for i in range(2):
        point = x[i] + v[i] / rate
        wanted[i] = point + TRACKS / rate * (point - goal[i])
    if count > 0:
        into_kernel(corners, count, wanted)
    for i in range(2):
        p[i] = p[i] + follows * (wanted[i] - p[i])
    if count > 0:
        into_kernel(corners, count, p)
    c, s = math.cosh(rate * dt), math.sinh(rate * dt)
    for i in range(2):
        if count == 0:
            p[i] = x[i] + v[i] * dt
            x[i] = p[i]
            continue
        off = x[i] - p[i]
        x[i], v[i] = p[i] + c * off + s / rate * v[i], rate * s * off + c * v[i]
    hold_kernel(things, floor, size, x, v)
