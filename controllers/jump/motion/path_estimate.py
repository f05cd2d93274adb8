"""The path estimate (Ooi 2015, 3.1.1): where the centre of mass goes, from the lowest point of the
wind-up over take-off to landing, and what stops a body from going there.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...body import yaw
from ..body import FLAT, TRAIL, TURNED, Physique, Start, carriage, hermite, measures, monotone, soles, take_off_velocity, uphill
from ..muscles import strength
from ..prior import BETWEEN, COLUMNS, EACH, FEATURES, LEGS, ROWS, Prior, mirrored
from .bound import flies_between
from .going_slowly import airtime as skips, beside, calm, skipping
from .hopping import hopping
from .rounds import Carriage, Found, Leap, Legs, rounds_kernel
from .take_off import TakesOff
from .thrust import Push, push

SQUAT, DEEPEST_SQUAT = 0.6, 0.30
"""How much lower [m] a body lands for each metre that it jumps up, and at most, at standard height."""
BACKWARD, BELOW = 0.4, 0.4
"""Feet that come down behind the body, lower by the second [m], at standard height, or more, reach less far by this share: there ankles can't bend so that knees give
softly. Not of who needs all of his reach, and leaves in haste."""
LEAST_AIRTIME, RUNS_UP = 0.30, 0.42
"""Shorter flights look like stumbling [s], and off one foot of who walks or runs like a long step: recorded ones take 0.44 to 0.60; on Earth, at standard height."""
TURN_SETTLES = 0.25
"""So long after it touched down [s] a body has made all of its turn."""
KEEPS = 0.95, 1.4
"""Who runs fast enough to run on, and is in no haste, leaves with about the first of his speed: what he leaves faster or slower along the floor is so many times as
dear as what he leaves faster upward."""
SPINS = 6.0, 8.0
"""How fast a body turns in the air at most that chooses its airtime, and that was told one [rad/s]."""
HIGHER = 0.14, 0.9
"""Who waits in the crouch flies longer by the first [s] to what is as far as the second [m], on Earth, at standard height: the less he must fall
ahead, the sooner he is off."""
STRIDES, FALLS, ASTRAY = (0.5, 1.8, 2.3), 3.7, 0.45
"""Who pushes off one foot lands on the other, to walk or run on, if he comes down faster ahead than the first, or the second if he wants to stay there, or the third if he has no room to run on, and falls slower than
that [m/s], from 0.7 m: a leg then bears 4.8 times the weight. But not if he goes aside by more than that share of it: no gait does, as fast."""
FOLDS = np.array([[-0.1, 0.17], [-0.2, 0.34], [-0.3, 0.5]])
"""By so much more than recorded hip and knee of a free leg are bent [rad] as the other lands, and in the rows before."""
TUCK, TUCKS, TUCK_TIME = (-1.5, 1.9), np.array([0.35, 0.9, 1.0, 0.7]), 0.45
"""How far hips and knees are bent [rad] of legs that are drawn up over something, by which share of the way at each row of the flight, and
how long a flight needs for all of it [s]."""
LEAST_PUSH = 0.01
"""A push that rises less [m], at standard height, is none."""


class Course(NamedTuple):
    """A way along the floor until the body leaves it: times (K,) [s]; place [m], velocity [m/s] and centre of pressure [m] (K, 2), x and z; how
    far [m] that lies outside the soles at most; how far the force leans from upright at most, which is the friction it needs."""

    times: np.ndarray
    place: np.ndarray
    velocity: np.ndarray
    pressed: np.ndarray
    outside: float
    lean: float


@dataclass(frozen=True, eq=False)
class Path:
    """The way of the centre of mass: lowest point, take-off, landing (3,) [m], its velocities (3,) [m/s] at the lowest point
    and at take-off, the flight's and the wind-up's time [s], the push between, None for a fall and where nothing pushes so.

    stance: (3,) [m] the middle of the soles that push; pressed: (3,) from where they begin to. dip: how long before the lowest point it starts to go down [s]. strong:
    whether the muscles can. far, up: how far and how much higher the feet land [m]. heading [rad]. running: it pushes off one
    foot out of a run; single: off one at all. keys: how the body is carried, as in `prior`. low_arms: the arms stay down. lands: on which foot it lands to run
    on, 0 left, 1 right; None on both. hops: it lands to hop on from there. turn: [rad] to the left from `heading` until it lands.
    course: how it goes along the floor, None where that was only estimated (see `grounded`).
    """

    low: np.ndarray
    leave: np.ndarray
    land: np.ndarray
    passing: np.ndarray
    velocity: np.ndarray
    airtime: float
    wind_up: float
    gravity: np.ndarray
    push: Push | None
    stance: np.ndarray
    pressed: np.ndarray
    dip: float = np.inf
    strong: bool = True
    far: float = 0.0
    up: float = 0.0
    heading: float = 0.0
    running: bool = False
    single: bool = False
    low_arms: bool = False
    lands: int | None = None
    hops: bool = False
    keys: np.ndarray = field(default_factory=lambda: np.zeros((0, 0)))
    turn: float = 0.0
    course: Course | None = None

    def turned(self, time: ArrayLike) -> np.ndarray:
        """How far (...) [rad] to the left it has turned at times (...) [s] after it began."""
        if not self.turn or self.push is None:
            return np.zeros(np.shape(time))
        leave = self.wind_up + self.push.duration
        down = leave + self.airtime
        times = np.array([0.0, self.wind_up, leave, down, down + TURN_SETTLES])
        made = self.turn * np.array([0.0, 0.0, *TURNED, 1.0])
        return hermite(times, made, monotone(times, made), np.clip(time, 0.0, times[-1]))

    @property
    def falling(self) -> np.ndarray:
        """The velocity (3,) [m/s] at landing."""
        return self.velocity + self.gravity * self.airtime


def path(physique: Physique, start: Start, feet: np.ndarray, landing: np.ndarray, floor: float,
         gravity: np.ndarray, airtime: float | None = None, low_arms: bool = False, prior: Prior | None = None, tucked: bool = False) -> Path:
    """The path from the planted `feet` (F, 5) on a `floor` [m] to the `landing` feet (2, 5).

    airtime: [s], or None for the least effort. low_arms: with the arms down. tucked: with the legs drawn up. prior: how people carry
    themselves, the shipped one by default. The crouch is as deep as the muscles need it (`windup`).
    """
    body, upright = physique.tables, measures(physique)
    size, g, prior = body.size, -float(gravity[1]), prior or Prior.load()
    ground = soles(feet, body, start.slope)
    middle, goal = ground.mean(0), soles(landing, body, start.lands_on).mean(0)
    flat = (goal - middle) * FLAT
    far = float(np.linalg.norm(flat))
    towards = flat / far if far > 1e-6 else np.zeros(3)
    lays = towards if not start.along else beside(start, towards)
    facing = yaw(start.heading)[:, 2]
    ahead, pace = float(flat @ facing), float(start.velocity @ facing)
    balls = feet[:, :3].mean(0)
    reach = 0.5 * float(body.tip[2] - body.heel[2] + body.toe[2]) - 0.015 * size
    # who jumps up lands with folded legs, and need not bring the body as high
    squat = min(SQUAT * max(float(goal[1]) - floor, 0.0), DEEPEST_SQUAT * size)
    # where it leaves, how far behind its feet and how much lower it lands
    guess = np.array([middle[0], floor + upright.leave(0.0), middle[2], 0.0, 0.0])
    turn = start.turn or 0.0
    along = float(towards @ yaw(start.lands)[:, 2])  # seen from how it lands
    across = float(np.sqrt(max(1.0 - along**2, 0.0)))
    runner = start.single if start.runs else None
    least = (TURNED[1] - TURNED[0]) * abs(turn) / SPINS[0]  # in the air, to get round
    keeps, dear = KEEPS if start.runs and not start.haste and np.linalg.norm(start.velocity * FLAT) > STRIDES[0] * np.sqrt(size) else (float(start.single is not None), 1.0)
    stretched = np.array([dear, 1.0, dear])
    behind = 0.0 if start.haste else BACKWARD * max(-along, 0.0) * min(max((floor - float(goal[1])) / (BELOW * size), 0.0), 1.0)
    fitted, joints = prior.two if not start.runs else prior.one, carriage.joints_of(physique.skeleton)
    rows = np.array([2 * BETWEEN, 3 * BETWEEN])
    shift = calm(np.zeros((2, COLUMNS)), start, rows, size)  # which is linear
    slow = skips(start.velocity, size) if start.along else RUNS_UP if start.runs else LEAST_AIRTIME
    legs = Legs(upright.stand, upright.leads, upright.leaves, upright.trails, upright.touches, upright.carried)
    one = int(start.runs)
    left, down, swung = (np.ascontiguousarray(part if runner != 0 else mirrored(part)) for part in (fitted[:, rows[0]], fitted[:, rows[1]], prior.unswung(rows[1], start.runs)))
    carry = Carriage(left, down, swung, calm(np.ones((2, COLUMNS)), start, rows, size) - shift, shift, prior.depth, prior.least[one], prior.most[one], ahead, pace, low_arms)
    leap = Leap(goal, towards, lays, along, float(abs(lays @ yaw(start.lands)[:, 0])) if start.along else across, np.nan if airtime is None else float(airtime),
                max((slow + start.ready * HIGHER[0] * min(far / (HIGHER[1] * size), 1.0)) * float(np.sqrt(9.81 / g * size)), least), flies_between(start.velocity, size, g), keeps * stretched * start.velocity * FLAT,
                stretched, squat, upright.stand + floor - float(start.centre[1] if start.low is None else start.low) if start.ready else np.nan, behind,
                TRAIL[2 if start.single is None and start.onto is None else 1] * size, start.runs, start.onto in (0, 1))
    pushing = feet if len(feet) == 2 else feet[[0, 0]]
    off = TakesOff(size, gravity, float(floor), upright.stand, upright.leads, middle, balls, pushing, reach, float(uphill(pushing, start.slope).mean()), start.centre, start.velocity, start.heading, start.leaves,
                   np.nan if start.low is None else float(start.low), start.straight, start.heel_up, start.haste, start.ready, start.springs, start.single is not None, start.along, start.bound, skipping(start, size))
    found = Found(np.empty((5, 3)), np.empty((2, FEATURES)))
    flight, wind_up, dip, strong, swings = rounds_kernel(body, joints, strength(physique, gravity=g), legs, carry, leap, off, guess, found)
    low, leave, passing, pressed, land = found.ends
    features = found.features
    velocity = take_off_velocity(leave, land, flight, gravity)  # from where it leaves in the end
    keys = _tuck(_low(calm(prior.keys(features[0], features[1], runner, swings), start, np.arange(ROWS), size), low_arms), flight, tucked)
    if start.onto is None and not start.springs:
        lands = _stride(start, velocity, flight, gravity, size)
        keys = _folded(keys, lands)
    else:
        lands = start.onto if start.onto in (0, 1) else None
        keys = hopping(keys, start.single, lands)
    if start.ready:  # it has gone down already
        keys[:BETWEEN] = keys[BETWEEN]
    rises = leave[1] - low[1] > LEAST_PUSH * size
    return Path(low, leave, land, passing, velocity, flight, wind_up, gravity,
                push(leave - low, passing, velocity, gravity, start.springs) if rises else None, middle, pressed, dip, strong, far, float(goal[1]) - floor,
                start.heading, start.runs, start.single is not None, low_arms, lands, start.onto is not None, keys, turn)


def _stride(start: Start, velocity: np.ndarray, flight: float, gravity: np.ndarray, size: float) -> int | None:
    """On which foot a runner lands: the other one, if it is to run on and does not fall too fast for one leg."""
    aside, _, ahead = velocity @ yaw(start.lands)
    if start.along and not start.bound and not start.stays and start.single is not None:
        return 1 - start.single
    if start.single is None or ahead < STRIDES[2 if start.cramped else int(start.stays)] * np.sqrt(size) or abs(aside) > ASTRAY * ahead:
        return None
    falls = start.lands_on @ velocity[[0, 2]] - (velocity + gravity * flight)[1]  # nearer to ground that may fall away, too
    return 1 - start.single if falls < FALLS * np.sqrt(size) else None


def _folded(keys: np.ndarray, lands: int | None) -> np.ndarray:
    """The same keys (ROWS, COLUMNS), the leg on which it does not land, if any, drawn up more, lest its toes touch the floor."""
    if lands is not None:
        keys = keys.copy()
        free = slice(LEGS + EACH * (1 - lands), LEGS + EACH * (1 - lands) + 2)
        keys[3 * BETWEEN - len(FOLDS) + 1:3 * BETWEEN + 1, free] += FOLDS
        keys[3 * BETWEEN + 1:, free] += FOLDS[-1]
    return keys


def _low(keys: np.ndarray, low_arms: bool) -> np.ndarray:
    """The same keys (..., COLUMNS), or with arms that stay down."""
    if low_arms:
        keys = keys.copy()
        keys[..., 3:LEGS] = carriage.LOW_ARMS
    return keys


def _tuck(keys: np.ndarray, flight: float, tucked: bool) -> np.ndarray:
    """The same keys (ROWS, COLUMNS), or with legs that are drawn up in the air as far as there is time [s]."""
    if tucked:
        keys = keys.copy()
        share = TUCKS * min(flight / TUCK_TIME, 1.0)
        rows = slice(2 * BETWEEN + 1, 3 * BETWEEN)
        for hip in (LEGS, LEGS + EACH):
            keys[rows, hip] += share * np.minimum(TUCK[0] - keys[rows, hip], 0.0)
            keys[rows, hip + 1] += share * np.maximum(TUCK[1] - keys[rows, hip + 1], 0.0)
    return keys
