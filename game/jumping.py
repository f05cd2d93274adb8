"""What there is to see of a jump: its arc and where it lands, what the body balances on, what pushes it.

After Ooi 2015, chapter 4. Layers: "jump" the arc, "balance" centre of mass and support polygon,
"forces" muscles, weight and the ground's push.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from controllers.body import forward_kinematics
from controllers.body.human import STATURE
from controllers.body.support import hull, margin, sole_corners, standing_corners
from controllers.body.anatomy import centre_of_mass
from controllers.contract import Leap
from controllers.jump import Jump, Physique
from controllers.jump.ballistics import along
from controllers.jump.muscles import POINTED, bend_kernel, muscle, spring_force
from controllers.jump.controller import RUNNING
from controllers.jump.path import Path, Start
from controllers.jump.plan import Plan
from controllers.navigation import floor_at

from .input.aim import Aim
from .scene import Arrow, Dot, Figure, Goal, Line, Overlays, Patch, Prop, Sketch
from .world import Character, World

LAYERS = ("jump", "balance", "forces")
CAN, CANNOT, SEEN = (0.02, 0.52, 0.16), (0.80, 0.05, 0.02), (0.02, 0.24, 0.80)
"""Colours of a jump that can be made, of one that can't, of one that is being made."""
GROUND, WEIGHT, PALE = (0.02, 0.42, 0.10), (0.10, 0.11, 0.13), (0.92, 0.92, 0.88)
NEWTON = 0.42 / (73.0 * 9.81)
"""How long forces are drawn [m/N]: an adult's weight on Earth is 0.42 m."""
MOST_DRAWN = 4.0
"""No longer arrows of the ground's force are drawn, in weights."""
LIFT = 0.012
"""How high over a floor things lie [m]."""
RING = 0.26
"""Where somebody lands [m]: its radius."""
BEAT = 0.1
"""From one bead of an arc to the next [s]."""
WIDE = 58
"""Letters in a line of a picture's corner."""
FADE = 0.5
"""So long after landing the arc is gone [s]."""


@dataclass(frozen=True, eq=False)
class Preview:
    """A jump that is aimed at.

    place: (3,) [m]. arc, beads: (N, 3), (M, 3) [m] where the centre of mass goes, and where it is on
    every beat. fault: why it can't be made; empty if it can.
    """

    place: np.ndarray
    arc: np.ndarray
    beads: np.ndarray
    fault: str


def jump_of(character: Character) -> Jump | None:
    """Somebody's jump controller; None for one that can't jump."""
    return getattr(character.controller, "controllers", {}).get("jump")


def plan_of(character: Character) -> tuple[Plan, float] | None:
    """The jump that somebody makes and how far it is [s]; None while they don't."""
    if jump_of(character) is None or character.state.memory.active != "jump":
        return None
    jumping = character.state.memory.memory
    return jumping.plan, jumping.time


def preview(character: Character, aim: Aim, props: Sequence[Prop]) -> Preview | None:
    """The jump that would be made if the button were let go now; None while nobody aims or one jumps."""
    jump = jump_of(character)
    if jump is None or plan_of(character) is not None:
        return None
    leap = aim.target(character.state, props, -float(jump.gravity[1]))
    return None if leap is None else previewed(jump, character, leap, props)


def previewed(jump: Jump, character: Character, leap: Leap, props: Sequence[Prop]) -> Preview:
    """A jump as it would be made from here."""
    state = character.controller.active(character.state)[1]
    start, floor = _pushing(jump.start_of(state)), float(state.floor)
    place = jump.middle(start, floor) if leap.place is None else np.asarray(leap.place, float)
    way, why = jump.survey(start, place, floor, leap.airtime, [prop for prop in props if not isinstance(prop, Goal)])
    arc, beads = _flight(way)
    return Preview(place, arc, beads, why)


def _pushing(start: Start) -> Start:
    """A runner between two steps, as if its lower foot stood: the arc stays what it is in every step."""
    if start.single is None and np.hypot(start.velocity[0], start.velocity[2]) > RUNNING:
        return replace(start, single=int(np.argmin(start.feet[:, 1])))
    return start


