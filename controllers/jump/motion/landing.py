"""The landing: legs give like a critically damped spring whose force begins at nothing, until the body stands again.

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
STRIDE, STIFF = 0.25, 0.8
"""Rate of that spring where one runs on on one foot [1/s], whose leg sinks by this share of how far two sink: 0.14 m,
as recorded."""
GRIP = 0.8
"""The friction of soles that a body which passes over its feet counts on."""
SINKS = 0.045, 0.0765, 0.42
"""How deep [m] legs give to a body that hardly falls, how much deeper for each m/s that it falls, and at most: as recorded, at standard
height."""
SLOWEST = 4.0
"""Rate of the spring with which a body that hardly fell stands up [1/s]."""
LIGHT = 0.0
"""However fast a body stands up, so much of its weight stays on its feet at least: the floor can't pull."""
ADULT = 0.975
"""How high the centre of mass of a standard body stands [m]."""
TIMES = np.linspace(0.0, 1.2, 121)
"""When a landing is looked at [s]."""
DEEPEST, STIFFEST = 0.45, 20.0
"""How far a body sinks at most, as a share of its standing height; how stiff legs are at most [1/s]."""
CATCH = 0.6
"""How much of the capture point's lead counts: arms, trunk and a heel's edge brake, too."""
OVER = 0.04
"""A body that passes over its feet walks on once it is so far beyond their middle [m]."""


@dataclass(frozen=True, eq=False)
class Landing:
    """The centre of mass after touch-down: rates (3,) [1/s] of the springs, `offset` (3,) [m] from where it
    comes to rest, `velocity` (3,) [m/s] and `falls` (3,) [m/s²] with which it landed, `goal` (3,) [m]. passes: it can't stop here."""

    rates: np.ndarray
    offset: np.ndarray
    velocity: np.ndarray
    falls: np.ndarray
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
        t, r = np.asarray(time, float)[:, None], self.rates
        a, b = self.velocity + r * self.offset, 0.5 * (self.falls + 2.0 * r * self.velocity + r**2 * self.offset)
        fade, way = np.exp(-r * t), self.offset + a * t + b * t**2
        rate, bend = a + 2.0 * b * t, 2.0 * b
        return self.goal + fade * way, fade * (rate - r * way), fade * (bend - 2.0 * r * rate + r**2 * way)


def absorb(land: np.ndarray, velocity: np.ndarray, goal: np.ndarray, support: np.ndarray, gravity: float, striding: bool = False) -> Landing:
    """The landing of a body at `land` (3,) with `velocity` (3,) over feet whose middle is under `goal` (3,).

    support: (C, 3) corners of the soles. It comes to rest if its capture point, x + v √(h/g), lies over
    them; else it passes over them and must step on (Ha 2012 rolls on; feet do it here). It sinks the
    deeper the faster it fell; the springs have three equal rates, so that the ground's force begins with none. striding: on one foot, to run on.
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
    rate = STRIDE if striding else min(PASS, 0.5 * GRIP * gravity / max(pace, 1e-6)) if passes else HOLD
    size, g = goal[1] - support[0, 1], np.array([gravity])
    start, speed, deep = land[1] - goal[1], float(velocity[1]), min(SINKS[0] + SINKS[1] * fall, SINKS[2]) * (STIFF if striding else 1.0) * size / ADULT

    def course(stiff: float) -> tuple[float, float]:
        """The lowest place [m] and the least acceleration [m/s²]."""
        up = np.array([0.0, 1.0, 0.0])
        place, _, bends = Landing(np.full(3, stiff), start * up, speed * up, -g * up, 0.0 * up).motion(TIMES)
        return float(place[:, 1].min()), float(bends[1:, 1].min())
    low, high = SLOWEST, STIFFEST
    for _ in range(10):
        sink = 0.5 * (low + high)
        low, high = (sink, high) if course(sink)[0] < max(start - deep, -DEEPEST * size) else (low, sink)
    while sink > 1.0 and course(sink)[1] < LIGHT * gravity - gravity:
        sink *= 0.93
    return Landing(np.array([rate, sink, rate]), land - goal, velocity, np.array([0.0, -gravity, 0.0]), goal, passes)
