"""The leg that goes on swinging of who lands on the other."""

from __future__ import annotations

import numpy as np

from ...body import sole_corners
from ..body import FLEX, Physique, carriage, hermite, monotone, place_kernel, turns
from ..prior import BETWEEN, EACH
from .ground_kernels import FREE, ground_kernel

CLEARS, LIFT, LIFTS, BENT = 0.015, 0.35, 4, 2.3
"""A leg that swings on as its body lands on the other clears the floor by so much [m]; a knee that is bent by 1 rad more lifts its foot by so much [m], at standard
height; tried so often, and bent no farther than this [rad] for it."""


def free_leg(body, lands: int) -> slice:
    """The joints of the leg on which a body, told by its tables, does not land; `lands` is the other, 0 left and 1 right."""
    first = int(body.hip[1 - lands])
    return slice(first, first + 4)


def passing(physique: Physique, landing: np.ndarray, lands: int, times: np.ndarray, rows: np.ndarray, centres: np.ndarray, angles: np.ndarray, upright: np.ndarray):
    """How the leg swings of who lands on the other, `lands`: as recorded in rows (K - 1, EACH) [rad] at times (K,) [s] after touch-down, its knee bent by as much more
    as keeps its foot off the floor until the lowest point: recorded bodies sink less over it.

    landing: (2, 5) the feet on the floor. centres: (BETWEEN + 1, 3) [m] the mass centre until the lowest point, angles (BETWEEN + 1, 11) [rad] and upright
    (BETWEEN + 1, 3, 3) how the body is carried and its pelvis turned. What is given is a function of times, see `keyed_leg`.
    """
    body, until, count = physique.tables, times[:BETWEEN + 1], len(physique.skeleton)
    joints, swings, flex = carriage.joints_of(physique.skeleton), free_leg(physique.tables, lands), FLEX * physique.flexibility
    swung, knee = keyed_leg(times, rows), np.zeros(len(times))
    feet = np.ones((len(until), 2, 6))
    feet[..., :5], feet[:, 1 - lands, 5] = landing, FREE
    roots, local = np.empty((len(until), 3)), np.tile(np.eye(3), (len(until), count, 1, 1))
    positions, turned = np.empty((count, 3)), np.empty((count, 3, 3))
    for _ in range(LIFTS):
        local[:, swings] = swung(until)
        ground_kernel(body, flex, angles, joints, np.zeros((len(until), count, 3)), upright, centres, feet, centres[0] - [0.0, 0.05, 0.0], roots, local)
        low = np.empty(len(until))
        for n in range(len(until)):
            place_kernel(body, roots[n], local[n], positions, turned)
            corners = sole_corners(physique.skeleton, positions[None], turned[None])[0]
            low[n] = corners.reshape(2, -1, 3)[1 - lands, :, 1].min() - (landing[0, 1] - body.sole)
        missing = np.maximum(CLEARS * physique.size - low, 0.0) / (LIFT * physique.size)
        if missing.max() < 1e-3:
            break
        knee[:BETWEEN + 1] += missing
        knee[BETWEEN + 1:] = 0.5 * np.maximum(knee[BETWEEN + 1:], knee[BETWEEN])
        bent = rows.copy()
        bent[:, 1] = np.minimum(rows[:, 1] + knee[:len(rows)], np.maximum(rows[:, 1], BENT))
        swung = keyed_leg(times, bent)
    return swung


def keyed_leg(times: np.ndarray, rows: np.ndarray):
    """A leg's local rotations (N, 4, 3, 3) at any times (N,) [s], that bends by rows (K, EACH) [rad] at times (K,) [s]; after the last
    row, as in it."""
    bent = np.zeros((len(times), 4, 3))
    bent[:, :EACH, 0] = np.concatenate([rows, rows[-1:]])
    slopes = monotone(times, bent)
    return lambda at: turns(hermite(times, bent, slopes, at))
