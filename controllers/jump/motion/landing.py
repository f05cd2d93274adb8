"""The landing: legs give like a critically damped spring until the body stands again.

Feet first (Ha 2012 without the roll): toes, then heels, knees absorbing. Along the floor the body
comes to rest over its feet if it can; the margin says whether it could.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

TIME = 1.35
"""From touch-down until the body stands [s]."""
HOLD, PASS = 4.2, 1.0
"""Rate of the spring that brings the body to rest over its feet, and of one that lets it pass over them [1/s]."""
GRIP = 0.8
"""The friction of soles that a body which passes over its feet counts on."""
SLOWEST = 5.0
"""Rate of the spring with which a body that hardly fell stands up [1/s]."""
LEAST_WEIGHT = 0.1
"""However fast a body stands up, so much of its weight stays on its feet: the floor can't pull."""
DEEPEST, STIFFEST = 0.41, 13.0
"""How far a body sinks at most, as a share of its standing height; how stiff legs are at most [1/s]."""
CATCH = 0.6
"""How much of the capture point's lead counts: arms, trunk and a heel's edge brake, too."""
OVER = 0.04
"""A body that passes over its feet walks on once it is so far beyond their middle [m]."""


@dataclass(frozen=True, eq=False)
class Landing:
    """The centre of mass after touch-down: rates (3,) [1/s] of the springs, `offset` (3,) [m] from where it
    comes to rest, `velocity` (3,) [m/s] with which it landed, `goal` (3,) [m]. passes: it can't stop here."""

    rates: np.ndarray
    offset: np.ndarray
    velocity: np.ndarray
    goal: np.ndarray
    passes: bool = False

    def until(self, times: np.ndarray) -> float:
        """When [s] a body that passes over its feet walks on: infinite for one that stops."""
        if not self.passes:
            return np.inf
        place, velocity, _ = self.motion(times)
        ahead = self.velocity * [1.0, 0.0, 1.0] / np.linalg.norm(self.velocity[[0, 2]])
        beyond = (place - self.goal) @ ahead > OVER
        return float(times[int(np.argmax(beyond))]) if beyond.any() else np.inf

    def motion(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Place, velocity, acceleration (N, 3) at times (N,) [s] after touch-down."""
        t = np.asarray(time, float)[:, None]
        pull = self.velocity + self.offset * self.rates
        fade = np.exp(-self.rates * t)
        return (self.goal + fade * (self.offset + pull * t),
                fade * (self.velocity - pull * self.rates * t),
                fade * (-2.0 * self.rates * pull + self.rates**2 * (self.offset + pull * t)))


def absorb(land: np.ndarray, velocity: np.ndarray, goal: np.ndarray, support: np.ndarray, gravity: float) -> Landing:
    """The landing of a body at `land` (3,) with `velocity` (3,) over feet whose middle is under `goal` (3,).

    support: (C, 3) corners of the soles. It comes to rest if its capture point, x + v √(h/g), lies over
    them; else it passes over them and must step on (Ha 2012 rolls on; feet do it here). It sinks the
    deeper the faster it fell: a critically damped spring met with speed v sinks v / (e·rate).
    """
    fall = max(-velocity[1], 0.0)
    flat = velocity * [1.0, 0.0, 1.0]
    pace = float(np.linalg.norm(flat))
    passes = False
    if pace > 1e-6:
        ahead = flat / pace
        capture = (land - goal) @ ahead + pace * np.sqrt((goal[1] - support[0, 1]) / gravity) * CATCH
        passes = bool(capture > ((support - goal) @ ahead).max())
    # soles don't slip: a spring of rate r brakes with 2 r v at first
    rate = min(PASS, 0.5 * GRIP * gravity / max(pace, 1e-6)) if passes else HOLD
    sink = max(fall / (np.e * (0.08 + 0.07 * fall)), SLOWEST)
    while sink < STIFFEST and _lowest(land[1] - goal[1], velocity[1], sink) < -DEEPEST * (goal[1] - support[0, 1]):
        sink *= 1.1
    while sink > 1.0 and _lightest(land[1] - goal[1], velocity[1], sink) < (LEAST_WEIGHT - 1.0) * gravity:
        sink *= 0.93
    return Landing(np.array([rate, sink, rate]), land - goal, velocity, goal, passes)


def _lowest(offset: float, velocity: float, rate: float) -> float:
    """The lowest that the critically damped spring comes, from an offset [m] and a velocity [m/s]."""
    pull = velocity + offset * rate
    time = max(velocity / (rate * pull), 0.0) if pull < 0.0 else 0.0
    return float(np.exp(-rate * time) * (offset + pull * time))


def _lightest(offset: float, velocity: float, rate: float) -> float:
    """The most [m/s²] that the same spring accelerates it downward, below 0."""
    pull = velocity + offset * rate
    time = max((3.0 * pull - offset * rate) / (rate * pull), 0.0) if pull else 0.0
    return float(np.exp(-rate * time) * (-2.0 * rate * pull + rate**2 * (offset + pull * time)))
