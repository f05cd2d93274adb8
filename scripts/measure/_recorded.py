"""The same figures of recorded people, on Gambol's skeleton."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from _figures import at_rest, figures, told
from _motion import Motion

from gambol.controllers.locomotion import Library

RECORDED = {"starts": "woody2/wd2_start_*", "stops": "woody2/wd2_stop_*", "crossings": "woody2/wd2_cross_walk_*",
            "walks": "woody2/wd2_WalkForward*", "turns": "woody2/wd2_*turn*", "runs (CMU)": "cmu/[01][96]/*_[03][1-6].amc",
            "idles": "woody2/wd2_idle*"}


def recorded(folder: Path, library: Library) -> None:
    """The same figures of one actor's recordings, on Gambol's skeleton."""
    from gambol.controllers.mocap import calibrate, load, retarget

    print("Recorded, the same actor:")
    for name, pattern in RECORDED.items():
        clips = [load(path) for path in sorted(folder.glob(pattern))]
        clips = [clip for clip in clips if len(clip) * clip.frame_time > 0.9]
        rows = []
        for clip in clips:
            body = retarget(clip, calibration=calibrate([clip]))
            motion = Motion(body.skeleton, round(1 / body.frame_time), body.root[:, None], body.rotations[:, None], library.accelerations)
            rows.append((figures(motion), motion))
        if rows:
            print(f"  {name} ({len(rows)}): " + told([row for row, _ in rows]))
            speed = [np.linalg.norm(m.com_velocity[..., [0, 2]], axis=-1)[:, 0] for _, m in rows]
            if name == "idles":
                print("    " + "; ".join(f"{len(m.roots) / m.rate:.0f} s: " + at_rest(m) for _, m in rows))
            if name == "starts":
                times = [_rise(s, m.rate) for s, (_, m) in zip(speed, rows)]
                print(f"    from 10 to 90 % of the speed: median {np.median(times):.2f} s")


def _rise(speed, rate) -> float:
    top = np.percentile(speed, 90)
    high = int(np.argmax(speed > 0.9 * top))
    low = high - int(np.argmax(speed[:high + 1][::-1] < 0.1 * top))
    return (high - low) / rate
