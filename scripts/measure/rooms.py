"""Measure walks among ten things: plans in random rooms, and somebody who is sent through them.

    python scripts/measure/rooms.py [--scenes 1000] [--walked 400] [--seed 0] [--gaps] [--log FILE] [--plots DIR]

Room n of a seed is the same whichever others are asked for; with --log each is kept as a line of JSON, and one that is there is not done again. A goal
counts as one that can be reached where a grid twice as fine as the planner's has a way for a disc of the clearance's radius; along every plan the body is
swept as it is turned, as wide as that disc, less deep. In every frame of a walk the body's capsule and all limbs are held against what stands
there. Times are the processor's.
"""

from __future__ import annotations

import argparse
import json
import os
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one thread: what a game has
import numpy as np

from _limbs import limbs_in
from _navigation import BODY, CLEARANCE, SETS, draw_rooms
from _plots import pictures

from gambol.controllers.body import wrap
from gambol.controllers.contract import Goal, Intent
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.navigation import DEPTH
from gambol.controllers.navigation.planning import plan, rehearse, too_near
from gambol.controllers.navigation.routes import distance, grid_way, shapes_of
from gambol.controllers.supervisor import Supervisor
from gambol.game.scene import Box, Pillar

SWEPT = 1e-3
"""A disc this much smaller [m] than the clearance is swept: grazing is no collision."""
GIRTH = np.array([CLEARANCE, *DEPTH])
"""How far a walker reaches aside, ahead and back [m]."""
LONGEST = 40.0
"""Who is not there after this [s] has failed."""


def things_in(rng) -> tuple:
    """Ten discs, boxes and walls about a middle."""
    made = []
    for _ in range(10):
        x, z, heading, kind = *rng.uniform(-3.0, 3.0, 2), rng.uniform(-np.pi, np.pi), rng.integers(3)
        if kind == 0:
            made.append(Pillar((x, 0.0, z), rng.uniform(0.15, 0.5), 1.0))
        elif kind == 1:
            made.append(Box((x, 0.5, z), (rng.uniform(0.2, 1.2), 1.0, rng.uniform(0.2, 1.2)), heading))
        else:
            made.append(Box((x, 1.0, z), (0.1, 2.0, rng.uniform(1.0, 3.0)), heading))
    return tuple(made)


def room(seed: int, number: int) -> tuple[tuple, tuple, tuple]:
    """What stands in a room, where a walk begins and where it is to end: (x, z, heading) each."""
    rng = np.random.default_rng([seed, number])
    while True:
        things = things_in(rng)
        start, goal = ((*rng.uniform(-3.5, 3.5, 2), rng.uniform(-np.pi, np.pi)) for _ in range(2))
        if np.hypot(start[0] - goal[0], start[1] - goal[1]) >= 1.0 and nearest(np.array([start[:2], goal[:2]]), shapes_of(things)) >= CLEARANCE:
            return things, start, goal


def nearest(places, shapes) -> float:
    """How near places (N, 2) come to shapes [m]."""
    out = np.empty(3)
    return min(distance(x, z, shape, out) for x, z in places for shape in shapes)


def room_at(grounds, shapes) -> float:
    """How much room is left beside a walker at ground frames (N, 3) [m], as he is turned."""
    return -max(too_near(x, z, heading, shape, GIRTH) for x, z, heading in grounds for shape in shapes)


def planned(limits, things, start, goal) -> dict[str, Any]:
    """Plans by each set of weights: how long they took [ms], why there is none, whether they turn aside, whether they touch anything."""
    shapes, told = shapes_of(things), {}
    told["shut"] = not len(grid_way(start[:2], goal[:2], shapes, CLEARANCE, 0.025))
    for name, weights in SETS.items():
        begun = time.process_time()
        made = plan(start, goal, weights=weights, limits=limits, around=things)
        told[name] = {"ms": 1e3 * (time.process_time() - begun), "cost": made.cost, "reason": made.reason}
        if not made.reason:
            ground = made.sampled(800)[1]
            told[name] |= {"touches": room_at(ground, shapes) < -SWEPT, "aside": nearest(ground[:, :2], shapes) < CLEARANCE - SWEPT}
    return told


def walk(walker: Locomotion, things, start, goal) -> dict[str, Any]:
    """Somebody is sent under a supervisor, who makes his own plans: how he follows them [m, rad], how he arrives, and what of him touches anything [m]."""
    someone, asked = Supervisor({"locomotion": walker}), Goal(goal[:2], goal[2])
    state, off, bodies, way = someone.start(start), [], [], []
    for _ in range(round(60 * LONGEST)):
        state, _ = someone.step(state, Intent(goal=asked, around=things), 1 / 60)
        made = state.going
        if someone.status(state).kind != "running":
            break
        where, _ = made.plan.at(made.time)
        off.append((np.hypot(*(where - state.ground)[:2]), abs(wrap(where[2] - state.ground[2]))))
        bodies.append(state.pose)
        way.append(state.ground[:2])
    status = someone.status(state)
    depth, limb, thing, frame = limbs_in(walker.skeleton, bodies, things)
    last = made.plan.goal - state.ground
    return {"status": status.kind, "reason": status.reason, "seconds": len(off) / 60, "off": list(np.mean(off, 0)), "worst": list(np.max(off, 0)),
            "end": [float(np.hypot(*last[:2])), abs(float(wrap(last[2])))], "plans": made.plans, "nearest": nearest(np.array(way), shapes_of(things)),
            "depth": depth, "limb": limb, "thing": thing, "frame": frame}


