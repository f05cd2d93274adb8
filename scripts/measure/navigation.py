"""Measure walks to goals: cost against IPOPT's optimum, likeness to people, obstacles, times, how they are followed.

    python scripts/measure/navigation.py [--quick] [--scenes 1000] [--seed 0] [--plots DIR]

Cost: the same problem stated anew for casadi and IPOPT (`tests/navigation/oracle.py`), with and without limits; where casadi is
installed. Likeness: in full, and on walks left out, it is told by `gambol navigate fit`; here the shipped weights on the recorded
walks in ../shared/human_paths, where they lie. Obstacles: random rooms with ten discs, boxes and walls; a goal counts as one that can
be reached where a grid twice as fine as the planner's has a way for a disc of the clearance's radius; along every plan the body is swept as it is turned, as wide as that disc, less deep. Times are the processor's.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one thread: what a game has
import numpy as np

from _limbs import limbs_in
from _navigation import BODY, CLEARANCE, RECORDED, SETS, around_the_start, draw_rooms
from _plots import pictures

from gambol.controllers.body import wrap
from gambol.controllers.contract import Goal, Intent
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.navigation import DEPTH, arrived, wish
from gambol.controllers.navigation.identification import likeness, planned_like, read_paths, straight
from gambol.controllers.navigation.planning import FREE, plan, too_near
from gambol.controllers.navigation.routes import distance, grid_way, shapes_of
from gambol.controllers.supervisor import Supervisor
from gambol.game.scene import Box, Pillar

ROOT = Path(__file__).resolve().parents[2]
SWEPT = 1e-3
"""A disc this much smaller [m] than the clearance is swept: grazing is no collision."""
GIRTH = np.array([CLEARANCE, *DEPTH])
"""How far a walker reaches aside, ahead and back [m]."""
SHARE = 0.9
"""What is left of the library's velocities [share] serves to catch up."""
HARD = [(0.0, 3.0, 0.0), (0.0, -1.0, 0.0), (1.0, 0.0, 0.0), (-1.5, 1.0, -np.pi), (0.0, 0.5, np.pi), (0.0, 0.0, np.pi)]
"""Goals ahead, behind, at the side, turned round and on the spot."""


def costs(limits, count: int, rng) -> None:
    """How far above IPOPT's least cost plans are."""
    sys.path.insert(0, str(ROOT / "tests" / "navigation"))
    try:
        from oracle import least_cost
    except ImportError:
        print("cost against IPOPT: casadi is not installed")
        return
    for name, weights in SETS.items():
        for within, planes in (("free", FREE), ("within the library's velocities", limits)):
            over, worse = [], 0
            for goal in [*HARD, *[(*rng.uniform(-4, 4, 2), rng.uniform(-np.pi, np.pi)) for _ in range(count)]][:count]:
                made = plan(np.zeros(3), goal, weights=weights, limits=planes)
                times, grounds, _ = made.sampled(41)
                ends = [np.array(goal) + [0, 0, turn] for turn in (-2 * np.pi, 0, 2 * np.pi) if abs(goal[2] + turn) < 1.5 * np.pi]
                found = [least_cost(np.zeros(3), end, weights, limits=planes, turns=(0, -1 if end[2] > 0 else 1),
                                    around=[(times, grounds)] if abs(end[2] - made.goal[2]) < 0.1 else [])[0] for end in ends]
                over.append(100 * (made.cost / min(found) - 1) if not made.reason else np.inf)
                worse += over[-1] > 1
            print(f"cost over IPOPT's least, {name}, {within}: {count} goals, mean {np.mean(over):+.2f} %, worst {max(over):+.2f} %, {worse} over 1 %",
                  flush=True)


def people(limits) -> None:
    """How like people's walks the plans are."""
    if not RECORDED.exists():
        print("likeness to people: no ../shared/human_paths beside the project")
        return
    paths = read_paths(RECORDED)
    print(f"likeness to {len(paths)} walks of people: straight lines {straight(paths).mean():.3f} m")
    for name, weights in SETS.items():
        for within, planes in (("free", FREE), ("within the library's velocities", limits)):
            away, heading, turning = likeness(paths, planned_like(paths, weights, planes)).means()
            print(f"  {name}, {within}: {away:.3f} m, heading {np.degrees(heading):.1f}°, turning at most {turning:.2f} rad/s")


