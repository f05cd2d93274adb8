"""Run-ups at platforms and gaps, with a leap that can be made or not: what of a body ends in what stands there, and what becomes of him.

    python scripts/measure/run_ups.py [--count 40] [--seed 0] [--only running]

Somebody runs, walks or sets off straight at a box or over a platform's edge and wants to leap onto or over it: by a script, and by hands on
the keys. Flesh is looked at in every step; whoever comes to the floor beside the platform has fallen off it.

Running: hands that run at a gap, a box or a hurdle press the leap's key some time ahead of it and let go once the ring is beyond it, or only at the edge. Whether
a plan exists is asked of his run from there on, at each footfall.
"""

from __future__ import annotations

import argparse
import os
from collections import Counter
from dataclasses import replace
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one thread: what a game has
import numpy as np

from _struck_rooms import deepest

from gambol.controllers.contract import CharacterState, Intent, Leap
from gambol.controllers.jump import Jumping
from gambol.controllers.locomotion import Locomotion, Settings
from gambol.controllers.navigation import floor_at
from gambol.controllers.person import person
from gambol.game.input import AHEAD, Jump, Move, Script, Wish
from gambol.game.scene import Box
from gambol.game.session import Timeline, begin, refused
from gambol.game.world import DT, Character, World, stopped

KINDS = "too high", "platform", "gap"
AGILE = 0.5, 1.0, 2.0
RUNNING = "gap", "box", "hurdle"
LANDS = 0.0, 0.2, 0.4, -0.2, 0.6, 0.8
"""So much nearer than the ring may a runner's leap land [m]."""
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


def running_stage(kind: str, rng) -> tuple[tuple[Box, ...], float, float, float, float]:
    """What stands there, how high he starts [m], how far away it is [m], how wide [m], and its size [m]: a gap's width, and else the height."""
    far = rng.uniform(4.0, 10.0)
    if kind == "gap":
        wide = rng.uniform(0.5, 1.8)
        return (Box((0.0, 0.5, 0.5 * far - 2.0), (4.0, 1.0, far + 4.0)), Box((0.0, 0.5, far + wide + 4.0), (4.0, 1.0, 8.0))), 1.0, far, wide, wide
    if kind == "box":
        high = rng.uniform(0.15, 0.5)
        return (Box((0.0, 0.5 * high, far + 4.0), (4.0, high, 8.0)),), 0.0, far, 0.0, high
    high, wide = rng.uniform(0.2, 0.5), rng.uniform(0.05, 0.3)
    return (Box((0.0, 0.5 * high, far + 0.5 * wide), (4.0, high, wide)),), 0.0, far, wide, high


def running_hands(who: Any, things: tuple[Box, ...], floor: float, far: float, wide: float, pace: float, ahead: float, at_edge: bool, lead: float) -> tuple[list[CharacterState], int]:
    """All states of somebody whose hands run on all the while and press the leap's key so many seconds ahead of what is `far` away, until the ring is so far beyond it
    [m], or, at the edge, until he is so near to it [m]; and in which step they press it."""
    line, states, held, gone = Timeline(begin(World((Character("A", who, who.start((0.0, 0.0, 0.0), floor)),), things), 1)), [], 0, False
    while len(states) * DT < 12.0 and (not states or states[-1].ground[1] < far + wide + 3.0):
        state, aim = line.now.after.characters[0].state, line.now.players[0].aim
        states.append(state)
        z = float(state.ground[1])
        held = held or (len(states) if z > far - ahead * pace else 0)
        if held and aim.aiming and not aim.moving and abs(state.velocity[0]) < 0.1:
            break  # he stands, and aims from a stand
        gone = gone or bool(held) and (z > far - lead if at_edge else aim.aiming and z + aim.offset[1] > far + wide + lead)
        line.advance((Wish(move=(0.0, 1.0), run=(pace - 1.3) / 1.7, jump=bool(held) and not gone).rounded(),))
    return states, max(held - 1, 0)


