"""Where somebody looks who jumps aside, backward or turning: to where he lands, then to where he will face."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...body import Skeleton
from ..body import FLAT, Start, hermite, monotone
from .path_estimate import Path

SHARES = {"Spine": 0.08, "Spine1": 0.08, "Spine2": 0.08, "Neck": 0.3, "Head": 0.46}
"""Which joint turns by which share of a look aside."""
MOST, HASTE = 1.4, 4.0
"""How far aside of the pelvis one looks at most [rad], and how fast one turns the head there [rad/s]."""
EASES = 0.12
"""In about so long [s] a head that was still comes to turn that fast."""
SPOT = 0.3
"""A place that is nearer [m] is no other: one looks at once where one will face."""
LEADS = 0.5 * math.pi
"""Who turns so far [rad] has taken his eyes from the place as he leaves the floor, and turns the head before the body."""
STAYS, BACK = 0.25, 0.4
"""How much of the look at the place is left at touch-down, and how long after that one looks ahead again [s]."""


@dataclass(frozen=True, eq=False)
class Look:
    """A look: how far (K,) [rad] the head is turned to the left of the pelvis at times (K,) [s]. joints: (5,), shares: (5,) of it."""

    times: np.ndarray
    angles: np.ndarray
    joints: np.ndarray
    shares: np.ndarray

    @staticmethod
    def of(start: Start, way: Path, place: np.ndarray, skeleton: Skeleton) -> Look:
        """The look of a jump along a path that lands at a place (3,) [m]."""
        turn = way.turn
        leave = way.wind_up + (0.0 if way.push is None else way.push.duration)
        flat = (place - way.stance) * FLAT
        to = turn
        if np.linalg.norm(flat) > SPOT:
            to = math.remainder(math.atan2(flat[0], flat[2]) - start.heading, math.tau)
            if to * turn < 0.0 and abs(to) > 0.5 * math.pi:  # behind: over the shoulder to which one turns
                to += math.copysign(math.tau, turn)
        ahead = to + min(abs(turn) / LEADS, 1.0) * (turn - to)
        after = turn + STAYS * (ahead - turn)
        times = np.array([0.0, way.wind_up, leave, leave + 0.5 * way.airtime, leave + way.airtime, leave + way.airtime + BACK])
        goals = np.array([0.0, to, ahead, 0.5 * (ahead + turn), after, turn]) - way.turned(times)
        most = np.minimum(HASTE * times**2 / (times + EASES), MOST)
        return Look(times, np.append(np.clip(goals, -most, most)[:-1], 0.0), np.array([skeleton.index(name) for name in SHARES]), np.array([*SHARES.values()]))

    def turns(self, times: np.ndarray, count: int) -> np.ndarray:
        """How far (N, count, 3) [rad] each of so many joints is turned at times (N,) [s], in its parent's frame."""
        out = np.zeros((len(times), count, 3))
        slopes = monotone(self.times, self.angles)
        slopes[[0, -1]] = 0.0  # a head is turned from rest, and comes to rest
        angle = hermite(self.times, self.angles, slopes, np.minimum(times, self.times[-1]))
        out[:, self.joints, 1] = angle[:, None] * self.shares
        return out
