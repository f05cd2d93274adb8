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
from .jump_sketches import CAN, CANNOT, LIFT, ring

if TYPE_CHECKING:  # whoever has a plan has loaded what it takes
    from gambol.controllers.navigation.planning import Plan

LOOKS = 0.25
"""From one mark of the heading to the next [s] ..."""
LONG = 0.16
"""... and how long it is [m]."""
BEND = 0.35
"""How high a leap that is ahead is drawn [m]."""
PLACE = 0.16
"""The radius of the ring at a goal [m]."""
PARTS = ("time", "forward", "turning", "sideways", "looking away")


def led(figures: Sequence[Figure], after: World, overlays: Overlays, count: int | None = None) -> tuple[Figure, ...]:
    """The figures, those who go to a goal with the headings of the way that is left, and with the goal. count: of the first so many alone: those who
    are played."""
    if not overlays.path:
        return tuple(figures)
    shown = [one.state.going is not None and (count is None or number < count) for number, one in enumerate(after.characters)]
    return tuple(figure if not shows or one.state.going is None else replace(figure, sketches=(*figure.sketches, *_way(one.state.going, float(one.state.floor))))
                 for figure, one, shows in zip(figures, after.characters, shown, strict=True))


def _way(way: Going, floor: float) -> list[Sketch]:
    tint = CANNOT if way.status.reason else CAN
    drawn: list[Sketch] = []
    walked = way.plan.at(np.arange(math.ceil(way.time / LOOKS) * LOOKS, way.plan.seconds + LOOKS, LOOKS))[0]  # the last one is its end
    heights = way.floors(walked[:, :2], floor)
    if not way.plan.reason:
        for (x, z, turned), high in zip(walked[:-1], heights[:-1]):
            drawn.append(_mark(np.array([x, high, z]), turned, np.array([0.0, LONG]), tint, 0.025, (0.9, 0.2)))
    place, last = np.array([way.goal.place[0], heights[-1] if len(heights) else floor, way.goal.place[-1]]), None
    for leap in way.crossings:
        at = np.array([leap.ground[0], leap.height, leap.ground[1]])
        drawn += [] if last is None else _onward(last, at, tint)
        share = np.linspace(0.0, 1.0, 17)[:, None]
        bent = at + share * (leap.place - at) + [0.0, LIFT, 0.0] + 4.0 * share * (1.0 - share) * [0.0, BEND, 0.0]
        drawn.append(Line("path", bent, tint, 0.02, dashed=True))
        last = leap.place
    if last is not None:
        straight = last + np.linspace(0.0, 1.0, 65)[:, None] * (place - last)
        place[1] = way.floors(straight[:, [0, 2]], float(last[1]))[-1]
        drawn += _onward(last, place, tint)
    drawn += [replace(sketch, layer="path") for sketch in ring(place, tint, PLACE)]
    if not (way.plan.reason or way.crossings):
        drawn.append(_mark(place, way.plan.goal[2], np.array([0.0, 1.8 * PLACE]), tint, 0.05, (1.0, 1.0)))
    return drawn


def _mark(place: np.ndarray, heading: float, far: np.ndarray, tint, width: float, opacity: tuple[float, float]) -> Line:
    """A short line that looks where somebody does."""
    ahead = np.array([math.sin(heading), 0.0, math.cos(heading)])
    return Line("path", place + [0.0, LIFT, 0.0] + far[:, None] * ahead, tint, width, opacity, flat=True)


def _onward(here: np.ndarray, there: np.ndarray, tint) -> list[Sketch]:
    """A walk that is not planned yet."""
    return [Line("path", np.array([here, there]) + [0.0, LIFT, 0.0], tint, 0.02, (0.5, 0.5), dashed=True, flat=True)]


def on_the_way(state: CharacterState) -> tuple[str, ...]:
    """How a walk to a goal stands, and what its plan costs and of what that is made, in lines; none without a goal."""
    way = state.going
    if way is None:
        return ()
    if way.planned is None:
        return ("which way?" if way.thinking is not None else "not before he walks",)
    if way.plan.reason:
        return (f"no way there: {way.plan.reason}",)
    if way.there:
        return ("at the goal",)
    parts = cost_of(way.costed)
    shares = "   ".join(f"{name} {value:.1f}".replace(" ", "\u00a0") for name, value in zip(PARTS, parts) if value >= 0.05)
    leaps = len(way.crossings)
    where = "the goal" if not leaps else "a leap" if leaps == 1 else f"the first of {leaps} leaps"
    return (f"to {where}: {min(way.time, way.plan.seconds):.1f} of {way.plan.seconds:.1f} s", f"cost {way.plan.cost:.1f}: {shares}")


def cost_of(plan: Plan, samples: int = 200) -> np.ndarray:
    """What a plan's cost is made of (5,): time, forward, turning and lateral acceleration, and, which is the rest, looking away."""
    from gambol.controllers.navigation.planning import HUMAN

    middle = (np.arange(samples) + 0.5) / samples * plan.seconds
    pushed = np.array(HUMAN[1:4]) * np.mean(plan.acceleration(middle) ** 2, 0) * plan.seconds
    known = np.array([HUMAN.time * plan.seconds, *pushed])
    return np.append(known, max(plan.cost - known.sum(), 0.0))
