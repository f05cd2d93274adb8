"""Walking to a goal: a plan is made, followed, and made anew where it no longer holds; where no walk leads on, he walks to a leap, and leaps.

What is remembered of it is a value, `Going`, in the character's state: the same states and intents give the same walks, to the bit.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..body import wrap
from ..contract import CharacterState, Controller, Goal, Intent, Leap, Status
from .goal import arrived, progress, wish
from .levels import SOON, Crossing, Leg, levels_of, named, next_leg, onto, runs, take_off
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
PATIENCE = 45.0
"""Who has come no nearer to the goal for so long [s] because of others gives up."""
KEPT = 0.9
"""Who goes on by less than this share of what he wishes for is kept from it by others."""
LATE = 4.0
"""Who has not arrived so long after his plan's end [s] plans anew."""
OFFSET, ASKEW, SLOW = 0.07, 0.1, 0.3
"""Who is so near to where he is to leap from [m], turned to it so far [rad], and no faster than this [m/s], leaps."""
REFUSED = 0.4
"""A leap that can't be made for so long [s] is given up for another way."""
MISSED = 0.5
"""Who lands farther from where he should [m] leaps so no more."""
ONWARD = 0.3
"""Who has landed and has to go on is asked to walk at this speed [m/s], and gets up sooner."""


@dataclass(frozen=True, eq=False)
class Going:
    """How somebody walks to a goal.

    goal: as it was asked for. plan: the walk there, or to where the first of `crossings` is leapt, and `time` how far he is in it [s]. heading: how he
    is to stand at its end [rad]. around: what stood about as it was planned, and stops what of it stops him. spent: since the goal was asked for [s].
    stood: for how long he has stood at the plan's end [s]. left: how far he was from it as it was planned [m]. held: so many plans in a row brought him no nearer. waits: for how
    long others have kept him from coming nearer than he was, `nearest` [m], to the plan's end [s]. plans: how many were made. crossings: the leaps that are left. asked: for how long the first was asked for [s]. leapt: whether somebody else is on duty.
    barred: leaps that he could not make. pace: how fast he walks as he leaps on [m/s]; 0 from a stand. off: after how many steps he leaps,
    once that is known. stands: leaps that he does not make from a walk.
    """

    goal: Goal
    plan: Plan
    heading: float
    around: Sequence[Any]
    stops: Sequence[Any]
    time: float = 0.0
    spent: float = 0.0
    stood: float = 0.0
    left: float = math.inf
    held: int = 0
    waits: float = 0.0
    nearest: float = math.inf
    plans: int = 1
    crossings: tuple[Crossing, ...] = ()
    asked: float = 0.0
    leapt: bool = False
    barred: tuple[tuple[float, ...], ...] = ()
    pace: float = 0.0
    off: int | None = None
    stands: tuple[tuple[float, ...], ...] = ()

    @property
    def there(self) -> bool:
        """Whether he has arrived, and stands."""
        return self.stood > STOOD and not self.crossings

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
        on = ONWARD if now is not None and not now.there and not now.plan.reason else 0.0
        return now if now is None else replace(now, leapt=True), replace(intent, velocity=np.array([on, 0.0, 0.0]))
    if now is None or now.goal != goal:
        now = _begun(state, intent, goal, walker, None if now is None else now.plans)
    elif now.leapt or _changed(now, intent.around):
        now = _onward(now, state, intent, walker)
    elif now.asked > REFUSED:
        now = _onward(replace(now, barred=(*now.barred, named(now.crossings[0]))), state, intent, walker)
    elif now.pace and not now.plan.reason and now.time > now.plan.seconds - SOON:
        now = _looked(now, state, intent, walker, dt)
    elif not now.plan.reason and _astray(now, state):
        now = _again(now, state, intent, walker)
    near = _within(now, state, STAYS) if now.there else bool(np.abs(state.velocity).max() < STILL) and arrived(now.plan, now.time, state.ground)
    now = replace(now, stood=now.stood + dt if near and not now.plan.reason else 0.0)
    velocity = np.zeros(3) if now.there else wish(now.plan, now.time, state.ground, state.velocity)
    share, leap = 1.0, intent.leap
    if intent.aside is not None:
        share, velocity = progress(velocity, velocity + intent.aside), velocity + intent.aside
        now = _kept(now, state, share, dt)
    if now.crossings and leap is None and not now.plan.reason and (now.off == 0 if now.pace else _ready(now, state)):
        leap, now = Leap(onto(now.crossings[0], now.pace)), replace(now, asked=now.asked + dt)
    now = replace(now, time=now.time + share * dt * float(walker.readiness(state)), spent=now.spent + dt)
    return now, replace(intent, velocity=velocity, leap=leap)


def _kept(now: Going, state: CharacterState, share: float, dt: float) -> Going:
    """The same, as others let him go on by a share of what he wishes for."""
    left = _left(state, now.plan)
    if left < now.nearest - NEARER:
        return replace(now, waits=0.0, nearest=left)
    waits = now.waits + dt * (share < KEPT)
    if waits <= PATIENCE or now.plan.reason:
        return replace(now, waits=waits)
    from .planning import Plan

    why = f"others have been in the way for {waits:.0f} s, {left:.2f} m before the {'leap' if now.crossings else 'goal'}"
    return replace(now, waits=waits, plan=Plan.none(state.ground, now.plan.goal, why))


