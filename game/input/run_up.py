"""Run-ups: who wants to leap goes on at what he can't walk over as long as he could still stop before it, and farther only if his leap goes off.

He plays ahead what he is about to do: controllers are pure functions. Hands that hold a leap at a run over what can't be run over go on to the last
footfall from which it can be leapt, and it goes off there by itself. What hands can leap is thought of beside the steps.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from gambol.controllers.contract import CharacterState, Intent, Leap, but
from gambol.controllers.jump import MOMENTARY, leaves_under
from gambol.controllers.navigation import STEP, floor_at, in_world, room
from gambol.controllers.navigation.thinking import Thought
from gambol.controllers.supervisor import Asked

from .straight_ahead import RISES, SHORT, UP, agility, is_edge, lacking, touches

LOOK, EVERY = 2.0, 0.15
"""He looks so far ahead [s], longer if his legs are slower than people's, and so often [s]: a run is stopped in 1.4 s at most."""
READY = 1.0
"""What a jump bids that could go off at once."""
THERE, RESTS = 0.3, 0.1
"""So near to that place [m], slower than this [m/s], he stays."""
RUNS = 1.8
"""Hands that ask for more than this [m/s] run [m/s]: a leap that they hold goes off by itself; who walks comes to rest before what is ahead, and aims."""
AHEAD = 0.70, 0.52
"""How far ahead the ring lies of a walker: at no speed [m], and for each m/s [s]."""
NEARER = 0.2, 0.0, 0.4, -0.2, 0.6, 0.8
"""A leap that goes off by itself lands so much nearer than the ring is [m]: a little, if it can, where he need not become faster for it."""
THINKS, WAITED = 0.5, 0.5
"""He thinks of his leap so much sooner than he would brake [s]; nearer to what is ahead than this share of how far he looks for that he hurries to know."""
BRAKES = 6
"""Who brakes already as he thinks of his leap brakes on for so many steps, by when he knows: who let go of that until he knew there is none would come to rest too late."""
MOST = 40
"""About the leap that goes off by itself he asks so many questions, and one more for each part of one that takes as long as most: of 47 that were found as hands ran at things none took more than 28; who asked
on, up to a hundred, came there before he knew."""
LATE, TURNED = 6, 0.35
"""It is asked for so many steps; who turned by more than this [rad] since it was found looks again."""

Asks = Callable[[CharacterState], Intent]
"""What is asked of somebody from state to state, step after step."""


@dataclass(frozen=True)
class RunUp:
    """What somebody knows of his run-up. free: for so many steps he goes on as he does, −1 where his leap was found not to go off; halt: x, z [m] where he is to come to rest, as he can't leap.
    leap: what goes off by itself after these steps, of a run of `velocity` [m/s] along x and z. thought: what he thinks of it, and for how many steps he has thought.
    why: what keeps him from leaping, off the last foot that is under him."""

    free: int = 0
    halt: tuple[float, float] | None = None
    leap: Leap | None = None
    velocity: tuple[float, float] = (0.0, 0.0)
    thought: Thought[RunUp] | None = None
    thinks: int = 0
    why: str = ""

    @property
    def off(self) -> Leap | None:
        """The leap that goes off by itself now."""
        return self.leap if self.free <= 0 else None

    def turned(self, velocity: tuple[float, float]) -> bool:
        """Whether hands ask for a velocity (2,) [m/s] another way than when this was found; who lets go of the stick does not."""
        across = self.velocity[0] * velocity[1] - self.velocity[1] * velocity[0]
        along = self.velocity[0] * velocity[0] + self.velocity[1] * velocity[1]
        return math.hypot(*velocity) > 1e-6 and abs(math.atan2(across, along)) > TURNED

    def onward(self, velocity: tuple[float, float]) -> RunUp | None:
        """The same a step later of somebody whose hands ask for a velocity (2,) [m/s]. None where no leap was found that goes off by itself, it did not, or he turned."""
        return None if self.leap is None or self.free <= -LATE or self.turned(velocity) else replace(self, free=self.free - 1)

    def known(self, hurried: bool, halt: tuple[float, float] | None) -> RunUp:
        """What he has thought of by now; the same a step later as long as he thinks. hurried: he is near. halt: where he is to come to rest if there is no leap."""
        assert self.thought is not None
        brakes = self.halt is not None
        found = None if brakes and self.thinks < BRAKES else self.thought.after(self.thinks, hurried or brakes)
        if found is None:
            return replace(self, thinks=self.thinks + 1)
        free = found.free - self.thinks
        return RunUp(-1, halt, velocity=self.velocity) if free < 0 or free == 0 and found.leap is None else replace(found, free=free)

    def step(self, controller: Any, state: CharacterState, asks: Callable[[], Asks], around: Sequence[Any], dt: float, place: Any = None) -> RunUp:
        """The same `dt` seconds later. asks: what is asked of him from here on. place: (3,) [m] where his leap leads."""
        if self.halt is not None or self.free > 0 or not len(around):
            return replace(self, free=self.free - 1)
        return _played(controller, state, asks, around, dt, LOOK / agility(controller), place)

    def heeded(self, state: CharacterState, intent: Intent) -> Intent:
        """An intent of somebody who comes to rest before what he can't leap; as it is where he goes on."""
        if self.halt is None:
            return intent
        far = float(np.hypot(self.halt[0] - state.ground[0], self.halt[1] - state.ground[1]))
        if far < THERE and np.hypot(state.velocity[0], state.velocity[2]) < RESTS:
            return but(intent, velocity=np.zeros(3), towards=None)
        return but(intent, halt=np.array([*self.halt, np.nan]), towards=None)


