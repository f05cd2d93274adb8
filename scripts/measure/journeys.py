"""Measure how people who are sent to places get about levels that nobody chose: platforms at random, gaps between them, stairs and ramps up to them.

    python scripts/measure/journeys.py [--levels 8] [--seed 0] [--goals 4] [--only LEVEL GOAL]

From one platform to the next it is 0.3 to 1.3 m, and up or down 0.5 m at most; from stairs or a ramp, all can be reached. Each goal in turn is asked for where the
last left one. Told: who comes there, in what time beside walking straight there at 1.2 m/s and 3 s for each leap; leaps that ended elsewhere, falls, and going back
for a run-up; what was refused, and why; the worst, by level and goal. --only plays one goal of one level and writes what happens.
"""

from __future__ import annotations

import argparse
import os
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one thread: what a game has
import numpy as np

from gambol.controllers.contract import Goal, Intent
from gambol.controllers.navigation import floor_at, gap
from gambol.controllers.person import person
from gambol.game.scene import Box, Pillar

DT, SECONDS, STEP = 1 / 60, 60.0, 0.25
SPEED, LEAP = 1.2, 3.0
INSIDE = 0.4
"""Goals are so far from where a platform ends [m]."""
FALLS = 0.25
"""Who comes down so far [m] without a leap falls."""


def level(rng: np.random.Generator) -> tuple[list[Box], list[Box], list[Pillar], float]:
    """Platforms, what leads up to the first of them, pillars on some, and how far along z [m] it begins, where nothing is."""
    size, high = rng.uniform(1.6, 4.0, 2), rng.uniform(0.4, 1.0)
    platforms = [Box((0.0, 0.5 * high, 5.0), (size[0], high, size[1]))]
    foot = 5.0 - 0.5 * size[1]
    if rng.random() < 0.5:
        count = int(np.ceil(high / 0.17))
        up = [Box((0.0, 0.5 * high * (k + 1) / (count + 1), foot - 0.3 * (count - k - 0.5)), (1.4, high * (k + 1) / (count + 1), 0.3)) for k in range(count)]
    else:
        long = high / np.tan(np.radians(13.0))
        up = [Box((0.0, 0.5 * high - 0.5, foot - 0.5 * long), (1.4, 1.0, long), slope=high / long)]
    begins = min(box.centre[2] - 0.5 * box.size[2] for box in up) - 0.8
    for _ in range(100):
        if len(platforms) >= 5:
            break
        last = platforms[-1] if rng.random() < 0.7 else platforms[rng.integers(len(platforms))]
        size, gap, side = rng.uniform(1.4, 4.0, 2), rng.uniform(0.3, 1.3), rng.integers(4)
        high = float(np.clip(last.size[1] + rng.uniform(-0.5, 0.5), 0.25, 1.4))
        way = np.array([(0.0, 1.0), (1.0, 0.0), (-1.0, 0.0), (0.0, -1.0)][side])
        other = np.abs(way[::-1])
        half = 0.5 * (np.array(last.size)[[0, 2]] + size)
        place = np.array(last.centre)[[0, 2]] + (half @ np.abs(way) + gap) * way + rng.uniform(-0.4, 0.4) * (half @ other) * other
        taken = *platforms, *up, Box((0.0, 0.0, begins), (1.0, 0.0, 1.0))
        if all(np.any(np.abs(place - np.array(box.centre)[[0, 2]]) > 0.5 * (size + np.array(box.size)[[0, 2]]) + 0.3) for box in taken):
            platforms.append(Box((place[0], 0.5 * high, place[1]), (size[0], high, size[1])))
    broad = [box for box in platforms[1:] if min(box.size[0], box.size[2]) > 3.0]
    pillars = [Pillar((box.centre[0] + 0.3 * box.size[0], box.size[1], box.centre[2] - 0.3 * box.size[2]), 0.15, 1.8) for box in broad]
    return platforms, up, pillars, float(begins)


