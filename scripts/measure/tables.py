"""Measure how deep arms come into boxes as high as tables, of who walks past, turns, stops and stands beside them.

    python scripts/measure/tables.py [--heights METRES ...]

Elbows, forearms and hands as they are bent are capsules; told are, over all heights and distances of a way to pass, the deepest of any in any frame, how
many frames are deeper than 2 cm, and how hard joints turn over the recordings' own 99th percentile, beside the same moves where nothing stands.
"""

from __future__ import annotations

import argparse
from collections import namedtuple

import numpy as np

from _motion import Motion
from gambol.controllers.body import end_positions, forward_kinematics
from gambol.controllers.contract import Intent
from gambol.controllers.navigation import gap
from gambol.controllers.person import person
from gambol.game.scene import Box
from gambol.game.world import stopped

HEIGHTS, BESIDE = (0.7, 0.8, 0.9, 1.0, 1.1), (0.25, 0.30, 0.35, 0.40, 0.45)
FPS = 60
ARMS = ("LeftForeArm", "LeftHand"), ("RightForeArm", "RightHand")
FORE, HAND, PARTS = 0.045, 0.035, np.linspace(0.0, 1.0, 5)
"""How thick an elbow is, and a wrist and all beyond it [m]; places along a bone that are looked at."""

Way = namedtuple("Way", "name box wishes")
"""A way to pass: where a box's face is for a distance and a height, and the wish in each second."""


def beside(far: float, high: float) -> Box:
    """A long box on the right of who walks along z."""
    return Box((-far - 0.4, 0.5 * high, 0.0), (0.8, high, 40.0))


def ahead(far: float, high: float) -> Box:
    """A table across the way of who walks along z, so far away that he walks some steps."""
    return Box((0.0, 0.5 * high, far + 2.0), (4.0, high, 0.8))


ON, REST = (1.3, 0.0, 0.0), (0.0, 0.0, 0.0)
WAYS = (Way("walk past at 1.3 m/s", beside, [ON] * 5), Way("walk past at 1.8 m/s", beside, [(1.8, 0.0, 0.0)] * 5), Way("run past at 3.0 m/s", beside, [(3.0, 0.0, 0.0)] * 5),
        Way("turn left beside", beside, [(0.0, 1.5, 0.0)] * 5), Way("turn right beside", beside, [(0.0, -1.5, 0.0)] * 5), Way("stop beside", beside, [ON, ON, REST, REST]),
        Way("stand beside", beside, [REST] * 8), Way("walk up to it", ahead, [ON] * 5), Way("walk up slowly", ahead, [(0.7, 0.0, 0.0)] * 6), Way("run up to it", ahead, [(2.5, 0.0, 0.0)] * 4))


def played(who, wishes, box):
    """Poses of somebody through wishes of a second each, in every step; his wishes heed the box."""
    state, poses = who.start(), []
    around = () if box is None else (box,)
    for wish in wishes:
        for _ in range(FPS):
            intent = Intent(np.array(wish), around=around)
            state, pose = who.step(state, stopped(state, intent, around), 1 / FPS)
            poses.append(pose)
    return poses


def depths(skeleton, poses, box) -> np.ndarray:
    """How deep (T,) [m] arms are in a box, negative outside."""
    places, turned = forward_kinematics(skeleton, np.array([pose.root for pose in poses]), np.array([pose.rotations for pose in poses]))
    ends = end_positions(skeleton, places, turned)
    worst = np.full(len(poses), -np.inf)
    for elbow, wrist in ARMS:
        a, b = places[:, skeleton.index(elbow)], places[:, skeleton.index(wrist)]
        tip = ends[:, skeleton.end_index[wrist]]
        for one, other, thick in ((a, b, np.linspace(FORE, HAND, len(PARTS))), (b, tip, np.full(len(PARTS), HAND))):
            points = one[:, None] + PARTS[:, None] * (other - one)[:, None]
            worst = np.maximum(worst, (thick - gap(points.reshape(-1, 3), box).reshape(points.shape[:2])).max(1))
    return worst


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--heights", nargs="+", type=float, default=HEIGHTS, help="how high [m]")
    heights, who = parser.parse_args().heights, person()
    skeleton, limits = who.skeleton, who.parts[who.first].library.accelerations
    print(f"{'':22} {'deepest':>9}  {'at':>12} {'> 2 cm':>8}  {'joints':>6} {'free':>6}")
    for way in WAYS:
        found, free = [], None
        for far in BESIDE:
            for high in heights:
                box = way.box(far, high)
                poses = played(who, way.wishes, box)
                found.append((depths(skeleton, poses, box), far, high, whipped(skeleton, poses, limits)))
        free = whipped(skeleton, played(who, way.wishes, None), limits)
        worst = max(found, key=lambda one: one[0].max())
        print(f"{way.name:22} {100 * worst[0].max():6.1f} cm  {worst[1]:.2f}, {worst[2]:.1f} m {100 * np.mean([one[0] > 0.02 for one in found]):6.2f} %  {max(one[3] for one in found):5.1f}× {free:5.1f}×", flush=True)


def whipped(skeleton, poses, limits) -> float:
    """The hardest that arms' joints turn, over the recordings' own 99th percentile."""
    motion = Motion(skeleton, FPS, np.array([pose.root for pose in poses])[:, None], np.array([pose.rotations for pose in poses])[:, None], limits)
    return float(motion.joints[FPS // 2:, 0][:, [skeleton.index(name) for arm in ARMS for name in arm]].max())


if __name__ == "__main__":
    main()
