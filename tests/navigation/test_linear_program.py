"""ORCA's linear programs against scipy's, and its half-planes against the definition of a velocity obstacle."""

import numpy as np
from hypothesis import given, settings, strategies as st
from scipy.optimize import linprog, minimize

from gambol.controllers.navigation.crowd import half_plane, nearest, nearest_to_all

FASTEST = 1.5


def planes_of(seed, count, spread=1.2):
    """Random half-planes (count, 4)."""
    rng = np.random.default_rng(seed)
    angle = rng.uniform(-np.pi, np.pi, count)
    normal = np.stack([np.cos(angle), np.sin(angle)], 1)
    return np.column_stack([normal * rng.uniform(-spread, 0.5 * spread, (count, 1)), normal])


def margins(planes, w):
    """How far (N,) a velocity is inside half-planes."""
    return ((w - planes[:, :2]) * planes[:, 2:]).sum(1)


def feasible(planes):
    """Whether some velocity of the disc keeps all: the largest least margin, by scipy, with the disc cut to a polygon inside it."""
    return least_worst(planes, 0) <= 0.0


def least_worst(planes, hard, sides=720):
    """By how much the worst half-plane from `hard` on must be broken at least, the first `hard` and the disc kept."""
    angles = np.linspace(-np.pi, np.pi, sides, endpoint=False)
    disc = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(sides)])
    soft = (np.arange(len(planes)) >= hard).astype(float)
    sides_of = np.column_stack([-planes[:, 2:], -soft])
    done = linprog([0, 0, 1], A_ub=np.vstack([disc, sides_of]),
                   b_ub=np.concatenate([np.full(sides, FASTEST), -(planes[:, :2] * planes[:, 2:]).sum(1)]), bounds=[(None, None)] * 2 + [(-9, None)])
    return done.x[2] if done.success else np.inf


@settings(deadline=None, max_examples=60)
@given(seed=st.integers(0, 10**6), count=st.integers(0, 8), wish=st.tuples(*[st.floats(-2, 2)] * 2))
def test_the_velocity_keeps_all_and_none_that_does_is_nearer(seed, count, wish):
    planes, out = planes_of(seed, count), np.empty(2)
    kept = nearest(planes, count, FASTEST, *wish, False, out)
    if count and abs(least_worst(planes, 0)) < 1e-3:
        return  # on the verge: the polygon's sides decide
    assert (kept == count) == (not count or feasible(planes))
    if kept == count:
        assert (margins(planes, out) >= -1e-7).all() and np.hypot(*out) <= FASTEST + 1e-7
        rules = [{"type": "ineq", "fun": lambda w: FASTEST**2 - w @ w}, {"type": "ineq", "fun": lambda w: margins(planes, w)}][:1 + bool(count)]
        other = minimize(lambda w: ((w - wish) ** 2).sum(), out, constraints=rules, method="SLSQP")
        assert np.hypot(*(out - wish)) <= np.hypot(*(other.x - wish)) + 1e-4
        tried = np.random.default_rng(seed).uniform(-FASTEST, FASTEST, (4000, 2))
        fits = (np.hypot(*tried.T) <= FASTEST) & (((tried[:, None] - planes[:, :2]) * planes[:, 2:]).sum(-1) >= 0).all(1)
        assert not fits.any() or np.hypot(*(out - wish)) <= np.hypot(*(tried[fits] - wish).T).min() + 1e-7


@settings(deadline=None, max_examples=60)
@given(seed=st.integers(0, 10**6), count=st.integers(3, 9), hard=st.integers(0, 1))
def test_where_none_keeps_all_the_worst_is_broken_least(seed, count, hard):
    planes, out = planes_of(seed, count, 2.0), np.empty(2)
    kept = nearest(planes, count, FASTEST, 0.3, 0.2, False, out)
    least = least_worst(planes, hard)
    if kept == count or kept < hard or not np.isfinite(least) or least < 1e-3:
        return
    nearest_to_all(planes, hard, count, kept, FASTEST, np.empty_like(planes), out)
    assert np.hypot(*out) <= FASTEST + 1e-7 and (margins(planes[:hard], out) >= -1e-7).all()
    assert -margins(planes[hard:], out).min() <= least + 1e-4


@settings(deadline=None, max_examples=100)
@given(way=st.floats(-np.pi, np.pi), far=st.floats(0.61, 5.0), v=st.tuples(*[st.floats(-2, 2)] * 2), share=st.floats(0.05, 0.95))
def test_two_who_keep_to_their_half_planes_do_not_touch_within_the_horizon(way, far, v, share):
    p, apart, horizon = far * np.array([np.sin(way), np.cos(way)]), 0.6, 3.0
    v, one, other = np.array(v), np.empty(4), np.empty(4)
    half_plane(*p, *v, apart, horizon, 0.5, share, 0.0, one)
    half_plane(*-p, *-v, apart, horizon, 0.5, 1.0 - share, 0.0, other)
    assert np.allclose(one[2:], -other[2:])  # reciprocal
    relative = v + one[:2] - other[:2]  # both go to the edge of what is left to them
    times = np.linspace(0.0, horizon, 400)[:, None]
    assert np.linalg.norm(p - relative * times, axis=1).min() >= apart - 1e-6
    along = np.array([-one[3], one[2]])
    for slide in (-1.0, 1.0):  # and to anywhere on it
        assert np.linalg.norm(p - (relative + slide * along) * times, axis=1).min() >= apart - 1e-6


def test_half_planes_are_no_stricter_than_they_must_be():
    """A hair across the edge, where it touches the velocity obstacle, they do touch."""
    rng, tight = np.random.default_rng(0), 0
    for _ in range(200):
        p, v, one = rng.normal(0, 2, 2), rng.normal(0, 1, 2), np.empty(4)
        if np.hypot(*p) < 0.7:
            continue
        half_plane(*p, *v, 0.6, 3.0, 0.5, 1.0, 0.0, one)
        relative = v + one[:2] - 1e-3 * one[2:]
        tight += np.linalg.norm(p - relative * np.linspace(0, 3.0, 3000)[:, None], axis=1).min() < 0.6
        assert tight
    assert tight > 100


def test_who_overlap_part():
    for p in ((0.3, 0.1), (0.0, -0.5), (1e-3, 0.0)):
        one = np.empty(4)
        half_plane(*p, 0.4, -0.2, 0.6, 3.0, 0.5, 0.5, 0.0, one)
        away = -np.array(p) / np.hypot(*p)
        assert np.allclose(one[2:], away)
        new = np.array([0.4, -0.2]) + 2 * one[:2]
        assert np.isclose(new @ away, (0.6 - np.hypot(*p)) / 0.5)
