"""Measure how deep bodies come into things close by: random people walk, run, turn and stop for a few seconds beside one or two things each, or upon one.

    python scripts/measure/close_by.py [--count 400] [--seed 0] [--where beside upon] [--pictures DIR]

`hands.py` plays on for minutes, where one bad second more or less is all that two runs differ by. Here every walk begins anew beside things of its own, at most two metres away, with wishes of
its own, so that walks that are measured again after a change of the code can be set one beside the other. Things are walls, boxes, kerbs, pillars, ramps and stairs;
who walks upon something stands on a platform, with stairs up to it or another one close by, and often steps off its edge.
Flesh is looked at in every step, arms and all: which limbs are deep, in what, and what their body does (`flesh_causes.py`). The worst walks are told by number and second;
--pictures draws them.
"""

from __future__ import annotations

import argparse
import os
from collections import defaultdict
from collections.abc import Sequence
from pathlib import Path
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one thread: what a game has
import numpy as np

from flesh_causes import causes
from hands import Body, Prop

from gambol.controllers.contract import Intent
from gambol.controllers.person import person
from gambol.game.scene import Box, Camera, Pillar, Scene
from gambol.game.world import DT, RATE, Character, World, figures

SECONDS, BEGINS = 5.0, 0.55
"""So long a walk is [s]; nothing is nearer to where it begins than the second [m]."""
KINDS = {"wall": 0.2, "box": 0.25, "pillar": 0.1, "ramp": 0.15, "kerb": 0.1, "stairs": 0.2}
WHERE = "beside", "upon"
SPEEDS = 0.0, 0.0, 0.7, 1.3, 1.3, 1.3, 2.8, -0.5
CAUSES = 12
"""So many causes are told, the most frequent first."""
DEEP = 2.0, 5.0
"""How deep flesh is told to be in things [cm]."""


def thing(rng: np.random.Generator) -> tuple[Prop, ...]:
    """One thing, or a flight of stairs, whose nearest place is BEGINS to 2 m before somebody who stands in the middle."""
    kind, heading, way = rng.choice(list(KINDS), p=list(KINDS.values())), rng.uniform(-np.pi, np.pi), rng.uniform(-1.2, 1.2)
    if kind == "pillar":
        size = (rng.uniform(0.05, 0.4), 2.0)
        reach = size[0]
    else:
        wide, high, deep = {"wall": (rng.uniform(1.0, 3.0), 2.0, rng.uniform(0.08, 0.5)), "box": (*rng.uniform((0.3, 0.22), (1.5, 0.9)), rng.uniform(0.3, 1.5)),
                            "ramp": (rng.uniform(1.0, 2.0), 1.0, rng.uniform(1.5, 3.0)), "kerb": (rng.uniform(0.4, 2.0), rng.uniform(0.05, 0.2), rng.uniform(0.4, 2.0)),
                            "stairs": (rng.uniform(1.2, 2.5), rng.uniform(0.12, 0.2), rng.uniform(0.25, 0.35))}[kind]
        steps = int(rng.integers(2, 6)) if kind == "stairs" else 1
        reach = 0.5 * float(np.hypot(wide, deep * steps))
    far = rng.uniform(BEGINS, 1.2) + reach
    x, z = far * np.sin(way), far * np.cos(way)
    if kind == "pillar":
        return (Pillar((x, 0.0, z), *size),)
    if kind == "stairs":
        along = [deep * (k - 0.5 * (steps - 1)) for k in range(steps)]
        return tuple(Box((x + a * np.sin(heading), 0.5 * high * (k + 1), z + a * np.cos(heading)), (wide, high * (k + 1), deep), heading) for k, a in enumerate(along))
    slope = rng.uniform(0.1, 0.4) if kind == "ramp" else 0.0
    return (Box((x, 0.5 * high - (1.0 - 0.5 * slope * deep if slope else 0.0), z), (wide, high, deep), heading, slope=slope),)


def platform(rng: np.random.Generator) -> tuple[tuple[Prop, ...], float]:
    """A platform under somebody who stands in the middle, with nothing, another box or stairs beside it; and how high it is [m]."""
    heading, beside, (wide, deep) = rng.uniform(-np.pi, np.pi), rng.choice(["nothing", "a box", "stairs"]), rng.uniform(1.2, 2.5, 2)
    steps, rise, going = int(rng.integers(2, 6)), rng.uniform(0.12, 0.2), rng.uniform(0.25, 0.35)
    high = steps * rise if beside == "stairs" else rng.uniform(0.25, 1.2)
    things = [Box((0.0, 0.5 * high, 0.0), (wide, high, deep), heading)]
    if beside == "a box":
        way, far, other = rng.uniform(-np.pi, np.pi), 0.5 * np.hypot(wide, deep) + rng.uniform(0.2, 1.2), max(high + rng.uniform(-0.5, 0.5), 0.1)
        things.append(Box((far * np.sin(way), 0.5 * other, far * np.cos(way)), (rng.uniform(0.5, 1.5), other, rng.uniform(0.5, 1.5)), rng.uniform(-np.pi, np.pi)))
    for k in range(steps - 1 if beside == "stairs" else 0):
        along, tread = 0.5 * deep + going * (k + 0.5), high - rise * (k + 1)
        things.append(Box((along * np.sin(heading), 0.5 * tread, along * np.cos(heading)), (wide, tread, going), heading))
    return tuple(things), high


