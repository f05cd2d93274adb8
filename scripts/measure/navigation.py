"""Measure walks to goals: cost against IPOPT's optimum, likeness to people, times, how they are followed; among things: `rooms.py`.

    python scripts/measure/navigation.py [--quick] [--seed 0] [--plots DIR]

Cost: the same problem stated anew for casadi and IPOPT (`tests/navigation/oracle.py`), with and without limits; where casadi is
installed. Likeness: in full, and on walks left out, it is told by `gambol navigate fit`; here the shipped weights on the recorded
walks in ../shared/human_paths, where they lie. Times are the processor's.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one thread: what a game has
import numpy as np

from _navigation import RECORDED, SETS, around_the_start
from _plots import pictures

from gambol.controllers.body import wrap
from gambol.controllers.contract import Intent
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.navigation import arrived, wish
from gambol.controllers.navigation.identification import likeness, planned_like, read_paths, straight
from gambol.controllers.navigation.planning import FREE, plan, rehearse

ROOT = Path(__file__).resolve().parents[2]
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


def main() -> None:
    """Print all figures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="a few of each")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--plots", type=Path, help="a folder for pictures")
    given = parser.parse_args()
    pictures(parser, given.plots)
    walker = Locomotion.load()
    limits = walker.walk.half_spaces()
    rehearse()
    rng = np.random.default_rng(given.seed)
    free_times(limits, 40 if given.quick else 500, rng)
    people(limits)
    if given.plots:
        around_the_start(limits, given.plots)
    followed(walker, 10 if given.quick else 50, rng)
    costs(limits, 3 if given.quick else 25, rng)


if __name__ == "__main__":
    main()
