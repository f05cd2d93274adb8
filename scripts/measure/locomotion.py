"""Measure the walking controller: foot drift, skate, floor, pelvis, feet apart, velocity, response, acceleration.

    python scripts/measure/locomotion.py [--library FILE]

A scripted run (rest, accelerate, curves, side, diagonal, stop, turn, back, run) is played with the
raw blend and with footing. Contact is judged by an independent detector on the final pose: a heel
or ball stands from one frame to the next while it is within 1 cm of its height in flat stance and
slower than 0.5 (heel) or 0.35 m/s (ball), 1.4 and 1.0 in runs. It knows nothing of the lock's labels,
but these speeds are those by which the recordings were labelled. Drift is of stances of 4 frames or
more: shorter ones are a point grazing its limits.
"""

from __future__ import annotations

import argparse

import numpy as np

from gambol.controllers.body import (contact_height, contact_points, detect_contacts, end_positions, feet_apart, foot_drift,
                                     forward_kinematics, screw)
from gambol.controllers.contract import Intent
from gambol.controllers.locomotion import DEFAULT_LIBRARY, Library, Locomotion, Settings, joint_acceleration

FPS = 60
SCRIPT = (  # name, seconds, (v_f, ω, v_l)
    ("rest", 1.0, (0.0, 0.0, 0.0)), ("accelerate", 3.0, (1.0, 0.0, 0.0)), ("curve left", 2.5, (1.0, 0.6, 0.0)),
    ("curve right", 2.5, (0.9, -0.7, 0.0)), ("side", 2.5, (0.0, 0.0, 0.45)), ("diagonal", 2.5, (0.5, 0.0, -0.4)),
    ("stop", 2.0, (0.0, 0.0, 0.0)), ("turn", 2.5, (0.0, 1.5, 0.0)), ("back", 2.5, (-0.6, 0.0, 0.0)),
    ("stop again", 2.0, (0.0, 0.0, 0.0)), ("run", 5.0, (2.8, 0.0, 0.0)), ("stop running", 2.0, (0.0, 0.0, 0.0)))
RUNNING = ("run", "stop running")
SHORTEST = 4  # frames


def play(locomotion: Locomotion, script=SCRIPT):
    """Every frame of a script: segment (T,), roots, rotations, positions, orientations, states."""
    state, segment, roots, local, states = locomotion.start(), [], [], [], []
    for number, (_, seconds, wish) in enumerate(script):
        for _ in range(round(seconds * FPS)):
            state, pose = locomotion.step(state, Intent(np.array(wish)), 1 / FPS)
            segment.append(number)
            roots.append(pose.root)
            local.append(pose.rotations)
            states.append(state)
    positions, orientations = forward_kinematics(locomotion.skeleton, np.array(roots, float), np.array(local, float))
    return np.array(segment), positions, orientations, states


def feet(locomotion: Locomotion, segment, positions, orientations, script=SCRIPT):
    """Contact points (T, 4, 3), which stand (T, 4) and their horizontal speeds (T, 4)."""
    points = contact_points(locomotion.skeleton, positions, orientations)
    step = np.diff(points, axis=0, append=points[-1:]) * FPS  # from each frame to the next
    gate = contact_height(locomotion.skeleton) + 0.01
    walking, running = (detect_contacts(points[..., 1], np.linalg.norm(step, axis=-1), height_gate=gate,
                                        release=1.0, running=r) for r in (False, True))
    names = np.array([name in RUNNING for name, _, _ in script])[segment]
    return points, np.where(names[:, None], running, walking), np.linalg.norm(step[..., [0, 2]], axis=-1)


