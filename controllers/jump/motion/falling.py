"""The making of one fall: a body in the air gets its feet under itself, upright, comes down and stands."""

from __future__ import annotations

import numpy as np

from ..body import Physique, Start, carriage, hermite, momentum_kernel, turns, vectors
from ..prior import BETWEEN, LEGS
from .airborne import SAME, Airborne
from .flight import flight_kernel
from .path_estimate import Path
from .plan import Plan

TURNS = 5.0
"""Nobody turns faster to get upright [rad/s]."""
FASTEST = 12.0
"""Legs go on no faster than this [rad/s] as they lose the floor: the way to where they land leads no farther round."""
REACHES = 0.30
"""So long after the hit the legs are where they land [s]."""
GATHERS = 0.6
"""In so long [s] arms that were thrown out are as in any landing."""
ROUNDS, CLOSE = 5, 0.02
"""At most so many flights are tried until the body lands this upright [rad]."""
TUCKED, EARLY = np.array([-0.7, 1.3, -0.6]), 0.4
"""A leg that is drawn up is bent more by so many [rad] at hip, knee and ankle, after so much of the time in which legs get to where they land."""
PUSHES = 0.15
"""A foot pushes off the edge for so long [s], at first hardest."""
LATE = PUSHES / 3.0
"""Who pushes off so stays for good this long [s] behind one who had all that speed at once."""


class Falling(Airborne):
    """One fall in the making. tucks: (2,) how far legs are drawn up half-way, as a share of TUCKED. push: (3,) [m/s] how much faster along the floor a foot's push off the edge makes
    it, which `way` has from the beginning. gives: which share of the usual it sinks in its landing. like: one that differs little, whose turn is where the search for its own begins."""

    def __init__(self, physique: Physique, start: Start, way: Path, landing: np.ndarray, tucks: np.ndarray, push: np.ndarray, gives: float, like: Falling | None = None):
        self.tucks, self.push, self.like = tucks, push, like
        touch = way.keys[3 * BETWEEN, :LEGS]
        share = min(way.airtime / GATHERS, 1.0)
        super().__init__(physique, start, way, landing, 0.0, [0.0, way.airtime], np.stack([carriage.FALL, carriage.FALL + share * (touch - carriage.FALL)]), gives)

    def plan(self) -> Plan:
        """Everything, in order."""
        self._differ(self.carriage(0.0))
        self._prepare_air()
        left = np.maximum(1.0 - self.flying[:, None] / PUSHES, 0.0)
        self.arc += LATE * self.push * left**3
        self._turn_upright()
        after, landed, heels, through = self._land()
        way, flying = self.way, self.flying
        contacts = np.zeros((len(flying) + len(after), 4), bool)
        contacts[len(flying):, 1::2], contacts[len(flying):, ::2] = True, heels
        return Plan(
            np.append(flying, self.down + after), np.concatenate([self.air_roots, landed[0]]),
            np.concatenate([self.air, landed[1]]), np.concatenate([self.arc, landed[2]]),
            np.concatenate([way.velocity - self.push * left**2 + self.gravity * flying[:, None], landed[3]]),
            self.physique.mass * np.concatenate([2.0 / PUSHES * left * self.push, landed[4] - self.gravity]),
            contacts, 0.0, 0.0, self.down, self.down + self.lowest, self.down + through, self.landing, self.momentum.copy(), way)

    def _turn_upright(self) -> None:
        """Fly with the angular momentum that lands the body upright: arms and hands get it from what they hit."""
        self.air[0] = self.start.rotations
        wanted = self._upright(self.air_angles[-1:, 0])[0]
        inertia = self._inertia()
        spin = vectors(wanted @ self.air[0, 0].T) / self.way.airtime if self.like is None else self.like.spin
        landed = wanted if self.like is None else self.like.air[-1, 0].copy()
        for _ in range(ROUNDS):
            spin = spin * min(1.0, TURNS / max(float(np.linalg.norm(spin)), 1e-9))
            self._fly(inertia @ spin, landed, 1e-4)
            landed, miss = self.air[-1, 0].copy(), self._miss(wanted, self.air)
            if np.abs(miss).max() < CLOSE:
                break
            spin = spin + miss / self.way.airtime
        self.spin = spin
        for _ in range(ROUNDS):  # the legs reach for where this very body comes down
            landed = self.air[-1, 0].copy()
            self._fly(self.momentum.copy(), landed, 1e-9)
            if np.abs(vectors(landed.T @ self.air[-1, 0])).max() < SAME:
                break

    def _inertia(self) -> np.ndarray:
        """The body's inertia (3, 3) [kg m²] as it was struck."""
        placed, inertia = self._parts(self.start.root, self.start.rotations), np.empty((3, 3))
        momentum_kernel(self.body, *placed, *placed, 1.0, np.empty(3), inertia)
        return inertia

    def _fly(self, momentum: np.ndarray, landed: np.ndarray, tolerance: float) -> None:
        """The flight with an angular momentum (3,), the legs reaching as if the body came down turned `landed`."""
        ids, airtime = self.legs, self.way.airtime
        now, end = self.start.rotations[ids], self._touching(landed)[0]
        step = self.flying[1]
        before = vectors(turns(-step * self.start.rates[ids]) @ now)
        now = vectors(now)
        rates = (now - before) / step
        rates = rates * np.minimum(1.0, FASTEST / np.maximum(np.linalg.norm(rates, axis=-1, keepdims=True), 1e-9))
        times = np.array([0.0, min(airtime, REACHES), airtime + 1e-6])
        values, slopes = [now, end, end], [rates, 0 * end, 0 * end]
        if self.tucks.any():
            half = 0.5 * (now + end)
            half[:3, 0] += TUCKED * self.tucks[0]
            half[4:7, 0] += TUCKED * self.tucks[1]
            times, values, slopes = np.insert(times, 1, EARLY * times[1]), [now, half, end, end], [slopes[0], (end - now) / times[1], *slopes[1:]]
        curve = hermite(times, np.stack(values), np.stack(slopes), self.flying)
        curve[:, [1, 5], 0] = np.maximum(curve[:, [1, 5], 0], np.minimum(now[[1, 5], 0], 0.05))  # knees don't bend back
        self.air[1:, ids] = turns(curve)[1:]
        self.momentum[:] = momentum
        flight_kernel(self.body, self.arc, self.air, np.zeros(3), self.momentum, step, self.air_roots, tolerance)
