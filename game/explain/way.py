"""What there is to see of a walk to a goal: where it looks on its way, where it is to stand, what it costs, in words."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from gambol.controllers.contract import CharacterState
from gambol.controllers.navigation import Going

from ..scene import Figure, Line, Overlays, Sketch
from ..world import World
from .jump_preview import CAN, CANNOT, LIFT, ring

if TYPE_CHECKING:  # whoever has a plan has loaded what it takes
    from gambol.controllers.navigation.planning import Plan

LOOKS = 0.25
"""From one mark of the heading to the next [s] ..."""
LONG = 0.16
"""... and how long it is [m]."""
PLACE = 0.16
"""The radius of the ring at a goal [m]."""
PARTS = ("time", "forward", "turning", "sideways", "looking away")


def led(figures: Sequence[Figure], after: World, overlays: Overlays) -> tuple[Figure, ...]:
    """The figures, those who go to a goal with the headings of the way that is left, and with the goal."""
    if not overlays.path:
        return tuple(figures)
    return tuple(figure if one.state.going is None else replace(figure, sketches=(*figure.sketches, *_way(one.state.going, float(one.state.floor))))
                 for figure, one in zip(figures, after.characters, strict=True))


def _way(way: Going, floor: float) -> list[Sketch]:
    tint = CANNOT if way.plan.reason else CAN
    heading = way.plan.goal[2]
    place = np.array([way.goal.place[0], floor, way.goal.place[-1]])
    drawn: list[Sketch] = [replace(sketch, layer="path") for sketch in ring(place, tint, PLACE)]
    if way.plan.reason:
        return drawn
    ahead = np.array([math.sin(heading), 0.0, math.cos(heading)])
    drawn.append(Line("path", place + [0.0, LIFT, 0.0] + np.array([[0.0], [1.8 * PLACE]]) * ahead, tint, 0.05, flat=True))
    first = math.ceil(way.time / LOOKS) * LOOKS
    for x, z, turned in way.plan.at(np.arange(first, way.plan.seconds, LOOKS))[0]:
        here, there = np.array([x, floor + LIFT, z]), np.array([math.sin(turned), 0.0, math.cos(turned)])
        drawn.append(Line("path", here + np.array([[0.0], [LONG]]) * there, tint, 0.025, (0.9, 0.2), flat=True))
    return drawn


def on_the_way(state: CharacterState) -> tuple[str, ...]:
    """How a walk to a goal stands, and what its plan costs and of what that is made, in lines; none without a goal."""
    way = state.going
    if way is None:
        return ()
    if way.plan.reason:
        return (f"no way there: {way.plan.reason}",)
    if way.there:
        return ("at the goal",)
    parts = cost_of(way.plan)
    shares = "   ".join(f"{name} {value:.1f}" for name, value in zip(PARTS, parts) if value >= 0.05)
    return (f"to the goal: {min(way.time, way.plan.seconds):.1f} of {way.plan.seconds:.1f} s", f"cost {way.plan.cost:.1f}: {shares}")


def cost_of(plan: Plan, samples: int = 200) -> np.ndarray:
    """What a plan's cost is made of (5,): time, forward, turning and lateral acceleration, and, which is the rest, looking away."""
    from gambol.controllers.navigation.planning import HUMAN

    middle = (np.arange(samples) + 0.5) / samples * plan.seconds
    pushed = np.array(HUMAN[1:4]) * np.mean(plan.acceleration(middle) ** 2, 0) * plan.seconds
    known = np.array([HUMAN.time * plan.seconds, *pushed])
    return np.append(known, max(plan.cost - known.sum(), 0.0))
