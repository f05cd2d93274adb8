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
    flat, shape, dtype = _flat(root, mid, end, target, pole)
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
    flat, shape, dtype = _flat(root, mid, end, target, pole_of(root, mid, end) if pole is None else pole)
    upper, lower = np.empty((len(flat[0]), 3, 3), dtype), np.empty((len(flat[0]), 3, 3), dtype)
    two_bone_turns_kernel(*flat, dtype.type(buffer), upper, lower)
    return upper.reshape(*shape, 3), lower.reshape(*shape, 3)


def _flat(*places):
    """Places of one type and shape, in rows (N, 3); what they are together, and of which type."""
    arrays = [np.asarray(a) for a in places]
    dtype = np.result_type(*arrays)
    dtype = dtype if dtype.kind == "f" else np.dtype(float)
    shape = np.broadcast_shapes(*(a.shape for a in arrays))
    if shape[-1:] != (3,):
        raise ValueError(f"joints and target must be (..., 3), together they are {shape}")
    return [np.ascontiguousarray(np.broadcast_to(a, shape), dtype).reshape(-1, 3) for a in arrays], shape, dtype


def pole_of(root: np.ndarray, mid: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Where the middle joint points (..., 3) [m]: its distance vector from the line root–end."""
    line = np.asarray(end) - root
    along = np.sum((mid - root) * line, -1, keepdims=True)
    return mid - root - line * along / np.maximum(np.sum(line * line, -1, keepdims=True), 1e-12)


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
def two_bone_turns_kernel(root, mid, end, target, pole, buffer, upper, lower):
    """Write the rotations (N, 3, 3) of `two_bone_turns`."""
    was, now, made = np.empty_like(upper[0]), np.empty_like(upper[0]), np.empty((2, 3), root.dtype)
    for n in range(len(root)):
        _two_bones(root[n:n + 1], mid[n:n + 1], end[n:n + 1], target[n:n + 1], pole[n:n + 1], buffer, made[:1], made[1:])
        before, after = np.cross(pole[n], end[n] - root[n]), np.cross(pole[n], made[1] - root[n])
        for old, new, out in ((mid[n] - root[n], made[0] - root[n], upper[n]), (end[n] - mid[n], made[1] - made[0], lower[n])):
            _frame(old, before, was)
            _frame(new, after, now)
            for i in range(3):
                for k in range(3):
                    out[i, k] = now[i, 0] * was[k, 0] + now[i, 1] * was[k, 1] + now[i, 2] * was[k, 2]


@kernel
def _frame(bone, hinge, frame):
    """Write an orthonormal frame (3, 3) whose first column is the bone, the second near the hinge."""
    x = bone / math.sqrt(bone[0] ** 2 + bone[1] ** 2 + bone[2] ** 2)
    y = hinge - x * (x[0] * hinge[0] + x[1] * hinge[1] + x[2] * hinge[2])
    size = math.sqrt(y[0] ** 2 + y[1] ** 2 + y[2] ** 2)
    if size <= 1e-9:  # no hinge that would tell: any
        y = np.cross(x, np.eye(3, dtype=x.dtype)[np.argmin(np.abs(x))])
        size = math.sqrt(y[0] ** 2 + y[1] ** 2 + y[2] ** 2)
    frame[:, 0], frame[:, 1] = x, y / size
    frame[:, 2] = np.cross(frame[:, 0], frame[:, 1])


@kernel
def distance_kernel(a, b):
    """How far apart two places (3,) are."""
    return math.sqrt((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2)
