"""From one pose to another, and what may have come before a pose: with these a body is taken over without a pop."""

from __future__ import annotations

import numpy as np

from ...body import Pose, Skeleton, exp, forward_kinematics, log
from ..pose_vector import REFERENCE, SKELETON, YAW_RATE, encode
from ..regression import SPAN
from .initial_pose import backed
from .pose_kernels import back_kernel, difference_kernel, moved_kernel

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
    out = np.empty((1 + len(to.rotations), 3))
    difference_kernel(to.root, to.rotations, start.root, start.rotations, out)
    return out


def moved(pose: Pose, by: np.ndarray) -> Pose:
    """The inverse of `difference`."""
    root, rotations = np.empty(3), np.empty_like(pose.rotations)
    moved_kernel(pose.root, pose.rotations, by, root, rotations)
    return Pose(root, rotations)


def unbroken(pose: Pose, of: Pose) -> Pose:
    """A pose whose elbows and knees bend no farther back than straight, or than those of another one: what fades may lead beyond."""
    back = np.empty(len(_HINGES))
    if not back_kernel(pose.rotations, of.rotations, _HINGES, _BONES, _AXES, back):
        return pose
    rotations = np.array(pose.rotations, float)
    rotations[_HINGES] = exp(back[:, None] * _AXES) @ rotations[_HINGES]
    return Pose(pose.root, rotations)


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
