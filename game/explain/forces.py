"""What a body balances on and what pushes it: centre of mass and support polygon, muscles, weight and the ground's push."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gambol.controllers.body import STATURE, centre_of_mass, hull, margin, sole_corners, standing_corners
from gambol.controllers.jump import Physique
from gambol.controllers.jump.body import MASS, bend_kernel
from gambol.controllers.jump.motion import Plan
from gambol.controllers.jump.muscles import POINTED, muscle, spring_force
from gambol.controllers.navigation import floor_at

from ..scene import Arrow, Dot, Figure, Line, Patch, Prop, Sketch
from ..world import Character, physique_of
from .jump_sketches import CAN, CANNOT, LIFT, PALE

GROUND, WEIGHT = (0.02, 0.42, 0.10), (0.10, 0.11, 0.13)
NEWTON = 0.42 / (MASS * 9.81)
"""How long forces are drawn [m/N]: an adult's weight on Earth is 0.42 m."""
MOST_DRAWN = 4.0
"""No longer arrows of the ground's force are drawn, in weights."""


@dataclass(frozen=True, eq=False)
class Body:
    """A drawn body: whose, how it stands."""

    physique: Physique
    figure: Figure
    centre: np.ndarray
    floor: float
    polygon: np.ndarray  # (H, 2) [m]

    @staticmethod
    def of(character: Character, figure: Figure) -> Body:
        physique, skeleton = physique_of(character.controller), character.controller.skeleton
        at, turned = np.asarray(figure.positions, float), np.asarray(figure.orientations, float)
        corners = sole_corners(skeleton, at, turned)[standing_corners(figure.contacts)]
        centre = centre_of_mass(physique.anatomy, at, turned)
        return Body(physique, figure, centre, float(character.state.floor), hull(corners[:, [0, 2]]))

    def on_floor(self, flat: np.ndarray, lift: float = LIFT) -> np.ndarray:
        """Points (N, 2) on the floor that carries it."""
        return np.insert(np.atleast_2d(flat), 1, self.floor + lift, axis=1)

    def nearest(self, flat: np.ndarray) -> np.ndarray:
        """The point (2,) of the support polygon's edge nearest to one (2,)."""
        ends = np.roll(self.polygon, -1, 0) - self.polygon
        part = np.sum((flat - self.polygon) * ends, 1) / np.maximum(np.sum(ends * ends, 1), 1e-12)
        feet = self.polygon + np.clip(part, 0.0, 1.0)[:, None] * ends
        return feet[np.argmin(np.linalg.norm(feet - flat, axis=1))]


def balance(body: Body, props: Sequence[Prop]) -> list[Sketch]:
    """Centre of mass, the polygon that carries it, and how far inside it is."""
    flat = body.centre[[0, 2]]
    below = floor_at(flat[0], flat[1], props, body.centre[1])
    sketches: list[Sketch] = [
        Line("balance", np.stack([body.centre, [flat[0], below + LIFT, flat[1]]]), PALE, 0.012, (0.9, 0.9), dashed=True),
        Dot("balance", body.centre, PALE, 0.055, quartered=True, through=True)]
    if len(body.polygon) < 3:
        return [*sketches, Dot("balance", np.array([flat[0], below + LIFT, flat[1]]), PALE, 0.03, flat=True)]
    inside = float(margin(body.polygon, flat))
    tint, edge = (CAN if inside > 0.0 else CANNOT), body.on_floor(np.vstack([body.polygon, body.polygon[:1]]))
    return [Patch("balance", edge[:-1], tint, 0.3), Line("balance", edge, tint, 0.018, flat=True),
            Line("balance", body.on_floor(np.stack([flat, body.nearest(flat)]), LIFT + 0.002), PALE, 0.014, flat=True),
            *sketches, Dot("balance", body.on_floor(flat, LIFT + 0.004)[0], tint, 0.032, flat=True)]


def planned(plan: Plan, time: float) -> np.ndarray:
    """The ground's force (3,) [N] on somebody who jumps."""
    return np.array([np.interp(time, plan.times, plan.forces[:, k]) for k in range(3)])


def pushed(character: Character, physique: Physique, gravity: float) -> np.ndarray:
    """The ground's force (3,) [N] on somebody who stands or walks, f = m (a − g), from how the centre of mass is borne
    (`gambol.game.world.centre_of_mass`); none without a foot on the floor."""
    if not np.asarray(character.state.contacts).any():
        return np.zeros(3)
    weight = physique.mass * gravity
    push = np.array([0.0, weight, 0.0])
    if character.centre_of_mass is not None:
        push += physique.mass * character.centre_of_mass.acceleration
    return push * min(max(push[1], 0.0) / max(abs(push[1]), 1e-9), MOST_DRAWN * weight / max(np.linalg.norm(push), 1e-9))


