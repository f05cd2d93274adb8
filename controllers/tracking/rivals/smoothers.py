"""Filters of poses: One-Euro (Casiez 2012), a Kalman filter of constant velocity, and Savitzky-Golay, which sees the future.

All of them work on steps between poses, six of the root in its own frame and one for each angle, so that nothing wraps.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..twists import Chain, Configuration, exp, inverse, log, retract_kernel, rigid, turn_log_kernel


@dataclass(frozen=True, eq=False)
class OneEuro:
    """A low pass that opens as the motion gets faster. rate: frames a second. cutoff: [Hz] of one that stands.

    opening: Hz for each metre or radian a second. slope: [Hz] of the filter of speeds.
    """

    rate: float
    cutoff: float = 1.0
    opening: float = 0.5
    slope: float = 1.0
    last: Configuration | None = None
    speed: np.ndarray | None = None

    def step(self, chain: Chain, pose: Configuration) -> tuple[OneEuro, Configuration]:
        """The filter after a pose, and what it makes of it."""
        if self.last is None or self.speed is None:
            return replace(self, last=pose, speed=np.zeros(6 + len(chain))), pose
        away = _difference(chain, self.last, pose)
        speed = self.speed + self._share(np.full(len(away), self.slope)) * (away * self.rate - self.speed)
        made = _gone(chain, self.last, self._share(self.cutoff + self.opening * np.abs(speed)) * away)
        return replace(self, last=made, speed=speed), made

    def _share(self, cutoff: np.ndarray) -> np.ndarray:
        return 1.0 / (1.0 + self.rate / (2.0 * math.pi * cutoff))


@dataclass(frozen=True, eq=False)
class KalmanFilter:
    """Constant velocity, every degree by itself. rate: frames a second. push: standard deviation of accelerations [m/s², rad/s²].

    noise: standard deviation of what is measured [m, rad].
    """

    rate: float
    push: float = 20.0
    noise: float = 0.05
    last: Configuration | None = None
    speed: np.ndarray | None = None
    spread: np.ndarray | None = None

    def step(self, chain: Chain, pose: Configuration) -> tuple[KalmanFilter, Configuration]:
        """The filter after a pose, and what it makes of it."""
        if self.last is None or self.speed is None or self.spread is None:
            return replace(self, last=pose, speed=np.zeros(6 + len(chain)), spread=np.diag([self.noise**2, 4.0])), pose
        dt = 1.0 / self.rate
        go = np.array([[1.0, dt], [0.0, 1.0]])
        spread = go @ self.spread @ go.T + self.push**2 * np.array([[dt**4 / 4, dt**3 / 2], [dt**3 / 2, dt**2]])
        ahead = _gone(chain, self.last, self.speed * dt)
        gain = spread[:, 0] / (spread[0, 0] + self.noise**2)
        away = _difference(chain, ahead, pose)
        made = _gone(chain, ahead, gain[0] * away)
        return replace(self, last=made, speed=self.speed + gain[1] * away, spread=spread - np.outer(gain, spread[0])), made


def smoothed(chain: Chain, poses: Sequence[Configuration], how: OneEuro | KalmanFilter) -> list[Configuration]:
    """Poses after a filter that knows the past alone."""
    out, current = [], how
    for pose in poses:
        step: Any = current.step(chain, pose)
        current, made = step
        out.append(made)
    return out


def savitzky_golay(chain: Chain, poses: Sequence[Configuration], reach: int = 5, order: int = 3, ahead: int | None = None) -> list[Configuration]:
    """Each pose moved onto the polynomial through `reach` frames before it and `ahead` after it, as many by default: it knows the future."""
    out = []
    for t, pose in enumerate(poses):
        near = range(max(t - reach, 0), min(t + (reach if ahead is None else ahead) + 1, len(poses)))
        away = np.stack([_difference(chain, pose, poses[k]) for k in near])
        times = np.array([k - t for k in near], float)
        powers = np.vander(times, min(order, len(near) - 1) + 1, increasing=True)
        out.append(_gone(chain, pose, np.linalg.lstsq(powers, away, rcond=None)[0][0]))
    return out


def _difference(chain: Chain, one: Configuration, other: Configuration) -> np.ndarray:
    out = np.empty(6 + len(chain))
    out[:6] = log(rigid(inverse(one.root) @ other.root))
    turn_log_kernel(chain.first, chain.count, one.angles, other.angles, out[6:])
    return out


def _gone(chain: Chain, pose: Configuration, step: np.ndarray) -> Configuration:
    root, angles = rigid(pose.root @ exp(step[:6])), pose.angles.copy()
    retract_kernel(chain.first, chain.count, np.concatenate([np.zeros(6), step[6:]]), root, angles, chain.lower, chain.upper)
    return Configuration(root, angles)
