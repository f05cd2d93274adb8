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
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one thread: what a game has
import numpy as np

from jump_trials import FINE, FPS, Motion, Trial, grown, ground, moved, starts

from gambol.controllers.body import contact_points, end_positions, log, sole_corners, yaw
from gambol.controllers.contract import CharacterState, Intent, Leap, Unable
from gambol.controllers.jump import Jump
from gambol.controllers.jump.body import Physique, airtime_up
from gambol.controllers.jump.motion import Plan
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.navigation import gap
from gambol.controllers.supervisor import Supervisor
from gambol.game.scene import Box

PACES = {"standing": 0.0, "strolling": 0.6, "walking": 1.4, "running": 2.8}
"""How fast those start who are asked [m/s]."""
BODIES = (Physique(), Physique(30.0, 1.3, 0.9, 1.1), Physique(110.0, 1.75, 0.75, 0.8))
PULLS = (9.81, 1.62, 24.8)
PLACES = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.6), (0.0, 0.0, 1.6), (0.7, 0.0, 0.1), (0.0, 0.0, -0.6), (0.3, 0.4, 0.7), (0.0, -1.0, 0.8))
AIRTIMES = (None, 0.05, 0.08, 0.2, 0.45, 0.9, 3.0)
BONES = (("Leg", "Foot"), ("UpLeg", "Leg"), ("ForeArm", "Hand"), ("Arm", "ForeArm"))


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


def depth(jump: Jump, made: Plan, around: Sequence[Any]) -> dict[str, float]:
    """How deep [cm] bones, feet, head and hands are in things, over the whole plan."""
    skeleton = jump.skeleton
    seen = Motion.of(jump, made, np.arange(0.0, min(made.duration, made.through), 1 / 120))
    ends = end_positions(skeleton, seen.positions, seen.orientations)
    parts = {}
    for above, below in BONES:
        lines = [seen.positions[:, skeleton.index(s + above)] + part * (seen.positions[:, skeleton.index(s + below)] - seen.positions[:, skeleton.index(s + above)])
                 for s in ("Left", "Right") for part in np.linspace(0.0, 0.9, 6)]
        parts["shins" if above == "Leg" else "thighs" if above == "UpLeg" else "arms"] = np.stack(lines, 1)
    parts["feet"] = sole_corners(skeleton, seen.positions, seen.orientations).reshape(len(seen.times), -1, 3) + [0.0, 0.01, 0.0]
    parts["head"] = ends[:, [skeleton.end_index["Head"]]]
    parts["hands"] = ends[:, [skeleton.end_index[s + "Hand"] for s in ("Left", "Right")]]
    parts["trunk"] = seen.positions[:, [skeleton.index(n) for n in ("Hips", "Spine", "Spine1", "Spine2", "Neck")]]
    return {name: 100.0 * max(0.0, *(-gap(points.reshape(-1, 3), thing).min() for thing in around)) for name, points in parts.items()}


def obstacles(states: dict[str, list[CharacterState]]) -> Iterator[tuple[str, CharacterState, np.ndarray, tuple[Box, ...]]]:
    """Hurdles, platforms, walls behind the target and roofs: what stands there, from which state, to where."""
    for high in (0.2, 0.4, 0.6):
        for pace, far in (("standing", 0.9), ("standing", 1.3), ("walking", 1.4), ("running", 2.2), ("running", 2.8)):
            for state in states[pace][::4]:
                for part in (0.4, 0.5, 0.6, 0.7):
                    yield f"hurdle of {high:.1f} m", state, np.array([0.0, 0.0, far]), (Box((0.0, 0.5 * high, part * far), (2.0, high, 0.2)),)
    for high in (0.15, 0.3, 0.45):
        for pace, far in (("standing", 0.6), ("standing", 0.9), ("walking", 1.3), ("running", 2.0)):
            for state in states[pace][::4]:
                for inside in (0.16, 0.25, 0.4):
                    yield "platform's edge", state, np.array([0.0, high, far]), (Box((0.0, 0.5 * high, far - inside + 1.0), (3.0, high, 2.0)),)
    for pace, far in (("standing", 0.5), ("standing", 0.9), ("walking", 1.4), ("running", 2.4)):
        for state in states[pace][::4]:
            for behind in (0.2, 0.3, 0.45, 0.7):
                yield "wall behind the target", state, np.array([0.0, 0.0, far]), (Box((0.0, 1.5, far + behind + 0.1), (4.0, 3.0, 0.2)),)
    for pace, far in (("standing", 0.5), ("standing", 1.0), ("walking", 1.4)):
        for state in states[pace][::4]:
            for low in (1.8, 1.9, 2.0, 2.2):
                yield "roof", state, np.array([0.0, 0.0, far]), (Box((0.0, low + 0.5, far), (4.0, 1.0, 1.6)),)