def free_times(limits, count: int, rng) -> None:
    """How long plans take with nothing in the way."""
    for name, weights in SETS.items():
        spent = []
        for _ in range(count):
            goal = (*rng.uniform(-5, 5, 2), rng.uniform(-np.pi, np.pi))
            begun = time.process_time()
            made = plan(np.zeros(3), goal, (rng.uniform(0, 1.2), 0.0, 0.0), weights=weights, limits=limits)
            spent.append(1e3 * (time.process_time() - begun))
            if made.reason:
                print(f"  no plan to {np.round(goal, 2)}: {made.reason}")
        print(f"time of a plan, {name}: median {np.median(spent):.1f} ms, 95 % {np.percentile(spent, 95):.1f} ms, worst {max(spent):.1f} ms ({count} goals)")


def room(rng) -> list:
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
    return made


def nearest(places, shapes) -> float:
    """How near places (N, 2) come to shapes [m]."""
    out = np.empty(3)
    return min(distance(x, z, shape, out) for x, z in places for shape in shapes)


def room_at(grounds, shapes) -> float:
    """How much room is left beside a walker at ground frames (N, 3) [m], as he is turned."""
    return -max(too_near(x, z, heading, shape, GIRTH) for x, z, heading in grounds for shape in shapes)


def rooms(limits, count: int, seed: int, plots: Path | None) -> None:
    """Goals in rooms: whether they are reached, and whether anything is touched."""
    for name, weights in SETS.items():
        rng = np.random.default_rng(seed)
        spent, missed, touched, turned, shut, beyond, drawn = [], [], 0, 0, 0, 0, []
        while len(spent) < count:
            things = room(rng)
            shapes = shapes_of(things)
            start, goal = ((*rng.uniform(-3.5, 3.5, 2), rng.uniform(-np.pi, np.pi)) for _ in range(2))
            if np.hypot(start[0] - goal[0], start[1] - goal[1]) < 1.0 or nearest(np.array([start[:2], goal[:2]]), shapes) < CLEARANCE:
                continue
            there = len(grid_way(start[:2], goal[:2], shapes, CLEARANCE, 0.025)) > 0
            begun = time.process_time()
            made = plan(start, goal, weights=weights, limits=limits, around=things)
            spent.append(1e3 * (time.process_time() - begun))
            shut += not there
            if made.reason:
                if there:
                    missed.append(f"{len(spent)}: {made.reason}")
                continue
            beyond += not there
            _, ground, _ = made.sampled(800)
            touched += room_at(ground, shapes) < -SWEPT
            turned += nearest(ground[:, :2], shapes) < CLEARANCE - SWEPT
            if len(drawn) < 12:
                drawn.append((shapes, made))
        print(f"rooms of ten things, {name}: {count} goals, {shut} that no grid search reaches; of the others {count - shut - len(missed)} reached"
              f" ({100 * (count - shut - len(missed)) / max(count - shut, 1):.1f} %), {beyond} reached where the grid is too rough; {turned} turn aside to pass; {touched} plans touch something")
        for line in missed[:10]:
            print(f"  missed {line}")
        print(f"  time of a plan: median {np.median(spent):.1f} ms, 95 % {np.percentile(spent, 95):.1f} ms, worst {max(spent):.1f} ms", flush=True)
        if plots:
            draw_rooms(drawn, plots / f"rooms_{name}.png")


def followed(walker, count: int, rng) -> None:
    """How a walker follows plans that use most of what he can do, and how he arrives."""
    limits = walker.walk.half_spaces(SHARE)
    for name, weights in SETS.items():
        rows = []
        for _ in range(count):
            made = plan(np.zeros(3), (*rng.uniform(-4, 4, 2), rng.uniform(-np.pi, np.pi)), weights=weights, limits=limits)
            state, off, into, ticks = walker.start(), [], 0.0, 0
            while into < made.seconds + 4:
                ready = walker.readiness(state)
                state, _ = walker.step(state, Intent(wish(made, into, state.ground, state.velocity)), 1 / 60)
                into, ticks = into + ready / 60, ticks + 1
                where, _ = made.at(into)
                if into <= made.seconds:
                    off.append((np.hypot(*(where - state.ground)[:2]), abs(wrap(where[2] - state.ground[2]))))
                elif arrived(made, into, state.ground) and np.abs(state.velocity).max() < 0.01:
                    break
            last = made.goal - state.ground
            rows.append((*np.mean(off, 0), *np.max(off, 0), np.hypot(*last[:2]), abs(wrap(last[2])), ticks / 60 - made.seconds))
        place, heading, worst_place, worst_heading, end, end_heading, late = np.array(rows).T
        print(f"followed by the walker, {name}: off {100 * place.mean():.1f} cm, {np.degrees(heading.mean()):.1f}° (worst walk {100 * place.max():.1f} cm, "
              f"{np.degrees(heading.max()):.1f}°; worst moment {100 * worst_place.max():.1f} cm, {np.degrees(worst_heading.max()):.1f}°); at the goal "
              f"{100 * end.mean():.1f} cm, {np.degrees(end_heading.mean()):.1f}°, worst {100 * end.max():.1f} cm, {np.degrees(end_heading.max()):.1f}°; stands "
              f"{late.mean():.1f} s after the plan's end, worst {late.max():.1f} s", flush=True)


