"""How a jumper carries trunk, head and arms: a few angles in time, from wind-up to standing again.

Angles [rad]: `lean` of the pelvis forward; `bend` of the spine; `look`, how far the head is held down; of each arm how it is
turned from hanging, as a rotation vector, and its elbow's bend. What they are in a jump is fitted to recorded ones, see
`controllers/jump/prior`; the few keys here are those that the thesis's crouch and a body that was struck go by.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache, partial

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from ...body import Skeleton, exp_kernel
from ...compiled import kernel
from .curves import hermite, monotone

ANGLES = ("lean", "bend", "look", "left arm x", "left arm y", "left arm z", "left elbow",
          "right arm x", "right arm y", "right arm z", "right elbow")


def hanging(side: float) -> np.ndarray:
    """An arm (3, 3) that hangs straight down. side: 1 left, −1 right."""
    return np.array([[0.0, side, 0.0], [-side, 0.0, 0.0], [0.0, 0.0, 1.0]])


def posture(lean: float, bend: float, look: float, swing: float, spread: float, elbow: float) -> np.ndarray:
    """The angles (11,) [rad] of a body that carries both arms alike, from degrees: arms swung backward and spread from hanging."""
    arms = []
    for side in (1.0, -1.0):
        turn = Rotation.from_euler("x", swing, degrees=True) * Rotation.from_euler("z", side * spread, degrees=True)
        arms += [*turn.as_rotvec(), math.radians(elbow)]
    return np.array([*np.radians([lean, bend, look]), *arms])


STAND = posture(2.0, 2.0, 0.0, 2.0, 9.0, 14.0)
CROUCH = posture(44.0, 26.0, -30.0, 52.0, 16.0, 22.0)
TAKE_OFF = posture(6.0, 4.0, -4.0, 5.0, 18.0, 55.0)
TOUCH = posture(2.0, 14.0, -8.0, 5.0, 18.0, 45.0)
LOW_ARMS = posture(0.0, 0.0, 0.0, -14.0, 12.0, 50.0)[3:]
"""Arms that something is above or before: close to the body."""
FALL = posture(16.0, 12.0, -14.0, -40.0, 62.0, 46.0)
"""Struck in the air: the arms go out to the sides."""


@lru_cache(maxsize=16)
def joints_of(skeleton: Skeleton) -> np.ndarray:
    """The joints that `carry_kernel` turns: three of the spine, neck, head, both arms, both elbows."""
    return np.array([skeleton.index(name) for name in (
        "Spine", "Spine1", "Spine2", "Neck", "Head", "LeftArm", "RightArm", "LeftForeArm", "RightForeArm")])


@kernel
def carry_kernel(angles, joints, local):
    """Write the local rotations of trunk, head and arms for `angles` (11,); the pelvis is not touched."""
    for k in range(3):
        exp_kernel(angles[1] / 3.0, 0.0, 0.0, local[joints[k]])
    for k in range(3, 5):
        exp_kernel(0.5 * angles[2], 0.0, 0.0, local[joints[k]])
    turn = np.empty((3, 3))
    for k in range(2):
        side, first = 1.0 - 2.0 * k, 3 + 4 * k
        exp_kernel(angles[first], angles[first + 1], angles[first + 2], turn)
        arm = local[joints[5 + k]]
        for i in range(3):  # from hanging, as in `hanging`
            arm[i, 0], arm[i, 1], arm[i, 2] = -side * turn[i, 1], side * turn[i, 0], turn[i, 2]
        exp_kernel(0.0, -side * angles[first + 3], 0.0, local[joints[7 + k]])


def keyed(times: np.ndarray, keys: np.ndarray, moving: bool = False) -> Callable[[ArrayLike], np.ndarray]:
    """The angles as a function of times within times[0] … times[-1] [s], through `keys` (K, 11) at `times` (K,).

    Monotone between keys (PCHIP's slopes): nothing overshoots; at rest at the end, and at the beginning but for who is moving.
    """
    slopes = monotone(times, keys)
    slopes[[-1] if moving else [0, -1]] = 0.0
    return partial(hermite, times, keys, slopes)
