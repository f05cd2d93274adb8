"""Dampers and springs are exact: the size of the step does not matter, and an integrator agrees."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from gambol.controllers.body.springs import damp, decay, settle, spring_kernel

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


@pytest.mark.parametrize("halflife", HALFLIVES)
def test_two_parts_of_a_springs_step_are_one(halflife, rng):
    x, v, goal = rng.normal(size=3)
    once = spring_kernel(x, v, goal, halflife, 0.1)
    twice = spring_kernel(*spring_kernel(x, v, goal, halflife, 0.03), goal, halflife, 0.07)
    np.testing.assert_allclose(twice, once, atol=1e-11)


@pytest.mark.parametrize("halflife", HALFLIVES)
def test_spring_agrees_with_an_integrator(halflife):
    y = 2 * np.log(2) / halflife
    x, v, goal, dt = 1.3, -4.0, 0.4, 0.7
    truth = solve_ivp(lambda _, s: [s[1], -2 * y * s[1] - y * y * (s[0] - goal)], (0, dt), [x, v],
                      rtol=1e-10, atol=1e-12).y[:, -1]
    np.testing.assert_allclose(spring_kernel(x, v, goal, halflife, dt), truth, atol=1e-7)


@pytest.mark.parametrize("halflife", HALFLIVES)
def test_damper_agrees_with_an_integrator(halflife):
    rate = np.log(2) / halflife
    truth = solve_ivp(lambda _, s: -rate * (s - 0.4), (0, 0.7), [1.3], rtol=1e-10, atol=1e-12).y[0, -1]
    assert damp(1.3, 0.4, halflife, 0.7) == pytest.approx(truth, abs=1e-7)


def test_they_arrive_and_from_rest_never_overshoot():
    for x in (1.0, -2.0):
        v = 0.0
        assert damp(x, 0.5, 0.1, 5.0) == pytest.approx(0.5, abs=1e-9)
        for _ in range(200):
            step, v = spring_kernel(x, v, 0.5, 0.1, 1 / 60)
            assert abs(step - 0.5) <= abs(x - 0.5) + 1e-12
            x = step
        assert (x, v) == pytest.approx((0.5, 0.0), abs=1e-8)


def test_no_time_changes_nothing_and_no_halflife_jumps():
    assert spring_kernel(1.0, 2.0, 0.0, 0.2, 0.0) == (1.0, 2.0)
    assert damp(1.0, 0.0, 0.2, 0.0) == 1.0
    assert damp(1.0, 0.25, 0.0, 1 / 60) == 0.25
    assert spring_kernel(1.0, 2.0, 0.25, 0.0, 1 / 60) == (0.25, 0.0)


@pytest.mark.parametrize("batch", BATCHES, ids=str)
def test_settling_is_the_spring_towards_nothing(batch, rng):
    x, v = rng.normal(size=(2,) + batch + (3,))
    offset, velocity = settle(x, v, 0.15, 0.1)
    assert offset.shape == velocity.shape == batch + (3,)
    for i in np.ndindex(offset.shape):
        np.testing.assert_allclose((offset[i], velocity[i]), spring_kernel(x[i], v[i], 0.0, 0.15, 0.1), atol=1e-14)
