"""What is thought of on the way to a goal: the way itself, another plan for it, at which step a leap goes off, and the leap."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ...contract import CharacterState, Controller, Intent, Leap, but
from ..levels import RUN_UPS, SHARE, TRIES, Crossing, Leg, approach, named, next_leg, onto, quickened, runs, start_of, take_offs
from ..obstacles import DEPTH, SHOULDER
from .going import NEARER, Going, Thinking
from .thought import Thought, steps_of

if TYPE_CHECKING:  # who never goes to a goal loads no planner
    from ..planning import Plan

HELD_UP = 4
"""After so many plans in a row that were worth nothing he is held up."""
MISSED = 0.5
"""Who lands farther from where he should [m] leaps so no more."""
REST = 1e-9
"""Who moves no faster than this [m/s, rad/s] is at rest."""


def _thinking(act: Callable[[Callable[[], None]], Mapping[str, Any]], dt: float, carries: np.ndarray | None = None) -> Thinking:
    return Thinking(Thought(act, dt), dt, 0, carries)


def began(now: Going, state: CharacterState, intent: Intent, walker: Controller, dt: float, carries: np.ndarray | None) -> Thinking:
    """The way to a goal is thought of, from where he will be by the time that it is known. carries: as of `Thinking`."""
    def act(ask: Callable[[], None]) -> Mapping[str, Any]:
        from ..planning import Plan, plan_in_time

        goal, questions, planes = now.goal, 0, walker.limits(SHARE)
        assert planes is not None  # he walks

        def counted() -> None:
            nonlocal questions
            questions += 1
            ask()

        def refusal(there: CharacterState, asked: Intent) -> str | None:
            counted()
            return walker.pondered(there, asked, counted)
        known = now.crossings[1:] if now.leapt else now.crossings if now.back else ()  # who went back for a run-up makes it
        leg = next_leg(walker, state, goal, intent.around, now.barred, refusal, known, now.stands, counted)
        failed = now.stands.count(named(leg.crossings[0])) if leg.crossings else 0
        run = bool(leg.crossings) and not leg.back and failed <= now.back and runs(leg.crossings[0], state.ground[:2], intent.around, planes)
        for _ in range(TRIES if run else 0):
            counted()
        steps = steps_of(questions, dt)
        then = foreseen(now, state, intent, walker, steps, dt, carries)
        pace, made = approach(walker, then, leg.crossings[0], intent, planes, leg.around, dt) if run else (0.0, None)
        stands = now.stands
        if run and not pace and failed + now.back < RUN_UPS:
            leg = _afresh(walker, leg, intent, then)
            stands = (*stands, named(leg.crossings[0])) if now.back else stands
        heading = _arrival(then, leg) if leg.heading is None else leg.heading
        end = np.array([*leg.place, heading])
        within = None if leg.crossings or goal.within is None else max(goal.within - now.spent - steps * dt, 0.1)
        if leg.reason:
            made = Plan.none(then.ground, end, leg.reason)
        elif not pace:
            made = plan_in_time(then.ground, end, then.velocity, planes, leg.around, float(then.floor), within, now.planned != goal, size=walker.size)
        assert made is not None
        return {"plan": made, "planned": goal, "heading": heading, "around": intent.around, "stops": leg.around, "time": 0.0, "stood": 0.0,
                "left": _left(then, made), "held": 0, "waits": 0.0, "nearest": math.inf, "plans": now.plans + 1, "crossings": leg.crossings,
                "asked": 0.0, "leapt": False, "anew": False, "pace": pace, "off": None, "poised": False, "back": leg.back,
                "stands": stands}
    return _thinking(act, dt, carries)


def _afresh(walker: Controller, leg: Leg, intent: Intent, here: CharacterState) -> Leg:
    """The walk to where a run-up begins from which a leap goes off that goes off neither from here nor from a stand."""
    leap: Crossing = leg.crossings[0]
    begins = start_of(walker, leap, intent.around, here.ground[:2])
    if begins is None or not walker.refusal(walker.start(leap.ground, leap.height), Intent(leap=Leap(leap.place), around=intent.around)):
        return leg
    return leg._replace(place=begins, back=True)


def landed(now: Going, state: CharacterState) -> Going:
    """The same after a leap: one that led elsewhere than it should is not made again, and what comes after it is sought anew."""
    if not now.crossings or math.dist(state.ground[:2], onto(now.crossings[0], now.pace)[[0, 2]]) <= MISSED:
        return now
    return now.but(barred=(*now.barred, named(now.crossings[0])), crossings=())


def another(now: Going, state: CharacterState, intent: Intent, walker: Controller, dt: float) -> Thinking:
    """Another plan to the same end is thought of."""
    left = _left(state, now.plan)
    held = 0 if now.there or now.waits > 0.0 or left < now.left - NEARER else now.held + 1

    def act(ask: Callable[[], None]) -> Mapping[str, Any]:
        from ..planning import Plan, plan_in_time

        planes, steps = walker.limits(SHARE), steps_of(0, dt)
        assert planes is not None  # he walked
        planes = quickened(planes, now.pace)
        goal = np.array([*now.plan.goal[:2], now.heading])
        if held >= HELD_UP:
            made = Plan.none(state.ground, goal, f"held up {left * walker.size:.2f} m before the {'leap' if now.crossings else 'goal'}")
        else:
            then = foreseen(now, state, intent, walker, steps, dt, None)
            within = None if now.goal.within is None or now.crossings else max(now.goal.within - now.spent - steps * dt, 0.1)
            made = plan_in_time(then.ground, goal, then.velocity, planes, now.stops, float(then.floor), within, leaving=np.array([now.pace, 0.0, 0.0]), size=walker.size)
        return {"plan": made, "time": 0.0, "stood": 0.0, "asked": 0.0, "left": left, "held": held, "plans": now.plans + 1, "off": None, "poised": False}
    return _thinking(act, dt)


def run_up(now: Going, state: CharacterState, intent: Intent, walker: Controller, dt: float) -> Thinking:
    """At which of his steps he leaps is thought of, while he goes on; where he can at none, he stops, and leaps from a stand."""
    def act(ask: Callable[[], None]) -> Mapping[str, Any]:
        off, steps = take_offs(walker, state, now.plan, now.time, now.crossings[0], intent, dt), steps_of(0, dt)
        return {"off": off[0] - steps + 1} if off and off[0] >= steps else {"stands": (*now.stands, named(now.crossings[0])), "anew": True}
    return _thinking(act, dt)


def poised(now: Going, state: CharacterState, intent: Intent, walker: Controller, dt: float) -> Thinking:
    """A leap from a stand is thought of: it is planned for where he will be, so that nothing is left to plan as it goes off."""
    def act(ask: Callable[[], None]) -> Mapping[str, Any]:
        then = foreseen(now, state, intent, walker, steps_of(0, dt), dt, None)
        refused = walker.refusal(then, but(intent, leap=Leap(onto(now.crossings[0], 0.0)))) != ""
        return {"asked": now.asked + dt * steps_of(0, dt)} if refused else {"poised": True}  # what is refused would be looked into as it went off
    return _thinking(act, dt)


def foreseen(now: Going, state: CharacterState, intent: Intent, walker: Controller, steps: int, dt: float, carries: np.ndarray | None) -> CharacterState:
    """The state after so many steps of dt [s], if nobody comes in his way: he is played ahead."""
    asked = but(intent, goal=None, aside=None, leap=None)
    for step in range(steps):
        velocity = now.wished_while(carries, step, dt, state.ground, state.velocity)
        if carries is not None and not velocity.any() and np.abs(state.velocity).max() < REST:
            return state
        now = now.but(time=now.time + dt * float(walker.readiness(state)))
        state, _ = walker.step(state, but(asked, velocity=velocity), dt)
    return state


def _left(state: CharacterState, made: Plan) -> float:
    return float(np.hypot(*(made.goal - state.ground)[:2]))


def _arrival(state: CharacterState, leg: Leg) -> float:
    """The heading [rad] with which the shortest way arrives; the walker's own where he is there already."""
    from ..routes import shapes_of, ways

    shapes, here = shapes_of(leg.around, float(state.floor)), np.asarray(state.ground[:2], float)
    found = (ways(here, leg.place, shapes, SHOULDER) or ways(here, leg.place, shapes, 0.5 * sum(DEPTH))) if len(shapes) else []
    last = leg.place - (found[0][-2] if found else here)
    return float(state.ground[2]) if math.hypot(*last) < NEARER else math.atan2(*last)
