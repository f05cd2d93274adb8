"""Wind-up and push of a leap: how a body stands, sinks and pushes itself off, each moment of it ready to be posed."""

from __future__ import annotations

import math

import numpy as np

from ..body import Physique, Start, hermite, monotone, standing, turns, vectors
from ..prior import BETWEEN, EACH, LEGS
from .airborne import GROUND_RATE, Airborne
from .clearing import ROWS as LIFT_ROWS
from .descent import sinking
from .flying_legs import STRAIGHTEST
from .footing import FADE, MOMENT, RUNNERS_HEEL, faded, heels_rise, heels_up, settling, swivels
from .going_slowly import FOLDS, GIVES, skipping, straight_through
from .ground_kernels import FREE, ground_kernel
from .path_estimate import Path
from .swinging import CLEARS, lifted, lowest

PUSH_RATE = 240.0
"""Poses a second during the push."""
GATHERS = 0.2
"""Half-life with which a runner's free leg comes to how recorded ones are, as a share of the time until take-off."""
SWINGS, FADES = (17.0, 20.0, 12.0), 2.0 * np.log(2.0) / np.e
"""But none of its joints turns faster than the first as recorded ones do, nor by more than what is then left of the second as it comes to them, but with the third
[rad/s] at least; which is at most so much of what it lacked over the half-life."""
ARMS = 14.0
"""Arms are swung no faster than this [rad/s] before take-off, as recorded ones in leaps off one foot."""
SPRINGING, WALKING = 8.0, 6.0
"""And no faster than this [rad/s] by who springs off from a landing, and by who walks and leaps to a place: he pushes for so short a time that hands were pulled by up to 173 m/s²."""
LAGS, AT_MOST = 0.06, 0.4
"""Arms of who leaps off one foot are as recorded ones at take-off so much later [s], or by this share of the flight: recorded swings slow down over a tenth of a second, and
here the push, which is as short as his speed wants it, would end theirs within a frame."""
CLEARED, SOON = 12, 0.12
"""At so many moments a swing leg is looked at, lest its foot be in the floor; so soon [s] it clears it whose foot is still about to leave it."""
HELD, RISES_ON = 13, 0.5
"""Where ankles can't keep heels down in the push is looked at so many times; from there they rise by so much of what others rise."""