def forces(body: Body, push: np.ndarray, gravity: float) -> list[Sketch]:
    """Muscles across hip, knee and ankle, the body's weight, and the ground's push (3,) [N]."""
    weight = body.physique.mass * gravity
    sketches = muscles(body)
    sketches.append(Arrow("forces", body.centre, np.array([0.0, -weight * NEWTON, 0.0]), WEIGHT, 0.026))
    if push[1] > 0.02 * weight and len(body.polygon):
        # through the centre of mass if the feet reach so far
        over = body.centre[1] - body.floor
        flat = body.centre[[0, 2]] - push[[0, 2]] / push[1] * over
        flat = flat if margin(body.polygon, flat) > 0.0 else body.nearest(flat)
        sketches.append(Arrow("forces", body.on_floor(flat)[0], push * NEWTON, GROUND, 0.036))
    return sketches


def muscles(body: Body) -> list[Sketch]:
    """The springs of both legs, thicker and redder the more they pull; pale on a leg in the air."""
    skeleton, at = body.figure, np.asarray(body.figure.positions, float)
    turned = np.ascontiguousarray(body.figure.orientations, float)
    size, hips = body.physique.height / STATURE, body.physique.tables.hip
    drawn = []
    for side, hip in enumerate(hips):
        bends = leg_bends(turned, int(hip))
        spring = muscle(body.physique)
        pulls = spring_force(bends, spring) / (2.0 * spring.stiffness * spring.width)
        stands = bool(np.asarray(skeleton.contacts)[2 * side:2 * side + 2].any())
        up, front = turned[0][:, 1], turned[hip][:, 2]
        down, shin, foot = -turned[hip][:, 1], -turned[hip + 1][:, 1], turned[hip + 1][:, 2]
        hip_at, knee, ankle = at[hip], at[hip + 1], at[hip + 2]
        thigh = np.linalg.norm(knee - hip_at)
        heel = ankle + turned[hip + 2] @ np.array([0.0, -0.03, -0.055]) * size
        back = -turned[0][:, 2]
        bands = ((hip_at + (0.10 * up + 0.07 * back) * size, hip_at + (0.11 * (back - front) / 1.6 - 0.02 * up) * size,
                  hip_at + 0.5 * thigh * down - 0.055 * size * front),
                 (hip_at + 0.35 * thigh * down + 0.075 * size * front, knee + 0.068 * size * (front + foot) / 1.7,
                  knee + (0.10 * shin + 0.05 * foot) * size),
                 (knee + (0.06 * shin - 0.05 * foot) * size, knee + (0.16 * shin - 0.075 * foot) * size, heel))
        for pull, points in zip(pulls, bands):
            drawn.append(Line("forces", _curve(*points), heat(float(pull)), (0.012 + 0.05 * float(pull)) * size,
                              (1.0, 1.0) if stands else (0.35, 0.35), through=True))
    return drawn


def heat(part: float) -> tuple[float, float, float]:
    """A colour from calm blue over yellow to red as `part` goes from 0 to 1."""
    stops = np.array([(0.02, 0.10, 0.50), (0.28, 0.26, 0.20), (0.85, 0.36, 0.01), (0.75, 0.02, 0.01)])
    red, green, blue = (float(np.interp(part, np.linspace(0.0, 0.75, 4), stops[:, k])) for k in range(3))
    return red, green, blue


def _curve(start: np.ndarray, over: np.ndarray, end: np.ndarray) -> np.ndarray:
    """A smooth curve (13, 3) that passes `over` a joint."""
    t = np.linspace(0.0, 1.0, 13)[:, None]
    bow = 2.0 * over - 0.5 * (start + end)
    return (1.0 - t)**2 * start + 2.0 * t * (1.0 - t) * bow + t**2 * end


def leg_bends(turned: np.ndarray, hip: int) -> np.ndarray:
    """How far hip, knee and ankle of a leg are bent (3,) [rad], as its muscles see it."""
    return np.array([-bend_kernel(turned[0], turned[hip]), bend_kernel(turned[hip], turned[hip + 1]),
                     POINTED - bend_kernel(turned[hip + 1], turned[hip + 2])])
