"""A jump that is aimed at: its arc and where it lands, whether the body can make it, where it could land if not."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from gambol.controllers.body import forward_kinematics
from gambol.controllers.contract import CharacterState, Leap
from gambol.controllers.jump import FRESH, RUNNING, Jump, Physique
from gambol.controllers.jump.body import Start, along
from gambol.controllers.jump.motion import Path, Plan
from gambol.controllers.jump.reach import Touch
from gambol.controllers.navigation import floor_at

from ..input import Aim, jumping, landing, leaving
from ..scene import Dot, Figure, Goal, Line, Patch, Prop, Sketch
from ..world import Character, World, jump_of

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
BEAT = 0.1
"""From one bead of an arc to the next [s]."""
FADE = 0.5
"""So long after landing the arc is gone [s]."""
STRIKES = 0.2
"""So far ahead of its centre of mass a runner's foot strikes [m], at standard height."""
SINKS = 0.7
"""So fast a runner's centre of mass sinks as a foot strikes [m/s]."""
ALIKE = 0.03
"""A body that has moved by less [m], and aims as much to the side at a metre, reaches the same places."""

HITS = "would hit"
"""What is said of jumps in which something is touched."""


@dataclass(frozen=True, eq=False)
class Preview:
    """A jump that is aimed at.

    stand, place: (3,) [m] the middle of the feet, and where it is to land. arc, beads: (N, 3), (M, 3) [m] where the centre
    of mass goes, and where it is on every beat. fault: why it can't be made; empty if it can. nearest: (3,) [m] the place
    nearest to it that can be reached; None where there is none. heading: [rad] in which it is to land, None where nobody said so.
    planned: whether it was planned and swept, not only looked at; touch: what it would touch then, and how the body would lie in it.
    """

    stand: np.ndarray
    place: np.ndarray
    arc: np.ndarray
    beads: np.ndarray
    fault: str
    nearest: np.ndarray | None = None
    heading: float | None = None
    planned: bool = False
    touch: Touch | None = None

    @property
    def why(self) -> str:
        """Why it can't be made, as somebody who plays is told."""
        if not self.fault or self.nearest is None:
            return self.fault
        beyond, reach = (float(np.linalg.norm(way[[0, 2]])) for way in (self.place - self.nearest, self.nearest - self.stand))
        if self.fault.startswith("too far:") and beyond > 0.05:
            return f"{beyond:.1f} m farther than this body can jump"
        return f"{self.fault}; it can jump {reach:.1f} m that way"


def plan_of(character: Character) -> tuple[Plan, float] | None:
    """The jump that somebody makes and how far it is [s]; None while they don't."""
    made = jumping(character.state)
    return None if made is None else (made.plan, made.time)


def preview(character: Character, aim: Aim, props: Sequence[Prop], before: Preview | None = None) -> Preview | None:
    """The jump that would be made if the button were let go now; None while nobody aims or one jumps.

    before: what was seen a moment ago, whose nearest place is kept as long as it is one.
    """
    jump = jump_of(character.controller)
    if jump is None or leaving(character.state):
        return None
    leap = aim.target(landing(jump, character.state), props, -float(jump.gravity[1]), jump.longest)
    if leap is None:
        return None
    solid, state = [prop for prop in props if not isinstance(prop, Goal)], jump.landing(character.controller.active(character.state)[1])
    seen = previewed(jump, state, leap, solid)
    if aim.moving or leap.place is None:
        return seen
    start, floor = _pushing(jump, jump.start_of(state, leap)), float(state.floor)
    if solid and np.linalg.norm(start.velocity[[0, 2]]) < RUNNING:  # a runner's feet move on in every frame
        seen = _swept(jump, start, leap, floor, solid, seen) if before is None or not before.planned or _moved(before, seen) else \
            replace(seen, fault=seen.fault or before.fault, planned=True, touch=before.touch)
    if not seen.fault:
        return seen
    if before is not None and _same_way(before, seen):
        return replace(seen, nearest=before.nearest)
    return replace(seen, nearest=jump.nearest(start, seen.place, floor, leap.airtime, solid))


def _swept(jump: Jump, start: Start, leap: Leap, floor: float, solid: Sequence[Prop], seen: Preview) -> Preview:
    """The same preview once the leap has been planned and swept: with what it touches, if it can't be made for that."""
    seen, found = replace(seen, planned=True), jump.touching(start, seen.place, floor, leap.airtime, solid)
    if found is None or not seen.fault and jump.attempt(start, seen.place, floor, leap.airtime, solid)[0] is not None:
        return seen
    return replace(seen, fault=found.reason, touch=found) if not seen.fault or HITS in seen.fault else seen


def previewed(jump: Jump, state: CharacterState, leap: Leap, solid: Sequence[Prop]) -> Preview:
    """A jump as it would be made from a state, among solid props."""
    start, floor = _pushing(jump, jump.start_of(state, leap)), float(state.floor)
    stand = jump.middle(start, floor)
    place = stand if leap.place is None else np.asarray(leap.place, float)
    way, why = jump.survey(start, place, floor, leap.airtime, solid)
    return Preview(stand, place, *_flight(way), why, heading=leap.heading)


def _pushing(jump: Jump, start: Start) -> Start:
    """A runner who can't push off yet, as its next foot strikes: the arc stays what it is in every step."""
    flat = start.velocity * [1.0, 0.0, 1.0]
    pace = float(np.linalg.norm(flat))
    if pace < RUNNING:
        return start
    ahead = (start.feet[:, :3] - start.centre) @ flat / pace
    if start.single is not None and -ahead[start.single] < FRESH:
        return start
    foot, feet, rates, velocity = int(np.argmax(ahead)), start.feet.copy(), start.feet_rates.copy(), start.velocity.copy()
    feet[foot, :3] += (STRIKES * jump.physique.height / Physique.height - ahead[foot]) * flat / pace
    rates[foot], velocity[1] = 0.0, min(velocity[1], -SINKS)
    return replace(start, single=foot, feet=feet, feet_rates=rates, velocity=velocity)


def _moved(before: Preview, now: Preview) -> bool:
    """Whether a jump is another one than a moment ago."""
    return bool(np.linalg.norm(before.place - now.place) > ALIKE or np.linalg.norm(before.stand - now.stand) > ALIKE)


def _same_way(before: Preview, now: Preview) -> bool:
    """Whether what can be reached on the way to a place is what it was a moment ago."""
    if not before.fault or abs(before.place[1] - now.place[1]) > ALIKE or np.linalg.norm(before.stand - now.stand) > ALIKE:
        return False
    old, new = ((one.place - one.stand)[[0, 2]] for one in (before, now))
    if before.nearest is None:
        return float(np.linalg.norm(old - new)) < ALIKE
    reach = float(np.linalg.norm((before.nearest - before.stand)[[0, 2]]))
    aside = np.linalg.norm(old / np.linalg.norm(old) - new / np.linalg.norm(new))
    return bool(aside < ALIKE and np.linalg.norm(new) > reach)


def _flight(way: Path) -> tuple[np.ndarray, np.ndarray]:
    """Points (33, 3) of an arc, and one for every beat."""
    times, beats = np.linspace(0.0, way.airtime, 33), np.arange(BEAT, way.airtime, BEAT)
    arc, beads = (along(way.leave, way.velocity, t, way.gravity) for t in (times, beats))
    return arc, beads


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
    return _arc(*_flight(plan.path), SEEN, left) + (ring(place, SEEN) if left == 1.0 else [])


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
