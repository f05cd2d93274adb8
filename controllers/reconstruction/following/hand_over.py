"""From one pose to another, and what may have come before a pose: with these a body is taken over without a pop."""

from __future__ import annotations

import numpy as np

from ...body import Pose, Skeleton, exp, forward_kinematics, log
from ..pose_vector import REFERENCE, SKELETON, YAW_RATE, encode
from ..regression import SPAN
from .initial_pose import backed

_HINGES = np.array([SKELETON.index(side + name) for side in ("Left", "Right") for name in ("ForeArm", "Leg")])
_BENT = log(REFERENCE[_HINGES])
_AXES = _BENT / np.linalg.norm(_BENT, axis=-1, keepdims=True)  # elbows and knees are bent about these on the average
_BONES = np.stack([SKELETON.offsets[np.flatnonzero(SKELETON.parents == joint)[0]] for joint in _HINGES])
_FADING = 0.1  # s, of the joints' velocities, backward in time, where the past is not known


def joints_of(pose: Pose, skeleton: Skeleton = SKELETON) -> tuple[np.ndarray, np.ndarray]:
    """A body's joints, the standard one's by default: positions (J, 3) [m] and orientations (J, 3, 3)."""
    return forward_kinematics(skeleton, pose.root, pose.rotations)


def difference(to: Pose, start: Pose) -> np.ndarray:
    """What moves one pose onto another (1 + J, 3): of the root [m], and of the joints as rotation vectors [rad]."""
    return np.concatenate([(to.root - start.root)[None], log(np.swapaxes(start.rotations, -1, -2) @ to.rotations)])


def moved(pose: Pose, by: np.ndarray) -> Pose:
    """The inverse of `difference`."""
    return Pose(pose.root + by[0], pose.rotations @ exp(by[1:]))


def unbroken(pose: Pose, of: Pose) -> Pose:
    """A pose whose elbows and knees bend no farther back than straight, or than those of another one: what fades may lead beyond."""
    back = np.minimum(_bends(of), 0.0) - _bends(pose)
    if not (back > 0.0).any():
        return pose
    rotations = np.array(pose.rotations, float)
    rotations[_HINGES] = exp(np.maximum(back, 0.0)[:, None] * _AXES) @ rotations[_HINGES]
    return Pose(pose.root, rotations)


def _bends(pose):
    """How far (4,) [rad] elbows and knees are bent."""
    turned = (pose.rotations[_HINGES] @ _BONES[..., None])[..., 0]
    return np.arctan2(np.sum(np.cross(_BONES, turned) * _AXES, -1), np.sum(_BONES * turned, -1))


def guessed_past(pose: Pose, before: Pose | None, elapsed: float, dt: float) -> tuple[np.ndarray, np.ndarray]:
    """Frames (SPAN, D) and ground tracks (SPAN, 3) that end in a pose, from it and maybe one `elapsed` [s] before.

    Farther back it is guessed: the hips went as fast all the time, the joints had begun to move not long before.
    """
    if before is None:
        frames, tracks = encode(pose.root[None], pose.rotations[None], dt)
        return frames, tracks
    pair, tracks = encode(np.stack([before.root, pose.root]), np.stack([before.rotations, pose.rotations]), elapsed)
    newest = pair[1]
    back = -np.arange(SPAN - 1, -1, -1) * dt
    frames = newest + (np.expm1(back / _FADING) * _FADING)[:, None] * (newest - pair[0]) / elapsed
    frames[:, YAW_RATE:] = newest[YAW_RATE:]
    way = [tracks[1]]
    for _ in range(SPAN - 1):
        way.insert(0, backed(way[0], newest, dt))
    return frames, np.stack(way)
