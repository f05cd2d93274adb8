"""Places aside: who is to leap to a place beside his way turns to it with the steps that are left, and leaps along the line to it, slower where he must; where he would come past it he comes to
rest, turns to it and leaps from there."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from gambol.controllers.contract import CharacterState, Intent, but
from gambol.controllers.jump import Jumping
from gambol.controllers.navigation import in_world, steer

from .pilot import STEERING

BESIDE = 0.1, 0.1
"""A place lies aside of his way who goes past it by more than these [rad, m]."""
ASKS = 0.4
"""Who goes leaps to no place that lies farther aside of how he goes than this [rad]: he turns to it first, and in the air by what is left."""
NEAREST = 0.4
"""And to none that is nearer than this [m], which he walks over: he would hop on the spot."""
GOES = 0.3
"""Who is slower than this [m/s] goes no way but that which he faces."""
GRID = 0.1
"""The heading in which he lands lies on so coarse a grid [rad], lest another leap be asked in each step that he turns."""
ROOM = 0.25, 1.2
"""He begins to turn as much sooner as he goes in the first [s], and in the time that turning as fast as the second takes [rad/s]."""
PASSES = 0.9, 2.5
"""Who has it farther aside than the first [rad] turns to it as soon as he could be there within the second [s] and a leap: else he would pass it."""
SHARES, WALKS, RUNS = (1.0, 0.9, 0.8, 1.1), (1.3, 1.1), 1.6
"""He goes to it as fast as he does, or so many times as fast, or, if he is faster than the third [m/s], at a walk [m/s]; or leaps at once, and turns in the air: whichever leads him off soonest."""
SOON, LATER, ENOUGH = 0.36, 0.8, 1.1
"""Who leaps in stride is in the air in so much time [s], at standard height; another leap is taken as if it went off so much later [s]. What goes off in stride within the third [s] will do."""
TURNS = 0.75
"""He turns no farther in the air than this [rad]."""
AHEAD, LATE = (1.0, 0.7, 4.0), 10
"""That is played ahead for so long as he goes there, by these [s, m/s], at most the last [s]; a leap that has not gone off so many steps later is found out about anew."""


class Known(NamedTuple):
    """What is known of a leap to a place aside. pace: how fast he goes to it [m/s], 0 for as he does; steps: for so many steps it is known, −1 before it was found out; stops: he comes to rest, as he
    can't leap as he goes; once: he leaps as soon as he can, however far aside it lies."""

    pace: float = 0.0
    steps: int = -1
    stops: bool = False
    once: bool = False


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


def found(leaps: Callable[[Known], tuple[int, float]], pace: float, dt: float) -> Known:
    """What comes of it, of who goes so fast [m/s]. leaps: tells of what may be known after how many steps of dt [s] the leap goes off, 0 where it never does, and for how long [s] he pushes then, longer
    where he can't go on from where he lands."""
    best, soonest = Known(stops=True), math.inf
    for known in (Known(pace, 0, once=True), *(Known(share * pace, 0) for share in SHARES), *(Known(walk, 0) for walk in WALKS if pace > RUNS)):
        steps, pushes = leaps(known)
        if steps and steps * dt + pushes < soonest:
            best, soonest = known._replace(steps=steps + LATE), steps * dt + pushes
        if soonest < ENOUGH:
            break
    return best


def goes_off(controller: Any, state: CharacterState, asks: Callable[[CharacterState], Intent], around: Sequence[Any], dt: float, seconds: float) -> tuple[int, float]:
    """After how many steps of dt [s] the leap goes off of who does what he is asked for so long [s], 0 where it never does; and for how long [s] he pushes then, LATER more where that is not in stride."""
    for number in range(round(seconds / dt)):
        state, _ = controller.step(state, but(asks(state), around=around), dt)
        memory = state.memory.memory if state.active == "jump" else None
        if isinstance(memory, Jumping):
            made = memory.plan
            strides = made.take_off < SOON * math.sqrt(controller.size) and made.path.lands is not None
            return (0, 0.0) if memory.fault else (number + 1, made.take_off + LATER * (not strides))
    return 0, 0.0
