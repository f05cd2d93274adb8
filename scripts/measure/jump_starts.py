"""Measure how a jump begins and goes on in play: from letting go to the air, and over the ring in a walk or a run.

    python scripts/measure/jump_starts.py [--targets 100] [--phases 8] [--leaps 100] [--seed 0]

Somebody stands, aims at random targets for a while and lets go. Walkers and runners of many speeds aim as one plays, let go at many moments of
their strides, leap over the ring and go on. Others leap from walks and runs to random places ahead: how much faster along the floor they leave than they came. Some leap from a stand, a walk
or a run to random places all over what is before them: how deep soles come into the floor, and how far hips are off their way as walking takes over. Or somebody lets go
in the midst of a turn, a side step or an arc, and leaps: how near his legs come to each other. Everything but how fast they leave is told from the poses
that are played.
"""

from __future__ import annotations

import argparse
import os
from dataclasses import replace

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one thread: what a game has
import numpy as np

from _limbs import legs_apart
from jump_trials import FPS

from gambol.controllers.body import forward_kinematics, log, sole_corners
from gambol.controllers.contract import CharacterState, Intent, Leap, Unable
from gambol.controllers.jump import Jumping
from gambol.controllers.jump.motion import Plan
from gambol.controllers.locomotion import Locomotion, Settings
from gambol.controllers.person import person
from gambol.controllers.supervisor import Supervisor
from gambol.game.input import Aim, Wish
from gambol.game.session import Timeline, begin
from gambol.game.world import Character, World

AIMED = 1.2
"""So long one aims before one lets go [s]."""
PATIENCE = 0.9
"""So long a jump that was asked waits, in play [s]."""
BEFORE = 4
"""So many steps before a leap are looked at, too."""
SPEEDS = 1.0, 1.3, 1.6, 2.2, 2.6, 3.0, 3.4
HELD, ASIDE = (0.15, 0.3, 0.5, 0.8), (30, 60, 90, 135, 180, -45, -90, -150)
"""So long hands hold the button [s], and the stick so far aside of the way somebody faces [°]."""
WALKS, LANDS, RUNS_ON = 1.8, 12, 24
"""Who is slower than the first [m/s] walks, and takes two steps in 1.1 s, who runs in 0.75; legs give for the second, and he is on his
way again after the third, in steps after touch-down."""
MOVES = {"turns on the spot": [(0.0, turn, 0.0) for turn in (1.0, 2.0, 3.0, -1.0, -2.0, -3.0)],
         "side and diagonal steps, backward": [(0.0, 0.0, 0.6), (0.0, 0.0, -0.6), (0.6, 0.0, 0.5), (0.6, 0.0, -0.5), (-0.5, 0.0, 0.4), (-0.5, 0.0, -0.4), (-0.7, 0.0, 0.0)],
         "arcs": [(0.5, 2.0, 0.0), (0.5, -2.0, 0.0)]}
"""What somebody does until he leaps: forward, turning, left [m/s, rad/s]."""
LASTED = np.arange(0.3, 2.51, 0.2)
"""So long he does it [s]."""
NEAR = 0.10
"""Axes of legs that are nearer than this are in each other's flesh [m]."""


def led(someone: Supervisor, state: CharacterState, intent: Intent, seconds: float) -> CharacterState:
    """Somebody who is told the same for so long [s]."""
    for _ in range(round(seconds * FPS)):
        state, _ = someone.step(state, intent, 1 / FPS)
    return state


def pulled(values: np.ndarray) -> np.ndarray:
    """The accelerations (N - 4, ...) of values (N, ...) of steps, over two of them."""
    return (values[4:] - 2.0 * values[2:-2] + values[:-4]) * (FPS / 2) ** 2


