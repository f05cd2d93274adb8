"""What makes two segments of motion alike: features whose Euclidean distance is the search's.

A feature vector holds the m frames of the past, newest first, each WIDTH columns times their
weights (neither place nor heading, so it is the same wherever the motion happens),
and after them, where the search is to see them (the "hybrid" query), the control points of the
frame to come: places in the ground frame of the newest past frame, and velocities against that
frame, also weighted.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...compiled import kernel
from ..pose_vector import ANGLES, FORWARD, HEIGHT, JOINTS, LEFTWARD, PITCH, REFERENCE, ROLL, ROOT, SKELETON, YAW_RATE


@dataclass(frozen=True)
class Weights:
    """How much each kind of difference counts, per radian, metre, rad/s and m/s.

    points, speeds: of control points (λ_c, λ_v).
    """

    angles: float = 1.0
    height: float = 2.0
    tilt: float = 1.0
    yaw_rate: float = 0.1
    velocity: float = 0.2
    points: float = 2.0
    speeds: float = 0.2

    @cached_property
    def columns(self) -> np.ndarray:
        """The weight of each column of a frame (WIDTH,) float32."""
        root = dict.fromkeys(ROOT, self.velocity) | {"height": self.height, "pitch": self.tilt, "roll": self.tilt,
                                                     "yaw rate": self.yaw_rate}
        return np.array([self.angles] * ANGLES + [root[name] for name in ROOT], np.float32)


def of_past(past: np.ndarray, weights: Weights = Weights()) -> np.ndarray:
    """Features (..., m · WIDTH) float32 of past frames (..., m, WIDTH), newest first."""
    past = np.asarray(past, np.float32) * weights.columns
    return past.reshape(*past.shape[:-2], -1)


def of_points(points: np.ndarray, before: np.ndarray, track: np.ndarray, dt: float, weights: Weights = Weights()
              ) -> np.ndarray:
    """Features (..., 6 n) float32 of control points in the world: all places, then all velocities.

    points: (..., n, 3) [m] in the frame to come. before: (..., n, 3) [m] in the newest past frame.
    track: (..., 3) that frame's ground track, x, z [m] and heading [rad]. dt: between the two [s].
    """
    # in double, since x and z may be kilometres from the origin
    points, before, track = (np.asarray(a, float) for a in (points, before, track))
    c, s = np.cos(track[..., 2, None]), np.sin(track[..., 2, None])
    x, z = points[..., 0] - track[..., 0, None], points[..., 2] - track[..., 1, None]
    rate, weight = (points - before) * (weights.speeds / dt), weights.points
    both = np.empty((*points.shape[:-2], 2, *points.shape[-2:]), np.float32)
    both[..., 0, :, 0], both[..., 0, :, 2] = weight * (c * x - s * z), weight * (s * x + c * z)
    both[..., 0, :, 1] = weight * points[..., 1]
    both[..., 1, :, 0], both[..., 1, :, 2] = c * rate[..., 0] - s * rate[..., 2], s * rate[..., 0] + c * rate[..., 2]
    both[..., 1, :, 1] = rate[..., 1]
    return both.reshape(*points.shape[:-2], -1)


def places(frames: np.ndarray, joints: tuple[int, ...], offsets: np.ndarray | None = None) -> np.ndarray:
    """Where some points are, seen from the body's own ground frame: (N, n, 3) float32 [m].

    frames: (N, WIDTH). joints: n numbers of joints of `SKELETON`. offsets: (n, 3) [m] of the points in the joints' frames, none by
    default. x is leftward, y up, z forward.
    """
    needed = {0}
    for joint in joints:
        while joint >= 0:
            needed.add(int(joint))
            joint = SKELETON.parents[joint]
    chain = np.array(sorted(needed))
    slot = {joint: k for k, joint in enumerate(chain)}
    parents = np.array([slot.get(int(SKELETON.parents[joint]), -1) for joint in chain])
    columns = np.array([3 * int(np.flatnonzero(JOINTS == joint)[0]) if joint in JOINTS else -1 for joint in chain])
    out = np.empty((len(frames), len(joints), 3), np.float32)
    wanted = np.array([slot[int(joint)] for joint in joints], np.int64)
    frames = np.array(frames, np.float32)  # the kernel is compiled for one kind of array
    beside = np.zeros((len(joints), 3)) if offsets is None else np.array(offsets, float)
    _places(frames, parents, columns, SKELETON.offsets[chain], REFERENCE[chain], wanted, beside, out)
    return out


def _coming(here: np.ndarray, there: np.ndarray, frames: np.ndarray, dt: float, weights: Weights) -> np.ndarray:
    """Features (W, 6 n) of recorded points: `of_points` without a world.

    here, there: (W, n, 3) places of the points in the ground frames of the newest past frame and of
    the next one. frames: (W, WIDTH) the next frames, whose rates lead from one to the other.
    """
    turn = frames[:, YAW_RATE, None] * dt
    c, s = np.cos(turn), np.sin(turn)
    x, y, z = np.moveaxis(there, -1, 0)
    moved = np.stack([c * x + s * z + frames[:, LEFTWARD, None] * dt, y,
                      c * z - s * x + frames[:, FORWARD, None] * dt], -1)
    both = np.concatenate([weights.points * moved, weights.speeds / dt * (moved - here)], 1)
    return both.reshape(len(both), -1).astype(np.float32)


def of_recorded(frames: np.ndarray, last: np.ndarray, joints: tuple[int, ...], dt: float, weights: Weights = Weights(),
                offsets: np.ndarray | None = None) -> np.ndarray:
    """Features (W, 6 n) float32 of the control points that follow recorded segments.

    frames: (N, WIDTH), a database's. last: (W,) the newest past frame of each segment.
    joints: numbers of the joints that the points are on. dt: between frames [s]. offsets: as of `places`.
    """
    features = np.empty((len(last), 6 * len(joints)), np.float32)
    for start in range(0, len(last), _CHUNK):
        here = last[start:start + _CHUNK]
        needed = np.unique(np.concatenate([here, here + 1]))
        seen, after = frames[needed], np.searchsorted(needed, here + 1)
        placed = places(seen, joints, offsets)
        features[start:start + _CHUNK] = _coming(placed[after - 1], placed[after], seen[after], dt, weights)
    return features


_CHUNK = 1 << 15


@kernel(fastmath=True)
def _turn(x, y, z, out):
    """The rotation matrix (3, 3) of a rotation vector, into `out`."""
    angle = np.sqrt(x * x + y * y + z * z)
    a, b = 1.0, 0.5
    if angle > 1e-4:
        a, b = np.sin(angle) / angle, (1 - np.cos(angle)) / (angle * angle)
    c = 1 - b * angle * angle
    out[0, 0], out[0, 1], out[0, 2] = c + b * x * x, b * x * y - a * z, b * x * z + a * y
    out[1, 0], out[1, 1], out[1, 2] = b * x * y + a * z, c + b * y * y, b * y * z - a * x
    out[2, 0], out[2, 1], out[2, 2] = b * x * z - a * y, b * y * z + a * x, c + b * z * z


@kernel(fastmath=True)
def _product(a, b, out):
    for i in range(3):
        for k in range(3):
            out[i, k] = a[i, 0] * b[0, k] + a[i, 1] * b[1, k] + a[i, 2] * b[2, k]


@kernel(fastmath=True)
def _places(frames, parents, columns, offsets, references, wanted, beside, out):
    count = len(parents)
    at, turned = np.empty((count, 3)), np.empty((count, 3, 3))
    local, zero = np.empty((3, 3)), np.empty((3, 3))  # zero: of a joint whose vector is zero
    for n in range(len(frames)):
        at[0] = 0.0
        at[0, 1] = frames[n, HEIGHT]
        _turn(frames[n, PITCH], 0.0, frames[n, ROLL], turned[0])
        for j in range(1, count):
            p, v = parents[j], columns[j]
            for i in range(3):
                at[j, i] = at[p, i] + (turned[p, i, 0] * offsets[j, 0] + turned[p, i, 1] * offsets[j, 1]
                                       + turned[p, i, 2] * offsets[j, 2])
            if v < 0:
                turned[j] = turned[p]
                continue
            _turn(frames[n, v], frames[n, v + 1], frames[n, v + 2], local)
            _product(turned[p], references[j], zero)
            _product(zero, local, turned[j])
        for w in range(len(wanted)):
            j = wanted[w]
            for i in range(3):
                out[n, w, i] = at[j, i] + (turned[j, i, 0] * beside[w, 0] + turned[j, i, 1] * beside[w, 1]
                                           + turned[j, i, 2] * beside[w, 2])
