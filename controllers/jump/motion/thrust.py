"""The push: which ground force takes a crouched body off with the wished velocity.

Force over the push (s = t / T from the lowest point to take-off): F/m = A φ(s) (up + lean + turn s). From a crouch φ is
(1 − s⁴) + 0.3 s (1 − s³): upward nearly level, as in measured counter-movement jumps, and nothing at take-off. Off a springy landing
it is a quarter of a cosine, within 0.4 %: landing and push are the two halves of what a mass does on a spring (Blickhan 1989).
`lean` and `turn` are horizontal: how far the force leans from upright at the lowest point, and how much more at take-off, which is also
the friction it needs. A and T follow from the way up and the speed upward, lean and turn from the velocity and the way along the floor.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

LEVEL, SPRING = np.array([1.0, 0.3, 0.0, 0.0, -1.3]), np.array([1.0, 0.0, -1.2337, 0.0, 0.2337])
"""φ as a polynomial, by rising powers of s: from a crouch, and off a springy landing."""
_POWERS = np.arange(len(LEVEL))
_UP = np.array([0.0, 1.0, 0.0])


@lru_cache(2)
def moments(springs: bool = False) -> tuple[float, float, float]:
    """∫ φ, ∫ s φ and ∫ s² φ over a push from a crouch, or off a springy landing."""
    shape = SPRING if springs else LEVEL
    m0, m1, m2 = (float((shape / (_POWERS + n)).sum()) for n in (1, 2, 3))
    return m0, m1, m2


MOMENTS = moments()
"""Those of a push from a crouch."""


@dataclass(frozen=True, eq=False)
class Push:
    """A push of `duration` [s] under `gravity` (3,). level: A [m/s²]. lean, turn: (3,) horizontal, of the force over its
    vertical part. springs: it goes off a springy landing."""

    duration: float
    level: float
    lean: np.ndarray
    turn: np.ndarray
    gravity: np.ndarray
    springs: bool = False

    @property
    def shape(self) -> np.ndarray:
        """φ (5,) as a polynomial."""
        return SPRING if self.springs else LEVEL

    def force(self, time: ArrayLike) -> np.ndarray:
        """Ground force over mass (..., 3) [m/s²] `time` (...) [s] after the lowest point."""
        s = np.clip(np.asarray(time, float) / self.duration, 0.0, 1.0)[..., None]
        return self.level * (s**_POWERS @ self.shape)[..., None] * (_UP + self.lean + self.turn * s)

    def moved(self, time: ArrayLike, velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Way (..., 3) [m] and velocity [m/s] since the lowest point, passed with `velocity` (3,)."""
        t, n, c = np.asarray(time, float)[..., None], _POWERS, self.shape
        s = t / self.duration
        rows = s**n
        level, turn = self.level * (_UP + self.lean), self.level * self.turn
        # ∫ φ, ∫ s φ, and both once more
        speed = self.duration * (level * (s * (rows @ (c / (n + 1)))[..., None]) + turn * (s**2 * (rows @ (c / (n + 2)))[..., None]))
        way = self.duration**2 * (level * (s**2 * (rows @ (c / ((n + 1) * (n + 2))))[..., None])
                                  + turn * (s**3 * (rows @ (c / ((n + 2) * (n + 3))))[..., None]))
        return velocity * t + 0.5 * self.gravity * t**2 + way, velocity + self.gravity * t + speed


def upward(rise: float, before: float, after: float, gravity: float, springs: bool = False) -> tuple[float, float]:
    """How long [s] a push takes, from a crouch or off a springy landing, that rises `rise` [m] while the speed upward goes from `before` to `after` [m/s] under
    `gravity` [m/s²] downward, and its level A [m/s²].

    ValueError if there is nothing to rise along.
    """
    if not rise > 0.0:
        raise ValueError("a push needs room to rise")
    gives, m1, _ = moments(springs)
    goes = gives - m1
    # (Δv + gT) T goes = (rise − v0 T + ½ g T²) gives, from both integrals
    a = gravity * (goes - 0.5 * gives)
    b = (after - before) * goes + before * gives
    c = -rise * gives
    duration = -2.0 * c / (b + np.sqrt(max(b * b - 4.0 * a * c, 0.0)))
    return float(duration), float(((after - before) / duration + gravity) / gives)


def push(way: np.ndarray, before: np.ndarray, after: np.ndarray, gravity: np.ndarray, springs: bool = False) -> Push:
    """The push, from a crouch or off a springy landing, that covers `way` (3,) [m] while the velocity goes from `before` to `after` (3,) [m/s].

    ValueError if the way does not rise: there is nothing to push along.
    """
    way, before, after, gravity = (np.asarray(a, float) for a in (way, before, after, gravity))
    duration, level = upward(way[1], before[1], after[1], -gravity[1], springs)
    gain = (after - before) * [1.0, 0.0, 1.0] / (level * duration)
    gone = (way - before * duration) * [1.0, 0.0, 1.0] / (level * duration**2)
    # gain = lean m0 + turn m1, gone = lean (m0 − m1) + turn (m1 − m2)
    m0, m1, m2 = moments(springs)
    determinant = m0 * (m1 - m2) - m1 * (m0 - m1)
    return Push(duration, level, (gain * (m1 - m2) - gone * m1) / determinant,
                (gone * m0 - gain * (m0 - m1)) / determinant, gravity, springs)


def risen(duration: float, velocity: float, gravity: float) -> float:
    """How far [m] a push of `duration` [s] from a crouch rises that leaves upward with `velocity` [m/s] from rest, under
    `gravity` [m/s²]: what `upward` inverts."""
    share = 1.0 - MOMENTS[1] / MOMENTS[0]
    return duration * (velocity * share + gravity * duration * (share - 0.5))
