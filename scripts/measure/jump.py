"""Measure the jump: targets reached, refusals, take-off, balance, feet, flight, hand-overs, time.

    python scripts/measure/jump.py [--quick] [--targets 1000] [--seed 0]

Random bodies on random planets are asked for random jumps, from standing and out of a run, up on
platforms and down from them. Everything is measured from the poses that are played, by formulas of
our own in `jump_trials.py`. A target counts as feasible when the controller accepts it; what it
refuses is held to a bound by energy. Hand-overs are held to recorded walks and runs and, where
../shared/mocap lies beside the project, to recorded jumps.
"""

from __future__ import annotations

import argparse
import os
import time
from collections import Counter
from dataclasses import replace

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one thread: what a game has
import numpy as np

from compare_jump import recorded
from jump_trials import FINE, FPS, Motion, possible, result_of, starts, trial

from gambol.controllers.body import forward_kinematics, log, segment_centres, sole_corners
from gambol.controllers.contract import Intent, Leap
from gambol.controllers.jump import Jump, Refused
from gambol.controllers.jump.body import Physique, airtime_up, measures
from gambol.controllers.jump.muscles import strength
from gambol.controllers.locomotion import Locomotion, joint_acceleration
from gambol.controllers.supervisor import Supervisor
from gambol.game.scene import Box


AFTER = 0.3
"""So long after touch-down recorded jumps count for accelerations [s]."""


def report_targets(trials: int, rng: np.random.Generator, locomotion: Locomotion) -> None:
    """Random targets until so many were accepted."""
    rest, runners = starts(locomotion, rng, 40)
    results, refused, wrong, asked, bodies, spent, steps, failed = [], Counter(), Counter(), Counter(), [], [], [], []
    planned = Counter()
    while len(results) < trials:
        t = trial(rng, rest, runners)
        way = "running" if t.running else "standing"
        asked[way] += 1
        begin = time.perf_counter()
        measures(t.jump.physique)  # found once a body
        strength(t.jump.physique, gravity=-float(t.jump.gravity[1]))
        bodies.append(time.perf_counter() - begin)
        begin = time.perf_counter()
        try:
            entered = t.jump.enter(t.state, t.intent)
        except Refused as reason:
            words = "".join("#" if ch.isdigit() else ch for ch in str(reason).split(";")[0].split(" at (")[0])
            refused[(way, " ".join(words.split()[:7]))] += 1
            wrong[way] += possible(t)
            continue
        except Exception as error:
            refused[(way, f"CRASHED: {type(error).__name__}: {error}")] += 1
            continue
        spent.append(time.perf_counter() - begin)
        planned[way] += 1
        made = entered.memory.plan
        state = entered
        begin = time.perf_counter()
        for _ in range(20):
            state, _ = t.jump.step(state, Intent(around=t.around), 1 / FPS)
        steps.append((time.perf_counter() - begin) / 20)
        r = result_of(t, made)
        if not np.isfinite([v for v in r.values() if not isinstance(v, str)]).all():
            failed.append(t)
        results.append(r | {"running": t.running, "kind": t.kind, "place": t.leap.place, "duration": made.duration})
    print(f"Targets: {trials} accepted; " + "; ".join(f"{way}: {planned[way]} of {asked[way]} asked" for way in sorted(asked)))
    for (way, reason), count in refused.most_common(14):
        print(f"  refused {way:8s} {count:4d}  {reason} …")
    print("  refused although energy alone would allow it (muscles, crouch and style are stricter): "
          + ", ".join(f"{way} {wrong[way]}" for way in sorted(asked)))
    for through in (False, True):
        some = [r for r in results if r["through"] == through]
        inside = [r["miss cm"] <= 2.0 and max(r["turn deg"], r["tilt deg"]) <= 3.0 for r in some]
        told = "passed over their feet to walk on, whose heels may never come down" if through else "came to stand"
        print(f"  {len(some)} {told}: feet within 2 cm and 3° in {100.0 * np.mean(inside or [0]):.1f} %, within 2 cm and 3° of "
              f"heading in {100.0 * np.mean([r['miss cm'] <= 2.0 and r['turn deg'] <= 3.0 for r in some] or [0]):.1f} %")
    print(f"  not finite: {len(failed)}")
    wanted = {"miss cm": 2.0, "turn deg": 3.0, "tilt deg": 3.0, "speed at the end": 0.05, "take-off before %": 1.0, "take-off flown %": 1.0,
              "off the parabola mm": None, "energy drift": 1e-6, "momentum drift": 1e-6, "drift said cm": 0.2,
              "drift seen cm": 0.2, "pull %": 0.0, "friction": 1.0, "push off soles cm": 5.0, "push with limbs cm": None,
              "landing off soles cm": 5.0, "landing with limbs cm": None, "depth before cm": 0.3, "depth after cm": 0.3, "beyond limits deg": 0.0,
              "frames beyond %": None, "UpLeg rad/s": 17.0, "Leg rad/s": 17.0, "Foot rad/s": 17.0}
    print("  figure                      median       99 %      worst     within wanted   worst in")
    for name, limit in wanted.items():
        rows(name, results, limit)
    for way in ("standing", "running"):
        some = [r for r in results if r["running"] == (way == "running")]
        print(f"  {way}: the push comes from within 5 cm of the soles in {100.0 * np.mean([r['push off soles cm'] <= 5.0 for r in some] or [0]):.1f} %, "
              f"a quarter of it from {np.median([r['push with limbs cm'] for r in some] or [0]):.0f} cm and more beside them once limbs that turn count (median)")
    standing = [r for r in results if not r["running"]]
    for name, told in (("wind-up margin cm", "until it begins to fall ahead"), ("margin cm", "until take-off")):
        values = np.array([r[name] for r in standing])
        print(f"  standing: centre of mass inside the soles {told}: least {values.min():.2f} cm ({standing[int(values.argmin())]['kind']}), "
              f"median {np.median(values):.2f} cm, above 0 in {100.0 * (values > 0.0).mean():.1f} %")
    print("  joints beyond their limits: " + (", ".join(f"{name} {count}" for name, count in Counter(
        r["joint beyond"] for r in results if r["joint beyond"]).most_common()) or "none"))
    print(f"Time: planning p50 {1e3 * np.median(spent):.1f} ms, p99 {1e3 * np.percentile(spent, 99):.1f} ms; a body's heights and "
          f"strength, once, p50 {1e3 * np.median(bodies):.1f} ms; a step p50 {1e3 * np.median(steps):.3f} ms, p99 {1e3 * np.percentile(steps, 99):.3f} ms")