def report_release(someone: Supervisor, targets: int, rng: np.random.Generator) -> None:
    """From letting go to the air, for who aimed before and who did not."""
    rest, jump = led(someone, someone.start(), Intent(), 0.5), someone.parts["jump"]
    took: dict[str, list[float]] = {"after aiming": [], "without": []}
    missed, refused, fars = [], 0, []
    for _ in range(targets):
        far, way, up = rng.uniform(0.0, 1.3), rng.uniform(-0.35, 0.35), rng.random() < 0.2
        place = np.array([rest.ground[0] + far * np.sin(way), 0.0, rest.ground[1] + far * np.cos(way)])
        leap = Leap(None, float(rng.uniform(0.42, 0.6))) if up else Leap(place)
        for how, state in (("after aiming", led(someone, rest, Intent(aim=leap), AIMED)), ("without", rest)):
            after, _ = someone.step(state, Intent(leap=leap), 1 / FPS)
            if not isinstance(after.memory.memory, Jumping):
                refused += 1
                continue
            made = after.memory.memory.plan
            took[how].append(made.take_off)
            if how == "after aiming":
                fars.append(0.0 if up else far)
                if not up:
                    middle = jump.middle(replace(jump.start_of(someone.active(led(someone, after, Intent(), made.duration))[1]), ready=False), 0.0)
                    missed.append(float(np.linalg.norm((middle - place)[[0, 2]])))
    for how, values in took.items():
        print(f"Standing, {how}: from letting go to the air {np.median(values):.2f} s (median), {np.percentile(values, 95):.2f} (95 %), "
              f"{max(values):.2f} (worst), of {len(values)}; within 0.25 s {100.0 * np.mean(np.array(values) <= 0.25):.0f} %")
    for low, high in ((0.0, 0.6), (0.6, 1.0), (1.0, 1.3)):
        some = [t for t, far in zip(took["after aiming"], fars) if low <= far < high]
        print(f"  {low:g} … {high:g} m: {np.median(some):.2f} s (median), {max(some):.2f} (worst)")
    print(f"  feet beside the target: {100.0 * np.median(missed):.1f} cm (median), {100.0 * max(missed):.1f} (worst); refused {refused}")


def report_taps(someone: Supervisor) -> None:
    """Somebody stands, holds the button for a moment with the stick aside, and lets go, as hands do."""
    print("Standing, the stick aside by 30 … 180°: held s; from letting go to the air s, median, worst; refused")
    for held in HELD:
        took, refused = [], 0
        for way in ASIDE:
            line, made = Timeline(begin(World((Character("A", someone, someone.start()),)), 1)), None
            for n in range(round((1.0 + held + 4.0) * FPS)):
                pressed = 1.0 <= n / FPS < 1.0 + held
                stick = (-np.sin(np.radians(way)), np.cos(np.radians(way))) if pressed else (0.0, 0.0)
                line.advance((Wish(move=stick, jump=pressed).rounded(),))
                memory = line.now.after.characters[0].state.memory.memory
                if isinstance(memory, Jumping):
                    made = memory
                    break
            if made is None:
                refused += 1
                continue
            took.append((n + 1) / FPS + made.plan.take_off - made.time - 1.0 - held)
        print(f"  {held:g}: {np.median(took):.2f}, {max(took):.2f}; {refused}")


