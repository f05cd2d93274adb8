"""Whether a body goes with its own trackers in blows, kicks and sprints: how far tracked points of recorded clips are from the body that is made of them, live.

    python scripts/measure/blows.py ../shared/mocap/cmu/14/14_02.amc ../shared/mocap/cmu/127/127_08.amc … [--points 6] [--turns] [--noise CM]
"""

from __future__ import annotations

import argparse
import math
from dataclasses import replace

import numpy as np

from gambol.controllers.body import forward_kinematics
from gambol.controllers.contract import Intent
from gambol.controllers.mocap import hinged, load, retarget
from gambol.controllers.reconstruction import SKELETON, Reconstruction, parse
from gambol.controllers.reconstruction.evaluation import jitter, position_error
from gambol.controllers.reconstruction.live import Recorded
from gambol.controllers.reconstruction.trackers import Network, Trackers

FPS, MOST = 60.0, 1500
"""Frames a second, and how many of a clip are looked at, at most."""
BEGUN, FAR = 10, 0.2
"""Frames until a body has begun; farther than this [m] a point is far from it."""


def made(path: str, points: str, turning: bool, noise: float) -> tuple[float, ...]:
    """Of a clip: mean error of joints, of tracked points and the worst of these [cm], the share of frames with one that is far, and jitter and peak acceleration over the clip's own."""
    clip = hinged(retarget(load(path))).resample(FPS)
    clip = replace(clip, root=clip.root[:MOST], quaternions=clip.quaternions[:MOST])
    controls = parse(points, SKELETON)
    method = Trackers(Network.load(), controls, clip.frame_time)
    follower = Reconstruction(method, controls, dt=clip.frame_time, starts=method, far=math.inf)
    source = Recorded.of(clip, controls, turning)
    source = source.noisy(noise, np.random.default_rng(0)) if noise else source
    state = follower.begin(source.points[0], (source.points[1] - source.points[0]) / clip.frame_time, turns=source.turned_at(0.0))
    poses = [state.pose]
    for number in range(1, len(clip)):
        now = number * clip.frame_time
        state, pose = follower.step(state, Intent(points=source.at(now), turns=source.turned_at(now)), clip.frame_time)
        poses.append(pose)
    found = forward_kinematics(SKELETON, np.stack([pose.root for pose in poses]), np.stack([pose.rotations for pose in poses]))
    truth = clip.kinematics()[:2]
    apart = np.linalg.norm(controls.on(*found) - controls.on(*truth), axis=-1)[BEGUN:]
    peak, own = (np.linalg.norm(np.diff(joints, 2, axis=0), axis=-1).max() for joints in (found[0], truth[0]))
    return (100.0 * position_error(found[0], truth[0]).mean(), 100.0 * apart.mean(), 100.0 * apart.max(), (apart.max(-1) > FAR).mean(),
            jitter(found[0], clip.frame_time) / jitter(truth[0], clip.frame_time), peak / own)


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("clips", nargs="+", help="BVH or AMC files")
    parser.add_argument("--points", default="6", help="points on the body")
    parser.add_argument("--turns", action="store_true", help="trackers tell how they are turned")
    parser.add_argument("--noise", type=float, default=0.0, help="[cm] on each coordinate")
    given = parser.parse_args()
    rows = np.array([made(clip, given.points, given.turns, given.noise / 100.0) for clip in given.clips])
    names = [clip.rpartition("/")[2] for clip in given.clips]
    for name, row in zip([*names, "mean", "worst"], [*rows, rows.mean(0), rows.max(0)]):
        print(f"{name:36} joints {row[0]:5.2f} cm; tracked points {row[1]:5.2f} cm, {row[2]:5.1f} at worst, {row[3]:.2%} of frames over 20; jitter {row[4]:.2f}×; peak acceleration {row[5]:.2f}×")


if __name__ == "__main__":
    main()
