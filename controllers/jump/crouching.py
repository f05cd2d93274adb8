"""Crouching while one aims: the body goes down into the crouch from which its muscles could make the jump that it is about to make,
waits there, follows the aim, and stands up again if nothing comes of it.

Centre of mass and carriage follow what is wanted by springs of three equal rates, so that the floor's force goes on without a step;
limbs and feet settle from how they were, as in a jump.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..body import Pose, yaw
from ..contract import CharacterState, Leap
from .body import FLAT, FOOT_FADE, FLEX, Start, carriage, measures, soles, standing, turns, vectors
from .motion import FADE, LASTS, Shown, deepest, faded, ground_kernel, near, swivels
from .prior import BETWEEN, LEGS
from .reach import Onward, Reach
from .starting import stands, turning

RATE = 10.0
"""Rate of the springs of a standard adult on Earth [1/s]: down in half a second, and never pulled."""
INSIDE, FAR = 0.8, 0.6
"""Who aims farther than the second [m], at standard height, leans ahead by this share of half the soles; who aims nearer, less, and as the jump begins."""
RAISED = 0.14
"""A heel that is raised by less stands still [rad]."""
SHARES = np.linspace(1.0, 0.0, 6)
"""Who would come against something crouches by the largest of these shares of how far he would, lying no deeper in it than he does as he stands."""
RISEN, SLOW = 0.01, 0.05
"""A body stands again that is so near to standing [m] and so slow [m/s]."""
STEP = 1.0 / 240.0
"""How a crouch begins is told from its first moments, so far apart [s]."""


@dataclass(frozen=True, eq=False)
class Crouching:
    """What somebody who crouches remembers. start: how it began; time: [s] since. offset: (J, 3) [rad] what its limbs differed by then,
    the pelvis's first. planted: (2, 5) where its feet come to stand. place, rate, bend: (14,) where the centre of mass is [m] and how the body
    is carried [rad], and their first and second derivatives. goal: (14,) where they shall be. leap: for what it crouches, None as it
    stands up. refused: why the jump that was asked can't be made, asked: which one that was, onward: with what that is gone on with being found out.
    stood: (4,) where it was left, see `starting.jumping.stands`. shown: what its legs differed by as it began, None for nothing.
    """

    start: Start
    time: float
    offset: np.ndarray
    planted: np.ndarray
    place: np.ndarray
    rate: np.ndarray
    bend: np.ndarray
    goal: np.ndarray
    leap: Leap | None = None
    refused: str = ""
    asked: Leap | None = None
    onward: Onward | None = None
    stood: np.ndarray | None = None
    shown: Shown | None = None

    @property
    def stands(self) -> bool:
        """Whether it is up again."""
        return (self.leap is None and bool(np.abs(self.goal - self.place)[:3].max() < RISEN)
                and bool(np.abs(self.rate[:3]).max() < SLOW))


def begun(reach: Reach, start: Start, floor: float) -> Crouching:
    """The memory of one who begins to crouch, so far for nothing."""
    skeleton = reach.physique.skeleton
    local = np.tile(np.eye(3), (len(skeleton), 1, 1))
    carriage.carry_kernel(carriage.STAND, carriage.joints_of(skeleton), local)
    local[0] = yaw(start.heading) @ turns(carriage.STAND[:1] * [1.0, 0.0, 0.0])
    place, still = np.concatenate([start.centre, carriage.STAND]), np.zeros(LEGS)
    planted = start.planted(floor, reach.physique.tables)
    memory = Crouching(start, 0.0, vectors(start.rotations @ np.swapaxes(local, -1, -2)), planted, place, np.concatenate([start.velocity, still]),
                     np.concatenate([start.acceleration, still]), _upright(reach, start, planted, floor))
    first = [moved(reach, memory, start.root, late)[1] for late in (0.0, STEP)]
    return replace(memory, shown=Shown.of(reach.physique, start, STEP, *(np.array([getattr(pose, part) for pose in first]) for part in ("root", "rotations"))))


def aimed(reach: Reach, memory: Crouching, leap: Leap | None, floor: float, around: Sequence[Any] = ()) -> Crouching:
    """The same crouch for another leap, as deep as boxes and pillars around leave room for; None stands up. What is no place counts as no other."""
    if leap is None:
        return replace(memory, leap=None, goal=_upright(reach, memory.start, memory.planted, floor))
    if leap.same(memory.leap):
        return memory
    goal = _upright(reach, memory.start, memory.planted, floor)
    body = reach.physique.tables
    still = turning(replace(memory.start, centre=goal[:3], velocity=np.zeros(3), feet=memory.planted, feet_rates=np.zeros((2, 5)), ready=True, single=None),
                    leap)
    place = reach.middle(still, floor) if leap.place is None else np.asarray(leap.place, float)
    if place.shape != (3,) or not np.isfinite(place).all():
        return memory
    way = reach.path(still, place, floor, leap.airtime)
    flat, lead = (place - way.stance) * FLAT, (way.low - way.stance) * FLAT
    far = float(np.linalg.norm(flat))
    lead += min(far / (FAR * body.size), 1.0) * (INSIDE * 0.5 * float(body.tip[2] - body.heel[2] + body.toe[2]) * flat / max(far, 1e-9) - lead)
    if not np.isfinite(np.concatenate([way.low, lead])).all():
        return memory
    still = replace(still, centre=(way.stance + lead) * FLAT + [0.0, way.low[1], 0.0])
    way = reach.path(still, place, floor, leap.airtime)  # how deep depends a little on where it waits
    wanted = np.concatenate([still.centre * FLAT + [0.0, way.low[1], 0.0], way.keys[BETWEEN, :LEGS]])
    return replace(memory, leap=leap, goal=_clear(reach, memory, goal, wanted, around)) if np.isfinite(wanted).all() else memory


def _clear(reach: Reach, memory: Crouching, upright: np.ndarray, wanted: np.ndarray, around: Sequence[Any]) -> np.ndarray:
    """Where (14,) it waits that would wait at `wanted` (14,), or nearer to `upright` (14,) where something is in its way."""
    things = near(reach.physique, wanted[None, :3], around)
    if not things:
        return wanted
    ways = upright + SHARES[:, None] * (wanted - upright)
    feet, still = np.repeat(memory.planted[None], len(ways), 0), np.zeros((len(ways), len(reach.physique.skeleton), 3))
    roots, local, _ = _posed(reach, memory.start, ways, still, feet, np.zeros((len(ways), 2)), wanted[:3] - [0.0, 0.1, 0.0])
    deep = deepest(reach.physique, roots, local, things)
    return ways[int(np.argmax(deep <= deep[-1]))]


def moved(reach: Reach, memory: Crouching, root: np.ndarray, dt: float) -> tuple[Crouching, Pose, np.ndarray]:
    """The crouch dt seconds later, its pose, and whether (4,) heels and balls stand. root: (3,) [m] where the pelvis was."""
    start = memory.start
    r = RATE * np.sqrt(-reach.gravity[1] / 9.81 / reach.physique.size)
    off = memory.place - memory.goal
    a, b = memory.rate + r * off, 0.5 * (memory.bend + 2.0 * r * memory.rate + r**2 * off)
    fade, way, rate, bend = np.exp(-r * dt), off + a * dt + b * dt**2, a + 2.0 * b * dt, 2.0 * b
    after = replace(memory, time=memory.time + dt, place=memory.goal + fade * way, rate=fade * (rate - r * way),
                    bend=fade * (bend - 2.0 * r * rate + r**2 * way))
    now = np.array([after.time])
    feet = memory.planted + faded(start.feet - memory.planted, start.feet_rates, FOOT_FADE, now)
    feet[..., 1] = np.maximum(feet[..., 1], memory.planted[:, 1])
    roots, local, down = _posed(reach, start, after.place[None], faded(memory.offset, start.rates, FADE, now), feet, swivels(reach.physique, start, now), root)
    stands = np.ones(4, bool)
    stands[::2] = down[0] < RAISED
    if memory.shown is not None:
        roots, local = memory.shown.over(reach.physique, now, roots, local)
        after = after if after.time < LASTS else replace(after, shown=None)
    return after, Pose(roots[0], local[0]), stands


def _posed(reach: Reach, start: Start, places: np.ndarray, left: np.ndarray, feet: np.ndarray, swivel: np.ndarray, root: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Poses (N, 3), (N, J, 3, 3) of a body carried so (N, 14) over feet (N, 2, 5), its knees turned about its legs by swivel (N, 2) [rad], `left` (N, J, 3) [rad] of how it
    began; and how far its feet point down (N, 2) [rad]. root: (3,) [m] about where the pelvis is."""
    body, skeleton = reach.physique.tables, reach.physique.skeleton
    turned = turns(left[:, 0]) @ yaw(start.heading) @ turns(places[:, 3:4] * [1.0, 0.0, 0.0])
    left[:, 0] = 0.0
    left[:, (body.hip[:, None] + np.arange(4)).ravel()] = 0.0
    stand = standing(len(places), start.slope)
    stand[..., :5], stand[..., 8] = feet, swivel
    roots, local = np.empty((len(places), 3)), np.tile(np.eye(3), (len(places), len(skeleton), 1, 1))
    ground_kernel(body, FLEX * reach.physique.flexibility, np.ascontiguousarray(places[:, 3:]), carriage.joints_of(skeleton), left, np.ascontiguousarray(turned),
                  np.ascontiguousarray(places[:, :3]), stand, np.array(root, float), roots, local)
    return roots, local, stand[..., 4]


def crouched(reach: Reach, state: CharacterState, leap: Leap | None, dt: float, around: Sequence[Any] = ()) -> CharacterState:
    """The state of somebody who crouches dt seconds later, for a leap, or standing up. The ground frame stays where the feet are."""
    memory: Crouching = aimed(reach, state.memory, leap, float(state.floor), around)
    memory, pose, contacts = moved(reach, memory, state.pose.root, dt)
    return replace(state, velocity=np.zeros(3), pose=pose, contacts=contacts, memory=replace(memory, stood=stands(state)))


def _upright(reach: Reach, start: Start, planted: np.ndarray, floor: float) -> np.ndarray:
    """Where (14,) centre of mass and carriage are as it stands."""
    middle = soles(planted, reach.physique.tables).mean(0)
    return np.concatenate([middle * FLAT + [0.0, floor + start.rise(middle) + measures(reach.physique).stand, 0.0], carriage.STAND])