def rows(name: str, results: list[dict], limit: float | None) -> None:
    """One line of the table."""
    values = np.array([r[name] for r in results])
    worst = results[int(values.argmax())]
    inside = "" if limit is None else f"{100.0 * (values <= limit + 1e-9).mean():6.1f} % ≤ {limit:g}"
    print(f"  {name:22s} {np.median(values):11.3g} {np.percentile(values, 99):10.3g} {values.max():10.3g}   {inside:>17s}   "
          f"{worst['kind']} → {worst['place'][2]:.2f} m, {worst['place'][1]:+.2f} m")


def report_refusals(locomotion: Locomotion) -> None:
    """What nobody can jump, asked of the whole game's supervisor: refused before the wind-up, with a reason."""
    wall = Box((0.0, 1.5, 0.8), (3.0, 3.0, 0.2))
    roof = Box((0.0, 2.1, 1.2), (3.0, 1.0, 0.8))
    weak = Physique(strength=0.2)
    cases = (
        ("NaN", Physique(), [np.nan, 0.0, 1.0], None, ()), ("infinite", Physique(), [0.0, 0.0, np.inf], None, ()),
        ("two numbers", Physique(), [0.0, 1.0], None, ()), ("inside a wall", Physique(), [0.0, 1.0, 0.8], None, (wall,)),
        ("behind a wall", Physique(), [0.0, 0.0, 1.3], None, (wall,)), ("too far", Physique(), [0.0, 0.0, 6.0], None, ()),
        ("too high", Physique(), [0.0, 1.6, 0.8], None, ()), ("under a roof", Physique(), [0.0, 0.0, 1.2], None, (roof,)),
        ("weak", weak, [0.0, 0.0, 1.2], None, ()), ("airtime NaN", Physique(), [0.0, 0.0, 0.5], np.nan, ()),
        ("airtime 0", Physique(), [0.0, 0.0, 0.5], 0.0, ()), ("airtime < 0", Physique(), [0.0, 0.0, 0.5], -1.0, ()),
        ("airtime 3 s", Physique(), [0.0, 0.0, 0.5], 3.0, ()), ("airtime 0.05 s", Physique(), [0.0, 0.0, 1.5], 0.05, ()),
        ("far below", Physique(), [0.0, -30.0, 1.0], None, ()), ("behind", Physique(), [0.0, 0.0, -3.0], None, ()))
    held = 0
    print("Infeasible targets:")
    for name, physique, place, airtime, around in cases:
        supervisor = Supervisor({"locomotion": locomotion, "jump": Jump(physique)})
        state = supervisor.start()
        intent = Intent(np.zeros(3), Leap(np.array(place), airtime), around)
        try:
            for _ in range(60):  # one look at a path or a plan in each
                state, pose = supervisor.step(state, intent, 1 / FPS)
            duty = state.memory
            good = duty.active == "locomotion" and bool(duty.refused) and np.isfinite(pose.root).all()
            answer = duty.refused or f"accepted: {duty.active}"
        except Exception as error:  # a traceback for a user's mistake is what is looked for here
            good, answer = False, f"{type(error).__name__}: {error}"
        held += good
        print(f"  {'refused ' if good else 'NOT REFUSED'} {name:14s} {answer[:150]}")
    print(f"  {held} of {len(cases)} refused before the wind-up, with a reason")


