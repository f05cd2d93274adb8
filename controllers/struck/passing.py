"""How a foot that swings gets past the one that stands. Legs hang from one pelvis: a foot may come to the other's far side before it or behind it, but gets from there to its own side
only as it came, since else one leg would go through the other."""

from __future__ import annotations

import math

import numpy as np

from ..body import Skeleton, forward_kinematics
from ..compiled import kernel

ROOM = 0.28, 0.13
"""A ball passes the other so far before or behind it, and so far beside it [m], at standard height: feet are that long, and shins lean."""
PACES = 4.4, 5.4, 6.8
"""A foot swings no faster than the first [m/s] in the mean, at standard height, 8 m/s at its fastest; who would fall for that, or put a leg through the other, is as much faster as he must."""
EARLIEST, LATEST = 0.3, 0.7
"""The share of its straight way at which a foot is farthest out of it is between these."""


@kernel
def past_kernel(begin, end, other, own, heading, size, out):
    """Write by how much (2,) x, z [m] a foot swings out of its straight way from `begin` to `end` (2,), so that its ball has room past the other (2,); at which share of that it is out most.
    own: 1 of a left foot, −1 of a right one. Seen from the other, in units of the room before and beside it, legs would go through each other on the line from 0 to the far side."""
    c, s = math.cos(heading), math.sin(heading)
    x, z = begin[0] - other[0], begin[1] - other[1]
    a, l = (s * x + c * z) / (ROOM[0] * size), own * (c * x - s * z) / (ROOM[1] * size)  # noqa: E741
    x, z = end[0] - other[0], end[1] - other[1]
    to_a, to_l = (s * x + c * z) / (ROOM[0] * size), own * (c * x - s * z) / (ROOM[1] * size)
    far = math.hypot(to_a - a, to_l - l)
    out[0] = out[1] = 0.0
    if far < 1e-6:
        return 0.5
    along_a, along_l = (to_a - a) / far, (to_l - l) / far
    side = 1.0 if along_a >= 0.0 else -1.0  # by its own side
    if l < 0.0 <= to_l:  # as it came: behind, or before
        side = 1.0 if a < 0.0 else -1.0
    elif to_l < 0.0 <= l:
        side = 1.0 if to_a > 0.0 else -1.0
    elif l < 0.0 and a * to_a > 0.0:
        side = math.copysign(1.0, -along_l * a)
    across_a, across_l = -side * along_l, side * along_a
    lacks = max(1.0 - (a * across_a + l * across_l), 0.0)
    share = -(a * along_a + l * along_l) / far
    if not 0.0 < share < 1.0 or lacks == 0.0:
        return 0.5
    ahead, left = lacks * across_a * ROOM[0] * size, own * lacks * across_l * ROOM[1] * size
    vx, vz = share * (end[0] - begin[0]) + s * ahead + c * left, share * (end[1] - begin[1]) + c * ahead - s * left  # the place where it passes
    there = math.hypot(vx, vz)
    share = min(max(there / (there + math.hypot(end[0] - begin[0] - vx, end[1] - begin[1] - vz)), EARLIEST), LATEST)
    out[0], out[1] = vx - share * (end[0] - begin[0]), vz - share * (end[1] - begin[1])
    return share


@kernel
def length_kernel(begin, end, other, own, heading, size):
    """How long [m] the way of a foot is from `begin` to `end` (2,) past the other (2,), see `past_kernel`."""
    out = np.empty(2)
    share = past_kernel(begin, end, other, own, heading, size, out)
    x, z = share * (end[0] - begin[0]) + out[0], share * (end[1] - begin[1]) + out[1]
    return math.hypot(x, z) + math.hypot(end[0] - begin[0] - x, end[1] - begin[1] - z)


def out_of_way(share: np.ndarray, most: float) -> np.ndarray:
    """How far (K,) a foot is out of its straight way after shares of it, 1 at `most`: q^α (1 − q)^β, of which neither is below 1, so that it leaves and lands as smoothly as it goes."""
    rises, sinks = max(1.0, most / (1.0 - most)), max(1.0, (1.0 - most) / most)
    return share**rises * (1.0 - share) ** sinks / (most**rises * (1.0 - most) ** sinks)


def legs_apart(skeleton: Skeleton, roots: np.ndarray, local: np.ndarray) -> float:
    """How near [m] the axes of one leg, from a third of its thigh down, come to those of the other in poses (N, 3), (N, J, 3, 3): by turns, each one's nearest place to the other."""
    places = forward_kinematics(skeleton, roots, local)[0]
    left, right = (np.stack([places[:, skeleton.index(side + part)] for part in ("UpLeg", "Leg", "Foot", "Toe")], 1) for side in ("Left", "Right"))
    for leg in (left, right):
        leg[:, 0] += (leg[:, 1] - leg[:, 0]) / 3.0
    a, c = left[:, :3, None], right[:, None, :3]
    u, v = np.diff(left, axis=1)[:, :, None], np.diff(right, axis=1)[:, None]
    uu, vv, off, there = (u * u).sum(-1), (v * v).sum(-1), a - c, np.full((len(roots), 3, 3), 0.5)
    for _ in range(4):
        here = np.clip(((off + there[..., None] * u) * v).sum(-1) / vv, 0.0, 1.0)
        there = np.clip(((here[..., None] * v - off) * u).sum(-1) / uu, 0.0, 1.0)
    return float(np.linalg.norm(off + there[..., None] * u - here[..., None] * v, axis=-1).min(initial=np.inf))
