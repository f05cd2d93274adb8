"""Ground frames: where a body is on the floor and which way it looks, and how such frames move.

A ground frame is x, z [m] and heading θ [rad]; a body velocity is forward v_f, turning ω and
lateral v_l, positive to the left, all in the moving frame [m/s, rad/s, m/s].
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike


def stacked(*parts: np.ndarray) -> np.ndarray:
    """Arrays (...) of one shape as columns (..., N): what `np.stack` makes of them along a last axis, in a third of its time for a single one."""
    out = np.empty((*np.shape(parts[0]), len(parts)), np.result_type(*parts))
    for column, part in enumerate(parts):
        out[..., column] = part
    return out


def screw(first: np.ndarray, last: np.ndarray, period: ArrayLike) -> np.ndarray:
    """The constant body velocity (..., 3) that carries one ground frame (..., 3) to another in `period` [s].

    The planar logarithm: with turn Δ the displacement in the first frame is V(Δ)·v·T,
    V(Δ) = [[sinΔ, 1−cosΔ], [cosΔ−1, sinΔ]] / Δ over (lateral, forward).
    """
    turn = last[..., 2] - first[..., 2]
    lateral, forward, _ = np.moveaxis(relative(first, last), -1, 0)
    half = 0.5 * turn
    cot = np.where(np.abs(half) < 1e-6, 1.0, half / np.where(np.abs(half) < 1e-6, 1.0, np.tan(half)))
    return stacked(cot * forward + half * lateral, turn, cot * lateral - half * forward) / period


def advance(ground: np.ndarray, velocity: np.ndarray, time: np.ndarray) -> np.ndarray:
    """Ground frames (..., 3) after moving at the constant body velocity (..., 3) for `time` (...) [s].

    The inverse of `screw`: arcs of circles, eq. (2) of Truong 2010 integrated exactly.
    """
    half = 0.5 * velocity[..., 1] * time
    # the chord of an arc: as long as the way times sin(h)/h, and turned by half the angle
    chord, middle = time * np.sinc(half / np.pi), ground[..., 2] + half
    lateral, forward = chord * velocity[..., 2], chord * velocity[..., 0]
    c, s = np.cos(middle), np.sin(middle)
    return stacked(ground[..., 0] + c * lateral + s * forward, ground[..., 1] - s * lateral + c * forward, ground[..., 2] + 2.0 * half)


def relative(frame: np.ndarray, ground: np.ndarray) -> np.ndarray:
    """Ground frames (..., 3) seen from other ground frames (..., 3)."""
    dx, dz = ground[..., 0] - frame[..., 0], ground[..., 1] - frame[..., 1]
    c, s = np.cos(frame[..., 2]), np.sin(frame[..., 2])
    return stacked(c * dx - s * dz, s * dx + c * dz, ground[..., 2] - frame[..., 2])


def compose(frame: np.ndarray, local: np.ndarray) -> np.ndarray:
    """The inverse of `relative`: ground frames (..., 3) given inside others."""
    c, s = np.cos(frame[..., 2]), np.sin(frame[..., 2])
    return stacked(frame[..., 0] + c * local[..., 0] + s * local[..., 1], frame[..., 1] - s * local[..., 0] + c * local[..., 1],
                   frame[..., 2] + local[..., 2])
