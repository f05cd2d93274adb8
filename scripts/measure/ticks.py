"""Measure how long a tick takes that sends somebody: a scenario over several levels, clicks in the game, a call of the import; that in which somebody is struck on stairs and falls; a script's, of
who walks or runs and is told to leap to a place aside; a leap that is asked for in every step and refused; hands that hold a leap as they run at gaps, boxes and hurdles;
random hands of `hands.py`, which leap at whatever they head for, for a tenth of so many minutes as there are clicks.

    python scripts/measure/ticks.py [--clicks 40] [--only scripts]

Ticks come sixty times a second, as in a game. A tick's time is that of the processor in the thread that makes it; what is thought of beside, in
another thread, is told apart, but by the clock a tick that waits for it is as much longer. What a first run compiles or loads is done before.
"""

from __future__ import annotations

import argparse
import gc
import os
import time
from collections.abc import Iterator
from itertools import chain, islice

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
import numpy as np

from _struck_rooms import room
from hands import STAGES, playing
from run_ups import RUNNING, running_stage

from gambol.controllers.contract import Goal, Intent, Leap, Strike
from gambol.controllers.navigation import in_world
from gambol.controllers.person import person
from gambol.game.input import Jump, Move, Script, Wish
from gambol.game.scenario import film, load
from gambol.game.scene import Box
from gambol.game.session import Timeline, begin, opening
from gambol.game.world import DT, RATE, Character, World, stopped

AMONG = tuple(Box((float(x), 0.6, float(z)), (0.5, 1.2, 0.5), 0.3 * x) for x in (-2.4, -0.8, 0.8, 2.4) for z in (2.0, 4.0, 6.0))


def told(name: str, ticks: Iterator[None]) -> None:
    """A line of how long ticks took."""
    next(ticks)  # everything is there
    own, clock, whole, begun, due = [], [], time.process_time(), (time.thread_time(), time.monotonic()), time.monotonic()
    for _ in ticks:
        own.append(1e3 * (time.thread_time() - begun[0]))
        clock.append(1e3 * (time.monotonic() - begun[1]))
        due = max(due + 1.0 / RATE, time.monotonic())
        time.sleep(max(due - time.monotonic(), 0.0))
        begun = time.thread_time(), time.monotonic()
    whole = 1e3 * (time.process_time() - whole)
    print(f"{name}: {len(own)} ticks, median {np.median(own):.2f} ms, the longest three {', '.join(f'{one:.1f}' for one in np.sort(own)[:-4:-1])} ms (by the clock {max(clock):.0f}), "
          f"{sum(one > 1e3 / RATE for one in own)} longer than a frame; beside them {whole - sum(own):.0f} ms in all", flush=True)


def scenario(name: str) -> Iterator[None]:
    """The ticks of a scenario."""
    asked = load(name)
    for number, _ in enumerate(film.acts(asked, person())):
        yield
        if number >= RATE * asked.duration:
            return


def clicks(count: int, seed: int) -> Iterator[None]:
    """The ticks of a game in which somebody is sent to another place every one and a half seconds."""
    rng, line = np.random.default_rng(seed), Timeline(opening(person()))
    for _ in range(count):
        x, z = rng.uniform((-4.0, -1.0), (7.0, 14.0))
        for tick in range(round(1.5 * RATE)):
            line.advance([Wish(pressed=(f"goto={x:.2f}/{z:.2f}",) if tick == 0 else ())])
            yield


def imported(count: int, seed: int) -> Iterator[None]:
    """The steps of somebody who is told goals among boxes."""
    rng, someone = np.random.default_rng(seed), person()
    state = someone.start()
    for _ in range(count):
        goal = Goal(tuple(rng.uniform((-4.0, -1.0), (4.0, 8.0))), float(rng.uniform(-np.pi, np.pi)))
        for _ in range(round(1.5 * RATE)):
            state, _ = someone.step(state, Intent(goal=goal, around=AMONG), 1 / RATE)
            yield


def strikes(count: int, seed: int) -> Iterator[None]:
    """The steps of somebody who is struck on stairs, over and over."""
    rng, someone = np.random.default_rng(seed), person()
    for _ in range(count):
        things, start, floor = room("stairs", rng)
        state, angle = someone.start(start, floor), rng.uniform(-np.pi, np.pi)
        kick = Strike(tuple(rng.uniform(1.5, 3.0) * someone.parts["struck"].physique.mass * np.array([np.sin(angle), np.cos(angle)])))
        for tick in range(RATE):
            state, _ = someone.step(state, Intent(around=things, strike=kick if tick == 10 else None), 1 / RATE)
            yield


