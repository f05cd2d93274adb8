"""Measure how often one arm is in the other of people who stand about.

    python scripts/measure/idling.py [--people 16] [--seconds 90]

Bones of arms are capsules as thick as the mannequin's. Told is how near bones of the two arms come to each other, axis to axis, for how much of the time they are nearer
than they are thick together, than half of that, and of how many people.
"""

from __future__ import annotations

import argparse

import numpy as np

from gambol.controllers.body import end_positions, forward_kinematics
from gambol.controllers.contract import Intent
from gambol.controllers.locomotion import Locomotion, between_bones

FPS, EVERY = 60, 3
"""Steps a second, and every which of them is looked at."""
BONES = {"upper arm": ("Arm", "ForeArm", 0.045), "forearm": ("ForeArm", "Hand", 0.04), "hand": ("Hand", "", 0.025)}
"""From which joint to which or to its end, and how thick [m]."""


def main() -> None:
    """Print all figures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--people", type=int, default=16)
    parser.add_argument("--seconds", type=float, default=90.0)
    asked = parser.parse_args()
    locomotion = Locomotion.load()
    skeleton, count = locomotion.skeleton, asked.people
    state, roots, poses = locomotion.start(np.array([(2.3 * k, -1.7 * k, 0.7 * k) for k in range(count)])), [], []
    for tick in range(round(asked.seconds * FPS)):
        state, pose = locomotion.step(state, Intent(np.zeros((count, 3))), 1 / FPS)
        if tick % EVERY == 0:
            roots.append(pose.root)
            poses.append(pose.rotations)
    positions, turned = forward_kinematics(skeleton, np.array(roots, float), np.array(poses, float))
    ends = end_positions(skeleton, positions, turned)

    def bone(side: str, first: str, last: str) -> tuple[np.ndarray, np.ndarray]:
        to = positions[:, :, skeleton.index(side + last)] if last else ends[:, :, skeleton.end_index[side + first]]
        return positions[:, :, skeleton.index(side + first)].reshape(-1, 3), to.reshape(-1, 3)

    for left, (first, last, thick) in BONES.items():
        for right, (begins, stops, wide) in BONES.items():
            gap = between_bones(bone("Left", first, last), bone("Right", begins, stops))[0].reshape(-1, count)
            near = thick + wide
            print(f"  left {left:10} right {right:10} nearest {100 * gap.min():4.1f} cm, under {100 * near:.1f} cm in {np.mean(gap < near):6.2%}, "
                  f"under half of that in {np.mean(gap < 0.5 * near):6.2%} of the time, {int((gap < 0.5 * near).any(0).sum())} of {count} people")


if __name__ == "__main__":
    main()
