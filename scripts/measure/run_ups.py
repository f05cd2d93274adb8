"""Run-ups at platforms and gaps, with a leap that can be made or not: what of a body ends in what stands there, and what becomes of him.

    python scripts/measure/run_ups.py [--count 40] [--seed 0]

Somebody runs, walks or sets off straight at a box or over a platform's edge and wants to leap onto or over it: by a script, and by hands on
the keys. Flesh is looked at in every step; whoever comes to the floor beside the platform has fallen off it.
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
from gambol.controllers.locomotion import Locomotion, Settings
from gambol.controllers.person import person
from gambol.game.input import Jump, Move, Script, Wish
from gambol.game.scene import Box
from gambol.game.session import Timeline, begin, refused
from gambol.game.world import DT, Character, World, stopped

KINDS = "too high", "platform", "gap"
AGILE = 0.5, 1.0, 2.0
LASTS = 7.0
"""How long a run-up is looked at [s]."""
INSIDE, SETS_OFF = 0.2, 0.75
"""Hands let go once the ring is so far inside a platform [m]; they hold the leap once they have run for so long [s]."""


def stage(kind: str, rng) -> tuple[tuple[Box, ...], float, float, float]:
    """What stands there, how high he starts [m], how far away [m], and how far from there his leap is to land [m]."""
    far = rng.uniform(1.2, 7.0)
    if kind == "gap":
        high, wide, land = 1.0, rng.uniform(0.6, 4.0), rng.uniform(0.3, 0.6)
        near = Box((0.0, 0.5 * high, 0.5 * far - 2.0), (4.0, high, far + 4.0))
        other = Box((0.0, 0.5 * high, far + wide + 3.0), (4.0, high, 6.0))
        return (near, other), high, far, wide + land
    high = rng.uniform(0.9, 1.8) if kind == "too high" else rng.uniform(0.25, 0.6)
    return (Box((0.0, 0.5 * high, far + 2.0), (4.0, high, 4.0)),), 0.0, far, rng.uniform(0.2, 1.2)


def scripted(who: Any, things: tuple[Box, ...], floor: float, far: float, beyond: float, pace: float) -> tuple[list[CharacterState], str]:
    """All states of somebody whose script runs up to a leap, and why he made none."""
    place = (0.0, things[-1].centre[1] + 0.5 * things[-1].size[1], far + beyond)
    script = Script((Move(LASTS, (pace, 0.0, 0.0), jump=Jump(place)),))
    world, states = World((Character("A", who, who.start((0.0, 0.0, 0.0), floor)),), things), []
    for _ in range(round(LASTS / DT) + 60):
        state = world.characters[0].state
        states.append(state)
        script, intent = script.step(state, DT)
        script, intent = script.held(who, state, intent, things, DT)
        world = world.step([intent if script.leaps else stopped(state, intent, things)])
    return states, script.refused[0] if script.refused else ""


def by_hands(who: Any, things: tuple[Box, ...], floor: float, far: float, beyond: float, pace: float) -> tuple[list[CharacterState], str]:
    """All states of somebody whose hands run at it with the leap held, and let go as soon as the ring is on it, or once he stands; a second
    later of everything."""
    line, states, told, held, since = Timeline(begin(World((Character("A", who, who.start((0.0, 0.0, 0.0), floor)),), things), 1)), [], "", True, 0
    run = float(np.clip((pace - 1.3) / 1.7, 0.0, 1.0))
    for _ in range(round(LASTS / DT)):
        moment = line.now
        state = moment.after.characters[0].state
        states.append(state)
        aim = moment.players[0].aim
        held = held and not (aim.moving and state.ground[1] + aim.offset[1] > far + (beyond if floor else min(beyond, INSIDE)) or len(states) > SETS_OFF / DT + 30 and not aim.moving)
        since += not held
        line.advance((Wish(move=(0.0, 1.0) if since * DT < 1.0 else (0.0, 0.0), run=run, jump=held and len(states) > SETS_OFF / DT).rounded(),))
        told = told or "; ".join(refused(moment, line.now))
    return states, told


def report(locomotion: Locomotion, seed: int, count: int, only: str = "", verbose: bool = False) -> None:
    """Print what becomes of so many run-ups of each kind."""
    for way, play in (("by a script", scripted), ("by hands", by_hands)):
        if only not in way:
            continue
        for kind in KINDS:
            fates, depths = Counter(), []
            for number in range(count):
                rng = np.random.default_rng([seed, KINDS.index(kind), number])
                who: Any = person(locomotion.tuned(Settings(idle=0.0, agility=AGILE[number % len(AGILE)])))
                things, floor, far, beyond = stage(kind, rng)
                pace = (0.7, 1.3, rng.uniform(2.0, 3.4))[int(rng.integers(3))]
                states, why = play(who, things, floor, far, beyond, pace)
                plans = [s.memory.memory for s in states if s.active == "jump" and isinstance(s.memory.memory, Jumping)]
                fell, leapt = any(m.fault for m in plans), any(not m.fault for m in plans)
                fates["fell off" if fell else "leapt" if leapt else "not leapt, told why" if why else "not leapt, not told"] += 1
                depths.append(100.0 * deepest(who.parts["jump"].physique, states, things)[0])
                if verbose and (depths[-1] > 2.0 or fell):
                    print(f"    {way} {kind} {number}: pace {pace:.2f}, far {far:.2f}, beyond {beyond:.2f}, agility {AGILE[number % 3]}, leapt {leapt}, "
                          f"deep {depths[-1]:.1f} cm, {plans[-1].fault if plans else why}")
            print(f"{way}, {kind}: {', '.join(f'{n} {fate}' for fate, n in fates.most_common())}; deepest in anything: median {np.median(depths):.1f} cm, "
                  f"worst {max(depths):.1f} (number {int(np.argmax(depths))}); more than 2 cm: {sum(d > 2.0 for d in depths)} of {count}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", choices=("script", "hands"), default="", help="run-ups by a script, or by hands, alone")
    parser.add_argument("--verbose", action="store_true", help="a line for each that falls or touches")
    given = parser.parse_args()
    report(Locomotion.load(), given.seed, given.count, given.only, given.verbose)


if __name__ == "__main__":
    main()
