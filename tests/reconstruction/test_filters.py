"""What is steady passes, what is noise does not, and how much of it is as computed."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import solve_discrete_are

from gambol.controllers.reconstruction.ours.filters import NATURAL, Motion, gains, noise

INDICES = st.one_of(st.floats(0.01, 1e4), st.just(math.inf))


@given(INDICES, st.floats(-5, 5), st.floats(-1, 1))
def test_what_stands_or_moves_evenly_passes_without_lag(index, place, change):
    motion = Motion(np.array([place]), np.array([change]))
    for t in range(1, 30):
        motion = motion.towards(np.array([place + t * change]), index)
        assert np.allclose(motion.place, place + t * change) and np.allclose(motion.change, change)


@pytest.mark.parametrize("index", [0.02, 0.1, 0.5, 1.0, 3.0])
def test_gains_are_the_kalman_filters(index):
    """Against the Riccati equation: acceleration constant in a frame, of deviation `index` in units of the noise."""
    step, push = np.array([[1.0, 1.0], [0.0, 1.0]]), np.array([0.5, 1.0])
    p = solve_discrete_are(step.T, np.array([[1.0], [0.0]]), index ** 2 * np.outer(push, push), np.eye(1))
    assert np.allclose(gains(index), p[:, 0] / (p[0, 0] + 1.0), atol=1e-6)


def test_where_there_is_no_noise_measurements_are_believed():
    seen = np.random.default_rng(0).normal(size=(50, 4))
    motion = Motion(seen[0], np.zeros(4))
    for now in seen[1:]:
        motion = motion.towards(now, math.inf)
        assert np.allclose(motion.place, now, atol=1e-12)
    assert np.allclose(gains(1e7), (1.0, 1.0), atol=1e-5)


@pytest.mark.parametrize("index", [0.05, 0.3, 1.0])
def test_noise_comes_through_as_computed(index):
    """The variance of the place is (2α² + 2β − 3αβ) / (α(4 − 2α − β)) of the noise's."""
    alpha, beta = gains(index)
    rng, motion, places = np.random.default_rng(1), Motion(np.zeros(4000), np.zeros(4000)), []
    for t in range(400):
        motion = motion.towards(rng.normal(size=4000), index)
        if t >= 300:
            places.append(motion.place)
    assert np.isclose(np.var(places), (2 * alpha ** 2 + 2 * beta - 3 * alpha * beta) / (alpha * (4 - 2 * alpha - beta)), rtol=0.03)


@given(st.floats(0.01, 1e4))
def test_a_step_is_reached_soon_and_hardly_overshot(index):
    """Never backward at first, at most a third too far, and there after a time that the gains tell."""
    motion, places = Motion(np.zeros(1), np.zeros(1)), []
    for _ in range(int(20 / math.sqrt(index)) + 20):
        motion = motion.towards(np.ones(1), index)
        places.append(motion.place[0])
    rise = places[:int(np.argmax(places)) + 1]
    assert np.all(np.diff([0.0, *rise]) >= 0.0) and max(places) < 1.34 and abs(places[-1] - 1.0) < 1e-3


def test_what_is_lost_coasts_to_a_halt_and_harms_nothing_else():
    motion = Motion(np.zeros(3), np.ones(3))
    for t in range(1, 200):
        motion = motion.towards(np.array([np.nan, np.inf, t]), 0.3)
    assert np.allclose(motion.place, [10.0, 10.0, 199.0]) and np.allclose(motion.change[:2], 0.0, atol=1e-6)


@given(st.floats(0.003, 0.05), st.integers(0, 1000))
@settings(max_examples=20)
def test_noise_is_told_on_a_moving_body(level, seed):
    """Rightly over many bodies, and for most of them: fifteen frames of four points tell it to a seventh, now and then not
    to a half. The least noise is told a little too small, as a body's own motion is taken off."""
    t = np.arange(15)[:, None, None] / 60
    rng, told, spoilt = np.random.default_rng(seed), [], []
    for _ in range(300):
        still = 0.4 * np.sin(2 * np.pi * (1.2 * t + rng.uniform(size=(4, 3)))) + 1.4 * t
        assert noise(still) == 0.0
        points = still + rng.normal(0, level, still.shape)
        told.append(noise(points) / level)
        points[7, 2] = 40.0, np.nan, -3.0  # a wild point is not noise
        points[3:5, 1] = np.nan
        spoilt.append(noise(points) / level)
        assert noise(still + rng.normal(0, 0.3 * NATURAL, still.shape)) == 0.0
    assert 0.8 < np.mean(told) < 1.08 and 0.88 < np.mean(spoilt) < 1.16  # five and more of the means' own deviations
    assert np.std(told) < 0.2 and np.std(spoilt) < 0.22
    assert noise(np.full((15, 4, 3), np.nan)) == 0.0


@given(st.floats(1e-6, 1e-5), st.integers(0, 99))
def test_what_has_heard_little_is_a_line_through_all_that_it_heard(index, seed):
    """By least squares, until the steady state's gains, here next to nothing, are reached."""
    seen = np.random.default_rng(seed).normal(size=12)
    motion = Motion(seen[:1], np.zeros(1), 1.0)
    for t in range(1, 12):
        motion = motion.towards(seen[t:t + 1], index)
        slope, start = np.polyfit(np.arange(t + 1), seen[:t + 1], 1)
        assert np.allclose(motion.place, start + slope * t) and np.allclose(motion.change, slope)


@given(st.floats(0.05, 3.0), st.integers(0, 99))
def test_in_the_end_it_is_the_steady_state(index, seed):
    seen = np.random.default_rng(seed).normal(size=(200, 3))
    short, long = Motion(seen[0], np.zeros(3), 1.0), Motion(seen[0], np.zeros(3))
    for now in seen[1:]:
        short, long = short.towards(now, index), long.towards(now, index)
    assert np.allclose(short.place, long.place, atol=1e-6)


def test_a_velocity_from_before_noise_was_known_is_soon_forgotten():
    """Three frames believed to the full, then that they are noisy by one: places of one who stands stay within the noise."""
    rng, off = np.random.default_rng(3), []
    motion = Motion(rng.normal(size=(500, 3)), np.zeros((500, 3)), 2.0)
    for t in range(30):
        motion = motion.towards(rng.normal(size=(500, 3)), np.inf if t < 3 else 0.03)
        off.append(np.sqrt(np.mean(motion.place ** 2)))
    assert max(off) < 1.3 and off[-1] < 0.6
