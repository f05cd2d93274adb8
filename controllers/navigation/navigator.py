"""Walking to a goal: a plan is made, followed, and made anew where it no longer holds.

What is remembered of it is a value, `Going`, in the character's state: the same states and intents give the same walks, to the bit.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..body import wrap
from ..contract import CharacterState, Controller, Goal, Intent, Status
from .goal import arrived, wish
from .obstacles import SHOULDER

if TYPE_CHECKING:  # who never goes to a goal loads no planner
    from .planning import Plan

SHARE = 0.9
"""Plans keep to this share of what is walked: what is left serves to catch up."""
OFF = 0.3, 1.0
"""Who is so far off his plan [m, rad] plans anew."""
STILL = 0.01
"""Who moves no faster than this [m/s, rad/s] stands."""
STOOD = 0.2
"""Who has stood at the goal for so long [s] has arrived."""
STAYS = 0.028, math.radians(2.8)
"""Who has arrived has done so as long as he is so near to the goal [m, rad]; else a step brings him back."""
AWAY = 0.1, 0.2
"""Who had arrived and is now so far from his goal [m, rad] goes there again."""
NEARER = 0.1
"""A new plan is worth something where the walker came so much nearer to the goal since the last [m]."""
HELD_UP = 4
"""After so many plans in a row that were worth nothing he is held up."""
LATE = 4.0
"""Who has not arrived so long after his plan's end [s] plans anew."""
QUICKER = 4
"""So often a quicker plan is sought for who has to be there within some time."""


@dataclass(frozen=True, eq=False)
class Going:
    """How somebody walks to a goal.

    goal: as it was asked for. plan: the way, and `time` how far he is in it [s]. heading: how he is to stand there [rad]. around, floor:
    what stood about as it was planned, and how high the floor lay [m]. spent: since the goal was asked for [s]. stood: for how long he has stood at the goal [s].
    left: how far he was from the goal as it was planned [m]. held: so many plans in a row brought him no nearer. plans: how many were made.
    """

    goal: Goal
    plan: Plan
    heading: float
    around: Sequence[Any]
    floor: float
    time: float = 0.0
    spent: float = 0.0
    stood: float = 0.0
    left: float = math.inf
    held: int = 0
    plans: int = 1

    @property
    def there(self) -> bool:
        """Whether he has arrived, and stands."""
        return self.stood > STOOD

    @property
    def status(self) -> Status:
        """Running; done at the goal; failed, with the plan's reason."""
        if self.plan.reason:
            return Status("failed", self.plan.reason)
        return Status("done" if self.there else "running")


def going(state: CharacterState, intent: Intent, walker: Controller, walks: bool, dt: float) -> tuple[Going | None, Intent]:
    """How the walk to intent.goal goes on, and what to ask of the walker for it: the same intent with the velocity to wish for.

    walker: by whose limits plans are made, and with whose readiness, while he sets off, their time runs. walks: whether he walks now; who jumps
    doesn't, and goes on afterwards. dt: the step that is to be made [s].
    """
    goal = intent.goal
    now: Going | None = state.going
    if goal is None:
        return None, intent
    if not walks:
        return now, replace(intent, velocity=np.zeros(3))
    if now is None or now.goal != goal:
        now = _begun(state, intent, goal, walker.limits(SHARE), now)
    elif _changed(now, intent.around, float(state.floor)):
        now = _again(now, state, intent, walker.limits(SHARE), anew=True)
    elif not now.plan.reason and _astray(now, state):
        now = _again(now, state, intent, walker.limits(SHARE))
    near = _within(now, state, STAYS) if now.there else bool(np.abs(state.velocity).max() < STILL) and arrived(now.plan, now.time, state.ground)
    now = replace(now, stood=now.stood + dt if near and not now.plan.reason else 0.0)
    velocity = np.zeros(3) if now.there else wish(now.plan, now.time, state.ground, state.velocity)
    return replace(now, time=now.time + dt * float(walker.readiness(state)), spent=now.spent + dt), replace(intent, velocity=velocity)


def _changed(now: Going, around: Sequence[Any], floor: float) -> bool:
    """Whether other things stand in the way than when it was planned."""
    if around is now.around and abs(floor - now.floor) < 1e-3:
        return False
    from .routes import shapes_of

    return not np.array_equal(shapes_of(around, floor), shapes_of(now.around, now.floor))


