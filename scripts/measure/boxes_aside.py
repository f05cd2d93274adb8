"""Walk or run by a script, and be told to leap onto the middle of a box that lies anywhere ahead or aside: who ends on it, who is lifted, falls or is refused, and why.

    python scripts/measure/boxes_aside.py [--count 40] [--seed 0] [--stands] [--verbose]

Boxes are 0.3 to 0.6 m high, 1 to 1.6 m wide, turned anyhow, 1.2 to 3.5 m away as he is told, 0 to 90° aside of his way; he goes at 0.9 to 2.8 m/s. `--stands`: of each who is refused it is
found out whether he could leap there from a stand anywhere round the box.
"""

from __future__ import annotations

import argparse
import math
import os
from collections import Counter
from typing import Any, NamedTuple

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one thread: what a game has
import numpy as np

from gambol.controllers.contract import Intent, Leap
from gambol.controllers.navigation import STEP, floor_at, room
from gambol.controllers.person import person
from gambol.game.input import Jump, Move, Script
from gambol.game.scene import Box
from gambol.game.world import DT, Character, World, stopped

HIGH, ASIDE, PACES = (0.3, 0.4, 0.5, 0.6), (0, 15, 30, 45, 60, 90), (0.9, 1.3, 1.5, 2.0, 2.8)
"""[m], [°], [m/s]."""
LEAD, FAR, WIDE, TURNED = (1.5, 3.0), (1.2, 3.5), (1.0, 1.6), 45.0
"""How far he goes until he is told; how far away the box's middle is then; how wide it is [m], and turned at most [°]."""
LEAPS, STAYS, LIFTED = 8.0, 1.5, 0.2
"""So long he may take to leap, and so long he stands there [s]; who gets so much higher in a step without a leap was lifted [m]."""


class Told(NamedTuple):
    """A box, the floor's middle of its top (3,), how fast he goes [m/s], how far he has gone as he is told [m], and how far aside it lies then [°]."""

    box: Box
    place: np.ndarray
    pace: float
    lead: float
    aside: float


def drawn(rng: np.random.Generator) -> Told:
    """One of them, at random."""
    high, aside, pace = float(rng.choice(HIGH)), float(rng.choice(ASIDE) * rng.choice([-1, 1])), float(rng.choice(PACES))
    lead, far, wide, turned = (float(rng.uniform(*of)) for of in (LEAD, FAR, WIDE, (-TURNED, TURNED)))
    x, z = far * math.sin(math.radians(aside)), lead + far * math.cos(math.radians(aside))
    return Told(Box((x, 0.5 * high, z), (wide, high, wide), math.radians(turned)), np.array([x, high, z]), pace, lead, aside)


def outcome(who: Any, told: Told) -> tuple[str, float, str]:
    """What becomes of one: "stays", "lifted", "fell" or "refused", after how long he is on the box, from when he was told [s], and why he is refused."""
    things, place = (told.box,), told.place
    jump = Jump(tuple(map(float, place)))
    script = Script((Move(told.lead / told.pace, (told.pace, 0.0, 0.0)), Move(LEAPS, (told.pace, 0.0, 0.0), jump=jump), Move(STAYS)))
    world, on, lifted, asked = World((Character("A", who, who.start()),), things), math.inf, False, 0
    for step in range(round((told.lead / told.pace + 2.0 * LEAPS + STAYS) / DT)):
        state = world.characters[0].state
        asked = asked or step * (script.index == 1)
        script, intent = script.step(state, DT)
        script, intent = script.held(who, state, intent, things, DT)
        world = world.step([intent if script.leaps else stopped(state, intent, things)])
        after = world.characters[0].state
        lifted |= state.active == after.active == "locomotion" and float(after.floor - state.floor) > LIFTED
        on = min(on, (step - asked) * DT if float(after.floor) > place[1] - 0.02 else math.inf)
        if script.done:
            break
    stays = float(world.characters[0].state.floor) > place[1] - 0.02
    kind = "lifted" if lifted else "stays" if stays else "fell" if math.isfinite(on) else "refused"
    return kind, on, script.refused[0].split(": ", 1)[-1] if script.refused else "still at it"


def stands(who: Any, told: Told) -> bool:
    """Whether somebody could leap there from a stand somewhere round the box."""
    things = (told.box,)
    for far in np.arange(0.6, 2.0, 0.1):
        for angle in np.radians(np.arange(0, 360, 20)):
            x, z = told.place[::2] + far * np.array([math.sin(angle), math.cos(angle)])
            if floor_at(x, z, things, STEP) < 0.01 and room(np.array([x, z]), 0.0, things) > 0.0 \
                    and not who.refusal(who.start((x, z, angle + math.pi)), Intent(leap=Leap(told.place), around=things)):
                return True
    return False


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--stands", action="store_true", help="whether who is refused could leap there from a stand")
    parser.add_argument("--verbose", action="store_true", help="a line for each")
    given = parser.parse_args()
    if given.count < 1:
        parser.error("--count must be 1 or more")
    who, rng = person(), np.random.default_rng(given.seed)
    counts, takes, could, whys = dict[float, Counter[str]](), list[float](), Counter[float](), Counter[str]()
    for _ in range(given.count):
        told = drawn(rng)
        while room(np.array([0.0, told.lead]), 0.0, (told.box,)) < 0.3 or room(np.zeros(2), 0.0, (told.box,)) < 0.3:
            told = drawn(rng)  # nobody is told in a box
        kind, on, why = outcome(who, told)
        high = float(told.place[1])
        counts.setdefault(high, Counter())[kind] += 1
        if kind == "stays":
            takes.append(on)
        elif kind == "refused":
            whys[" ".join(why.split()[:8])] += 1
            could[high] += given.stands and stands(who, told)
        if given.verbose:
            print(f"  {high:g} m high, {told.box.size[0]:.2f} m wide, {told.aside:g}° aside, {told.pace:g} m/s: {kind}" + (f", {on:.1f} s" if kind == "stays" else f", {why}"), flush=True)
    for high in sorted(counts):
        made = counts[high]
        print(f"{high:g} m high: {made.total()}; {made['stays']} end on it, {made['refused']} are refused" + (f" ({could[high]} of them though there is a stand)" if given.stands else "")
              + f", {made['lifted']} lifted, {made['fell']} fall off")
    if takes:
        print(f"on it after {np.median(takes):.1f} s, {max(takes):.1f} s at most")
    for why, count in whys.most_common():
        print(f"  {count} × {why}")


if __name__ == "__main__":
    main()
