"""Scripts: a list of moves, one after the other, that gives an intent for every step."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import reduce
from typing import Any

import numpy as np

from gambol.controllers.contract import CharacterState, Intent, Leap, Strike, but
from gambol.controllers.jump import Spread
from gambol.controllers.navigation import STEP, follow, in_world
from gambol.controllers.supervisor import both

from .aside import ANEW, EACH, SLOWED, STOPS, WALKS, Ahead, Known, ahead, askew, paces, waiting
from .making import Making, pace_of, way_of
from .moves import Move
from .run_up import Asks, RunUp
from .stances import Place, stand_for
from .straight_ahead import before


@dataclass(frozen=True, eq=False)
class Script:
    """Where somebody is in a list of moves.

    index, now: which move he makes, and how far he is with it. strikes: after how many steps of the script what strikes; made: those it has
    made. refused: why jumps were not made and places not reached, so far.
    """

    moves: tuple[Move, ...]
    index: int = 0
    strikes: tuple[tuple[int, Strike], ...] = ()
    made: int = 0
    refused: tuple[str, ...] = ()
    now: Making = Making()

    @property
    def done(self) -> bool:
        """Whether every move is over."""
        return self.index >= len(self.moves)

    @property
    def leaps(self) -> bool:
        """Whether its move ends with a jump: its run-up may go at what it leaps onto, but not who comes to rest before it."""
        return not self.done and self.moves[self.index].jump is not None and not (self.now.stand is not None and self.now.stand.goes)

    def step(self, state: CharacterState, dt: float) -> tuple[Script, Intent]:
        """The script `dt` seconds later, what it asks of a character in `state` meanwhile, and what strikes him."""
        hits = [strike for number, strike in self.strikes if number == self.made]
        script, intent = but(self, made=self.made + 1), Intent()
        while not script.done and script.now.over(script.moves[script.index], state, dt):
            script = script._next(state)
        if not script.done:
            now, intent = script.now.step(script.moves[script.index], state, dt)
            if intent.leap is not None and not _goes_on(script.moves[script.index + 1:]):
                intent = but(intent, leap=replace(intent.leap, stays=True))
            told = now.stuck(dt) and script.moves[script.index].jump is None  # else it is told as the jump is given up
            script = but(script, now=now, refused=(*script.refused, script.stands) if told else script.refused)
        return script, but(intent, strike=reduce(both, hits)) if hits else intent

    @property
    def stands(self) -> str:
        """What is told of who gets no farther."""
        x, z = self.moves[self.index].points[-1]
        return f"stands on the way to ({x:g}, {z:g}), which goes past nothing that is in it, as go_to does, nor up a step higher than {STEP:g} m"

    def held(self, controller: Any, state: CharacterState, intent: Intent, around: Sequence[Any], dt: float) -> tuple[Script, Intent]:
        """The same script, and what it asks of a character in `state` in this step, who on a run-up comes to rest before what he can't leap."""
        move = None if self.done else self.moves[self.index]
        if move is None or move.jump is None or self.now.jumped or not move.runs:
            return self, intent
        if self.now.stand is None and self.now.rests and state.active != "jump" and move.jump.place is not None and _before(state, move.jump.place):
            return self._rests(controller, state, around, self.now.run_up.halt, ()).held(controller, state, intent, around, dt)
        script = self if self.now.stand is None else self._rested(controller, state, around, dt)
        if script.now.stand is not None and script.now.stand.holds(state):
            return script, but(intent, leap=None, aim=None)
        return script._goes_at_it(move, controller, state, intent, around, dt)

    def _goes_at_it(self, move: Move, controller: Any, state: CharacterState, intent: Intent, around: Sequence[Any], dt: float) -> tuple[Script, Intent]:
        """The same of who is on his run-up, or asks for his leap from where he stands."""
        assert move.jump is not None
        if state.active == "jump":
            return self, intent
        known = self.now.aside
        if self.now.turns and not known.stops and known.lapsed:
            known = self._thinks(controller, state, intent, around, known.pace or pace_of(move), dt)
        if self.now.turns:
            known, thought, halts = known.after(), known.thought is not None, known.halts
            if thought and known.thought is None and halts and math.hypot(state.velocity[0], state.velocity[2]) < SLOWED * self.now.aside.pace:
                known = STOPS  # what he has thought of is how he would have gone on
            elif thought and known.stops and move.jump.place is not None and math.dist(move.jump.place[::2], state.ground[:2]) > ANEW:
                known = Known(WALKS[0])
            if known.thought is not None:
                x, z = in_world(state.ground, intent.velocity)
                brakes = RunUp(0, before(controller, state, (float(x), float(z)), around))
                known = known._replace(halts=brakes.halt is not None)
                return but(self, now=but(self.now, aside=known)), brakes.heeded(state, waiting(state, intent))
            if known.waits:
                return but(self, now=but(self.now, aside=known)), waiting(state, intent)
        run_up = self.now.run_up.step(controller, state, lambda: self._onward(intent, dt), around, dt, move.jump.place)
        return but(self, now=but(self.now, run_up=run_up, aside=known)), run_up.heeded(state, intent)

    def _rests(self, controller: Any, state: CharacterState, around: Sequence[Any], halt: Sequence[float] | None, tried: tuple[Place, ...]) -> Script:
        """The same of who begins to think of where he can leap from, as he comes to rest. halt: x, z [m] there; None: as soon as he can. tried: where he could not."""
        jump = self.moves[self.index].jump
        assert jump is not None and jump.place is not None  # or he would not come to rest for it
        leap = Leap(np.asarray(jump.place, float), jump.airtime, heading=jump.heading, on=jump.on)
        return but(self, now=but(self.now, stand=stand_for(controller, state, leap, around, halt, tried)))

    def _rested(self, controller: Any, state: CharacterState, around: Sequence[Any], dt: float) -> Script:
        """The same of who goes to where he can leap from, as soon as he knows and is slow enough, and leaps from there as who turns to a place aside does."""
        stand, now = self.now.stand, self.now
        assert stand is not None
        if stand.again and now.fails(state, dt):
            x, z, heading = map(float, state.ground)
            return self._rests(controller, state, around, (x, z), (*stand.tried, (x, z, heading)))._rested(controller, state, around, dt)
        after = stand.after(state, dt)
        if after.goes and not stand.goes:
            now = but(now, asked=0, aside=STOPS, turns=True, run_up=RunUp())
        return but(self, now=but(now, stand=after))

    def _thinks(self, controller: Any, state: CharacterState, intent: Intent, around: Sequence[Any], pace: float, dt: float) -> Known:
        """What is known of who begins to turn to a place aside, and to think of how to leap to it, and goes so fast [m/s]."""
        move = self.moves[self.index]
        assert move.jump is not None and move.jump.place is not None  # or he would not turn
        place = np.asarray(move.jump.place, float)[[0, 2]]
        way = place - state.ground[:2]
        far = float(np.hypot(*way))
        may = paces(pace, askew(state, way), far)
        found = Ahead[Script](controller, around, place, dt).found(self, state, intent, may, ahead(far, may[0]))
        return Known(may[0], thought=Spread(found, EACH))

    def paced(self, pace: float) -> Script:
        """The same of one who goes so fast [m/s] to a place aside."""
        return but(self, now=but(self.now, aside=Known(pace, 0)))

    def _onward(self, intent: Intent, dt: float) -> Asks:
        """What it asks from here on, first an intent."""
        script, first = self, True

        def asks(state: CharacterState) -> Intent:
            nonlocal script, first
            if first:
                first = False
                return intent
            script, onward = script.step(state, dt)
            return onward
        return asks

    def wished(self, state: CharacterState) -> np.ndarray | None:
        """The velocity (2,) [m/s] along x and z that its move along a path would have in the world, however its walker is turned; None of others."""
        if self.done or self.now.path is None or self.now.turns or self.moves[self.index].facing is not None:
            return None
        return follow(self.now.path, state.ground, np.float64(self.now.progress), self.moves[self.index].speed)[0]

    def _next(self, state: CharacterState) -> Script:
        """The beginning of the next move."""
        move, refused = self.moves[self.index], self.refused
        if move.jump is not None and not self.now.jumped:
            kind = "hop" if move.jump.hop is not None else "jump"
            place = move.jump.place
            where = "" if kind == "hop" else " up" if place is None else " to ({:g}, {:g}, {:g})".format(*place)
            why = self.now.run_up.why or self.now.why or state.refused or "it never came to where it could jump from"
            away = f", and its run-up ended {math.dist(place[::2], state.ground[:2]):.1f} m away" if move.runs and place is not None else ""
            refused = (*refused, f"no {kind}{where}: {why}{away}")
        way = way_of(move, state)
        if move.goal is not None and way is not None and way.reason:
            refused = (*refused, "no way to ({:g}, {:g}): {}".format(*move.goal.floor, way.reason))
        index = self.index + 1
        if _hops(move) and not self.now.jumped:  # nor are those made that go off from its landing
            while index < len(self.moves) and _hops(self.moves[index]):
                index += 1
        return but(self, index=index, refused=refused, now=Making(hopped=self.now.hops if self.now.jumped else None))


def _before(state: CharacterState, place: Sequence[float]) -> bool:
    """Whether a place (3,) lies before somebody, and not behind."""
    return abs(askew(state, np.asarray(place, float)[[0, 2]] - np.asarray(state.ground[:2], float))) < 0.5 * math.pi


def _goes_on(moves: Sequence[Move]) -> bool:
    """Whether the first of these moves, if there is one, goes anywhere."""
    return bool(moves) and (moves[0].runs or moves[0].goal is not None)


def _hops(move: Move) -> bool:
    return move.jump is not None and move.jump.hop is not None
