"""Places aside: who is to leap to a place beside his way turns to it with the steps that are left, and leaps along the line to it, slower where he must; where he would come past it he comes to
rest, turns to it and leaps from there."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, Generic, NamedTuple, Protocol, TypeVar

import numpy as np

from gambol.controllers.contract import CharacterState, Intent, but
from gambol.controllers.jump import RUNNING, Pieces, Spread, priced
from gambol.controllers.navigation import in_world, steer
from gambol.controllers.supervisor import Asked

from .pilot import STEERING
from .straight_ahead import touches

BESIDE = 0.1, 0.1
"""A place lies aside of his way who goes past it by more than these [rad, m]."""
NEAREST = 0.4
"""Who goes leaps to no place that is nearer than this [m], which he walks over: he would hop on the spot."""
GOES = 0.3
"""Who is slower than this [m/s] goes no way but that which he faces."""
GRID = 0.1
"""The heading in which he lands lies on so coarse a grid [rad], lest another leap be asked in each step that he turns."""
ROOM = 0.25, 1.2
"""He begins to turn as much sooner as he goes in the first [s], and in the time that turning as fast as the second takes [rad/s]."""
PASSES = 0.9, 2.5
"""Who has it farther aside than the first [rad] turns to it as soon as he could be there within the second [s] and a leap: else he would pass it."""
SHARES, WALKS, RUNS = (0.8, 1.1), (1.3, 1.1), 1.6
"""He goes to it as fast as he does, or so many times as fast, or, if he is faster than the third [m/s], at a walk [m/s], whichever leads him off soonest."""
BENDS, NEARBY = (1.1, 2.0), 0.9
"""Who runs, has it farther aside than the first over his pace [rad m/s], and is faster than the second [m/s], walks to it until he knows better: no foot sends him round so far. So does who would be there within
the third [s]."""
FAR = 1.2
"""Who has farther to go than this [m] and walks so slowly that he would leap off both feet goes faster first."""
ANEW = 1.4
"""Who knows no leap as he goes, and has farther to go than this [m], thinks anew, at a walk; who is nearer comes to rest, and leaps from there."""
SOON, LATER, ENOUGH = 0.36, 0.8, 1.1
"""Who leaps in stride is in the air in so much time [s], at standard height; another leap is taken as if it went off so much later [s]. What goes off in stride within the third [s] will do."""
TURNS = 0.75
"""He turns no farther in the air than this [rad]."""
AHEAD, LATE = (1.0, 0.7, 4.0), 10
"""That is played ahead for so long as he goes there, by these [s, m/s], at most the last [s]; a leap that has not gone off so many steps later is found out about anew."""
UNDER_WAY = 0.7
"""Who runs up to a jump faster than this [m/s] aims at it; who is slower would crouch for it."""
EACH, PLANS, COSTS, WAITS = 12, 10, 4, 1
"""It is found out in pieces, so many in a step: a step that is played ahead is one, so many more if he may leap in it, a plan that will do so many more, and what is found out about a leap so many for each that it
costs."""
IN_TIME, CHANGES = (3, 6), 20
"""Nobody asks whether he leaps in a moment that comes within so many steps: it is gone by when he knows; nor whether in a later one as that which he knows comes within the second. Another pace is taken up
so many steps after he began to think of it."""
SENDS, FAST, SENT = (1.2, 1.0), 2.3, 1.5
"""Nor whether a foot sends a runner aside of his way by more than the first [m/s], the second if he is faster than the third, or farther aside than the fourth [rad]: of 380 that were
so in 1200 leaps and 3700 refusals, four were leapt."""
HOPES = 1.1
"""Who has not yet played ahead until he is as near as this [m] lets a leap go by that is none in stride: one may come."""
PAST = 0.6
"""Who has it nearer than this [m], and no longer before him, has gone past it."""
SLOWED = 0.85
"""Who has become slower than this share of his pace before what is ahead, as he thinks, goes on otherwise than he has thought."""
READY = 1.0
"""What a jump bids that could go off at once."""

S = TypeVar("S", bound="Goes")


class Goes(Protocol):
    """What asks of somebody who is on his way, as a script does."""

    @property
    def leaps(self) -> bool:
        """Whether he is still to leap."""
        ...

    def step(self: S, state: CharacterState, dt: float) -> tuple[S, Intent]:
        """The same `dt` seconds later, and what it asks meanwhile."""
        ...

    def paced(self: S, pace: float) -> S:
        """The same of one who goes to the place so fast [m/s]."""
        ...


class Known(NamedTuple):
    """What is known of a leap to a place aside. pace: how fast he goes to it [m/s], 0 for as he does; steps: after how many steps it goes off; change: to which pace [m/s] he changes, and after how many steps.
    stops: he comes to rest, as he can't leap as he goes. thought: what comes of thinking about it; thinks: for how many steps he has thought; halts: whether he is to come to rest before something meanwhile."""

    pace: float = 0.0
    steps: int = -LATE - 1
    change: tuple[float, int] | None = None
    stops: bool = False
    thought: Spread[Known] | None = None
    thinks: int = 0
    halts: bool = False

    @property
    def lapsed(self) -> bool:
        """Whether nothing is known, nor thought of: the leap was to go off before."""
        return self.thought is None and self.steps < -LATE

    @property
    def waits(self) -> bool:
        """Whether he leaps in no moment yet."""
        return self.thought is not None or self.steps > 0

    def after(self) -> Known:
        """The same a step later."""
        if self.thought is None:
            later = self._replace(steps=self.steps - 1)
        else:
            found = self.thought.after(self.thinks + 1)
            if isinstance(found, str):
                return self._replace(thinks=self.thinks + 1)
            later = found._replace(steps=found.steps - self.thinks, change=found.change and (found.change[0], found.change[1] - self.thinks))
        if later.change is None:
            return later
        pace, steps = later.change
        return later._replace(pace=pace, change=None) if steps <= 1 else later._replace(change=(pace, steps - 1))


