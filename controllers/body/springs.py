"""Dampers and springs that are exact for any step: half a step twice is the same as a whole one.

Their stiffness is said as a half-life [s]: how long until half of what is left is gone. A
half-life of 0 jumps to the goal. The critically damped spring's own rate is
y = 2·ln 2 / half-life, so that spring and damper of one half-life take about equally long.
Arrays of any shape, and a scalar kernel for compiled loops.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from ..compiled import kernel

_LN2 = math.log(2.0)
_EPSILON = 1e-9  # s: keeps a half-life of 0 from dividing by 0


def decay(x: ArrayLike, halflife: float, dt: float) -> np.ndarray:
    """What is left of x (...) after dt [s]: half of it each half-life."""
    return np.asarray(x) * math.exp(-_LN2 * dt / (halflife + _EPSILON))


def damp(x: ArrayLike, goal: ArrayLike, halflife: float, dt: float) -> np.ndarray:
    """x (...) moved towards its goal (...): the first-order damper."""
    return np.asarray(goal) + decay(np.asarray(x) - goal, halflife, dt)


def settle(x: np.ndarray, v: np.ndarray, halflife: float | np.ndarray, dt: float | np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """An offset and its velocity (...) after dt [s], settling critically damped to 0: inertialisation.

    halflife, dt: numbers, or anything that broadcasts with them.

    At a transition take x = old − new and v likewise, as vectors or rotation vectors (the short
    way round), add the settling offset to the new motion, and nothing jumps.
    """
    y = 2.0 * _LN2 / (halflife + _EPSILON)
    x, v = np.asarray(x), np.asarray(v)
    pull = v + x * y
    fade = np.exp(-y * dt)
    return fade * (x + pull * dt), fade * (v - pull * (y * dt))


@kernel
def damp_kernel(x, goal, halflife, dt):
    """`damp` of one number."""
    return goal + (x - goal) * math.exp(-_LN2 * dt / (halflife + _EPSILON))


@kernel
def spring_kernel(x, v, goal, halflife, dt):
    """Position and velocity of one number after dt [s] of a critically damped spring towards `goal`.

    Never overshoots from rest, and takes the velocity v along without a jerk.
    """
    y = 2.0 * _LN2 / (halflife + _EPSILON)
    offset = x - goal
    pull = v + offset * y
    fade = math.exp(-y * dt)
    return goal + fade * (offset + pull * dt), fade * (v - pull * (y * dt))
