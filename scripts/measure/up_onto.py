"""Walk up to a box by hand and leap onto it, as players do: how many get up, how soon, and what of a body ends in the box.

    python scripts/measure/up_onto.py [--count 100] [--seed 0]

Hands walk at a box of random height, width and heading. Half of them come to rest before it and then hold the leap's key, the stick ahead; the others press it as they
walk and let go of both. Nobody looks where the ring is. Who refuses says why.
"""

from __future__ import annotations

import argparse
import os
from collections import Counter
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one thread: what a game has
import numpy as np

from _struck_rooms import deepest

from gambol.controllers.contract import CharacterState
from gambol.controllers.jump import Jumping
from gambol.controllers.person import person
from gambol.game.input import Wish
from gambol.game.scene import Box
from gambol.game.session import Timeline, begin, refused
from gambol.game.world import DT, Character, World

KINDS = "rest, then leap", "leap as they walk"
HIGH, WIDE, ASKEW, FAR = (0.26, 0.55), (0.8, 2.5), 0.4, (1.0, 1.8)
"""Boxes: how high and wide [m], how much they are turned at most [rad], how far away [m]."""
HOLDS, RESTS, PRESSED = (0.5, 0.9), (2.0, 3.0), (0.7, 2.0)
"""So long the key is held; so long they walk who then rest, until 0.6 s later; so soon it is pressed by those who walk [s]."""
PAUSE, LASTS = 0.6, 7.5
"""[s]"""


def played(who: Any, rng: np.random.Generator, kind: str) -> tuple[list[CharacterState], Box, float, list[str]]:
    """All states of one, the box, when he let go of the key [s], and why he did not leap."""
    high, deep = rng.uniform(*HIGH), rng.uniform(*WIDE)
    box = Box((0.0, 0.5 * high, rng.uniform(*FAR) + 0.5 * deep), (rng.uniform(*WIDE), high, deep), rng.uniform(-ASKEW, ASKEW))
    line = Timeline(begin(World((Character("A", who, who.start((rng.normal(0.0, 0.1), 0.0, 0.0))),), (box,)), 1))
    tilt, holds = rng.choice([1.0, 0.6]), rng.uniform(*HOLDS)
    walks = rng.uniform(*RESTS) if kind == KINDS[0] else rng.uniform(*PRESSED)
    presses = walks + PAUSE if kind == KINDS[0] else walks
    states, why = [], []
    for k in range(round(LASTS / DT)):
        t, yaw = k * DT, line.now.players[0].camera.yaw
        held, before = presses <= t < presses + holds, line.now
        ahead = (tilt * np.sin(yaw), tilt * np.cos(yaw)) if t < walks or held else (0.0, 0.0)  # straight at it, wherever the camera looks
        line.advance((Wish(move=ahead, jump=held).rounded(),))
        states.append(line.now.after.characters[0].state)
        why += refused(before, line.now)
    return states, box, presses + holds, why


def measure(count: int, seed: int) -> None:
    """Print the figures of each kind of hands."""
    who, rng = person(), np.random.default_rng(seed)
    for kind in KINDS:
        up, waits, deep, told = 0, [], [], Counter[str]()
        for _ in range(count // 2):
            states, box, let_go, why = played(who, rng, kind)
            there = abs(float(states[-1].floor) - box.size[1]) < 0.02
            up += there
            if there:
                waits.append(next(k * DT for k, s in enumerate(states) if isinstance(getattr(s.memory, "memory", None), Jumping)) - let_go)
            else:
                told[why[-1] if why else "leapt elsewhere"] += 1
            deep.append(deepest(who, states, (box,))[0])
        off = f"off {np.median(waits):.2f} s after they let go (at most {max(waits):.2f}); " if waits else ""
        print(f"{kind}: {up} of {count // 2} get up; {off}"
              f"flesh more than 2 cm in the box in {np.sum(np.array(deep) > 0.02)}, {100 * max(deep):.1f} cm at most")
        for reason, times in told.most_common():
            print(f"    {times} × {reason}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0)
    args = parser.parse_args()
    measure(args.count, args.seed)
