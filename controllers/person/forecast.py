"""What a character will do in the next second if it is asked for the same all the while: its way and its coming footholds.

Controllers are pure functions, so nothing need be guessed: the controller itself is stepped on. Who asks again
with another wish sees both planned anew.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..body import contact_points, forward_kinematics
from ..contract import CharacterState, Controller, Intent

STEP = 1 / 60
"""Seconds a step of a forecast. Steps as long as those that are then made foretell them to rounding; of twice the length they
take half the time, and are off by millimetres in steady walks, by up to 5 cm where a gait changes."""


class Forecast(NamedTuple):
    """The next T steps of a character with leading batch axes, and where its left and right foot come down first in them.

    times: (T,) [s] from now. ground: (..., T, 3) x, z [m], heading [rad]. when: (..., 2) [s] when each foot comes down, NaN of
    one that does not. foothold: (..., 2, 4) x, y, z [m] of its ball as it then stands, and where it points [rad]; NaN likewise.
    """

    times: np.ndarray
    ground: np.ndarray
    when: np.ndarray
    foothold: np.ndarray


def forecast(controller: Controller, state: CharacterState, intent: Intent, seconds: float = 1.0, step: float = STEP) -> Forecast:
    """Step a character ahead for so long [s], in steps of `step` [s]. ValueError for what the controller refuses, or no time."""
    count = round(seconds / step)
    if not count > 0:
        raise ValueError(f"a forecast of {seconds:g} s in steps of {step:g} s has no step")
    states = []
    for _ in range(count):
        state, _ = controller.step(state, intent, step)
        states.append(state)
    positions, orientations = forward_kinematics(
        controller.skeleton, np.stack([np.asarray(s.pose.root, float) for s in states], -2),
        np.stack([np.asarray(s.pose.rotations, float) for s in states], -4))
    points = contact_points(controller.skeleton, positions, orientations)
    points = points.reshape(points.shape[:-2] + (2, 2, 3))  # foot, then heel and ball
    stands = np.stack([s.contacts for s in states], -2)
    stands = np.asarray(stands.reshape(stands.shape[:-1] + (2, 2)).any(-1))
    comes = stands[..., 1:, :] & ~stands[..., :-1, :]
    first = np.where(comes.any(-2), comes.argmax(-2) + 1, count)  # (..., 2), the step at which a foot comes down
    leaves = ~stands & (np.arange(count)[:, None] > first[..., None, :])
    rests = (first + np.where(leaves.any(-2), leaves.argmax(-2), count) - 1) // 2  # the middle of its stance
    at = np.clip(rests, 0, count - 1)[..., None, :, None]
    heel, ball = (np.take_along_axis(points[..., k, :], at, -3)[..., 0, :, :] for k in (0, 1))
    along = ball - heel
    times = step * np.arange(1, count + 1)
    comes = first < count
    foothold = np.concatenate([ball, np.arctan2(along[..., 0], along[..., 2])[..., None]], -1)
    return Forecast(times, np.stack([s.ground for s in states], -2), np.where(comes, times[np.minimum(first, count - 1)], np.nan),
                    np.where(comes[..., None], foothold, np.nan))