def gaps(limits) -> None:
    """How many plans lead through a gap in a wall of 24 m, from six starts, and not round the wall."""
    ways = [((0.0, 0.0, 0.0), (0.0, 4.0, 0.0)), ((-1.0, 0.5, 0.0), (0.8, 3.5, 1.0)), ((1.0, 0.0, 2.0), (-1.0, 4.0, -1.0)),
            ((-2.0, 1.0, 1.5), (1.5, 3.0, 0.0)), ((0.3, 1.2, 3.0), (-0.5, 2.9, 0.0)), ((0.0, 0.0, 1.57), (0.0, 4.0, 1.57))]
    for wide in np.arange(0.47, 0.521, 0.005):
        wall = tuple(Box((side * (0.5 * wide + 6.0), 0.6, 2.0), (12.0, 1.2, 0.15)) for side in (1.0, -1.0))
        made = [plan(start, goal, limits=limits, around=wall) for start, goal in ways]
        through = sum(not one.reason and np.abs(one.sampled(200)[1][:, 0]).max() < 6.0 for one in made)
        print(f"a gap of {100 * wide:.1f} cm: {through} of {len(ways)} plans lead through it, {sum(bool(one.reason) for one in made)} nowhere", flush=True)


def told_of_plans(rows: Sequence[dict]) -> None:
    """All figures of plans."""
    for name in SETS:
        shut = sum(row["shut"] for row in rows)
        missed = [(row["number"], row[name]["reason"]) for row in rows if row[name]["reason"] and not row["shut"]]
        made, spent = [row for row in rows if not row[name]["reason"]], [row[name]["ms"] for row in rows]
        print(f"rooms of ten things, {name}: {len(rows)} goals, {shut} that no grid search reaches; of the others {len(rows) - shut - len(missed)} reached, "
              f"{sum(row['shut'] for row in made)} reached where the grid is too rough; {sum(row[name]['aside'] for row in made)} turn aside to pass; "
              f"{sum(row[name]['touches'] for row in made)} plans touch something; mean cost {np.mean([row[name]['cost'] for row in made]):.4f}")
        for number, why in missed[:10]:
            print(f"  missed {number}: {why}")
        print(f"  time of a plan: median {np.median(spent):.1f} ms, 95 % {np.percentile(spent, 95):.1f} ms, worst {max(spent):.1f} ms", flush=True)


def told_of_walks(rows: Sequence[dict]) -> None:
    """All figures of walks."""
    walks = [row["walk"] for row in rows if "walk" in row]
    there = [one for one in walks if one["status"] == "done"]
    if not there:
        return
    off, worst, end = (np.array([one[name] for one in there]) for name in ("off", "worst", "end"))
    depth = np.array([one["depth"] for one in walks])
    limbs = [one["limb"] for one in walks if one["depth"] > 0.0]
    print(f"sent among ten things: {len(there)} of {len(walks)} arrived; off the plan {100 * off[:, 0].mean():.1f} cm, {np.degrees(off[:, 1].mean()):.1f}° (worst moment "
          f"{100 * worst[:, 0].max():.1f} cm, {np.degrees(worst[:, 1].max()):.1f}°); at the goal worst {100 * end[:, 0].max():.1f} cm, {np.degrees(end[:, 1].max()):.1f}°; "
          f"{sum(one['plans'] for one in walks)} plans; {np.mean([one['seconds'] for one in there]):.2f} s each")
    print(f"  in every frame: middles of bodies never nearer than {100 * min(one['nearest'] for one in walks):.1f} cm; bodies of {BODY} m in something in "
          f"{sum(one['nearest'] < BODY for one in walks)} walks; limbs in {(depth > 0).sum()}, deepest {100 * depth.max():.1f} cm "
          f"({', '.join(f'{name} {limbs.count(name)}' for name in sorted(set(limbs))) or 'none'})")
    for row in rows:
        if "walk" in row and row["walk"]["status"] != "done":
            print(f"  failed {row['number']}: {row['walk']['reason'] or f'not there after {LONGEST:g} s'}")


def main() -> None:
    """Print all figures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenes", type=int, default=1000, help="rooms, of which the first --walked are walked through, too")
    parser.add_argument("--walked", type=int, default=400)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--gaps", action="store_true", help="narrow gaps instead of rooms")
    parser.add_argument("--log", type=Path, help="a file to which every room is added as it is done")
    parser.add_argument("--plots", type=Path, help="a folder for pictures")
    given = parser.parse_args()
    pictures(parser, given.plots)
    walker = Locomotion.load()
    limits = walker.walk.half_spaces()
    rehearse()
    if given.gaps:
        gaps(limits)
        return
    lines = given.log.read_text().splitlines() if given.log and given.log.exists() else []
    known = {(row["seed"], row["number"]): row for row in map(json.loads, lines)}
    rows = []
    for number in range(given.scenes):
        row = known.get((given.seed, number), {"seed": given.seed, "number": number})
        things, start, goal = room(given.seed, number)
        before = len(row)
        if "shut" not in row:
            row |= planned(limits, things, start, goal)
        if number < given.walked and not row["shut"] and "walk" not in row:
            row["walk"] = walk(walker, things, start, goal)
        if given.log and len(row) > before:
            with given.log.open("a") as file:
                file.write(json.dumps(row, default=float) + "\n")
        rows.append(row)
    told_of_plans(rows)
    told_of_walks(rows)
    if given.plots:
        scenes = [room(given.seed, number) for number in range(min(12, given.scenes))]
        for name, weights in SETS.items():
            made = [(shapes_of(things), plan(start, goal, weights=weights, limits=limits, around=things)) for things, start, goal in scenes]
            draw_rooms([one for one in made if not one[1].reason], given.plots / f"rooms_{name}.png")


if __name__ == "__main__":
    main()
