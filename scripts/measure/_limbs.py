"""Limbs as capsules about bones: how deep they are in each other, and in what stands about."""

from __future__ import annotations

import numpy as np

from gambol.controllers.body import forward_kinematics
from gambol.controllers.navigation import gap

LIMBS = {"LeftUpLeg": ("LeftLeg", 0.07), "RightUpLeg": ("RightLeg", 0.07), "LeftLeg": ("LeftFoot", 0.05), "RightLeg": ("RightFoot", 0.05),
         "LeftFoot": ("LeftToe", 0.04), "RightFoot": ("RightToe", 0.04), "LeftArm": ("LeftForeArm", 0.045), "RightArm": ("RightForeArm", 0.045),
         "LeftForeArm": ("LeftHand", 0.035), "RightForeArm": ("RightHand", 0.035), "Hips": ("Spine1", 0.13)}
"""Where each ends, and how thick it is [m]."""
ARMS = np.array(["Arm" in name for name in LIMBS])
PARTS = np.linspace(0.0, 1.0, 5)
"""Places along a bone that are looked at."""
FAR = 0.8
"""What is farther from a body's middle than this [m] none of its limbs touches."""


def ends_of(skeleton, roots: np.ndarray, rotations: np.ndarray) -> np.ndarray:
    """Both ends (N, L, 2, 3) [m] of the limbs of N bodies."""
    names = list(skeleton.names)
    bones = np.array([[names.index(a), names.index(b)] for a, (b, _) in LIMBS.items()])
    return forward_kinematics(skeleton, np.asarray(roots, float), np.asarray(rotations, float))[0][:, bones]


def thickness() -> np.ndarray:
    """The radii (L,) of limbs [m]."""
    return np.array([radius for _, radius in LIMBS.values()])


def limbs_in(skeleton, poses, things) -> tuple[float, str, int, int]:
    """How deep [m] any limb is in things in any of the poses, negative where none is; which is, in which thing, and in which pose."""
    ends = ends_of(skeleton, np.array([pose.root for pose in poses]), np.array([pose.rotations for pose in poses]))
    middle = ends.mean((1, 2))
    found = -np.inf, "", -1, -1
    for number, thing in enumerate(things):
        near = gap(np.column_stack([middle[:, 0], np.full(len(middle), 0.5), middle[:, 2]]), thing) < FAR
        if near.any():
            places = ends[near][..., 0, None, :] + PARTS[:, None] * (ends[near][..., 1, :] - ends[near][..., 0, :])[..., None, :]
            depth = (thickness()[:, None] - gap(places.reshape(-1, 3), thing).reshape(places.shape[:-1])).max(2)
            frame, limb = np.unravel_index(depth.argmax(), depth.shape)
            if depth[frame, limb] > found[0]:
                found = float(depth[frame, limb]), list(LIMBS)[limb], number, int(np.flatnonzero(near)[frame])
    return found


def limb_depths(skeleton, pose, pairs, arms: bool = True) -> np.ndarray:
    """How deep (P,) [m] limbs of pairs (P, 2) of people are in each other, negative where apart. arms: whether arms count."""
    who, which = np.unique(pairs, return_inverse=True)
    which, chosen = which.reshape(pairs.shape), np.flatnonzero(arms | ~ARMS)
    ends, thick = ends_of(skeleton, pose.root[who], pose.rotations[who])[:, chosen], thickness()[chosen]
    one, other = ends[which[:, 0]][:, :, None], ends[which[:, 1]][:, None, :]
    apart = segments_apart(one[..., 0, :], one[..., 1, :], other[..., 0, :], other[..., 1, :])
    return (thick[:, None] + thick[None] - apart).max((1, 2))


def segments_apart(a, b, c, d) -> np.ndarray:
    """How far (...) stretches a to b and c to d, (..., 3) each, are apart [m]: by turns, each one's nearest place to the other."""
    u, v = b - a, d - c
    t = np.full(np.broadcast_shapes(a.shape, c.shape)[:-1], 0.5)
    uu, vv = np.maximum((u * u).sum(-1), 1e-12), np.maximum((v * v).sum(-1), 1e-12)
    for _ in range(6):
        s = np.clip(((a + t[..., None] * u - c) * v).sum(-1) / vv, 0.0, 1.0)
        t = np.clip(((c + s[..., None] * v - a) * u).sum(-1) / uu, 0.0, 1.0)
    return np.linalg.norm(a + t[..., None] * u - c - s[..., None] * v, axis=-1)


def legs_apart(skeleton, roots: np.ndarray, rotations: np.ndarray) -> np.ndarray:
    """How far (N,) [m] the axes of the left and the right leg of N poses are apart, from a third of the thighs down."""
    joints = forward_kinematics(skeleton, np.asarray(roots, float), np.asarray(rotations, float))[0]
    legs = []
    for side in ("Left", "Right"):
        hip, knee, ankle = (joints[:, skeleton.index(side + name)] for name in ("UpLeg", "Leg", "Foot"))
        legs.append(((hip + (knee - hip) / 3.0, knee), (knee, ankle)))
    return np.min([segments_apart(*one, *other) for one in legs[0] for other in legs[1]], 0)
