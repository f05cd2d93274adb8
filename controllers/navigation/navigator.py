"""Walking to a goal: a plan is made, followed, and made anew where it no longer holds; where no walk leads on, he walks to a leap, and leaps.

What is remembered of it is a value, `Going`, in the character's state: the same states and intents give the same walks, to the bit. Nothing is planned
in a step: what is thought of beside is used some steps later, for where he will be by then.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..contract import CharacterState, Controller, Goal, Intent, Leap, but
from .goal import arrived, progress
from .levels import SOON, levels_of, named, onto
from .obstacles import changed, matters
from .thinking import NEARER, Going, another, astray, began, in_size, landed, poised, ready, run_up, steps_of, within

STILL = 0.01
"""Who moves no faster than this [m/s, rad/s] stands."""
SLOWS, TURNED = 2.0, 0.5
"""So long before its end [s], and turned so far as he should then stand [rad], a plan is left to the walker's own last strides, which end where it does."""
STAYS = 0.028, np.radians(2.8)
"""Who has arrived has done so as long as he is so near to the goal [m, rad]; else a step brings him back."""
PATIENCE = 45.0
"""Who has come no nearer to the goal for so long [s] because of others gives up."""
KEPT = 0.9
"""Who goes on by less than this share of what he wishes for is kept from it by others."""
REFUSED = 0.4
"""A leap that can't be made for so long [s] is given up for another way."""
ANEW = 0.5
"""A plan is followed for so long [s] before what moved about him is thought of: who began anew in each step would never set off."""
ASIDE, STRAYS = 1.0, 0.1
"""What moved matters if the way past it could be shorter than his, or longer by no more than the first [m]; where there was no way, what moved by the second [m]."""
ONWARD = 0.3
"""Who has landed and has to go on is asked to walk at this speed [m/s], and gets up sooner."""


def going(state: CharacterState, intent: Intent, walker: Controller, walks: bool, dt: float) -> tuple[Going | None, Intent]:
    """How the walk to intent.goal goes on, and what to ask of the walker for it: the same intent with the velocity to wish for.

    walker: by whose limits plans are made, and with whose readiness, while he sets off, their time runs. walks: whether he walks now; who jumps
    doesn't, and goes on afterwards. dt: the step that is to be made [s].
    """
    if walker.size != 1.0 and intent.goal is not None:
        return in_size(_led, state, intent, walker, walks, dt)
    return _led(state, intent, walker, walks, dt)


def _led(state: CharacterState, intent: Intent, walker: Controller, walks: bool, dt: float) -> tuple[Going | None, Intent]:
    """The same of somebody of the standard size."""
    goal = intent.goal
    now: Going | None = state.going
    if goal is None or not walks:
        if now is not None and now.thinking is not None:
            now.thinking.thought.forget()
    if goal is None:
        return None, intent
    if not walks:
        on = ONWARD if now is not None and not now.there and not now.plan.reason else 0.0
        return now if now is None else now.but(leapt=True, thinking=None), but(intent, velocity=np.array([on, 0.0, 0.0]))
    now = _stays(state, intent, goal) if now is None else now
    if now.goal != goal:
        now = now.but(goal=goal, spent=0.0, stood=0.0)
    now = _thought(now)
    if now.thinking is None:
        now = _thinks(now, state, intent, walker, dt)
    near = within(now, state, STAYS) if now.there else bool(np.abs(state.velocity).max() < STILL) and arrived(now.plan, now.time, state.ground)
    stood = now.stood + dt if near and not now.plan.reason and now.planned == goal else 0.0
    now = now if now.stood == stood else now.but(stood=stood)
    velocity = now.wished(state.ground, state.velocity)
    share, leap = 1.0, intent.leap
    if intent.aside is not None and bool(np.isfinite(intent.aside).all()):
        share, velocity = progress(velocity, velocity + intent.aside), velocity + intent.aside
        now = _kept(now, state, share, dt, walker.size)
    if now.crossings and leap is None and not intent.held and _leaps(now, state):
        leap, now = Leap(onto(now.crossings[0], now.pace)), now.but(asked=now.asked + dt)
    now = now.but(time=now.time + share * dt * float(walker.readiness(state)), spent=now.spent + dt)
    rests = now.thinking is None and not (now.crossings or now.plan.reason or leap or now.planned != goal) and share >= KEPT
    turn = abs(math.remainder(now.plan.goal[2] - float(state.ground[2]), math.tau))
    halt = now.plan.goal if rests and now.time > now.plan.seconds - SLOWS and turn < TURNED else None
    return now, but(intent, velocity=velocity, leap=leap, halt=halt)


