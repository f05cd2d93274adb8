"""Which points of the feet stand on the floor, told from where they are and nothing else.

This detector knows no labels and no foot lock: it is what the figures are measured with. The
points are, in this order, left heel, left ball, right heel, right ball.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..compiled import kernel
from .human import CONTACT_HEIGHT, HEEL, human
from .skeleton import Skeleton, end_positions

POINTS = ("left heel", "left ball", "right heel", "right ball")
WALK_SPEEDS = np.array([0.50, 0.35, 0.50, 0.35])
"""Slower than this [m/s] a point of a walking foot stands: heels, balls."""
RUN_SPEEDS = np.array([1.40, 1.00, 1.40, 1.00])
"""The same for a runner, whose feet hardly come to rest [m/s]."""
HEIGHT_GATE = 0.05
"""Higher than this above the floor [m] nothing stands; in flat stance the points are at 0.02."""
RELEASE = 1.25
"""A standing point is let go only beyond this many times its speed limit or the height gate."""
for _limits in (WALK_SPEEDS, RUN_SPEEDS):
    _limits.setflags(write=False)


@dataclass(frozen=True, eq=False)
class Stances:
    """The stretches during which points stood, N in all, in order of point and time.

    point: (N,) 0 … 3, see POINTS. start, stop: (N,) first frame and the one after the last.
    drift: (N,) [m] the farthest it strayed on the ground from where it stood at first.
    """

    point: np.ndarray
    start: np.ndarray
    stop: np.ndarray
    drift: np.ndarray

    def __len__(self) -> int:
        return len(self.point)


def contact_height(skeleton: Skeleton) -> float:
    """How high heel, ball and toe of this skeleton stand in flat stance [m]."""
    return CONTACT_HEIGHT * _foot_size(skeleton)


def heel_offset(skeleton: Skeleton) -> np.ndarray:
    """Where the heel's contact point is in this skeleton's foot frames (3,) [m]."""
    return HEEL * _foot_size(skeleton)


def contact_points(skeleton: Skeleton, positions: np.ndarray, orientations: np.ndarray) -> np.ndarray:
    """Heels and balls (..., 4, 3) [m], from what forward kinematics returned."""
    heel, points = heel_offset(skeleton).astype(positions.dtype), np.empty((*positions.shape[:-2], 4, 3), positions.dtype)
    for k, side in enumerate(("Left", "Right")):
        foot = skeleton.index(side + "Foot")
        points[..., 2 * k, :] = positions[..., foot, :] + orientations[..., foot, :, :] @ heel
        points[..., 2 * k + 1, :] = positions[..., skeleton.index(side + "Toe"), :]
    return points


def point_speeds(points: np.ndarray, frame_time: float) -> np.ndarray:
    """Speeds (T, ...) [m/s] of points (T, ..., 3) [m], by central differences."""
    if len(points) < 2:
        return np.zeros(points.shape[:-1])
    return np.linalg.norm(np.gradient(points, frame_time, axis=0), axis=-1)


def detect_contacts(heights: np.ndarray, speeds: np.ndarray, *, running: bool = False,
                    height_gate: float = HEIGHT_GATE, release: float = RELEASE, shortest: int = 1) -> np.ndarray:
    """Which points stand, (T, ..., 4) bool.

    heights: (T, ..., 4) [m] above the floor. speeds: (T, ..., 4) [m/s]. A point takes hold below
    the height gate and its speed limit (WALK_SPEEDS or RUN_SPEEDS) and lets go `release` times
    higher. Stretches of fewer than `shortest` frames are dropped.
    ValueError if the shapes differ or do not end in 4 points.
    """
    heights, speeds = np.asarray(heights, float), np.asarray(speeds, float)
    if heights.shape != speeds.shape or heights.shape[-1:] != (4,):
        raise ValueError(f"heights {heights.shape} and speeds {speeds.shape} must agree and end in 4 points")
    limits = RUN_SPEEDS if running else WALK_SPEEDS
    excess = np.maximum(heights / height_gate, speeds / limits)
    standing = np.zeros((len(excess), excess[0].size if len(excess) else 0), np.bool_)
    _hold(excess.reshape(standing.shape), release, shortest, standing)
    return standing.reshape(excess.shape)


def foot_drift(points: np.ndarray, contacts: np.ndarray) -> Stances:
    """Every stance of a clip and how far the point drifted in it.

    points: (T, 4, 3) [m]. contacts: (T, 4) bool.
    """
    edges = np.diff(np.pad(np.asarray(contacts, np.int8), ((1, 1), (0, 0))), axis=0)
    point, start = np.nonzero(edges.T == 1)
    stop = np.nonzero(edges.T == -1)[1]
    ground = np.asarray(points)[..., [0, 2]]
    drift = [np.linalg.norm(ground[a:b, k] - ground[a, k], axis=-1).max() for k, a, b in zip(point, start, stop)]
    return Stances(point, start, stop, np.array(drift))


def feet_apart(skeleton: Skeleton, positions: np.ndarray, orientations: np.ndarray) -> np.ndarray:
    """How far apart the centre lines of the feet are, seen from above (...) [m]; 0 where they cross.

    positions, orientations: what forward kinematics returned. A centre line runs from the heel to
    the end of the toes; shoes are 7 (heel) to 10 cm (ball) wide.
    """
    points, ends = contact_points(skeleton, positions, orientations), end_positions(skeleton, positions, orientations)
    a, c = points[..., 0, [0, 2]], points[..., 2, [0, 2]]
    b, d = (ends[..., skeleton.end_index[side + "Toe"], :][..., [0, 2]] for side in ("Left", "Right"))
    gaps = [_from_line(*line) for line in ((a, c, d), (b, c, d), (c, a, b), (d, a, b))]
    cross = (_side(a, b, c) * _side(a, b, d) < 0) & (_side(c, d, a) * _side(c, d, b) < 0)
    return np.where(cross, 0.0, np.minimum.reduce(gaps))


def _from_line(point, start, stop):
    along = stop - start
    share = np.clip(np.sum((point - start) * along, -1) / np.sum(along**2, -1), 0.0, 1.0)
    return np.linalg.norm(point - start - share[..., None] * along, axis=-1)


def _side(start, stop, point):
    along, off = stop - start, point - start
    return along[..., 0] * off[..., 1] - along[..., 1] * off[..., 0]


@lru_cache
def _foot_size(skeleton):
    """This skeleton's foot over the standard human's, told by the ankle's height above the ball."""
    toe = skeleton.index("LeftToe")
    return float(skeleton.offsets[toe, 1] / human().offsets[human().index("LeftToe"), 1])


@kernel
def _hold(excess, release, shortest, standing):
    for k in range(excess.shape[1]):
        on, since = False, 0
        for t in range(excess.shape[0]):
            now = excess[t, k] < (release if on else 1.0)
            if now and not on:
                since = t
            if on and not now and t - since < shortest:
                standing[since:t, k] = False
            standing[t, k] = now
            on = now
        if on and excess.shape[0] - since < shortest:
            standing[since:, k] = False
