"""How good a motion is, judged from its poses alone: drift and skate of the feet, floor, accelerations.

No foot lock and no label of a controller counts: contact is what the detector of
`gambol.controllers.body.contact` sees in the final pose, at the height of flat stance and slow.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from gambol.controllers.body import (Skeleton, contact_height, contact_points, detect_contacts, foot_drift,
                                     forward_kinematics)
from gambol.controllers.locomotion import ACCELERATION_RATE, joint_acceleration

from ..world import DT, World

GATE = 0.01
"""Higher than this above its place in flat stance [m] no point of a foot counts as standing."""
SHORTEST = 4
"""Contacts of fewer frames are no stances."""
SKATING = 0.2
"""A standing point faster than this along the floor [m/s] skates."""
RUNNING = 1.7
"""Whose hips go faster than this [m/s] is judged as a runner."""
AROUND = 0.5
"""Seconds over which that speed is taken, and before and after a run for which its accelerations are a runner's."""


@dataclass(frozen=True)
class Quality:
    """What was measured of one character over a while.

    seconds: how long. stances: how often a heel or ball stood. drift, worst_drift: how far they
    strayed meanwhile, on average and at most [m]. contacts: frames, each of four points counting, in
    which one stood; skate: the part of them that skated, 0 … 1. sunk: how deep any point went below
    the floor [m]. acceleration: the largest of any joint over the 99th percentile of that joint in
    motion capture, and joint: whose; NaN and "" where that is not known.
    """

    seconds: float = 0.0
    stances: int = 0
    drift: float = 0.0
    worst_drift: float = 0.0
    contacts: int = 0
    skate: float = 0.0
    sunk: float = 0.0
    acceleration: float = float("nan")
    joint: str = ""

    def merged(self, other: Quality) -> Quality:
        """Two stretches of one motion as one."""
        def mean(a, b, m, n):
            return (a * m + b * n) / (m + n) if m + n else 0.0
        rough = other if not self.acceleration >= other.acceleration and other.joint else self
        return Quality(self.seconds + other.seconds, self.stances + other.stances,
                       mean(self.drift, other.drift, self.stances, other.stances),
                       max(self.worst_drift, other.worst_drift), self.contacts + other.contacts,
                       mean(self.skate, other.skate, self.contacts, other.contacts), max(self.sunk, other.sunk),
                       rough.acceleration, rough.joint)


def measure(skeleton: Skeleton, positions: np.ndarray, orientations: np.ndarray, dt: float,
            natural: Mapping[str, np.ndarray] | None = None) -> Quality:
    """The quality of N poses dt seconds apart.

    positions, orientations: (N, J, 3) [m], (N, J, 3, 3) of the skeleton's joints in a world whose
    floor is at height 0. natural: by family, "walk" and "run", (J,) [m/s²] what motion capture stays
    below in 99 of 100 frames, as `Library.accelerations` has it. ValueError for dt ≤ 0 or shapes
    that do not fit.
    """
    positions, orientations = np.asarray(positions, float), np.asarray(orientations, float)
    joints = len(skeleton)
    if not dt > 0.0 or positions.shape[1:] != (joints, 3) or orientations.shape != positions.shape + (3,):
        raise ValueError(f"poses of {joints} joints a positive time apart are wanted, got positions "
                         f"{positions.shape}, orientations {orientations.shape}, dt {dt}")
    if len(positions) < 2:
        return Quality(seconds=len(positions) * dt)
    runs = running(positions[:, 0], dt)
    points = contact_points(skeleton, positions, orientations)
    # from each frame to the next: what a viewer sees as a slide
    step = np.diff(points, axis=0, append=points[-1:]) / dt
    rest = contact_height(skeleton)
    walking, fast = (detect_contacts(points[..., 1], np.linalg.norm(step, axis=-1), height_gate=rest + GATE,
                                     release=1.0, running=r) for r in (False, True))
    standing = np.where(runs[:, None], fast, walking)
    standing[-1] = False  # nothing tells how fast the last one is
    sliding = np.linalg.norm(step[..., [0, 2]], axis=-1)[standing] > SKATING
    stances = foot_drift(points, standing)
    drift = stances.drift[stances.stop - stances.start >= SHORTEST]
    acceleration, joint = _roughest(skeleton, positions, runs, dt, natural)
    return Quality(len(positions) * dt, len(drift), float(drift.mean()) if len(drift) else 0.0,
                   float(drift.max(initial=0.0)), int(standing.sum()), float(sliding.mean()) if len(sliding) else 0.0,
                   max(0.0, rest - float(points[..., 1].min())), acceleration, joint)


def quality_of(worlds: Sequence[World], who: int) -> Quality:
    """The quality of character `who` over worlds one step apart."""
    controller, poses = worlds[-1].characters[who].controller, [world.characters[who].state.pose for world in worlds]
    posed = forward_kinematics(controller.skeleton, np.array([pose.root for pose in poses], float),
                               np.array([pose.rotations for pose in poses], float))
    natural = controller.library and controller.library.accelerations
    return measure(controller.skeleton, *posed, DT, natural)


def running(hips: np.ndarray, dt: float) -> np.ndarray:
    """In which of N frames the hips (N, 3) [m] are a runner's, (N,) bool; N ≥ 2."""
    frames = max(1, round(AROUND / dt))
    from scipy.ndimage import uniform_filter1d  # here, as below: a game starts without

    velocity = uniform_filter1d(np.gradient(hips[:, [0, 2]], dt, axis=0), frames, axis=0)
    return np.linalg.norm(velocity, axis=-1) > RUNNING


def _roughest(skeleton: Skeleton, positions: np.ndarray, runs: np.ndarray, dt: float,
              natural: Mapping[str, np.ndarray] | None) -> tuple[float, str]:
    """The largest acceleration of a joint over what is natural for it, and that joint's name."""
    stride = max(1, round(1 / (ACCELERATION_RATE * dt)))
    if not natural or "walk" not in natural or len(positions) <= 2 * stride:
        return float("nan"), ""
    from scipy.ndimage import maximum_filter1d

    runs = maximum_filter1d(runs, 2 * round(AROUND / dt) + 1)  # who sets off or stops is as rough as who runs
    limit = np.where(runs[:, None], natural.get("run", natural["walk"]), natural["walk"])
    # frames are left out and not averaged, so every phase of the leaving out counts
    over = np.concatenate([joint_acceleration(positions[phase:], dt) / limit[phase::stride][1:-1]
                           for phase in range(stride)])
    joint = int(np.argmax(over.max(0)))
    return float(over[:, joint].max()), skeleton.names[joint]