class Pushing(Airborne):
    """A leap as far as the floor has to do with it: wind-up and push are ready to be posed, no flight is known."""

    def __init__(self, physique: Physique, start: Start, way: Path, planted: np.ndarray, landing: np.ndarray):
        assert way.push is not None  # a fall has none, and is no leap
        self.planted, self.off, self.push = planted, way.wind_up, way.push
        leave = self.off + self.push.duration
        self.sinks = max(self.off - way.dip, 0.0)  # nobody bows who has not begun to go down
        self.events = np.array([self.sinks, self.off, leave, leave + way.airtime])
        self.due = np.interp(np.arange(3 * BETWEEN + 1) / BETWEEN, np.arange(4), self.events)
        self.lifts = np.zeros((LIFT_ROWS, 2, EACH))
        super().__init__(physique, start, way, landing, leave, self.due, self._no_faster(start, way.keys[:3 * BETWEEN + 1, :LEGS].copy()), 1.0 - (1.0 - GIVES) * skipping(start, physique.size))
        self._prepare_ground()

    def _no_faster(self, start: Start, keys: np.ndarray) -> np.ndarray:
        """Keys (K, LEGS) of the carriage until touch-down, arms swung less far until take-off where they have less time than recorded ones."""
        off = 2 * BETWEEN
        if start.low is not None:  # straight through: no time is left to swing them back first
            share = self.due[:off + 1, None] / self.due[off]
            keys[:off + 1, 3:] = keys[0, 3:] + share**2 * (3.0 - 2.0 * share) * (keys[off, 3:] - keys[0, 3:])
        if start.runs:
            since = np.array([0.0, 0.0, min(LAGS, AT_MOST * (self.events[3] - self.events[2])), 0.0])
            late = np.interp(np.arange(len(keys)) / BETWEEN, np.arange(4), self.events + since)
            keys[:, 3:] = hermite(late, keys[:, 3:], monotone(late, keys[:, 3:]), self.due)
        swung = keys[:off + 1, 3:].reshape(off + 1, 2, 4)[..., :3]
        fastest = float((np.linalg.norm(np.diff(swung, axis=0), axis=-1) / np.maximum(np.diff(self.due[:off + 1]), 1e-9)[:, None]).max())
        most = SPRINGING if start.low is not None else WALKING if start.bound else ARMS if start.runs else math.inf
        share = min(most / max(fastest, 1e-9), 1.0)
        keys[:off, 3:] = keys[off, 3:] + share * (keys[:off, 3:] - keys[off, 3:])
        return keys

    def _prepare_ground(self) -> None:
        """Wind-up and push: times, centre of mass, forces, feet, and how everything is carried."""
        way, start = self.way, self.start
        before = np.linspace(0.0, self.off, max(int(np.ceil(self.off * GROUND_RATE)), 3) + 1)
        pushing = np.linspace(0.0, self.push.duration, max(int(np.ceil(PUSH_RATE * self.push.duration)), 8) + 1)[1:]
        c, v, a = sinking(way, start, before)
        gone, speed = self.push.moved(pushing, way.passing)
        self.times = np.concatenate([before, self.off + pushing])
        self.centres, self.velocities = np.concatenate([c, way.low + gone]), np.concatenate([v, speed])
        self.forces = np.concatenate([a - self.gravity, self.push.force(pushing)])
        self._along_the_floor()
        self.angles = self.carriage(np.maximum(self.times, self.sinks))
        self._differ(self.angles[0], (self.carriage(max(MOMENT, self.sinks)) - self.angles[0]) / MOMENT)
        self.offsets = self._left_over(self.times)
        root = vectors(start.rotations[0] @ self._upright(self.angles[:1, 0])[0].T)
        self.turns = turns(faded(root, start.rates[0], FADE, self.times)) @ self._upright(self.angles[:, 0], self.times)
        share = np.clip((self.times - self.off) / self.push.duration, 0.0, 1.0)
        rising = heels_rise(start, self.planted, self.centres, share, self.push.duration)
        late = np.clip((share - rising) / (1.0 - rising), 0.0, 1.0)
        self.nudge = (share**2 * (share - 1.0))[:, None] * self.push.duration
        self.feet = standing(len(self.times), start.slope)
        self.feet[..., 5] += (start.haste < 2) * np.clip(self.times / max(self.off, 1e-9), 0.0, 1.0)[:, None]
        self.feet[..., :5] = settling(start, self.planted, self.body, self.times, self.off, self.push.duration)
        self.feet[..., 8] = swivels(self.physique, start, self.times)
        risen = heels_up(start, self.planted, way.leave, self.push.duration, self.body) * late**2
        self.feet[..., 4] += risen[:, None]
        self.pitches = self.feet[..., 4].copy()
        self.roots = np.empty((len(self.times), 3))
        self.local = np.tile(np.eye(3), (len(self.times), self.count, 1, 1))
        if start.single is not None:
            swing = 1 - start.single
            self.feet[:, swing, 5] = FREE
            self.local[:, self.legs[4 * swing:4 * swing + 4]] = self._knee_drive(swing)
        else:
            self._hold_heels()

    def _along_the_floor(self) -> None:
        """Centre of mass and force as the path's course has them along the floor."""
        course = self.way.course
        assert course is not None  # a path with a push has one before it is planned
        places = hermite(course.times, course.place, course.velocity, self.times)
        pressed = np.stack([np.interp(self.times, course.times, part) for part in course.pressed.T], 1)
        high = self.centres[:, 1] - (self.planted[:, 1].mean() - self.body.sole)
        self.centres[:, [0, 2]] = places
        self.forces[:, [0, 2]] = (self.forces[:, 1] / high)[:, None] * (places - pressed)
        self.velocities[:, [0, 2]] = np.stack([np.interp(self.times, course.times, part) for part in course.velocity.T], 1)

    def _hold_heels(self) -> None:
        """Let heels that ankles can't keep down when the body is low stay up, and rise on from there, as a runner's do: one that came down in the push would straighten
        the knee the faster."""
        first = int(np.searchsorted(self.times, self.off))
        some = np.unique(np.linspace(first, len(self.times) - 1, HELD).round().astype(int))
        forced = self._pitches(some)
        for side, highest in enumerate(forced.argmax(0)):
            up, first, ends = forced[highest, side], some[highest], self.pitches[-1, side]
            if up > self.pitches[first, side]:
                late = (self.times[first:] - self.times[first]) / max(self.times[-1] - self.times[first], 1e-9)
                ends = max(ends, min(up + RISES_ON * ends, RUNNERS_HEEL[1]))
                self.pitches[first:, side] = np.maximum(self.pitches[first:, side], up + late**2 * (ends - up))

    def _pitches(self, some: np.ndarray) -> np.ndarray:
        """How far feet (M, 2) point down [rad] in samples (M,) of the push, as legs and ankles let the body stand over them."""
        roots, local, feet = np.empty((len(some), 3)), self.local[some], self.feet[some]
        ground_kernel(self.body, self.flex, self.angles[some], self.joints, self.offsets[some], self.turns[some], self.centres[some],
                      feet, self.centres[some[0]] + self.start.root - self.start.centre, roots, local)
        return feet[:, :, 4]

    def _knee_drive(self, side: int) -> np.ndarray:
        """The swing leg's local rotations (N, 4, 3, 3) while the other pushes: as recorded, from how it is."""
        ids = self.legs[4 * side:4 * side + 4]
        start, rows = vectors(self.start.rotations[ids]), np.zeros((2 * BETWEEN + 1, 4, 3))
        rows[:, :EACH, 0] = self.way.keys[:2 * BETWEEN + 1, LEGS + side * EACH:LEGS + (side + 1) * EACH]
        due = self.due[:2 * BETWEEN + 1]
        fastest = float(np.abs(np.diff(rows[:, :EACH, 0], axis=0) / np.diff(due)[:, None]).max())
        # whoever has less time swings it less far, each joint between how it would begin and how it would end so that it begins as it is; but the knee is
        # bent as far as recorded ones, so that the foot clears the floor
        share = 1.0 if self.start.haste > 1 else min(SWINGS[0] / max(fastest, 1e-6), 1.0)
        early, late = (rows[k] + (rows - rows[k]) * share for k in (0, -1))
        apart = np.where(np.abs(late[0] - early[0]) > 1e-9, late[0] - early[0], 1e-9)
        shifted = np.clip((start - early[0]) / apart, 0.0, 1.0)
        shifted[1] = 1.0
        rows = early + shifted * (late - early)
        if self.start.along:
            rows = straight_through(rows, start, due)
        slopes, lacks = monotone(due, rows), start - rows[0]
        lasts = GATHERS * self.leave
        if self.start.haste < 2:
            lasts = max(lasts, FADES * float(np.abs(lacks[:EACH, 0]).max()) / max(SWINGS[1] - fastest, SWINGS[2]))
        swung = hermite(due, rows, slopes, self.times) + faded(lacks, self.start.rates[ids] - slopes[0], lasts, self.times)
        swung[:, 1, 0] = np.maximum(swung[:, 1, 0], STRAIGHTEST)
        some = np.unique(np.linspace(0, len(swung) - 1, CLEARED).round().astype(int))
        more = self._lifted(side, swung, some)
        swung[:, :EACH, 0] += hermite(self.times[some], more, monotone(self.times[some], more), self.times) if more.any() else 0.0
        return turns(swung)

    def _lifted(self, side: int, swung: np.ndarray, some: np.ndarray) -> np.ndarray:
        """By how much more (M, EACH) [rad] a swing leg that turns by swung (N, 4, 3) bends in samples (M,), lest its foot be in the floor as the body goes down: no
        sooner than it can from where it is."""
        up = self.landing[:, 1].mean() > self.planted[:, 1].mean()
        ground = self.planted[1 - side], self.start.slope
        low, room = float(lowest(self.physique, side, self.start.root[None], self.start.rotations[None], *ground)[0]), CLEARS * self.physique.size
        clears = min(low, room) + max(room - low, 0.0) * np.minimum(self.times[some] / SOON, 1.0)
        return lifted(self.physique, side, *ground, swung[some], clears, self.angles[some], self.offsets[some], self.turns[some], self.centres[some], self.feet[some], self.start.root,
                      FOLDS if self.start.along else 0.0, self.start.ledge if up else None)

    def _stand(self, spin: np.ndarray, first: int) -> None:
        """Pose the body over its feet from sample `first` on, so that the pelvis leaves with an extra spin (3,)."""
        turned = turns(self.nudge[first:] * spin) @ self.turns[first:]
        root = np.array(self.start.root if first == 0 else self.roots[first], float)
        self.feet[first:, :, 4] = self.pitches[first:]
        ground_kernel(self.body, self.flex, self.angles[first:], self.joints, self.offsets[first:], turned,
                      self.centres[first:], self.feet[first:], root, self.roots[first:], self.local[first:])
