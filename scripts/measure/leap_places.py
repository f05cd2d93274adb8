"""Measure leaps of walkers to a place: on level ground, onto and off a low box, up and down a ramp, over a gap, ahead and askew.

    python scripts/measure/leap_places.py [--phases 8] [--only level,up,...] [--speeds 1.2,1.6] [--verbose]

By a script, as scenarios and journeys ask it: somebody walks straight on, and is to leap to a place some metres ahead, which lies at many moments of a stride. Then he
walks on. Told is how many leaps are refused; how far before the place he begins; how long it takes to the air from then on; how fast he leaves along the floor over how fast
he came; how much of his speed he keeps, the least over 0.1 s and in the mean, until 0.6 s after touch-down; on how many feet he lands; and how hands, hips, knees and soles
move meanwhile, as in `leap_ways.py`.
"""

from __future__ import annotations

import argparse
import os
from collections import Counter
from collections.abc import Iterator
from typing import Any, NamedTuple

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one thread: what a game has
import numpy as np

from leap_ways import OVER, moved

from gambol.controllers.contract import CharacterState
from gambol.controllers.jump import Jumping
from gambol.controllers.locomotion import Locomotion, Settings
from gambol.controllers.person import person
from gambol.game.input import Jump, Move, Script
from gambol.game.scene import Box
from gambol.game.world import DT, RATE, Character, World, stopped

SPEEDS = 1.1, 1.2, 1.3, 1.45, 1.6, 1.75
"""How fast they walk [m/s]."""
FAR, STRIDE = 4.0, 0.8
"""How far the place is at least [m], and so much farther, over so many seconds of going."""
UP, STEEP, GAP, BEYOND = (0.2, 0.35), (10, 15), (0.4, 0.7), 0.3
"""How high boxes are [m], how steep ramps [°], how wide gaps [m], and how far beyond edges the place lies [m]."""
ASKEW, ASKED = (20, 40), 1.3
"""How far aside of his way a place lies of which he is told as he is so near [°, m]."""
LASTS = 9.0
"""So long they are looked at [s]."""


class Way(NamedTuple):
    """A way to a place: its group and name, what stands there, where he starts z [m], and how high, where the place is (3,) [m], and from how near he is told it [m],
    None for where scripts ask."""

    group: str
    name: str
    things: tuple[Box, ...]
    begins: float
    floor: float
    place: tuple[float, float, float]
    within: float | None = None


def ways(extra: float) -> Iterator[Way]:
    """All ways, with places so much farther [m]."""
    far = FAR + extra
    yield Way("level", "level", (), 0.0, 0.0, (0.0, 0.0, far))
    for up in UP:
        yield Way("up", f"{up:g} m up", (Box((0.0, 0.5 * up, far - BEYOND + 8.0), (6.0, up, 16.0)),), 0.0, 0.0, (0.0, up, far))
        yield Way("down", f"{up:g} m down", (Box((0.0, 0.5 * up, far - BEYOND - 6.0), (6.0, up, 12.0)),), 0.0, up, (0.0, 0.0, far))
    for wide in GAP:
        near, other = Box((0.0, 0.5, far - BEYOND - wide - 6.0), (6.0, 1.0, 12.0)), Box((0.0, 0.5, far - BEYOND + 8.0), (6.0, 1.0, 16.0))
        yield Way("gaps", f"{wide:g} m gap", (near, other), 0.0, 1.0, (0.0, 1.0, far))
    for steep in STEEP:
        rise = float(np.tan(np.radians(steep)))
        deep = 40.0 * rise
        ramp = Box((0.0, 0.5 * deep, 0.0), (40.0, deep, 40.0), slope=rise)
        for name, sign in (("uphill", 1.0), ("downhill", -1.0)):
            at = -10.0 * sign
            yield Way("ramps", f"{steep}° {name}", (ramp,), at, rise * (40.0 + at), (0.0, rise * (40.0 + at + sign * far), at + sign * far))
    for aside in ASKEW:
        angle = float(np.radians(aside))
        for sign in (1.0, -1.0):
            yield Way("askew", f"{aside}° aside", (), 0.0, 0.0, (sign * ASKED * float(np.sin(angle)), 0.0, far + ASKED * float(np.cos(angle))), ASKED)


def gone(who: Any, way: Way, speed: float) -> tuple[list[CharacterState], str]:
    """All states of one who walks so fast [m/s] and leaps, and why he did not."""
    heading = 0.0 if way.place[2] > way.begins else float(np.pi)
    walks = Move(LASTS, (speed, 0.0, 0.0), jump=Jump(way.place, within=way.within))
    script = Script((walks, Move(LASTS, (speed, 0.0, 0.0))))
    world, states = World((Character("A", who, who.start((0.0, way.begins, heading), way.floor)),), way.things), []
    for _ in range(round(LASTS * RATE)):
        state = world.characters[0].state
        states.append(state)
        script, intent = script.step(state, DT)
        script, intent = script.held(who, state, intent, way.things, DT)
        world = world.step([intent if script.leaps else stopped(state, intent, way.things)])
    return states, script.refused[0] if script.refused else ""