def walked(who: Any, seed: int, where: str) -> tuple[tuple[Prop, ...], list[Any]]:
    """What stands about in the walk of that number, and the states of who walks there."""
    rng = np.random.default_rng(seed)
    if where == "upon":
        things, high = platform(rng)
        state = who.start((*rng.uniform(-0.2, 0.2, 2), rng.uniform(-np.pi, np.pi)), high)
    else:
        things = thing(rng) + (thing(rng) if rng.random() < 0.3 else ())
        state = who.start((0.0, 0.0, rng.uniform(-0.6, 0.6)))
    states, until, wish = [], 0, np.zeros(3)
    for tick in range(round(SECONDS * RATE)):
        if tick >= until:
            until = tick + round(rng.uniform(0.3, 1.2) * RATE)
            speed = rng.choice(SPEEDS)
            wish = np.array([speed, rng.choice([0.0, 0.0, rng.uniform(-2.0, 2.0)]), rng.choice([0.0, 0.0, 0.5, -0.5]) if speed < 1.0 else 0.0])
        state, _ = who.step(state, Intent(wish, around=things), DT)
        states.append(state)
    return things, states


def draw(who: Any, worst: Sequence[tuple[float, int, int]], where: str, path: Path) -> None:
    """The worst moments, a row each: from the side and from above, 0.1 s apart."""
    from PIL import Image

    from gambol.game.hosts import Offscreen
    rows = []
    with Offscreen((240, 220), "fast") as stage:
        for _, seed, k in worst:
            things, states = walked(who, seed, where)
            body, row = Body(who, states, things), []
            hips, heading = body.placed[0][k, 0], float(states[k].ground[2])
            for eye in (np.array([2.2 * np.cos(heading), 0.5, -2.2 * np.sin(heading)]), np.array([0.3, 2.6, 0.3])):
                for frame in np.clip(k + np.arange(-12, 13, 6), 0, len(states) - 1):
                    world = World((Character("A", who, states[frame]),), things)
                    row.append(stage.frame(Scene(Camera(hips + eye, hips - [0.0, 0.3, 0.0]), figures(world, world, 0.0), things))[..., :3].copy())
            rows.append(np.concatenate(row, 1))
    Image.fromarray(np.concatenate(rows)).save(path)


def measured(who: Any, where: str, seeds: range) -> list[tuple[float, int, int]]:
    """Print the figures of these walks; the worst moments, how deep [cm], in which walk and frame."""
    deeps, worst = [], []
    why: dict[tuple[str, str, str], list[tuple[float, int, int]]] = defaultdict(list)
    for seed in seeds:
        things, states = walked(who, seed, where)
        body = Body(who, states, things)
        deep = -100.0 * body.flesh[1].min(1)
        for cause, moments in causes(body, things).items():
            why[cause] += [(100.0 * far, seed, k) for k, far in moments]
        deeps.append(deep)
        worst.append((float(deep.max()), seed, int(deep.argmax())))
    deep, most = np.concatenate(deeps), np.array([w[0] for w in worst])
    print(f"{len(seeds)} walks of {SECONDS:g} s {where} things: flesh in them " + ", ".join(f"> {limit:g} cm in {np.mean(deep > limit):.2%} of the frames, {np.mean(most > limit):.1%} of the walks" for limit in DEEP))
    worst = sorted(worst, reverse=True)[:12]
    print("  the worst: " + ", ".join(f"{far:.1f} cm in {seed} at {k * DT:.2f} s" for far, seed, k in worst))
    print("  limb       in      doing                      frames  walks  worst [cm]")
    for (limb, what, doing), moments in sorted(why.items(), key=lambda one: -len(one[1]))[:CAUSES]:
        far, seed, k = max(moments)
        print(f"  {limb:10} {what:7} {doing:25} {len(moments):7} {len({m[1] for m in moments}):6} {far:8.1f} in {seed} at {k * DT:.2f} s")
    return worst


def main() -> None:
    """Print all figures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=400)
    parser.add_argument("--seed", type=int, default=0, help="the number of the first walk")
    parser.add_argument("--where", nargs="+", choices=WHERE, default=WHERE)
    parser.add_argument("--pictures", type=Path)
    asked = parser.parse_args()
    who = person()
    for where in asked.where:
        worst = measured(who, where, range(asked.seed, asked.seed + asked.count))
        if asked.pictures is not None:
            asked.pictures.mkdir(parents=True, exist_ok=True)
            draw(who, worst[:8], where, asked.pictures / f"{where}.png")


if __name__ == "__main__":
    main()