def planned(who: Any, state: CharacterState, things: tuple[Box, ...], far: float, wide: float, pace: float) -> bool:
    """Whether somebody who runs on from a state can leap over what is there, or onto it, from any footfall."""
    stood, floor = True, float(state.floor)
    while state.ground[1] < far and state.active == "locomotion":
        z, speed = float(state.ground[1]), float(np.hypot(state.velocity[0], state.velocity[2]))
        asked = Intent(np.array([pace, 0.0, 0.0]), leap=Leap(np.array([0.0, floor, z + 2.0])), around=things)
        stands = who.precondition(state, asked) >= 1.0
        for to in z + AHEAD[0] + AHEAD[1] * speed - np.array(LANDS) if stands and not stood else ():
            place = np.array([0.0, floor_at(0.0, to, things, floor + 0.95), to])
            if to > far + wide + 0.1 and who.refusal(state, replace(asked, leap=Leap(place))) == "":
                return True
        stood = stands
        before = state
        state, _ = who.step(state, replace(asked, leap=None, aim=asked.leap), DT)
        if state.ground[1] - before.ground[1] < 1e-4:
            break  # he is held up
    return False


def running(locomotion: Locomotion, seed: int, count: int, verbose: bool) -> None:
    """Print what becomes of so many run-ups of each kind by hands."""
    for kind in RUNNING:
        fates, depths = Counter(), []
        for number in range(count):
            rng = np.random.default_rng([seed, RUNNING.index(kind), number])
            who: Any = person(locomotion.tuned(Settings(idle=0.0, agility=AGILE[number % len(AGILE)])))
            things, floor, far, wide, size = running_stage(kind, rng)
            pace, ahead, at_edge, lead = rng.uniform(2.0, 3.0), rng.uniform(0.2, 2.0), bool(rng.integers(2)), rng.uniform(0.1, 0.5)
            states, pressed = running_hands(who, things, floor, far, wide, pace, ahead, at_edge, lead)
            can = planned(who, states[pressed], things, far, wide, pace)
            plans = [s.memory.memory for s in states if s.active == "jump" and isinstance(s.memory.memory, Jumping)]
            over = states[-1].ground[1] > far + wide + 1.0
            slowest = min(float(np.hypot(s.velocity[0], s.velocity[2])) for s in states[pressed:])
            fate = ("falls" if any(m.fault for m in plans) else "leaps and runs on" if plans and over and slowest > 1.0 else "leaps from slow" if plans and over
                    else "goes over without a leap" if over else "stops")
            deep = 100.0 * deepest(who.parts["jump"].physique, states, things)[0]
            fates[can, fate] += 1
            depths.append(deep)
            if verbose:
                print(f"    {kind} {number}: {size:.2f} m at {far:.2f} m, {pace:.2f} m/s, agility {AGILE[number % len(AGILE)]}, pressed {ahead:.2f} s ahead, let go "
                      f"{'at the edge' if at_edge else 'by the ring'}: {'a plan' if can else 'no plan'}, {fate}, deep {deep:.1f} cm", flush=True)
        for can in (True, False):
            some = {fate: n for (which, fate), n in fates.most_common() if which == can}
            print(f"running, {kind}, {'a plan exists' if can else 'none exists'} ({sum(some.values())}): {', '.join(f'{n} {fate}' for fate, n in some.items()) or 'nobody'}")
        print(f"  deepest in anything: median {np.median(depths):.1f} cm, worst {max(depths):.1f}; more than 2 cm: {sum(d > 2.0 for d in depths)} of {count}", flush=True)


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
    parser.add_argument("--only", choices=("script", "hands", "running"), default="", help="run-ups by a script, by hands, or leaps out of a run by hands, alone")
    parser.add_argument("--verbose", action="store_true", help="a line for each that falls or touches")
    given = parser.parse_args()
    locomotion = Locomotion.load()
    if given.only != "running":
        report(locomotion, given.seed, given.count, given.only, given.verbose)
    if given.only in ("", "running"):
        running(locomotion, given.seed, given.count, given.verbose)


if __name__ == "__main__":
    main()
