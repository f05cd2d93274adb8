"""The prior of recorded jumps: what is fitted is what is asked for again, and takes that it never saw are near it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gambol.controllers.body import forward_kinematics
from gambol.controllers.jump import Physique
from gambol.controllers.jump.body import carriage
from gambol.controllers.jump.prior import LEGS, ROWS, Prior, carried, fit, recorded_jumps
from gambol.controllers.jump.prior.build import as_far, regressed
from gambol.controllers.jump.prior.coefficients import BETWEEN, COLUMNS, ELBOWS, FEATURES, mirrored
from gambol.controllers.jump.prior.recorded import aligned

PRIOR = Prior.load()


def test_what_the_carriage_does_is_told_again():
    """The angles that a pose is made of are those that are read off it."""
    skeleton, rng = Physique().skeleton, np.random.default_rng(4)
    angles = np.column_stack([rng.uniform(-0.4, 0.4, (20, 3)), *[np.column_stack([rng.uniform(-0.8, 0.8, (20, 3)), rng.uniform(0.2, 1.5, 20)]) for _ in range(2)]])
    local = np.tile(np.eye(3), (20, len(skeleton), 1, 1))
    for one, posed in zip(angles, local):
        carriage.carry_kernel(one, carriage.joints_of(skeleton), posed)
    c, s = np.cos(angles[:, 0]), np.sin(angles[:, 0])
    local[:, 0, 1, 1], local[:, 0, 1, 2], local[:, 0, 2, 1], local[:, 0, 2, 2] = c, -s, s, c
    turned = forward_kinematics(skeleton, np.zeros((20, 3)), local)[1]
    np.testing.assert_allclose(carried(skeleton, local, turned)[:, :LEGS], angles, atol=1e-9)


@given(st.integers(0, 2**32 - 1))
def test_mirrored_twice_is_the_same(seed):
    keys = np.random.default_rng(seed).normal(size=(ROWS, COLUMNS))
    assert np.array_equal(mirrored(mirrored(keys)), keys)
    left, right = (PRIOR.keys(*[PRIOR.features(2.0, 1.5, 3.0, 1.0, True)] * 2, single=side) for side in (0, 1))
    assert np.array_equal(mirrored(left), right)


@given(st.floats(-5.0, 30.0), st.floats(-9.0, 9.0), st.floats(-9.0, 9.0), st.floats(0.5, 1.5))
def test_beyond_what_was_recorded_it_is_as_at_its_rim(speed, far, pace, size):
    """So no wish makes a posture that no body has."""
    features = PRIOR.features(speed, far, pace, size, False)
    assert (features >= PRIOR.least[0] - 1e-9).all() and (features <= PRIOR.most[0] + 1e-9).all()
    keys = PRIOR.keys(features, features)
    knees, elbows = keys[:, [LEGS + 1, LEGS + 4]], keys[:, [6, 10]]
    assert knees.min() > 0.0 and knees.max() < 2.6 and elbows.min() > 0.0 and elbows.max() < np.radians(150.0)
    assert np.abs(keys[:, :2]).max() < 1.4
    assert 0.05 < features @ PRIOR.depth < 0.5


def test_lines_through_keys_and_slopes_over_features_are_found_again():
    rng = np.random.default_rng(1)
    keys, events = rng.normal(size=(ROWS, COLUMNS)), np.array([3, 60, 90, 130, 150, 220])
    frames = np.interp(np.arange(240), np.interp(np.linspace(0, 5, ROWS), np.arange(6), events), np.arange(ROWS))
    shown = np.stack([np.interp(frames, np.arange(ROWS), column) for column in keys.T], -1)
    np.testing.assert_allclose(aligned(shown, events), keys, atol=0.15)
    features = np.column_stack([np.ones(400), rng.normal(size=(400, 3))])
    slopes = rng.normal(size=(4, 2))
    np.testing.assert_allclose(regressed(features, features @ slopes, np.ones(400)), slopes, atol=0.02)


def test_elbows_bend_as_far_as_recorded_though_people_bend_them_at_different_moments():
    """In a hop by 18°, where recorded people bend them by 31°: arms hung."""
    moments = np.linspace(0.0, 2.0, 9)
    keys = np.zeros((len(moments), ROWS, COLUMNS))
    keys[..., ELBOWS] = 0.8 + 0.3 * np.sin(0.5 * np.arange(ROWS) + moments[:, None])[..., None]
    features, weight = np.column_stack([np.ones(len(moments)), np.random.default_rng(2).normal(size=(len(moments), FEATURES - 1))]), np.ones(len(moments))
    mean = np.zeros((FEATURES, ROWS, COLUMNS))
    mean[0] = keys.mean(0)
    until, made = slice(3 * BETWEEN), as_far(mean, features, keys, weight)[0]
    shown = keys[:, until, ELBOWS].var(1).mean(0)
    assert (mean[0][until, ELBOWS].var(0) < 0.75 * shown).all()
    np.testing.assert_allclose(made[until, ELBOWS].var(0), shown, rtol=1e-9)
    made[until, ELBOWS] = mean[0][until, ELBOWS]
    assert np.array_equal(made, mean[0]), "nothing else is changed"
    hop = PRIOR.keys(*[PRIOR.features(2.05, 0.0, 0.0, 1.0, False)] * 2)[:, ELBOWS]
    assert np.degrees(np.ptp(hop, axis=0)).min() > 26.0


def test_arms_of_short_leaps_off_one_foot_lie_between_those_of_strides_and_of_long_leaps():
    """They were as in leaps of half a second, level aside, however short a flight was: hands 1.2 m apart. A runner's arms go against his legs: the left one, which leads as he leaves the right foot."""
    skeleton, apart, behind = Physique().skeleton, [], []
    hands = [skeleton.index(name) for name in ("LeftHand", "RightHand")]
    for airtime in (0.22, 0.3, 0.42, 0.55):
        keys = PRIOR.keys(*[PRIOR.features(0.5 * 9.81 * airtime, 1.2, 3.0, 1.0, True)] * 2, single=1)[2 * BETWEEN:3 * BETWEEN + 1]
        local = np.tile(np.eye(3), (len(keys), len(skeleton), 1, 1))
        for row, posed in zip(keys, local):
            carriage.carry_kernel(np.ascontiguousarray(row[:LEGS]), carriage.joints_of(skeleton), posed)
        places = forward_kinematics(skeleton, np.zeros((len(keys), 3)), local)[0][:, hands]
        apart.append(float(np.linalg.norm(places[:, 0] - places[:, 1], axis=-1).mean()))
        behind.append(float((places[:, 1] - places[:, 0])[:, 2].mean()))
    assert (np.diff(apart) > 0.1).all() and apart[0] < 0.5 and apart[2] < 0.85 < 1.0 < apart[3]
    assert min(behind) > 0.08