def report_strides(someone: Supervisor, phases: int) -> None:
    """Walks and runs over the ring and on, let go at many moments of the stride."""
    print("Walking or running over the ring: of how many, refused; lands on one foot; least of hips over 0.1 s from before touch-down to 0.6 s "
          "later, over the speed before: median, worst; waited s (median, longest); in the air s, rises cm (medians); knee bent as it lands ° (median, worst); "
          "hands pulled m/s², the free knee °/s² until 0.4 s later, over 1/30 s (medians; recorded 56 … 100, 6500 … 13000); hands apart cm in the air, mean and most, "
          "and the one behind that is beside the leg that leads (medians; recorded leaps 88 … 103, 112 … 137, −5 … 44, strides 35 … 52, 37 … 55, 11 … 24)")
    kept_all, refused_all, all_, legs = [], 0, 0, [someone.skeleton.index(side + "Leg") for side in ("Left", "Right")]
    hands = [someone.skeleton.index(side + "Hand") for side in ("Left", "Right")]
    for speed in SPEEDS:
        wish = np.array([speed, 0.0, 0.0])
        base = led(someone, someone.start(), Intent(wish), 3.5)
        single, kept, waits, refused, air, knees, pulls, arms = 0, [], [], 0, [], [], [], []
        for k in range(phases):
            state = led(someone, base, Intent(wish), (0.75 if speed > WALKS else 1.1) * k / phases)
            leap, made, poses = Aim().step(Wish(jump=True, move=(0.0, 1.0)), 0.0, state, False, 1 / FPS).target(state, (), 9.81), None, []
            for n in range(150):
                state, pose = someone.step(state, Intent(wish, leap if made is None and n < PATIENCE * FPS else None), 1 / FPS)
                poses.append(pose)
                if made is None and isinstance(state.memory.memory, Jumping):
                    made, begun = state.memory.memory.plan, n
            if made is None:
                refused += 1
                continue
            roots, turned = np.stack([pose.root for pose in poses]), np.stack([pose.rotations for pose in poses])
            pace = (roots[6:, 2] - roots[:-6, 2]) * FPS / 6
            bent = np.degrees(np.linalg.norm(log(turned[:, legs]), axis=-1))
            down = begun + int(made.touch_down * FPS)
            around, lands = slice(down - 4, down + RUNS_ON), slice(None) if made.path.lands is None else made.path.lands
            shown = forward_kinematics(someone.skeleton, roots, turned)[0][:, hands]
            pulls.append((float(np.linalg.norm(pulled(shown[around]), axis=-1).max()),
                          float(np.abs(pulled(bent[around, 0 if made.path.lands is None else 1 - made.path.lands])).max())))
            apart = shown[begun + int(made.take_off * FPS) + 1:down, 1] - shown[begun + int(made.take_off * FPS) + 1:down, 0]
            wide = np.linalg.norm(apart, axis=-1)
            arms.append((wide.mean(), wide.max(), float(apart[:, 2].mean()) * (1.0 if made.path.lands == 0 else -1.0)))
            single += made.path.lands is not None
            waits.append(begun / FPS)
            air.append((made.path.airtime, 50.0 * made.path.velocity[1]**2 / 9.81))
            knees.append(float(bent[down:down + LANDS, lands].max()))
            kept.append(float(pace[down - 6:down + 36].min()) / speed)
        kept_all, refused_all, all_ = kept_all + kept, refused_all + refused, all_ + phases
        print(f"  {speed:g} m/s: {phases}, {refused}; {single}; {100.0 * np.median(kept):.0f} %, {100.0 * min(kept):.0f} %; {np.median(waits):.2f}, {max(waits):.2f}; "
              f"{np.median(air, 0)[0]:.2f}, {np.median(air, 0)[1]:.0f}; {np.median(knees):.0f}, {max(knees):.0f}; "
              f"{np.median(pulls, 0)[0]:.0f}, {np.median(pulls, 0)[1]:.0f}; " + ", ".join(f"{100.0 * part:.0f}" for part in np.median(arms, 0)))
    print(f"  all: refused {refused_all} of {all_}; at least 80 % of the speed kept in {100.0 * np.mean(np.array(kept_all) >= 0.8):.0f} %")


def report_gains(someone: Supervisor, leaps: int, rng: np.random.Generator) -> None:
    """How much faster along the floor leaps off one foot leave than somebody came, who walks or runs."""
    jump, gains, refused = someone.parts["jump"], [], 0
    for _ in range(leaps):
        wish = Intent(np.array([rng.uniform(1.2, 3.6), 0.0, 0.0]))
        far, up = rng.uniform(0.4, 1.0) * wish.velocity[0], rng.choice([0.0, 0.0, 0.0, 0.2, 0.4, -0.3])
        state = led(someone, someone.start(), wish, rng.uniform(2.5, 3.2))
        for _ in range(60):
            state, _ = someone.step(state, wish, 1 / FPS)
            own = someone.active(state)[1]
            start = jump.start_of(own)
            pace = start.velocity * [1.0, 0.0, 1.0]
            if start.single is None:
                continue
            leap = Leap(start.centre * [1.0, 0.0, 1.0] + far * pace / np.linalg.norm(pace) + [0.0, up, 0.0])
            if jump.precondition(own, Intent(leap=leap)) < 1.0:
                continue
            try:
                gains.append(float(np.linalg.norm(jump.plan(own, Intent(leap=leap)).path.velocity[[0, 2]]) - np.linalg.norm(pace)))
            except Unable:
                refused += 1
            break
    print(f"Off one foot to random places ahead, {leaps}: {len(gains)} leap, {refused} refused; faster along the floor as they leave than they came by {np.median(gains):.2f} m/s "
          f"(median), {max(gains):.2f} (most); by more than 0.1 m/s {sum(g > 0.1 for g in gains)}, 0.3 m/s {sum(g > 0.3 for g in gains)}")