def goals(rng: np.random.Generator, platforms: list[Box], things: Sequence[Any]) -> Iterator[tuple[float, float]]:
    """Places on platforms, and now and then on the floor, that nothing is near which is higher."""
    while True:
        box = platforms[rng.integers(len(platforms))]
        half = 0.5 * np.array(box.size)[[0, 2]] - INSIDE
        place = np.array(box.centre)[[0, 2]] + rng.uniform(-1.0, 1.0, 2) * half if rng.random() < 0.85 else rng.uniform((-3.0, -3.0), (3.0, 0.0))
        height = floor_at(*place, things) + STEP
        higher = [thing for thing in things if isinstance(thing, Pillar) or thing.centre[1] + 0.5 * thing.size[1] > height]
        if all(gap(np.array([[place[0], height, place[1]]]), thing)[0] > INSIDE for thing in higher):
            yield float(place[0]), float(place[1])


class Told(NamedTuple):
    """What became of a goal. slow: how many times as long it took as it might, and late by how much [s]."""

    level: int
    goal: int
    reason: str
    seconds: float
    slow: float
    late: float
    leaps: int
    elsewhere: int
    fell: int
    backs: int


def sent(somebody: Any, state: Any, goal: Goal, things: tuple[Any, ...], name: tuple[int, int], loud: bool) -> tuple[Any, Told]:
    """Somebody is sent to a goal, and comes there or not."""
    begun, barred, active, floors, backs, back = state.ground[:2].copy(), 0, [], [], 0, False
    for step in range(round(SECONDS / DT)):
        state, _ = somebody.step(state, Intent(goal=goal, around=things), DT)
        active.append(state.active)
        floors.append(float(state.floor))
        now = state.going
        backs += now.back and not back
        if loud and (step % 30 == 0 or len(active) > 1 and active[-1] != active[-2] or now.back != back):
            leap = now.crossings[0] if now.crossings else None
            leaps = f"leap {np.round(leap.ground, 2)} -> {np.round(leap.place, 2)}" if leap else ""
            print(f"{step * DT:6.2f} {state.active:10s} {np.round(state.ground, 2)} floor {floors[-1]:.2f} {'back' if now.back else ''} pace {now.pace:.2f} "
                  f"{leaps} barred {len(now.barred)} {somebody.status(state).reason}")
        back, barred = now.back, max(barred, len(now.barred))
        status = somebody.status(state)
        if status.kind != "running":
            break
    took, jumps = len(active) * DT, [k for k in range(1, len(active)) if active[k] == "jump" != active[k - 1]]
    fell = sum(active[k] == "fall" != active[k - 1] for k in range(1, len(active)))
    ideal = np.hypot(*(goal.floor - begun)) / SPEED + LEAP * len(jumps) + 1.0
    reason = "" if status.kind == "done" else status.reason or "time is up"
    return state, Told(*name, reason, took, took / ideal, took - ideal, len(jumps), barred, fell, backs)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--levels", type=int, default=8)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--goals", type=int, default=4)
    parser.add_argument("--only", type=int, nargs=2, metavar=("LEVEL", "GOAL"))
    given = parser.parse_args()
    somebody, told = person(), []
    for number in [given.only[0]] if given.only else range(given.levels):
        rng = np.random.default_rng([given.seed, number])
        platforms, up, pillars, begins = level(rng)
        things = *platforms, *up, *pillars
        asked = goals(rng, platforms, things)
        state = somebody.start((0.0, begins, 0.0))
        for k in range(given.goals):
            place = next(asked)
            loud = given.only == [number, k]
            if loud:
                for thing in things:
                    print(thing)
                print("to", np.round(place, 2), f"{floor_at(*place, things):.2f} m up")
            state, one = sent(somebody, state, Goal(place), things, (number, k), loud)
            told.append(one)
            if loud:
                print(one)
    there = [one for one in told if not one.reason]
    slow, late = np.median([one.slow for one in there] or [np.nan]), max((one.late for one in there), default=np.nan)
    print(f"{len(told)} goals: {len(there)} reached, in {slow:.2f} times what it might take (at most {late:.0f} s late)")
    print(f"{sum(one.leaps for one in told)} leaps, {sum(one.elsewhere for one in told)} of which could not be made or ended elsewhere; {sum(one.fell for one in told)} falls; "
          f"{sum(one.backs for one in told)} times back for a run-up")
    for why, count in Counter(one.reason for one in told if one.reason).most_common():
        print(f"{count} not reached: {why}")
    print("worst: " + "; ".join(f"level {one.level} goal {one.goal}: {one.late:.0f} s late, {one.leaps} leaps" for one in sorted(told, key=lambda one: -one.late)[:5]))


if __name__ == "__main__":
    main()
