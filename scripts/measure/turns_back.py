"""Measure how somebody who walks or runs goes back: the stick thrown back, at every phase, and recorded people's U-turns.

    python scripts/measure/turns_back.py [--recordings DIR]

Of every one: when the heading is within 0.1 rad of the way back, from when on the mass centre has nine tenths of its speed that way, or what a steady
gait's falls to where that is less, steps until then, how far it goes on and aside, its lowest speed on average. Recorded ones begin when heading or speed is a seventh off what it was; DIR is the folder of motion capture.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from _figures import figures, told
from _motion import Motion
from changes import FPS, Bench

from gambol.controllers.locomotion import Library, Locomotion
from gambol.controllers.navigation import steer

SPEEDS, SECONDS, NEAR = (0.7, 1.0, 1.3, 2.5, 3.0, 3.5), 5.0, 0.1
BEGINS = 0.15


def ours(bench: Bench, speed: float) -> None:
    """Print the figures of one speed [m/s]."""
    angle, new = np.pi, np.array([0.0, -1.0])
    state, states, enough = bench.at_all_phases((speed, 0, 0)), [], bench.up_to_speed(speed)
    for _ in range(round(SECONDS * FPS)):
        state, _ = bench.locomotion.step(state, steer(state.ground, speed * new, None, state.velocity[:, 1]), 1 / FPS)
        states.append(state)
    motion, rows = bench.motion(states), []
    feet = np.array([s.contacts.reshape(-1, 2, 2).any(-1) for s in states]).astype(int)
    strikes = (np.diff(feet, axis=0) > 0).sum(-1)
    heading = np.array([s.ground[:, 2] for s in states])
    for n in range(heading.shape[1]):
        faces = int(np.flatnonzero(np.abs((heading[:, n] - angle + np.pi) % (2 * np.pi) - np.pi) > NEAR)[-1]) + 1
        slow = int(np.flatnonzero(motion.com_velocity[:faces + FPS, n][:, [0, 2]] @ new < enough)[-1]) + 1
        way = motion.com[:, n] - motion.com[0, n]
        rows.append((faces / FPS, slow / FPS, strikes[:faces, n].sum(), way[:, 2].max(), np.abs(way[:faces, 0]).max()))
    lowest = np.linalg.norm(motion.com_velocity[..., [0, 2]], axis=-1).min(0)
    say(f"{speed:.1f} m/s", rows, lowest.mean())
    print("    " + told([figures(motion)]))


def recorded(folder: Path, library: Library) -> None:
    """Print the figures of recorded U-turns."""
    from scipy.ndimage import gaussian_filter1d

    from gambol.controllers.mocap import calibrate, load, retarget

    rows, speeds = [], []
    for path in sorted(folder.glob("woody2/*u-turn*")):
        clip = load(path)
        body = retarget(clip, calibration=calibrate([clip]))
        rate = round(1 / body.frame_time)
        motion = Motion(body.skeleton, rate, body.root[:, None], body.rotations[:, None], library.accelerations)
        ahead = np.asarray(body.rotations, float)[:, 0, :, 2]
        heading = gaussian_filter1d(np.unwrap(np.arctan2(ahead[:, 0], ahead[:, 2])), 0.05 * rate)
        flat, velocity = motion.com[:, 0][:, [0, 2]], motion.com_velocity[:, 0][:, [0, 2]]
        feet = motion.standing[:, 0].reshape(-1, 2, 2).any(-1).astype(int)
        strikes = np.flatnonzero((np.diff(feet, axis=0) > 0).any(-1))
        way_of, last = np.floor((heading - heading[0]) / np.pi + 0.5), -rate
        for middle in np.flatnonzero(np.diff(way_of)):
            a, b, half = middle - round(1.33 * rate), middle + round(0.95 * rate), rate // 2
            if a < half or b + rate >= len(heading) or middle - last < rate:
                continue
            before, after = heading[a:a + half].mean(), heading[b:b + half].mean()
            if abs(abs(after - before) - np.pi) > 0.5:
                continue
            last, old, new = middle, np.array([np.sin(before), np.cos(before)]), np.array([np.sin(after), np.cos(after)])
            speed, later = (velocity[a - rate // 3:a + half] @ old).mean(), (velocity[b:b + 2 * rate // 3] @ new).mean()
            goes = (np.abs(heading[a:middle] - before) < BEGINS) & (velocity[a:middle] @ old > (1.0 - BEGINS) * speed)
            begin = a + int(np.flatnonzero(goes)[-1]) if goes.any() else a
            faces = middle + int((np.abs(heading[middle:] - after) < NEAR).argmax())
            quick = middle + int((velocity[middle:] @ new > 0.9 * later).argmax())
            way = flat[begin:b + half] - flat[begin]
            rows.append(((faces - begin) / rate, (quick - begin) / rate, ((strikes > begin) & (strikes <= faces)).sum(), (way @ old).max(),
                         np.abs(way[:faces - begin] @ np.array([old[1], -old[0]])).max()))
            speeds.append(speed)
    say(f"recorded ({len(rows)}), {min(speeds):.1f}–{max(speeds):.1f} m/s", rows)


def say(name: str, rows, lowest: float | None = None) -> None:
    mean, most = np.mean(rows, 0), np.max(rows, 0)
    print(f"{name}: faces back after {mean[0]:.2f} s (worst {most[0]:.2f}), nine tenths of the speed after {mean[1]:.2f} s ({most[1]:.2f}); {mean[2]:.1f} steps ({most[2]:.0f}); "
          f"goes on {mean[3]:.2f} m ({most[3]:.2f}), aside {mean[4]:.2f} m ({most[4]:.2f})" + (f"; at least {lowest:.2f} m/s" if lowest is not None else ""), flush=True)


def main() -> None:
    """Print all figures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--recordings", type=Path, help="the folder of motion capture")
    asked = parser.parse_args()
    bench = Bench(Locomotion.load(), False)
    if asked.recordings:
        recorded(asked.recordings, bench.locomotion.library)
    for speed in SPEEDS:
        ours(bench, speed)


if __name__ == "__main__":
    main()