def report_feet(library: Library) -> None:
    """Drift per stance, skate, penetration, pelvis and how near the feet come to each other, by segment."""
    results = {}
    for footing in (False, True):
        locomotion = Locomotion(library, Settings(footing=footing))
        segment, positions, orientations, states = play(locomotion)
        points, standing, speeds = feet(locomotion, segment, positions, orientations)
        floor, skeleton = contact_height(locomotion.skeleton), locomotion.skeleton
        toes = end_positions(skeleton, positions, orientations)[
            :, [skeleton.end_index["LeftToe"], skeleton.end_index["RightToe"]]]
        lowest = np.minimum(points[..., 1].min(-1), toes[..., 1].min(-1))
        apart = feet_apart(skeleton, positions, orientations)
        stances = foot_drift(points, standing)
        long = stances.stop - stances.start >= SHORTEST
        rows = []
        for number in (*range(len(SCRIPT)), None):
            here = segment == number if number is not None else np.ones(len(segment), bool)
            drift = stances.drift[long & here[stances.start]] if len(stances) else np.zeros(0)
            fast = speeds[here][standing[here]] > 0.2
            drop = max(float(s.memory["pelvis"]) for s, h in zip(states, here) if h)
            rows.append((drift.mean() * 100 if len(drift) else 0.0, drift.max() * 100 if len(drift) else 0.0,
                         fast.mean() * 100 if len(fast) else 0.0,
                         max(0.0, floor - lowest[here].min()) * 100, drop * 100, apart[here].min() * 100))
        results[footing] = rows
    print("Feet: raw blend / final.  drift per stance mean (max) cm · contact frames over 0.2 m/s % · heel, ball or toe's "
          "end\n      below floor cm · pelvis drop cm · least distance of the feet's centre lines cm")
    for i, name in enumerate([s[0] for s in SCRIPT] + ["whole run"]):
        raw, final = results[False][i], results[True][i]
        print(f"  {name:13s} {raw[0]:5.2f} ({raw[1]:5.2f}) / {final[0]:5.2f} ({final[1]:5.2f})   {raw[2]:5.1f} / {final[2]:4.1f}"
              f"   {raw[3]:5.2f} / {final[3]:4.2f}   {final[4]:4.2f}   {raw[5]:4.1f} / {final[5]:4.1f}")


def report_acceleration(library: Library) -> None:
    """Peak joint accelerations by segment over the 99th percentile in the motion capture itself."""
    if not library.accelerations:
        print("Acceleration: this library does not carry its recordings' own")
        return
    locomotion = Locomotion(library)
    segment, positions, _, _ = play(locomotion)
    print("Acceleration: largest of any joint over the recordings' own 99th percentile, at 30 Hz (worst joint)")
    for number, (name, _, _) in enumerate(SCRIPT):
        natural = library.accelerations.get("run" if name in RUNNING else "walk", library.accelerations["walk"])
        here = np.flatnonzero(segment == number)
        here = np.arange(max(here[0] - 4, 0), here[-1] + 1)
        worst = np.max([np.max(joint_acceleration(positions[here[phase:]], 1 / FPS), 0) for phase in (0, 1)], 0) / natural
        print(f"  {name:13s} {worst.max():.2f} ({locomotion.skeleton.names[int(worst.argmax())]}), median joint {np.median(worst):.2f}")


def report_velocity(library: Library) -> None:
    """Steady velocity error over many wishes, without and with correction of the query."""
    rng = np.random.default_rng(0)
    print("Steady velocity, 400 random wishes inside the walking space: error over 3 cycles (v_f, ω, v_l): mean; RMS; 95 %")
    for correct in (0, 1, 2, 3, 5):
        locomotion = Locomotion(library, Settings(correct=correct))
        box = np.array([1.3, 1.6, 0.5])
        wish = rng.uniform(-1, 1, (4000, 3)) * box
        wish = wish[locomotion.walk.inside(wish / 0.95)][:400]
        wish = wish[np.linalg.norm(wish / box, axis=-1) > 0.15]
        error = steady(locomotion, wish) - wish
        rows = np.mean(np.abs(error), 0), np.sqrt(np.mean(error**2, 0)), np.percentile(np.abs(error), 95, axis=0)
        print(f"  {correct} corrections:  " + ";  ".join("{:.4f} m/s {:.4f} rad/s {:.4f} m/s".format(*row) for row in rows))


