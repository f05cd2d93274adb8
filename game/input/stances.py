"""Where to stand for a leap from rest: who can't leap as he comes goes to where he can off both feet, nearer, farther back or round what he leaps onto, and leaps from there.

That is thought of beside the steps, while he comes to rest.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from gambol.controllers.contract import CharacterState, Intent, Leap
from gambol.controllers.jump import Pieces, Spread, priced
from gambol.controllers.navigation import STEP, Path, floor_at, follow, in_world, room, steer

from .pilot import STEERING
from .straight_ahead import lacking

BEARINGS = 0.0, 0.25, -0.25, 0.5, -0.5, 0.75, -0.75
"""He goes so far round the place [rad] from where he comes to rest."""
APART, NEAREST, FARTHEST = 0.1, 0.5, 1.9
"""So far from it he may stand [m], at standard height: from the second to the third, by the first."""
EASY, EFFORT = 1.1, 2.0
"""Farther from it than this [m], at standard height, each metre that he leaps is worth so many that he goes."""
SPARE = 0.06
"""He stands so much farther [m], at standard height, from what he leaps onto than he would have to, as he won't stand there to the inch."""
AHEAD = 0.2
"""What lies no farther aside than this [rad] lies ahead."""
SLOW = 0.3
"""Who is slower than this [m/s] has all but come to rest."""
LEVEL = 0.04
"""Where he stands and goes no floor is higher or lower than this [m]."""
ASKS, TRIES = 10, 3
"""It is found out of so many places at most whether he can leap from there, and so often he looks for one."""
PLAN, EACH = 4, 8
"""A plan is so many pieces, of which a step works out so many."""
BRAKES = 2.5
"""He comes to rest braking so hard [m/s²]."""
PACE, FADES = 1.0, 0.3
"""He goes there so fast at most [m/s], and his pace fades over the last of it [m]."""
SIDES = 0.6
"""He faces where he goes only if that is farther than this [m]: else he steps there as he will stand."""
THERE, RESTS, TURNED, LONG = 0.06, 0.08, 0.12, 5.0
"""He is there who is no farther from it than this [m], no faster than this [m/s, rad/s] and turned no farther from it than this [rad], or has gone for so long [s]."""

Place = tuple[float, float, float]
"""x, z [m] and heading [rad]."""


@dataclass(frozen=True, eq=False)
class Stand:
    """From where somebody leaps who comes to rest. at: there; None where he knows none. rests: where he comes to rest meanwhile; None: as soon as he can. thought: what comes of thinking of it, None once
    that is known; steps: for how many he has thought, or gone there. there: whether he has come there. tried: where he thought before that he could."""

    rests: Place | None = None
    thought: Spread[Place | None] | None = None
    at: Place | None = None
    steps: int = 0
    there: bool = False
    tried: tuple[Place, ...] = ()

    @property
    def goes(self) -> bool:
        """Whether he goes there."""
        return self.at is not None and not self.there

    def holds(self, state: CharacterState) -> bool:
        """Whether somebody does not leap yet: he goes there, or has come to rest and thinks."""
        return self.goes or self.thought is not None and slow(state)

    @property
    def again(self) -> bool:
        """Whether he who can't leap from where he thought that he could looks for another place."""
        return self.there and len(self.tried) < TRIES

    def after(self, state: CharacterState, dt: float) -> Stand:
        """The same a step later."""
        if self.thought is not None:
            found = self.thought.after(self.steps + 1)
            if isinstance(found, str) or found is not None and not slow(state):  # he brakes first, as he must
                return replace(self, steps=self.steps + 1)
            return replace(self, thought=None, at=found, steps=0)
        if self.at is None or self.there:
            return self
        far, turned = math.dist(self.at[:2], state.ground[:2]), abs(math.remainder(self.at[2] - float(state.ground[2]), math.tau))
        rests = far < THERE and turned < TURNED and float(np.abs(state.velocity).max()) < RESTS
        return replace(self, steps=self.steps + 1, there=rests or self.steps * dt > LONG)

    def leads(self, state: CharacterState) -> Intent | None:
        """What somebody wants who goes there, or to where he comes to rest first; None where nothing leads him, or he has gone past that."""
        at = self.at or self.rests
        if at is None or self.there:
            return None
        here = np.asarray(state.ground[:2], float)
        far, pace = math.dist(at[:2], here), max(PACE, math.hypot(state.velocity[0], state.velocity[2]))
        x, z = np.array(at[:2]) - here
        off = abs(math.remainder(math.atan2(x, z) - float(state.ground[2]), math.tau))
        if self.at is None and (off < AHEAD or slow(state)) or not slow(state) and off > 0.5 * math.pi:  # he brakes before what is ahead by himself
            return None
        wish = follow(Path(np.array([here, at[:2]])), state.ground, np.float64(0.0), pace, brake=FADES)[0] if far > THERE else np.zeros(2)
        return replace(steer(state.ground, wish, None if far > SIDES else at[2], state.velocity[1], STEERING), halt=np.array(at))


