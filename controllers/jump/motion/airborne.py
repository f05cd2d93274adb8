"""A body in the air and on its feet again: what a planned jump and a fall share."""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from ...body import yaw
from ..body import FLEX, TOES_DOWN, Physique, Start, carriage, hermite, measures, parts_kernel, place_kernel, soles, standing, turns, vectors
from ..prior import BETWEEN, EACH, LEGS
from .flying_legs import touching_kernel
from .footing import FADE, MOMENT, faded
from .ground_kernels import FREE, carry_all_kernel, ground_kernel
from .landing import TIME, absorb
from .looking import Look
from .path_estimate import Path
from .rolling import rolls
from .swinging import free_leg, passing

GROUND_RATE, AIR_RATE = 72.0, 90.0
"""Poses a second over planted feet, in the air."""
SHORT = 0.5
"""Flights that last longer [s] are slower, and need fewer poses a second."""
RUNS_ON = 0.06, 0.26
"""Who lands on one foot walks or runs on once his leg has given and he is over it, so soon at least and at most [s]: by then who walks has come up again."""
PASSES, CALMS = 0.2, 0.26
"""The leg that swings on passes the other in so long at least [s], and trunk and arms come down with the body in so long, however soon the leg it lands on has given:
sooner, hands were pulled by up to 230 m/s² and knees by 26,000 °/s², recorded ones by 56 to 100 and 6,500 to 13,000."""
WAITS = 0.06
"""Who could hop on off one foot and goes too fast to stop over it walks on so long after the lowest point [s]."""
DOWN = 0.34
"""And who can stop puts the other foot down beside it within so long from there [s]."""
PLANT = 0.07
"""From the toes' landing to the heels' [s]."""
POINTS = 0.08, 2.5, 0.2
"""Who falls faster than the second [m/s] lands with feet that point down farther by the first for each m/s, and by the third at most [rad]; these take longer, too:
ankles take over from knees."""
HEEL = 0.03
"""A heel that is raised by more has left the floor [rad]."""
SOON = 1.0 / 240.0
"""How legs bend as they touch down is told from how they are and from how they will be so soon after [s]."""
STEADY = 0.12
"""Half-life with which the pelvis loses the turn it landed with [s]."""
LOWEST = 0.06, 0.45
"""From touch-down to the lowest point of the landing it takes at least and at most so long [s]."""
SETTLES = np.array([0.85, 0.6, 0.35, 0.15, 0.05])
"""How much is left, from row to row, of what a body's carriage differed by as it touched down."""
LEANS, LEANT = (1.8, 0.2), np.array([0.2, 0.5, 0.8, 1.0, 1.0, 0.8, 0.55, 0.3, 0.1, 0.0])
"""Who sinks deeper than the second [m] leans farther forward by the first [rad/m], lest the heels rise; and which share of that, from row to row."""
UP = 0.98
"""Trunk and arms are as in standing once the body has come up so much of the way."""
SAME = 1e-3
"""The legs reach for a body turned to within this of how it lands [rad]."""


