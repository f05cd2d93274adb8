"""Whether somebody who walks or runs has come over an edge, so that no foot can reach ground any more."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ...body import Pose, Skeleton, contact_points, forward_kinematics
from ...navigation import floor_at
from ...navigation.passing import STEP
from ..body import Physique, Start, measures

VOID, BRINK = 0.33, STEP + 0.002
"""A heel or ball that is so high over what lies under it [m] stands on nothing: farther than feet step down; and so does one on a floor so high over that."""
STANDS = 0.1
"""A foot whose ball or heel is no higher over it [m] stands there, however high the floor was that its body was on."""
TOUCHES, SUNK = 0.055, 0.01
"""A ball or heel that is no higher over the ground [m] may still carry its body, where no foot has sunk so far below the floor [m]: it was to stand there."""
STRIDE = np.linspace(0.0, 0.5, 6)
"""Feet come down so far ahead of the mass centre [m]: behind it nobody sets one who does not stop."""


def over_nothing(skeleton: Skeleton, pose: Pose, contacts: np.ndarray, around: Sequence[Any], floor: float, size: float = 1.0) -> bool:
    """Whether a foot that stands, heel or ball (4,), has no floor within a step under either, or under the floor [m] that the body was on:
    feet reach for what lies lower, and stand once they are there. size: of the body, over a standard one's."""
    stands = np.asarray(contacts, bool).reshape(2, 2).any(1)
    feet = _feet(skeleton, pose)
    return bool((stands & (_heights(feet, around, size) > STANDS * size).all(1) & _void(feet, around, floor, size)).any())


def hangs(skeleton: Skeleton, pose: Pose, around: Sequence[Any], size: float = 1.0) -> bool:
    """Whether nothing lies right under the soles of somebody who stands still: what was there is gone. size: of the body, over a standard one's."""
    return bool((_heights(_feet(skeleton, pose), around, size) > STANDS * size).all())


def steps_over(physique: Physique, start: Start, pose: Pose, around: Sequence[Any], floor: float, gravity: np.ndarray) -> bool:
    """Whether no foot of a body that was on a floor so high [m] reaches ground any more: one has gone down past it over nothing, or neither carries the body,
    whose mass centre flies to where nothing lies under its next step."""
    size, feet = physique.size, _feet(physique.skeleton, pose)
    void = _void(feet, around, floor, size)
    sunk = feet[..., 1].max(1) < floor + physique.tables.sole - SUNK * size
    if (sunk & void).any():
        return True
    if (_heights(feet, around, size) < TOUCHES * size).any():
        return False
    g, drop = -float(gravity[1]), float(start.centre[1]) - floor - measures(physique).touch(0.0)
    rise = float(start.velocity[1])
    time = max(rise + math.sqrt(max(rise * rise + 2.0 * g * drop, 0.0)), 0.0) / g
    flat = start.velocity[[0, 2]]
    ahead = flat / max(float(np.hypot(*flat)), 1e-6)
    places = start.centre[[0, 2]] + time * flat + STRIDE[:, None] * size * ahead
    return all(floor - floor_at(x, z, around, floor + VOID * size) > BRINK * size for x, z in places)


def _feet(skeleton: Skeleton, pose: Pose) -> np.ndarray:
    """Heels and balls (2, 2, 3) [m]."""
    return contact_points(skeleton, *forward_kinematics(skeleton, np.asarray(pose.root, float), np.asarray(pose.rotations, float))).reshape(2, 2, 3)


def _heights(feet: np.ndarray, around: Sequence[Any], size: float) -> np.ndarray:
    """How high (2, 2) [m] heels and balls are over what lies under them."""
    return np.array([[y - floor_at(x, z, around, y + STANDS * size) for x, y, z in foot] for foot in feet])


def _void(feet: np.ndarray, around: Sequence[Any], floor: float, size: float) -> np.ndarray:
    """Whether nothing lies within a step under feet (2,), or under the floor that their body was on."""
    return np.array([all(max(y, floor + (VOID - BRINK) * size) - floor_at(x, z, around, y + STANDS * size) > VOID * size for x, y, z in foot) for foot in feet])
