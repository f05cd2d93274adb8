"""Restless hands of other bodies and at other rates: what is shown at every step, in the size and the time of the standard body (Froude)."""

from __future__ import annotations

import numpy as np

from _figures import figures
from _motion import Motion

from gambol.controllers.body import contact_height
from gambol.controllers.jump import Physique
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.navigation import steer
from gambol.controllers.scaled import Scaled

SECONDS, COUNT, HANDS = 30, 6, 60
"""So many seconds of so many restless pairs, which ask for something else so many times a second at most, whatever the rate."""
JOINTS = {"knee": ("LeftLeg", "RightLeg"), "ankle": ("LeftFoot", "RightFoot"), "toe": ("LeftToe", "RightToe"), "hip": ("LeftUpLeg", "RightUpLeg"),
          "hand": ("LeftHand", "RightHand"), "head": ("Head",)}


def bodies(locomotion: Locomotion, heights: list[float], rates: list[int], asks, seed: int) -> None:
    """Print the figures of bodies so high [m], stepped so many times a second. asks: what hands ask for, of a generator, steps and pairs."""
    print(f"Restless hands, {SECONDS * COUNT / 60:.0f} minutes of each body at each rate, in the standard body's size and time: joints over 3× walking, worst "
          "(runs) · drift a stance, worst · lowest sole\n  · joints' accelerations from step to step, 99.9th percentile and worst, m/s²")
    for height in heights:
        for rate in rates:
            roots, rotations, factor = played(locomotion, height, rate, *asks(np.random.default_rng(seed), SECONDS * HANDS, COUNT))
            skeleton, own = locomotion.skeleton, rate * factor**0.5
            motion = Motion(skeleton, round(own), roots / factor, rotations, locomotion.library.accelerations)
            row = figures(motion)
            lowest = min(motion.points[..., 1].min(), motion.toe_ends[..., 1].min()) - contact_height(skeleton)
            steps = np.linalg.norm(np.diff(motion.kinematics[0], 2, axis=0), axis=-1) * own**2
            print(f"  {height:.2f} m, {rate:3d} a second: {row['joints3']:.2f} %, {row['joint']:.1f}× ({row['joint_run']:.1f}×) · {row['drift']:.2f} cm, "
                  f"{row['drift_worst']:.1f} · {100 * lowest:.2f} cm · " + ", ".join(f"{name} {_told(steps[..., [skeleton.index(n) for n in joints]])}"
                                                                                  for name, joints in JOINTS.items()), flush=True)


def _told(steps: np.ndarray) -> str:
    return f"{np.percentile(steps, 99.9):.0f}–{steps.max():.0f}"


def played(locomotion: Locomotion, height: float, rate: int, move: np.ndarray, face: np.ndarray):
    """Roots (T, N, 3) [m] and rotations (T, N, J, 3, 3) of a body's steps as hands ask for `move` (T, N, 2) [m/s] and `face` (T, N) in the standard body's
    size, and how long its legs are over those."""
    factor = Physique(height=height).size
    walker = locomotion if factor == 1.0 else Scaled(locomotion, factor)
    shown = []
    for n in range(move.shape[1]):
        state, poses = walker.start(), []
        for t in range(SECONDS * rate):
            at = t * HANDS // rate
            wish = steer(state.ground, move[at, n] * factor**0.5, face[at, n], state.velocity[1])
            state, pose = walker.step(state, wish, 1 / rate)
            poses.append(pose)
        shown.append(poses)
    return (np.array([[pose.root for pose in poses] for poses in shown]).swapaxes(0, 1),
            np.array([[pose.rotations for pose in poses] for poses in shown]).swapaxes(0, 1), factor)
