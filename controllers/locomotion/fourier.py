"""Gait cycles as Fourier series (Truong 2010, eq. 3 and 6, with the angular frequency 2πk/T).

The printed kπt/T is the series of an interval of length 2T: over one trimmed cycle of length T it
must be 2πkt/T. Rows of a coefficient array are 1, cos φ₁, sin φ₁, cos φ₂, … with φ_k = 2πkφ, so
that a series is one product ``basis(φ) @ coefficients`` and a blend of series is a blend of rows.
"""

from __future__ import annotations

import numpy as np

HARMONICS = 12


def fit(samples: np.ndarray, harmonics: int = HARMONICS) -> np.ndarray:
    """Coefficients (..., 2N + 1, D) of one cycle's samples (..., S, D) at phases s / S.

    Row 0 is the mean ½α₀, rows 2k − 1 and 2k are α_k and β_k. ValueError if N > (S − 1) / 2, and for samples of another shape.
    """
    samples = np.asarray(samples, float)
    if samples.ndim < 2:
        raise ValueError(f"samples are (..., S, D), one row a phase; got shape {samples.shape}")
    count = samples.shape[-2]
    if harmonics > (count - 1) // 2:
        raise ValueError(f"{harmonics} harmonics need more than {count} samples: at least {2 * harmonics + 1}")
    spectrum = np.fft.rfft(samples, axis=-2)[..., :harmonics + 1, :] / count
    rows = np.empty(samples.shape[:-2] + (2 * harmonics + 1, samples.shape[-1]))
    rows[..., 0, :] = spectrum[..., 0, :].real
    rows[..., 1::2, :] = 2 * spectrum[..., 1:, :].real
    rows[..., 2::2, :] = -2 * spectrum[..., 1:, :].imag
    return rows


def basis(phase: np.ndarray, harmonics: int = HARMONICS) -> np.ndarray:
    """The basis functions (..., 2N + 1) at phases (...)."""
    angle = 2 * np.pi * np.asarray(phase, float)[..., None] * np.arange(1, harmonics + 1)
    rows = np.ones(angle.shape[:-1] + (2 * harmonics + 1,))
    rows[..., 1::2], rows[..., 2::2] = np.cos(angle), np.sin(angle)
    return rows


def evaluate(coefficients: np.ndarray, phase: np.ndarray) -> np.ndarray:
    """Series (..., D) of coefficients (2N + 1, D) at phases (...): eq. (6)."""
    coefficients = np.asarray(coefficients)
    return basis(phase, (coefficients.shape[-2] - 1) // 2) @ coefficients
