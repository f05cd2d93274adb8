"""Measure how somebody who walks turns a corner: the stick thrown 60° to 180° aside, at every phase, both ways; and recorded people's corners.

    python scripts/measure/corners.py [--recordings DIR] [--only SPEED ...]

The corner is where he is as the stick is thrown. Of every one: how far he goes beyond the new line, which leads on from that corner, until he is under way on it; when
the heading is within 0.1 rad of it; from when on the mass centre has nine tenths of its speed along it, or what a steady gait's falls to where that is less; steps until
he faces it; its lowest speed. Recorded ones, who knew
beforehand, begin when heading or speed is a seventh off what it was; DIR is the folder of motion capture.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from _figures import figures, told
from _motion import Motion
from changes import FPS, PHASES, Bench

from gambol.controllers.locomotion import Library, Locomotion
from gambol.controllers.navigation import steer

SPEEDS, DEGREES, SECONDS, NEAR = (0.7, 1.0, 1.3), (60, 90, 120, 150, 180), 4.0, 0.1
BEGINS, HALF = 0.15, 0.5
"""A recorded corner begins with this share of heading [rad] or speed; what it leads from and to is told over so long [s]."""
GRAZE = 0.2
"""What comes down so soon [s] after another foot is a recorded one that its marker let stand in between."""
CORNERS = "woody2/walk_*_90degree*", "woody2/wd2_*_turn.bvh", "cmu/16/16_17.amc", "cmu/16/16_18.amc", "cmu/16/16_19.amc", "cmu/16/16_2[0789].amc", "cmu/16/16_30.amc", "cmu_30fps/69/69_2[0-9].bvh", "cmu_30fps/69/69_3[0-3].bvh"


def row_of(way, velocity, heading, strikes, angle, enough, rate) -> tuple[float, ...]:
    """What is told of one corner: way (T, 2) [m] from it and velocity (T, 2) [m/s] with the old line along z, heading (T,) [rad] from that, frames of strikes, which speed is enough [m/s]."""
    new, side = np.array([np.sin(angle), np.cos(angle)]), np.sign(angle)
    beyond = np.abs(way @ [new[1], -new[0]]) if abs(angle) > 3.1 else -side * (way @ [new[1], -new[0]])
    faces = int(np.flatnonzero(np.abs((heading - angle + np.pi) % (2 * np.pi) - np.pi) > NEAR)[-1]) + 1
    slow = int(np.flatnonzero(velocity[:faces + rate] @ new < enough)[-1]) + 1
    return beyond[:faces + rate].max(), faces / rate, slow / rate, float((strikes < faces).sum()), np.linalg.norm(velocity[:faces + rate // 2], axis=-1).min()


def ours(bench: Bench, speed: float, degrees: float) -> None:
    """Print the figures of one speed [m/s] and angle."""
    state = bench.at_all_phases((speed, 0, 0))
    rows, told_rows, enough = [], [], bench.up_to_speed(speed)
    for side in (1, -1):
        now, states, angle = state, [], side * np.radians(degrees)
        for _ in range(round(SECONDS * FPS)):
            now, _ = bench.locomotion.step(now, steer(now.ground, speed * np.array([np.sin(angle), np.cos(angle)]), None, now.velocity[:, 1]), 1 / FPS)
            states.append(now)
        motion = bench.motion(states)
        feet = np.array([s.contacts.reshape(-1, 2, 2).any(-1) for s in states]).astype(int)
        strikes = (np.diff(feet, axis=0) > 0).any(-1)
        heading = np.array([s.ground[:, 2] for s in states])
        told_rows.append(figures(motion))
        for n in range(PHASES):
            way = (motion.com[:, n] - motion.com[0, n])[:, [0, 2]]
            rows.append(row_of(way, motion.com_velocity[:, n][:, [0, 2]], heading[:, n], np.flatnonzero(strikes[:, n]), angle, enough, FPS))
    say(f"{speed:.1f} m/s, {degrees:3.0f}°", rows)
    print("    " + told(told_rows), flush=True)


def recorded(folder: Path, library: Library) -> None:
    """Print the figures of recorded corners of 60–120°."""
    from scipy.ndimage import gaussian_filter1d

    from gambol.controllers.mocap import calibrate, load, retarget

    rows, speeds, angles = [], [], []
    for path in sorted(path for pattern in CORNERS for path in folder.glob(pattern)):
        clip = load(path)
        body = retarget(clip, calibration=calibrate([clip]))
        rate = round(1 / body.frame_time)
        motion = Motion(body.skeleton, rate, body.root[:, None], body.rotations[:, None], library.accelerations)
        ahead = np.asarray(body.rotations, float)[:, 0, :, 2]
        heading = gaussian_filter1d(np.unwrap(np.arctan2(ahead[:, 0], ahead[:, 2])), 0.08 * rate)
        velocity = motion.com_velocity[:, 0][:, [0, 2]]
        middle, half = int(np.abs(np.gradient(heading) * (np.linalg.norm(velocity, axis=-1) > 0.3)).argmax()), round(HALF * rate)
        a, b = middle - round(1.1 * rate), middle + round(0.9 * rate)
        if a < 0 or b + half > len(heading):
            continue
        before, after = heading[a:a + half].mean(), heading[b:b + half].mean()
        old, new = np.array([np.sin(before), np.cos(before)]), np.array([np.sin(after), np.cos(after)])
        speed, later = (velocity[a:a + half] @ old).mean(), (velocity[b:b + half] @ new).mean()
        if not np.radians(60) < abs(after - before) < np.radians(120) or speed < 0.5:
            continue
        goes = (np.abs(heading[a:middle] - before) < BEGINS) & (velocity[a:middle] @ old > (1.0 - BEGINS) * speed)
        begin = a + int(np.flatnonzero(goes)[-1]) if goes.any() else a
        feet = motion.standing[:, 0].reshape(-1, 2, 2).any(-1).astype(int)
        strikes = np.flatnonzero((np.diff(feet, axis=0) > 0).any(-1))
        strikes = strikes[np.diff(strikes, prepend=-rate) > GRAZE * rate]
        turned = np.array([[np.cos(before), np.sin(before)], [-np.sin(before), np.cos(before)]])
        until = b + half
        way = (motion.com[begin:until, 0][:, [0, 2]] - motion.com[begin, 0][[0, 2]]) @ turned
        rows.append(row_of(way, velocity[begin:until] @ turned, heading[begin:until] - before, strikes[strikes > begin] - begin, after - before, 0.9 * later, rate))
        speeds.append(speed)
        angles.append(abs(np.degrees(after - before)))
    say(f"recorded ({len(rows)}), {min(speeds):.1f}–{max(speeds):.1f} m/s, {min(angles):.0f}–{max(angles):.0f}°", rows)


def say(name: str, rows) -> None:
    mean, most, least = np.mean(rows, 0), np.max(rows, 0), np.min(rows, 0)
    print(f"{name}: {mean[0]:.2f} m beyond ({most[0]:.2f}); faces there after {mean[1]:.2f} s (worst {most[1]:.2f}), nine tenths of the speed after {mean[2]:.2f} s "
          f"({most[2]:.2f}); {mean[3]:.1f} steps ({most[3]:.0f}); at least {mean[4]:.2f} m/s ({least[4]:.2f})", flush=True)


def main() -> None:
    """Print all figures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--recordings", type=Path, help="the folder of motion capture")
    parser.add_argument("--only", type=float, nargs="+", default=SPEEDS, help="speeds [m/s]")
    asked = parser.parse_args()
    bench = Bench(Locomotion.load(), False)
    if asked.recordings:
        recorded(asked.recordings, bench.locomotion.library)
    for speed in asked.only:
        for degrees in DEGREES:
            ours(bench, speed, degrees)


if __name__ == "__main__":
    main()
