"""The same figures of recorded people, on Gambol's skeleton."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from _figures import at_rest, figures, told
from _motion import Motion

from gambol.controllers.locomotion import Library

RECORDED = {"starts": "woody2/wd2_start_*", "stops": "woody2/wd2_stop_*", "crossings": "woody2/wd2_cross_walk_*",
            "walks": "woody2/wd2_WalkForward*", "brisk walks (CMU)": "cmu_bvh/0[78]/*.bvh", "turns": "woody2/wd2_*turn*", "runs (CMU)": "cmu/[01][96]/*_[03][1-6].amc",
            "idles": "woody2/wd2_idle*"}

STEADY = ("walks", "crossings", "brisk walks (CMU)")
STRIDE = 1.1
"""Seconds that strides are looked for in; all knees' pushes lie in it."""


def recorded(folder: Path, library: Library) -> None:
    """The same figures of one actor's recordings, on Gambol's skeleton."""
    from gambol.controllers.mocap import calibrate, load, retarget

    print("Recorded, the same actor:")
    knees = []
    for name, pattern in RECORDED.items():
        clips = [load(path) for path in sorted(folder.glob(pattern))]
        clips = [clip for clip in clips if len(clip) * clip.frame_time > 0.9]
        rows = []
        for clip in clips:
            body = retarget(clip, calibration=calibrate([clip]))
            motion = Motion(body.skeleton, round(1 / body.frame_time), body.root[:, None], body.rotations[:, None], library.accelerations)
            rows.append((figures(motion), motion))
        if name in STEADY:
            knees += [found for _, motion in rows for found in _knees(motion)]
        if rows:
            print(f"  {name} ({len(rows)}): " + told([row for row, _ in rows], False))
            speed = [np.linalg.norm(m.com_velocity[..., [0, 2]], axis=-1)[:, 0] for _, m in rows]
            if name == "stops":
                rest = [np.median(m.lean[-m.rate // 3:]) for _, m in rows]
                print("    trunk's lean as the speed falls, from that at rest: " + ", ".join(
                    f"{np.percentile(m.lean[int(s.argmax()):, 0], 5) - r:+.0f}°" for (_, m), s, r in zip(rows, speed, rest)))
            if name == "idles":
                print("    " + "; ".join(f"{len(m.roots) / m.rate:.0f} s: " + at_rest(m) for _, m in rows))
            if name == "starts":
                times = [_rise(s, m.rate) for s, (_, m) in zip(speed, rows)]
                print(f"    from 10 to 90 % of the speed: median {np.median(times):.2f} s")
    speeds, most = np.array(knees).reshape(-1, 2).T
    print("  knees' acceleration over the recordings' own, the most in a stride of steady walks, median (90 %): " + ", ".join(
        f"{v:.1f} m/s {np.median(most[near]):.1f} ({np.percentile(most[near], 90):.1f})×"
        for v in (0.4, 0.7, 1.0, 1.3, 1.5) if (near := np.abs(speeds - v) < 0.08).sum() >= 3))


def _knees(motion: Motion) -> list[tuple[float, float]]:
    """Of every stride of a steady walk: its speed [m/s] and the most that a knee accelerates, over the recordings' own."""
    n, found = round(STRIDE * motion.rate), []
    knees = [motion.skeleton.index(side + "Leg") for side in ("Left", "Right")]
    for t in range(motion.rate // 2, len(motion.roots) - motion.rate // 2 - n, n):
        speed = np.linalg.norm(motion.com_velocity[t:t + n, 0][:, [0, 2]], axis=-1)
        if np.ptp(speed) < 0.3 * speed.mean():
            found.append((float(speed.mean()), float(motion.joints[t:t + n, 0][:, knees].max())))
    return found


def _rise(speed, rate) -> float:
    top = np.percentile(speed, 90)
    high = int(np.argmax(speed > 0.9 * top))
    low = high - int(np.argmax(speed[:high + 1][::-1] < 0.1 * top))
    return (high - low) / rate
