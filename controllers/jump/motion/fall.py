"""The fall: something is in the way in the air, or a foot was set down over an edge. A hit takes the velocity into it, and
the body gets its feet under itself, comes down on whatever floor there is, and stands.

Beyond the thesis; after Faloutsos 2001, whose controllers end in a state that another can take over from.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...body import Pose, Skeleton, end_positions, forward_kinematics, sole_corners
from ...navigation import floor_at, gap, slope_at
from ..body import (FLAT, TRAIL, Physique, Start, hermite, landing_feet, measures, momentum_kernel, carriage,
                    rise, soles, turns, vectors)
from ..prior import BETWEEN, LEGS, Prior
from .airborne import SAME, Airborne
from .flight import flight_kernel
from .path_estimate import Path, softened
from .plan import Plan
from .rolling import rolled, rolls, room

BOUNCE, FRICTION = 0.05, 0.4
"""How much of the velocity into it something gives back, and how much along it it takes, as a share of that."""
CLOSING = 0.4
"""Slower than this [m/s] a body does not strike what it touches."""
LEAST, LOW = 0.14, 0.5
"""Legs need so long to come down [s]; a body lands no lower than this share of how high it touches down."""
TURNS = 5.0
"""Nobody turns faster to get upright [rad/s]."""
FASTEST = 12.0
"""Legs go on no faster than this [rad/s] as they lose the floor: the way to where they land leads no farther round."""
REACHES = 0.30
"""So long after the hit the legs are where they land [s]."""
GATHERS = 0.6
"""In so long [s] arms that were thrown out are as in any landing."""
ASIDE = ((0.25, 0.17), (1.15, 0.36))
"""What stands or hangs at a height over the feet [m] is so far from them [m] when they come down."""
BESIDE, ROUND, DEEP, HANGS = np.linspace(0.05, 0.3, 6), np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False), 10.0, 0.05
"""Where soles would be in a riser or hang over an edge they come down so far beside [m], in one of these directions: as near as can be, where a metre that a sole is in
something counts as so many, and a corner that hangs as so much [m]."""
ROUNDS, CLOSE = 5, 0.02
"""At most so many flights are tried until the body lands this upright [rad]."""
TUCKS, TUCKED, EARLY = np.array([0.5, 1.0, 1.5]), np.array([-0.7, 1.3, -0.6]), 0.4
"""A leg that would go into something, as into the edge that it leaves, is drawn up by one of these, hip, knee and ankle by so many [rad] of each, after so much of the time in which legs
get to where they land."""
GRAZES, SHIN = 0.01, 0.045
"""So deep [m] legs may be in something; how thick shins are [m], at standard height."""


@dataclass(frozen=True, eq=False)
class Hit:
    """What a flying body struck: where (3,) [m], and the way (3,) out of it."""

    place: np.ndarray
    normal: np.ndarray

    @property
    def reason(self) -> str:
        """In words."""
        x, y, z = self.place
        return f"it struck something in the air at ({x:.1f}, {y:.1f}, {z:.1f}) m"

    def after(self, velocity: np.ndarray) -> np.ndarray:
        """The velocity (3,) [m/s] that is left: a little back, and less along it."""
        into = min(float(velocity @ self.normal), 0.0)
        along = velocity - into * self.normal
        pace = float(np.linalg.norm(along))
        return along * (1.0 - min(FRICTION * -into / max(pace, 1e-9), 1.0)) - BOUNCE * into * self.normal


def struck(skeleton: Skeleton, pose: Pose, centre: np.ndarray, velocity: np.ndarray, around: Sequence[Any]) -> Hit | None:
    """What a body runs into whose centre of mass (3,) flies with `velocity` (3,) [m/s]; its feet may touch
    what they please. It is sent back as if its middle were in the way, so that nobody hangs on an edge."""
    positions, turned = forward_kinematics(skeleton, pose.root, pose.rotations)
    feet = [skeleton.index(side + part) for side in ("Left", "Right") for part in ("Foot", "Toe")]
    ends = [skeleton.end_index[name] for name in ("Head", "LeftHand", "RightHand")]
    body = np.concatenate([np.delete(positions, feet, 0), end_positions(skeleton, positions, turned)[ends]])
    for thing in around:
        deep = gap(body, thing)
        place = body[int(deep.argmin())]
        if deep.min() < 0.0:
            normal = _out(np.array([centre[0], place[1], centre[2]]), thing)
            if velocity @ normal < -CLOSING:
                return Hit(place, normal)
    return None


def _out(place: np.ndarray, thing) -> np.ndarray:
    """The way (3,) out of a thing from a place (3,)."""
    step = 1e-4 * np.eye(3)
    slope = gap(place + step, thing) - gap(place - step, thing)
    return slope / max(float(np.linalg.norm(slope)), 1e-12)


def fall(physique: Physique, start: Start, hit: Hit | None, around: Sequence[Any], gravity: np.ndarray) -> Plan:
    """The motion from the moment of a hit, or of losing the floor, to standing, with a roll where it comes down hard, going ahead. start: the body at that moment."""
    velocity = start.velocity if hit is None else hit.after(start.velocity)
    time, land, place = _down(physique, start.centre, velocity, start.heading, around, gravity)
    prior, falls = Prior.load(), max(-float(velocity[1] + gravity[1] * time), 0.0)
    features = prior.features(falls, 0.0, 0.0, physique.size, False)
    way = Path(start.centre, start.centre, land, velocity, velocity, time, 0.0, gravity, None, start.centre, start.centre, heading=start.heading,
               keys=prior.keys(features, features))
    start = replace(start, lands_on=slope_at(place[0], place[2], around, place[1] + GRAZES))
    landing, tucks = landing_feet(place, start.heading, physique.tables, start.lands_on), np.zeros(2)
    best = _Fall(physique, start, way, landing, tucks).plan()
    deep = least = _deep(physique, best, around)
    for tuck in TUCKS:
        if deep.max() < GRAZES:
            break
        tucks = np.where(deep < GRAZES, tucks, tuck)
        made = _Fall(physique, start, way, landing, tucks).plan()
        deep = _deep(physique, made, around)
        if deep.max() < least.max():
            best, least = made, deep
    if rolls(physique, way):
        rolling = rolled(physique, best)
        if room(physique, rolling, around):
            return rolling
    return best


def _deep(physique: Physique, made: Plan, around: Sequence[Any]) -> np.ndarray:
    """How deep (2,) [m] shins and soles of either leg go into anything while they fall, beyond how deep they were in it."""
    if not around:
        return np.zeros(2)
    air, skeleton, out = slice(0, int(np.searchsorted(made.times, made.touch_down)), 2), physique.skeleton, np.zeros(2)
    positions, turned = forward_kinematics(skeleton, made.roots[air], made.local[air])
    soles = sole_corners(skeleton, positions, turned).reshape(len(positions), 2, -1, 3)
    for side, name in enumerate(("Left", "Right")):
        knee, ankle = (positions[:, skeleton.index(name + joint)] for joint in ("Leg", "Foot"))
        shin = knee[:, None] + np.linspace(0.3, 0.9, 4)[:, None] * (ankle - knee)[:, None]
        points, thick = np.concatenate([soles[:, side], shin], 1), np.append(np.zeros(soles.shape[2]), np.full(4, SHIN * physique.size))
        for thing in around:
            far = thick - gap(points.reshape(-1, 3), thing).reshape(points.shape[:2])
            out[side] = max(out[side], float((far - np.maximum(far[:1], 0.0)).max()))
    return out


def _down(physique: Physique, centre: np.ndarray, velocity: np.ndarray, heading: float, around: Sequence[Any],
          gravity: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """When [s] and where (3,) a falling centre of mass is as the feet touch the floor, and their place (3,) there, heading so [rad]."""
    flat, g, touch = velocity * FLAT, -float(gravity[1]), measures(physique).touch(0.0)
    pace, size = float(np.linalg.norm(flat)), physique.size
    ahead = flat / max(pace, 1e-9) * min(TRAIL[0] * pace, TRAIL[1] * size)

    def until(height: float) -> float:
        return (velocity[1] + np.sqrt(max(velocity[1] ** 2 + 2.0 * g * (centre[1] - height), 0.0))) / g
    time, place, floor = 0.0, centre, centre[1] - touch
    for _ in range(4):  # the floor tells the time, the time where, and that the floor
        place = centre + time * flat + ahead
        for thing in around:
            for height, aside in ASIDE:
                near = gap(foot := np.array([[place[0], floor + height * size, place[2]]]), thing)[0]
                if near < aside * size:  # a goal is infinitely far, and has no way out
                    place = place + (aside * size - near) * _out(foot[0], thing) * FLAT
        floor = floor_at(place[0], place[2], around, centre[1] - LOW * touch)
        soft = softened(np.sqrt(velocity[1] ** 2 + 2.0 * g * max(centre[1] - floor - touch, 0.0)), physique.tables)
        time = max(until(floor + touch - soft), min(LEAST, until(floor + LOW * touch)), 0.03)
    return time, centre + time * velocity + 0.5 * time**2 * gravity, _clear(physique, np.array([place[0], floor, place[2]]), heading, around)


def _clear(physique: Physique, place: np.ndarray, heading: float, around: Sequence[Any]) -> np.ndarray:
    """The place (3,) near another one at its height where both soles come down whole, or as whole as can be: out of risers, and not over edges."""
    size, slope = physique.size, slope_at(place[0], place[2], around, place[1] + GRAZES)
    corners = soles(landing_feet(place, heading, physique.tables, slope), physique.tables, slope)

    def cost(aside: np.ndarray) -> float:
        high = np.array([floor_at(x, z, around, y + LOW * size) - y for x, y, z in corners + aside])
        return float(np.hypot(*aside[[0, 2]]) + DEEP * max(high.max() - GRAZES, 0.0) + HANGS * (high < -GRAZES).sum())
    best = np.zeros(3)
    if not len(around) or cost(best) == 0.0:
        return place
    ways = [far * size * np.array([np.sin(angle), 0.0, np.cos(angle)]) for far in BESIDE for angle in ROUND]
    ways = [way + [0.0, rise(way[[0, 2]], slope), 0.0] for way in ways]
    return place + min([best, *ways], key=cost)


class _Fall(Airborne):
    """One fall in the making. tucks: (2,) how far legs are drawn up half-way, see TUCKS."""

    def __init__(self, physique: Physique, start: Start, way: Path, landing: np.ndarray, tucks: np.ndarray):
        self.tucks = tucks
        touch = way.keys[3 * BETWEEN, :LEGS]
        share = min(way.airtime / GATHERS, 1.0)
        super().__init__(physique, start, way, landing, 0.0, [0.0, way.airtime], np.stack([carriage.FALL, carriage.FALL + share * (touch - carriage.FALL)]))

    def plan(self) -> Plan:
        """Everything, in order."""
        self._differ(self.carriage(0.0))
        self._prepare_air()
        self._turn_upright()
        after, landed, heels, through = self._land()
        way, flying = self.way, self.flying
        contacts = np.zeros((len(flying) + len(after), 4), bool)
        contacts[len(flying):, 1::2], contacts[len(flying):, ::2] = True, heels
        return Plan(
            np.append(flying, self.down + after), np.concatenate([self.air_roots, landed[0]]),
            np.concatenate([self.air, landed[1]]), np.concatenate([self.arc, landed[2]]),
            np.concatenate([way.velocity + self.gravity * flying[:, None], landed[3]]),
            self.physique.mass * np.concatenate([np.zeros((len(flying), 3)), landed[4] - self.gravity]),
            contacts, 0.0, 0.0, self.down, self.down + self.lowest, self.down + through, self.landing, self.momentum.copy(), way)

    def _turn_upright(self) -> None:
        """Fly with the angular momentum that lands the body upright: arms and hands get it from what they hit."""
        self.air[0] = self.start.rotations
        wanted = self._upright(self.air_angles[-1:, 0])[0]
        inertia = self._inertia()
        spin = vectors(wanted @ self.air[0, 0].T) / self.way.airtime
        landed = wanted
        for _ in range(ROUNDS):
            spin *= min(1.0, TURNS / max(float(np.linalg.norm(spin)), 1e-9))
            self._fly(inertia @ spin, landed, 1e-4)
            landed, miss = self.air[-1, 0].copy(), self._miss(wanted, self.air)
            if np.abs(miss).max() < CLOSE:
                break
            spin = spin + miss / self.way.airtime
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
        now, end = self.start.rotations[ids], vectors(self._touching(landed)[0][ids])
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