class Leapt(NamedTuple):
    """What became of a leap, see the docstring; why: what kept him, "" if he leapt."""

    why: str
    before: float = 0.0
    delay: float = 0.0
    leaves: float = 0.0
    kept: float = 0.0
    whole: float = 0.0
    single: float = 0.0
    hands: float = 0.0
    hips: float = 0.0
    knees: float = 0.0
    slides: float = 0.0
    apart: float = 0.0


def leapt(who: Any, way: Way, speed: float) -> Leapt:
    """What became of one."""
    states, why = gone(who, way, speed)
    memories = [s.memory.memory if s.active == "jump" and isinstance(s.memory.memory, Jumping) else None for s in states]
    at = next((k for k, memory in enumerate(memories) if memory is not None), None)
    if at is None:
        return Leapt(why or "nothing")
    memory = memories[at]
    assert memory is not None
    if memory.fault or any(one is not None and one.fault for one in memories):
        return Leapt("fell")
    made = memory.plan
    down = at + int(made.touch_down * RATE)
    place = np.array([np.asarray(s.pose.root)[[0, 2]] for s in states])
    came = place[at - 1] - place[at - 1 - OVER]
    pace = float(np.linalg.norm(came)) * RATE / OVER
    until = min(down + 36, len(place) - 1)
    paces = np.linalg.norm(place[OVER:] - place[:-OVER], axis=1) * RATE / OVER
    return Leapt("", float(np.linalg.norm(np.array(way.place)[[0, 2]] - place[at])), made.take_off, float(np.linalg.norm(made.path.velocity[[0, 2]])) / pace,
                 float(paces[at:until - OVER].min()) / pace, float(np.linalg.norm(place[until] - place[at - 1])) * RATE / (until + 1 - at) / pace,
                 float(made.path.lands is not None), *moved(states[at - OVER:until], who.skeleton))


def told(name: str, some: list[Leapt]) -> str:
    """A line about some leaps."""
    made, reasons = [one for one in some if not one.why], Counter(" ".join(one.why.split()[:14]) for one in some if one.why)
    line = f"  {name}: {len(some)}, {len(some) - len(made)}"
    if made:
        before, delay, leaves, kept, whole, single, hands, hips, knees, slides, apart = np.array([one[1:] for one in made]).T
        line += (f"; {np.median(before):.2f}; {np.median(delay):.2f}, {delay.max():.2f}; {100 * np.median(leaves):.0f}, {100 * leaves.min():.0f} … {100 * leaves.max():.0f}; "
                 f"{100 * np.median(kept):.0f}, {100 * kept.min():.0f}; {100 * np.median(whole):.0f}, {100 * whole.min():.0f}; {single.sum():.0f}; {np.median(hands):.0f}, {hands.max():.0f}; "
                 f"{np.median(hips):.0f}; {np.median(knees):.0f}, {knees.max():.0f}; {100 * slides.max():.1f}; {100 * apart.min():.0f}")
    return line + "".join(f"\n      {count} × {why}" for why, count in reasons.most_common())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--phases", type=int, default=8)
    parser.add_argument("--only", default="level,up,down,gaps,ramps,askew")
    parser.add_argument("--speeds", default=",".join(str(speed) for speed in SPEEDS))
    parser.add_argument("--verbose", action="store_true", help="a line for each leap")
    given = parser.parse_args()
    if given.phases < 1:
        parser.error("--phases must be 1 or more")
    who = person(Locomotion.load(settings=Settings(idle=0.0)))
    print("Of how many, refused; so far before the place m, median; to the air s, median, longest; leaves as fast as he came %, median, least … most; speed kept at the least %, "
          "median, least; in the mean %, median, least; lands on one foot; hands m/s², median, most; hips m/s²; knees °/s², median, most; soles slide cm; legs apart cm")
    found: dict[str, list[Leapt]] = {}
    for speed in map(float, given.speeds.split(",")):
        for k in range(given.phases):
            for way in ways(speed * STRIDE * k / given.phases):
                if way.group not in given.only.split(","):
                    continue
                one = leapt(who, way, speed)
                if given.verbose:
                    print(told(f"{way.name}, {speed:g} m/s, {k}", [one]), flush=True)
                for name in (f"{way.name}", f"{way.group} at {speed:g} m/s"):
                    found.setdefault(name, []).append(one)
    for name in sorted(found):
        print(told(name, found[name]), flush=True)


if __name__ == "__main__":
    main()
