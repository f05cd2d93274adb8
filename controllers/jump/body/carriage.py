"""How a jumper carries trunk, head and arms: a few angles in time, from wind-up to standing again.

Angles [rad]: `lean` of the pelvis forward; `bend` of the spine; `look`, how far the head is held
up; `swing` of the arms, positive backward; `spread` of the arms from hanging; `elbow`, its bend.
The keys are ours, set by eye beside the counter-movement jumps of the motion capture.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from ...body import Skeleton, exp_kernel
from ...compiled import kernel
from .curves import hermite, monotone

ANGLES = ("lean", "bend", "look", "swing", "spread", "elbow")
STAND = np.radians([2.0, 2.0, 0.0, 2.0, 9.0, 14.0])
CROUCH = np.radians([44.0, 26.0, -30.0, 52.0, 16.0, 22.0])
TAKE_OFF = np.radians([10.0, -6.0, -4.0, -122.0, 18.0, 34.0])
RAISED = np.radians([11.0, -1.0, -5.0, -138.0, 20.0, 37.0])
AIR = np.radians([14.0, 10.0, -6.0, -96.0, 24.0, 44.0])
TOUCH = np.radians([20.0, 14.0, -8.0, -62.0, 26.0, 36.0])
RUNNER_ARMS = np.radians([-76.0, -84.0, -80.0])
"""How far a runner's arms are swung at take-off, a little later and in the middle of the flight."""
LOW_ARMS = np.radians([-22.0, -23.0, -26.0, -30.0])
"""How far arms are swung that something is above or before: the same, and at touch-down."""
SWING = 0.33
"""The arms swing up in no less [s]: they begin before the legs do."""
UNHURRIED = 0.46
"""A runner's arms take as long at least [s], at standard height."""
AFTER = 0.08
"""So long after take-off they are raised highest [s]."""
ABSORB = np.radians([46.0, 26.0, -26.0, -34.0, 30.0, 40.0])

FALL = np.radians([16.0, 12.0, -14.0, -40.0, 62.0, 46.0])
"""Struck in the air: the arms go out to the sides."""


def joints_of(skeleton: Skeleton) -> np.ndarray:
    """The joints that `carry_kernel` turns: three of the spine, neck, head, both arms, both elbows."""
    return np.array([skeleton.index(name) for name in (
        "Spine", "Spine1", "Spine2", "Neck", "Head", "LeftArm", "RightArm", "LeftForeArm", "RightForeArm")])


@kernel
def carry_kernel(angles, joints, local):
    """Write the local rotations of trunk, head and arms for `angles` (6,); the pelvis is not touched."""
    for k in range(3):
        exp_kernel(angles[1] / 3.0, 0.0, 0.0, local[joints[k]])
    for k in range(3, 5):
        exp_kernel(0.5 * angles[2], 0.0, 0.0, local[joints[k]])
    cs, ss = math.cos(angles[3]), math.sin(angles[3])
    for k in range(2):
        sign = 1.0 - 2.0 * k
        down = -sign * (0.5 * math.pi - angles[4])
        c, s = math.cos(down), math.sin(down)
        arm = local[joints[5 + k]]  # about z to hang, then about x to swing
        arm[0, 0], arm[0, 1], arm[0, 2] = c, -s, 0.0
        arm[1, 0], arm[1, 1], arm[1, 2] = cs * s, cs * c, -ss
        arm[2, 0], arm[2, 1], arm[2, 2] = ss * s, ss * c, cs
        exp_kernel(0.0, -sign * angles[5], 0.0, local[joints[7 + k]])


def shapes(crouch: float, absorbing: float, lean: float = 0.0, fold: float = 0.0, running: bool = False, low: bool = False) -> np.ndarray:
    """The keys (8, 6) of a jump: start, lowest point, take-off, a little after it, middle of the flight, touch-down, lowest
    point of the landing, standing.

    crouch, absorbing: how deep before and after, 1 as in CROUCH and ABSORB. lean, fold: [rad] how much
    farther forward it leans at take-off and at touch-down. low: the arms stay down.
    """
    flight = np.array([TAKE_OFF, RAISED, AIR, TOUCH])
    flight[:, 0] += [lean, lean, 0.5 * (lean + fold), fold]
    if running:  # arms that swing against the legs have no time to rise above the head
        flight[:3, 3] = RUNNER_ARMS
    if low:
        flight[:, 3] = LOW_ARMS
    return np.array([STAND, STAND + crouch * (CROUCH - STAND), *flight, _absorbed(absorbing), STAND])


def flying(airtime: float) -> np.ndarray:
    """When (4,) [s] in a flight its keys are due: take-off, a little after it, the middle, touch-down."""
    return np.array([0.0, min(AFTER, 0.2 * airtime), 0.45 * airtime, airtime])


def unhurried(times: np.ndarray, keys: np.ndarray, lasts: float) -> np.ndarray:
    """The keys (8, 6), of which the first are due at `times` (T,), of a runner whose arms swing up from the start on, for so
    long [s], and whose trunk straightens until take-off. A foot strikes late and leaves soon: what waited for the push would
    be torn up."""
    swung = keys.copy()
    for columns, until, target in ((slice(0, 3), times[2], keys[2]), (slice(3, 6), lasts, keys[3])):
        for n in range(1, len(times)):
            if times[n] < until:
                share = times[n] / until
                swung[n, columns] = keys[0, columns] + share**2 * (3.0 - 2.0 * share) * (target - keys[0])[columns]
    return swung


def falling(absorbing: float) -> np.ndarray:
    """The keys (4, 6) of a body that was struck: from the hit to touch-down, lowest point, standing."""
    return np.array([FALL, FALL, _absorbed(absorbing), STAND])


def _absorbed(share: float) -> np.ndarray:
    return STAND + min(max(share, 0.25), 1.1) * (ABSORB - STAND)


def keyed(times: np.ndarray, keys: np.ndarray, first: float = 0.0) -> Callable[[ArrayLike], np.ndarray]:
    """The angles as a function of times within times[0] … times[-1] [s], through `keys` (K, 6) at `times` (K,).

    first: how much sooner [s] the arms come to their second key. Monotone between keys (PCHIP's slopes): nothing
    overshoots; at rest at both ends.
    """
    arms = np.array(times, float)
    arms[1] -= first
    trunk, limbs = _through(np.asarray(times, float), keys[:, :3]), _through(arms, keys[:, 3:])
    return lambda time: np.concatenate([trunk(time), limbs(time)], axis=-1)


def _through(times: np.ndarray, keys: np.ndarray) -> Callable[[ArrayLike], np.ndarray]:
    slopes = monotone(times, keys)
    slopes[[0, -1]] = 0.0
    return partial(hermite, times, keys, slopes)
