"""How a move is made: what it asks for in every step, and when it is over."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from gambol.controllers.contract import CharacterState, Intent, Leap, Status, but
from gambol.controllers.jump import MOMENTARY, Jumping, walks_to
from gambol.controllers.navigation import Path, floor_at, follow, in_world, steer

from .aside import ANEW, FAST, NEAREST, STOPS, UNDER_WAY, Known, bent, beside, lands, room
from .moves import Jump, Move
from .pilot import STEERING
from .run_up import RunUp
from .stances import Stand

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
"""So long [s] a jump that can't be made from a stand is asked for, once he stands who still ran ..."""
LONGER = 2.0
"""... and by who has just come to rest for it: until his last foot is beside the other."""
PASSED = 0.12
"""A place farther behind than this [m] a run-up has gone past."""
HOPS_UP = 0.4
"""What is higher over the ground than this [m] is hopped against, not onto."""
LAST, BENDS = 0.3, 1.25
"""So near to its end along a path [m], and where that is no longer by more than this factor than straight, somebody goes there to come to rest."""
STANDS, STILL = 5.0, 0.1
"""Who has stood for so long [s], no faster than this [m/s], on his way along a path will hardly get on: it is told, and who ran up to a jump gives it up."""
STRAIGHT, SIDES = 1.1, 2.0
"""Who has no farther to go along a path than so many times as far as straight may turn to where he jumps; and who goes straight on by so much more ahead than aside: who strafes or backs up was told to."""
AHEAD = 0.85, 0.5
"""A runner asks for its jump this near to the landing: at no speed [m], and for each m/s [s]."""
STRIDE = 0.8
"""And a walker so much farther off [m]: he chooses among his next footfalls."""

LATE = 0.45
"""Who runs, and would be there within this [s], leaps there no more: no foot brakes so much."""
BRAKES = 2.5
"""Who would come to rest, braking so hard [m/s²], no farther from the place than from where he can leap to it does; who would be farther turns back at a walk."""
BEYOND, EACH, HIGHEST, EVEN = 2.0, 0.2, 2.0, 0.06
"""Who turns back to a place finds even floor as far as the first before and behind [m], looked at so often [m]: nothing up to the third is higher than the fourth, or lower [m]."""


