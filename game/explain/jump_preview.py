"""A jump that is aimed at: its arc and where it lands, whether the body can make it, where it could land if not."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from concurrent.futures import Executor, Future
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from gambol.controllers.contract import CharacterState, Leap
from gambol.controllers.jump import FRESH, LIKE, RUNNING, Jump, Physique, goes
from gambol.controllers.jump.body import Start, along
from gambol.controllers.jump.motion import Path, Plan
from gambol.controllers.jump.reach import Touch
from gambol.controllers.navigation import clearance

from ..input import AHEAD, Aim, jumping, landing, leaving
from ..scene import Goal, Prop
from ..world import Character, jump_of

BEAT = 0.1
"""From one bead of an arc to the next [s]."""
STRIKES = 0.2
"""So far ahead of its centre of mass a runner's foot strikes [m], at standard height."""
SINKS = 0.7
"""So fast a runner's centre of mass sinks as a foot strikes [m/s]."""
ALIKE, TURNED = 0.03, 0.1
"""A body that has moved by less [m], and aims as much to the side at a metre, reaches the same places, if it is to land turned by less than the second [rad]."""

CARRIED = 0.75
"""The ring of who goes slowly lies where he is in so long [s]; of who goes faster, nearer and nearer to where that of a runner lies."""
BESIDE = 1.2
"""What is farther from a runner's arc [m] is nothing that he would touch."""
NO = "no jump"
"""So begins what is told of jumps that can't be made."""
HITS = "would hit"
"""What is said of jumps in which something is touched."""


class _AtOnce(Executor):
    """Does what it is given at once."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """What comes of it."""
        done: Future[Any] = Future()
        done.set_result(fn(*args, **kwargs))
        return done


AT_ONCE = _AtOnce()


@dataclass(frozen=True, eq=False)
class Preview:
    """A jump that is aimed at.

    stand, place: (3,) [m] the middle of the feet, and where it is to land. arc, beads: (N, 3), (M, 3) [m] where the centre
    of mass goes, and where it is on every beat. fault: why it can't be made; empty if it can. nearest: (3,) [m] the place
    nearest to it that can be reached; None where there is none. heading: [rad] in which it is to land, None where nobody said so.
    slack: so far from the place it may land [m].
    sought: whether all was found out about it that takes long; seeking: that, as long as it is sought; found: what was found so last, where the ring was
    then. touch: what it would touch, and how the body would lie in it.
    """

    stand: np.ndarray
    place: np.ndarray
    arc: np.ndarray
    beads: np.ndarray
    fault: str
    nearest: np.ndarray | None = None
    heading: float | None = None
    slack: float = 0.0
    sought: bool = False
    seeking: Future[Preview] | None = None
    found: Preview | None = None
    touch: Touch | None = None

    @property
    def why(self) -> str:
        """Why it can't be made, as somebody who plays is told."""
        if not self.fault or self.nearest is None:
            return self.fault
        beyond, reach = (float(np.linalg.norm(way[[0, 2]])) for way in (self.place - self.nearest, self.nearest - self.stand))
        if self.fault.startswith("too far:") and beyond > 0.05:
            return f"{beyond:.1f} m farther than this body can jump"
        return f"{self.fault}; " + (f"it can jump {reach:.1f} m that way" if reach > ALIKE else "it can't jump that way")

    @property
    def told(self) -> str:
        """What somebody who aims is told: that it can't be made, or that it leads to the nearest place instead; "" if it can."""
        if self.nearest is None or not self.fault.startswith("too far:") or not np.linalg.norm(self.place - self.nearest) <= self.slack:
            return self.fault and f"{NO}: {self.why}"
        return f"{self.why}: it lands in the green ring"


def plan_of(character: Character) -> tuple[Plan, float] | None:
    """The jump that somebody makes and how far it is [s]; None while they don't."""
    made = jumping(character.state)
    return None if made is None else (made.plan, made.time)


def preview(character: Character, aim: Aim, props: Sequence[Prop], before: Preview | None = None, crew: Executor = AT_ONCE,
            sweeps: bool = True) -> Preview | None:
    """The jump that would be made if the button were let go now; None while nobody aims or one jumps.

    before: what was seen a moment ago; what was found out about it is kept as long as it is the same jump. crew: who finds that out, which takes
    up to half a second among things: until then it is seen without. sweeps: whether it is planned and swept where things stand about.
    """
    jump = jump_of(character.controller)
    if jump is None or not aim.wants or leaving(character.state):  # what is not aimed may still be being compiled
        return None
    leap = aim.target(landing(jump, character.state), props, -float(jump.gravity[1]), jump.longest, reaches=jump.about)
    if leap is None:
        return None
    solid, state = [prop for prop in props if not isinstance(prop, Goal)], jump.landing(character.controller.active(character.state)[1])
    seen = previewed(jump, state, leap, solid)
    if leap.place is None:
        return seen
    start, floor = jump.placed(state, leap, solid)
    start = _pushing(jump, start)
    if aim.moving:
        return _running(jump, start, leap, floor, solid, seen, before, crew) if sweeps else seen
    runs = bool(np.linalg.norm(start.velocity[[0, 2]]) >= RUNNING)
    sweeps = sweeps and bool(solid) and not runs  # who has let go is swept as he leaps
    found, seeking = (None, None) if before is None else (before.found, before.seeking)
    if seeking is not None and seeking.done():
        found, seeking = seeking.result(), None
    known = _with(seen, found, sweeps)
    if known.sought or not sweeps and not seen.fault:
        return known
    if before is not None and seeking is not None:
        if not _moved(before, seen) or seen.fault and _same_way(before, seen):  # how far it can get that way is sought on while the ring moves on
            return replace(known, seeking=seeking)
        seeking.cancel()
    seeking = (AT_ONCE if runs else crew).submit(_sought, jump, start, leap, floor, solid, seen, sweeps)
    return _with(seen, seeking.result(), sweeps) if seeking.done() else replace(known, seeking=seeking)


