"""Planning a jump: path, wind-up, push, flight and landing, one after the other, and a pose for each moment.

Where the centre of mass goes is decided first; trunk, arms and head are carried by `style`, legs
follow from where the feet are, and in the air the turning of the whole body follows from its momentum.
"""

from __future__ import annotations

import numpy as np

from ..body.rotations import yaw
from ..body.springs import settle
from ..body.turning import exp_kernel
from ..compiled import kernel
from . import style
from .dynamics import Physique, momentum_kernel, place_kernel, turns, vectors
from .flight import flight_kernel
from .landing import TIME, absorb
from .path import FLEX, FOOT_FADE, HEEL_UP, TOES_DOWN, Path, Start, landing_feet, measures, soles
from .plan import Plan
from .posture import stand_kernel

GROUND_RATE, PUSH_RATE, AIR_RATE = 72.0, 240.0, 90.0
"""Poses a second over planted feet, during the push, in the air."""
PLANT = 0.09
"""From the toes' landing to the heels' [s]."""
FADE = 0.14
"""Half-life with which the start's pose gives way to the jump's [s]."""
STEADY = 0.12
"""Half-life with which the pelvis loses the turn it landed with [s]."""
HEELS_RISE = (0.45, 0.85)
"""When in the push a heel starts to rise, at the earliest and at the latest."""
FREE = -1.0
"""A foot's freedom (see `posture.leg_kernel`) if its leg is posed by joints: the swing leg of a run."""
SAME = 5e-4
"""The legs reach for a body turned to within this of how it lands [rad]."""
ROUNDS, CLOSE = 5, 0.02
"""At most so many flights are tried until the body lands this upright [rad]."""


def plan(physique: Physique, start: Start, way: Path, place: np.ndarray, floor: float) -> Plan:
    """The whole jump from `start`, off a floor at height `floor` [m], along a path to a `place` (3,) [m].

    Checks nothing: see `reach`.
    """
    landing = landing_feet(np.asarray(place, float), start.heading, physique.tables)
    return _Draft(physique, start, way, start.planted(floor, physique.tables), landing).plan()


