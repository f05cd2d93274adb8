"""No foot is deep in the floor, whoever put it there, and nothing else moves."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gambol.controllers.body import Pose, forward_kinematics, human
from gambol.controllers.body.contact import contact_height, contact_points
from gambol.controllers.body.ik import pole_of
from gambol.controllers.body.rotations import exp
from gambol.controllers.reconstruction.following.feet import GIVE, above, lift_kernel


def standing(skeleton, turns, sunk, floor):
    """A pose that stands on the floor, less `sunk` [m]; turns: (J, 3) rotation vectors."""
    rotations = exp(turns)
    root = skeleton.offsets[0] * [1.0, 0.0, 1.0]
    points = contact_points(skeleton, *forward_kinematics(skeleton, root, rotations))
    return Pose(root + [0.0, floor + contact_height(skeleton) - points[:, 1].min() - sunk, 0.0], rotations)


@given(st.integers(0, 2**32 - 1), st.floats(0.001, 0.15), st.floats(-1.0, 2.0), st.sampled_from([1.2, 1.741]))
@settings(max_examples=60, deadline=None)
def test_feet_come_up_and_the_rest_stays(seed, sunk, floor, height):
    rng, skeleton = np.random.default_rng(seed), human(height)
    turns = rng.normal(0.0, 0.2, (len(skeleton.names), 3))
    for side in ("Left", "Right"):
        turns[skeleton.index(side + "UpLeg"), 0], turns[skeleton.index(side + "Leg"), 0] = -0.4, 0.8
    pose = standing(skeleton, turns, sunk, floor)
    before = forward_kinematics(skeleton, pose.root, pose.rotations)
    after = forward_kinematics(skeleton, *(lambda p: (p.root, p.rotations))(above(skeleton, pose, *before, floor)))
    deepest = floor + contact_height(skeleton) - contact_points(skeleton, *after)[:, 1].min()
    assert deepest <= GIVE + 1e-9
    legs = [skeleton.index(side + name) for side in ("Left", "Right") for name in ("Leg", "Foot", "Toe")]
    rest = np.setdiff1d(np.arange(len(skeleton.names)), legs)
    np.testing.assert_allclose(after[0][rest], before[0][rest], atol=1e-9)
    feet = legs[1::3]
    np.testing.assert_allclose(after[1][feet], before[1][feet], atol=1e-9)
    np.testing.assert_allclose(after[0][feet][:, [0, 2]], before[0][feet][:, [0, 2]], atol=1e-6)


@pytest.mark.parametrize("sunk", [0.003, 0.01, 0.05])
def test_a_straight_knee_bends_forward_and_never_flips(sunk):
    """From bent to overstretched by three degrees, a thousandth of a radian each: no jump, and forward once it is lifted at all."""
    skeleton, knees = human(), []
    shin = skeleton.index("LeftLeg")
    for bend in np.arange(0.3, -0.05, -0.001):
        turns = np.zeros((len(skeleton.names), 3))
        turns[shin, 0] = bend
        turns[skeleton.index("LeftFoot"), 0] = -bend
        pose = Pose(np.array([0.0, skeleton.offsets[0, 1] - sunk, 0.0]), exp(turns))
        joints = forward_kinematics(skeleton, pose.root, pose.rotations)
        lifted = above(skeleton, pose, *joints, 0.0)
        positions, _ = forward_kinematics(skeleton, lifted.root, lifted.rotations)
        knees.append(positions[shin])
        if bend < 0.0 and sunk >= GIVE:
            hip, ankle = positions[[skeleton.index("LeftUpLeg"), skeleton.index("LeftFoot")]]
            assert pole_of(hip, positions[shin], ankle)[2] > 0.0
    assert np.linalg.norm(np.diff(knees, axis=0), axis=-1).max() < 0.01


def test_who_stands_on_the_floor_is_left_alone():
    skeleton = human()
    pose = standing(skeleton, np.zeros((len(skeleton.names), 3)), 0.0, 0.5)
    assert above(skeleton, pose, *forward_kinematics(skeleton, pose.root, pose.rotations), 0.5 - 1e-9) is pose


def test_the_lift_begins_without_a_slope_and_has_no_kink():
    depths = np.linspace(-0.02, 0.08, 10_001)
    slope = np.gradient(np.array([lift_kernel(depth) for depth in depths]), depths)
    assert slope[depths < -1e-4] == pytest.approx(0.0) and slope[depths > 2.01 * GIVE] == pytest.approx(1.0)
    assert np.abs(np.diff(slope)).max() < 2e-3 and slope.min() >= -1e-9