def random_leap(someone: Supervisor, rng: np.random.Generator) -> tuple[str, Plan, list[CharacterState]] | None:
    """How somebody came, the plan of his leap to a random place, his states from `BEFORE` steps ahead of it until a second after it; None where he can't leap."""
    kind = ("stand", "walk", "run")[rng.choice(3, p=(0.2, 0.4, 0.4))]
    pace = {"stand": 0.0, "walk": rng.uniform(0.6, 2.0), "run": rng.uniform(2.0, 3.6)}[kind]
    state = led(someone, someone.start(), Intent(np.array([pace, 0.0, 0.0])), rng.uniform(2.0, 3.0))
    aside = rng.uniform(-1.2, 1.2) if rng.random() < 0.6 else rng.normal(0.0, 0.15)
    far, up = rng.uniform(0.4, 0.9) * pace if kind == "run" else rng.uniform(0.3, 1.6), rng.choice([0.0, 0.0, 0.0, rng.uniform(-0.5, 0.4)])
    on = np.array([pace if rng.random() < 0.6 else 0.0, 0.0, 0.0])
    states = [state]
    for _ in range(75):
        way = state.ground[2] + aside
        leap = Leap(np.array([state.ground[0] + far * np.sin(way), up, state.ground[1] + far * np.cos(way)]))
        state, _ = someone.step(state, Intent(np.array([pace, 0.0, 0.0]), leap), 1 / FPS)
        states.append(state)
        if len(states) > BEFORE and isinstance(state.memory.memory, Jumping):
            made, states = state.memory.memory.plan, states[-BEFORE - 1:]
            while len(states) < (made.duration + 1.0) * FPS + BEFORE:
                states.append(someone.step(states[-1], Intent(on), 1 / FPS)[0])
            return kind, made, states
    return None


def report_feet(someone: Supervisor, leaps: int, rng: np.random.Generator) -> None:
    """How deep soles are in the floor before take-off, from touch-down on and 0.6 s on as the walk has taken over; how far hips are off the mean of their way
    before and after as it does; and how hard hands are pulled until the take-off off one foot."""
    hands, pulls = [someone.skeleton.index(side + "Hand") for side in ("Left", "Right")], []
    rows: dict[str, list[tuple[float, ...]]] = {"stand": [], "walk": [], "run": []}
    for number in range(leaps):
        played = random_leap(someone, np.random.default_rng([int(rng.integers(2**31)), number]))
        if played is None:
            continue
        kind, made, states = played
        seen = forward_kinematics(someone.skeleton, np.stack([s.pose.root for s in states]), np.stack([s.pose.rotations for s in states]))
        low = sole_corners(someone.skeleton, *seen)[..., 1].min(-1)
        taken = next(n for n, s in enumerate(states) if n > BEFORE and s.active != "jump")
        off, down = BEFORE + int(made.take_off * FPS), BEFORE + int(np.ceil(made.touch_down * FPS))
        there = float(states[taken].floor)
        way = np.diff(seen[0][taken - 2:taken + 2, 0], axis=0)
        rows[kind].append((*(100.0 * max(level - part.min(initial=level), 0.0) for level, part in (
            (0.0, low[BEFORE:off]), (there, low[down:taken]), (there, low[taken:taken + 36]))), 1e3 * float(np.linalg.norm(way[1] - 0.5 * (way[0] + way[2])))))
        if made.path.single:
            place = seen[0][:off + 3, hands]
            pulls.append(float(np.linalg.norm(pulled(place), axis=-1).max()))
    print(f"Random leaps, {leaps}: deepest of soles in the floor before take-off, from touch-down, 0.6 s on as the walk takes over: 95 %, worst cm; hips off their way as it does: median, worst mm")
    for kind, some in rows.items():
        before, landing, after, hips = np.array(some).T
        told = "; ".join(f"{np.percentile(part, 95):.1f}, {part.max():.1f}" for part in (before, landing, after))
        print(f"  {kind:5s} {len(some)}: {told}; {np.median(hips):.1f}, {hips.max():.1f}")
    print(f"  hands until the take-off of {len(pulls)} off one foot, over 1/30 s: median {np.median(pulls):.0f}, 90 % {np.percentile(pulls, 90):.0f}, worst {max(pulls):.0f} m/s²")


