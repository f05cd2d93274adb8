"""Measure the walking controller in steady gaits: foot drift, skate, floor, pelvis, feet apart, velocity. For changes of
speed, way and gait there is `changes.py`.

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
                                     forward_kinematics)
from gambol.controllers.contract import Intent
from gambol.controllers.locomotion import DEFAULT_LIBRARY, LABELS_AT, Library, Locomotion, Settings

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


def report_velocity(library: Library) -> None:
    """What the correction of the query is good for: how far the blend's own feet slide under a root that goes as it is
    commanded, over many steady wishes."""
    rng = np.random.default_rng(0)
    box = np.array([1.3, 1.6, 0.5])
    wish = rng.uniform(-1, 1, (4000, 3)) * box
    print("Steady walking, 100 random wishes inside the walking space: how far the blend's own feet slide in a stance")
    for correct in (0, 1, 2, 3, 5):
        locomotion = Locomotion(library, Settings(correct=correct, footing=False))
        some = wish[locomotion.walk.inside(wish / 0.95) & (np.linalg.norm(wish / box, axis=-1) > 0.3)][:100]
        state, states = locomotion.start(np.zeros((len(some), 3))), []
        for frame in range(8 * FPS):
            state, _ = locomotion.step(state, Intent(some), 1 / FPS)
            states += [state] if frame >= 4 * FPS else []
        slid = np.concatenate([_slid(states, n) for n in range(len(some))])
        print(f"  {correct} corrections: {100 * slid.mean():.2f} cm on average, 95 % under {100 * np.percentile(slid, 95):.1f} cm")


def _slid(states, n) -> np.ndarray:
    """How far each of one character's balls slid while its label said that it stood [m]."""
    found = []
    labels = np.array([s.memory["row"][n, LABELS_AT:LABELS_AT + 4] for s in states]) > 0.9
    c, s = (np.array([f(state.ground[n, 2]) for state in states])[:, None] for f in (np.cos, np.sin))
    points, ground = (np.array([x(state) for state in states]) for x in (lambda k: k.memory["points"][n], lambda k: k.ground[n]))
    flat = np.stack([ground[:, :1] + c * points[..., 0] + s * points[..., 2], ground[:, 1:2] - s * points[..., 0] + c * points[..., 2]], -1)
    for k in (1, 3):
        edges = np.flatnonzero(np.diff(np.concatenate([[0], labels[:, k].astype(int), [0]]))).reshape(-1, 2)
        found += [np.linalg.norm(flat[b - 1, k] - flat[a, k]) for a, b in edges if a > 0 and b < len(labels) and b - a > 3]
    return np.array(found)


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
    report_velocity(library)


if __name__ == "__main__":
    main()