def report_counter_movement(locomotion: Locomotion) -> None:
    """An adult's jump straight up: depth, push-off, peak force, speed; from the poses at 240 Hz."""
    print("Counter-movement jump of an adult: wanted depth 0.28 … 0.38 m, push-off 0.22 … 0.30 s, peak 2.0 … 2.6 BW, "
          "v 2.4 … 2.8 m/s")
    jump = Jump()
    state = replace(locomotion.step(locomotion.start(), Intent(), 1 / FPS)[0], elapsed=0.0)
    middle = sole_corners(jump.skeleton, *(a[None] for a in forward_kinematics(
        jump.skeleton, np.asarray(state.pose.root, float), np.asarray(state.pose.rotations, float))))[0].mean(0) * [1, 0, 1]
    for height in (0.30, 0.35, 0.40):
        made = jump.plan(state, Intent(leap=Leap(middle, airtime_up(jump.physique, height, jump.gravity))))
        seen = Motion.of(jump, made, np.arange(0.0, made.take_off, 1 / FINE))
        centre = seen.centre[:, 1]
        lowest = int(centre.argmin())
        force = 1.0 + np.diff(centre, 2) * FINE**2 / 9.81
        knee, hip, ankle = (np.degrees(np.linalg.norm(log(seen.local[lowest, jump.skeleton.index(n)]))) for n in
                            ("LeftLeg", "LeftUpLeg", "LeftFoot"))
        air = Motion.of(jump, made, np.arange(made.take_off, made.touch_down, 1 / FINE))
        v = (air.centre[8, 1] - air.centre[0, 1]) * FINE / 8 + 0.5 * 9.81 * 8 / FINE
        print(f"  {height:.2f} m: depth {centre[0] - centre[lowest]:.3f} m, push-off {made.take_off - seen.times[lowest]:.3f} s, "
              f"peak {uniform(force).max():.2f} BW, v {v:.2f} m/s, apex {air.centre[:, 1].max() - air.centre[0, 1]:.3f} m, wind-up to "
              f"take-off {made.take_off:.2f} s; lowest: knee {knee:.0f}°, hip {hip:.0f}°, ankle {ankle:.0f}°")


def report_arms(locomotion: Locomotion) -> None:
    """What swinging arms do to the centre of mass of an adult: its place about the shoulders, times the arms' share of the
    mass, over the push of a jump of 0.35 m and at take-off."""
    jump = Jump()
    anatomy, skeleton = jump.physique.anatomy, jump.skeleton
    state = replace(locomotion.step(locomotion.start(), Intent(), 1 / FPS)[0], elapsed=0.0)
    made = jump.plan(state, Intent(leap=Leap(None, airtime_up(jump.physique, 0.35, jump.gravity))))
    seen = Motion.of(jump, made, made.times[made.times <= made.take_off + 1e-9])
    places = segment_centres(anatomy, seen.positions, seen.orientations)
    height = np.zeros(len(places))
    for side in ("Left", "Right"):
        arm = [n for n, joint in enumerate(anatomy.joints) if skeleton.names[joint] in (side + "Arm", side + "ForeArm", side + "Hand")]
        shoulder = seen.positions[:, skeleton.index(side + "Arm"), 1]
        height += ((places[:, arm, 1] - shoulder[:, None]) * anatomy.masses[arm]).sum(1) / anatomy.masses.sum()
    speed = np.gradient(height, seen.times)
    push = seen.times >= made.push_off
    print(f"Arms, in a jump of 0.35 m: they raise the centre of mass by {100.0 * (height[-1] - height[push][0]):.1f} cm over the push, by "
          f"{speed[push].max():.2f} m/s at the fastest and {speed[-1]:.2f} m/s at take-off, of {made.path.velocity[1]:.2f}")


def uniform(values: np.ndarray, width: int = 5) -> np.ndarray:
    """Over 20 ms, as a force plate is read: second differences of interpolated poses are spiky."""
    return np.convolve(values, np.full(width, 1.0 / width), "valid")


