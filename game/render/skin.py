"""Poses as skinning motions: 22 joints and 8 helpers, as dual quaternions.

The helpers spread twist: where a mocap forearm turns about its own length, flesh near the elbow
turns little and flesh near the wrist fully. `UpperArm0`, `Forearm0` and `Thigh0` swing with their
bone without its twist; `Forearm1` has the hand's twist as well. Their weights (made by
`scripts/build/mannequin.py`) run from one to the next along the limb.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from gambol.controllers.body import human

STANDARD = human()
REST = np.array(STANDARD.offsets, float)  # no kinematics, which the first start ever would have to compile first
for _joint, _parent in enumerate(STANDARD.parents[1:], 1):
    REST[_joint] += REST[_parent]
"""The standard human's joints (22, 3) [m] at T-pose, in which the mesh is modelled."""

_SWINGS = (("LeftArm", 0), ("RightArm", 0), ("LeftForeArm", 0), ("RightForeArm", 0),
           ("LeftUpLeg", 1), ("RightUpLeg", 1))
_HANDS = (("LeftForeArm", "LeftHand"), ("RightForeArm", "RightHand"))
HELPERS = tuple(f"{name}0" for name, _ in _SWINGS) + tuple(f"{name}1" for name, _ in _HANDS)
"""Helper joints by name: a joint's name and 0 (without its twist) or 1 (with the hand's)."""
NAMES = STANDARD.names + HELPERS
"""All joints that vertices may hang on."""

_BONES = np.array([STANDARD.index(name) for name, _ in _SWINGS])
_AXES = np.eye(3)[[axis for _, axis in _SWINGS]]
_FORE = np.array([STANDARD.index(fore) for fore, _ in _HANDS])
_HAND = np.array([STANDARD.index(hand) for _, hand in _HANDS])
AT = np.concatenate([np.arange(len(STANDARD)), _BONES, _FORE])
"""At which of the 22 joints each of `NAMES` sits (30,)."""
PARENTS = np.concatenate([STANDARD.parents, STANDARD.parents[_BONES], _FORE])
"""On which joint each of `NAMES` hangs (30,), -1 for the hips."""


def borrowed() -> tuple[np.ndarray, np.ndarray]:
    """Of each helper the joint whose twist it takes over (8,), -1 for one that leaves its own out, and about which axis (8, 3)."""
    return np.concatenate([np.full(len(_SWINGS), -1), _HAND]), np.concatenate([_AXES, np.tile([1.0, 0.0, 0.0], (len(_HANDS), 1))])


def twist(rotation: np.ndarray, axis: np.ndarray) -> np.ndarray:
    """The part (..., 4) of unit quaternions (..., 4), (x, y, z, w), that turns about `axis` (..., 3)."""
    along = np.sum(rotation[..., :3] * axis, -1, keepdims=True)
    part = np.concatenate([along * axis, rotation[..., 3:]], -1)
    length = np.linalg.norm(part, axis=-1, keepdims=True)
    # half a turn of pure swing leaves the twist open: take none
    return np.where(length > 1e-6, part / np.maximum(length, 1e-12), [0.0, 0.0, 0.0, 1.0])


def multiply(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Quaternion products (..., 4), (x, y, z, w): first b, then a."""
    av, aw, bv, bw = a[..., :3], a[..., 3:], b[..., :3], b[..., 3:]
    return np.concatenate([aw * bv + bw * av + np.cross(av, bv),
                           aw * bw - np.sum(av * bv, -1, keepdims=True)], -1)


def motions(positions: np.ndarray, orientations: np.ndarray, scale: np.ndarray,
            rest: np.ndarray = REST) -> np.ndarray:
    """Dual quaternions (N, 30, 2, 4), float32, real part then dual part, each (x, y, z, w).

    They carry the mesh in T-pose, times scale (N,), onto figures whose joints stand at positions
    (N, 22, 3) [m] with orientations (N, 22, 3, 3). rest: (22, 3) [m] the mesh's joints at T-pose.
    """
    real = turns(orientations)
    shift = positions[:, AT] - rotate(real, rest[AT] * scale[:, None, None])
    dual = 0.5 * multiply(np.concatenate([shift, np.zeros_like(shift[..., :1])], -1), real)
    return np.stack([real, dual], 2).astype(np.float32)


def turns(orientations: np.ndarray) -> np.ndarray:
    """World rotations (N, 30, 4), (x, y, z, w), of joints and helpers from orientations (N, 22, 3, 3)."""
    count, joints = orientations.shape[:2]
    own = Rotation.from_matrix(orientations.reshape(-1, 3, 3)).as_quat().reshape(count, joints, 4)
    parents = own[:, STANDARD.parents[_BONES]]
    local = multiply(conjugate(parents), own[:, _BONES])
    swings = multiply(own[:, _BONES], conjugate(twist(local, _AXES)))
    hands = twist(multiply(conjugate(own[:, _FORE]), own[:, _HAND]), np.array([1.0, 0.0, 0.0]))
    return np.concatenate([own, swings, multiply(own[:, _FORE], hands)], 1)


def rotate(q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Vectors (..., 3) turned by unit quaternions (..., 4)."""
    u, w = q[..., :3], q[..., 3:]
    return v + 2.0 * np.cross(u, np.cross(u, v) + w * v)


def skinned(vertices: np.ndarray, joints: np.ndarray, weights: np.ndarray, motion: np.ndarray,
            scale: float = 1.0) -> np.ndarray:
    """Where one figure's vertices (V, 3) go [m]: what the vertex shader computes, in numpy.

    joints, weights: (V, 4). motion: (30, 2, 4), one figure of `motions`.
    """
    real, dual = motion[joints, 0].astype(float), motion[joints, 1].astype(float)
    side = np.where(np.sum(real * real[:, :1], -1) < 0.0, -1.0, 1.0)
    w = (weights * side)[..., None]
    real, dual = np.sum(real * w, 1), np.sum(dual * w, 1)
    size = np.linalg.norm(real, axis=-1, keepdims=True)
    real, dual = real / size, dual / size
    shift = 2.0 * (real[:, 3:] * dual[:, :3] - dual[:, 3:] * real[:, :3] + np.cross(real[:, :3], dual[:, :3]))
    return rotate(real, vertices * scale) + shift


def conjugate(q: np.ndarray) -> np.ndarray:
    """The inverse (..., 4) of unit quaternions (..., 4)."""
    return q * [-1.0, -1.0, -1.0, 1.0]
