"""What lost points are taken to be: the conditional mean, whatever guess one begins with."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from gambol.controllers.reconstruction.ours.lost_points import NOISE, LostPoints
from gambol.controllers.reconstruction.ours.networks import LAGS, view

POINTS = 4
WIDTH = 3 * POINTS * len(LAGS)
masks = hnp.arrays(bool, (len(LAGS), POINTS))


@pytest.fixture(scope="module")
def moments():
    """Of points that all follow from five numbers."""
    rng = np.random.default_rng(0)
    drawn = rng.normal(size=(4000, 5)) @ rng.normal(0, 0.2, (5, WIDTH)) + rng.normal(0, 0.01, (4000, WIDTH))
    points = drawn.reshape(-1, len(LAGS), POINTS, 3) + [[0.3, 1.0, 0], [-0.3, 1.0, 0], [0.1, 0.1, 0], [-0.1, 0.1, 0]]
    inputs, _ = view(points, np.zeros(len(points)))
    return LostPoints(inputs.mean(0), np.cov(inputs.T)), points


@given(masks)
def test_the_conditional_mean_is_the_least_squares_one(moments, mask):
    """As ridge regression on all the samples, centred, would find it."""
    (told, points), known = moments, np.repeat(mask.ravel(), 3)
    inputs, _ = view(points, np.zeros(len(points)))
    found = told.given(inputs[0], known)
    assert np.array_equal(found[known], inputs[0][known])
    if not known.any():
        assert np.allclose(found, told.mean)
    elif not known.all():
        away = inputs - told.mean
        gram = away[:, known].T @ away[:, known] / (len(away) - 1) + NOISE ** 2 * np.eye(known.sum())
        slope = np.linalg.solve(gram, away[:, known].T @ away[:, ~known] / (len(away) - 1))
        assert np.allclose(found[~known], told.mean[~known] + away[0, known] @ slope, atol=1e-6)


@given(masks, st.integers(0, 3999), st.floats(-3, 3))
def test_points_that_are_seen_stay_and_a_wild_guess_is_forgotten(moments, mask, which, heading):
    told, points = moments
    guess = np.where(mask[..., None], points[which], points[which] + 5.0)
    found = told.complete(guess, mask, heading)
    assert np.array_equal(found[mask], points[which][mask]) and np.isfinite(found).all()
    if mask[0].sum() >= 3:
        assert np.abs(found - points[which]).max() < 5.0, "five metres off have shrunk"


def test_they_are_kept_on_disk(moments, tmp_path):
    moments[0].save(tmp_path / "moments")
    back = LostPoints.load(tmp_path / "moments")
    assert np.array_equal(back.covariance, moments[0].covariance) and np.array_equal(back.mean, moments[0].mean)
    with pytest.raises(ValueError):
        LostPoints(np.zeros(5), np.zeros((5, 5))).save(tmp_path / "odd")
        LostPoints.load(tmp_path / "odd")
