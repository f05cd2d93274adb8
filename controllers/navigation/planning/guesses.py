"""Where searches begin: the same place to go, turned to it in different ways, past things on different sides."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...body import wrap
from .splines import Basis
from .walking_cost import Weights

TURNING = 0.35
"""Shares of the time in which a guess turns to the way, and from it to the goal's heading."""
BOTH_WAYS = 0.5 * np.pi
"""Turns larger than this [rad] are tried the other way round, too."""
AHEAD = 1.2
"""Where the goal can't be walked to straight, the walker faces the way so far ahead [m]."""
MOVES = 0.2
"""Who is faster than this [m/s, half as much in rad/s] is moving."""
STANDING = np.zeros(3)
TURNED, TURNS = 0.15, 0.6
"""Who passes where it is narrow is turned aside so far before and after it [m], and begins to turn so much farther from there [m]."""
NEAR = 2.5
"""Ways shorter than this [m] are tried without turning to them: to the side, or backward."""


def ease(share):
    """0 … 1 with rest at both ends: what the least effort is on a straight line."""
    share = np.clip(share, 0.0, 1.0)
    return share * share * (3.0 - 2.0 * share)


def both_ways(from_angle: float, to_angle: float) -> list[float]:
    """An angle [rad] as the nearest turn brings it about, and as the other way round does where that is not much farther."""
    turn = float(wrap(to_angle - from_angle))
    far = turn - np.copysign(2.0 * np.pi, turn)
    return [from_angle + t for t in ((turn,) if abs(turn) < BOTH_WAYS else (turn, far))]


def faced(way: np.ndarray, basis: Basis) -> np.ndarray:
    """What a walker on a way (n, 2) faces at each place of the quadrature (Q, 2) [m]: the goal on the last stretch, before it the way ahead."""
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(way, axis=0), axis=1))])
    here = ease(basis.shares) * along[-1]
    there = np.where(here >= along[-2], along[-1], here + AHEAD)
    return np.stack([np.interp(there, along, way[:, i]) for i in range(2)], -1)


def guesses(way: np.ndarray, start: float, goal: float, weights: Weights, top: float, basis: Basis,
            moving: np.ndarray = STANDING, leaving: np.ndarray = STANDING,
            narrow: Callable[[np.ndarray], np.ndarray] | None = None) -> tuple[np.ndarray, np.ndarray]:
    """First splines (S, M + 3, 3) and times (S,) [s] along a way (n, 2) [m], from one heading to another [rad].

    top: the fastest that is gone ahead [m/s]. moving: (3,) ẋ, ż, ω in the world at the start [m/s, rad/s]: who moves may also go on
    so at first. leaving: (3,) likewise, at the goal. narrow: whether it is too narrow at places (P, 2) of the way for who is not turned aside, to the left or to the right.
    """
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(way, axis=0), axis=1))])
    length = along[-1]
    share = ease(basis.peaks)
    place = np.stack([np.interp(share * length, along, way[:, i]) for i in range(2)], -1)
    made, times = [], []
    direct = len(way) == 2
    if length < NEAR and direct or length < 1e-9:
        for last in both_ways(start, goal):
            made.append(start + share * (last - start))
            times.append((length, abs(last - start)))
    if length >= 1e-9:
        steps = np.diff(way, axis=0)
        bearings = np.unwrap(np.arctan2(steps[:, 0], steps[:, 1]))
        aside = _aside(share * length, np.zeros(len(place), bool) if narrow is None else narrow(place))
        for first in both_ways(start, bearings[0]):
            ahead = np.interp(share * length, 0.5 * (along[1:] + along[:-1]), bearings - bearings[0] + first)
            end = bearings[-1] - bearings[0] + first
            for last in both_ways(end, goal):
                for side in (0.5 * np.pi, -0.5 * np.pi) if aside.any() else (0.0,):
                    path = ahead + side * aside
                    towards, away = ease(basis.peaks / TURNING), ease((basis.peaks - 1.0) / TURNING + 1.0)
                    made.append(start + towards * (path - start) + away * (last - path))
                    times.append((length, abs(first - start) + np.abs(np.diff(path)).sum() + abs(last - end)))
    far, turned = np.array(times).T
    seconds = (36.0 * (weights.forward * far**2 + weights.turning * turned**2) / weights.time) ** 0.25
    seconds = np.maximum(seconds, 1.5 * far / top) + 0.1
    guess = np.empty((len(made), len(basis.peaks), 3))
    guess[..., :2] = place
    guess[..., 2] = made
    guess -= (basis.peaks**2 * (1.0 - basis.peaks) * seconds[:, None])[..., None] * leaving  # a cubic with that velocity in the end
    if direct and np.hypot(*moving[:2]) + 0.5 * abs(moving[2]) > MOVES:
        going = basis.peaks * (1.0 - basis.peaks) ** 2 * seconds[:, None]  # a cubic with that velocity at first, and none in the end
        guess = np.concatenate([guess, guess + going[..., None] * moving])
        seconds = np.tile(seconds, 2)
    return guess, seconds


def _aside(along: np.ndarray, narrow: np.ndarray) -> np.ndarray:
    """How much 0 … 1 somebody is turned aside at places along a way (P,) [m], some of which (P,) are narrow."""
    if not narrow.any():
        return np.zeros(len(along))
    return ease(1.0 - (np.abs(along[:, None] - along[narrow]).min(1) - TURNED) / TURNS)
