"""Planning a jump: path, wind-up, push, flight and landing, one after the other, and a pose for each moment.

Where the centre of mass goes is decided first; trunk, arms and head are carried by `style`, legs
follow from where the feet are, and in the air the turning of the whole body follows from its momentum.
"""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np

from .body import Physique, Start, landing_feet, momentum_kernel, striding_feet, turns, vectors
from .motion import COLUMNS, HEEL, SAME, Path, Plan, Pushing, depths, flight_kernel, flying_legs_kernel, lifts, spread
from .prior import BETWEEN, EACH, LEGS

ROUNDS, CLOSE = 8, 0.02
"""At most so many flights are tried until the body lands this upright [rad]."""
MOST_TURN, MOST_GAIN = 0.7, 2.5
"""From one to the next the body comes down turned otherwise by so much at most [rad]; so many times the momentum of a stiff body
that turns so may bring it about."""
BEYOND = 1.7
"""How far the legs reach beyond how a body just came down, at first: it turns about half as far back."""
TAKES, TAKEN = 6, 2e-5
"""At most so many spins at take-off are tried until it gives the momentum that was found, to this, over mass and height squared [1/s]."""
CLEARINGS = 8
"""Feet that would go through the floor in the air are lifted so often at most."""
COARSE = 3
"""Until then, only every third pose is made."""
PLACED = 0.02
"""A foot that still comes down as its body winds up stands once it is so near to its place [m], at standard height."""


def plan(physique: Physique, start: Start, way: Path, place: np.ndarray, floor: float) -> Plan:
    """The whole jump from `start`, off a floor at height `floor` [m], along a path to a `place` (3,) [m].

    Checks nothing: see `reach`.
    """
    return drafted(physique, start, way, place, floor).plan()


def drafted(physique: Physique, start: Start, way: Path, place: np.ndarray, floor: float) -> Draft:
    """The same, to be planned: its flight can be looked at first."""
    place = np.asarray(place, float)
    landing = (landing_feet(place, start.lands, physique.tables, start.lands_on) if way.lands is None
               else striding_feet(place, start.lands, physique.tables, way.lands, start.lands_on))
    planted = start.planted(floor, physique.tables)
    return Draft(physique, start, way, planted, landing)


class Turning(NamedTuple):
    """How a body turns in the air, found along every third pose. wanted: (3, 3) how it shall come down. spun, still: (3, 3), (3,) the momentum that a spin of the pelvis at take-off gives
    [kg m²/s over rad/s], beside what it has without one. momentum: (3,) with which it comes down so. roots: (N, 3) [m], local: (N, J, 3, 3) the poses."""

    wanted: np.ndarray
    spun: np.ndarray
    still: np.ndarray
    momentum: np.ndarray
    roots: np.ndarray
    local: np.ndarray


