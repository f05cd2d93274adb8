"""How jumps crouch, leave and land: straight up, ahead, from a height, out of runs; and how a ring before a runner is answered."""

from __future__ import annotations

import time
from collections import Counter

import numpy as np

from jump_trials import FINE, FPS, Motion, Trial, ground, moved, starts

from gambol.controllers.body import centre_of_mass, forward_kinematics, log
from gambol.controllers.contract import CharacterState, Intent, Leap, Unable
from gambol.controllers.jump import Jump
from gambol.controllers.jump.body import airtime_up
from gambol.controllers.jump.motion import Plan
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.supervisor import Supervisor
from gambol.game.scene import Box


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


def landing_force(jump: Jump, made: Plan) -> np.ndarray:
    """The floor's force (N,) [body weights] from touch-down until it stands or runs on, by the plan's own poses: between them bodies go straight
    on, and differences over less than from one to the next would see corners."""
    chosen = (made.times > made.touch_down - 1e-9) & (made.times < min(made.duration, made.through) + 1e-9)
    placed = forward_kinematics(jump.skeleton, made.roots[chosen], made.local[chosen])
    height, step = centre_of_mass(jump.physique.anatomy, *placed)[:, 1], np.diff(made.times[chosen])[-1]
    return 1.0 + np.diff(height, 2) / step**2 / 9.81


def told(jump: Jump, made: Plan, name: str) -> None:
    """One jump in figures."""
    seen = Motion.of(jump, made, np.arange(0.0, made.duration, 1 / FINE))
    c = seen.centre[:, 1]
    force = landing_force(jump, made)
    at = lambda time: int(np.clip(round(time * FINE), 0, len(c) - 1))  # noqa: E731
    down, off = at(made.touch_down), at(made.take_off)
    low = down + int(c[down:].argmin())
    neck = seen.positions[:, jump.skeleton.index("Neck")] - seen.positions[:, 0]
    trunk = np.degrees(np.arctan2(np.hypot(neck[:, 0], neck[:, 2]), neck[:, 1]))
    knee = np.degrees(np.linalg.norm(log(seen.local[:, jump.skeleton.index("LeftLeg")]), axis=-1))
    print(f"{name}: crouch {c[0] - c[:off].min():.2f} m, knee {knee[:off].max():.0f}°, at take-off {knee[off]:.0f}°, at touch-down {knee[down]:.0f}°, lowest {knee[low]:.0f}°; trunk "
          f"lowest before {trunk[int(c[:off].argmin())]:.0f}°, take-off {trunk[off]:.0f}°, touch-down {trunk[down]:.0f}°, landed lowest {trunk[low]:.0f}°, most {trunk[down:].max():.0f}°, 0.25 s later "
          f"{trunk[min(low + FINE // 4, len(c) - 1)]:.0f}°; landing sinks {c[0] - c[low]:.2f} m, force {force.max():.1f} BW, at first {force[0]:.1f}; "
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
            up = landing_force(jump, plan)
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
