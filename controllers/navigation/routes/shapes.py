"""What stands about, seen from above: rectangles with rounded corners.

A shape is (6,): centre x, z [m], half width and half length [m], heading [rad], radius of the rounding [m]. A pillar is
one of no size, a wall one that is thin.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ...compiled import kernel
from ..obstacles import HEAD, is_box, is_pillar, ramp, span, step_among
THIN = 0.001
"""The end of the ground is a shape so thick [m], and no wall is."""



def shapes_of(around: Sequence[Any], floor: float = 0.0) -> np.ndarray:
    """The shapes (K, 6) of those boxes and pillars that stop somebody who stands on a floor `floor` [m] high.

    What ends no higher than a step or hangs higher than a head stops nobody; nor does a ramp that can be walked.
    """
    found, step = [], step_among(around)
    for thing in around:
        if is_box(thing) and not ramp(thing):
            low, high = span(thing)
            shape = (thing.centre[0], thing.centre[2], 0.5 * thing.size[0], 0.5 * thing.size[2], thing.heading, 0.0)
        elif is_pillar(thing):
            low, high = thing.foot[1], thing.foot[1] + thing.height
            shape = (thing.foot[0], thing.foot[2], 0.0, 0.0, 0.0, thing.radius)
        else:
            continue
        if high > floor + step and low < floor + HEAD:
            found.append(shape)
    return np.array(found, float).reshape(-1, 6)


def ends_ground(shape: np.ndarray) -> bool:
    """Whether a shape is no wall, but where the ground ends: one may stand nearer to it."""
    return bool(shape[2] <= 0.5 * THIN and shape[5] <= 0.0)


@kernel
def distance(x, z, shape, out):
    """The signed distance [m] of a place from a shape; out: (3,) its gradient by x and z, and the level line's curvature [1/m]."""
    c, s = math.cos(shape[4]), math.sin(shape[4])
    dx, dz = x - shape[0], z - shape[1]
    u, w = c * dx - s * dz, s * dx + c * dz
    a, b = abs(u) - shape[2], abs(w) - shape[3]
    su, sw = math.copysign(1.0, u), math.copysign(1.0, w)
    out[2] = 0.0
    if a > 0.0 and b > 0.0:
        far = math.hypot(a, b)
        gu, gw = su * a / far, sw * b / far
        out[2] = 1.0 / far
    elif a > b:
        far, gu, gw = a, su, 0.0
    else:
        far, gu, gw = b, 0.0, sw
    out[0], out[1] = c * gu + s * gw, -s * gu + c * gw
    return far - shape[5]


@kernel
def separation(ax, az, bx, bz, shape):
    """How far a straight stretch from a to b stays from a shape [m]: exact where it stays out of the rectangle, else not above 0."""
    c, s = math.cos(shape[4]), math.sin(shape[4])
    ua, wa = c * (ax - shape[0]) - s * (az - shape[1]), s * (ax - shape[0]) + c * (az - shape[1])
    ub, wb = c * (bx - shape[0]) - s * (bz - shape[1]), s * (bx - shape[0]) + c * (bz - shape[1])
    du, dw = ub - ua, wb - wa
    enters, leaves = 0.0, 1.0
    for p, d, half in ((ua, du, shape[2]), (wa, dw, shape[3])):
        if abs(d) < 1e-15:
            if abs(p) > half:
                enters = 2.0
        else:
            one, other = (-half - p) / d, (half - p) / d
            enters, leaves = max(enters, min(one, other)), min(leaves, max(one, other))
    if enters <= leaves:
        return -shape[5]
    near = min(_outside(ua, wa, shape), _outside(ub, wb, shape))
    square = du * du + dw * dw
    for su in (-1.0, 1.0):
        for sw in (-1.0, 1.0):
            u, w = su * shape[2] - ua, sw * shape[3] - wa
            t = min(max((u * du + w * dw) / square, 0.0), 1.0) if square > 0.0 else 0.0
            near = min(near, math.hypot(u - t * du, w - t * dw))
    return near - shape[5]


@kernel
def _outside(u, w, shape):
    return math.hypot(max(abs(u) - shape[2], 0.0), max(abs(w) - shape[3], 0.0))


@kernel
def clear(ax, az, bx, bz, shapes, clearance):
    """Whether a straight stretch stays so far from all shapes (K, 6)."""
    for k in range(shapes.shape[0]):
        if separation(ax, az, bx, bz, shapes[k]) < clearance:
            return False
    return True
