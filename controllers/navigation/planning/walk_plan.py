"""A plan: the way to a goal over time, or the reason why there is none."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import BSpline

from .splines import knots_of


@dataclass(frozen=True, eq=False)
class Plan:
    """How to walk to a goal.

    coefficients: (M + 3, 3) of cubic B-splines over the share of time: x, z [m], θ [rad]. seconds: how long it takes. cost: J. goal:
    (3,) x, z [m], heading [rad], turned by whole turns as the walker turns. reason: why there is no plan, and then the walker stays
    where he is; "" if there is one.
    """

    coefficients: np.ndarray
    seconds: float
    cost: float
    goal: np.ndarray
    reason: str = ""

    @staticmethod
    def none(ground: np.ndarray, goal: np.ndarray, reason: str) -> Plan:
        """No plan: staying at ground (3,), and why."""
        return Plan(np.repeat(np.asarray(ground, float)[None], 4, 0), 0.0, np.inf, np.asarray(goal, float), reason)

    def at(self, time) -> tuple[np.ndarray, np.ndarray]:
        """Ground frames (..., 3) and velocities (..., 3) v_f, ω, v_l [m/s, rad/s, m/s] at times (...) [s] from the start; at
        rest at the goal afterwards."""
        ground, rate, _ = self._motion(time)
        return ground, self._own(ground, rate)

    def acceleration(self, time) -> np.ndarray:
        """The controls (..., 3) at times (...) [s]: how v_f, ω and v_l change [m/s², rad/s², m/s²]."""
        ground, rate, change = self._motion(time)
        v_f, turning, v_l = np.moveaxis(self._own(ground, rate), -1, 0)
        a_f, turn, a_l = np.moveaxis(self._own(ground, change), -1, 0)
        return np.stack([a_f + turning * v_l, turn, a_l - turning * v_f], -1)

    def sampled(self, count: int = 101) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Times (count,) [s], evenly spaced over all of it, with their ground frames and velocities (count, 3)."""
        times = np.linspace(0.0, self.seconds, count)
        return times, *self.at(times)

    def _motion(self, time) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Ground frames (..., 3) and their first and second derivatives by the time."""
        seconds = max(self.seconds, 1e-9)
        share = np.asarray(time, float) / seconds
        over = ((share < 0.0) | (share > 1.0))[..., None]
        way = BSpline(knots_of(len(self.coefficients) - 3), self.coefficients, 3)
        share = np.clip(share, 0.0, 1.0)
        return way(share), np.where(over, 0.0, way(share, 1) / seconds), np.where(over, 0.0, way(share, 2) / seconds**2)

    @staticmethod
    def _own(ground: np.ndarray, rate: np.ndarray) -> np.ndarray:
        c, s = np.cos(ground[..., 2]), np.sin(ground[..., 2])
        return np.stack([s * rate[..., 0] + c * rate[..., 1], rate[..., 2], c * rate[..., 0] - s * rate[..., 1]], -1)
