"""How fast knees and ankles turn in jumps, phase by phase, beside recorded ones.

    python scripts/measure/jump_joints.py [--count 150] [--seed 0] [--plans] [--worst 0]

Plans are those of `jump_faults.py`: random targets all round, in random bodies, from rest, a stroll, a walk and a run. Recorded jumps are those of
`compare_jump.py`; both are looked at 60 times a second. A phase's figure is the fastest turn in it; printed are the median and the worst over all
jumps, and in how many knees turn faster than 17 and ankles faster than 20 rad/s.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one thread: what a game has
import numpy as np

from compare_jump import recorded
from jump_faults import gaits, wishes

from gambol.controllers.body import log
from gambol.controllers.contract import Unable
from gambol.controllers.jump import Jump
from gambol.controllers.locomotion import Locomotion

FPS = 60.0
PHASES = ("down", "push", "take-off", "after it", "fold", "unfold", "before", "touch-down", "sinks", "up")
"""Until the lowest point; the push until 50 ms before take-off, those, and as many after it; the rest of the flight's first half, its second
until 50 ms before touch-down, those, and as many after it; until the lowest point of the landing; on from there."""
NEAR = 0.05
"""So long before and after take-off and touch-down [s]."""
FAST = {"knee": 17.0, "ankle": 20.0}
"""Nobody turns joints faster [rad/s]."""


def ends(lowest: float, leave: float, down: float, landed: float, end: float) -> np.ndarray:
    """Where phases begin and end (11,) [s] of a jump with these events."""
    middle, near = 0.5 * (leave + down), min(NEAR, 0.25 * (down - leave))
    return np.array([0.0, lowest, max(leave - NEAR, lowest), leave, leave + near, middle, down - near, down, min(down + NEAR, landed), landed, end])


def rates(jump: Jump, local: np.ndarray) -> dict[str, np.ndarray]:
    """How fast (T − 1, 2) [rad/s] left and right knees and ankles turn between poses (T, ...)."""
    out = {}
    for name, joint in (("knee", "Leg"), ("ankle", "Foot")):
        turned = local[:, [jump.skeleton.index(side + joint) for side in ("Left", "Right")]]
        out[name] = FPS * np.linalg.norm(log(np.swapaxes(turned[:-1], -1, -2) @ turned[1:]), axis=-1)
    return out


def fastest(found: dict[str, np.ndarray], times: np.ndarray, limits: np.ndarray) -> dict[str, np.ndarray]:
    """The fastest (10,) [rad/s] of each phase; 0 where it is shorter than a frame. times: (T − 1,) [s] the middles of the steps."""
    phase = np.clip(np.searchsorted(limits, times) - 1, 0, len(PHASES) - 1)
    return {name: np.array([speed[phase == k].max(initial=0.0) for k in range(len(PHASES))]) for name, speed in found.items()}


def of_recorded() -> Iterator[tuple[str, dict[str, np.ndarray]]]:
    """Every recorded jump: off how many feet, and its fastest."""
    jump = Jump()
    for clip, some in recorded(jump):
        thin = max(round(1 / (FPS * clip.frame_time)), 1)
        for one in some:
            start, lowest, first, last, landed, upright = (e * clip.frame_time for e in one.events)
            local = clip.rotations[one.events[0]:one.events[-1] + 1:thin]
            speeds = {name: part / (thin * clip.frame_time * FPS) for name, part in rates(jump, local).items()}
            times = (np.arange(len(local) - 1) + 0.5) * thin * clip.frame_time
            yield "recorded, off both" if one.single is None else "recorded, off one", fastest(
                speeds, times, ends(*(t - start for t in (lowest, first, last, landed, upright))))


def of_plans(count: int, seed: int) -> Iterator[tuple[str, dict[str, np.ndarray], str]]:
    """Every random plan: its pace, its fastest, and what was asked."""
    states = gaits(Locomotion.load(), 8)
    for t in wishes(np.random.default_rng(seed), states, count):
        try:
            plan = t.jump.plan(t.state, t.intent)
        except Unable:
            continue
        times = np.arange(0.0, min(plan.duration, plan.through), 1.0 / FPS)
        found = rates(t.jump, np.stack([plan.at(time).rotations for time in times]))
        limits = ends(plan.push_off, plan.take_off, plan.touch_down, max(plan.lowest, plan.touch_down + 0.02), plan.duration)
        place, size = np.asarray(t.leap.place), t.jump.physique.size
        told = (f"{t.kind}, {np.hypot(place[0], place[2]):.2f} m, {place[1]:+.2f} m up, airtime {plan.touch_down - plan.take_off:.2f} s"
                f"{'' if t.leap.airtime is None else ' told'}, size {size:.2f}, falls {-plan.path.falling[1]:.1f} m/s")
        yield ("level: " if place[1] == 0.0 else "up or down: ") + t.kind.split(",")[0], fastest(found, times[:-1] + 0.5 / FPS, limits), told


def table(rows: list[tuple], worst: int) -> None:
    """What was found, by kind."""
    print(f"{'':24s}{'':7s}{'all':>14s}" + "".join(f"{phase:>12s}" for phase in PHASES))
    for kind in dict.fromkeys(row[0] for row in rows):
        some = [row for row in rows if row[0] == kind]
        for name, most in FAST.items():
            found = np.array([row[1][name] for row in some])
            over = found > most
            print(f"{kind:24s}{name:7s}" + "".join(f"{np.median(part):{w}.0f} ({part.max():2.0f})" for part, w in zip((found.max(1), *found.T), [9] + [7] * 10)))
            print(f"{f'  {len(some)}, over {most:.0f} rad/s':24s}{'':7s}" + "".join(f"{int(part.sum()):{w}d}" for part, w in zip((over.any(1), *over.T), [14] + [12] * 10)))
    for name in FAST if worst else ():
        print(f"fastest {name}s:")
        for row in sorted((row for row in rows if len(row) > 2), key=lambda row: -row[1][name].max())[:worst]:
            print(f"  {row[1][name].max():4.1f} rad/s, {PHASES[int(row[1][name].argmax())]}: {row[2]}")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--count", type=int, default=150, help="random targets")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--plans", action="store_true", help="without recorded jumps")
    parser.add_argument("--worst", type=int, default=0, help="so many of the fastest are told")
    given = parser.parse_args()
    table((list(of_recorded()) if not given.plans else []) + list(of_plans(given.count, given.seed)), given.worst)


if __name__ == "__main__":
    main()
