"""Measure walks over uneven ground: kerbs, stairs, slopes up, down and across.

    python scripts/measure/ground.py [--only NAME ...] [--strips DIR]

Told from the final pose alone, beside what says which soles stand. Eight people walk each way, each from another phase.
Below: heel, ball or toe's end under the ground that lies there by more than 0.5 cm, in the share of frames, and by how much at
most. Gap: how far standing heels and balls are over or under it, median and 95th percentile; what hangs over an edge by more
than 5 cm does not count. Off: the angle between a sole that stands whole and its ground. Drift: how far a standing ball
moves. Accelerations are the mass centre's, over 1/30 s. --strips draws where each way's mass centre is jerked most.
"""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from _motion import Motion
from _plots import pictures
from _strips import draw

from gambol.controllers.body import foot_drift
from gambol.controllers.contract import Intent
from gambol.controllers.locomotion import DEFAULT_LIBRARY, Locomotion
from gambol.controllers.navigation import floor_at

FPS, PEOPLE = 60, 8
SOLE = 0.02
"""How high heels, balls and toes' ends are in flat stance [m]."""


def box(centre, size, slope=0.0, heading=0.0):
    """A box as a scene has it."""
    return SimpleNamespace(centre=centre, size=size, slope=slope, heading=heading)


def stairs(rise, count=5, tread=0.30, landing=1.6):
    """Stairs up, a landing and stairs down."""
    end = 2.0 + count * tread
    up = [box((0, 0.5 * h, 0.5 * (2.0 + k * tread + end)), (4, h, end - 2.0 - k * tread))
          for k, h in enumerate(rise * np.arange(1, count + 1))]
    top = box((0, 0.5 * rise * count, end + 0.5 * landing), (4, rise * count, landing))
    down = [box((0, 0.5 * h, end + landing + 0.5 * (k + 1) * tread), (4, h, (k + 1) * tread))
            for k, h in enumerate(rise * np.arange(count, 0, -1))]
    return (*up, top, *down)


def ramp(degrees, length=4.0, landing=1.6):
    """A ramp up, a landing and a ramp down."""
    slope = math.tan(math.radians(degrees))
    high = slope * length
    return (box((0, 0.5 * high - 0.5, 2 + 0.5 * length), (4, 1.0, length), slope),
            box((0, 0.5 * high, 2 + length + 0.5 * landing), (4, high, landing)),
            box((0, 0.5 * high - 0.5, 2 + landing + 1.5 * length), (4, 1.0, length), -slope))


def across(degrees):
    """A slope that falls to one's right and is begun on: far too long to be left."""
    slope = math.tan(math.radians(degrees))
    return (box((0, 4.5, 6.0), (40.0, 1.0, 20.0), slope, 0.5 * math.pi),)


WAYS = {**{f"kerb of {h} cm, {v} m/s": ((box((0, 0.005 * h, 4.0), (4, 0.01 * h, 2.0)),), v) for h, v in ((10, 1.3), (15, 1.2), (15, 0.8))},
        **{f"stairs of {h} cm, {v} m/s": (stairs(0.01 * h), v)
           for h, v in ((12, 0.6), (12, 0.9), (15, 0.8), (17, 0.6), (17, 0.8), (17, 1.0), (20, 0.6), (20, 0.8))},
        **{f"up and down {d}°, {v} m/s": (ramp(d), v) for d, v in ((5, 1.3), (10, 1.2), (15, 0.8), (15, 1.2), (8, 2.8))},
        **{f"across {d}°, {v} m/s": (across(d), v) for d, v in ((5, 1.2), (10, 1.0), (15, 1.0), (15, 0.6))}}


def heights(points, around):
    """The ground (...) [m] under points (..., 3), at most half a metre over each, and its rise along x and z (..., 2)."""
    ground, rise = np.zeros(points.shape[:-1]), np.zeros(points.shape[:-1] + (2,))
    for b in around:
        c, s = math.cos(b.heading), math.sin(b.heading)
        dx, dz = points[..., 0] - b.centre[0], points[..., 2] - b.centre[2]
        along = s * dx + c * dz
        top = b.centre[1] + 0.5 * b.size[1] + b.slope * along
        inside = (np.abs(c * dx - s * dz) <= 0.5 * b.size[0]) & (np.abs(along) <= 0.5 * b.size[2]) & (top > ground) & (
            top < points[..., 1] + 0.5)
        ground = np.where(inside, top, ground)
        rise = np.where(inside[..., None], b.slope * np.array([s, c]), rise)
    return ground, rise