def _flight(way: Path) -> tuple[np.ndarray, np.ndarray]:
    """Points (33, 3) of an arc, and one for every beat."""
    times, beats = np.linspace(0.0, way.airtime, 33), np.arange(BEAT, way.airtime, BEAT)
    arc, beads = (along(way.leave, way.velocity, t, way.gravity) for t in (times, beats))
    return arc, beads


def explained(figures: Sequence[Figure], before: World, after: World, alpha: float, overlays: Overlays,
              previews: Sequence[Preview | None] = ()) -> tuple[Figure, ...]:
    """The figures of `game.world.figures` with all that the overlays show of their jumps.

    previews: of the first characters, where they aim.
    """
    if not any(getattr(overlays, layer) for layer in LAYERS):
        return tuple(figures)
    drawn = []
    for n, (figure, old, new) in enumerate(zip(figures, before.characters, after.characters)):
        now, sketches = moment_of(old, new, alpha), []
        if overlays.jump:
            if n < len(previews) and previews[n] is not None:
                sketches += aimed(previews[n])
            elif now is not None:
                sketches += flown(*now)
        if overlays.balance or overlays.forces:
            body = _Body.of(new, figure)
            if overlays.balance:
                sketches += balance(body, after.props)
            if overlays.forces:
                g = -float(jump.gravity[1]) if (jump := jump_of(new)) else 9.81
                sketches += forces(body, pushed(old, new, body.physique, g) if now is None else planned(*now), g)
        drawn.append(replace(figure, sketches=tuple(sketches)))
    return tuple(drawn)


def broken(line: str) -> tuple[str, ...]:
    """A long line in parts that fit into a corner of the picture."""
    return tuple(textwrap.wrap(line, WIDE))


def moment_of(old: Character, new: Character, alpha: float) -> tuple[Plan, float] | None:
    """The jump that is drawn, and how far it is [s], `alpha` of the way between two worlds."""
    after, before = plan_of(new), plan_of(old)
    if after is None:
        return None
    start = before[1] if before is not None and before[0] is after[0] else 0.0
    return after[0], start + alpha * (after[1] - start)


# --- the arc

def aimed(seen: Preview) -> list[Sketch]:
    """The arc that would be flown, and the ring where it lands; who aims stands between them and the camera."""
    tint = CANNOT if seen.fault else CAN
    return [replace(sketch, through=True) for sketch in ring(seen.place, tint) + _arc(seen.arc, seen.beads, tint, 1.0)]


def flown(plan: Plan, time: float) -> list[Sketch]:
    """The arc of a jump that is made, fading once it has landed."""
    left = 1.0 - max(time - plan.touch_down, 0.0) / FADE
    if left <= 0.0:
        return []
    place = plan.feet[:, :3].mean(0)
    place[1] = plan.feet[:, 1].min() - 0.02
    return _arc(*_flight(plan.path), SEEN, left) + (ring(place, SEEN) if left == 1.0 else [])


def _arc(arc: np.ndarray, beads: np.ndarray, tint, opacity: float) -> list[Sketch]:
    if not np.isfinite(arc).all():
        return []
    return [Line("jump", arc, tint, 0.036, (0.8 * opacity, opacity)),
            *(Dot("jump", bead, PALE, 0.030 * opacity) for bead in beads)]


def ring(place: np.ndarray, tint, radius: float = RING) -> list[Sketch]:
    """Two circles on the floor."""
    angle = np.linspace(0.0, math.tau, 49)
    circle = np.stack([np.sin(angle), np.zeros(49), np.cos(angle)], 1)
    middle = place + [0.0, LIFT, 0.0]
    return [Patch("jump", middle + radius * circle[:-1], tint, 0.3),
            Line("jump", middle + radius * circle, tint, 0.045, flat=True),
            Line("jump", middle + [0.0, 0.001, 0.0] + 0.3 * radius * circle, tint, 0.035, flat=True)]


# --- balance

