"""The landing: legs give like a critically damped spring until the body stands again.

Feet first (Ha 2012 without the roll): toes, then heels, knees absorbing. Along the floor the body
comes to rest over its feet if it can; the margin says whether it could.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

TIME = 1.15
"""From touch-down until the body stands [s]."""
HOLD = 3.6
"""Rate of the spring that brings the body over its feet [1/s]."""


@dataclass(frozen=True, eq=False)
class Landing:
    """The centre of mass after touch-down: rates (3,) [1/s] of the springs, `offset` (3,) [m] from where it
    comes to rest, `velocity` (3,) [m/s] with which it landed, `goal` (3,) [m]."""

    rates: np.ndarray
    offset: np.ndarray
    velocity: np.ndarray
    goal: np.ndarray

    def motion(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Place, velocity, acceleration (N, 3) at times (N,) [s] after touch-down."""
        t = np.asarray(time, float)[:, None]
        pull = self.velocity + self.offset * self.rates
        fade = np.exp(-self.rates * t)
        return (self.goal + fade * (self.offset + pull * t),
                fade * (self.velocity - pull * self.rates * t),
                fade * (-2.0 * self.rates * pull + self.rates**2 * (self.offset + pull * t)))


def absorb(land: np.ndarray, velocity: np.ndarray, goal: np.ndarray) -> Landing:
    """The landing of a body at `land` (3,) with `velocity` (3,) that should come to rest at `goal` (3,).

    It sinks the deeper the faster it fell: a critically damped spring met with speed v sinks
    v / (e·rate), 60 to 90 degrees of knee for a human.
    """
    fall = max(-velocity[1], 0.0)
    dip = 0.08 + 0.07 * fall
    return Landing(np.array([HOLD, max(fall / (np.e * dip), 2.0), HOLD]), land - goal, velocity, goal)