def aside(count: int, seed: int) -> Iterator[None]:
    """The steps of a script's walkers and runners, from the moment in which they are told to leap to a place beside their way."""
    rng, who = np.random.default_rng(seed), person()
    for _ in range(count):
        speed, angle, far = rng.uniform(0.7, 3.0), rng.uniform(-1.6, 1.6), rng.uniform(0.8, 3.0)
        world = World((Character("A", who, who.start()),))
        for _ in range(3 * RATE + rng.integers(RATE)):
            world = world.step([Intent(np.array([speed, 0.0, 0.0]))])
            yield
        ground = world.characters[0].state.ground
        way = np.arctan2(*in_world(ground, world.characters[0].state.velocity)) + angle
        place = float(ground[0] + far * np.sin(way)), 0.0, float(ground[1] + far * np.cos(way))
        script = Script((Move(6.0, (speed, 0.0, 0.0), jump=Jump(place)), Move(6.0, (speed, 0.0, 0.0))))
        for _ in range(5 * RATE):
            state = world.characters[0].state
            script, intent = script.step(state, DT)
            script, intent = script.held(who, state, intent, (), DT)
            world = world.step([intent if script.leaps else stopped(state, intent, ())])
            yield


def never(speed: float, things: tuple[Box, ...], far: float) -> Iterator[None]:
    """The steps of somebody who goes so fast [m/s], and is asked in each of them to leap to a place so far ahead of where he began [m], which nobody can; none for 0."""
    who = person()
    state, leap = who.start(), Leap(np.array([0.3, 0.0, far])) if far else None
    for number in range(10 * RATE):
        state, _ = who.step(state, Intent(np.array([speed, 0.0, 0.0]), leap=leap if number > 2 * RATE else None, around=things), 1 / RATE)
        yield


def held(kind: str, count: int, seed: int) -> Iterator[None]:
    """The ticks of a game in which hands run at a gap, a box or a hurdle and hold a leap from so far ahead until it goes off."""
    who = person()
    for number in range(count):
        rng = np.random.default_rng([seed, RUNNING.index(kind), number])
        things, floor, far, _, _ = running_stage(kind, rng)
        pace, ahead = rng.uniform(2.0, 3.0), rng.uniform(0.2, 2.0)
        line, leapt = Timeline(begin(World((Character("A", who, who.start((0.0, 0.0, 0.0), floor)),), things), 1)), False
        for _ in range(6 * RATE):
            state = line.now.after.characters[0].state
            leapt = leapt or state.active == "jump"
            if leapt and state.active != "jump":
                break
            line.advance((Wish(move=(0.0, 1.0), run=(pace - 1.3) / 1.7, jump=not leapt and float(state.ground[1]) > far - ahead * pace).rounded(),))
            yield


def restless(stage: str, seed: int, minutes: float) -> Iterator[None]:
    """The ticks of a game that random hands play."""
    for _ in islice(playing(person(), STAGES[stage](seed), seed), round(60 * RATE * minutes) + 1):
        yield


def main() -> None:
    """Print all figures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--clicks", type=int, default=20)
    parser.add_argument("--only", default="", help="lines that begin so")
    asked = parser.parse_args()
    for _ in chain(clicks(3, 9), strikes(4, 9), aside(2, 9), *(held(kind, 2, 9) for kind in RUNNING), restless("yard", 9, 0.5)):  # compiled, loaded
        pass
    time.sleep(4.0)  # the last of them is still thought of
    gc.collect()
    gc.freeze()  # as the game does: to look for garbage among all that is loaded takes 60 to 80 ms
    lines = {"go_across": scenario("go_across"), "clicks on the course": clicks(asked.clicks, 0), "goals among twelve boxes": imported(asked.clicks, 0), "struck on stairs": strikes(asked.clicks, 0),
             "scripts' leaps aside": aside(asked.clicks, 0),
             **{f"{'walks' if speed < 2.0 else 'runs'} {'beside boxes' if things else 'in the open'}, {'a leap refused' if far else 'alone'}": never(speed, things, far)
                for speed in (1.3, 3.0) for things in ((), AMONG) for far in (0.0, 60.0)}, **{f"a leap held at a run, {kind}": held(kind, max(asked.clicks // 2, 1), 0) for kind in RUNNING},
             **{f"random hands, {stage}": restless(stage, 0, asked.clicks / 10) for stage in STAGES}}
    for name, ticks in lines.items():
        if name.startswith(asked.only):
            told(name, ticks)


if __name__ == "__main__":
    main()