def test_takes_left_out_are_near_what_the_others_say(shared):
    """The rows of the flight, of takes by three people: knees, hips, trunk."""
    body = Physique()
    found, notes = recorded_jumps(shared / "mocap", body.skeleton, body.anatomy,
                            ("cmu/16/16_02.amc", "cmu/16/16_05.amc", "cmu/127/127_27.amc", "woody2/wd2_Physics_Jump00.bvh", "cmu/49/49_03.amc"))
    assert not notes and len(found) > 12
    air = slice(ROWS // 5 * 2, ROWS // 5 * 3 + 1)
    for take in ("16_02", "wd2_Physics_Jump00"):
        prior = fit([one for one in found if one.clip != take])
        errors = []
        for one in (one for one in found if one.clip == take):
            features = np.clip([1.0, one.airtime, one.far, one.pace], prior.least[0], prior.most[0])
            off = np.degrees(prior.keys(features, features) - one.keys)[air]
            errors.append([np.sqrt(np.mean(off[:, columns] ** 2)) for columns in ([LEGS + 1, LEGS + 4], [LEGS, LEGS + 3], [0])])
        knee, hip, lean = np.median(errors, 0)
        assert knee < 20.0 and hip < 25.0 and lean < 20.0  # by four other takes; by all, compare_jump.py prints


def test_a_prior_takes_jumps_of_both_kinds(tmp_path):
    with pytest.raises(ValueError, match="off both feet and off one, got 0 and 0"):
        fit([])
    body = Physique()
    found, notes = recorded_jumps(tmp_path, body.skeleton, body.anatomy, ("none.bvh",))
    assert not found and "none.bvh" in notes[0]
