"""The push: which ground force takes a crouched body off with the wished velocity.

Force over the push (s = t / T from the lowest point to take-off):
F/m = A (1 − s⁴) + C s (1 − s³): nearly level, as in measured counter-movement jumps, and nothing
at take-off. A and C follow from the velocity to gain and the way to make, T from the shape
C = RISE · A of the vertical force.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

RISE = 0.3
"""How the vertical force rises within the push: C over A."""
_A1, _C1 = 4.0 / 5.0, 3.0 / 10.0
"""∫ of both shapes over the push: what they give to velocity."""
_A2, _C2 = 7.0 / 15.0, 2.0 / 15.0
"""∫∫ of both shapes: what they give to the way."""


@dataclass(frozen=True, eq=False)
class Push:
    """A push of `duration` [s] under `gravity` (3,). level, rise: (3,) A and C [m/s²]."""

    duration: float
    level: np.ndarray
    rise: np.ndarray
    gravity: np.ndarray

    def force(self, time: np.ndarray) -> np.ndarray:
        """Ground force over mass (..., 3) [m/s²] `time` (...) [s] after the lowest point."""
        s = np.clip(np.asarray(time, float) / self.duration, 0.0, 1.0)[..., None]
        return self.level * (1.0 - s**4) + self.rise * s * (1.0 - s**3)

    def moved(self, time: np.ndarray, velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Way (..., 3) [m] and velocity [m/s] since the lowest point, passed with `velocity` (3,)."""
        t = np.asarray(time, float)[..., None]
        s = t / self.duration
        speed = (velocity + self.gravity * t
                 + self.duration * (self.level * (s - s**5 / 5) + self.rise * (s**2 / 2 - s**5 / 5)))
        way = (velocity * t + 0.5 * self.gravity * t**2
               + self.duration**2 * (self.level * (s**2 / 2 - s**6 / 30) + self.rise * (s**3 / 6 - s**6 / 30)))
        return way, speed


def push(way: np.ndarray, before: np.ndarray, after: np.ndarray, gravity: np.ndarray, rise: float = RISE) -> Push:
    """The push that covers `way` (3,) [m] while the velocity goes from `before` to `after` (3,) [m/s].

    ValueError if the way does not rise: there is nothing to push along.
    """
    way, before, after, gravity = (np.asarray(a, float) for a in (way, before, after, gravity))
    if not way[1] > 0.0:
        raise ValueError("a push needs room to rise")
    g = -gravity[1]
    alpha, beta = _A1 + _C1 * rise, _A2 + _C2 * rise
    # (Δv + gT) T β = (D − v0 T + ½ g T²) α, from both integrals
    a = g * (beta - 0.5 * alpha)
    b = (after[1] - before[1]) * beta + before[1] * alpha
    c = -way[1] * alpha
    duration = -2.0 * c / (b + np.sqrt(max(b * b - 4.0 * a * c, 0.0)))
    gain = (after - before - gravity * duration) / duration
    gone = (way - before * duration - 0.5 * gravity * duration**2) / duration**2
    determinant = _A1 * _C2 - _C1 * _A2
    return Push(float(duration), (gain * _C2 - gone * _C1) / determinant,
                (gone * _A1 - gain * _A2) / determinant, gravity)


def risen(duration: float, velocity: float, gravity: float, rise: float = RISE) -> float:
    """How far [m] a push of `duration` [s] rises that leaves upward with `velocity` [m/s] from rest, under
    `gravity` [m/s²]: what `push` inverts."""
    share = (_A2 + _C2 * rise) / (_A1 + _C1 * rise)
    return duration * (velocity * share + gravity * duration * (share - 0.5))
