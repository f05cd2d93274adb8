"""Filters for what moves steadily: the constant-velocity Kalman filter in its steady state, and how noisy points are."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

NATURAL = 0.0015
"""What the third differences of recorded points look like at 60 Hz, were they noise [m]: less than this in 99 of 100 frames."""
_COAST = 0.9  # of its velocity what is lost keeps from frame to frame
_WHITE = math.sqrt(20.0) * 0.6745  # the median size of a third difference of noise of unit deviation


def gains(index: float) -> tuple[float, float]:
    """The steady state's gains α and β for a tracking index a·Δt²/σ: of changing acceleration a, and noise σ (Kalata 1984).

    The greater the index, the more a measurement is believed: all of it where it is infinite. β stays below 1, where
    the velocity is the last measured one.
    """
    if not math.isfinite(index):
        return 1.0, 1.0
    r = (4.0 + index - math.sqrt(8.0 * index + index * index)) / 4.0
    alpha = 1.0 - r * r
    return alpha, min(2.0 * (2.0 - alpha) - 4.0 * r, 1.0)


@dataclass(frozen=True, eq=False)
class Motion:
    """Where things are and go, filtered. place: any shape. change: by how much the place changes in a frame. told: on how many
    frames that rests: gains fall no sooner than a line through so many and one more has them; where it is infinite they are the steady state's at once."""

    place: np.ndarray
    change: np.ndarray
    told: float = math.inf

    def towards(self, seen: np.ndarray, index: float) -> Motion:
        """A frame later, where things are seen at `seen`; what is not finite there is lost, and coasts to a halt."""
        (alpha, beta), told = gains(index), self.told
        if math.isfinite(told):
            line = 6.0 / ((told + 1.0) * (told + 2.0))
            if line > beta:
                alpha, beta = (4.0 * told + 2.0) / ((told + 1.0) * (told + 2.0)), line
            told = 0.5 * (math.sqrt(1.0 + 24.0 / beta) - 1.0)
        expected = self.place + self.change
        there = np.isfinite(seen)
        miss = np.where(there, seen, expected) - expected
        return Motion(expected + alpha * miss, np.where(there, self.change + beta * miss, _COAST * self.change), told)


def noise(points: np.ndarray) -> float:
    """The standard deviation [m] of the noise on points (T, n, 3) that were seen one frame after the other, 0 for a clean motion.

    Told from their third differences, in which motion hardly shows; NaN where points are missing.
    """
    rough = np.abs(points[3:] - points[:-3] - 3.0 * (points[2:-1] - points[1:-2]))
    rough = rough[np.isfinite(rough)]
    if not len(rough):
        return 0.0
    middle = len(rough) // 2
    rough.partition((middle - 1 + len(rough) % 2, middle))
    median = 0.5 * float(rough[middle - 1 + len(rough) % 2] + rough[middle])
    return math.sqrt(max((median / _WHITE) ** 2 - NATURAL ** 2, 0.0))
