"""How jumps are drawn: the arc that would be flown, or is, its shadow, the ring where it lands, and bodies as they would lie in what they would touch."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from gambol.controllers.body import forward_kinematics
from gambol.controllers.jump.motion import Plan
from gambol.controllers.navigation import floor_at

from ..scene import Dot, Figure, Line, Patch, Prop, Sketch
from ..world import World
from .jump_preview import Preview, flight

CAN, CANNOT, SEEN = (0.02, 0.52, 0.16), (0.80, 0.05, 0.02), (0.02, 0.24, 0.80)
"""Colours of a jump that can be made, of one that can't, of one that is being made."""
PALE = (0.92, 0.92, 0.88)
LIFT = 0.012
"""How high over a floor things lie [m]."""
RING = 0.26
"""Where somebody lands [m]: its radius."""
TOUCHED = 0.07
"""How large is marked what a jump would touch [m]."""
GHOST, CLEAR = (0.80, 0.06, 0.03), 0.55
"""Tint and opacity of a body as it would lie in what it would touch."""
FADE = 0.5
"""So long after landing the arc is gone [s]."""


def aimed(seen: Preview, props: Sequence[Prop]) -> list[Sketch]:
    """The arc that would be flown, its shadow and the ring where it lands, and another where it could; who aims hides
    neither."""
    tint = CANNOT if seen.fault else CAN
    drawn = [*ring(seen.place, tint), *_arc(seen.arc, seen.beads, tint, 1.0)]
    if seen.heading is not None:
        drawn += arrow(seen.place, seen.heading, tint)
    if seen.nearest is not None:
        drawn += ring(seen.nearest, CAN)
    if seen.touch is not None:
        drawn.append(Dot("jump", seen.touch.place, CANNOT, TOUCHED))
    return [*_shadow(seen, props, tint), *(replace(sketch, through=True) for sketch in drawn)]


def ghosts(previews: Sequence[Preview | None], figures: Sequence[Figure], world: World) -> tuple[Figure, ...]:
    """The bodies of those who aim where they would touch something, as they would lie in it. figures: how those in a world are drawn."""
    drawn = []
    for seen, figure, one in zip(previews, figures, world.characters):
        if seen is not None and seen.touch is not None:
            placed = forward_kinematics(one.controller.skeleton, seen.touch.root, seen.touch.local)
            drawn.append(Figure(*placed, GHOST, body=figure.body, opacity=CLEAR))
    return tuple(drawn)


def _shadow(seen: Preview, props: Sequence[Prop], tint) -> list[Sketch]:
    """A line on the floor below an arc, from the feet to the ring."""
    way = seen.stand + np.linspace(0.0, 1.0, 25)[:, None] * (seen.place - seen.stand)
    if not np.isfinite(seen.arc).all() or np.linalg.norm(seen.place - seen.stand) < RING:
        return []
    high = np.linspace(seen.stand[1], seen.place[1], 25) + 0.5
    way[:, 1] = [floor_at(x, z, props, below) + LIFT for (x, _, z), below in zip(way, high)]
    return [Line("jump", way, tint, 0.035, (0.5, 0.9), flat=True)]


def flown(plan: Plan, time: float) -> list[Sketch]:
    """The arc of a jump that is made, fading once it has landed."""
    left = 1.0 - max(time - plan.touch_down, 0.0) / FADE
    if left <= 0.0:
        return []
    place = plan.feet[:, :3].mean(0)
    place[1] = plan.feet[:, 1].min() - 0.02
    return _arc(*flight(plan.path), SEEN, left) + (ring(place, SEEN) if left == 1.0 else [])


def _arc(arc: np.ndarray, beads: np.ndarray, tint, opacity: float) -> list[Sketch]:
    if not np.isfinite(arc).all():
        return []
    return [Line("jump", arc, tint, 0.036, (0.8 * opacity, opacity)),
            *(Dot("jump", bead, PALE, 0.030 * opacity) for bead in beads)]


def arrow(place: np.ndarray, heading: float, tint, radius: float = RING) -> list[Sketch]:
    """An arrow out of a ring on the floor, to where somebody will face who lands there."""
    c, s = math.cos(heading), math.sin(heading)
    ahead, left = np.array([s, 0.0, c]), np.array([c, 0.0, -s])
    middle, tip = place + [0.0, LIFT, 0.0], 2.2 * radius * ahead
    head = np.stack([tip - 0.45 * radius * (ahead - side * left) for side in (1.0, -1.0)])
    return [Line("jump", middle + np.stack([radius * ahead, tip]), tint, 0.045, flat=True),
            Line("jump", middle + np.stack([head[0], tip, head[1]]), tint, 0.045, flat=True)]


def ring(place: np.ndarray, tint, radius: float = RING) -> list[Sketch]:
    """Two circles on the floor."""
    angle = np.linspace(0.0, math.tau, 49)
    circle = np.stack([np.sin(angle), np.zeros(49), np.cos(angle)], 1)
    middle = place + [0.0, LIFT, 0.0]
    return [Patch("jump", middle + radius * circle[:-1], tint, 0.3),
            Line("jump", middle + radius * circle, tint, 0.045, flat=True),
            Line("jump", middle + [0.0, 0.001, 0.0] + 0.3 * radius * circle, tint, 0.035, flat=True)]
