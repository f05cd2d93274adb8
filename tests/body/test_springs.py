"""Dampers and springs are exact: the size of the step does not matter, and an integrator agrees."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from controllers.body.springs import cubic, damp, decay, settle, spring, spring_kernel

BATCHES = ((), (1,), (3, 1, 2, 1))
HALFLIVES = (0.02, 0.2, 1.5)


@pytest.fixture
def rng():
    return np.random.default_rng(1)


@pytest.mark.parametrize("halflife", HALFLIVES)
def test_half_is_left_after_a_halflife(halflife):
    assert decay(3.0, halflife, halflife) == pytest.approx(1.5, rel=1e-6)
    assert damp(3.0, 1.0, halflife, halflife) == pytest.approx(2.0, rel=1e-6)


@pytest.mark.parametrize("batch", BATCHES, ids=str)
@pytest.mark.parametrize("halflife", HALFLIVES)
def test_two_half_steps_are_one(batch, halflife, rng):
    x, v, goal = (rng.normal(size=batch + (3,)) for _ in range(3))
    dt = 0.1
    np.testing.assert_allclose(damp(damp(x, goal, halflife, dt / 2), goal, halflife, dt / 2),
                               damp(x, goal, halflife, dt), atol=1e-12)
    once = spring(x, v, goal, halflife, dt)
    twice = spring(*spring(x, v, goal, halflife, 0.3 * dt), goal, halflife, 0.7 * dt)
    for a, b in zip(once, twice):
        assert a.shape == batch + (3,)
        np.testing.assert_allclose(a, b, atol=1e-11)


@pytest.mark.parametrize("halflife", HALFLIVES)
def test_spring_agrees_with_an_integrator(halflife):
    y = 2 * np.log(2) / halflife
    x, v, goal, dt = 1.3, -4.0, 0.4, 0.7
    truth = solve_ivp(lambda _, s: [s[1], -2 * y * s[1] - y * y * (s[0] - goal)], (0, dt), [x, v],
                      rtol=1e-10, atol=1e-12).y[:, -1]
    np.testing.assert_allclose(spring(x, v, goal, halflife, dt), truth, atol=1e-7)


@pytest.mark.parametrize("halflife", HALFLIVES)
def test_damper_agrees_with_an_integrator(halflife):
    rate = np.log(2) / halflife
    truth = solve_ivp(lambda _, s: -rate * (s - 0.4), (0, 0.7), [1.3], rtol=1e-10, atol=1e-12).y[0, -1]
    assert damp(1.3, 0.4, halflife, 0.7) == pytest.approx(truth, abs=1e-7)


def test_they_arrive_and_from_rest_never_overshoot():
    x, v = np.array([1.0, -2.0]), np.zeros(2)
    for _ in range(200):
        step, v = spring(x, v, 0.5, 0.1, 1 / 60)
        assert np.all(np.abs(step - 0.5) <= np.abs(x - 0.5) + 1e-12)
        x = step
    np.testing.assert_allclose(x, 0.5, atol=1e-9)
    np.testing.assert_allclose(v, 0.0, atol=1e-8)
    np.testing.assert_allclose(damp(np.array([1.0, -2.0]), 0.5, 0.1, 5.0), 0.5, atol=1e-9)


def test_no_time_changes_nothing_and_no_halflife_jumps():
    assert spring(1.0, 2.0, 0.0, 0.2, 0.0) == (1.0, 2.0)
    assert damp(1.0, 0.0, 0.2, 0.0) == 1.0
    assert damp(1.0, 0.25, 0.0, 1 / 60) == 0.25
    position, velocity = spring(1.0, 2.0, 0.25, 0.0, 1 / 60)
    assert (position, velocity) == (0.25, 0.0)


def test_settling_starts_with_the_value_and_slope_it_was_given(rng):
    x, v = rng.normal(size=3), rng.normal(size=3)
    for offset in (lambda t: settle(x, v, 0.15, t), lambda t: cubic(x, v, 0.4, t)):
        np.testing.assert_allclose(offset(0.0)[0], x)
        np.testing.assert_allclose(offset(0.0)[1], v)
        ahead, here = offset(0.1 + 1e-6)[0], offset(0.1 - 1e-6)[0]
        np.testing.assert_allclose((ahead - here) / 2e-6, offset(0.1)[1], atol=1e-6)


def test_the_cubic_is_gone_at_its_end_and_stays_gone(rng):
    x, v = rng.normal(size=3), rng.normal(size=3)
    for time in (0.4, 0.5, 10.0):
        for part in cubic(x, v, 0.4, time):
            np.testing.assert_allclose(part, 0.0, atol=1e-12)


def test_the_kernel_is_the_array_version():
    np.testing.assert_allclose(spring_kernel(1.3, -4.0, 0.4, 0.2, 0.05), spring(1.3, -4.0, 0.4, 0.2, 0.05), atol=1e-14)
