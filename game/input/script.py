"""Scripts: a list of moves, one after the other, that gives an intent for every step."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from gambol.controllers.contract import CharacterState, Goal, Intent, Leap, Status, Strike, but
from gambol.controllers.jump import Jumping
from gambol.controllers.navigation import Path, follow, steer

from .pilot import STEERING

ARRIVED = 0.12
"""A path is walked when no more than this is left of it [m]."""
BRAKE = 0.25
"""Wishes along a path fade over so much of its end [m]: walkers have let go of them before."""
NEAR = 0.12
"""A jump no farther than this [m] goes straight up: nobody turns for it."""
FEW, SLOW, TURNS = 1.4, 0.5, 0.35
"""Who has no farther to go than this [m] along a path, at less than this speed [m/s], and has to turn by more than this [rad], turns first."""
ASKEW = 0.15
"""A standing body faces where it jumps to within this [rad]."""
PATIENCE = 1.0
"""So long [s] a jump that can't be made from a stand is asked for."""
AHEAD = 0.85, 0.5
"""A runner asks for its jump this near to the landing: at no speed [m], and for each m/s [s]."""


@dataclass(frozen=True)
class Jump:
    """A jump to `place`, x, y, z [m]; None: straight up. airtime: [s], None for the least effort.

    within: a runner jumps no farther from it than this [m]; None: as its speed suggests. slow: how much longer flights
    take than on Earth, √(9.81 / g). aims: so long [s] a standing body crouches first, aiming. heading: [rad] in which it lands; None: as it went off.
    hop: instead of a place, so far ahead [m] of where its feet stand.
    """

    place: tuple[float, float, float] | None = None
    airtime: float | None = None
    within: float | None = None
    slow: float = 1.0
    aims: float = 0.0
    heading: float | None = None
    hop: float | None = None


@dataclass(frozen=True)
class Move:
    """One thing to do.

    seconds: how long; infinite for a path that takes as long as it takes.
    velocity, until: v_f [m/s], ω [rad/s], v_l [m/s] at the beginning and the end, linear between.
    points: x, z [m] to walk along from wherever the character is, instead of `velocity`.
    speed: [m/s] along them. facing: a heading to hold [rad], or None. jump: what it ends with;
    until it can begin, the rest of the move goes on. goal: where to go instead, as it is planned.
    """

    seconds: float
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    until: tuple[float, float, float] | None = None
    points: tuple[tuple[float, float], ...] = ()
    speed: float = 1.2
    facing: float | None = None
    jump: Jump | None = None
    goal: Goal | None = None

    @property
    def runs(self) -> bool:
        """Whether it goes somewhere by foot."""
        return bool(self.points) or any(self.velocity)


