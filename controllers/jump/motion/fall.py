"""The fall: something is in the way in the air, or a foot was set down over an edge. A hit takes the velocity into it, and
the body gets its feet under itself, comes down on whatever floor there is, and stands. Who would come down in what stands there pushes off the edge as he leaves it, and
sinks less.

Beyond the thesis; after Faloutsos 2001, whose controllers end in a state that another can take over from.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ...body import forward_kinematics, sole_corners
from ...navigation import floor_at, gap, slope_at
from ..body import FLAT, TRAIL, Physique, Start, landing_feet, measures, rise, soles
from ..prior import Prior
from .capsules import capsule_places, near
from .falling import LATE, REACHES, Falling
from .hit import Hit, out_of
from .path_estimate import Path
from .rounds import softened
from .plan import Plan
from .rolling import rolled, rolls, room

LEAST, LOW = 0.14, 0.5
"""Legs need so long to come down [s]; a body lands no lower than this share of how high it touches down."""
ASIDE = ((0.25, 0.17), (1.15, 0.36))
"""What stands or hangs at a height over the feet [m] is so far from them [m] when they come down."""
BESIDE, ROUND, DEEP, HANGS = np.linspace(0.05, 0.3, 6), np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False), 10.0, 0.05
"""Where soles would be in a riser or hang over an edge they come down so far beside [m], in one of these directions: as near as can be, where a metre that a sole is in
something counts as so many, and a corner that hangs as so much [m]."""
TUCKS = np.array([0.5, 1.0, 1.5])
"""A leg that would go into something, as into the edge that it leaves, is drawn up by one of these shares of `falling.TUCKED`."""
QUICK = 5.0
"""But by no more for each second that it has until it is where it lands: knees that were drawn up in no time whipped feet off low ledges."""
GRAZES, SHIN = 0.01, 0.045
"""So deep [m] legs may be in something; how thick shins are [m], at standard height."""
IN, NEARER, CLEARS = 0.015, 0.005, 0.03
"""Who would be deeper in something than the first [m] falls otherwise, if that takes him out of it by the second: he pushes off to be clear by the third."""
PUSH = 0.2, 1.0
"""So hard he pushes off at least and at most [m/s]."""
SINKS = 0.6
"""Where that is not enough he pushes as hard as that and sinks by this share of the usual in his landing."""


def fall(physique: Physique, start: Start, hit: Hit | None, around: Sequence[Any], gravity: np.ndarray) -> Plan:
    """The motion from the moment of a hit, or of losing the floor, to standing, with a roll where it comes down hard, going ahead. start: the body at that moment."""
    best, made = _fallen(physique, start, hit, around, gravity, np.zeros(3), 1.0, None)
    least, push = _in_the_way(physique, best, around)
    hardest = PUSH[1] / max(float(np.linalg.norm(push)), 1e-9) * push
    if hit is not None:  # in the air there is nothing to push off
        ways = [(np.zeros(3), SINKS)]
    elif np.allclose(push, hardest):
        ways = [(hardest, SINKS)]
    else:
        ways = [(push, 1.0), (hardest, SINKS)]
    for push, gives in ways:
        if least < IN:
            break
        other, made = _fallen(physique, start, hit, around, gravity, push, gives, made)
        deep, _ = _in_the_way(physique, other, around)
        if deep < least - NEARER:
            best, least = other, deep
    return best


def _in_the_way(physique: Physique, made: Plan, around: Sequence[Any]) -> tuple[float, np.ndarray]:
    """How deep [m] a falling body comes into something, beyond how deep it was in it, and with which push (3,) [m/s] it would have been clear of that."""
    rows = slice(0, None, 2)
    centres, times = made.centres[rows], made.times[rows]
    things = near(physique, centres, around)
    worst, push = 0.0, np.zeros(3)
    if not things:
        return worst, push
    _, _, points, thick = capsule_places(physique, *forward_kinematics(physique.skeleton, made.roots[rows], made.local[rows]))
    for thing in things:
        deep = thick - gap(points.reshape(-1, 3), thing).reshape(points.shape[:2])
        deep -= np.maximum(deep[0], 0.0)
        if deep.max() > worst:
            worst = float(deep.max())
            k, place = np.unravel_index(int(deep.argmax()), deep.shape)
            way = out_of(np.array([centres[k, 0], points[k, place, 1], centres[k, 2]]), thing) * FLAT
            size, goes = float(np.linalg.norm(way)), min(float(times[k]), made.touch_down)
            if size > 0.0:
                push = np.clip((worst + CLEARS) / max(goes - LATE, 0.05), *PUSH) / size * way
    return worst, push


def _fallen(physique: Physique, start: Start, hit: Hit | None, around: Sequence[Any], gravity: np.ndarray, push: np.ndarray, gives: float,
            like: Falling | None) -> tuple[Plan, Falling]:
    """One such motion, of somebody who pushes off as much (3,) [m/s] and sinks by such a share of the usual; and of what it was made. like: as of `Falling`."""
    velocity = (start.velocity if hit is None else hit.after(start.velocity)) + push
    leaves = start.centre - LATE * push
    time, land, place = _down(physique, leaves, velocity, start.heading, around, gravity)
    prior, falls = Prior.load(), max(-float(velocity[1] + gravity[1] * time), 0.0)
    features = prior.features(falls, 0.0, 0.0, physique.size, False)
    way = Path(start.centre, leaves, land, velocity, velocity, time, 0.0, gravity, None, start.centre, start.centre, heading=start.heading,
               keys=prior.keys(features, features))
    start = replace(start, lands_on=slope_at(place[0], place[2], around, place[1] + GRAZES))
    landing, tucks = landing_feet(place, start.heading, physique.tables, start.lands_on), np.zeros(2)
    falling = Falling(physique, start, way, landing, tucks, push, gives, like)
    best = falling.plan()
    deep = least = _deep(physique, best, around)
    quickest = np.minimum(TUCKS if like is None else TUCKS[1:2], QUICK * min(way.airtime, REACHES))
    for tuck in np.unique(quickest):  # no longer than a frame or two may take
        if deep.max() < GRAZES:
            break
        tucks = np.where(deep < GRAZES, tucks, tuck)
        falling = Falling(physique, start, way, landing, tucks, push, gives, falling)
        made = falling.plan()
        deep = _deep(physique, made, around)
        if deep.max() < least.max():
            best, least = made, deep
    if rolls(physique, way):
        rolling = rolled(physique, best)
        if room(physique, rolling, around):
            return rolling, falling
    return best, falling


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
                    place = place + (aside * size - near) * out_of(foot[0], thing) * FLAT
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
