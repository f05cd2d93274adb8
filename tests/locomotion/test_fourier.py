"""Fourier series of cycles: exact for what they can hold, the best fit for what they can't."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.signal import resample

from gambol.controllers.locomotion import fourier

law = settings(max_examples=40, deadline=None)
seeds = st.integers(0, 2**32 - 1)
harmonics = st.integers(0, 14)


def some(seed, *shape):
    return np.random.default_rng(seed).normal(size=shape)


@law
@given(seeds, harmonics, st.integers(0, 9))
def test_fitting_undoes_evaluating(seed, count, spare):
    """Every series of N harmonics comes back from 2N + 1 or more of its samples."""
    coefficients = some(seed, 2 * count + 1, 3)
    samples = 2 * count + 1 + spare
    signal = fourier.evaluate(coefficients, np.arange(samples) / samples)
    np.testing.assert_allclose(fourier.fit(signal, count), coefficients, atol=1e-12)


@law
@given(seeds, st.integers(1, 30))
def test_a_full_series_agrees_with_scipys_resampling(seed, count):
    samples = some(seed, 2 * count + 1, 2)
    fine = 4 * len(samples)
    np.testing.assert_allclose(fourier.evaluate(fourier.fit(samples, count), np.arange(fine) / fine),
                               resample(samples, fine), atol=1e-10)


@law
@given(seeds, st.integers(1, 12))
def test_a_shortened_series_is_the_least_squares_fit(seed, count):
    samples = some(seed, 32, 4)
    phase = np.arange(32) / 32
    waves = [np.ones(32)]
    for k in range(1, count + 1):
        waves += [np.cos(2 * np.pi * k * phase), np.sin(2 * np.pi * k * phase)]
    best, *_ = np.linalg.lstsq(np.stack(waves, 1), samples)
    np.testing.assert_allclose(fourier.fit(samples, count), best, atol=1e-12)


@pytest.mark.parametrize("k", (1, 2, 12))
def test_the_angular_frequency_is_two_pi_k_over_the_period(k):
    """The k-th harmonic swings k times a cycle, not k / 2 times as the paper prints it."""
    phase = np.arange(96) / 96
    rows = fourier.fit(np.stack([np.cos(2 * np.pi * k * phase), np.sin(2 * np.pi * k * phase)], 1))
    wanted = np.zeros_like(rows)
    wanted[2 * k - 1, 0] = wanted[2 * k, 1] = 1.0
    np.testing.assert_allclose(rows, wanted, atol=1e-13)


@law
@given(seeds, st.floats(-3, 3), st.integers(-3, 3))
def test_a_series_closes(seed, phase, turns):
    coefficients = some(seed, 25, 2)
    np.testing.assert_allclose(fourier.evaluate(coefficients, phase + turns),
                               fourier.evaluate(coefficients, phase), atol=1e-10)


@law
@given(seeds, st.lists(st.floats(0, 1), min_size=2, max_size=5))
def test_a_blend_of_series_is_the_series_of_the_blend(seed, weights):
    signals = some(seed, len(weights), 40, 3)
    phase = np.linspace(0, 1, 17)
    blended = np.tensordot(weights, fourier.fit(signals), 1)
    apart = sum(w * fourier.evaluate(fourier.fit(s), phase) for w, s in zip(weights, signals))
    np.testing.assert_allclose(fourier.evaluate(blended, phase), apart, atol=1e-12)
    np.testing.assert_allclose(blended, fourier.fit(np.tensordot(weights, signals, 1)), atol=1e-12)


@pytest.mark.parametrize("batch", ((), (1,), (3, 1, 2, 1)), ids=str)
def test_any_batch_axes(batch):
    samples = some(0, *batch, 31, 2)
    rows = fourier.fit(samples, 5)
    assert rows.shape == batch + (11, 2)
    np.testing.assert_array_equal(rows.reshape(-1, 11, 2),
                                  [fourier.fit(s, 5) for s in samples.reshape(-1, 31, 2)])
    phase = np.abs(some(1, *batch))
    assert fourier.evaluate(rows.reshape(-1, 11, 2)[0], phase).shape == batch + (2,)
    np.testing.assert_array_equal(fourier.basis(phase, 5)[..., 0], 1.0)


@pytest.mark.parametrize("samples", (1, 2, 10, 24))
def test_too_few_samples_are_refused(samples):
    most = (samples - 1) // 2
    fourier.fit(np.zeros((samples, 1)), most)
    with pytest.raises(ValueError, match=f"{most + 1} harmonics .*at least {2 * most + 3}"):
        fourier.fit(np.zeros((samples, 1)), most + 1)