@dataclass(frozen=True, eq=False)
class Script:
    """Where somebody is in a list of moves.

    steps: made of the current move. path, progress: along it. asked: for how many steps its jump was
    asked for; aimed: for how many it was aimed at; jumped: whether it began. strikes: after how many steps of the script what strikes; made: those it has made.
    refused: why jumps were not made and places not reached, so far.
    hops: x, z [m] where its hop lands, and the heading [rad] that it keeps; hopped: of the hop before, None where there was none.
    """

    moves: tuple[Move, ...]
    index: int = 0
    strikes: tuple[tuple[int, Strike], ...] = ()
    made: int = 0
    steps: int = 0
    path: Path | None = None
    progress: float = 0.0
    asked: int = 0
    aimed: int = 0
    jumped: bool = False
    refused: tuple[str, ...] = ()
    hops: tuple[float, float, float] | None = None
    hopped: tuple[float, float, float] | None = None

    @property
    def done(self) -> bool:
        """Whether every move is over."""
        return self.index >= len(self.moves)

    @property
    def leaps(self) -> bool:
        """Whether its move ends with a jump: its run-up may go at what it leaps onto."""
        return not self.done and self.moves[self.index].jump is not None

    def step(self, state: CharacterState, dt: float) -> tuple[Script, Intent]:
        """The script `dt` seconds later, what it asks of a character in `state` meanwhile, and what strikes him."""
        hit = next((strike for number, strike in self.strikes if number == self.made), None)
        script, intent = replace(self, made=self.made + 1)._wished(state, dt)
        return script, intent if hit is None else but(intent, strike=hit)

    def _wished(self, state: CharacterState, dt: float) -> tuple[Script, Intent]:
        """The script `dt` seconds later, and what it asks of a character in `state` meanwhile."""
        script = self
        while not script.done and script._over(state, dt):
            script = script._next(state)
        if script.done:
            return script, Intent()
        move = script.moves[script.index]
        if move.points and script.steps == 0:
            script = replace(script, path=_from_here(state.ground, move.points))
        script, intent = script._ask(move, state, dt)
        if move.jump is not None:
            script, intent = script._ask_jump(move, move.jump, state, intent, dt)
        return replace(script, steps=script.steps + 1), intent

    def wished(self, state: CharacterState) -> np.ndarray | None:
        """The velocity (2,) [m/s] along x and z that its move along a path would have in the world, however its walker is turned; None of others."""
        if self.done or self.path is None or self.moves[self.index].facing is not None:
            return None
        return follow(self.path, state.ground, np.float64(self.progress), self.moves[self.index].speed)[0]

    def _next(self, state: CharacterState) -> Script:
        """The beginning of the next move."""
        jump, refused = self.moves[self.index].jump, self.refused
        if jump is not None and not self.jumped:
            where = "up" if jump.place is None else "to ({:g}, {:g}, {:g})".format(*jump.place)
            why = state.refused or "it never came to where it could jump from"
            refused = (*refused, f"no jump {where}: {why}")
        goal, way = self.moves[self.index].goal, _way(self.moves[self.index], state)
        if goal is not None and way is not None and way.reason:
            refused = (*refused, "no way to ({:g}, {:g}): {}".format(*goal.place, way.reason))
        hopped = self.hops if self.jumped else None
        return Script(self.moves, self.index + 1, self.strikes, self.made, refused=refused, hopped=hopped)

    def _over(self, state: CharacterState, dt: float) -> bool:
        move = self.moves[self.index]
        now = jumping(state)
        if move.jump is not None and self.jumped:
            return now is None or now.landed
        if self.steps * dt >= move.seconds - 0.5 * dt:
            return True
        if move.jump is not None and not move.runs:
            return self.asked * dt > PATIENCE and (now is None or now.landed)
        way = _way(move, state)
        if way is not None:
            return self.steps > 0 and way.kind != "running"
        if move.points:
            return self.steps > 0 and (self.path is None or self.progress >= self.path.length - ARRIVED)
        return False

    def _ask(self, move: Move, state: CharacterState, dt: float) -> tuple[Script, Intent]:
        if move.goal is not None:
            return self, Intent(goal=move.goal)
        if not move.points:
            if move.facing is not None:
                return self, steer(state.ground, np.zeros(2), move.facing, state.velocity[1], STEERING)
            velocity = np.array(move.velocity)
            if move.until is not None:
                velocity = velocity + (np.array(move.until) - velocity) * min(self.steps * dt / move.seconds, 1.0)
            return self, Intent(velocity)
        wish, progress = np.zeros(2), self.progress
        if self.path is not None:
            wish, progress = follow(self.path, state.ground, np.float64(progress), move.speed, brake=BRAKE)
        facing = move.facing
        if self.path is not None and facing is None and self.path.length - progress < FEW and np.hypot(state.velocity[0], state.velocity[2]) < SLOW:
            way = math.atan2(*wish)
            if abs(math.remainder(way - float(state.ground[2]), math.tau)) > TURNS:  # nobody turns in a stride or two
                wish, facing = np.zeros(2), way
        intent = steer(state.ground, wish, facing, state.velocity[1], STEERING)
        if self.path is not None and move.jump is None:
            intent = but(intent, halt=np.array([*self.path.points[-1], math.nan if move.facing is None else move.facing]))
        return replace(self, progress=float(progress)), intent

    def _ask_jump(self, move: Move, jump: Jump, state: CharacterState, intent: Intent, dt: float) -> tuple[Script, Intent]:
        """The same with the jump, once it is time for it: near enough at a run, turned to it, and aimed, at rest."""
        now = jumping(state)
        if self.jumped or now is not None and not now.landed:  # one that has landed gets up for the next
            return replace(self, jumped=True), Intent()
        place, onward = np.array([state.ground[0], float(state.floor), state.ground[1]] if jump.place is None else jump.place), jump.place
        if jump.hop is not None:
            before = self.hopped or (state.ground[0], state.ground[1], float(state.ground[2]))
            place = onward = np.array([before[0] + jump.hop * math.sin(before[2]), float(state.floor), before[1] + jump.hop * math.cos(before[2])])
        way = place[[0, 2]] - state.ground[:2]
        far = float(np.hypot(*way))
        if move.runs:
            speed = float(np.hypot(state.velocity[0], state.velocity[2]))
            ready = far <= (AHEAD[0] + AHEAD[1] * speed * jump.slow if jump.within is None else jump.within)
        elif far > NEAR and jump.heading is None:
            heading = math.atan2(*way)
            intent = steer(state.ground, np.zeros(2), heading, state.velocity[1], STEERING)
            ready = abs(math.remainder(heading - float(state.ground[2]), math.tau)) < ASKEW
        else:
            ready = True
        if not ready:
            return self, intent
        leap = Leap(None if onward is None else place, jump.airtime, heading=jump.heading)
        if not move.runs and self.aimed * dt < jump.aims - 0.5 * dt:
            return replace(self, aimed=self.aimed + 1), replace(intent, aim=leap)
        hops = None if jump.hop is None else (float(place[0]), float(place[2]), float(state.ground[2]) if self.hopped is None else self.hopped[2])
        return replace(self, asked=self.asked + 1, hops=hops), replace(intent, leap=leap)


def jumping(state: CharacterState) -> Any:
    """What somebody who jumps remembers of it; None for everybody else, and for who crouches first."""
    memory = state.memory.memory if state.active == "jump" else None
    return memory if isinstance(memory, Jumping) else None


def _way(move: Move, state: CharacterState) -> Status | None:
    """How the walk to a move's goal stands; None where that is not what it is about."""
    return state.going.status if move.goal is not None and state.going is not None and state.going.goal == move.goal else None


def _from_here(ground: np.ndarray, points) -> Path | None:
    """The path from where a character stands through points; None if it stands on the only one."""
    way = [tuple(ground[:2])]
    for point in points:
        if math.dist(point, way[-1]) > 1e-3:
            way.append(point)
    return Path(np.array(way)) if len(way) > 1 else None


def leaving(state: CharacterState) -> bool:
    """Whether somebody has begun a jump and is about to leave the floor."""
    made = jumping(state)
    return made is not None and made.time <= made.plan.take_off


def aloft(state: CharacterState) -> bool:
    """Whether somebody flies."""
    made = jumping(state)
    return made is not None and made.plan.take_off < made.time < made.plan.touch_down


def landing(jump: Any, state: CharacterState) -> CharacterState:
    """The state of somebody who jumps as he will stand once he has landed on both feet; of everybody else as it is."""
    made = jumping(state)
    return state if made is None else replace(jump.landing(replace(state, memory=made)), memory=state.memory)