def _looked(now: Going, state: CharacterState, intent: Intent, walker: Controller, dt: float) -> Going:
    """The same near the edge, at which of his steps he leaps; anew, for a leap from a stand, where he leaps at none, or has not leapt at that one."""
    if now.off is not None and now.off > 0:
        return replace(now, off=now.off - 1)
    off = None if now.off == 0 else take_off(walker, state, now.plan, now.time, now.crossings[0], intent, dt)
    return replace(now, off=off) if off is not None else _onward(replace(now, stands=(*now.stands, named(now.crossings[0]))), state, intent, walker)


def _ready(now: Going, state: CharacterState) -> bool:
    """Whether he stands where the next leap goes off, or nearly stands."""
    return _within(now, state, (OFFSET, ASKEW)) and math.hypot(state.velocity[0], state.velocity[2]) < SLOW


def _changed(now: Going, around: Sequence[Any]) -> bool:
    """Whether other things stand in the way than when it was planned."""
    return around is not now.around and levels_of(around) is not levels_of(now.around)


def _onward(now: Going, state: CharacterState, intent: Intent, walker: Controller) -> Going:
    """The way from where he is, after a leap or where something else stands about now."""
    barred = now.barred
    if now.leapt and now.crossings and math.dist(state.ground[:2], onto(now.crossings[0], now.pace)[[0, 2]]) > MISSED:
        barred = (*barred, named(now.crossings[0]))
    return replace(_begun(state, intent, now.goal, walker, now.plans, now.spent, barred, now.stands), spent=now.spent)


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


def _begun(state: CharacterState, intent: Intent, goal: Goal, walker: Controller, plans: int | None, spent: float = 0.0,
           barred: tuple[tuple[float, ...], ...] = (), stands: tuple[tuple[float, ...], ...] = ()) -> Going:
    """The way to a goal, `spent` [s] after it was asked for, as so many plans had been made."""
    from .planning import Plan, plan_in_time

    planes = walker.limits(SHARE)
    if planes is None:
        none = Plan.none(state.ground, np.array([*goal.floor, state.ground[2]]), "nobody here walks")
        return Going(goal, none, float(state.ground[2]), intent.around, intent.around)
    leg = next_leg(walker, state, goal, intent.around, barred)
    heading = _arrival(state, leg) if leg.heading is None else leg.heading
    end = np.array([*leg.place, heading])
    within = None if leg.crossings or goal.within is None else max(goal.within - spent, 0.1)
    pace = runs(leg.crossings[0], state.ground[:2], intent.around, planes) if leg.crossings and named(leg.crossings[0]) not in stands else 0.0
    made = Plan.none(state.ground, end, leg.reason) if leg.reason else plan_in_time(
        state.ground, end, state.velocity, planes, leg.around, float(state.floor), within, not spent, np.array([pace, 0.0, 0.0]))
    return Going(goal, made, heading, intent.around, leg.around, left=_left(state, made), plans=1 if plans is None else plans + 1,
                 crossings=leg.crossings, barred=barred, pace=pace, stands=stands)


def _again(now: Going, state: CharacterState, intent: Intent, walker: Controller) -> Going:
    """Another plan to the same end."""
    from .planning import Plan, plan_in_time

    planes = walker.limits(SHARE)
    assert planes is not None  # he walked
    goal, left = now.plan.goal, _left(state, now.plan)
    goal = np.array([goal[0], goal[1], now.heading])
    held = 0 if now.there or now.waits > 0.0 or left < now.left - NEARER else now.held + 1
    if held >= HELD_UP:
        made = Plan.none(state.ground, goal, f"held up {left:.2f} m before the {'leap' if now.crossings else 'goal'}")
    else:
        within = None if now.goal.within is None or now.crossings else max(now.goal.within - now.spent, 0.1)
        made = plan_in_time(state.ground, goal, state.velocity, planes, now.stops, float(state.floor), within, leaving=np.array([now.pace, 0.0, 0.0]))
    return replace(now, plan=made, time=0.0, stood=0.0, asked=0.0, left=left, held=held, plans=now.plans + 1, off=None)


def _left(state: CharacterState, made: Plan) -> float:
    return float(np.hypot(*(made.goal - state.ground)[:2]))


def _arrival(state: CharacterState, leg: Leg) -> float:
    """The heading [rad] with which the shortest way arrives; the walker's own where he is there already."""
    from .routes import shapes_of, ways

    shapes, here = shapes_of(leg.around, float(state.floor)), np.asarray(state.ground[:2], float)
    found = ways(here, leg.place, shapes, SHOULDER) if len(shapes) else []
    last = leg.place - (found[0][-2] if found else here)
    return float(state.ground[2]) if math.hypot(*last) < NEARER else math.atan2(*last)
