"""Curves through keys, against scipy's."""

import hypothesis.strategies as st
import numpy as np
from hypothesis import given
from hypothesis.extra.numpy import arrays
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

from gambol.controllers.jump.body.curves import hermite, monotone

KEYS = st.integers(3, 7).flatmap(lambda count: st.tuples(
    arrays(float, count, elements=st.floats(0.05, 2.0)).map(np.cumsum),
    arrays(float, (count, 2, 3), elements=st.sampled_from([-2.0, -0.3, 0.0, 0.0, 0.1, 1.0, 4.0]))))


@given(KEYS)
def test_slopes_are_those_of_pchip(keys):
    times, values = keys
    assert np.allclose(monotone(times, values), PchipInterpolator(times, values).derivative()(times), atol=1e-9)


@given(KEYS, st.integers(0, 1000))
def test_curves_are_cubic_hermite_splines(keys, seed):
    times, values = keys
    rng = np.random.default_rng(seed)
    slopes, at = rng.normal(size=values.shape), rng.uniform(times[0] - 0.1, times[-1] + 0.1, 9)
    spline = CubicHermiteSpline(times, values, slopes)
    assert np.allclose(hermite(times, values, slopes, at), spline(at), atol=1e-7)
    assert np.allclose(hermite(times, values, slopes, times), values, atol=1e-9)
    assert np.array_equal(hermite(times, values, slopes, at[0]), hermite(times, values, slopes, at)[0])
