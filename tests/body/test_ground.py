"""Ground frames and screws against scipy's matrix exponential: the same algebra from every place."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm

from gambol.controllers.body.ground_frame import advance, compose, relative, screw

law = settings(max_examples=40, deadline=None)
BATCHES = ((), (1,), (3, 1, 2, 1))
places = st.tuples(*[st.floats(-20, 20)] * 2, st.floats(-7, 7)).map(np.array)
speeds = st.one_of(st.floats(-4, 4), st.floats(-1e-6, 1e-6), st.just(0.0))
velocities = st.tuples(speeds, speeds, speeds).map(np.array)
times = st.floats(0.05, 1.5)


def matrix(ground):
    """A ground frame as a homogeneous matrix over (x, z): columns left, forward, place."""
    x, z, heading = ground
    return np.array([[np.cos(heading), np.sin(heading), x], [-np.sin(heading), np.cos(heading), z], [0, 0, 1]])


def twist(velocity):
    v_f, omega, v_l = velocity
    return np.array([[0, omega, v_l], [-omega, 0, v_f], [0, 0, 0]])


@law
@given(places, velocities, times)
def test_advancing_is_the_exponential_of_the_twist(ground, velocity, time):
    after = advance(ground, velocity, time)
    np.testing.assert_allclose(matrix(after), matrix(ground) @ expm(twist(velocity) * time), atol=1e-9)
    assert after[2] - ground[2] == pytest.approx(velocity[1] * time, abs=1e-12)  # headings are not wrapped


@law
@given(places, velocities, times)
def test_a_screw_undoes_advancing(ground, velocity, time):
    """Up to a whole turn, where every screw of that turn leads back to where it began."""
    velocity = velocity * [1, min(1, 6 / max(abs(velocity[1] * time), 1e-9)), 1]
    np.testing.assert_allclose(screw(ground, advance(ground, velocity, time), time), velocity, atol=1e-8)


@law
@given(places, places, times)
def test_advancing_undoes_a_screw(first, last, time):
    last = last * [1, 1, 0] + [0, 0, first[2] + np.clip(last[2] - first[2], -6, 6)]
    np.testing.assert_allclose(advance(first, screw(first, last, time), time), last, atol=1e-8)


@law
@given(places, velocities, times, times)
def test_advancing_twice_is_advancing_longer(ground, velocity, a, b):
    np.testing.assert_allclose(advance(advance(ground, velocity, a), velocity, b),
                               advance(ground, velocity, a + b), atol=1e-9)


def test_straight_curve_and_side():
    """Signs: heading 0 faces +Z, left is +X, and turning left brings +X to the front."""
    at = np.zeros(3)
    np.testing.assert_allclose(advance(at, np.array([2.0, 0, 0]), 1.0), [0, 2, 0], atol=1e-12)
    np.testing.assert_allclose(advance(at, np.array([0, 0, 0.5]), 1.0), [0.5, 0, 0], atol=1e-12)
    half_circle = advance(at, np.array([1.0, np.pi, 0]), 1.0)
    np.testing.assert_allclose(half_circle, [2 / np.pi, 0, np.pi], atol=1e-12)


@law
@given(places, places)
def test_composing_undoes_seeing_from(frame, ground):
    np.testing.assert_allclose(compose(frame, relative(frame, ground)), ground, atol=1e-10)
    np.testing.assert_allclose(relative(frame, compose(frame, ground)), ground, atol=1e-10)
    np.testing.assert_allclose(relative(frame, frame), 0, atol=1e-12)
    np.testing.assert_allclose(matrix(compose(frame, ground)), matrix(frame) @ matrix(ground), atol=1e-10)


@law
@given(places, places, velocities, times)
def test_motion_looks_the_same_from_everywhere(frame, ground, velocity, time):
    np.testing.assert_allclose(compose(frame, advance(ground, velocity, time)),
                               advance(compose(frame, ground), velocity, time), atol=1e-9)


@pytest.mark.parametrize("batch", BATCHES, ids=str)
def test_any_batch_axes(batch):
    rng = np.random.default_rng(0)
    a, b, v = (rng.normal(size=batch + (3,)) for _ in range(3))
    for result, one in ((screw(a, b, 0.7), lambda i: screw(a[i], b[i], 0.7)),
                        (advance(a, v, np.full(batch, 0.7)), lambda i: advance(a[i], v[i], 0.7)),
                        (relative(a, b), lambda i: relative(a[i], b[i])),
                        (compose(a, b), lambda i: compose(a[i], b[i]))):
        assert result.shape == batch + (3,)
        for i in np.ndindex(batch):
            np.testing.assert_allclose(result[i], one(i), atol=1e-14)
