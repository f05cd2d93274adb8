"""Following a plan to a goal: a plan and where the walker is become the velocity that he should wish for.

Legs take up a wish as a critically damped spring does. What it takes to have them move as planned is its inverse,
v + 2 v̇/y + v̈/y² with y = 2 ln 2 / half-life, of the plan; what the walker is off in place, heading and speed is added.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:  # whoever has a plan has loaded what it takes
    from .planning import Plan


CREEPS = 0.05
"""Nobody who wishes for less than this [m/s] is kept from his way."""


class Following(NamedTuple):
    """How a plan is followed.

    halflife, turning_halflife: of the springs by which wishes to walk and to turn are taken up [s]; a walker's `Settings` has the
    one, the other is half of it. place, heading: how much faster for each metre and radian that he is off [1/s]. speed: how much faster for
    each metre a second that he is too slow, and so with turning. near, straight: who is as near to the goal as this [m, rad] once the
    plan is over stays there.
    """

    halflife: float = 0.22
    turning_halflife: float = 0.11
    place: float = 1.6
    heading: float = 3.0
    speed: float = 0.3
    near: float = 0.02
    straight: float = math.radians(2.0)


def wish(plan: Plan, time: float, ground: np.ndarray, velocity: np.ndarray, following: Following = Following()) -> np.ndarray:
    """The velocity (3,) v_f, ω, v_l to wish for [m/s, rad/s, m/s], `time` [s] into the plan: who sets off is late, so his time runs by
    his controller's `readiness`.

    ground: (3,) x, z [m], heading [rad], where the walker is. velocity: (3,) how he moves. Nothing once he has arrived, or where
    there is no plan. ValueError for a time that is none.
    """
    try:
        known = math.isfinite(time)
    except TypeError:
        known = False
    if not known:
        raise ValueError(f"a time into a plan is a number of seconds, got {time!r}")
    if plan.reason or arrived(plan, time, ground, following):
        return np.zeros(3)
    return plan.wished(time, ground, velocity, following)


def progress(wanted: np.ndarray, chosen: np.ndarray) -> float:
    """How much 0 … 1 of the way that a wish (3,) v_f, ω, v_l would go is gone by the velocity (3,) that was chosen instead: by so much a plan's
    time goes on. All of it for who wishes to stand, or to turn."""
    ahead, going = wanted[[0, 2]], chosen[[0, 2]]
    square = float(ahead @ ahead)
    return 1.0 if square < CREEPS**2 else min(max(float(ahead @ going) / square, 0.0), 1.0)


def arrived(plan: Plan, time: float, ground: np.ndarray, following: Following = Following()) -> bool:
    """Whether a plan is over and the walker at its goal."""
    return (time >= plan.seconds and math.hypot(plan.goal[0] - ground[0], plan.goal[1] - ground[1]) <= following.near
            and abs(math.remainder(plan.goal[2] - ground[2], math.tau)) <= following.straight)
