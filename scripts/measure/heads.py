"""Measure how far heads turn over shoulders, and how suddenly, as one walks about, beside recorded people.

    python scripts/measure/heads.py [--recordings DIR] [--people 20] [--seconds 30] [--set SETTING=VALUE ...]

DIR is the folder of motion capture. Told is the angle between face and chest, seen from above, by how fast a walker's hips turn, of who goes aside, and as
hands throw the stick about; and how fast a head's turning changes, in the room.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from changes import FPS, bursts, hands

from gambol.controllers.body import Skeleton, forward_kinematics, wrap
from gambol.controllers.locomotion import Locomotion, Settings
from gambol.controllers.mocap import calibrate, load, retarget
from gambol.controllers.navigation import steer

RECORDED = {"curves": "woody2/wd2_spiral_walk_*", "starts, turning": "woody2/wd2_start_[1-9]*", "turns": "woody2/wd2_*turn*", "crossings, 45°": "woody2/wd2_cross_walk_*45d*",
            "crossings, 90°": "woody2/wd2_cross_walk_*90d*"}
TURNING = (0.0, 0.2, 0.5, 0.9, 1.4, 2.5)
"""Classes of how fast hips turn [rad/s]."""
WALKS = (0.4, 1.7)
"""Between these speeds [m/s] somebody walks."""


def angles(skeleton: Skeleton, roots: np.ndarray, turns: np.ndarray, rate: int) -> dict[str, np.ndarray]:
    """Of T frames of N bodies (T − 2 s, N), s of them in 1/30 s: face from chest [°], a head's change of turning [°/s²],
    hips' turning [rad/s], speed [m/s]."""
    positions, orientations = forward_kinematics(skeleton, np.asarray(roots, float), np.asarray(turns, float))
    step = max(1, round(rate / 30))

    def faces(joint: str) -> np.ndarray:
        return np.unwrap(np.arctan2(*np.moveaxis(orientations[..., skeleton.index(joint), [0, 2], 2], -1, 0)), axis=0)
    head, chest, hips = faces("Head"), faces("Spine2"), faces("Hips")
    wide = max(1, round(0.25 * rate))
    smooth = np.array([hips[min(t + wide, len(hips) - 1)] - hips[max(t - wide, 0)] for t in range(len(hips))]) * rate / (2 * wide)
    inner = slice(step, -step)
    speed = np.linalg.norm(positions[2 * step:, :, 0] - positions[:-2 * step, :, 0], axis=-1) * rate / (2 * step)
    return {"head": np.degrees(np.abs(wrap(head - chest)))[inner],
            "sudden": np.degrees(np.abs(head[2 * step:] - 2.0 * head[inner] + head[:-2 * step])) * (rate / step) ** 2,
            "turning": np.abs(smooth)[inner], "speed": speed}


def told(name: str, found: dict[str, np.ndarray]) -> None:
    """Print the figures of one kind of motion."""
    head, sudden = found["head"], found["sudden"]
    walks = (found["speed"] > WALKS[0]) & (found["speed"] < WALKS[1])
    print(f"{name}: face from chest, median, 90 %, 99 %, most: {np.median(head):.0f}, {np.percentile(head, 90):.0f}, {np.percentile(head, 99):.0f}, {head.max():.0f}°; "
          f"change of turning, 99 %: {np.percentile(sudden, 99):.0f} °/s²")
    rows = [(low, high, head[walks & (found["turning"] >= low) & (found["turning"] < high)]) for low, high in zip(TURNING, TURNING[1:])]
    print("  walking and turning at " + "; ".join(f"{low:g}–{high:g} rad/s {np.median(row):.0f}, {np.percentile(row, 90):.0f}°" for low, high, row in rows if len(row) > 20))


def ours(locomotion: Locomotion, name: str, move: np.ndarray, face: np.ndarray) -> None:
    """Print those of somebody who is asked for ways (T, N, 2) [m/s] and to face headings (T, N)."""
    state, roots, turns = locomotion.start(np.zeros((move.shape[1], 3))), [], []
    for way, held in zip(move, face):
        state, pose = locomotion.step(state, steer(state.ground, way, held, state.velocity[:, 1]), 1 / FPS)
        roots.append(pose.root)
        turns.append(pose.rotations)
    told(name, angles(locomotion.skeleton, np.array(roots), np.array(turns), FPS))


def main() -> None:
    """Print all figures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--recordings", type=Path)
    parser.add_argument("--people", type=int, default=20)
    parser.add_argument("--seconds", type=float, default=30.0)
    parser.add_argument("--set", nargs="*", default=[], metavar="SETTING=VALUE")
    asked = parser.parse_args()
    if asked.recordings is not None:
        for name, pattern in RECORDED.items():
            clips = [clip for path in sorted(asked.recordings.glob(pattern)) if len(clip := load(path)) * clip.frame_time > 0.9]
            rows = [angles(body.skeleton, body.root[:, None], body.rotations[:, None], round(1 / body.frame_time))
                    for body in (retarget(clip, calibration=calibrate([clip])) for clip in clips)]
            told(f"recorded, {name} ({len(rows)})", {key: np.concatenate([row[key] for row in rows]) for key in rows[0]})
    locomotion = Locomotion.load().tuned(Settings(**{name: float(value) for name, value in (one.split("=") for one in asked.set)}))
    frames, count = round(asked.seconds * FPS), asked.people
    time, spins = np.arange(frames)[:, None] / FPS, np.linspace(0.4, 2.2, count) * np.where(np.arange(count) % 2, 1, -1)
    told_way = 1.3 * np.stack([np.sin(spins * time), np.cos(spins * time)], -1)
    free = np.full((frames, count), np.nan)
    ours(locomotion, "the stick in circles", told_way, free)
    aside = np.broadcast_to(0.45 * np.stack([np.sin(np.linspace(-1.6, 1.6, count)), np.cos(np.linspace(-1.6, 1.6, count))], -1), (frames, count, 2))
    ours(locomotion, "aside, facing ahead", aside, np.zeros((frames, count)))
    back = 1.3 * np.stack([np.zeros((frames, count)), np.where(np.floor(time / 1.5 + np.arange(count) / count) % 2 == 0, 1.0, -1.0)], -1)
    ours(locomotion, "there and back", back, free)
    ours(locomotion, "restless hands", *hands(np.random.default_rng(13), frames, count))
    ours(locomotion, "hands in a hurry", *bursts(np.random.default_rng(13), frames, count))


if __name__ == "__main__":
    main()
