"""Where a method's body leaps: it has changed its mind, or knows more. What leaps is not shown; it fades."""

from __future__ import annotations

import math

import numpy as np

from ...body import Pose, Skeleton
from ..control_points import ControlPoints
from ..pose_vector import SKELETON
from .hand_over import joints_of
from .pose_kernels import apart_kernel, missed_kernel

LEAP = 0.03
"""A joint that is farther than this [m] from where its motion leads has leapt …"""
BEYOND = 1.5
"""… unless points swerved themselves: by so many times as far as they did. What they don't tell of swings the farther."""
TAKEN = 0.01
"""How bodies change their pace may be a little of a leap: so much [m] a frame."""
LIMBS = tuple(np.array([SKELETON.index(side + name) for name in names])
              for side in ("Left", "Right") for names in (("Shoulder", "Arm", "ForeArm", "Hand"), ("UpLeg", "Leg", "Foot", "Toe")))
"""A limb on which nothing is followed leaps by itself: a hand that is seen does not go astray because of a foot that is not."""
KEPT, NOISY = 0.03, 2.0
"""What fades carries points that are surely seen no farther from there than they lately were, but for so much [m], and for so many times as far as noise takes them."""
LATELY = 2.0
"""Lately: half as far counts after so many half-lives of what fades."""
TRIES = 4
"""So often what carries too far is shortened, as long as that helps: joints turn, and half of it need not be half as far."""


def led(body: Skeleton, before: Pose, pose: Pose, goes: np.ndarray, step: np.ndarray, went: np.ndarray | None, followed: np.ndarray, allowed: float, swerved: float
        ) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
    """By what (1 + J, 3) a body goes on from the pose before to the next, as it is shown: as it did where it leapt, but for `TAKEN`.

    goes: (1 + J, 3) by what it does, from the one to the other; step: by what it was taken to; went: by what it truly did to the pose before, None where that is not known. followed: joints whose points are followed; swerved: how far
    one of those points got from where its motion led [m]. allowed: within so far [m] nothing leaps.
    Also returns which rows (1 + J,) bool leapt, and what (1 + J, 3) it was taken to go on by beyond what it does: what goes on evenly a second time was no leap, but another pace.
    None where all limbs are followed and nothing leapt.
    """
    there, most, limbs = joints_of(pose, body)[0], allowed + BEYOND * swerved, _free(followed)
    apart = _apart(body, there, before, step)
    if not limbs and apart.max() <= most:
        return None
    none, step, trunk = np.zeros_like(step), step.copy(), np.ones(len(body), bool)
    for limb in limbs:
        trunk[limb] = False
    rows, far = np.append(True, trunk), apart[trunk].max()
    if far > most and went is not None and _apart(body, there, before, went)[trunk].max() <= most:
        none[rows], far = step[rows] - goes[rows], 0.0
    leapt = rows & (far > most)
    step[rows] += (TAKEN / far if far > most else 1.0) * (goes[rows] - step[rows])
    for limb in limbs:
        alone = goes.copy()
        alone[limb + 1] = step[limb + 1]
        far = _apart(body, there, before, alone)[limb].max()
        leapt[limb + 1] = far > allowed
        step[limb + 1] += (TAKEN / far if far > allowed else 1.0) * (goes[limb + 1] - step[limb + 1])
    return step, leapt, none


def kept(body: Skeleton, pose: Pose, offset: np.ndarray, controls: ControlPoints, seen: np.ndarray, most: np.ndarray, followed: np.ndarray, least: float) -> np.ndarray:
    """What is left, `least` to 1, of each row (1 + J, 1) of an offset so that points of a pose are no farther from where they are seen (n, 3) [m], NaN where not, than that (n,) [m],
    if it can be.

    followed: joints whose points are followed. Limbs on which there are none fade by themselves; all else is shortened alike: as a body that is carried somewhere turns
    there and bends, nothing of that is right without the rest.
    """
    rows = np.ones(len(offset), bool)
    for limb in _free(followed):
        rows[limb + 1] = False
    share, tried, worst = 1.0, 1.0, math.inf
    for _ in range(TRIES):
        over = np.fmax.reduce(missed(body, pose, np.where(rows, tried, 1.0)[:, None] * offset, controls, seen) / most)
        if over >= worst:
            break
        share, worst = tried, over
        if over <= 1.0 or share <= least:
            break
        tried = max(share / over, least)
    return np.where(rows, share, 1.0)[:, None]


def missed(body: Skeleton, pose: Pose, by: np.ndarray, controls: ControlPoints, seen: np.ndarray) -> np.ndarray:
    """How far (n,) [m] the points of a pose that is moved by (1 + J, 3) are from where they are seen (n, 3) [m]."""
    out = np.empty(len(seen))
    missed_kernel(body.parents, body.offsets, pose.root, pose.rotations, by, controls.joints, controls.offsets, seen, out)
    return out


def _free(followed: np.ndarray) -> list[np.ndarray]:
    """The limbs on none of whose joints a point is followed."""
    told = set(followed.tolist())
    return [limb for limb in LIMBS if told.isdisjoint(limb.tolist())]


def _apart(body: Skeleton, there: np.ndarray, pose: Pose, by: np.ndarray) -> np.ndarray:
    """How far (J,) [m] the joints of a pose that is moved by (1 + J, 3) are from where they are, (J, 3) [m]."""
    out = np.empty(len(body))
    apart_kernel(body.parents, body.offsets, pose.root, pose.rotations, by, there, out)
    return out