def slow(state: CharacterState) -> bool:
    """Whether somebody has all but come to rest."""
    return math.hypot(state.velocity[0], state.velocity[2]) < SLOW


def stand_for(controller: Any, state: CharacterState, leap: Leap, around: Sequence[Any], halt: Sequence[float] | None, tried: tuple[Place, ...] = ()) -> Stand:
    """What somebody begins to think of, who comes to rest and is to leap to `leap.place`. halt: x, z [m] where he comes to rest; None: as soon as he can."""
    if halt is None:
        velocity = np.array(in_world(state.ground, state.velocity))
        rests = np.asarray(state.ground[:2], float) + velocity * float(np.hypot(*velocity)) / (2.0 * BRAKES)
    else:
        rests = np.asarray(halt, float)
    x, z = np.asarray(leap.place, float)[[0, 2]] - rests
    meanwhile = None if halt is None else (float(rests[0]), float(rests[1]), math.atan2(x, z))
    return Stand(meanwhile, Spread(_found(controller, state, leap, around, rests, tried), EACH), tried=tried)


def _found(controller: Any, state: CharacterState, leap: Leap, around: Sequence[Any], rests: np.ndarray, tried: tuple[Place, ...]) -> Pieces[Place | None]:
    """Where to go, in pieces; None: he can from where he comes to rest, or from nowhere."""
    floor, count = float(state.floor), 0
    for at in _places(controller.size, rests, leap, floor, around):
        if any(math.dist(at[:2], other[:2]) < 0.9 * APART for other in tried):
            continue
        made = yield from priced(controller.looks(controller.start(at, floor), Intent(leap=leap, around=around)), PLAN)
        if made is not None and not isinstance(made, str):
            return at if math.dist(at[:2], rests) > THERE else None
        count += 1
        if count == ASKS:
            break
    return None


def _places(size: float, rests: np.ndarray, leap: Leap, floor: float, around: Sequence[Any]) -> Iterator[Place]:
    """Where he may stand, and how he faces, the best first."""
    place = np.asarray(leap.place, float)[[0, 2]]
    back = rests - place
    far = float(np.hypot(*back))
    found: list[tuple[float, Place]] = []
    for bearing in BEARINGS:
        angle = math.atan2(*back) + bearing
        out = np.array([math.sin(angle), math.cos(angle)])
        heading = math.remainder(angle + math.pi, math.tau)
        for d, spare in [(far, 0.0)] * (bearing == 0.0) + [(d, SPARE) for d in np.arange(NEAREST, FARTHEST, APART) * size]:
            at = place + d * out
            if _free(at, rests, floor, around) and lacking(at, -out, floor, around, size, d, spare) <= 0.0:
                found.append((math.dist(at, rests) + EFFORT * max(d - EASY * size, 0.0), (float(at[0]), float(at[1]), heading)))
    return (at for _, at in sorted(found))


def _free(at: np.ndarray, rests: np.ndarray, floor: float, around: Sequence[Any]) -> bool:
    """Whether somebody can go from where he comes to rest to a place (2,), and stand there."""
    count = 1 + math.ceil(math.dist(at, rests) / APART)
    ways = rests + np.linspace(0.0, 1.0, count + 1)[1:, None] * (at - rests)
    return all(abs(floor_at(float(x), float(z), around, floor + STEP) - floor) < LEVEL for x, z in ways) and all(room(way, floor, around) > 0.0 for way in ways)
