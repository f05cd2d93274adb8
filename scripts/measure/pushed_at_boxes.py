"""Push people who stand or go beside a box as high as a knee, and look how deep they get into it.

    python scripts/measure/pushed_at_boxes.py [--pushes 60] [--seed 0]

Boxes of 26 to 44 cm, 15 to 50 cm before a foot's toes, whichever way one faces; half of them go towards the box. Told from the final pose, from the push on for 2.5 s.
"""

from __future__ import annotations

import argparse
from collections import Counter
from typing import Any

import numpy as np

from hands import Body, wished
from gambol.controllers.person import person
from gambol.game.input import Wish
from gambol.game.scene import Box
from gambol.game.session import Timeline, begin
from gambol.game.world import DT, Character, World

AFTER, DEEP = 2.5, (2.0, 5.0)
"""So long after a push it is looked [s], and flesh is told to be so deep [cm]."""


def pushed(who: Any, seed: int) -> tuple[Box, list[Any]]:
    """The box and the states from the push on."""
    rng = np.random.default_rng(seed)
    high, deep = rng.uniform(0.26, 0.44), rng.uniform(0.4, 1.2)
    box = Box((0.0, 0.5 * high, 0.3 + 0.5 * deep + rng.uniform(0.15, 0.5)), (rng.uniform(0.8, 2.0), high, deep), rng.uniform(-0.6, 0.6))
    line = Timeline(begin(World((Character("A", who, who.start((0.0, 0.0, rng.uniform(-np.pi, np.pi)))),), (box,)), 1))
    goes, until, states = rng.random() < 0.5, round(rng.uniform(0.3, 1.0) / DT), []
    for tick in range(until + round(AFTER / DT)):
        state = line.now.after.characters[0].state
        states.append(state)
        walks = wished(state, line.now.players[0].camera.yaw, (0.0, 0.3), tick == 0, tilt=0.5 * goes)
        line.advance((walks if tick < until else Wish(pressed=("push",) if tick == until else ()).rounded(),))
    return box, states[until:]


def main() -> None:
    """Print all figures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pushes", type=int, default=60)
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    who, deep, said = person(), [], Counter()
    for seed in range(asked.seed, asked.seed + asked.pushes):
        box, states = pushed(who, seed)
        deep.append(-100.0 * Body(who, states, (box,)).flesh[1].min(1))
        said[next((state.memory.memory.made.why for state in states if state.active == "struck"), "not struck")] += 1
    depths = np.array(deep)
    print(f"{asked.pushes} pushes: flesh in the box " + ", ".join(f"> {limit:g} cm in {np.mean(depths > limit):.2%} of the frames, {np.sum(depths.max(1) > limit)} pushes" for limit in DEEP)
          + f" · worst {depths.max():.1f} cm in {asked.seed + int(depths.max(1).argmax())}")
    for why, count in said.most_common():
        print(f"    {count:3} {why}")


if __name__ == "__main__":
    main()
