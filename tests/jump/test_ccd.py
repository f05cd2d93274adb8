"""Cyclic coordinate descent: never beyond a limit, there where it can be, as near as can be where not."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from gambol.controllers.body import human
from gambol.controllers.body.anatomy import joint_limits
from gambol.controllers.body.ccd import TOLERANCE, foot_turn_kernel, reach
from gambol.controllers.body.rotation_kernels import exp_kernel, log_kernel


def end_of(turns, bones):
    place, turned = np.zeros(3), Rotation.identity()
    for turn, bone in zip(turns, bones):
        turned = turned * Rotation.from_rotvec(turn)
        place = place + turned.apply(bone)
    return place


def leg(flexibility=1.0):
    """Thigh and shank of the standard human, the knee a hinge."""
    skeleton, limits = human(), joint_limits(human())
    hip = skeleton.index("LeftUpLeg")
    lower, upper = limits.lower[[hip, hip + 1]] * flexibility, limits.upper[[hip, hip + 1]] * flexibility
    lower[1, 1:] = upper[1, 1:] = 0.0
    return skeleton.offsets[[hip + 1, hip + 2]], lower, upper


def chain(rng):
    """Some joints, hinges and balls, with limits around straight."""
    n = int(rng.integers(1, 5))
    lower, upper = -rng.uniform(0.1, 2, (n, 3)), rng.uniform(0.1, 2, (n, 3))
    for k in np.flatnonzero(rng.random(n) < 0.5):
        fixed = np.arange(3) != rng.integers(3)
        lower[k, fixed] = upper[k, fixed] = 0.0
    return rng.normal(size=(n, 3)) * 0.3, lower, upper


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1), st.booleans())
def test_limits_hold_and_the_gap_is_true_and_never_grows(seed, far):
    rng = np.random.default_rng(seed)
    bones, lower, upper = chain(rng)
    goal = rng.normal(size=3) * (5.0 if far else 0.4)
    start = rng.uniform(lower, upper)
    found = reach(np.zeros(3), np.eye(3), bones, start, goal, lower, upper, iterations=40)
    assert (found.turns >= lower).all() and (found.turns <= upper).all()
    there = end_of(found.turns, bones)
    np.testing.assert_allclose(found.joints[-1], there, atol=1e-9)
    assert found.gap == pytest.approx(np.linalg.norm(there - goal), abs=1e-9)
    assert found.gap <= np.linalg.norm(end_of(start, bones) - goal) + 1e-9


@given(st.integers(0, 2**32 - 1), st.floats(0.3, 1.2), st.sampled_from([0.0, 0.3, 0.9]))
@example(223171, 1.0, 0.0)  # the descent alone ends 1.1 cm away
def test_a_leg_comes_to_every_place_it_can(seed, flexibility, held):
    """Also to those which it comes to only at its limits; held: the share of its turns that are at one."""
    rng = np.random.default_rng(seed)
    bones, lower, upper = leg(flexibility)
    turns = rng.uniform(lower, upper)
    turns = np.where(rng.random(turns.shape) < held, np.where(rng.random(turns.shape) < 0.5, lower, upper), turns)
    found = reach(np.zeros(3), np.eye(3), bones, np.zeros_like(bones), end_of(turns, bones), lower, upper)
    assert found.gap < TOLERANCE and (found.turns >= lower).all() and (found.turns <= upper).all()


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_out_of_reach_a_leg_is_as_near_as_an_optimiser_gets(seed):
    bones, lower, upper = leg()
    rng = np.random.default_rng(seed)
    goal = rng.normal(size=3)
    goal *= rng.uniform(0.9, 2.0) / np.linalg.norm(goal)
    found = reach(np.zeros(3), np.eye(3), bones, np.zeros((2, 3)), goal, lower, upper)
    free = upper > lower

    def gap(values):
        turns = np.zeros((2, 3))
        turns[free] = values
        return np.linalg.norm(end_of(turns, bones) - goal)
    best = minimize(gap, found.turns[free], bounds=list(zip(lower[free], upper[free])), method="L-BFGS-B").fun
    assert found.gap <= best + 2e-3


@pytest.mark.parametrize("goal", [(0, 0, 0), (0, -0.4, 0), (0, 0.4, 0), (0, -2, 0), (0, 2, 0), (0, -0.8562, 0)], ids=str)
def test_degenerate_goals_are_no_trouble(goal):
    """On the hip, along the straight leg, straight up: directions vanish there."""
    bones, lower, upper = leg()
    found = reach(np.zeros(3), np.eye(3), bones, np.zeros((2, 3)), np.array(goal, float), lower, upper)
    assert np.isfinite(found.turns).all() and np.isfinite(found.gap)
    if goal == (0, -0.4, 0):
        assert found.gap < 1e-3  # a straight leg has to be bent to get there
    nothing = reach(np.zeros(3), np.eye(3), np.zeros((2, 3)), np.zeros((2, 3)), np.ones(3), lower, upper)
    assert np.isfinite(nothing.turns).all()


def test_batches_are_solved_each_for_itself():
    bones, lower, upper = leg()
    goals = np.array([[[0.0, -0.5, 0.1]], [[0.1, -0.6, 0.2]]])
    found = reach(np.zeros(3), np.eye(3), bones, np.zeros((2, 3)), goals, lower, upper)
    assert found.turns.shape == (2, 1, 2, 3) and found.joints.shape == (2, 1, 3, 3)
    one = reach(np.zeros(3), np.eye(3), bones, np.zeros((2, 3)), goals[1, 0], lower, upper)
    np.testing.assert_array_equal(found.turns[1, 0], one.turns)


def test_what_is_no_chain_is_refused():
    bones, lower, upper = leg()
    with pytest.raises(ValueError, match="goal must be finite"):
        reach(np.zeros(3), np.eye(3), bones, np.zeros((2, 3)), np.full(3, np.nan), lower, upper)
    with pytest.raises(ValueError, match="lower limit"):
        reach(np.zeros(3), np.eye(3), bones, np.zeros((2, 3)), np.zeros(3), upper, lower)
    with pytest.raises(ValueError, match="must be"):
        reach(np.zeros(3), np.eye(3), bones[0], np.zeros((2, 3)), np.zeros(3), lower, upper)


@settings(deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from([1.0, 1e-9, 1e-5, np.pi, np.pi - 1e-7]))
def test_rotation_vectors_come_back(seed, angle):
    vector = np.random.default_rng(seed).normal(size=3)
    vector *= angle / np.linalg.norm(vector)
    matrix, back = np.empty((3, 3)), np.empty(3)
    exp_kernel(*vector, matrix)
    np.testing.assert_allclose(matrix, Rotation.from_rotvec(vector).as_matrix(), atol=1e-12)
    log_kernel(matrix, back)
    np.testing.assert_allclose(Rotation.from_rotvec(back).as_matrix(), matrix, atol=1e-9)


def test_a_foot_is_turned_back_as_far_as_its_ankle_goes():
    parent = Rotation.from_rotvec([0.4, 0.0, 0.0]).as_matrix()
    turn, out = np.empty(3), np.empty((3, 3))
    assert foot_turn_kernel(parent, np.eye(3), np.full(3, -1.0), np.ones(3), turn, out) == 0.0
    np.testing.assert_allclose(out, np.eye(3), atol=1e-12)
    assert foot_turn_kernel(parent, np.eye(3), np.full(3, -0.3), np.ones(3), turn, out) == pytest.approx(0.1)
    assert turn[0] == pytest.approx(-0.3)