def report_obstacles(states: dict[str, list[CharacterState]]) -> None:
    """How deep finished plans are in what stands about, and whether a place that is offered instead is one."""
    jump, deepest, count, refused, bad, offered = Jump(), {}, Counter(), Counter(), Counter(), 0
    for name, state, place, around in obstacles(states):
        count[name] += 1
        try:
            made = jump.plan(state, Intent(leap=Leap(place), around=around))
        except Unable as reason:
            refused[name] += 1
            near = getattr(reason, "nearest", None)
            if near is not None:
                offered += 1
                try:
                    deep = depth(jump, jump.plan(state, Intent(leap=Leap(near), around=around)), around)
                    if max(deep.values()) > 0.0:
                        bad["touches something"] += 1
                except Exception as error:
                    bad[f"{type(error).__name__}: {str(error)[:40]}"] += 1
            continue
        for part, deep in depth(jump, made, around).items():
            deepest.setdefault(name, {})[part] = max(deepest.get(name, {}).get(part, 0.0), deep)
    for name, total in count.items():
        told = {part: round(deep, 1) for part, deep in deepest.get(name, {}).items() if deep > 0.0}
        print(f"{name}: {total - refused[name]} planned, {refused[name]} refused; deepest [cm] {told or 0}")
    print(f"places offered instead: {offered}, that can't be jumped to or touch something {sum(bad.values())} {dict(bad.most_common(3))}")


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


def report_shape(states: dict[str, list[CharacterState]]) -> None:
    """Straight up: crouch, take-off, landing; landings from a height; release to take-off."""
    jump, state = Jump(), states["standing"][0]
    for height in (0.06, 0.15, 0.25, 0.40):
        made = jump.plan(state, Intent(leap=Leap(None, airtime_up(jump.physique, height, jump.gravity))))
        told(jump, made, f"up {height:.2f} m")
    for far in (0.5, 1.0):
        told(jump, jump.plan(state, Intent(leap=Leap(np.array([0.0, 0.0, far])))), f"ahead {far:.1f} m")
    high = moved(state, np.array([0.0, 1.0, 0.0]))
    box = Box((0.0, 0.5, -1.0), (3.0, 1.0, 2.3))
    told(jump, jump.plan(high, Intent(leap=Leap(np.array([0.0, 0.0, 0.7])), around=(box,))), "down 1.0 m")
    for name, way in (("forward", 0.0), ("sideways", 0.5 * np.pi), ("backward", np.pi)):
        best = 0.0
        for far in np.arange(0.3, 3.0, 0.02):
            try:
                jump.plan(state, Intent(leap=Leap(far * np.array([np.sin(way), 0.0, np.cos(way)]))))
                best = far
            except Unable:
                break
        print(f"standing reach {name}: {best:.2f} m")


def told(jump: Jump, made: Plan, name: str) -> None:
    """One jump in figures."""
    seen = Motion.of(jump, made, np.arange(0.0, made.duration, 1 / FINE))
    c = seen.centre[:, 1]
    force = 1.0 + np.convolve(np.diff(c, 2) * FINE**2 / 9.81, np.full(5, 0.2), "same")
    at = lambda time: int(np.clip(round(time * FINE), 0, len(c) - 1))  # noqa: E731
    down, off = at(made.touch_down), at(made.take_off)
    low = down + int(c[down:].argmin())
    neck = seen.positions[:, jump.skeleton.index("Neck")] - seen.positions[:, 0]
    trunk = np.degrees(np.arctan2(np.hypot(neck[:, 0], neck[:, 2]), neck[:, 1]))
    knee = np.degrees(np.linalg.norm(log(seen.local[:, jump.skeleton.index("LeftLeg")]), axis=-1))
    print(f"{name}: crouch {c[0] - c[:off].min():.2f} m, knee {knee[:off].max():.0f}°, at take-off {knee[off]:.0f}°, at touch-down {knee[down]:.0f}°, lowest {knee[low]:.0f}°; trunk "
          f"lowest before {trunk[int(c[:off].argmin())]:.0f}°, take-off {trunk[off]:.0f}°, touch-down {trunk[down]:.0f}°, landed lowest {trunk[low]:.0f}°, most {trunk[down:].max():.0f}°, 0.25 s later "
          f"{trunk[min(low + FINE // 4, len(c) - 1)]:.0f}°; landing sinks {c[0] - c[low]:.2f} m, force {force[down + 4:].max():.1f} BW, first 10 ms {force[down + 2]:.1f}; "
          f"begin to take-off {made.take_off:.2f} s, on the ground after {made.duration - made.touch_down:.2f} s")


