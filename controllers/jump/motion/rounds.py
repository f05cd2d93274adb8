"""Rounds of the path estimate: where a body leaves and how fast, how it is carried then and how it touches down follow from each other, and are found in turn."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...compiled import kernel
from ..body import TOUCH_REACH, TRAIL, airtime_kernel, carriage, carried_kernel
from ..muscles import between_kernel
from ..prior import ARMS, FEATURES, LEGS, features_kernel, swings_kernel
from .bound import flies_kernel
from .off_one_foot import running_kernel
from .take_off import standing_kernel

SOFT = 0.85, 15.5, 0.07
"""Whoever comes down faster along his legs touches down with knees bent more, so that they need not fly: legs are shortened by the first, as a share of that speed, and
knees turn no faster for that than the second [rad/s]; but no lower than by the third [m], at standard height."""
TILTED, HARD = 0.7, (4.4, 5.4)
"""A runner, who passes over his feet as legs give, lands lower by so much of that, and so does who falls faster [m/s], by and by, and needs his legs to stop."""
FOLDED = 0.64
"""How low a body touches down at most, as a share of how high it stands."""
ON_ONE = 0.06
"""So much higher a body comes down that hops onto one foot [m], at standard height: on a straighter leg, the other held up."""
HIGHEST = 0.04
"""A flight of least effort rises by so much at least [m], at standard height, and higher than where it ends by as much."""
ROUNDS, SETTLED, LEAST_STEP = 12, 1e-3, 0.2
"""Where a body leaves and how fast follow from each other: they are found in so many rounds at most, to so much [m], by such
a share at least of what the last round found."""
FIRST_ARM = ARMS.start
"""The first column of the arms."""
_LOW_ARMS = carriage.LOW_ARMS


class Legs(NamedTuple):
    """How high a centre of mass is over its feet, as in `Measures`: stand [m]; leads, leaves: (L,); trails, touches: (T,); carried: (2,) for which those are."""

    stand: float
    leads: np.ndarray
    leaves: np.ndarray
    trails: np.ndarray
    touches: np.ndarray
    carried: np.ndarray


class Carriage(NamedTuple):
    """How trunk, arms and legs are carried as a body leaves and as it touches down. leaves, lands, swings: (FEATURES, COLUMNS) [rad] for each feature, as fitted, as it leaves and touches down, and what is added
    to the last where arms do not swing; scale, shift: (2, COLUMNS) what those are multiplied by, and what is added, of who goes slowly. depth: (FEATURES,) as in `Prior`. least, most: (FEATURES,) of what was
    recorded; ahead: [m], pace: [m/s] features of the leap. low_arms: the arms stay down."""

    leaves: np.ndarray
    lands: np.ndarray
    swings: np.ndarray
    scale: np.ndarray
    shift: np.ndarray
    depth: np.ndarray
    least: np.ndarray
    most: np.ndarray
    ahead: float
    pace: float
    low_arms: bool


class Leap(NamedTuple):
    """Where a leap leads. goal: (3,) [m] the middle of the soles as they land; towards: (3,) which way, lays: (3,) which way the feet land ahead of the mass. along, across: how much of that is ahead, as it
    lands, and aside. airtime: [s], not a number for that of least effort; least: [s] that of those at least; flies: [s] the least and the most of who walks to a place. kept: (3,) [m/s] what of its speed least
    effort keeps; stretched: (3,) by what ways are multiplied for that. squat: [m] how much lower it lands that jumps up; crouch: [m] how deep it is that waits, not a number where
    nobody does. behind, trails: by how much its feet reach less, and how far at most [m]. runs, onto_one: whether it runs, and hops onto one foot."""

    goal: np.ndarray
    towards: np.ndarray
    lays: np.ndarray
    along: float
    across: float
    airtime: float
    least: float
    flies: tuple[float, float]
    kept: np.ndarray
    stretched: np.ndarray
    squat: float
    crouch: float
    behind: float
    trails: float
    runs: bool
    onto_one: bool


class Found(NamedTuple):
    """What the rounds find, written: ends (5, 3): where it is lowest and where it leaves [m], its velocity when it is lowest [m/s], where it begins to press, and where it lands [m]; features (2, FEATURES) as it
    leaves and as it lands."""

    ends: np.ndarray
    features: np.ndarray


def softened(fall: float, body) -> float:
    """How much lower [m] a body touches down that comes down along its legs with `fall` [m/s], see SOFT. body: its tables."""
    return softened_kernel(fall, 0.5 * (body.thigh + body.shank), body.size)


@kernel
def softened_kernel(fall, bone, size):
    """See `softened`. A leg of two bones of length a whose knee is bent by θ gets shorter by a sin θ/2 for each radian."""
    sine = min(max(SOFT[0] * fall / (SOFT[1] * bone), 0.0), 1.0)
    return min(max(2.0 * bone * (TOUCH_REACH - math.sqrt(1.0 - sine**2)), 0.0), SOFT[2] * size)


@kernel
def _angles(carried, which, features, swings, angles):
    """Write how a body is carried (11,) [rad] as it leaves, 0, or touches down, 1, with these features (FEATURES,), its arms swinging so much."""
    rows = carried.leaves if which == 0 else carried.lands
    for column in range(LEGS):
        value = 0.0
        for n in range(FEATURES):
            value += features[n] * rows[n, column]
            if which == 1 and swings < 1.0 and column >= FIRST_ARM:
                value += (1.0 - swings) * features[n] * carried.swings[n, column]
        angles[column] = carried.scale[which, column] * value + carried.shift[which, column]
        if carried.low_arms and column >= FIRST_ARM:
            angles[column] = _LOW_ARMS[column - FIRST_ARM]


@kernel
def rounds_kernel(body, joints, able, legs, carried, leap, off, guess, found):
    """Find the take-off and the landing of a leap. body, able: its tables and `Strength`; off: what it takes off from, `TakesOff`. guess: (5,) where it leaves [m], how far behind its feet and how much lower it
    lands [m], at first; found: `Found`, written. Returns the flight's time, that until the lowest point and how much of that it goes down [s], whether the muscles are strong enough, and how far arms swing.
    """
    size, g, bone = off.size, -off.gravity[1], 0.5 * (body.thigh + body.shank)
    leaves, touches = 0.0, 0.0  # how much higher than usual the mass is carried
    straight = between_kernel(legs.trails, legs.touches, 0.0)
    fall, relaxed, before, lacks = 0.0, 0.5, np.empty(5), np.empty(5)  # half the way: the whole one may swing about
    crouch, passing, velocity, ends = 0.0, off.velocity.copy(), np.empty(3), found.ends
    leave, land, angles = np.empty(3), ends[4], np.empty((2, LEGS))
    passing[1] = 0.0
    flight, wind_up, dip, strong, swings = 0.0, 0.0, math.inf, True, 1.0
    for number in range(ROUNDS):
        trail, soft = guess[3], guess[4]
        leave[:] = guess[:3]
        tilted = TILTED if leap.runs else 1.0 + (TILTED - 1.0) * min(max((fall - HARD[0]) / (HARD[1] - HARD[0]), 0.0), 1.0)
        reached, aside = between_kernel(legs.trails, legs.touches, trail * leap.along) + touches, trail * leap.across
        reached = math.sqrt(max(reached**2 - aside**2, 0.25 * reached**2))
        height = max(min(reached - tilted * soft, straight + touches - max(leap.squat, soft)), FOLDED * legs.stand) + (ON_ONE * size if leap.onto_one else 0.0)
        for i in range(3):
            land[i] = leap.goal[i] - trail * leap.lays[i]
        land[1] = leap.goal[1] + height
        rises = land[1] - leave[1]
        if leap.airtime == leap.airtime:
            flight = leap.airtime
        elif off.bound:
            flight = flies_kernel(math.hypot(land[0] - leave[0], land[2] - leave[2]), rises, math.hypot(off.velocity[0], off.velocity[2]), leap.flies[0], leap.flies[1], size, g)
        else:
            far, keeps = 0.0, 0.0
            for i in range(3):
                way = leap.stretched[i] * (land[i] - leave[i])
                far, keeps = far + way * way, keeps + way * leap.kept[i]
            top = max(rises, 0.0) + HIGHEST * size
            flight = max(max(airtime_kernel(g * g, keeps, far), leap.least), math.sqrt(2.0 * top / g) + math.sqrt(2.0 * max(top - rises, 0.0) / g))
        for i in range(3):
            velocity[i] = (land[i] - leave[i]) / flight - 0.5 * off.gravity[i] * flight
        fall = g * flight - velocity[1]
        if leap.runs:
            swings = swings_kernel(carried.pace, size, carried.least)
        for which in range(2):
            features_kernel(velocity[1] if which == 0 else fall, carried.ahead, carried.pace, size, carried.least, carried.most, found.features[which])
            _angles(carried, which, found.features[which], swings, angles[which])
        leaves = carried_kernel(body, angles[0], joints) - legs.carried[0]
        touches = carried_kernel(body, angles[1], joints) - legs.carried[1]
        if leap.runs:
            wind_up = running_kernel(off, between_kernel(legs.leads, legs.leaves, 0.0) + leaves, leave, land, velocity, ends)
            given = fall
        else:
            # who waits needs no more than the muscles do, and pushes from as deep as it is
            crouch = leap.crouch
            if not crouch == crouch:
                crouch = 0.0
                for n in range(FEATURES):
                    crouch += size * found.features[0, n] * carried.depth[n]
            wind_up, dip, strong = standing_kernel(body, joints, able, off, angles[0], crouch, passing, leave, land, velocity, flight, ends)
            down, long = -height * (velocity[1] - g * flight), height * height
            for i in (0, 2):
                ahead = trail * leap.towards[i]
                down, long = down + ahead * velocity[i], long + ahead * ahead
            given = down / math.sqrt(long)
        for i in range(3):
            passing[i] = ends[2, i]
        fast = velocity[0] * leap.towards[0] + velocity[2] * leap.towards[2]
        settled, turned, changed = True, 0.0, 0.0
        for n in range(5):
            before[n] = lacks[n]
            lacks[n] = (ends[1, n] if n < 3 else (1.0 - leap.behind) * min(leap.trails, max(TRAIL[0] * fast, 0.0)) if n == 3 else softened_kernel(given, bone, size)) - guess[n]
            settled = settled and abs(lacks[n]) < SETTLED
            change = lacks[n] - before[n]
            turned, changed = turned + before[n] * change, changed + change * change
        if settled:
            break
        if number > 0:  # Aitken's relaxation
            relaxed = min(max(-relaxed * turned / max(changed, 1e-12), LEAST_STEP), 1.0)
        for n in range(5):
            guess[n] += relaxed * lacks[n]
    return flight, wind_up, dip, strong, swings