class Airborne:
    """One motion in the making, from the air to standing.

    start: where it begins. way: its flight. landing: (2, 5) the feet on the floor. leave: when the flight
    begins [s]. times, keys: (K,) [s], (K, 11) [rad] the carriage until touch-down; the landing's is added from `Path.keys`. gives: which share of the usual it
    sinks and bends in its landing.
    """

    def __init__(self, physique: Physique, start: Start, way: Path, landing: np.ndarray, leave: float, times, keys: np.ndarray, gives: float = 1.0):
        self.physique, self.body, self.start, self.way = physique, physique.tables, start, way
        self.landing, self.gravity, self.leave = landing, way.gravity, leave
        self.joints = carriage.joints_of(physique.skeleton)
        self.count = len(physique.skeleton)
        self.flex = FLEX * physique.flexibility
        self.legs = (self.body.hip[:, None] + np.arange(4)).ravel()
        self.down = leave + way.airtime
        self.support = soles(landing if way.lands is None else landing[way.lands:way.lands + 1], self.body, start.lands_on)
        goal = self.support.mean(0) + [0.0, measures(physique).stand, 0.0]
        self.absorbs = absorb(way.land, way.falling, goal, self.support, -self.gravity[1], way.lands is not None and not way.hops, way.hops, rolls(physique, way), gives)
        self.after = np.linspace(0.0, TIME, int(np.ceil(GROUND_RATE * TIME)) + 1)[1:]
        self.sunk = self.absorbs.motion(self.after)
        landed = self._landing_times(goal[1])
        self.lowest, self.up = float(landed[BETWEEN - 1]), float(landed[-1])
        self.stands = self.lowest + DOWN if way.hops and way.lands is not None and not self.absorbs.passes else math.inf
        self.swings = slice(0, 0)  # joints of the leg that goes on swinging
        if way.lands is not None:
            self.swings = free_leg(self.body, way.lands)
        self.look = None if start.turn is None else Look.of(start, way, self.support.mean(0), physique.skeleton)
        rows = way.keys[3 * BETWEEN + 1:, :LEGS].copy()  # whoever comes down otherwise carried comes to them by and by
        rows[:len(SETTLES)] += SETTLES[:, None] * (keys[-1] - way.keys[3 * BETWEEN, :LEGS])
        sunk = (goal[1] - float(self.sunk[0][:, 1].min())) / physique.size
        rows[:, 0] += LEANS[0] * max(sunk - LEANS[1], 0.0) * LEANT
        calmer = (1.0 - gives) * np.minimum(np.arange(1.0, len(rows) + 1.0) / BETWEEN, 1.0)[:, None]  # but not at once: elbows snapped by 13° in a frame
        rows += calmer * (carriage.STAND - rows)
        carried = landed if way.lands is None else self._carried(landed)
        self.carriage = carriage.keyed(np.concatenate([times, self.down + carried, [self.down + TIME]]),
                                       np.concatenate([keys, rows, [carriage.STAND]]), start.runs)
        if way.lands is not None:
            later = max(PASSES - self.lowest, 0.0)
            times = np.concatenate([np.linspace(0.0, self.lowest + later, BETWEEN + 1), np.append(landed[BETWEEN:], TIME) + later])
            until = times[:BETWEEN + 1]
            centres = np.stack([np.interp(until, np.concatenate([[0.0], self.after]), part) for part in np.concatenate([[way.land], self.sunk[0]]).T], 1)
            angles = self.carriage(self.down + until)
            self.swung = passing(physique, landing, way.lands, times, way.keys[3 * BETWEEN:, LEGS + EACH * (1 - way.lands):][:, :EACH], centres, angles,
                                 self._upright(angles[:, 0], np.inf), start.lands_on, start.ledge if way.up < 0.0 else None)

    def _landing_times(self, stand: float) -> np.ndarray:
        """When [s] after touch-down the rows of the prior are due: until the lowest point evenly, then as the body comes up to how
        high [m] it stands."""
        height = self.sunk[0][:, 1]
        low = int(height.argmin())
        lowest = float(np.clip(self.after[low], *LOWEST))
        rises = (height[low:] - height[low]) / max(stand - height[low], 1e-6)
        up = np.interp(UP * np.linspace(0.0, 1.0, BETWEEN + 1)[1:], np.maximum.accumulate(rises), self.after[low:])
        up = np.minimum(np.maximum(up, lowest + 0.04 * np.arange(1, BETWEEN + 1)), TIME - 0.04 * np.arange(BETWEEN, 0, -1))
        return np.concatenate([lowest * np.linspace(0.0, 1.0, BETWEEN + 1)[1:], up])

    def _carried(self, landed: np.ndarray) -> np.ndarray:
        """When [s] after touch-down the rows of trunk and arms are due of who lands on one foot: later than those of his leg, which gives sooner than recorded ones."""
        return np.interp(landed, [0.0, self.lowest, TIME], [0.0, max(CALMS, self.lowest), TIME])

    def _differ(self, angles: np.ndarray, rates: np.ndarray | float = 0.0) -> None:
        """What the start's pose differs by from one carried by `angles` (11,), which change at `rates` (11,) [1/s]: it fades, see `_left_over`."""
        local, later = np.tile(np.eye(3), (2, self.count, 1, 1))
        carriage.carry_kernel(angles, self.joints, local)
        carriage.carry_kernel(angles + MOMENT * rates, self.joints, later)
        apart = self.start.rotations @ np.swapaxes(local, -1, -2)
        own = vectors(later @ np.swapaxes(local, -1, -2)) / MOMENT
        self.offset, self.offset_rate = vectors(apart), self.start.rates - (apart @ own[..., None])[..., 0]
        for part in (self.offset, self.offset_rate):
            part[0] = part[self.legs] = 0.0

    def _left_over(self, times: np.ndarray) -> np.ndarray:
        """What is left (N, J, 3) [rad] of the start's pose at times (N,) [s], pelvis and legs apart."""
        left = faded(self.offset, self.offset_rate, FADE, times)
        left[np.einsum("njk,njk->nj", left, left) < 1e-12] = 0.0
        return left if self.look is None else left + self.look.turns(times, self.count)

    def _upright(self, lean: np.ndarray, time: np.ndarray | float = 0.0) -> np.ndarray:
        """The pelvis' turns (N, 3, 3), facing where the jumper faces at times (N,) or one time [s], and leaning (N,) [rad]."""
        facing = self.start.heading if not self.way.turn else self.start.heading + self.way.turned(time)
        return yaw(facing) @ turns(np.asarray(lean)[:, None] * [1.0, 0.0, 0.0])

    def _prepare_air(self) -> None:
        """The flight's times, arc and carriage."""
        way = self.way
        count = AIR_RATE * min(way.airtime, math.sqrt(SHORT * way.airtime))
        self.flying = np.linspace(0.0, way.airtime, 3 * max(math.ceil(count / 3.0), 3) + 1)
        t = self.flying[:, None]
        self.arc = way.leave + way.velocity * t + 0.5 * self.gravity * t**2
        self.air_angles = self.carriage(self.leave + self.flying)
        self.air = np.tile(np.eye(3), (len(t), self.count, 1, 1))
        carry_all_kernel(self.air_angles, self.joints, self._left_over(self.leave + self.flying), self.air)
        self.air_roots, self.momentum = np.empty((len(t), 3)), np.empty(3)
        touches = np.array([0.0, SOON])
        self.comes_down, self.posed = standing(2, self.start.lands_on), np.stack([self.air[-1], self.air[-1]])
        self.comes_down[..., :4], self.comes_down[..., 4], self.comes_down[..., 5] = self.landing[:, :4], self._toes_down(touches)[:, None], 0.0
        self._free(self.comes_down)
        if self.way.lands is not None:
            self.posed[:, self.swings] = self.swung(touches)

    def _miss(self, wanted: np.ndarray, air: np.ndarray) -> np.ndarray:
        """The rotation vector (3,) [rad] from how a body in these poses (N, J, 3, 3) came down to how it should, somersaults
        counted."""
        miss = vectors(wanted @ air[-1, 0].T)
        across = yaw(self.start.heading)[:, 0]
        turned = vectors(air[1:, 0] @ np.swapaxes(air[:-1, 0], -1, -2)) @ across
        meant = vectors(wanted @ air[0, 0].T) @ across
        return miss + 2.0 * np.pi * np.round((meant - turned.sum() - miss @ across) / (2.0 * np.pi)) * across

    def _parts(self, root: np.ndarray, local: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Where (S, 3) the segments of a body are from its centre of mass, and how they are turned (S, 3, 3)."""
        positions, turned = np.empty((self.count, 3)), np.empty((self.count, 3, 3))
        place_kernel(self.body, root, local, positions, turned)
        parts = len(self.body.mass)
        out = np.empty((parts, 3)), np.empty((parts, 3, 3))
        parts_kernel(self.body, positions, turned, np.empty(3), *out)
        return out

    def _touching(self, turn: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """How the legs are turned (8, 3) [rad] at touch-down, the body turned `turn` (3, 3), and how fast they bend then (8, 3) [rad/s]."""
        end, bending = np.empty((len(self.legs), 3)), np.empty((len(self.legs), 3))
        touching_kernel(self.body, self.flex, turn, self.way.land, self.way.falling, SOON, self.comes_down, self.posed, self.legs, end, bending)
        return end, bending

    def _land(self):
        """Touch-down to standing: times (M,) and, for each, roots, local rotations, and the centre of mass's place,
        velocity and acceleration; whether the heels (M, 2) stand; when it walks on."""
        body = self.body
        after, landing, (c, v, a) = self.after, self.absorbs, self.sunk
        angles = self.carriage(self.down + after)
        feet = standing(len(after), self.start.lands_on)
        feet[..., :5] = self.landing
        feet[..., 4] = self._toes_down(after)[:, None]
        self._free(feet)
        upright = self._upright(angles[:, 0], np.inf)
        rate = vectors(self.air[-1, 0] @ self.air[-2, 0].T) / self.flying[1]
        turned = turns(faded(vectors(self.air[-1, 0] @ self._upright(self.air_angles[-1:, 0], np.inf)[0].T), rate, STEADY, after)) @ upright
        roots, local = np.empty((len(after), 3)), np.tile(np.eye(3), (len(after), self.count, 1, 1))
        if self.way.lands is not None:
            local[:, self.swings] = self.swung(after)
            local[:, self.swings.start] = np.swapaxes(turned, -1, -2) @ upright @ local[:, self.swings.start]  # else a trunk that turns on puts its toes into the floor
        pose = partial(ground_kernel, body, self.flex, angles, self.joints, self._left_over(self.down + after), turned, c)
        pose(feet, self.air_roots[-1].copy(), roots, local)
        if np.isfinite(self.stands):
            self._put_down(after, feet, roots, local)
            pose(feet, self.air_roots[-1].copy(), roots, local)
        return after, (roots, local, c, v, a), feet[..., 4] <= HEEL, (
            max(landing.until(after), self.lowest) if self.way.lands is None else
            self._steps_on() if self.way.hops else float(np.clip(max(self.lowest, landing.over(after)), *RUNS_ON)))

    def _steps_on(self) -> float:
        """When [s] after touch-down one who could hop on, but is not asked to, stands on both feet, or walks on if he can't stop."""
        return max(self.stands + 0.5 * DOWN, self.up) if np.isfinite(self.stands) else self.lowest + WAITS

    def _put_down(self, after: np.ndarray, feet: np.ndarray, roots: np.ndarray, local: np.ndarray) -> None:
        """Write how the foot in the air comes to stand beside the other, from how it is in these poses (M, ...) at the lowest point, into feet (M, 2, 6)."""
        free, first = int(self.way.lands == 0), int(np.searchsorted(after, self.lowest))
        ankle, ball, seen = self.body.hip[free] + 2, self.body.hip[free] + 3, np.empty((2, 5))
        positions, turned = np.empty((self.count, 3)), np.empty((self.count, 3, 3))
        for row, n in zip(seen, (first - 1, first)):
            place_kernel(self.body, roots[n], local[n], positions, turned)
            ahead = turned[ankle, :, 2]
            row[:] = *positions[ball], self.landing[free, 3], np.arcsin(np.clip(-ahead[1], -1.0, 1.0))
        times = after[first:] - after[first]
        way = hermite(np.array([0.0, DOWN]), np.stack([seen[1], self.landing[free]]),
                      np.stack([(seen[1] - seen[0]) / (after[first] - after[first - 1]), np.zeros(5)]), np.minimum(times, DOWN))
        way[:, 1] = np.maximum(way[:, 1], self.landing[free, 1])
        feet[first:, free, :5], feet[first:, free, 5] = way, 0.0

    def _free(self, feet: np.ndarray) -> None:
        """Let go of the foot (..., 2, 6) on which it does not land, if any."""
        if self.way.lands is not None:
            feet[..., 1 - self.way.lands, 5] = FREE

    def _toes_down(self, time) -> np.ndarray:
        """How far feet point down (...) [rad] so long after they touched [s]: toes first, but for strides, which are flat."""
        more = 1.0 + float(np.clip(POINTS[0] * (-self.way.falling[1] - POINTS[1]), 0.0, POINTS[2])) / TOES_DOWN
        return (self.way.lands is None or self.way.hops) * TOES_DOWN * more * np.clip(1.0 - np.asarray(time) / (PLANT * np.sqrt(more)), 0.0, 1.0) ** 2