def leap_amid(someone: Supervisor, state: CharacterState, leap: Leap) -> tuple[float, float, float] | None:
    """How near the legs of somebody come who lets go of all keys and leaps [m], how long he waits, and how long until he is in the air [s]; None where he can't leap."""
    states: list[CharacterState] = []
    for n in range(2 * FPS):
        state, _ = someone.step(state, Intent(leap=leap), 1 / FPS)
        if isinstance(state.memory.memory, Jumping):
            made, states = state.memory.memory.plan, [state]
            while states[-1].active == "jump" and states[-1].memory.memory.time < made.duration:
                states.append(someone.step(states[-1], Intent(), 1 / FPS)[0])
            near = legs_apart(someone.skeleton, np.stack([s.pose.root for s in states]), np.stack([s.pose.rotations for s in states]))
            return float(near.min()), n / FPS, n / FPS + made.take_off
    return None


def report_turns(someone: Supervisor) -> None:
    """How near legs come to each other in leaps out of the midst of a turn, of side steps and of arcs, and how long feet are set before."""
    print(f"Leaps of 0.9 m and straight up out of the midst of a move of {LASTED[0]:g} … {LASTED[-1]:.1f} s: of how many, refused; axes of legs nearer than {100.0 * NEAR:g} cm; nearest; "
          "wait at all; waited s, of those median, worst; to the air median, worst")
    for kind, velocities in MOVES.items():
        found = []
        for velocity in velocities:
            for lasted in LASTED:
                state = led(someone, someone.start(), Intent(np.array(velocity)), lasted)
                x, z, heading = state.ground
                found += [leap_amid(someone, state, leap) for leap in (Leap(None), Leap(np.array([x + 0.9 * np.sin(heading), 0.0, z + 0.9 * np.cos(heading)])))]
        near, waits, takes = np.array([one for one in found if one is not None]).T
        waited = waits[waits > 0.0]
        print(f"  {kind}: {len(found)}, {len(found) - len(near)}; {np.sum(near < NEAR)}; {100.0 * near.min():.1f} cm; {100.0 * np.mean(waits > 0.0):.0f} %; "
              f"{np.median(waited):.2f}, {waited.max():.2f}; {np.median(takes):.2f}, {takes.max():.2f}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--targets", type=int, default=100)
    parser.add_argument("--phases", type=int, default=14)
    parser.add_argument("--leaps", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    if given.targets < 10 or given.phases < 1 or given.leaps < 10:
        parser.error("--targets must be 10 or more, --phases 1 or more, --leaps 10 or more")
    someone = person(Locomotion.load(settings=Settings(idle=0.0)))
    report_turns(someone)
    report_release(someone, given.targets, np.random.default_rng(given.seed))
    report_taps(someone)
    report_strides(someone, given.phases)
    report_gains(someone, given.leaps, np.random.default_rng(given.seed))
    report_feet(someone, 4 * given.leaps, np.random.default_rng(given.seed))


if __name__ == "__main__":
    main()
