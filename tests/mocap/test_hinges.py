"""Elbows and knees that only bend, about CMU's axes: the same joints, the same hands and feet, whatever skeleton told them."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from test_retarget import walk

from gambol.controllers.body import Clip, exp
from gambol.controllers.mocap import elbows, hinged

KEPT = ["Head", "LeftHand", "RightHand", "LeftFoot", "RightFoot", "LeftToe", "RightToe", "LeftUpLeg", "RightShoulder"]


def told_otherwise(clip: Clip, roll: float, seed: int = 3) -> Clip:
    """The same joints of a skeleton whose upper arms are rolled, and that turns forearms and shins from moment to moment."""
    rotations, skeleton = np.array(clip.rotations), clip.skeleton
    slow = np.cumsum(0.05 * np.random.default_rng(seed).normal(size=(4, len(clip))), -1)
    for k, side in enumerate(("Left", "Right")):
        arm, fore, hand, shin, foot = (skeleton.index(side + name) for name in ("Arm", "ForeArm", "Hand", "Leg", "Foot"))
        along = np.array([1.0, 0.0, 0.0]) * (1.0, -1.0)[k]
        turn = exp(roll * along)
        rotations[:, arm] = rotations[:, arm] @ turn
        rotations[:, fore] = turn.T @ rotations[:, fore]
        for joint, end, bone, way in ((fore, hand, along, slow[k]), (shin, foot, np.array([0.0, -1.0, 0.0]), slow[2 + k])):
            twist = exp(way[:, None] * bone)
            rotations[:, joint] = rotations[:, joint] @ twist
            rotations[:, end] = np.swapaxes(twist, -1, -2) @ rotations[:, end]
    return Clip(clip.name, skeleton, clip.frame_time, clip.root, Rotation.from_matrix(rotations.reshape(-1, 3, 3)).as_quat().reshape(*rotations.shape[:2], 4))


def bent(clip: Clip, by: float = 0.8) -> Clip:
    """A walk with its elbows bent by so much more [rad]."""
    quaternions = np.array(clip.quaternions)
    for side, way in (("Left", -1.0), ("Right", 1.0)):
        fore = clip.skeleton.index(side + "ForeArm")
        quaternions[:, fore] = (Rotation.from_rotvec([0.0, by * way, 0.0]) * Rotation.from_quat(quaternions[:, fore])).as_quat()
    return Clip(clip.name, clip.skeleton, clip.frame_time, clip.root, quaternions)


@pytest.mark.parametrize("roll", [-0.9, 0.0, 0.5])
def test_what_is_told_otherwise_comes_to_the_same(roll):
    clip = bent(walk(2.0))
    plain, other = hinged(clip), hinged(told_otherwise(clip, roll))
    assert np.abs(plain.rotations - other.rotations).max() < 1e-6


def test_joints_stay_and_hands_and_feet_as_they_are_turned():
    clip = told_otherwise(bent(walk(1.0)), 0.7)
    before, after = clip.kinematics(), hinged(clip).kinematics()
    assert np.allclose(before[0], after[0], atol=1e-9)
    kept = [clip.skeleton.index(name) for name in KEPT]
    assert np.allclose(before[1][:, kept], after[1][:, kept], atol=1e-9)


def test_forearms_bend_about_one_axis_and_shins_about_the_knees():
    clip = hinged(told_otherwise(bent(walk(1.0)), 0.7))
    fore, shin = (Rotation.from_matrix(clip.rotations[:, clip.skeleton.index(name)]).as_rotvec() for name in ("LeftForeArm", "LeftLeg"))
    assert np.abs(fore[:, 0]).max() < 1e-9 and np.abs(shin[:, 1]).max() < 1e-9
    assert np.degrees(np.arctan2(*fore.mean(0)[[2, 1]])) == pytest.approx(150.0, abs=0.1)


def test_arms_that_are_never_bent_are_not_rolled():
    clip = bent(walk(2.0), -0.2)
    assert elbows([clip]) == (0.0, 0.0)
    assert np.allclose(hinged(clip).rotations, clip.rotations, atol=1e-6)


def test_a_performers_other_clips_tell_the_axis_of_one_whose_elbows_stay_straight():
    clips = [told_otherwise(bent(walk(1.0), by), -0.5) for by in (-0.2, 0.8)]
    assert elbows(clips[:1]) == (0.0, 0.0)
    assert abs(elbows(clips)[0]) == pytest.approx(np.radians(30.0) + 0.5, abs=1e-6)
