"""Measure taps of the jump near small boxes: how soon feet are on top, how far he steps back first, and who is refused, after how long and why.

    python scripts/measure/near_boxes.py [--high 0.2,0.3,0.4] [--ways rest,walk,"held up"] [--verbose]

Hands hold the stick at the box, straight or askew, and tap the jump: as they set off from rest so far from it, as they walk and are so far from it, or are held up by it, or once they are held up before it. They hold
the stick on until he is in the air, or has been told why not. Told is the time from the key going down to a foot on top.
"""

from __future__ import annotations

import argparse
import os
from collections import Counter
from typing import Any, NamedTuple

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one thread: what a game has
import numpy as np

from _struck_rooms import deepest

from gambol.controllers.contract import CharacterState
from gambol.controllers.person import person
from gambol.game.input import Wish
from gambol.game.scene import Box
from gambol.game.session import Timeline, begin, refused
from gambol.game.world import DT, Character, World

DISTANCES, ASKEW = (0.2, 0.35, 0.5, 0.65, 0.8, 1.0, 1.2), (0.0, 15.0, 30.0, 45.0)
"""How far from the box [m] the middle of the body is as hands tap; and how far aside of the box's normal it goes [°]."""
TAPS, LASTS, FAR, STANDS, LONGEST = 0.1, 4.5, 1.6, 1.0, 2.5
"""So long the key is held, and so long he is looked at from there [s]; who walks comes from so much farther away [m]; who is held up has stood so long there,
or goes along it after so long [s]."""
DEEP, WIDE = 1.5, 4.0
"""How deep the box is, and how wide [m]."""
WAYS = "rest", "walk", "held up"


class Tapped(NamedTuple):
    """What became of a tap: after how long feet are on top, infinite where they never are; how far [m] he has gone back; how deep [m] flesh was in the box; what he was told, and after how long [s]."""

    states: list[CharacterState]
    on_top: float
    off: float
    back: float
    deep: float
    why: tuple[str, ...]
    waits: float


def tapped(who: Any, way: str, high: float, far: float, askew: float) -> Tapped:
    """What becomes of one. far: from the box [m]; he goes `askew` [°] aside of its normal."""
    angle = np.radians(askew)
    ahead = np.array([np.sin(angle), np.cos(angle)])
    box = Box((0.0, 0.5 * high, 0.5 * DEEP), (WIDE, high, DEEP))  # its edge lies at z = 0
    far /= float(ahead[1])  # along his way
    begins = far if way == "rest" else far + FAR
    x, z = -begins * ahead
    line = Timeline(begin(World((Character("A", who, who.start((x, z, angle))),), (box,)), 1))
    states, why, waits, pressed, held = [], [], np.inf, None, 0
    while pressed is None or len(states) - pressed < LASTS / DT:
        state = line.now.after.characters[0].state
        gone = -float(np.asarray(state.ground[:2], float) @ ahead)
        speed = float(np.hypot(state.velocity[0], state.velocity[2]))
        held = held + 1 if speed < 0.1 and len(states) > 1.0 / DT else 0
        if pressed is None and (len(states) * DT > 0.5 if way == "rest" else gone <= far or held if way == "walk" else held * DT > STANDS or len(states) * DT > LONGEST):
            pressed = len(states)
        on = (pressed is not None or way != "rest") and not why and not (pressed is not None and state.active == "jump" and not np.any(state.contacts))
        yaw, before = line.now.players[0].camera.yaw, line.now
        move = (float(on * np.sin(yaw - angle)), float(on * np.cos(yaw - angle)))
        line.advance((Wish(move=move, jump=pressed is not None and len(states) - pressed < TAPS / DT).rounded(),))
        states.append(line.now.after.characters[0].state)
        told = refused(before, line.now)
        if told and not why and pressed is not None:
            waits = (len(states) - pressed) * DT
        why += told
    after = states[pressed:]
    there = next((k * DT for k, s in enumerate(after) if abs(float(s.floor) - high) < 0.02 and np.any(s.contacts)), np.inf)
    off = next((k * DT for k, s in enumerate(after) if s.active == "jump" and not np.any(s.contacts)), np.inf)
    gone = np.array([float(np.asarray(s.ground[:2], float) @ ahead) for s in after[:max(round(min(off, LASTS) / DT), 1)]])
    back = float((np.maximum.accumulate(gone) - gone).max())
    return Tapped(states, there, off, back, deepest(who.parts["jump"].physique, states, (box,))[0], tuple(why), waits)


def told(name: str, some: list[Tapped]) -> str:
    """A line about some taps."""
    tops = np.array([one.on_top for one in some])
    went, back = tops[np.isfinite(tops)], np.array([one.back for one in some])
    line = f"{name}: {len(went)} of {len(some)} on top"
    line += f", {np.median(went):.2f} s after the key went down (median), {went.max():.2f} (worst)" if len(went) else ""
    line += f"; go back by more than 5 cm {np.sum(back > 0.05)}, {100 * back.max():.0f} cm at most; flesh in the box {100 * max(one.deep for one in some):.1f} cm at most"
    late = [one.waits for one in some if one.why]
    line += f"; refused {len(late)}, after {np.median(late):.2f} s (median), {max(late):.2f} (worst)" if late else ""
    line += f"; stepped or walked up, or nothing: {sum(not one.why and not np.isfinite(one.off) for one in some)}"
    for reason, count in Counter(" | ".join(one.why) for one in some if one.why).most_common():
        line += f"\n    {count} × {reason}"
    return line


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--high", default="0.2,0.3,0.4")
    parser.add_argument("--ways", default=",".join(WAYS))
    parser.add_argument("--verbose", action="store_true", help="a line for each tap")
    given, who = parser.parse_args(), person()
    for way in given.ways.split(","):
        for high in map(float, given.high.split(",")):
            some = []
            for askew in ASKEW:
                for far in {"rest": DISTANCES[:4], "walk": DISTANCES, "held up": DISTANCES[:1]}[way]:
                    one = tapped(who, way, high, float(far), askew)
                    some.append(one)
                    if given.verbose:
                        print(f"  {way} {high:g} m, {far:.1f} m away, {askew:g}° askew: off {one.off:.2f}, on top {one.on_top:.2f} s, back {100 * one.back:.0f} cm, deep {100 * one.deep:.1f} cm"
                              f"{f', told after {one.waits:.2f} s: ' if one.why else ''}{' | '.join(one.why)}", flush=True)
            print(told(f"{way}, box of {high:g} m", some), flush=True)


if __name__ == "__main__":
    main()