STOPS = Known(stops=True, steps=0)
"""Of who comes to rest, and leaps from there."""


def course(state: CharacterState) -> float:
    """Which way [rad] somebody goes, or faces who stands."""
    if math.hypot(state.velocity[0], state.velocity[2]) < GOES:
        return float(state.ground[2])
    x, z = in_world(state.ground, state.velocity)
    return math.atan2(x, z)


def askew(state: CharacterState, way: np.ndarray) -> float:
    """How far [rad] to the left of how somebody goes a way (2,) leads."""
    return math.remainder(math.atan2(*way) - course(state), math.tau)


def beside(state: CharacterState, way: np.ndarray) -> bool:
    """Whether a place a way (2,) off lies aside of how somebody goes."""
    off = askew(state, way)
    return abs(off) > BESIDE[0] and float(np.hypot(*way)) * abs(math.sin(off)) > BESIDE[1]


def ahead(far: float, pace: float) -> float:
    """For how long [s] it is played ahead of somebody who goes so fast at most [m/s] to a place so far away [m]."""
    return min(AHEAD[0] + far / max(AHEAD[1], 0.8 * pace), AHEAD[2])


def room(state: CharacterState, way: np.ndarray, pace: float) -> float:
    """How far [m] before he may leap somebody begins to turn to a place a way (2,) off, who is to go so fast [m/s]: at the latest before he passes it."""
    off = abs(askew(state, way))
    return pace * PASSES[1] if off > PASSES[0] else math.hypot(state.velocity[0], state.velocity[2]) * (ROOM[0] + off / ROOM[1])


def bent(state: CharacterState, pace: float, way: np.ndarray) -> Intent:
    """What somebody wants who goes so fast [m/s] and turns to a place a way (2,) off."""
    return steer(state.ground, pace * way / max(float(np.hypot(*way)), 1e-9), None, state.velocity[1], STEERING)


def lands(state: CharacterState, way: np.ndarray) -> float:
    """The heading [rad] in which he lands who leaps a way (2,)."""
    heading = float(state.ground[2])
    return GRID * round((heading + min(max(math.remainder(math.atan2(*way) - heading, math.tau), -TURNS), TURNS)) / GRID)


def paces(pace: float, off: float, far: float) -> tuple[float, ...]:
    """How fast [m/s] somebody may go to a place so far aside [rad] and away [m] who goes so fast: what he does until he knows better first."""
    slower, faster = (share * pace for share in SHARES)
    walks, slowly = WALKS
    if pace <= RUNS:
        return (pace, slower, faster) if pace >= RUNNING else (slowly, pace) if far > FAR else (pace, slowly)
    return (walks, slowly, slower) if far < NEARBY * pace or pace > BENDS[1] and abs(off) > BENDS[0] / pace else (pace, walks, slower, slowly)


def waiting(state: CharacterState, intent: Intent) -> Intent:
    """An intent of somebody who does not leap yet."""
    if intent.leap is None:
        return intent
    return but(intent, leap=None, aim=intent.leap if math.hypot(state.velocity[0], state.velocity[2]) > UNDER_WAY else None)


class _Played(NamedTuple):
    """A leap that goes off as it was played ahead: after how many steps, how good that is, as a time [s], and whether in stride."""

    number: int
    good: float
    strides: bool