def _astray(now: Going, state: CharacterState) -> bool:
    """Whether the walker is where the plan does not have him, or comes to no end."""
    if now.there:
        return not _within(now, state, AWAY)
    off = now.plan.at(now.time)[0] - state.ground
    return math.hypot(off[0], off[1]) > OFF[0] or abs(float(wrap(off[2]))) > OFF[1] or now.time > now.plan.seconds + LATE


def _within(now: Going, state: CharacterState, near: tuple[float, float]) -> bool:
    """Whether he is so near to the goal [m, rad]."""
    off = now.plan.goal - state.ground
    return math.hypot(off[0], off[1]) <= near[0] and abs(float(wrap(off[2]))) <= near[1]


def _begun(state: CharacterState, intent: Intent, goal: Goal, planes: np.ndarray | None, before: Going | None) -> Going:
    """The walk to a new goal."""
    floor = float(state.floor)
    if planes is None:
        from .planning import Plan

        none = Plan.none(state.ground, np.array([*goal.floor, state.ground[2]]), "nobody here walks")
        return Going(goal, none, float(state.ground[2]), intent.around, floor)
    heading = _arrival(state.ground, goal.floor, intent.around, floor) if goal.heading is None else goal.heading
    made = _planned(state, np.array([*goal.floor, heading]), intent.around, planes, goal.within, True)
    return Going(goal, made, heading, intent.around, floor, left=_left(state, made), plans=1 if before is None else before.plans + 1)


def _again(now: Going, state: CharacterState, intent: Intent, planes: np.ndarray | None, anew: bool = False) -> Going:
    """Another plan to the same goal. anew: something else stands about, so that what was tried before counts for nothing."""
    from .planning import Plan

    assert planes is not None  # he walked
    goal, left = np.array([*now.goal.floor, now.heading]), _left(state, now.plan)
    held = 0 if anew or now.there or left < now.left - NEARER else now.held + 1
    if held >= HELD_UP:
        made = Plan.none(state.ground, goal, f"held up {left:.2f} m before the goal")
    else:
        within = None if now.goal.within is None else max(now.goal.within - now.spent, 0.1)
        made = _planned(state, goal, intent.around, planes, within, False)
    return Going(now.goal, made, now.heading, intent.around, float(state.floor), spent=now.spent, left=left, held=held, plans=now.plans + 1)


def _left(state: CharacterState, made: Plan) -> float:
    return float(np.hypot(*(made.goal - state.ground)[:2]))


def _arrival(ground: np.ndarray, place: np.ndarray, around: Sequence[Any], floor: float) -> float:
    """The heading [rad] with which the shortest way arrives; the walker's own where he is there already."""
    from .routes import shapes_of, ways

    shapes = shapes_of(around, floor)
    found = ways(np.asarray(ground[:2], float), place, shapes, SHOULDER) if len(shapes) else []
    last = place - (found[0][-2] if found else ground[:2])
    return float(ground[2]) if math.hypot(*last) < NEARER else math.atan2(*last)


def _planned(state: CharacterState, goal: np.ndarray, around: Sequence[Any], planes: np.ndarray, within: float | None, strictly: bool) -> Plan:
    """The plan from where and how the walker moves, within the time [s], or, unless strictly, the quickest."""
    from .planning import HUMAN, Plan, plan

    floor = float(state.floor)
    across = planes[:, :3] @ state.velocity
    share = np.min(-planes[:, 3] / np.maximum(across, 1e-9), initial=1.0, where=across > 1e-9)  # who runs has to slow down first
    moving = max(min(float(share), 1.0), 0.0) * np.asarray(state.velocity, float)
    weights = HUMAN
    made = plan(state.ground, goal, moving, weights, planes, around, floor=floor)
    if made.reason and np.abs(moving).max() > 1e-3:  # he has to stand first
        moving = np.zeros(3)
        made = plan(state.ground, goal, moving, weights, planes, around, floor=floor)
    for _ in range(QUICKER):
        if made.reason or within is None or made.seconds <= within:
            return made
        faster = (0.95 * within / made.seconds) ** 4
        weights = weights._replace(forward=faster * weights.forward, turning=faster * weights.turning, lateral=faster * weights.lateral)
        quicker = plan(state.ground, goal, moving, weights, planes, around, floor=floor)
        made = made if quicker.reason or quicker.seconds > made.seconds else quicker
    if within is not None and made.seconds > within and strictly:
        return Plan.none(state.ground, goal, f"it takes {made.seconds:.1f} s, {within:.1f} s are given")
    return made
