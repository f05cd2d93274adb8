"""Gambol's own skeleton: a standard human, in T-pose, facing +Z, left along +X.

Segment lengths are de Leva's 1996 adult male (1.741 m) where he gives them (thigh, shank, foot,
upper arm, forearm, hand, trunk and head heights); ankle height and the widths of hips and
shoulders are Drillis & Contini's 1966 fractions of stature. Everything scales with height.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from .skeleton import Skeleton

STATURE = 1.741
"""Height [m] of the standard human."""

# joint, parent, world position [m] at T-pose of a 1.741 m adult; the left side only
_MIDLINE_AND_LEFT = (
    ("Hips", "", (0.0, 1.004, 0.0)),
    ("Spine", "Hips", (0.0, 1.080, -0.005)),
    ("Spine1", "Spine", (0.0, 1.210, -0.005)),
    ("Spine2", "Spine1", (0.0, 1.340, -0.010)),
    ("Neck", "Spine2", (0.0, 1.490, -0.015)),
    ("Head", "Neck", (0.0, 1.580, 0.010)),
    ("LeftShoulder", "Spine2", (0.035, 1.425, 0.015)),
    ("LeftArm", "LeftShoulder", (0.180, 1.425, -0.015)),
    ("LeftForeArm", "LeftArm", (0.4617, 1.425, -0.015)),
    ("LeftHand", "LeftForeArm", (0.7306, 1.425, -0.015)),
    ("LeftUpLeg", "Hips", (0.0875, 0.9242, 0.0)),
    ("LeftLeg", "LeftUpLeg", (0.0875, 0.5020, 0.0)),
    ("LeftFoot", "LeftLeg", (0.0875, 0.0680, 0.0)),
    ("LeftToe", "LeftFoot", (0.0875, 0.0200, 0.1250)),
)
_ENDS = (
    ("Head", (0.0, 1.741, 0.020)),
    ("LeftHand", (0.9205, 1.425, -0.015)),
    ("LeftToe", (0.0875, 0.0200, 0.1980)),
)
HEEL = np.array([0.0, -0.048, -0.060])
"""The heel's contact point in the foot's frame [m], at the height of the ball; times height / STATURE."""
CONTACT_HEIGHT = 0.020
"""How high heel, ball and toe stand above the floor in flat stance [m]; times height / STATURE."""


@lru_cache
def human(height: float = STATURE) -> Skeleton:
    """The standard human, 22 joints and 5 end sites, `height` metres tall."""
    joints, ends = [], []
    for name, parent, at in _MIDLINE_AND_LEFT:
        joints.append((name, parent, np.array(at)))
    for name, parent, at in _MIDLINE_AND_LEFT:
        if name.startswith("Left"):
            joints.append((name.replace("Left", "Right"), parent.replace("Left", "Right"),
                           np.array(at) * [-1, 1, 1]))
    for joint, at in _ENDS:
        ends.append((joint, np.array(at)))
        if joint.startswith("Left"):
            ends.append((joint.replace("Left", "Right"), np.array(at) * [-1, 1, 1]))
    joints = _depth_first(joints)
    names = tuple(name for name, _, _ in joints)
    place = {name: at for name, _, at in joints}
    parents = np.array([names.index(parent) if parent else -1 for _, parent, _ in joints])
    offsets = np.stack([at - place[parent] if parent else at for _, parent, at in joints])
    return Skeleton(names, parents, offsets * (height / STATURE),
                    np.array([names.index(joint) for joint, _ in ends]),
                    np.stack([at - place[joint] for joint, at in ends]) * (height / STATURE))


def _depth_first(joints):
    ordered = []

    def visit(parent):
        for joint in joints:
            if joint[1] == parent:
                ordered.append(joint)
                visit(joint[0])
    visit("")
    return ordered