def report_strides(locomotion: Locomotion, rng: np.random.Generator) -> None:
    """Leaps out of runs of many speeds, from a foot that has just struck: on how many feet they land, and how hard."""
    jump, rows, refused = Jump(), [], 0
    for state in starts(locomotion, rng, 24)[1]:
        for far in (1.8, 2.1, 2.4, 2.7):
            t = Trial(jump, state, Leap(np.array([0.0, 0.0, far])), (), True, "running")
            try:
                plan = jump.plan(t.state, t.intent)
            except Unable:
                refused += 1
                continue
            r, last = ground(t, plan), min(plan.duration, plan.through)
            seen = Motion.of(jump, plan, np.arange(plan.touch_down, last, 1 / FINE))
            up = 1.0 + np.convolve(np.diff(seen.centre[:, 1], 2) * FINE**2 / 9.81, np.full(5, 0.2), "valid")
            knee = np.degrees(np.linalg.norm(log(seen.local[:, jump.skeleton.index(("Left", "Right")[plan.path.lands or 0] + "Leg")]), axis=-1))
            rows.append([plan.path.lands is not None, up.max(), r["pull %"], r["friction"], r["push off soles cm"], r["landing off soles cm"], knee[0], knee.max(),
                         100.0 * (seen.centre[0, 1] - seen.centre[:, 1].min()), last - plan.touch_down])
    a = np.array(rows)
    print(f"leaps out of runs: {len(a)} planned, {refused} refused; {int(a[:, 0].sum())} land on one foot, with {np.median(a[:, 1]):.1f} body weights (median), {a[:, 1].max():.1f} (worst); pull > 1 % in "
          f"{100 * (a[:, 2] > 1).mean():.0f} %, friction > 1 in {100 * (a[:, 3] > 1).mean():.0f} % ({a[:, 3].max():.2f}); pressure outside the sole in the push, as it lands {np.median(a[:, 4]):.0f}, "
          f"{np.median(a[:, 5]):.0f} cm (median), {a[:, 4].max():.0f}, {a[:, 5].max():.0f} cm (worst); knee as it lands {np.median(a[:, 6]):.0f}°, most {np.median(a[:, 7]):.0f}°; it sinks "
          f"{np.median(a[:, 8]):.0f} cm, and runs on after {np.median(a[:, 9]):.2f} s")


def report_ring(locomotion: Locomotion) -> None:
    """A ring a little ahead of a runner, asked for at every phase of the stride; and what a refused one costs."""
    refused, asked, waits, told = 0, 0, [], Counter()
    for far in (1.8, 2.0, 2.2, 2.4, 2.6, 2.8, 3.0):
        for phase in range(8):
            person = Supervisor({"locomotion": locomotion, "jump": Jump()})
            state, wish = person.start(), np.array([2.8, 0.0, 0.0])
            for _ in range(150 + 5 * phase):
                state, _ = person.step(state, Intent(wish), 1 / FPS)
            place = np.array([state.ground[0], 0.0, state.ground[1] + far])
            asked += 1
            for k in range(90):
                state, _ = person.step(state, Intent(wish, Leap(place)), 1 / FPS)
                if state.active == "jump":
                    waits.append(k / FPS)
                    break
                if state.ground[1] > place[2]:
                    break
            if state.active != "jump":
                refused += 1
                told[state.refused.split(";")[0].split(":")[0]] += 1
    print(f"ring refused while running: {refused} of {asked} {dict(told)}; waited {np.mean(waits or [0]):.2f} s")
    person = Supervisor({"locomotion": locomotion, "jump": Jump()})
    for pace in (0.0, 2.8):
        state, spent = person.start(), []
        for k in range(200):
            far = np.array([state.ground[0], 0.0, state.ground[1] + 9.0]) if k == 120 else far if k > 120 else None
            begin = time.perf_counter()
            state, _ = person.step(state, Intent(np.array([pace, 0.0, 0.0]), None if far is None else Leap(far)), 1 / FPS)
            if k > 121:
                spent.append(1e3 * (time.perf_counter() - begin))
        print(f"a refused leap held at {pace:.1f} m/s: {np.median(spent):.2f} ms a step, {np.percentile(spent, 95):.1f} ms in the worst twentieth")


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
