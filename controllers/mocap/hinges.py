"""Where limbs turn about their own bones: one meaning for all skeletons, CMU's.

Elbows and knees only bend, elbows about one axis of the upper arm; what turns about forearm and shin belongs to hand and foot. Other
skeletons have the elbow's axis elsewhere, by up to 53°, and turn forearms and shins as well: the same bodies, told otherwise.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from ..body import Clip, between, exp

_TILT = np.radians(30.0)
"""A left elbow's axis in T-pose is the downward one, turned forward by this about the arm."""
_ELBOWS = {"Left": np.array([0.0, -np.cos(_TILT), np.sin(_TILT)]), "Right": np.array([0.0, np.cos(_TILT), -np.sin(_TILT)])}
_BENT, _LONG = np.radians(35.0), 0.5
"""Elbows bent by more than this tell their axis, if they are for so long [s]: nearly straight ones are told too ill."""


def elbows(clips: Sequence[Clip]) -> tuple[float, float]:
    """By how much [rad] about the upper arm's bone the axes of the left and the right elbow are off CMU's, in one performer's clips on our
    skeleton; 0 where they are never bent."""
    found = []
    for side, axis in _ELBOWS.items():
        total, long = np.zeros(3), 0.0
        for clip in clips:
            bone = _bone(clip, side + "Hand")
            fore = Rotation.from_quat(clip.quaternions[:, clip.skeleton.index(side + "ForeArm")]).apply(bone)
            bent = fore @ bone < np.cos(_BENT)
            total += np.cross(bone, fore[bent]).sum(0)
            long += clip.frame_time * bent.sum()
        found.append(float(np.arctan2(np.cross(axis, total) @ bone, axis @ total)) if long >= _LONG else 0.0)
    return found[0], found[1]


def hinged(clip: Clip, rolls: tuple[float, float] | None = None) -> Clip:
    """The same motion with elbows about CMU's axes, and forearms and shins that bend alone.

    clip: on our skeleton (`retarget`). rolls: of `elbows`, from this clip alone by default. All joints stay where they are, and hands and
    feet as they are turned.
    """
    rotations = np.array(clip.rotations)
    for side, roll in zip(_ELBOWS, elbows([clip]) if rolls is None else rolls, strict=True):
        arm, fore, hand, shin, foot = (clip.skeleton.index(side + name) for name in ("Arm", "ForeArm", "Hand", "Leg", "Foot"))
        turn = exp(roll * _bone(clip, side + "Hand"))
        rotations[:, arm] = rotations[:, arm] @ turn
        rotations[:, fore] = turn.T @ rotations[:, fore]
        for joint, end in ((fore, hand), (shin, foot)):
            bone = _bone(clip, clip.skeleton.names[end])
            bent = between(bone, rotations[:, joint] @ bone)
            rotations[:, end] = np.swapaxes(bent, -1, -2) @ rotations[:, joint] @ rotations[:, end]
            rotations[:, joint] = bent
    return replace(clip, quaternions=Rotation.from_matrix(rotations.reshape(-1, 3, 3)).as_quat().reshape(*rotations.shape[:2], 4))


def _bone(clip: Clip, name: str) -> np.ndarray:
    """The direction (3,) from a joint's parent to it."""
    offset = clip.skeleton.offsets[clip.skeleton.index(name)]
    return offset / np.linalg.norm(offset)