def recorded_accelerations() -> np.ndarray | None:
    """The 99th percentile (J,) [m/s²] of every joint in recorded jumps, from the crouch to a good while after
    touch-down, as for the gaits; None where there are no recordings."""
    jump, found = Jump(), []
    for clip, some in recorded(jump):
        positions = clip.kinematics()[0]
        found += [joint_acceleration(positions[one.events[0]:one.events[3] + round(AFTER / clip.frame_time)], clip.frame_time) for one in some]
    return np.percentile(np.concatenate(found), 99, axis=0) if found else None


def report_hand_over(locomotion: Locomotion, count: int, rng: np.random.Generator) -> None:
    """Accelerations of joints around both hand-overs, over the 99th percentile of recorded gaits and of recorded jumps."""
    jumps = recorded_accelerations()
    print("Hand-over: largest acceleration of a joint within 0.1 s of it, over the recordings' 99th percentile (30 Hz): "
          "median, worst (joint); wanted ≤ 3")
    for name, low, high, far in (("standing", 0.0, 0.0, (0.2, 1.2)), ("walking", 0.6, 1.4, (0.8, 1.6)), ("running", 2.2, 3.2, (1.6, 3.0))):
        limits = {"recorded " + ("runs" if name == "running" else "walks"): locomotion.library.accelerations["run" if name == "running" else "walk"]}
        if jumps is not None:
            limits["recorded jumps"] = jumps
        met, waits = [], []
        for _ in range(count):
            speed, wait = rng.uniform(low, high), 120 + int(rng.integers(0, 60))
            over, delay = hand_over(locomotion, speed, rng.uniform(*far), wait)
            if over is not None:
                met.append(over)
                waits.append(delay / FPS)
        print(f"  {name:9s} {count} moments, refused {count - len(met)}, waited {np.mean(waits or [0]):.2f} s ({max(waits, default=0):.2f})")
        for reference, limit in limits.items():
            told = []
            for kind in ("the gait before", "walk → jump", "touch-down", "jump → walk"):
                ratios = np.array([over[kind] / limit for over in met if kind in over])
                if len(ratios):
                    worst = ratios[int(ratios.max(1).argmax())]
                    told.append(f"{kind} {np.median(ratios.max(1)):.2f}, {worst.max():.2f} ({locomotion.skeleton.names[int(worst.argmax())]})")
            print(f"    over {reference:14s} {'; '.join(told)}")


def hand_over(locomotion: Locomotion, speed: float, far: float, wait: int):
    """One jump out of a gait and back into it: by kind of moment the largest accelerations (J,) [m/s²], and how
    many steps it waited; None for the former if it never jumped."""
    supervisor = Supervisor({"locomotion": locomotion, "jump": Jump()})
    state, wish = supervisor.start(), np.array([speed, 0.0, 0.0])
    roots, local, active = [], [], []
    asked, place = False, None
    for k in range(wait + 400):
        if k >= wait and not asked:
            place = np.array([state.ground[0], 0.0, state.ground[1] + far])
        state, pose = supervisor.step(state, Intent(wish, None if asked or k < wait else Leap(place)), 1 / FPS)
        if state.memory.active == "jump" and not asked:
            asked, begun, made = True, k, state.memory.memory.plan
        roots.append(pose.root)
        local.append(pose.rotations)
        active.append(state.memory.active == "jump")
        if asked and not active[-1] and k > begun + made.touch_down * FPS + 60:
            break
        if not asked and k > wait + 120:
            return None, 0
    positions, _ = forward_kinematics(locomotion.skeleton, np.array(roots, float), np.array(local, float))
    ends = np.flatnonzero(np.diff(np.array(active, int)))
    moments = {"walk → jump": begun, "touch-down": begun + round(made.touch_down * FPS)}
    if len(ends) > 1:
        moments["jump → walk"] = int(ends[1]) + 1
    windows = {kind: positions[max(at - 6, 0):at + 7] for kind, at in moments.items()}
    windows["the gait before"] = positions[wait - 60:max(begun - 6, wait)]
    out = {}
    for kind, window in windows.items():
        out[kind] = np.max([joint_acceleration(window[phase:], 1 / FPS).max(0) for phase in (0, 1)], 0)
    return out, begun - wait


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--quick", action="store_true", help="100 targets, and fewer hand-overs")
    parser.add_argument("--targets", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    if given.targets < 1:
        parser.error("--targets must be 1 or more")
    rng, locomotion = np.random.default_rng(given.seed), Locomotion.load()
    report_counter_movement(locomotion)
    report_arms(locomotion)
    report_refusals(locomotion)
    report_targets(100 if given.quick else given.targets, rng, locomotion)
    report_hand_over(locomotion, 6 if given.quick else 30, rng)


if __name__ == "__main__":
    main()