def _played(controller: Any, state: CharacterState, asks: Callable[[], Asks], around: Sequence[Any], dt: float, seconds: float, place: Any) -> RunUp:
    """What comes of going on for so long: whether he leaps is asked only if he would else come to where he can't walk."""
    walks, way, blocked, now = asks(), [state.ground[:2]], None, state
    for _ in range(round(seconds / dt)):
        intent = walks(now)
        now, _ = controller.step(now, but(intent, leap=None, aim=intent.leap or intent.aim, around=around), dt)
        way.append(now.ground[:2])
        floor = float(now.floor)
        if blocked is None and room(way[-1], floor, around) <= 0.0:
            blocked = len(way) - 1, is_edge(way[-1], floor, around)
        if now.active == "jump" or touches(way[-1], floor, around):
            number, why = leaps(controller, state, asks(), around, dt, len(way) - 1, place=place)
            last, edge = blocked or (len(way) - 1, now.active == "jump")
            return RunUp(number) if number else RunUp(0, _before(np.array(way), last, edge, float(state.floor), around, controller.size), why=why)
    return RunUp(max(round(EVERY / dt), 1))


def braked(controller: Any, state: CharacterState, brakes: RunUp, asks: Asks, around: Sequence[Any], dt: float) -> CharacterState:
    """The state of somebody who brakes as he thinks by when he knows."""
    for _ in range(BRAKES):
        intent = but(brakes.heeded(state, asks(state)), leap=None, aim=Leap(ring(state, around)), around=around)
        state, _ = controller.step(state, intent, dt)
    return state


def _silent() -> None:
    """Nobody counts the questions."""


def leaps(controller: Any, state: CharacterState, asks: Asks, around: Sequence[Any], dt: float, most: int, ask: Callable[[], None] = _silent,
          place: Any = None) -> tuple[int, str]:
    """After how many steps, at most so many, he can leap who goes on; 0 where he never can, and what keeps him from the leap to a place (3,) [m], None for any, off
    the last foot that is under him. Asked as often as a supervisor does. ask: is called before each question."""
    refused, told = None, ""
    for number in range(most):
        intent = but(asks(state), around=around)
        if intent.leap is not None and not (refused is not None and refused.still(state, intent)) and controller.precondition(state, intent) >= READY:
            ask()
            why = controller.refusal(state, intent)
            if not why:
                return number + 1, ""
            soon = intent.leap.slack == 0.0 and leaves_under(state, intent.leap, around)  # he may leap in the next moment
            refused = None if soon else Asked("", intent, state)
            if why not in MOMENTARY and (place is None or intent.leap.place is not None and np.array_equal(intent.leap.place, place)):
                told = why
        state, _ = controller.step(state, but(intent, leap=None, aim=intent.leap or intent.aim), dt)
    return 0, told