def _running(jump: Jump, start: Start, leap: Leap, floor: float, solid: Sequence[Prop], seen: Preview, before: Preview | None, crew: Executor) -> Preview:
    """The same preview of who runs, with what he would have touched as this was last found out, which begins anew as soon as it is: he is
    elsewhere in every frame."""
    if clearance(seen.arc, solid).min() >= BESIDE:
        return seen
    seeking = None if before is None else before.seeking
    if before is not None and seeking is not None:
        found = seeking.result() if seeking.done() else before
        seen = replace(seen, touch=found.touch, fault=seen.fault or found.fault if found.touch is not None else seen.fault)
    if seeking is None or seeking.done():
        seeking = crew.submit(_swept, jump, start, leap, floor, solid, replace(seen, touch=None, fault=""))
    return replace(seen, seeking=seeking)


def _with(seen: Preview, found: Preview | None, sweeps: bool) -> Preview:
    """A preview with what was found out last; of a ring that has moved on since with the nearest place alone, if it lies on the same way.
    sweeps: whether what it touches has to be found out, too."""
    if found is None:
        return seen
    if not _moved(found, seen):
        return replace(seen, fault=found.fault or seen.fault, nearest=found.nearest, sought=True, touch=found.touch, found=found)
    if _same_way(found, seen):
        return replace(seen, nearest=found.nearest, sought=not sweeps, found=found)
    return replace(seen, found=found)


def _sought(jump: Jump, start: Start, leap: Leap, floor: float, solid: Sequence[Prop], seen: Preview, sweeps: bool) -> Preview:
    """The same preview with what it touches, if it is to be planned and swept, and with the nearest place, if it can't be made."""
    seen = _swept(jump, start, leap, floor, solid, seen) if sweeps else seen
    return replace(seen, nearest=jump.nearest(start, seen.place, floor, leap.airtime, solid)) if seen.fault else seen


def _swept(jump: Jump, start: Start, leap: Leap, floor: float, solid: Sequence[Prop], seen: Preview) -> Preview:
    """The same preview once the leap has been planned and swept: with what it touches, if it can't be made for that."""
    found = jump.touching(start, seen.place, floor, leap.airtime, solid)
    if found is None or not seen.fault and jump.attempt(start, seen.place, floor, leap.airtime, solid)[0] is not None:
        return seen
    return replace(seen, fault=found.reason, touch=found) if not seen.fault or HITS in seen.fault else seen


def previewed(jump: Jump, state: CharacterState, leap: Leap, solid: Sequence[Prop]) -> Preview:
    """A jump as it would be made from a state, among solid props."""
    start, floor = jump.placed(state, None if leap.along else leap, solid)
    start = _pushing(jump, replace(start, along=False, bound=False))
    stand = jump.middle(start, floor)
    if leap.along:  # he waits for the foot that carries him there
        way = goes(state)
        pace = max(float(np.linalg.norm(way)), 1e-9)
        place = stand + float(np.interp(pace, LIKE, (CARRIED, AHEAD[0] / pace + AHEAD[1]))) * way
        return Preview(stand, place, *flight(jump.path(start, place, floor)), "", heading=leap.heading)
    place = stand if leap.place is None else np.asarray(leap.place, float)
    way, why = jump.survey(start, place, floor, leap.airtime, solid)
    return Preview(stand, place, *flight(way), why, heading=leap.heading, slack=leap.slack)


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
    return bool(np.linalg.norm(before.place - now.place) > ALIKE or np.linalg.norm(before.stand - now.stand) > ALIKE or _turned(before, now))


def _turned(before: Preview, now: Preview) -> bool:
    """Whether it is to land in another heading, with which it reaches other places."""
    if before.heading is None or now.heading is None:
        return before.heading is not now.heading
    return abs(math.remainder(before.heading - now.heading, math.tau)) > TURNED


def _same_way(before: Preview, now: Preview) -> bool:
    """Whether what can be reached on the way to a place is what it was a moment ago."""
    if not before.fault or abs(before.place[1] - now.place[1]) > ALIKE or np.linalg.norm(before.stand - now.stand) > ALIKE or _turned(before, now):
        return False
    old, new = ((one.place - one.stand)[[0, 2]] for one in (before, now))
    if before.nearest is None:
        return float(np.linalg.norm(old - new)) < ALIKE
    reach = float(np.linalg.norm((before.nearest - before.stand)[[0, 2]]))
    aside = np.linalg.norm(old / np.linalg.norm(old) - new / np.linalg.norm(new))
    return bool(aside < ALIKE and np.linalg.norm(new) > reach)


def flight(way: Path) -> tuple[np.ndarray, np.ndarray]:
    """Points (33, 3) of an arc, and one for every beat."""
    times, beats = np.linspace(0.0, way.airtime, 33), np.arange(BEAT, way.airtime, BEAT)
    arc, beads = (along(way.leave, way.velocity, t, way.gravity) for t in (times, beats))
    return arc, beads