class _Draft:
    """One plan in the making: what its parts share."""

    def __init__(self, physique: Physique, start: Start, way: Path, planted: np.ndarray, landing: np.ndarray):
        self.physique, self.body, self.start, self.way = physique, physique.tables, start, way
        self.planted, self.landing, self.gravity = planted, landing, way.gravity
        self.joints = style.joints_of(physique.skeleton)
        self.count = len(physique.skeleton)
        self.flex = FLEX * physique.flexibility
        self.legs = (self.body.hip[:, None] + np.arange(4)).ravel()
        self.off = way.wind_up
        self.leave = self.off + way.push.duration
        self.down = self.leave + way.airtime
        self.keys = np.array([0.0, self.off, self.leave, self.leave + 0.45 * way.airtime, self.down,
                              self.down + 0.28, self.down + TIME])
        self.carriage = style.keyed(self.keys, style.shapes(
            np.linalg.norm(way.velocity - way.passing), np.linalg.norm(way.falling), start.single is not None))

    def plan(self) -> Plan:
        """Everything, in order."""
        self._prepare_ground()
        self._prepare_air()
        spin = self._fly()
        self._stand(spin, 0)
        after, landed, through = self._land()
        way, mass, g = self.way, self.physique.mass, self.gravity
        contacts = np.zeros((len(self.times) + len(self.flying) - 1 + len(after), 4), bool)
        heel_up = self.feet[:, :, 4] > 0.03
        on = self.feet[:, :, 5] >= 0.0
        contacts[:len(self.times), 1::2], contacts[:len(self.times), ::2] = on, on & ~heel_up
        contacts[-len(after):, 1::2], contacts[-len(after):, ::2] = True, (after > PLANT)[:, None]
        flying = self.flying[1:]
        return Plan(
            np.concatenate([self.times, self.leave + flying, self.down + after]),
            np.concatenate([self.roots, self.air_roots[1:], landed[0]]),
            np.concatenate([self.local, self.air[1:], landed[1]]),
            np.concatenate([self.centres, self.arc[1:], landed[2]]),
            np.concatenate([self.velocities, way.velocity + g * flying[:, None], landed[3]]),
            mass * np.concatenate([self.forces, np.zeros((len(flying), 3)), landed[4] - g]),
            contacts, self.off, self.leave, self.down, self.down + 0.28, self.down + through, self.landing, self.momentum.copy(), way)

    def _prepare_ground(self) -> None:
        """Wind-up and push: times, centre of mass, forces, feet, and how everything is carried."""
        way, start = self.way, self.start
        before = np.linspace(0.0, self.off, max(int(np.ceil(self.off * GROUND_RATE)), 3) + 1)
        pushing = np.linspace(0.0, way.push.duration, max(int(np.ceil(PUSH_RATE * way.push.duration)), 8) + 1)[1:]
        c, v, a = quintic(start.centre, start.velocity, np.zeros(3), way.low, way.passing,
                          way.push.force(np.array(0.0)) + self.gravity, before)
        gone, speed = way.push.moved(pushing, way.passing)
        self.times = np.concatenate([before, self.off + pushing])
        self.centres, self.velocities = np.concatenate([c, way.low + gone]), np.concatenate([v, speed])
        self.forces = np.concatenate([a - self.gravity, way.push.force(pushing)])
        self.angles = self.carriage(self.times)
        self._leftovers()
        share = np.clip((self.times - self.off) / way.push.duration, 0.0, 1.0)
        rising = self._heels_rise(share)
        late = np.clip((share - rising) / (1.0 - rising), 0.0, 1.0)
        self.nudge = (share**3 - share**2)[:, None] * way.push.duration
        self.feet = np.ones((len(self.times), 2, 6))
        self.feet[..., :5] = self.planted + faded(start.feet - self.planted, start.feet_rates, FOOT_FADE, self.times)
        self.feet[..., 1] = np.maximum(self.feet[..., 1], self.planted[:, 1])
        self.feet[..., 4] += (HEEL_UP * late**2 * (3.0 - 2.0 * late))[:, None]
        self.pitches = self.feet[..., 4].copy()
        self.roots = np.empty((len(self.times), 3))
        self.local = np.tile(np.eye(3), (len(self.times), self.count, 1, 1))
        if start.single is not None:
            swing = 1 - start.single
            self.feet[:, swing, 5] = FREE
            self.local[:, self.legs[4 * swing:4 * swing + 4]] = self._knee_drive(swing)

    def _heels_rise(self, share: np.ndarray) -> float:
        """When in the push (0 … 1) the heels rise: not before a standing jumper is over the balls of the feet."""
        if self.start.single is not None:
            return HEELS_RISE[0]
        past = (self.centres - self.planted[:, None, :3]) @ yaw(self.start.heading)[:, 2]
        over = (past > 0.0).all(0) & (share > 0.0)
        return float(np.clip(share[int(np.argmax(over))], *HEELS_RISE)) if over.any() else HEELS_RISE[0]

    def _leftovers(self) -> None:
        """What the start's pose differs by from the carried one, fading: of the joints, of the pelvis' turn."""
        start, local = self.start, np.tile(np.eye(3), (self.count, 1, 1))
        style.carry_kernel(self.angles[0], self.joints, local)
        turn = self._upright(self.angles[:1, 0])[0]
        offset, root = vectors(start.rotations @ np.swapaxes(local, -1, -2)), vectors(start.rotations[0] @ turn.T)
        self.offset, self.offset_rate = offset, start.rates
        self.offsets = self._left_over(self.times)
        self.turns = turns(faded(root, start.rates[0], FADE, self.times)) @ self._upright(self.angles[:, 0])

    def _left_over(self, times: np.ndarray) -> np.ndarray:
        """What is left (N, J, 3) [rad] of the start's pose at times (N,) [s], pelvis and legs apart."""
        left = faded(self.offset, self.offset_rate, FADE, times)
        left[:, 0] = left[:, self.legs] = 0.0
        left[np.abs(left).max(-1) < 1e-6] = 0.0
        return left

    def _upright(self, lean: np.ndarray) -> np.ndarray:
        """The pelvis' turns (N, 3, 3), facing where the jumper faces and leaning (N,) [rad]."""
        return yaw(self.start.heading) @ turns(np.asarray(lean)[:, None] * [1.0, 0.0, 0.0])

    def _knee_drive(self, side: int) -> np.ndarray:
        """The swing leg's local rotations (N, 4, 3, 3) while the other pushes: forward and up."""
        ids = self.legs[4 * side:4 * side + 4]
        start = vectors(self.start.rotations[ids])
        high = np.zeros((4, 3))
        high[0, 0], high[1, 0], high[2, 0] = -1.05, 1.25, -0.1
        passing = 0.5 * (start + high)
        passing[1, 0] = max(start[1, 0], high[1, 0]) + 0.35  # the toes pass over the floor
        times = np.array([0.0, 0.5 * self.leave, self.leave])
        slopes = np.stack([self.start.rates[ids], (high - start) / self.leave, np.zeros((4, 3))])
        return turns(hermite(times, np.stack([start, passing, high]), slopes, self.times))

    def _stand(self, spin: np.ndarray, first: int) -> None:
        """Pose the body over its feet from sample `first` on, so that the pelvis leaves with an extra spin (3,)."""
        turned = turns(self.nudge[first:] * spin) @ self.turns[first:]
        root = np.array(self.start.root if first == 0 else self.roots[first], float)
        self.feet[first:, :, 4] = self.pitches[first:]
        ground_kernel(self.body, self.flex, self.angles[first:], self.joints, self.offsets[first:], turned,
                      self.centres[first:], self.feet[first:], root, self.roots[first:], self.local[first:])

    def _prepare_air(self) -> None:
        """The flight's times, arc and carriage."""
        way = self.way
        self.flying = np.linspace(0.0, way.airtime, max(int(np.ceil(AIR_RATE * way.airtime)), 8) + 1)
        t = self.flying[:, None]
        self.arc = way.leave + way.velocity * t + 0.5 * self.gravity * t**2
        self.air_angles = self.carriage(self.leave + self.flying)
        self.air = np.tile(np.eye(3), (len(t), self.count, 1, 1))
        for angles, left, local in zip(self.air_angles, self._left_over(self.leave + self.flying), self.air):
            carry_on_kernel(angles, self.joints, left, local)
        self.air_roots, self.momentum = np.empty((len(t), 3)), np.empty(3)

    def _fly(self) -> np.ndarray:
        """Find the spin (3,) at take-off with which the body lands upright, and fly with it.

        A spin turns the body by about itself times the airtime; Broyden's method learns the rest.
        """
        self.roots[-3:] = self.centres[-3:]  # a guess
        wanted = self._upright(self.air_angles[-1:, 0])[0]
        spin, gain = np.array([-1.8 / self.way.airtime, 0.0, 0.0]), 0.57 * self.way.airtime * np.eye(3)
        change = before = np.zeros(3)
        for _ in range(ROUNDS):
            self._flight(spin, wanted, 1e-4)
            miss = self._miss(wanted)
            if change.any():
                gain += np.outer(before - miss - gain @ change, change) / (change @ change)
            if np.abs(miss).max() < CLOSE:
                break
            change, before = np.clip(np.linalg.solve(gain, miss), -5.0, 5.0), miss
            spin = spin + change
        # the legs reach for where this very body comes down, which changes a little how it turns
        for _ in range(ROUNDS):
            landed = self.air[-1, 0].copy()
            self._flight(spin, landed, 1e-9)
            if np.abs(vectors(landed.T @ self.air[-1, 0])).max() < SAME:
                break
        return spin

    def _miss(self, wanted: np.ndarray) -> np.ndarray:
        """The rotation vector (3,) [rad] from how the body came down to how it should, somersaults counted."""
        miss = vectors(wanted @ self.air[-1, 0].T)
        across = yaw(self.start.heading)[:, 0]
        turned = vectors(self.air[1:, 0] @ np.swapaxes(self.air[:-1, 0], -1, -2)) @ across
        meant = vectors(wanted @ self.air[0, 0].T) @ across
        return miss + 2.0 * np.pi * np.round((meant - turned.sum() - miss @ across) / (2.0 * np.pi)) * across

    def _flight(self, spin: np.ndarray, landed: np.ndarray, tolerance: float) -> None:
        """The flight after a take-off with `spin`, its legs reaching as if it came down turned `landed` (3, 3)."""
        self._stand(spin, len(self.times) - 3)
        step = self.times[-1] - self.times[-2]
        placed = np.empty((2, self.count, 3)), np.empty((2, self.count, 3, 3))
        for k in range(2):
            place_kernel(self.body, self.roots[k - 2], self.local[k - 2], placed[0][k], placed[1][k])
        momentum_kernel(self.body, placed[0][0], placed[1][0], placed[0][1], placed[1][1], step,
                        self.momentum, np.empty((3, 3)))
        self.air[:, self.legs] = self._legs_in_flight(step, self._touching(landed)[1])
        self.air[0] = self.local[-1]
        rate = vectors(self.local[-1, 0] @ self.local[-2, 0].T) / step
        flight_kernel(self.body, self.arc, self.air, rate, self.momentum, self.flying[1], self.air_roots, tolerance)

    def _touching(self, turn: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Pelvis (3,) and local rotations at touch-down, the body turned `turn` (3, 3)."""
        local = self.air[-1].copy()
        local[0] = turn
        root = self.way.land + [0.0, -0.05, 0.0]
        feet = np.column_stack([self.landing[:, :4], np.full(2, TOES_DOWN), np.zeros(2)])
        stand_kernel(self.body, self.way.land, feet, self.flex, root, local,
                     np.empty((self.count, 3)), np.empty((self.count, 3, 3)))
        return root, local

    def _legs_in_flight(self, step: float, end: np.ndarray) -> np.ndarray:
        """The legs' local rotations (N, 8, 3, 3): out of the push straight, then tucked, then reaching."""
        airtime, ids = self.way.airtime, self.legs
        before, last, reach = vectors(self.local[-2, ids]), vectors(self.local[-1, ids]), vectors(end[ids])
        tuck = np.clip((airtime - 0.25) / 0.35, 0.0, 1.0)
        straight, folded = last.copy(), reach.copy()
        for side, hip in enumerate((0, 4)):
            if self.feet[-1, side, 5] != FREE:
                straight[hip, 0], straight[hip + 1, 0], straight[hip + 2, 0] = last[hip, 0] + 0.10, 0.12, last[hip + 2, 0] + 0.08
            folded[hip, 0] = reach[hip, 0] - 0.45 * tuck
            folded[hip + 1, 0] = reach[hip + 1, 0] + 0.85 * tuck
            folded[hip + 2, 0] = 0.25
        times = np.array([0.0, min(0.08, 0.25 * airtime), 0.55 * airtime, airtime])
        slopes = np.zeros((4, 8, 3))
        slopes[0] = (last - before) / step
        return turns(hermite(times, np.stack([last, straight, folded, reach]), slopes, self.flying))

    def _land(self):
        """Touch-down to standing: times (M,) and, for each, roots, local rotations, and the centre of
        mass's place, velocity and acceleration."""
        way, body = self.way, self.body
        after = np.linspace(0.0, TIME, int(np.ceil(GROUND_RATE * TIME)) + 1)[1:]
        support = soles(self.landing, body)
        goal = support.mean(0) + [0.0, measures(self.physique).stand, 0.0]
        landing = absorb(way.land, way.falling, goal, support, -self.gravity[1])
        c, v, a = landing.motion(after)
        angles = self.carriage(self.down + after)
        feet = np.ones((len(after), 2, 6))
        feet[..., :5] = self.landing
        feet[..., 4] = (TOES_DOWN * np.clip(1.0 - after / PLANT, 0.0, 1.0) ** 2)[:, None]
        upright = self._upright(angles[:, 0])
        rate = vectors(self.air[-1, 0] @ self.air[-2, 0].T) / self.flying[1]
        turned = turns(faded(vectors(self.air[-1, 0] @ self._upright(self.air_angles[-1:, 0])[0].T), rate, STEADY, after)) @ upright
        roots, local = np.empty((len(after), 3)), np.tile(np.eye(3), (len(after), self.count, 1, 1))
        ground_kernel(body, self.flex, angles, self.joints, self._left_over(self.down + after), turned, c, feet,
                      self.air_roots[-1].copy(), roots, local)
        return after, (roots, local, c, v, a), max(landing.until(after), PLANT + 0.02)


def faded(offset: np.ndarray, rate: np.ndarray, halflife: float, times: np.ndarray) -> np.ndarray:
    """Offsets (N, ...) at times (N,) [s] of one (...) that settles from its rate."""
    return settle(offset, rate, halflife, times.reshape((-1,) + (1,) * np.ndim(offset)))[0]


def hermite(times: np.ndarray, values: np.ndarray, slopes: np.ndarray, at: np.ndarray) -> np.ndarray:
    """The cubic Hermite curve (N, ...) through values (K, ...) with slopes (K, ...) at times (K,)."""
    n = np.clip(np.searchsorted(times, at, "right") - 1, 0, len(times) - 2)
    width = (times[n + 1] - times[n]).reshape((-1,) + (1,) * (values.ndim - 1))
    s = (at - times[n]).reshape(width.shape) / width
    return (values[n] * (1.0 + 2.0 * s) * (1.0 - s) ** 2 + slopes[n] * width * s * (1.0 - s) ** 2
            + values[n + 1] * s**2 * (3.0 - 2.0 * s) + slopes[n + 1] * width * s**2 * (s - 1.0))


def quintic(start, velocity, acceleration, end, end_velocity, end_acceleration, times):
    """Place, velocity, acceleration (N, 3) along the quintic with these ends at times[0] = 0 and times[-1]."""
    t = times[-1]
    powers = np.array([[t**3, t**4, t**5], [3 * t**2, 4 * t**3, 5 * t**4], [6 * t, 12 * t**2, 20 * t**3]])
    c = np.linalg.solve(powers, np.stack([
        end - start - velocity * t - 0.5 * acceleration * t**2,
        end_velocity - velocity - acceleration * t, end_acceleration - acceleration]))
    s = times[:, None]
    return (start + velocity * s + 0.5 * acceleration * s**2 + c[0] * s**3 + c[1] * s**4 + c[2] * s**5,
            velocity + acceleration * s + 3 * c[0] * s**2 + 4 * c[1] * s**3 + 5 * c[2] * s**4,
            acceleration + 6 * c[0] * s + 12 * c[1] * s**2 + 20 * c[2] * s**3)


@kernel
def ground_kernel(body, flex, angles, joints, offsets, turns, centres, feet, root, roots, local):
    """Poses over planted feet: angles (N, 6), what is left of the start (N, J, 3), the pelvis' turns
    (N, 3, 3), centres of mass (N, 3), feet (N, 2, 6), whose pitch is written.

    root: (3,) a first guess. roots: (N, 3) and local: (N, J, 3, 3) are written.
    """
    count = local.shape[1]
    positions, orientations = np.empty((count, 3)), np.empty((count, 3, 3))
    for n in range(len(centres)):
        carry_on_kernel(angles[n], joints, offsets[n], local[n])
        local[n, 0] = turns[n]
        if n > 0:
            for i in range(3):
                root[i] += centres[n, i] - centres[n - 1, i]
        stand_kernel(body, centres[n], feet[n], flex, root, local[n], positions, orientations)
        roots[n] = root


@kernel
def carry_on_kernel(angles, joints, offsets, local):
    """Write the local rotations (J, 3, 3) of a body carried by `angles` (6,), what is left of the start (J, 3)
    added; neither the pelvis nor, where nothing is left, joints that are not carried are touched."""
    turn = np.empty((3, 3))
    for j in range(1, len(local)):  # poses are made anew, whatever an earlier round left
        if offsets[j, 0] != 0.0 or offsets[j, 1] != 0.0 or offsets[j, 2] != 0.0:
            exp_kernel(0.0, 0.0, 0.0, local[j])
    style.carry_kernel(angles, joints, local)
    for j in range(1, len(local)):
        if offsets[j, 0] != 0.0 or offsets[j, 1] != 0.0 or offsets[j, 2] != 0.0:
            exp_kernel(offsets[j, 0], offsets[j, 1], offsets[j, 2], turn)
            local[j] = turn @ local[j]