class Ahead(Generic[S]):
    """What is played ahead of somebody who turns to a place aside. controller: whose; around: what stands about; place: (2,) [m]; dt: of a step [s]."""

    def __init__(self, controller: Any, around: Sequence[Any], place: np.ndarray, dt: float):
        self.controller, self.around, self.place, self.dt = controller, around, place, dt
        self.number = 0  # of the step in which that is thought of

    def found(self, goes: S, state: CharacterState, intent: Intent, pace: Sequence[float], seconds: float) -> Pieces[Known]:
        """What comes of it, in pieces, that are told the step in which they are worked out. goes: what asks him from here on, first an intent; pace: how fast he may go [m/s], first what he does until then;
        seconds: so long at most it is played ahead, for who goes as fast as that [s]."""
        goes, way = goes.paced(pace[0]), list[tuple[S, CharacterState]]()
        best, change = (yield from self._leaps(goes, state, intent, 0, seconds, None, way)), None
        others = list(pace[1:])
        while others and (best is None or best.good > ENOUGH):
            at, known = self.number + CHANGES, best
            if known is not None and at >= known.number or at * self.dt > seconds or not (yield from self._until(at, way)):
                break
            while others and self.number < at:
                other = others.pop(0)
                found = yield from self._leaps(way[at][0].paced(other), way[at][1], None, at, seconds if best is None else min(seconds, best.good), at - 1, None)
                if found is not None and (best is None or found.good < best.good):
                    best, change = found, (other, at)
            if change is not None:
                break
        return STOPS if best is None else Known(pace[0], best.number, change)

    def _until(self, at: int, way: list[tuple[S, CharacterState]]) -> Pieces[bool]:
        """Whether he still goes on as he does after so many steps; the way (of what asks and states, one a step) is played on until there."""
        while len(way) <= at:
            goes, state = way[-1]
            goes, intent = goes.step(state, self.dt)
            state, _ = self.controller.step(state, waiting(state, but(intent, around=self.around)), self.dt)
            if not goes.leaps or state.active == "jump":
                return False
            way.append((goes, state))
            self.number = yield 1
        return True

    def _leaps(self, goes: S, state: CharacterState, intent: Intent | None, number: int, seconds: float, until: int | None,
               way: list[tuple[S, CharacterState]] | None) -> Pieces[_Played | None]:
        """The best leap of who goes on so, from the step `number` on, within so long [s]; None where none goes off, or it is not known by the step `until`. way: is told what asks, and the state, of each step."""
        best, refused = None, None
        self.number = yield 0
        while goes.leaps and state.active != "jump" and number * self.dt < (seconds if best is None else min(seconds, best.good)):
            if until is not None and self.number >= until or self._past(state) or touches(state.ground[:2], float(state.floor), self.around):
                break
            if best is not None and self.number + IN_TIME[1] >= best.number:
                if best.strides or float(np.hypot(*(self.place - state.ground[:2]))) < HOPES:
                    break
                best = None
            if way is not None:
                way.append((goes, state))
            if intent is None:
                goes, intent = goes.step(state, self.dt)
            intent = but(intent, around=self.around)
            soon = number <= self.number + IN_TIME[0]
            asks = intent.leap is not None and not soon and not (refused is not None and refused.still(state, intent)) and self._sends(state)
            if asks:
                self.number = yield WAITS
            if asks and self.controller.precondition(state, intent) >= READY:
                made = yield from self._asked(state, intent)
                refused = Asked("", intent, state)
                if not isinstance(made, str) and number >= self.number and (until is None or self.number < until):
                    strides = made.take_off < SOON * math.sqrt(self.controller.size) and made.path.lands is not None
                    good = number * self.dt + made.take_off + LATER * (not strides)
                    best = _Played(number, good, strides) if best is None or good < best.good else best
            state, _ = self.controller.step(state, waiting(state, intent), self.dt)
            intent, number = None, number + 1
            self.number = yield 1
        return best if best is not None and best.number >= self.number else None

    def _past(self, state: CharacterState) -> bool:
        """Whether somebody has gone past the place."""
        way = self.place - state.ground[:2]
        far = float(np.hypot(*way))
        return far < NEAREST or far < PAST and abs(askew(state, way)) > 0.5 * math.pi

    def _sends(self, state: CharacterState) -> bool:
        """Whether a foot may send somebody to the place."""
        off, pace = askew(state, self.place - state.ground[:2]), math.hypot(state.velocity[0], state.velocity[2])
        return pace < RUNNING or abs(off) < SENT and pace * abs(math.sin(off)) < SENDS[pace > FAST]

    def _asked(self, state: CharacterState, intent: Intent) -> Pieces[Any]:
        """The plan of a leap that is asked, or why there is none."""
        made = yield from priced(self.controller.looks(state, intent), COSTS)
        self.number = yield 0 if isinstance(made, str) else PLANS
        self.number = yield 0  # that is paid off
        return made
