"""How good a reconstruction is: distances, angles, jitter, lag and feet against the recorded motion.

All take whole takes, frames along the first axis, and give one number a frame or a take. World positions
are compared as they are: whoever wanders off pays for it.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from ...body import log
from ..pose_vector import JOINTS, REFERENCE


FLAT = 0.02
"""A foot lies flat whose heel and ball are no higher than this above where they stand [m]."""


def position_error(found: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """Mean distance (T,) [m] over the chart's 19 joints, in the world (MPJPE), of positions (T, J, 3)."""
    return np.linalg.norm(found[:, JOINTS] - truth[:, JOINTS], axis=-1).mean(-1)


def aligned_error(found: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """As `position_error`, with the hips of both in one place: (T,) [m]."""
    return position_error(found - found[:, :1], truth - truth[:, :1])


def angle_error(found: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """Root mean square (T,) [rad] over the chart's 19 joints of the angle between local rotations (T, J, 3, 3)."""
    between = np.swapaxes(truth[:, JOINTS], -1, -2) @ found[:, JOINTS]
    angles = Rotation.from_matrix(between.reshape(-1, 3, 3)).magnitude().reshape(between.shape[:2])
    return np.sqrt(np.mean(angles ** 2, -1))


def column_error(found: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """Root mean square (T,) [rad] of the 57 joint columns' differences, of local rotations (T, J, 3, 3)."""
    def columns(rotations):
        return log(np.swapaxes(REFERENCE[JOINTS], -1, -2) @ rotations[:, JOINTS])
    return np.sqrt(np.mean((columns(found) - columns(truth)) ** 2, (-1, -2)))


def jitter(positions: np.ndarray, dt: float) -> float:
    """Mean length of the third derivative [m/s³] of the joints' positions (T, J, 3), frames dt [s] apart."""
    return float(np.linalg.norm(np.diff(positions[:, JOINTS], 3, axis=0), axis=-1).mean() / dt ** 3)


def slides(points: np.ndarray, standing: np.ndarray, dt: float) -> np.ndarray:
    """How fast soles' points (T, 4, 3) that stand, (T, 4) bool, move along the floor (K,) [m/s], one for each that does in a frame and the next."""
    return _along(points, dt)[standing[1:] & standing[:-1]]


def flat_slides(points: np.ndarray, height: float, dt: float) -> np.ndarray:
    """How fast feet that lie flat on the floor move along it (K,) [m/s], whoever says that they stand: the slower of heel and ball, of points
    (T, 4, 3) that stand at a height [m]. What an eye takes for sliding."""
    low = np.asarray(points[..., 1] < height + FLAT).reshape(-1, 2, 2)
    flat = low[..., 0] & low[..., 1]
    return _along(points, dt).reshape(-1, 2, 2).min(-1)[flat[1:] & flat[:-1]]


def knee_leap(knees: np.ndarray, hips: np.ndarray) -> float:
    """How far [m] a knee (T, 2, 3) was at most from where its last two places, seen from the hips (T, 3), led."""
    return float(np.linalg.norm(np.diff(knees - hips[:, None], 2, axis=0), axis=-1).max(initial=0.0))


def _along(points, dt):
    return np.linalg.norm(np.diff(points[..., [0, 2]], axis=0), axis=-1) / dt


def lag(found: np.ndarray, truth: np.ndarray, most: int = 8) -> float:
    """By how many frames, fractions too, positions (T, J, 3) come late: where the error's parabola is least.

    Each joint's own constant error is left out of account. 0 for takes too short to tell.
    """
    if len(truth) < 4 * most:
        return 0.0
    shifts = np.arange(-most, most + 1)
    costs = []
    for shift in shifts:
        away = found[most + shift:len(found) - most + shift, JOINTS] - truth[most:-most, JOINTS]
        costs.append(np.mean((away - away.mean(0)) ** 2))
    best = int(np.argmin(costs))
    if best in (0, len(shifts) - 1):
        return float(shifts[best])
    before, here, after = costs[best - 1:best + 2]
    return float(shifts[best] + 0.5 * (before - after) / max(before - 2 * here + after, 1e-12))


def interval(values: np.ndarray, rng: np.random.Generator, share: float = 0.95, draws: int = 10_000) -> tuple[float, float]:
    """The bootstrap interval of the mean of values (N,), one of each take; of differences, it is the paired one."""
    means = values[rng.integers(0, len(values), (draws, len(values)))].mean(-1)
    low, high = np.quantile(means, [(1 - share) / 2, (1 + share) / 2])
    return float(low), float(high)