def walked(locomotion, around, speed):
    """The motion of all who walk a way, and how firmly heels and balls stand (T, N, 4)."""
    begin = np.zeros((PEOPLE, 3))
    begin[:, 1] = np.linspace(0.0, 0.5, PEOPLE)
    floor = np.array([floor_at(0.0, z, around) for z in begin[:, 1]])
    state, states = locomotion.start(begin, floor), []
    for _ in range(round((12.0 if speed < 2 else 16.0) / speed * FPS)):
        state, _ = locomotion.step(state, Intent(np.array([speed, 0.0, 0.0]), around=around), 1 / FPS)
        states.append(state)
    motion = Motion(locomotion.skeleton, FPS, np.array([s.pose.root for s in states]), np.array([s.pose.rotations for s in states]),
                    locomotion.library.accelerations)
    return motion, np.array([s.memory["grip"] for s in states])


def figures(motion, grip, around) -> str:
    """One way's figures in a line."""
    all_points = np.concatenate([motion.points, motion.toe_ends], 2)
    ground, rise = heights(all_points, around)
    over = all_points[..., 1] - SOLE - ground
    below = -over.min(-1)
    stands = grip >= 1.0
    gaps = np.abs(over[..., :4][stands & (over[..., :4] < 0.05)])
    off, flat = [], stands.reshape(*stands.shape[:2], 2, 2).all(-1)
    for foot, side in enumerate(("Left", "Right")):
        up = motion.kinematics[1][:, :, motion.skeleton.index(side + "Foot"), :, 1]
        normal = np.concatenate([-rise[..., 2 * foot + 1, :1], np.ones(up.shape[:-1] + (1,)), -rise[..., 2 * foot + 1, 1:]], -1)
        normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
        off.append(np.degrees(np.arccos(np.clip((up * normal).sum(-1), -1, 1)))[flat[..., foot]])
    off = np.concatenate(off)
    drift = np.concatenate([foot_drift(motion.points[:, n, 1::2], stands[:, n, 1::2]).drift for n in range(PEOPLE)])
    a = motion.com_acceleration
    return (f"below {100 * (below > 0.005).mean():4.1f} %, {100 * max(below.max(), 0):4.1f} cm · gap {100 * np.median(gaps):4.1f}, "
            f"{100 * np.percentile(gaps, 95):4.1f} cm · off {np.median(off):4.1f}, {np.percentile(off, 95):4.1f}° · drift {100 * drift.mean():4.2f} "
            f"({100 * drift.max():3.1f}) cm · up {a[..., 1].max():4.1f}, down {-a[..., 1].min():4.1f}, level "
            f"{np.linalg.norm(a[..., [0, 2]], axis=-1).max():4.1f} m/s² · joints {motion.joints.max():4.1f}×")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--library", default=DEFAULT_LIBRARY)
    parser.add_argument("--only", nargs="+", help="only the ways whose names hold one of these")
    parser.add_argument("--strips", type=Path, help="a folder for the worst moments")
    arguments = parser.parse_args()
    pictures(parser, arguments.strips)
    locomotion, worst = Locomotion.load(arguments.library), []
    for name, (around, speed) in WAYS.items():
        if arguments.only and not any(part in name for part in arguments.only):
            continue
        motion, grip = walked(locomotion, around, speed)
        print(f"  {name:26s} {figures(motion, grip, around)}", flush=True)
        jerk = np.linalg.norm(motion.com_acceleration, axis=-1)
        t, n = np.unravel_index(jerk.argmax(), jerk.shape)
        worst.append((float(jerk[t, n]), name, motion, int(n), int(t)))
    if arguments.strips:
        draw(sorted(worst, key=lambda w: -w[0])[:10], arguments.strips, "ground", "m/s²")


if __name__ == "__main__":
    main()