def _stays(state: CharacterState, intent: Intent, goal: Goal) -> Going:
    """How it is before anything was thought of."""
    from .planning import Plan

    return Going(goal, Plan.none(state.ground, state.ground, ""), float(state.ground[2]), intent.around, intent.around)


def _thought(now: Going) -> Going:
    """The same a step later, with what was thought of, if it is to be used now."""
    thinks = now.thinking
    if thinks is None:
        return now
    changes = thinks.thought.after(thinks.steps + 1)
    if changes is None:
        return now.but(thinking=thinks._replace(steps=thinks.steps + 1))
    return now.but(thinking=None, **changes)


def _thinks(now: Going, state: CharacterState, intent: Intent, walker: Controller, dt: float) -> Going:
    """The same, as he begins to think where he has to."""
    asked, run = (now, state, intent, walker, dt), now.pace > 0.0
    if now.planned != now.goal:
        if walker.limits() is None:
            from .planning import Plan

            return now.but(planned=now.goal, plan=Plan.none(state.ground, state.ground, "nobody here walks"))
        follows = not (now.plan.reason or now.leapt or now.anew or run or now.planned is None)
        carries = None if follows else np.zeros(3) if run else state.velocity  # a plan that ends in a leap leads over an edge
        fresh = now.but(barred=(), stands=(), crossings=())
        return now.but(barred=(), stands=(), thinking=began(fresh, *asked[1:], carries))
    if now.leapt:
        now = landed(now, state)
        return now.but(thinking=began(now, *asked[1:], state.velocity))
    if _changed(now, state, intent.around):
        return now.but(thinking=began(now, *asked[1:], state.velocity if now.plan.reason or run else None))
    if now.anew:
        return now.but(thinking=began(now, *asked[1:], np.zeros(3)))
    if now.asked > REFUSED:
        now = now.but(barred=(*now.barred, named(now.crossings[0])))
        return now.but(thinking=began(now, *asked[1:], np.zeros(3)))
    if now.plan.reason:
        return now
    if run and now.off is not None and now.off > 0:
        return now.but(off=now.off - 1)
    late = run and now.off is None and now.time > now.plan.seconds - SOON - dt * steps_of(0, dt)
    if run and (now.off is not None or late and intent.held):
        now = now.but(stands=(*now.stands, named(now.crossings[0])))  # he has not leapt at that step, or may not
        return now.but(thinking=began(now, *asked[1:], np.zeros(3)))
    if late:
        return now.but(thinking=run_up(*asked))
    if now.back and ready(now, state):
        return now.but(thinking=began(now, *asked[1:], np.zeros(3)))
    if now.crossings and not run and not now.poised and ready(now, state):
        return now.but(thinking=poised(*asked))
    return now.but(thinking=another(*asked)) if astray(now, state) else now


def _leaps(now: Going, state: CharacterState) -> bool:
    """Whether the next leap goes off now, so far as it is for him to say."""
    if now.thinking is not None or now.plan.reason:
        return False
    return now.off == 0 if now.pace else now.poised and ready(now, state)


def _kept(now: Going, state: CharacterState, share: float, dt: float, size: float) -> Going:
    """The same, as others let somebody of a size go on by a share of what he wishes for."""
    left = float(np.hypot(*(now.plan.goal - state.ground)[:2]))
    if left < now.nearest - NEARER:
        return now.but(waits=0.0, nearest=left)
    waits = now.waits + dt * (share < KEPT)
    if waits <= PATIENCE or now.plan.reason:
        return now.but(waits=waits)
    from .planning import Plan

    why = f"others have been in the way for {waits * size**0.5:.0f} s, {left * size:.2f} m before the {'leap' if now.crossings else 'goal'}"
    return now.but(waits=waits, plan=Plan.none(state.ground, now.plan.goal, why), thinking=None)


def _changed(now: Going, state: CharacterState, around: Sequence[Any]) -> bool:
    """Whether other things stand in the way than when it was planned, or leave one that may be shorter."""
    if around is now.around or levels_of(around) is levels_of(now.around):
        return False
    if now.plan.reason:
        return bool(changed(now.around, around, STRAYS))
    if now.time < ANEW and now.plan.seconds > 0.0:
        return False
    way = now.plan.at(np.linspace(min(now.time, now.plan.seconds), now.plan.seconds, 24))[0][:, :2]
    left = np.linalg.norm(np.diff(way, axis=0), axis=-1).sum() + np.linalg.norm(way[-1] - now.goal.floor)
    return matters(changed(now.around, around), state.ground[:2], now.goal.floor, float(left) + ASIDE)