class Draft(Pushing):
    """One plan in the making: what its parts share."""

    def plan(self) -> Plan:
        """Everything that is left to do, in order."""
        spin = self._fly()
        self._stand(spin, 0)
        after, landed, heels, through = self._land()
        way, mass, g = self.way, self.physique.mass, self.gravity
        contacts = np.zeros((len(self.times) + len(self.flying) - 1 + len(after), 4), bool)
        heel_up = self.feet[:, :, 4] > HEEL
        off = self.feet[:, :, :3] - self.planted[:, :3]
        on = (self.feet[:, :, 5] >= 0.0) & (np.maximum(np.hypot(off[..., 0], off[..., 2]), off[..., 1]) < PLACED * self.physique.size)
        contacts[:len(self.times), 1::2], contacts[:len(self.times), ::2] = on, on & ~heel_up
        contacts[-len(after):, 1::2], contacts[-len(after):, ::2] = True, heels
        if way.lands is not None:
            contacts[-len(after):, 2 - 2 * way.lands:4 - 2 * way.lands] = (after >= self.stands)[:, None]
        flying = self.flying[1:]
        return Plan(
            np.concatenate([self.times, self.leave + flying, self.down + after]),
            np.concatenate([self.roots, self.air_roots[1:], landed[0]]),
            np.concatenate([self.local, self.air[1:], landed[1]]),
            np.concatenate([self.centres, self.arc[1:], landed[2]]),
            np.concatenate([self.velocities, way.velocity + g * flying[:, None], landed[3]]),
            mass * np.concatenate([self.forces, np.zeros((len(flying), 3)), landed[4] - g]),
            contacts, self.off, self.leave, self.down, self.down + self.lowest, self.down + through, self.landing, self.momentum.copy(), way)

    @cached_property
    def turning(self) -> Turning:
        """How the body turns in the air: every third pose of its flight, known at half the cost of a plan.

        Without angular momentum a body only turns against its limbs, by less than half a turn. From there on the momentum is
        found by Broyden's method, in steps that turn it a little: none leads round by a somersault.
        """
        self._prepare_air()
        self.roots[-3:] = self.centres[-3:]  # a guess
        wanted = self._upright(self.air_angles[-1:, 0], self.down)[0]
        time = self.way.airtime
        spin, spun = np.zeros(3), np.zeros((3, 3))
        self._leave(spin)
        still = self.momentum.copy()
        for k in range(3):  # what a spin gives is nearly linear
            self._leave(np.eye(3)[k])
            spun[:, k] = self.momentum - still
        gain = spun / time
        self.momentum[:] = 0.0
        if self.way.turn:  # round once, and no other way
            self.momentum[:] = gain @ [0.0, self.way.turned(self.down) - self.way.turned(self.leave), 0.0]
        change = before = np.zeros(3)
        for _ in range(ROUNDS):
            roots, flown = self._flight(wanted, 1e-4, COARSE)
            miss = vectors(wanted @ flown[-1, 0].T)
            if np.abs(miss).max() < CLOSE:
                break
            if change.any():
                turned = before - miss
                if turned @ turned > 1e-6:
                    gain += np.outer(change - gain @ turned, turned) / (turned @ turned)
            step = miss * min(1.0, MOST_TURN / float(np.linalg.norm(miss)))
            change, before = gain @ step, miss
            bound = MOST_GAIN * float(np.linalg.norm(spun @ step)) / time
            change *= min(1.0, bound / max(float(np.linalg.norm(change)), 1e-12))
            self.momentum[:] += change
        return Turning(wanted, spun, still, self.momentum.copy(), roots, flown)

    def _fly(self) -> np.ndarray:
        """Fly with the spin (3,) at take-off with which the body lands upright, and find it."""
        wanted, spun, still, meant, *_ = self.turning
        spin = np.zeros(3)
        self.momentum[:] = still
        for _ in range(TAKES):  # nearly linear, but for a leg that is nearly straight
            spin = spin + np.linalg.solve(spun, meant - self.momentum)
            self._leave(spin)
            if np.abs(meant - self.momentum).max() < TAKEN * self.physique.mass * self.physique.size**2:
                break
        self._reach(wanted)
        for _ in range(CLEARINGS):
            deep, down = depths(self.physique, self.air_roots, self.air, self.arc, self.planted, self.landing, self.start.slope, self.start.lands_on, self.start.ledge)
            if not deep.any():
                break
            bent = vectors(self.air[:, self.legs].reshape(-1, 2, 4, 3, 3))[:, :, :EACH, 0]
            self.lifts = lifts(self.flying, deep, down, bent, self.lifts, self.physique.size)
            self._reach(wanted)
        return spin

    def _reach(self, wanted: np.ndarray) -> None:
        """Fly with legs that reach for where this very body comes down, upright as wanted (3, 3): that changes a little how it turns."""
        landed, beyond, off = wanted, BEYOND, None
        _, flown = self._flight(landed, 1e-4, COARSE)
        for _ in range(ROUNDS):
            before, off = off, vectors(landed.T @ flown[-1, 0])
            if before is not None:
                if np.abs(off).max() < SAME:
                    break
                change = before - off
                beyond = float(np.clip(beyond * (before @ change) / max(change @ change, 1e-12), 0.8, 2.5))
            landed = landed @ turns(beyond * off)
            _, flown = self._flight(landed, 1e-9)

    def _leave(self, spin: np.ndarray) -> None:
        """Take off with a spin (3,): the last poses on the floor, and the momentum that they have."""
        self._stand(spin, len(self.times) - 3)
        step = self.times[-1] - self.times[-2]
        momentum_kernel(self.body, *self._parts(self.roots[-2], self.local[-2]), *self._parts(self.roots[-1], self.local[-1]),
                        step, self.momentum, np.empty((3, 3)))

    def _flight(self, landed: np.ndarray, tolerance: float, every: int = 1) -> tuple[np.ndarray, np.ndarray]:
        """The flight, its legs reaching as if it came down turned `landed` (3, 3): where its pelvis is (N, 3) [m] and its poses (N, J, 3, 3), of `every` so many
        only."""
        step = self.times[-1] - self.times[-2]
        air, arc, roots, times = (np.ascontiguousarray(part[::every]) for part in (self.air, self.arc, self.air_roots, self.flying))
        air[:, self.legs] = self._legs_in_flight(step, *self._touching(landed), times)
        air[0] = self.local[-1]
        rate = vectors(self.local[-1, 0] @ self.local[-2, 0].T) / step
        flight_kernel(self.body, arc, air, rate, self.momentum, times[1], roots, tolerance)
        return roots, air

    def _legs_in_flight(self, step: float, end: np.ndarray, bending: np.ndarray, times: np.ndarray) -> np.ndarray:
        """The legs' local rotations (N, 8, 3, 3) at times (N,) [s] in the air: as recorded, out of the push and to how they
        touch down (8, 3) [rad], with `bending` (8, 3) [rad/s]."""
        rows, keys = np.ascontiguousarray(self.way.keys[2 * BETWEEN:3 * BETWEEN + 1, LEGS:]), self.due[2 * BETWEEN:3 * BETWEEN + 1] - self.leave
        before, last = vectors(self.local[-2:, self.legs]).reshape(2, COLUMNS)
        bends = np.empty((len(times), COLUMNS))
        flying_legs_kernel(times, self.way.airtime, keys, rows, before, last, step, end.ravel(), bending.ravel(), bends)
        bends = bends.reshape(len(times), 2, 4, 3)
        if self.lifts.any():
            bends[:, :, :EACH, 0] += spread(times, self.way.airtime, self.lifts)
        return turns(bends).reshape(len(times), -1, 3, 3)
