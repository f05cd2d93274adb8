"""Whether every plan of a jump is one that a body could play: what `compare_jump.py` prints beside the recorded jumps.

    python scripts/measure/jump_faults.py [--quick] [--seed 0]

Each figure is measured from the poses of finished plans, off axis as well as ahead, from rest, a walk and a run in
every phase of the stride.
"""

from __future__ import annotations

import argparse
import os
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one thread: what a game has
import numpy as np

from _jump_landings import report_ring, report_shape, report_strides
from _jump_obstacles import report_obstacles
from jump_trials import FINE, FPS, Motion, Trial, grown, ground, moved

from gambol.controllers.body import contact_points, log, sole_corners, yaw
from gambol.controllers.contract import CharacterState, Intent, Leap, Unable
from gambol.controllers.jump import Jump
from gambol.controllers.jump.body import Physique
from gambol.controllers.jump.motion import Plan
from gambol.controllers.locomotion import Locomotion

PACES = {"standing": 0.0, "strolling": 0.6, "walking": 1.4, "running": 2.8}
"""How fast those start who are asked [m/s]."""
BODIES = (Physique(), Physique(30.0, 1.3, 0.9, 1.1), Physique(110.0, 1.75, 0.75, 0.8))
PULLS = (9.81, 1.62, 24.8)
PLACES = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.6), (0.0, 0.0, 1.6), (0.7, 0.0, 0.1), (0.0, 0.0, -0.6), (0.3, 0.4, 0.7), (0.0, -1.0, 0.8))
AIRTIMES = (None, 0.05, 0.08, 0.2, 0.45, 0.9, 3.0)


