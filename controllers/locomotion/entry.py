"""Taking over a body that something else moved: its pose, its motion and its feet as they are.

The pose becomes the blend's own offset, which then fades (inertialisation); the feet that stand
are locked where they stand.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..body import Pose, contact_points, forward_kinematics, log, yaw
from ..contract import CharacterState
from .kernel import COLUMNS, HIPS_AT, LABELS_AT, LANES, series_kernel
from .memory import RUN, WALK

WALKS_ON = 0.35
"""A body that moves faster than this [m/s] walks on; a slower one stands."""
FADE = 0.22
"""Half-life with which the pose that was taken over gives way to the walker's own [s]."""
ABOUT_TO_STEP = 0.95
"""The phase in which both feet stand and the left one is about to leave."""


def entered(locomotion: Any, state: CharacterState) -> CharacterState:
    """The state (no batch axes) of a body that walks or stands on from where it is.

    state: any, with pose, ground, contacts and, if it moves, previous and elapsed. At rest it stands on
    the spot; faster it takes the left foot off next, at the velocity that the state says.
    """
    ground = _under_the_feet(locomotion, state)
    rest = locomotion.start(ground, state.floor)
    memory = rest.memory.copy()
    speed = float(np.hypot(state.velocity[0], state.velocity[2]))
    if speed > WALKS_ON:
        _set_off(locomotion, memory, np.asarray(state.velocity, float))
    shown = _row(locomotion, state.pose, ground, state.floor)
    memory["blend"][:LABELS_AT] = shown - memory["row"][:LABELS_AT]
    memory["row"][:LABELS_AT] = shown
    memory["fade"] = FADE
    if state.previous is not None and state.elapsed > 0.0:
        before = _row(locomotion, state.previous, ground, state.floor)
        rate = (shown - before) / state.elapsed
        rate[[HIPS_AT, HIPS_AT + 2]] = 0.0  # the ground frame moves along the floor, not the hips in it
        memory["blend_rate"][:LABELS_AT] = memory["row_rate"][:LABELS_AT] = np.clip(rate, -12.0, 12.0)
    points = contact_points(locomotion.skeleton, *forward_kinematics(
        locomotion.skeleton, np.asarray(state.pose.root, float), np.asarray(state.pose.rotations, float)))
    points[:, 1] -= state.floor
    c, s = np.cos(ground[2]), np.sin(ground[2])
    aside, ahead = points[:, 0] - ground[0], points[:, 2] - ground[1]
    memory["points"] = np.stack([c * aside - s * ahead, points[:, 1], s * aside + c * ahead], -1)
    stands = np.asarray(state.contacts, bool)
    memory["standing"] = memory["grip"] = stands
    memory["bears"] = memory["grip"][1::2]
    memory["stood"] = points[:, [0, 2]]
    memory["offset"] = memory["offset_rate"] = memory["raised"] = memory["raised_rate"] = 0.0
    return CharacterState(memory["ground"], memory["velocity"], state.pose, stands, memory, state.floor)


def _set_off(locomotion: Any, memory: np.ndarray, velocity: np.ndarray) -> None:
    """Walking or running at a velocity (3,), the left foot about to leave."""
    running = velocity[0] > locomotion.settings.run_above and locomotion.run is not None
    family = "run" if running else "walk"
    space = locomotion.space(family)
    members = locomotion.library.family(family)
    query = space.clamp(velocity)
    memory["weights"] = 0.0
    memory["weights"][members] = space.weights(query)
    memory["family"] = RUN if running else WALK
    memory["command"] = memory["velocity"] = query
    memory["settled"], memory["phase"] = 0, ABOUT_TO_STEP
    row = np.empty(COLUMNS, np.float32)
    series_kernel(locomotion.tables.series, memory["weights"], np.float32(ABOUT_TO_STEP), row)
    memory["row"], memory["stretch"] = row, 1.0


def _under_the_feet(locomotion: Any, state: CharacterState) -> np.ndarray:
    """The ground frame (3,) in which a body at rest has its feet's middle where this body has it."""
    rest = locomotion.start((0.0, 0.0, 0.0))
    ours, theirs = (_middle(locomotion, pose) for pose in (rest.pose, state.pose))
    heading = float(state.ground[2])
    c, s = np.cos(heading), np.sin(heading)
    return np.array([theirs[0] - (c * ours[0] + s * ours[1]), theirs[1] - (-s * ours[0] + c * ours[1]), heading])


def _middle(locomotion: Any, pose: Pose) -> np.ndarray:
    """Where (2,) the middle of the feet is, along x and z."""
    points = contact_points(locomotion.skeleton, *forward_kinematics(
        locomotion.skeleton, np.asarray(pose.root, float), np.asarray(pose.rotations, float)))
    return points[:, [0, 2]].mean(0)


def _row(locomotion: Any, pose: Pose, ground: np.ndarray, floor: np.ndarray | float) -> np.ndarray:
    """A pose as the pose columns of a series row, seen from a ground frame."""
    turn = yaw(-ground[2])
    local = np.array(pose.rotations, float)
    local[0] = turn @ local[0]
    chart = log(np.swapaxes(locomotion.library.reference, -1, -2) @ local)
    row = np.zeros(LABELS_AT)
    for axis in range(3):
        row[axis * LANES:axis * LANES + len(chart)] = chart[:, axis]
    root = np.asarray(pose.root, float) - [ground[0], floor, ground[1]]
    row[HIPS_AT:LABELS_AT] = turn @ root
    return row
