"""A plan: the way to a goal over time, or the reason why there is none."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...compiled import kernel


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
        moments = self._moments(time)
        return moments[..., 0, :], moments[..., 1, :]

    def acceleration(self, time) -> np.ndarray:
        """The controls (..., 3) at times (...) [s]: how v_f, ω and v_l change [m/s², rad/s², m/s²]."""
        return self._moments(time)[..., 2, :]

    def sampled(self, count: int = 101) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Times (count,) [s], evenly spaced over all of it, with their ground frames and velocities (count, 3)."""
        times = np.linspace(0.0, self.seconds, count)
        return times, *self.at(times)

    def _moments(self, time) -> np.ndarray:
        """Ground frames, velocities and controls (..., 3, 3) at times (...) [s]."""
        times = np.asarray(time, float)
        out = np.empty((*times.shape, 3, 3))
        moments(self.coefficients, float(self.seconds), np.ascontiguousarray(times).reshape(-1), out.reshape(-1, 3, 3))
        return out

    def wished(self, time: float, ground: np.ndarray, velocity: np.ndarray, following: tuple[float, ...]) -> np.ndarray:
        """The velocity (3,) by which somebody who is somewhere (3,) and moves somehow (3,) follows it, see `wish`."""
        out = np.empty(3)
        wish_kernel(self.coefficients, float(self.seconds), float(time), np.asarray(ground, float), np.asarray(velocity, float), following, out)
        return out


@kernel
def _knot(k, intervals):
    return min(max((k - 3) / intervals, 0.0), 1.0)


@kernel
def moment(coefficients, seconds, time, out):
    """Write ground frame, velocity v_f, ω, v_l and controls (3, 3) of a plan's cubic B-splines (M + 3, 3) at a time [s], after de Boor."""
    intervals, seconds = coefficients.shape[0] - 3, max(seconds, 1e-9)
    share = time / seconds
    over = share < 0.0 or share > 1.0
    share = min(max(share, 0.0), 1.0)
    i = min(int(share * intervals), intervals - 1)
    place, rate, change = np.empty((4, 3)), np.empty((3, 3)), np.empty((2, 3))
    for d in range(3):
        for j in range(4):
            place[j, d] = coefficients[i + j, d]
        for j in range(3):
            rate[j, d] = 3.0 * (place[j + 1, d] - place[j, d]) / (_knot(i + j + 4, intervals) - _knot(i + j + 1, intervals))
        for j in range(2):
            change[j, d] = 2.0 * (rate[j + 1, d] - rate[j, d]) / (_knot(i + j + 4, intervals) - _knot(i + j + 2, intervals))
    for degree, values in ((3, place), (2, rate), (1, change)):
        for lap in range(1, degree + 1):
            for j in range(degree, lap - 1, -1):
                low, high = _knot(i + 3 - degree + j, intervals), _knot(i + 4 - lap + j, intervals)
                part = (share - low) / (high - low)
                for d in range(3):
                    values[j, d] = (1.0 - part) * values[j - 1, d] + part * values[j, d]
    c, s = math.cos(place[3, 2]), math.sin(place[3, 2])
    first, second = (0.0, 0.0) if over else (1.0 / seconds, 1.0 / seconds**2)
    for d in range(3):
        out[0, d] = place[3, d]
    turn = first * rate[2, 2]
    out[1, 0], out[1, 1], out[1, 2] = first * (s * rate[2, 0] + c * rate[2, 1]), turn, first * (c * rate[2, 0] - s * rate[2, 1])
    out[2, 0] = second * (s * change[1, 0] + c * change[1, 1]) + turn * out[1, 2]
    out[2, 1] = second * change[1, 2]
    out[2, 2] = second * (c * change[1, 0] - s * change[1, 1]) - turn * out[1, 0]


@kernel
def moments(coefficients, seconds, times, out):
    """Write ground frames, velocities and controls (N, 3, 3) of a plan at times (N,) [s]."""
    for n in range(len(times)):
        moment(coefficients, seconds, times[n], out[n])


OVER = 0.05
"""How controls change is told over so long before and after a moment [s]."""


@kernel
def wish_kernel(coefficients, seconds, time, ground, velocity, following, out):
    """Write the velocity (3,) to wish for, as `gambol.controllers.navigation.wish` tells it; following: its `Following`."""
    now, ends = np.empty((3, 3)), np.empty((2, 3, 3))
    moment(coefficients, seconds, time, now)
    before, after = min(max(time - OVER, 0.0), seconds), min(max(time + OVER, 0.0), seconds)
    moment(coefficients, seconds, before, ends[0])
    moment(coefficients, seconds, after, ends[1])
    c, s = math.cos(ground[2]), math.sin(ground[2])
    dx, dz, turn = now[0, 0] - ground[0], now[0, 1] - ground[1], now[0, 2] - ground[2]
    turn -= 2.0 * math.pi * math.floor(turn / (2.0 * math.pi) + 0.5)
    missing = (following.place * (s * dx + c * dz), following.heading * turn, following.place * (c * dx - s * dz))
    for d in range(3):
        lead = 0.5 * (following.turning_halflife if d == 1 else following.halflife) / math.log(2.0)  # 1 / y
        jerk = (ends[1, 2, d] - ends[0, 2, d]) / max(after - before, OVER)
        out[d] = now[1, d] + 2.0 * lead * now[2, d] + lead**2 * jerk + missing[d] + following.speed * (now[1, d] - velocity[d])
