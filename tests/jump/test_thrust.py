"""The push: its force gives exactly the velocity and the way that were asked, and ends with nothing."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad_vec

from gambol.controllers.jump.motion.thrust import SPRING, push, risen_kernel

speed = st.floats(-3.0, 3.0)
cases = st.tuples(speed, speed, st.floats(0.05, 4.0), speed, st.floats(-0.5, 0.5), st.floats(0.02, 0.6), st.floats(0.5, 25.0), st.booleans())


def of(case):
    before_x, after_x, after_y, before_z, way_x, way_y, g, springs = case
    before, after = np.array([before_x, 0.0, before_z]), np.array([after_x, after_y, before_z])
    way, gravity = np.array([way_x, way_y, 0.1]), np.array([0.0, -g, 0.0])
    return push(way, before, after, gravity, springs), way, before, after


@given(cases)
def test_force_integrates_to_the_velocity_and_the_way(case):
    made, way, before, after = of(case)
    t = made.duration
    gain, _ = quad_vec(lambda s: made.force(s) + made.gravity, 0.0, t, epsabs=1e-11)
    gone, _ = quad_vec(lambda s: (t - s) * (made.force(s) + made.gravity), 0.0, t, epsabs=1e-11)
    np.testing.assert_allclose(before + gain, after, atol=1e-7)
    np.testing.assert_allclose(before * t + gone, way, atol=1e-7)


@given(cases)
def test_nothing_pushes_at_take_off_and_the_moved_way_ends_where_it_should(case):
    made, way, before, after = of(case)
    np.testing.assert_allclose(made.force(np.array(made.duration)), 0.0, atol=1e-9)
    gone, speed = made.moved(np.array(made.duration), before)
    np.testing.assert_allclose(gone, way, atol=1e-9)
    np.testing.assert_allclose(speed, after, atol=1e-9)


@given(cases)
def test_vertical_force_has_its_shape_and_never_pulls(case):
    made = of(case)[0]
    s = np.array([0.0, 0.5, 0.9])
    shape = made.force(s * made.duration)[:, 1] / made.level
    wanted = s[:, None] ** np.arange(len(SPRING)) @ SPRING if made.springs else 1.0 - s**4 + 0.3 * s * (1.0 - s**3)
    np.testing.assert_allclose(shape, wanted, rtol=1e-9)
    assert (made.force(np.linspace(0.0, made.duration, 50))[:, 1] >= -1e-9).all()


@given(st.floats(0.06, 0.6), st.floats(0.1, 4.0), st.floats(0.5, 25.0))
def test_a_push_of_the_way_it_rises_takes_that_long(duration, velocity, g):
    way = risen_kernel(duration, velocity, g)
    if way > 1e-3:
        made = push([0.0, way, 0.0], np.zeros(3), [0.0, velocity, 0.0], np.array([0.0, -g, 0.0]))
        assert made.duration == pytest.approx(duration, rel=1e-9)


def test_off_a_springy_landing_it_is_the_second_half_of_what_a_spring_gives():
    s = np.linspace(0.0, 1.0, 50)
    assert np.abs(s[:, None] ** np.arange(len(SPRING)) @ SPRING - np.cos(0.5 * np.pi * s)).max() < 0.004


@pytest.mark.parametrize("rise", [0.0, -0.1, np.nan])
def test_a_push_needs_room(rise):
    with pytest.raises(ValueError, match="room to rise"):
        push([0.0, rise, 0.0], np.zeros(3), [0.0, 2.0, 0.0], np.array([0.0, -9.81, 0.0]))
