"""The push: which ground force takes a crouched body off with the wished velocity.

Force over the push (s = t / T from the lowest point to take-off): F/m = A φ(s) (up + lean + turn s). From a crouch φ is
(1 − s⁴) + 0.3 s (1 − s³): upward nearly level, as in measured counter-movement jumps, and nothing at take-off. Off a springy landing
it is a quarter of a cosine, within 0.4 %: landing and push are the two halves of what a mass does on a spring (Blickhan 1989).
`lean` and `turn` are horizontal: how far the force leans from upright at the lowest point, and how much more at take-off, which is also
the friction it needs. A and T follow from the way up and the speed upward, lean and turn from the velocity and the way along the floor.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from ...compiled import kernel

LEVEL, SPRING = np.array([1.0, 0.3, 0.0, 0.0, -1.3]), np.array([1.0, 0.0, -1.2337, 0.0, 0.2337])
"""φ as a polynomial, by rising powers of s: from a crouch, and off a springy landing."""
_POWERS = np.arange(len(LEVEL))


@lru_cache(2)
def moments(springs: bool = False) -> tuple[float, float, float]:
    """∫ φ, ∫ s φ and ∫ s² φ over a push from a crouch, or off a springy landing."""
    shape = SPRING if springs else LEVEL
    m0, m1, m2 = (float((shape / (_POWERS + n)).sum()) for n in (1, 2, 3))
    return m0, m1, m2


MOMENTS, SPRINGY = moments(), moments(True)
"""Those of a push from a crouch, and off a springy landing."""


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
        times = np.asarray(time, float)
        out = np.empty((*times.shape, 3))
        _force(np.ravel(times), self.duration, self.level, self.lean, self.turn, self.shape, out.reshape(-1, 3))
        return out

    def moved(self, time: ArrayLike, velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Way (..., 3) [m] and velocity [m/s] since the lowest point, passed with `velocity` (3,)."""
        times = np.asarray(time, float)
        way, speed = np.empty((2, *times.shape, 3))
        _moved(np.ravel(times), self.duration, self.level, self.lean, self.turn, self.gravity, self.shape, velocity, way.reshape(-1, 3), speed.reshape(-1, 3))
        return way, speed


@kernel
def _force(times, duration, level, lean, turn, shape, out):
    """Write the forces (N, 3) of a push at times (N,) [s]."""
    for n in range(len(times)):
        s = min(max(times[n] / duration, 0.0), 1.0)
        strength = level * (shape[0] + s * (shape[1] + s * (shape[2] + s * (shape[3] + s * shape[4]))))
        for i in range(3):
            out[n, i] = strength * ((1.0 if i == 1 else 0.0) + lean[i] + turn[i] * s)


@kernel
def _moved(times, duration, level, lean, turn, gravity, shape, velocity, way, speed):
    """Write ways and velocities (N, 3) of a push at times (N,) [s]."""
    for n in range(len(times)):
        t = times[n]
        s, power = t / duration, 1.0
        first, twice, later, more = 0.0, 0.0, 0.0, 0.0  # ∫ φ, ∫ s φ, and both once more
        for k in range(len(shape)):
            part = shape[k] * power
            first, later = first + part / (k + 1), later + part / (k + 2)
            twice, more = twice + part / ((k + 1) * (k + 2)), more + part / ((k + 2) * (k + 3))
            power *= s
        for i in range(3):
            leans = level * ((1.0 if i == 1 else 0.0) + lean[i])
            speed[n, i] = velocity[i] + gravity[i] * t + duration * (leans * s * first + level * turn[i] * s**2 * later)
            way[n, i] = velocity[i] * t + 0.5 * gravity[i] * t**2 + duration**2 * (leans * s**2 * twice + level * turn[i] * s**3 * more)


def upward(rise: float, before: float, after: float, gravity: float, springs: bool = False) -> tuple[float, float]:
    """How long [s] a push takes, from a crouch or off a springy landing, that rises `rise` [m] while the speed upward goes from `before` to `after` [m/s] under
    `gravity` [m/s²] downward, and its level A [m/s²].

    ValueError if there is nothing to rise along.
    """
    if not rise > 0.0:
        raise ValueError("a push needs room to rise")
    return upward_kernel(float(rise), float(before), float(after), float(gravity), springs)


@kernel
def upward_kernel(rise, before, after, gravity, springs):
    """See `upward`, for who has something to rise along."""
    gives, m1, _ = SPRINGY if springs else MOMENTS
    goes = gives - m1
    # (Δv + gT) T goes = (rise − v0 T + ½ g T²) gives, from both integrals
    a = gravity * (goes - 0.5 * gives)
    b = (after - before) * goes + before * gives
    duration = 2.0 * rise * gives / (b + math.sqrt(max(b * b + 4.0 * a * rise * gives, 0.0)))
    return duration, ((after - before) / duration + gravity) / gives


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


@kernel
def risen_kernel(duration, velocity, gravity):
    """How far [m] a push of `duration` [s] from a crouch rises that leaves upward with `velocity` [m/s] from rest, under
    `gravity` [m/s²]: what `upward` inverts."""
    share = 1.0 - MOMENTS[1] / MOMENTS[0]
    return duration * (velocity * share + gravity * duration * (share - 0.5))