@dataclass(frozen=True, eq=False)
class Making:
    """How far somebody is with a move.

    steps: made of it. path, progress: along it. asked: for how many steps its jump was asked for, of one from a stand not while it still landed or ran; aimed:
    for how many it was aimed at; jumped: whether it began. passed: whether what its run-up leads to lies behind for good. hops: x, z [m] where its hop
    lands, and the heading [rad] that it keeps; hopped: of the hop before, None where there was none. run_up: what it knows of its run-up. stood: for how
    many steps somebody has stood on his way. why: what last kept him from leaping off a foot that was under him. aside: what is known of a leap to a place beside his way;
    turns: whether he turns to one. stand: from where he leaps once he comes to rest; None before.
    """

    steps: int = 0
    path: Path | None = None
    progress: float = 0.0
    asked: int = 0
    aimed: int = 0
    jumped: bool = False
    passed: bool = False
    hops: tuple[float, float, float] | None = None
    hopped: tuple[float, float, float] | None = None
    run_up: RunUp = RunUp()
    stood: int = 0
    why: str = ""
    aside: Known = Known()
    turns: bool = False
    stand: Stand | None = None

    def step(self, move: Move, state: CharacterState, dt: float) -> tuple[Making, Intent]:
        """The same `dt` seconds later, and what is asked of a character in `state` meanwhile."""
        now = replace(self, path=_from_here(state.ground, move.points)) if move.points and self.steps == 0 else self
        now, intent = now._ask(move, state, dt)
        if move.jump is not None:
            now, intent = now._ask_jump(move, move.jump, state, intent, dt)
            if now.asked and state.refused and state.refused not in MOMENTARY:
                now = replace(now, why=state.refused)
        stands = now.path is not None and not now.jumped and _still(state)
        return replace(now, steps=now.steps + 1, stood=now.stood + 1 if stands else 0), intent

    @property
    def rests(self) -> bool:
        """Whether somebody comes to rest on his run-up, to leap from there."""
        return self.aside.stops or self.run_up.halt is not None

    def fails(self, state: CharacterState, dt: float) -> bool:
        """Whether somebody who has come to rest can't leap from there."""
        return self.asked * dt > PATIENCE and jumping(state) is None and bool(state.refused) and state.refused not in MOMENTARY

    def stuck(self, dt: float) -> bool:
        """Whether that is to be told now: once, of every stand."""
        return self.stood == math.ceil(STANDS / dt)

    def over(self, move: Move, state: CharacterState, dt: float) -> bool:
        """Whether it is done, or has been asked for long enough."""
        now = jumping(state)
        if move.jump is not None and self.jumped:
            return now is None or now.landed
        if self.stand is not None and self.stand.goes:
            return False
        if self.passed or not self.aside.stops and self.steps * dt >= move.seconds - 0.5 * dt:
            return True
        if move.jump is not None and (self.aside.stops or not move.runs):
            if self.aside.stops and -self.aside.steps >= math.ceil(STANDS / dt):
                return True
            return self.asked * dt > (LONGER if self.aside.stops else PATIENCE) and (now is None or now.landed)
        if move.jump is not None and self.stood >= math.ceil(STANDS / dt):
            return True
        way = way_of(move, state)
        if way is not None:
            return self.steps > 0 and way.kind != "running"
        if move.points:
            return self.steps > 0 and (self.path is None or self.progress >= self.path.length - ARRIVED)
        return False

    def _ask(self, move: Move, state: CharacterState, dt: float) -> tuple[Making, Intent]:
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
        if self.path is not None and move.jump is None and facing is None and self.path.length - progress < FEW and np.hypot(state.velocity[0], state.velocity[2]) < SLOW:
            way = math.atan2(*wish)
            if abs(math.remainder(way - float(state.ground[2]), math.tau)) > TURNS:  # nobody turns in a stride or two
                wish, facing = np.zeros(2), way
        intent = steer(state.ground, wish, facing, state.velocity[1], STEERING)
        if self.path is not None and move.jump is None and self.path.length - progress < LAST + BENDS * math.dist(self.path.points[-1], state.ground[:2]):
            intent = but(intent, halt=np.array([*self.path.points[-1], math.nan if move.facing is None else move.facing]))
        return replace(self, progress=float(progress)), intent

    def _ask_jump(self, move: Move, jump: Jump, state: CharacterState, intent: Intent, dt: float) -> tuple[Making, Intent]:
        """The same with the jump, once it is time for it: near enough at a run, turned to it, and aimed, at rest."""
        now = jumping(state)
        if self.jumped or now is not None and not now.landed:  # one that has landed gets up for the next
            return replace(self, jumped=True), Intent()
        place, onward = np.array([state.ground[0], float(state.floor), state.ground[1]] if jump.place is None else jump.place), jump.place
        if jump.hop is not None:
            before = self.hopped or (state.ground[0], state.ground[1], float(state.ground[2]))
            x, z = float(before[0] + jump.hop * math.sin(before[2])), float(before[1] + jump.hop * math.cos(before[2]))
            place = onward = np.array([x, floor_at(x, z, jump.around, float(state.floor) + HOPS_UP), z])
        way = place[[0, 2]] - state.ground[:2]
        far = float(np.hypot(*way))
        leap = Leap(None if onward is None else place, jump.airtime, heading=jump.heading, on=jump.on)
        led, waits = (None, False) if self.stand is None else (self.stand.leads(state), self.stand.holds(state))
        if led is not None and waits:
            return self, led
        intent = intent if led is None else led
        runs = move.runs and not self.aside.stops
        if runs:
            speed, behind = float(np.hypot(state.velocity[0], state.velocity[2])), bool(way @ np.array(in_world(state.ground, intent.velocity)) < -PASSED * _pace(intent))
            if not self.turns and self._back(move, jump, state, far, speed, behind):
                if abs(speed**2 / (2.0 * BRAKES) + (far if behind else -far)) < ANEW:
                    return replace(self, aside=STOPS, turns=True), bent(state, 0.0, way)
                self = replace(self, turns=True)
            if not self.turns and behind:  # no run-up leads back
                return replace(self, passed=self.asked > 0 and _straight(move)), intent
            usual = AHEAD[0] + AHEAD[1] * speed * jump.slow + STRIDE * walks_to(state, leap)
            ready = self.run_up.halt is not None or far <= (usual if jump.within is None else jump.within)
            leads = self._leads(move, jump, far) and (self.turns or beside(state, way)) and state.active == "locomotion" and self.run_up.halt is None
            if leads and (ready or far <= usual + room(state, way, pace_of(move))):
                if far < NEAREST and self.aside.lapsed:
                    return replace(self, aside=STOPS, turns=True), bent(state, 0.0, way)
                self, intent = replace(self, turns=True), bent(state, self.aside.pace or pace_of(move), way)
                leap = replace(leap, heading=lands(state, way)) if beside(state, way) else leap
            ready = ready and (not leads or far > NEAREST)
        elif far > NEAR and jump.heading is None:
            heading = math.atan2(*way)
            intent = steer(state.ground, np.zeros(2), heading, state.velocity[1], STEERING)
            ready = abs(math.remainder(heading - float(state.ground[2]), math.tau)) < ASKEW
        else:
            ready = True
        if waits or not ready:
            aims = runs and state.active == "locomotion" and np.hypot(state.velocity[0], state.velocity[2]) > UNDER_WAY
            return self, replace(intent, aim=leap) if aims else intent
        if not runs and self.aimed * dt < jump.aims - 0.5 * dt:
            return replace(self, aimed=self.aimed + 1), replace(intent, aim=leap)
        hops = None if jump.hop is None else (float(place[0]), float(place[2]), float(state.ground[2]) if self.hopped is None else self.hopped[2])
        return replace(self, asked=self.asked + (runs or now is None and _still(state)), hops=hops), replace(intent, leap=leap)

    def _back(self, move: Move, jump: Jump, state: CharacterState, far: float, speed: float, behind: bool) -> bool:
        """Whether somebody who goes so fast [m/s] on a run-up turns back to a place that lies behind, so far away [m], or that no foot sends him to any more who asked for it: where all is even."""
        late = self.asked > 0 and (behind or speed > FAST and far < LATE * speed)
        if not (late or behind and self.steps == 0 and far > NEAREST) or state.active != "locomotion" or self.run_up.halt is not None or not _straight(move) or not self._leads(move, jump, far):
            return False
        assert jump.place is not None  # or nothing would lead there
        floor, here, there = float(state.floor), np.asarray(state.ground[:2], float), np.array([jump.place[0], jump.place[2]])
        if move.points and math.dist(move.points[-1], there) > NEAREST:
            return False
        ways = [here + far * (there - here) / max(math.dist(here, there), 1e-9) for far in np.arange(-BEYOND, far + BEYOND, EACH)]
        return all(abs(floor_at(float(x), float(z), jump.around, floor + HIGHEST) - floor) < EVEN for x, z in ways) and abs(float(jump.place[1]) - floor) < EVEN

    def _leads(self, move: Move, jump: Jump, far: float) -> bool:
        """Whether somebody on a run-up has only the way left to where his jump leads, so far away [m]: he may turn to it, unless he was told how he lands."""
        if jump.place is None or jump.heading is not None:
            return False
        if self.path is not None:
            return self.path.length - self.progress < STRAIGHT * far
        return _straight(move) and move.velocity[0] > SIDES * abs(move.velocity[2])


def _pace(intent: Intent) -> float:
    """How fast [m/s] somebody is asked to go."""
    return math.hypot(intent.velocity[0], intent.velocity[2])


def _still(state: CharacterState) -> bool:
    """Whether somebody stands, or as good as."""
    return bool(np.hypot(state.velocity[0], state.velocity[2]) < STILL)


def pace_of(move: Move) -> float:
    """How fast [m/s] somebody is to go on a run-up."""
    return move.speed if move.points else math.hypot(move.velocity[0], move.velocity[2])


def _straight(move: Move) -> bool:
    """Whether a run-up leads straight on, so that it never comes to what it has passed."""
    return len(move.points) < 2 and move.velocity[1] == 0.0 and move.until is None


def jumping(state: CharacterState) -> Any:
    """What somebody who jumps remembers of it; None for everybody else, and for who crouches first."""
    memory = state.memory.memory if state.active == "jump" else None
    return memory if isinstance(memory, Jumping) else None


def way_of(move: Move, state: CharacterState) -> Status | None:
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
