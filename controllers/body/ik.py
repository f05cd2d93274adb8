"""Two-bone inverse kinematics: a hip, a knee and an ankle, solved in closed form.

The law of cosines gives the bend, the pole says to which side. A target out of reach gives the
nearest point in reach, never a NaN: the distance is clamped to [|l1 − l2| + ε, l1 + l2 − buffer]
(a small buffer also keeps the knee from popping as it straightens; Kovar 2002).
"""

from __future__ import annotations

import math

import numpy as np

from ..compiled import kernel

EPSILON = 1e-5
"""The least distance kept from both ends of the reach, as a share of l1 + l2."""


def two_bone(root: np.ndarray, mid: np.ndarray, end: np.ndarray, target: np.ndarray,
             pole: np.ndarray | None = None, *, buffer: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Where the middle and end joints go, both (..., 3) [m], so that the end meets the target.

    root, mid, end: (..., 3) [m] the limb as it stands; its bones keep their lengths.
    target: (..., 3) [m] where the end should be. buffer: how far short of straight it stays [m].
    pole: (..., 3) the direction to which the middle joint bends, any length; by default where it
    points now, which an all but straight limb hardly tells: pass one there.
    All broadcast. The result has the float type of the inputs together, float64 for integers.
    """
    if pole is None:
        pole = pole_of(root, mid, end)
    arrays = [np.asarray(a) for a in (root, mid, end, target, pole)]
    dtype = np.result_type(*arrays)
    dtype = dtype if dtype.kind == "f" else np.dtype(float)
    arrays = np.broadcast_arrays(*arrays)
    shape = arrays[0].shape
    if shape[-1:] != (3,):
        raise ValueError(f"joints and target must be (..., 3), together they are {shape}")
    flat = [np.ascontiguousarray(a, dtype).reshape(-1, 3) for a in arrays]
    new_mid, new_end = np.empty_like(flat[0]), np.empty_like(flat[0])
    _two_bones(*flat, dtype.type(buffer), new_mid, new_end)
    return new_mid.reshape(shape), new_end.reshape(shape)


def two_bone_turns(root: np.ndarray, mid: np.ndarray, end: np.ndarray, target: np.ndarray,
                   pole: np.ndarray | None = None, *, buffer: float = 0.0
                   ) -> tuple[np.ndarray, np.ndarray]:
    """The world rotations (..., 3, 3) of the upper and the lower bone that two_bone implies.

    Multiply each from the left onto its joint's world orientation. Arguments as in `two_bone`;
    the pole is where the middle joint faces now, and it goes on facing there. Both bones keep
    the same hinge axis in their own frames, so a hinge stays a hinge: the frame of bone and hinge
    is carried over, not the bone alone.
    """
    here = pole_of(root, mid, end) if pole is None else pole
    new_mid, new_end = two_bone(root, mid, end, target, here, buffer=buffer)
    before = np.cross(here, end - root)
    after = np.cross(here, new_end - root)
    upper = _frame(new_mid - root, after) @ _swap(_frame(mid - root, before))
    lower = _frame(new_end - new_mid, after) @ _swap(_frame(end - mid, before))
    return upper, lower


def pole_of(root: np.ndarray, mid: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Where the middle joint points (..., 3) [m]: its distance vector from the line root–end."""
    line = np.asarray(end) - root
    along = np.sum((mid - root) * line, -1, keepdims=True)
    return mid - root - line * along / np.maximum(np.sum(line * line, -1, keepdims=True), 1e-12)


def _frame(bone, hinge):
    """Orthonormal frames (..., 3, 3) whose first column is the bone, the second near the hinge."""
    x = bone / np.linalg.norm(bone, axis=-1, keepdims=True)
    y = hinge - x * np.sum(x * hinge, -1, keepdims=True)
    size = np.linalg.norm(y, axis=-1, keepdims=True)
    spare = np.cross(x, np.eye(3)[np.argmin(np.abs(x), -1)])
    y = np.where(size > 1e-9, y / np.maximum(size, 1e-12), spare / np.linalg.norm(spare, axis=-1, keepdims=True))
    return np.stack([x, y, np.cross(x, y)], -1)


def _swap(matrix):
    return np.swapaxes(matrix, -1, -2)


@kernel
def two_bone_kernel(root, upper, lower, target, pole, buffer, mid, end):
    """Write the middle and end joint (3,) [m] of a limb with bones `upper` and `lower` [m] long.

    root, target, pole: (3,) as in `two_bone`. A pole along the limb, or a target on the root,
    leaves the side open: any perpendicular then serves.
    """
    total = upper + lower
    dx, dy, dz = target[0] - root[0], target[1] - root[1], target[2] - root[2]
    distance = math.sqrt(dx * dx + dy * dy + dz * dz)
    if distance < 1e-9:  # no direction at all: straight down
        dx, dy, dz = 0.0, -1.0, 0.0
    else:
        dx, dy, dz = dx / distance, dy / distance, dz / distance
    least = min(abs(upper - lower) + EPSILON * total, total)
    most = max(total - max(buffer, EPSILON * total), least)
    distance = min(max(distance, least), most)
    dot = pole[0] * dx + pole[1] * dy + pole[2] * dz
    px, py, pz = pole[0] - dot * dx, pole[1] - dot * dy, pole[2] - dot * dz
    size = math.sqrt(px * px + py * py + pz * pz)
    if size < 1e-9:
        ax, ay, az = abs(dx), abs(dy), abs(dz)
        if az <= ax and az <= ay:
            px, py, pz = -dz * dx, -dz * dy, 1.0 - dz * dz
        elif ax <= ay:
            px, py, pz = 1.0 - dx * dx, -dx * dy, -dx * dz
        else:
            px, py, pz = -dy * dx, 1.0 - dy * dy, -dy * dz
        size = math.sqrt(px * px + py * py + pz * pz)
    along = (upper * upper - lower * lower + distance * distance) / (2.0 * distance)
    aside = math.sqrt(max(upper * upper - along * along, 0.0)) / size
    mid[0] = root[0] + along * dx + aside * px
    mid[1] = root[1] + along * dy + aside * py
    mid[2] = root[2] + along * dz + aside * pz
    end[0], end[1], end[2] = root[0] + distance * dx, root[1] + distance * dy, root[2] + distance * dz


@kernel
def _two_bones(root, mid, end, target, pole, buffer, new_mid, new_end):
    for n in range(len(root)):
        upper = math.sqrt((mid[n, 0] - root[n, 0]) ** 2 + (mid[n, 1] - root[n, 1]) ** 2
                          + (mid[n, 2] - root[n, 2]) ** 2)
        lower = math.sqrt((end[n, 0] - mid[n, 0]) ** 2 + (end[n, 1] - mid[n, 1]) ** 2
                          + (end[n, 2] - mid[n, 2]) ** 2)
        two_bone_kernel(root[n], upper, lower, target[n], pole[n], buffer, new_mid[n], new_end[n])


@kernel
def distance_kernel(a, b):
    """How far apart two places (3,) are."""
    return math.sqrt((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2)