def gaits(locomotion: Locomotion, phases: int) -> dict[str, list[CharacterState]]:
    """Somebody at the origin, facing +Z, by pace and at so many phases of the stride."""
    out = {}
    for name, pace in PACES.items():
        state, wish, states = locomotion.start(), np.array([pace, 0.0, 0.0]), []
        for k in range(150 + 48):
            before = state
            state, _ = locomotion.step(state, Intent(wish), 1 / FPS)
            if k >= 150:
                states.append(replace(state, previous=before.pose, elapsed=1 / FPS))
        states = states[::48 // phases] if pace else [replace(states[0], elapsed=0.0)]
        out[name] = [moved(s, -np.array([s.ground[0], 0.0, s.ground[1]])) for s in states]
    return out


def report_errors(states: dict[str, list[CharacterState]]) -> None:
    """Legal wishes of any body under any gravity: a plan, or `Unable`."""
    asked, planned, wrong = 0, 0, Counter()
    for body in BODIES:
        for pull in PULLS:
            jump = Jump(body, (0.0, -pull, 0.0))
            for pace in ("standing", "walking", "running"):
                state = grown(states[pace][3 % len(states[pace])], body.size)
                for place in PLACES:
                    for airtime in AIRTIMES:
                        asked += 1
                        try:
                            jump.plan(state, Intent(leap=Leap(np.array(place), airtime)))
                            planned += 1
                        except Unable:
                            pass
                        except Exception as error:  # any other error is what is looked for
                            wrong[f"{type(error).__name__}: {str(error)[:60]}"] += 1
    print(f"Errors of another kind: {sum(wrong.values())} of {asked} legal wishes ({planned} planned); {dict(wrong.most_common(4))}")


def wishes(rng: np.random.Generator, states: dict[str, list[CharacterState]], count: int) -> Iterator[Trial]:
    """Random targets all round, at random heights, from random paces and phases, in random bodies."""
    for _ in range(count):
        body = Physique(float(rng.uniform(50.0, 90.0)), float(rng.uniform(1.5, 1.95)), float(rng.uniform(0.8, 1.2)))
        pace = list(PACES)[rng.integers(len(PACES))]
        state = grown(states[pace][rng.integers(len(states[pace]))], body.size)
        way, far = rng.uniform(-np.pi, np.pi), rng.uniform(0.0, 1.8 if pace != "running" else 3.2)
        if pace in ("walking", "running"):
            way = 0.4 * way
        up = rng.uniform(-0.8, 0.4) if rng.random() < 0.5 else 0.0
        place = np.array([far * np.sin(way), up, far * np.cos(way)])
        airtime = None if rng.random() < 0.6 else float(rng.uniform(0.2, 0.75))
        yield Trial(Jump(body), state, Leap(place, airtime), (), pace == "running", f"{pace}, {np.degrees(way):.0f}° off")


def grid(states: dict[str, list[CharacterState]]) -> Iterator[Trial]:
    """Targets 0.8 rad and more off what a body faces."""
    jump = Jump()
    for pace, some in states.items():
        for state in some[::4]:
            for way in np.linspace(0.8, np.pi, 6):
                for sign in (-1.0, 1.0):
                    for far in (0.3, 0.6, 0.9, 1.2):
                        for airtime in (None, 0.4, 0.6):
                            place = np.array([sign * far * np.sin(way), 0.0, far * np.cos(way)])
                            yield Trial(jump, state, Leap(place, airtime), (), pace == "running", f"{pace}, {sign * np.degrees(way):.0f}° off")


def attitude(t: Trial, made: Plan) -> tuple[float, float, float]:
    """How far [°] pelvis and chest are tilted from upright at most in flight, how far at touch-down, and how far the body
    turns about upright at most."""
    seen = Motion.of(t.jump, made, np.linspace(made.take_off, made.touch_down, 40))
    chest = t.jump.skeleton.index("Spine2")
    up = np.maximum(np.arccos(np.clip(seen.orientations[:, 0, 1, 1], -1.0, 1.0)), np.arccos(np.clip(seen.orientations[:, chest, 1, 1], -1.0, 1.0)))
    turned = np.abs(log(seen.orientations[:, 0] @ yaw(float(t.state.ground[2])).T)[:, 1])
    return np.degrees(up.max()), np.degrees(up[-1]), np.degrees(turned.max())


def report_attitude(name: str, trials: Iterator[Trial]) -> list[tuple[Trial, Plan]]:
    """Tilt in flight; the plans that were made."""
    made, refused, worst = [], 0, []
    for t in trials:
        try:
            plan = t.jump.plan(t.state, t.intent)
        except Unable:
            refused += 1
            continue
        except Exception:  # counted above
            continue
        made.append((t, plan))
        worst.append(attitude(t, plan))
    tilt = np.array(worst)
    over = int((tilt[:, 0] > 90.0).sum())
    print(f"{name}: {len(made)} planned, {refused} refused; upside down {over} of {len(made)}; tilted in flight: median {np.median(tilt[:, 0]):.0f}°, 99 % "
          f"{np.percentile(tilt[:, 0], 99):.0f}°, worst {tilt[:, 0].max():.0f}° ({made[int(tilt[:, 0].argmax())][0].kind}); at touch-down 99 % "
          f"{np.percentile(tilt[:, 1], 99):.0f}°, worst {tilt[:, 1].max():.0f}°; turned about upright: 99 % {np.percentile(tilt[:, 2], 99):.0f}°, worst {tilt[:, 2].max():.0f}°")
    return made


def report_forces(made: list[tuple[Trial, Plan]]) -> None:
    """Pull, friction, pressure outside the soles, turning of joints, feet below the floor, over plans on level floors."""
    by = {}
    for t, plan in made:
        pace = t.kind.split(",")[0]
        place = t.leap.place if t.leap.place is not None else np.zeros(3)
        r = ground(replace(t, leap=Leap(place)), plan)
        seen = Motion.of(t.jump, plan, np.arange(0.0, plan.duration, 1 / FPS))
        local = seen.local[seen.times < plan.through]
        speed = np.linalg.norm(log(np.swapaxes(local[:-1], -1, -2) @ local[1:]), axis=-1) * FPS
        fast = {part: speed[:, [t.jump.skeleton.index(s + part) for s in ("Left", "Right")]].max() for part in ("Leg", "Foot", "Arm")}
        before = Motion.of(t.jump, plan, np.arange(0.0, plan.take_off, 1 / FINE))
        points = np.concatenate([contact_points(t.jump.skeleton, before.positions, before.orientations)[..., 1] - t.jump.physique.tables.sole,
                                 sole_corners(t.jump.skeleton, before.positions, before.orientations)[..., 1]], -1)
        legs = [t.jump.skeleton.index(s + "Leg") for s in ("Left", "Right")]
        off = Motion.of(t.jump, plan, [plan.take_off, plan.touch_down])
        bend = np.degrees(np.linalg.norm(log(off.local[0, legs]), axis=-1))
        by.setdefault(pace, []).append([r["pull %"], r["friction"], r["push off soles cm"], fast["Leg"], fast["Foot"], fast["Arm"],
                                        100.0 * (float(t.state.floor) - points.min()), bend.min(), bend.max()])
    for pace, rows in by.items():
        a = np.array(rows)
        print(f"{pace}: {len(a)} plans; pull > 1 % in {100 * (a[:, 0] > 1).mean():.1f} %; friction > 1 in {100 * (a[:, 1] > 1).mean():.1f} %; pressure > 5 cm outside "
              f"the soles in the push in {100 * (a[:, 2] > 5).mean():.0f} %; knee over 17 rad/s in {100 * (a[:, 3] > 17).mean():.0f} % (worst {a[:, 3].max():.0f}), ankle over 20 "
              f"in {100 * (a[:, 4] > 20).mean():.0f} % (worst {a[:, 4].max():.0f}), shoulder 99 % {np.percentile(a[:, 5], 99):.0f} rad/s; a foot > 1 cm below the floor before take-off in "
              f"{int((a[:, 6] > 1.0).sum())} ({a[:, 6].max():.1f} cm); knee at take-off median {np.median(a[:, 7]):.0f}° (straighter leg)")


def table(locomotion: Locomotion, quick: bool, seed: int) -> None:
    """Everything."""
    rng, states = np.random.default_rng(seed), gaits(locomotion, 8)
    report_errors(states)
    made = report_attitude("random targets", wishes(rng, states, 150 if quick else 812))
    report_attitude("0.8 rad and more off axis", grid(states))
    report_obstacles(states)
    report_forces([(t, plan) for t, plan in made if abs(t.leap.place[1]) < 1e-9 or t.leap.place[1] == 0.0])
    report_shape(states)
    report_strides(locomotion, rng)
    report_ring(locomotion)
    spent = []
    for t, _ in made[:60]:
        jump = Jump(t.jump.physique, t.jump.gravity)  # which knows of no plan
        begin = time.process_time()
        jump.plan(t.state, t.intent)
        spent.append(1e3 * (time.process_time() - begin))
    print(f"planning: median {np.median(spent):.1f} ms of the processor, worst of {len(spent)} {max(spent):.1f} ms")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--quick", action="store_true", help="150 random targets")
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    table(Locomotion.load(), given.quick, given.seed)


if __name__ == "__main__":
    main()
