"""The push: which ground force takes a crouched body off with the wished velocity.

Force over the push (s = t / T from the lowest point to take-off):
F/m = A φ(s) (up + lean + turn s), φ = (1 − s⁴) + RISE s (1 − s³): upward nearly level, as in measured
counter-movement jumps, and nothing at take-off. `lean` and `turn` are horizontal: how far the force leans
from upright at the lowest point, and how much more at take-off, which is also the friction it needs. A and T follow
from the way up and the speed upward, lean and turn from the velocity and the way along the floor.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

RISE = 0.3
"""How the vertical force rises within the push."""
MOMENTS = 0.8 + 0.3 * RISE, 1 / 3 + RISE / 6, 4 / 21 + 3 * RISE / 28
"""∫ φ, ∫ s φ and ∫ s² φ over the push."""
_UP = np.array([0.0, 1.0, 0.0])


@dataclass(frozen=True, eq=False)
class Push:
    """A push of `duration` [s] under `gravity` (3,). level: A [m/s²]. lean, turn: (3,) horizontal, of the force over its
    vertical part."""

    duration: float
    level: float
    lean: np.ndarray
    turn: np.ndarray
    gravity: np.ndarray

    def force(self, time: ArrayLike) -> np.ndarray:
        """Ground force over mass (..., 3) [m/s²] `time` (...) [s] after the lowest point."""
        s = np.clip(np.asarray(time, float) / self.duration, 0.0, 1.0)[..., None]
        return self.level * (1.0 - s**4 + RISE * s * (1.0 - s**3)) * (_UP + self.lean + self.turn * s)

    def moved(self, time: ArrayLike, velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Way (..., 3) [m] and velocity [m/s] since the lowest point, passed with `velocity` (3,)."""
        t = np.asarray(time, float)[..., None]
        s = t / self.duration
        level, turn = self.level * (_UP + self.lean), self.level * self.turn
        speed = self.duration * (level * (s - s**5 / 5 + RISE * (s**2 / 2 - s**5 / 5))
                                 + turn * (s**2 / 2 - s**6 / 6 + RISE * (s**3 / 3 - s**6 / 6)))
        way = self.duration**2 * (level * (s**2 / 2 - s**6 / 30 + RISE * (s**3 / 6 - s**6 / 30))
                                  + turn * (s**3 / 6 - s**7 / 42 + RISE * (s**4 / 12 - s**7 / 42)))
        return velocity * t + 0.5 * self.gravity * t**2 + way, velocity + self.gravity * t + speed


def upward(rise: float, before: float, after: float, gravity: float) -> tuple[float, float]:
    """How long [s] a push takes that rises `rise` [m] while the speed upward goes from `before` to `after` [m/s] under
    `gravity` [m/s²] downward, and its level A [m/s²].

    ValueError if there is nothing to rise along.
    """
    if not rise > 0.0:
        raise ValueError("a push needs room to rise")
    gives, goes = MOMENTS[0], MOMENTS[0] - MOMENTS[1]
    # (Δv + gT) T goes = (rise − v0 T + ½ g T²) gives, from both integrals
    a = gravity * (goes - 0.5 * gives)
    b = (after - before) * goes + before * gives
    c = -rise * gives
    duration = -2.0 * c / (b + np.sqrt(max(b * b - 4.0 * a * c, 0.0)))
    return float(duration), float(((after - before) / duration + gravity) / gives)


def push(way: np.ndarray, before: np.ndarray, after: np.ndarray, gravity: np.ndarray) -> Push:
    """The push that covers `way` (3,) [m] while the velocity goes from `before` to `after` (3,) [m/s].

    ValueError if the way does not rise: there is nothing to push along.
    """
    way, before, after, gravity = (np.asarray(a, float) for a in (way, before, after, gravity))
    duration, level = upward(way[1], before[1], after[1], -gravity[1])
    gain = (after - before) * [1.0, 0.0, 1.0] / (level * duration)
    gone = (way - before * duration) * [1.0, 0.0, 1.0] / (level * duration**2)
    # gain = lean m0 + turn m1, gone = lean (m0 − m1) + turn (m1 − m2)
    m0, m1, m2 = MOMENTS
    determinant = m0 * (m1 - m2) - m1 * (m0 - m1)
    return Push(duration, level, (gain * (m1 - m2) - gone * m1) / determinant,
                (gone * m0 - gain * (m0 - m1)) / determinant, gravity)


def risen(duration: float, velocity: float, gravity: float) -> float:
    """How far [m] a push of `duration` [s] rises that leaves upward with `velocity` [m/s] from rest, under
    `gravity` [m/s²]: what `upward` inverts."""
    share = 1.0 - MOMENTS[1] / MOMENTS[0]
    return duration * (velocity * share + gravity * duration * (share - 0.5))
