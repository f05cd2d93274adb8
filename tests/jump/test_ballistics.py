"""Arcs: they end where they should, least effort is least, and apexes are apexes."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.optimize import minimize_scalar

from gambol.controllers.jump.body.ballistics import along, apex_airtime, least_effort, take_off_velocity

places = arrays(float, 3, elements=st.floats(-4, 4))
falls = st.sampled_from([9.81, 1.62, 3.7, 25.0]).map(lambda g: np.array([0.0, -g, 0.0]))


@given(places, places, st.floats(0.05, 5), falls)
def test_a_take_off_ends_where_it_should(start, end, airtime, gravity):
    velocity = take_off_velocity(start, end, airtime, gravity)
    np.testing.assert_allclose(along(start, velocity, airtime, gravity), end, atol=1e-9)


@given(places, places, places, falls)
def test_least_effort_is_least(start, end, run, gravity):
    assume(np.linalg.norm(end - start) > 0.05)
    airtime = least_effort(start, end, run, gravity)
    assert airtime > 0

    def effort(t):
        return np.linalg.norm(take_off_velocity(start, end, t, gravity) - run)
    tries = np.geomspace(0.01, 30, 400)
    rough = tries[np.argmin([effort(t) for t in tries])]
    found = minimize_scalar(effort, bounds=(0.9 * rough, 1.1 * rough), method="bounded").fun
    assert effort(airtime) <= found + 1e-6


def test_from_rest_the_quartic_has_its_closed_form():
    start, end = np.zeros(3), np.array([1.2, 0.0, 0.9])
    assert least_effort(start, end) == pytest.approx((4 * 2.25 / 9.81**2) ** 0.25)
    assert least_effort(start, start) == 0.0


@given(places, st.floats(0.02, 2.0), falls)
def test_an_apex_is_as_high_as_was_asked(end, height, gravity):
    assume(end[1] < height)
    airtime = apex_airtime(np.zeros(3), end, height, gravity)
    velocity = take_off_velocity(np.zeros(3), end, airtime, gravity)
    assert velocity[1] ** 2 / (-2 * gravity[1]) == pytest.approx(height, abs=1e-9)
    with pytest.raises(ValueError, match="never comes"):
        apex_airtime(np.zeros(3), np.array([0.0, height + 0.1, 0.0]), height, gravity)


def test_batches_broadcast():
    ends = np.ones((2, 5, 3))
    assert take_off_velocity(np.zeros(3), ends, np.full((2, 5), 0.5)).shape == (2, 5, 3)
    assert along(np.zeros(3), np.ones(3), np.linspace(0, 1, 7)).shape == (7, 3)
