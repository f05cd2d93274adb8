"""Where trackers are on somebody who stands in poses, and how that changes with bones, mounts, the floor and joints' angles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...body import exp, heel_offset
from ..pose_vector import SKELETON
from .simulated import BONES, SCALES, TARGETS, told
from .stood import JOINTS, WORN, Stood

_N = len(SKELETON)
OWN = 3 * (_N - 1)
"""Numbers of all joints' angles but the hips'."""
_FEET = np.array([SKELETON.index(side + part) for side in ("Left", "Right") for part in ("Foot", "Toe")])
_SOLES = np.array([heel_offset(SKELETON), np.zeros(3)] * 2)
_LENGTHS = told(np.eye(TARGETS))[0][:BONES].reshape(BONES, 3 * _N).T
"""How offsets (3 J) change with a calibration's numbers of bones."""
_ABOVE = np.eye(_N, dtype=bool)
for _j in range(1, _N):
    _ABOVE[_j] |= _ABOVE[SKELETON.parents[_j]]


@dataclass(frozen=True, eq=False)
class Points:
    """points: (K, n, 3) [m] trackers, as many as are worn, and soles. held: (K, worn, 3, 3) how trackers are turned. shared (K, n, 3, S), own (K, n, 3, O):
    how points change with what is shared, and own (`pose_fit.PoseFit`). spun (K, worn, 3, S), spun_own (K, worn, 3, O): how trackers turn [rad], about
    their own axes."""

    points: np.ndarray
    held: np.ndarray
    shared: np.ndarray
    own: np.ndarray
    spun: np.ndarray
    spun_own: np.ndarray

    @property
    def worn(self) -> int:
        return self.held.shape[1]

    def turned(self, off: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """How the rotation vectors (K, worn, 3) that trackers' turns are off by change with what is shared, and own."""
        back = _unbent(off)
        return back @ self.spun, back @ self.spun_own


def told_of(stood: Stood, worn: np.ndarray, asked: np.ndarray, headings: np.ndarray, roots: np.ndarray, shared: np.ndarray, own: np.ndarray) -> Points:
    """What trackers of which some are worn (S,) bool say of somebody who stands about as asked (K, J, 3, 3), the hips about so: see `pose_fit.PoseFit`."""
    count, which = len(asked), JOINTS[worn]
    bones, away, turned, floor = told(shared[:TARGETS])
    angles = np.concatenate([own[:, OWN:OWN + 3], shared[TARGETS:] + own[:, :OWN]], 1).reshape(count, _N, 3)
    local = np.concatenate([headings[:, None], asked[:, 1:]], 1) @ exp(angles)
    joints, orientations = np.empty((count, _N, 3)), local.copy()
    joints[:, 0] = roots + own[:, OWN + 3:]
    offsets = SKELETON.offsets + bones
    for j in range(1, _N):
        p = SKELETON.parents[j]
        joints[:, j] = joints[:, p] + orientations[:, p] @ offsets[j]
        orientations[:, j] = orientations[:, p] @ local[:, j]
    on, count_worn = np.concatenate([which, _FEET]), len(which)
    mounts, turned, beside = stood.mounts[0, worn], turned[worn], (stood.offsets[0] + away)[worn]
    as_stood = orientations[:, which] @ exp(-turned)
    arms = np.concatenate([np.einsum("ksij,sj->ksi", as_stood, beside), np.einsum("kfij,fj->kfi", orientations[:, _FEET], _SOLES)], 1)
    points = joints[:, on] + arms
    above = _ABOVE[on]
    # joints turn about their own places by columns of these, in the room's axes
    about = orientations @ _bent(angles)
    levers = -_hat((points[:, :, None] - joints[:, None]) * above[..., None]) @ about[:, None]
    spun = np.swapaxes(as_stood @ np.swapaxes(mounts, -1, -2), -1, -2)[:, :, None] @ (about[:, None] * above[:count_worn, :, None, None])
    parents = np.concatenate([np.zeros((count, 1, 3, 3)), orientations[:, SKELETON.parents[1:]]], 1)
    carried = (parents[:, None] * above[..., None, None]).swapaxes(2, 3).reshape(count, len(on), 3, 3 * _N)
    by_shared, by_own = np.zeros((count, len(on), 3, len(shared))), np.zeros((count, len(on), 3, own.shape[1]))
    turns, turns_own = np.zeros((count, count_worn, 3, len(shared))), np.zeros((count, count_worn, 3, own.shape[1]))
    by_shared[..., :BONES] = carried @ _LENGTHS
    for k, s in enumerate(np.flatnonzero(worn)):
        at, turn = BONES + 3 * s, BONES + 3 * (len(WORN) + s)
        by_shared[:, k, :, at:at + 3] = as_stood[:, k] * SCALES[at]
        bent = _bent(-turned[k]) * SCALES[turn]
        by_shared[:, k, :, turn:turn + 3] = as_stood[:, k] @ _hat(beside[k]) @ bent
        turns[:, k, :, turn:turn + 3] = -mounts[k] @ bent
    points = points.copy()
    points[:, :count_worn, 1] += floor
    by_shared[:, :count_worn, 1, TARGETS - 1] = SCALES[TARGETS - 1]
    for whole, mine, some in ((by_shared, by_own, levers), (turns, turns_own, spun)):
        flat = some.swapaxes(2, 3).reshape(*some.shape[:2], 3, 3 * _N)
        whole[..., TARGETS:] = mine[..., :OWN] = flat[..., 3:]
        mine[..., OWN:OWN + 3] = flat[..., :3]
    by_own[..., OWN + 3:] = np.eye(3)
    return Points(points, as_stood @ np.swapaxes(mounts, -1, -2), by_shared, by_own, turns, turns_own)


def _hat(v: np.ndarray) -> np.ndarray:
    """Matrices (..., 3, 3) of cross products with v (..., 3)."""
    out = np.zeros((*v.shape, 3))
    out[..., 0, 1], out[..., 0, 2], out[..., 1, 2] = -v[..., 2], v[..., 1], -v[..., 0]
    return out - np.swapaxes(out, -1, -2)


def _bent(v: np.ndarray) -> np.ndarray:
    """How exp(v) turns, in its own axes, as v (..., 3) changes: the right Jacobian of SO(3) (Chirikjian 2012, §10.8)."""
    angle, cross = np.linalg.norm(v, axis=-1)[..., None, None], _hat(v)
    small = angle < 1e-3
    third = np.where(small, 1.0 / 6.0, (1.0 - np.sinc(angle / np.pi)) / np.where(small, 1.0, angle) ** 2)
    return np.eye(3) - 0.5 * np.sinc(angle / (2.0 * np.pi)) ** 2 * cross + third * cross @ cross


def _unbent(v: np.ndarray) -> np.ndarray:
    """The inverse of `_bent`, of angles below a full turn."""
    angle, cross = np.linalg.norm(v, axis=-1)[..., None, None], _hat(v)
    half = np.where(angle < 1e-3, 1.0, 0.5 * angle)
    square = np.where(angle < 1e-3, 1.0 / 12.0, 0.25 * (1.0 - half / np.tan(half)) / half ** 2)
    return np.eye(3) + 0.5 * cross + square * cross @ cross
