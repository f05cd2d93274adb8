"""A body weighs what it should, balances where it should, and bends as far as it should."""

import numpy as np
import pytest
from sampling import BATCHES, rotations

from gambol.controllers.body import Pose, forward_kinematics, human
from gambol.controllers.body.anatomy import anatomy, centre_in_pose, centre_of_mass, joint_limits, segment_centres
from gambol.controllers.body.rotations import exp

SEXES = ("male", "female")


@pytest.mark.parametrize("sex", SEXES)
def test_shares_sum_to_one_and_masses_to_the_mass(sex):
    body = anatomy(human(), 61.9, sex)
    assert body.shares.sum() == pytest.approx(1.0, abs=1e-12)
    assert body.masses.sum() == pytest.approx(61.9)
    assert len(body.names) == len(set(body.names)) == 16


@pytest.mark.parametrize("sex", SEXES)
def test_left_and_right_are_alike(sex):
    body = anatomy(human(), sex=sex)
    for k, name in enumerate(body.names):
        if name.startswith("left"):
            other = body.names.index(name.replace("left", "right"))
            assert body.shares[k] == body.shares[other]
            np.testing.assert_allclose(body.centres[k] * [-1, 1, 1], body.centres[other], atol=1e-15)
            np.testing.assert_allclose(body.inertias[k], body.inertias[other], atol=1e-15)


@pytest.mark.parametrize("sex", SEXES)
def test_inertias_are_those_of_real_bodies(sex):
    """Positive, and no principal moment above the sum of the other two."""
    moments = np.linalg.eigvalsh(anatomy(human(), sex=sex).inertias)
    assert np.all(moments > 0)
    assert np.all(moments[:, 2] <= moments[:, 0] + moments[:, 1])


def test_standing_the_centre_of_mass_is_at_57_percent_of_stature():
    skeleton = human()
    vectors = np.zeros((len(skeleton), 3))
    vectors[skeleton.index("LeftArm"), 2], vectors[skeleton.index("RightArm"), 2] = -np.pi / 2, np.pi / 2
    centre = centre_of_mass(anatomy(skeleton), *forward_kinematics(skeleton, skeleton.offsets[0], exp(vectors)))
    assert 0.55 < centre[1] / 1.741 < 0.58
    assert centre[0] == pytest.approx(0.0, abs=1e-12)
    assert abs(centre[2]) < 0.03


@pytest.mark.parametrize("batch", BATCHES, ids=str)
def test_the_centre_is_the_weighted_mean_and_moves_with_the_body(batch):
    rng = np.random.default_rng(2)
    skeleton = human()
    body = anatomy(skeleton)
    local = rotations("tangent", batch + (len(skeleton),), rng)
    positions, orientations = forward_kinematics(skeleton, np.zeros(3), local)
    centre = centre_of_mass(body, positions, orientations)
    assert centre.shape == batch + (3,)
    np.testing.assert_allclose(centre, np.average(segment_centres(body, positions, orientations), axis=-2,
                                                  weights=body.shares), atol=1e-12)
    turn, shift = rotations("uniform", (), rng), rng.normal(size=3)
    np.testing.assert_allclose(centre_of_mass(body, positions @ turn.T + shift, turn @ orientations),
                               centre @ turn.T + shift, atol=1e-12)


def test_a_taller_body_scales():
    small, tall = anatomy(human(1.5), 50.0), anatomy(human(1.8), 50.0)
    np.testing.assert_allclose(tall.centres, small.centres * 1.2, atol=1e-12)
    np.testing.assert_allclose(tall.inertias, small.inertias * 1.44, atol=1e-12)


def test_limits_hold_the_t_pose_and_mirror():
    skeleton = human()
    limits = joint_limits(skeleton)
    assert np.all(limits.lower <= 0) and np.all(limits.upper >= 0)
    left, right = skeleton.index("LeftUpLeg"), skeleton.index("RightUpLeg")
    np.testing.assert_allclose(limits.lower[right], [limits.lower[left, 0], -limits.upper[left, 1], -limits.upper[left, 2]])
    assert np.all(np.isinf(limits.lower[skeleton.index("Hips")]))


def test_knees_bend_back_only_and_the_spine_shares_its_range():
    skeleton = human()
    limits = joint_limits(skeleton)
    knee = skeleton.index("RightLeg")
    assert limits.lower[knee, 0] == 0.0 and limits.upper[knee, 0] == pytest.approx(np.radians(140))
    spine = [skeleton.index(n) for n in ("Spine", "Spine1", "Spine2")]
    assert limits.upper[spine, 0].sum() == pytest.approx(np.radians(75))
    bent = np.full((2, len(skeleton), 3), -9.0)
    np.testing.assert_array_equal(limits.clip(bent)[:, 1:], np.broadcast_to(limits.lower[1:], (2, len(skeleton) - 1, 3)))


@pytest.mark.parametrize("mass, sex, message", [(0.0, "male", "weigh"), (-3.0, "male", "-3.0"), (70.0, "other", "other")])
def test_nonsense_is_refused(mass, sex, message):
    with pytest.raises(ValueError, match=message):
        anatomy(human(), mass, sex)


def test_in_a_pose_the_centre_of_mass_is_the_same():
    skeleton, rng = human(1.5), np.random.default_rng(3)
    body, turns, root = anatomy(skeleton), exp(rng.uniform(-1.0, 1.0, (len(skeleton), 3))), rng.uniform(-2.0, 2.0, 3)
    np.testing.assert_allclose(centre_in_pose(body, skeleton, Pose(root, turns)), centre_of_mass(body, *forward_kinematics(skeleton, root, turns)), atol=1e-12)
