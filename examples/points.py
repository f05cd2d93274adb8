"""A body from a few points in a loop of your own: points in, some of them missing now and then, and the whole body's joints out.

Here the points are those of somebody who walks; yours come from trackers, cameras or a simulation.

    python examples/points.py
"""

import numpy as np

from gambol.controllers.body import forward_kinematics
from gambol.controllers.contract import Intent
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.reconstruction import SKELETON, Reconstruction, parse
from gambol.controllers.reconstruction.trackers import Network, Trackers

RATE = 60


def walked(frames: int) -> np.ndarray:
    """Joints (frames, 22, 3) [m] of somebody who walks in a bend."""
    walker = Locomotion.load()
    state, joints = walker.start(), []
    for _ in range(frames):
        state, pose = walker.step(state, Intent(np.array([1.2, 0.3, 0.0])), 1 / RATE)
        joints.append(forward_kinematics(walker.skeleton, pose.root, pose.rotations)[0])
    return np.array(joints)


def main(seconds: float = 4.0, missing: float = 0.2) -> float:
    """By how much joints are off [m] on the average. missing: the share of all points that never arrive."""
    truth = walked(round(seconds * RATE))
    controls = parse("root,head,lwrist,rwrist,lankle,rankle", SKELETON)
    method = Trackers(Network.load(), controls)                   # the network that ships
    follower = Reconstruction(method, controls, starts=method)    # height=1.6, if the body is smaller
    points = truth[:, controls.joints].copy()                     # (T, 6, 3) [m], Y up
    points[1:][np.random.default_rng(0).random(points[1:].shape[:2]) < missing] = np.nan
    state, off = follower.begin(points[0]), []
    for seen, true in zip(points[1:], truth[1:], strict=True):
        state, pose = follower.step(state, Intent(points=seen), 1 / RATE)
        joints, _ = forward_kinematics(follower.skeleton, pose.root, pose.rotations)    # (22, 3) [m]
        off.append(np.linalg.norm(joints - true, axis=-1).mean())
    print(f"{follower.status(state).kind}; joints are {100 * np.mean(off):.1f} cm off")
    return float(np.mean(off))


if __name__ == "__main__":
    main()