class Footfall(NamedTuple):
    """A moment from which a runner could leap: after how many steps, his state then, the way (2,) that he goes, what he is asked, and where (3,) the ring is ahead of him."""

    number: int
    state: CharacterState
    ahead: np.ndarray
    intent: Intent
    ring: np.ndarray


def last_chance(controller: Any, state: CharacterState, velocity: tuple[float, float], asks: Asks, around: Sequence[Any], dt: float,
                ask: Callable[[], None] = _silent) -> RunUp | None:
    """The run-up of somebody who goes on with a velocity (2,) [m/s] to the last footfall from which he can leap over what he can't run over, or onto it; None
    where there is none, or none that is found with `MOST` questions. ask: is called before each leap that is asked about."""
    footfalls, blocked = _footfalls(controller, state, asks, around, dt)
    if blocked is None:
        return None
    asked = 0

    def counts() -> None:
        nonlocal asked
        asked += 1
    for footfall in reversed(footfalls):
        for leap in _beyond(footfall, blocked, float(state.floor), around):
            if asked >= MOST:
                return None
            ask()
            counts()
            found = controller.found(footfall.state, but(footfall.intent, leap=leap), counts)
            if found is not None:
                return RunUp(footfall.number, None, found, velocity)
    return None


def ring(state: CharacterState, around: Sequence[Any]) -> np.ndarray:
    """Where (3,) [m] the ring is ahead of a runner: with a leap there in mind he does not brake before what he would else step onto."""
    pace = np.array(in_world(state.ground, state.velocity))
    speed = max(float(np.hypot(*pace)), 1e-6)
    x, z = np.array(state.ground[:2]) + (AHEAD[0] + AHEAD[1] * speed) * pace / speed
    return np.array([x, floor_at(x, z, around, float(state.floor) + UP), z])


def _footfalls(controller: Any, state: CharacterState, asks: Asks, around: Sequence[Any], dt: float) -> tuple[list[Footfall], np.ndarray | None]:
    """All footfalls of somebody who goes on until he can go no farther, and where (2,) [m] the first place is that he can't run over; None where there is none."""
    footfalls: list[Footfall] = []
    stood, now, floor, blocked = True, state, float(state.floor), None
    for number in range(round((LOOK / agility(controller) + THINKS) / dt)):
        place = ring(now, around)
        intent = but(asks(now), leap=Leap(place), around=around)
        stands = controller.precondition(now, intent) >= READY
        if stands and not stood:
            way = place[[0, 2]] - now.ground[:2]
            footfalls.append(Footfall(number, now, way / np.hypot(*way), intent, place))
        stood = stands
        now, _ = controller.step(now, but(intent, leap=None, aim=intent.leap), dt)
        here = np.array(now.ground[:2])
        met = touches(here, floor, around)  # what is low enough to step on, too, before his middle is over it
        if blocked is None and (met or room(here, floor, around) <= 0.0 or floor_at(here[0], here[1], around, floor + UP) > floor + RISES):
            blocked = here
        if now.active == "jump" or met or blocked is not None and is_edge(here, floor, around):
            break
    return footfalls, blocked


def _beyond(footfall: Footfall, blocked: np.ndarray, floor: float, around: Sequence[Any]) -> Iterator[Leap]:
    """Leaps onto the ring, and a little nearer or farther, that lead beyond a place (2,) [m] which can't be run over."""
    for nearer in NEARER:
        x, z = footfall.ring[[0, 2]] - nearer * footfall.ahead
        high = floor_at(x, z, around, floor + UP)
        if float((np.array([x, z]) - blocked) @ footfall.ahead) > 0.0 and high >= floor - STEP:
            yield Leap(np.array([x, high, z]))


def _before(way: np.ndarray, last: int, edge: bool, floor: float, around: Sequence[Any], size: float) -> tuple[float, float]:
    """Where (x, z) [m] on a way (N, 2) to come to rest before its place `last`, with room to leap onto what lies there."""
    gone = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(way[:last + 1], axis=0).T))])

    def on(far: float) -> np.ndarray:
        return np.array([np.interp(far, gone, way[:last + 1, k]) for k in (0, 1)])
    at = max(gone[-1] - SHORT[edge], 0.0)
    ahead = way[last] - on(at)
    x, z = on(max(at - lacking(on(at), ahead / max(float(np.hypot(*ahead)), 1e-9), floor, around, size), 0.0))
    return float(x), float(z)