@dataclass(frozen=True, eq=False)
class _Body:
    """A drawn body: whose, how it stands."""

    physique: Physique
    figure: Figure
    centre: np.ndarray
    floor: float
    polygon: np.ndarray  # (H, 2) [m]

    @staticmethod
    def of(character: Character, figure: Figure) -> _Body:
        jump, skeleton = jump_of(character), character.controller.skeleton
        physique = Physique() if jump is None else jump.physique
        at, turned = np.asarray(figure.positions, float), np.asarray(figure.orientations, float)
        corners = sole_corners(skeleton, at, turned)[standing_corners(figure.contacts)]
        centre = centre_of_mass(physique.anatomy, at, turned)
        return _Body(physique, figure, centre, float(character.state.floor), hull(corners[:, [0, 2]]))

    def on_floor(self, flat: np.ndarray, lift: float = LIFT) -> np.ndarray:
        """Points (N, 2) on the floor that carries it."""
        return np.insert(np.atleast_2d(flat), 1, self.floor + lift, axis=1)

    def nearest(self, flat: np.ndarray) -> np.ndarray:
        """The point (2,) of the support polygon's edge nearest to one (2,)."""
        ends = np.roll(self.polygon, -1, 0) - self.polygon
        part = np.sum((flat - self.polygon) * ends, 1) / np.maximum(np.sum(ends * ends, 1), 1e-12)
        feet = self.polygon + np.clip(part, 0.0, 1.0)[:, None] * ends
        return feet[np.argmin(np.linalg.norm(feet - flat, axis=1))]


def balance(body: _Body, props: Sequence[Prop]) -> list[Sketch]:
    """Centre of mass, the polygon that carries it, and how far inside it is."""
    flat = body.centre[[0, 2]]
    below = floor_at(*flat, props, body.centre[1])
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


# --- forces

def planned(plan: Plan, time: float) -> np.ndarray:
    """The ground's force (3,) [N] on somebody who jumps."""
    return np.array([np.interp(time, plan.times, plan.forces[:, k]) for k in range(3)])


def pushed(old: Character, new: Character, physique: Physique, gravity: float) -> np.ndarray:
    """The ground's force (3,) [N] on somebody who stands or walks, f = m (a − g), from how the centre of mass moved
    over the last three poses; none without a foot on the floor. It trembles a little where feet are corrected."""
    if not np.asarray(new.state.contacts).any():
        return np.zeros(3)
    weight = physique.mass * gravity * np.array([0.0, 1.0, 0.0])
    poses = (old.state.previous, old.state.pose, new.state.pose)
    if poses[0] is None or new.state.elapsed <= 0.0 or new is old:
        return weight
    placed = forward_kinematics(physique.skeleton, *(np.stack([np.asarray(getattr(p, part), float) for p in poses])
                                                     for part in ("root", "rotations")))
    push = physique.mass * np.diff(centre_of_mass(physique.anatomy, *placed), 2, axis=0)[0] / new.state.elapsed**2 + weight
    return push * min(max(push[1], 0.0) / max(abs(push[1]), 1e-9), MOST_DRAWN * weight[1] / max(np.linalg.norm(push), 1e-9))


def forces(body: _Body, push: np.ndarray, gravity: float) -> list[Sketch]:
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


def muscles(body: _Body) -> list[Sketch]:
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
    return tuple(float(np.interp(part, np.linspace(0.0, 0.75, 4), stops[:, k])) for k in range(3))


def _curve(start: np.ndarray, over: np.ndarray, end: np.ndarray) -> np.ndarray:
    """A smooth curve (13, 3) that passes `over` a joint."""
    t = np.linspace(0.0, 1.0, 13)[:, None]
    bow = 2.0 * over - 0.5 * (start + end)
    return (1.0 - t)**2 * start + 2.0 * t * (1.0 - t) * bow + t**2 * end


def leg_bends(turned: np.ndarray, hip: int) -> np.ndarray:
    """How far hip, knee and ankle of a leg are bent (3,) [rad], as its muscles see it."""
    return np.array([-bend_kernel(turned[0], turned[hip]), bend_kernel(turned[hip], turned[hip + 1]),
                     POINTED - bend_kernel(turned[hip + 1], turned[hip + 2])])