def steady(locomotion: Locomotion, wish: np.ndarray) -> np.ndarray:
    """Velocities (N, 3) achieved over whole cycles, after 4 s, by characters with constant wishes."""
    state = locomotion.start(np.zeros((len(wish), 3)))
    for _ in range(4 * FPS):
        state, _ = locomotion.step(state, Intent(wish), 1 / FPS)
    cycles = np.zeros(len(wish), int)
    first = np.zeros((len(wish), 3))
    last, turned, time, result = first.copy(), np.zeros(len(wish)), np.zeros(len(wish)), np.zeros((len(wish), 3))
    phase = state.memory["phase"].copy()
    for _ in range(10 * FPS):
        before = state.ground
        state, _ = locomotion.step(state, Intent(wish), 1 / FPS)
        wrapped = state.memory["phase"] < phase
        phase = state.memory["phase"].copy()
        begun = cycles > 0
        time[begun] += 1 / FPS
        turned[begun] += ((state.ground[:, 2] - before[:, 2] + np.pi) % (2 * np.pi) - np.pi)[begun]
        start = wrapped & (cycles == 0)
        first[start] = state.ground[start]
        finish = wrapped & (cycles == 3)
        last[finish] = np.concatenate([state.ground[finish, :2], (first[finish, 2] + turned[finish])[:, None]], -1)
        result[finish] = screw(first[finish], last[finish], time[finish, None])
        cycles += wrapped
    return result


CHANGES = (  # name, (v_f, ω, v_l) before and after
    ("rest to 1.0 m/s", (0, 0, 0), (1.0, 0, 0)), ("0.6 to 1.2 m/s", (0.6, 0, 0), (1.2, 0, 0)),
    ("1.2 m/s to rest", (1.2, 0, 0), (0, 0, 0)), ("straight to 1 rad/s", (0.8, 0, 0), (0.8, 1.0, 0)),
    ("forward to side", (0.8, 0, 0), (0, 0, 0.5)), ("forward to back", (0.8, 0, 0), (-0.6, 0, 0)),
    ("1.2 to 2.8 m/s", (1.2, 0, 0), (2.8, 0, 0)))


def report_response(library: Library) -> None:
    """How long from a new wish to 90 % of the change, in the blend's own velocity and in the body's."""
    locomotion = Locomotion(library)
    print("Response: seconds from a new wish to 90 % of the change, mean (slowest) over 13 moments of the gait: the blend's\n"
          "      nominal velocity; the body's, from where it is a quarter of a second before and after (which adds up to 0.2 s)")
    for name, before, after in CHANGES:
        goal, start = np.array(after, float), np.array(before, float)
        blend, body = [], []
        for delay in np.linspace(0, 1.2, 13):
            state, grounds, blends = locomotion.start(), [], []
            first = round((3 + delay) * FPS)
            for frame in range(first + 4 * FPS):
                state, _ = locomotion.step(state, Intent(start if frame < first else goal), 1 / FPS)
                grounds.append(state.ground)
                blends.append(state.memory["weights"][:len(library.velocities)] @ library.velocities)
            grounds = np.unwrap(np.array(grounds), axis=0, period=2 * np.pi) * [0, 0, 1] + np.array(grounds) * [1, 1, 0]
            half = FPS // 4
            achieved = screw(grounds[:-2 * half], grounds[2 * half:], 2 * half / FPS)  # at frame half, half + 1, …
            blend.append(_reached(np.array(blends)[first:first + 3 * FPS], start, goal))
            body.append(_reached(achieved[first - half:first - half + 3 * FPS], start, goal))
        print(f"  {name:20s} {_times(blend)}   {_times(body)}")


def _reached(velocity, start, goal) -> float:
    """Seconds until velocities (T, 3) have made 90 % of the change; infinite if they never do."""
    near = np.linalg.norm(velocity - goal, axis=-1) < 0.1 * np.linalg.norm(goal - start)
    return (np.argmax(near) + 1) / FPS if near.any() else np.inf


def _times(seconds) -> str:
    missed = int(np.isinf(seconds).sum())
    return f"not reached in {missed} of {len(seconds)}" if missed else f"{np.mean(seconds):.2f} s ({np.max(seconds):.2f})"


def report_space(library: Library) -> None:
    """Shape of the control spaces: coverage, slivers, steepest weights."""
    locomotion = Locomotion(library)
    for family, space in (("walk", locomotion.walk), ("run", locomotion.run)):
        if space is None:
            continue
        quality = space.quality()
        print(f"Control space, {family}: {len(space.points)} primitives, {len(space.simplices)} simplices, quality "
              f"5 % {np.percentile(quality, 5):.3f}, median {np.median(quality):.3f}; steepest weight {space.lipschitz():.1f} per unit")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--library", default=DEFAULT_LIBRARY)
    library = Library.load(parser.parse_args().library)
    report_space(library)
    report_feet(library)
    report_acceleration(library)
    report_velocity(library)
    report_response(library)


if __name__ == "__main__":
    main()