def sent(walker, count: int, seed: int) -> None:
    """How somebody who is told a goal among ten things follows his plans and arrives, under a supervisor, with plans of his own; what of his body
    touches anything in any frame."""
    someone, rng = Supervisor({"locomotion": walker}), np.random.default_rng(seed)
    rows, failed, steps, planned, near, shut, struck = [], [], [], [], [], 0, []
    while len(rows) + len(failed) < count:
        things = tuple(room(rng))
        shapes = shapes_of(things)
        start, goal = ((*rng.uniform(-3.5, 3.5, 2), rng.uniform(-np.pi, np.pi)) for _ in range(2))
        if np.hypot(start[0] - goal[0], start[1] - goal[1]) < 1.0 or nearest(np.array([start[:2], goal[:2]]), shapes) < CLEARANCE:
            continue
        if not len(grid_way(start[:2], goal[:2], shapes, CLEARANCE, 0.025)):
            shut += 1
            continue
        state, asked, off, way, plans, bodies = someone.start(start), Goal(goal[:2], goal[2]), [], [], 0, []
        for _ in range(60 * 40):
            begun = time.process_time()
            state, _ = someone.step(state, Intent(goal=asked, around=things), 1 / 60)
            (planned if state.going.plans > plans else steps).append(1e3 * (time.process_time() - begun))
            plans, made = state.going.plans, state.going
            if someone.status(state).kind != "running":
                break
            where, _ = made.plan.at(made.time)
            off.append((np.hypot(*(where - state.ground)[:2]), abs(wrap(where[2] - state.ground[2]))))
            way.append(state.ground[:2])
            bodies.append(state.pose)
        if someone.status(state).kind != "done":
            failed.append(someone.status(state).reason or "not there after 40 s")
            continue
        last = made.plan.goal - state.ground
        rows.append((*np.mean(off, 0), *np.max(off, 0), np.hypot(*last[:2]), abs(wrap(last[2])), plans))
        near.append(nearest(np.array(way), shapes))
        struck.append(limbs_in(walker.skeleton, bodies, things))
    place, heading, worst_place, worst_heading, end, end_heading, plans = np.array(rows).T
    depth, by = np.array([deep for deep, _ in struck]), [name for deep, name in struck if deep > 0]
    print(f"sent among ten things: {len(rows)} of {count} arrived, beside {shut} goals that no grid search reaches; off the plan {100 * place.mean():.1f} cm, {np.degrees(heading.mean()):.1f}° (worst moment "
          f"{100 * worst_place.max():.1f} cm, {np.degrees(worst_heading.max()):.1f}°); at the goal worst {100 * end.max():.1f} cm, {np.degrees(end_heading.max()):.1f}°; "
          f"{int(plans.sum())} plans; the middle of the body never nearer to anything than {100 * min(near):.1f} cm; a step {np.median(steps):.2f} ms, one that plans "
          f"{np.median(planned):.1f} ms, worst {max(planned):.1f} ms")
    print(f"  in every frame: bodies of {BODY} m in something in {sum(1 for one in near if one < BODY)} walks; limbs in {(depth > 0).sum()}, deepest "
          f"{100 * depth.max():.1f} cm ({', '.join(f'{name} {by.count(name)}' for name in sorted(set(by))) or 'none'})")
    for why in sorted(set(failed)):
        print(f"  failed, {failed.count(why)}: {why}")


def main() -> None:
    """Print all figures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="a few of each")
    parser.add_argument("--scenes", type=int, default=1000, help="rooms with obstacles")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--plots", type=Path, help="a folder for pictures")
    given = parser.parse_args()
    pictures(parser, given.plots)
    walker = Locomotion.load()
    limits = walker.walk.half_spaces()
    plan(np.zeros(3), (1.0, 1.0, 1.0), limits=limits, around=[Pillar((0.5, 0.0, 0.5), 0.1, 1.0)])  # compiled
    rng = np.random.default_rng(given.seed)
    free_times(limits, 40 if given.quick else 500, rng)
    people(limits)
    if given.plots:
        around_the_start(limits, given.plots)
    followed(walker, 10 if given.quick else 50, rng)
    sent(walker, 10 if given.quick else given.scenes, given.seed)
    rooms(limits, 40 if given.quick else given.scenes, given.seed, given.plots)
    costs(limits, 3 if given.quick else 25, rng)


if __name__ == "__main__":
    main()
