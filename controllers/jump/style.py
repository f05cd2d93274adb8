"""How a jumper carries trunk, head and arms: a few angles in time, from wind-up to standing again.

Angles [rad]: `lean` of the pelvis forward; `bend` of the spine; `look`, how far the head is held
up; `swing` of the arms, positive backward; `spread` of the arms from hanging; `elbow`, its bend.
The keys are ours, set by eye beside the counter-movement jumps of the motion capture.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

from ..body import Skeleton
from ..body.turning import exp_kernel
from ..compiled import kernel

ANGLES = ("lean", "bend", "look", "swing", "spread", "elbow")
STAND = np.radians([2.0, 2.0, 0.0, 2.0, 9.0, 14.0])
CROUCH = np.radians([44.0, 26.0, -30.0, 52.0, 16.0, 22.0])
TAKE_OFF = np.radians([10.0, -6.0, -4.0, -138.0, 18.0, 34.0])
AIR = np.radians([14.0, 10.0, -6.0, -96.0, 24.0, 44.0])
TOUCH = np.radians([20.0, 14.0, -8.0, -62.0, 26.0, 36.0])
RUNNER_ARMS = np.radians([-84.0, -80.0])
"""How far a runner's arms are swung at take-off and in the middle of the flight."""
LOW_ARMS = np.radians([-22.0, -26.0, -30.0])
"""How far arms are swung that something is above or before: at take-off, in the middle of the flight, at touch-down."""
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


def shapes(effort: float, fall: float, running: bool, low: bool = False) -> np.ndarray:
    """The keys (7, 6) of a jump: start, lowest point, take-off, middle of the flight, touch-down, lowest
    point of the landing, standing.

    effort: the velocity that the push gives, fall: the velocity of the landing [m/s]. A runner hardly
    winds up. low: the arms stay down.
    """
    crouch = min(max(effort / 2.8, 0.25), 1.15) * (0.35 if running else 1.0)
    leave, air = TAKE_OFF.copy(), AIR.copy()
    if running:  # arms that swing against the legs have no time to rise above the head
        leave[3], air[3] = RUNNER_ARMS
    flight = np.array([leave, air, TOUCH])
    if low:
        flight[:, 3] = LOW_ARMS
    return np.array([STAND, STAND + crouch * (CROUCH - STAND), *flight, _absorbing(fall), STAND])


def falling(fall: float) -> np.ndarray:
    """The keys (4, 6) of a body that was struck: from the hit to touch-down, lowest point, standing. fall: as above."""
    return np.array([FALL, FALL, _absorbing(fall), STAND])


def _absorbing(fall: float) -> np.ndarray:
    return STAND + min(max(fall / 3.2, 0.25), 1.1) * (ABSORB - STAND)


def keyed(times: np.ndarray, keys: np.ndarray) -> CubicHermiteSpline:
    """The angles as a function of times within times[0] … times[-1] [s], through `keys` (K, 6) at `times` (K,).

    Monotone between keys (PCHIP's slopes): nothing overshoots; at rest at both ends.
    """
    slopes = PchipInterpolator(times, keys).derivative()(times)
    slopes[[0, -1]] = 0.0
    return CubicHermiteSpline(times, keys, slopes)
