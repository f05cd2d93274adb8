"""What stands about somebody who is struck: walls that hold him, treads that feet come down on, edges that he goes over."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..compiled import kernel
from ..navigation import is_box, slope

NOTHING = np.zeros((0, 9))
"""Where nothing stands about: the floor goes on as it is."""
NEAR = 5.0
"""What is farther [m] nobody comes to who is struck."""
STEP = 0.24
"""What lies no farther above or below a foot [m] is a tread; what stands higher is a wall, what lies lower an abyss."""
KEEPS = 0.30
"""A wall keeps a mass centre so far away [m], at standard height."""
STOPS = 0.10
"""Hands and trunk stop a body in so long [s]: towards a wall nobody is faster than the room that is left over this."""
TRUNK = 0.45, 1.5
"""From so high over the floor to so high [m], at standard height, a body meets walls."""


def about(around: Sequence[Any], place: np.ndarray) -> np.ndarray:
    """Boxes, ramps and pillars (K, 9) near a place (2,) x, z [m]: middle x, z, half sizes across and along [m], cosine and sine of the heading, from where to where they reach [m], and
    how they rise along. A pillar's half size across is its radius, that along −1."""
    rows = []
    for thing in around:
        if is_box(thing):
            half, rise = [0.5 * float(part) for part in thing.size], float(slope(thing))
            x, y, z = (float(part) for part in thing.centre)
            if math.hypot(x - place[0], z - place[1]) < NEAR + math.hypot(half[0], half[2]):
                rows.append((x, z, half[0], half[2], math.cos(thing.heading), math.sin(thing.heading), y - half[1], y + half[1], rise))
        elif hasattr(thing, "foot") and math.hypot(thing.foot[0] - place[0], thing.foot[2] - place[1]) < NEAR + thing.radius:
            x, y, z = (float(part) for part in thing.foot)
            rows.append((x, z, float(thing.radius), -1.0, 1.0, 0.0, y, y + float(thing.height), 0.0))
    return np.array(rows) if rows else NOTHING


@kernel
def aside_kernel(things, x, z, low, high, out):
    """How far a place is, along the floor, from the nearest thing that stands at heights from `low` to `high` [m]; less than nothing inside. The way (2,) out of it is written.
    A ramp is as high as where it is nearest to a place beside it, and stands in nobody's way who is over it."""
    nearest = math.inf
    out[0], out[1] = 0.0, 0.0
    for k in range(len(things)):
        rises = things[k, 8] != 0.0
        if not rises and (things[k, 6] >= high or things[k, 7] <= low):
            continue
        dx, dz = x - things[k, 0], z - things[k, 1]
        if things[k, 3] < 0.0:
            far = math.hypot(dx, dz)
            gap, ox, oz = far - things[k, 2], dx / max(far, 1e-9), dz / max(far, 1e-9)
        else:
            c, s = things[k, 4], things[k, 5]
            left, ahead = c * dx - s * dz, s * dx + c * dz
            a, b = abs(left) - things[k, 2], abs(ahead) - things[k, 3]
            if rises:
                rise = things[k, 8] * min(max(ahead, -things[k, 3]), things[k, 3])
                if max(a, b) <= 0.0 or things[k, 6] + rise >= high or things[k, 7] + rise <= low:
                    continue
            sa, sb = math.copysign(1.0, left), math.copysign(1.0, ahead)
            if a > 0.0 and b > 0.0:
                gap = math.hypot(a, b)
                na, nb = sa * a / gap, sb * b / gap
            elif a > b:
                gap, na, nb = a, sa, 0.0
            else:
                gap, na, nb = b, 0.0, sb
            ox, oz = c * na + s * nb, c * nb - s * na
        if gap < nearest:
            nearest, out[0], out[1] = gap, ox, oz
    return nearest


@kernel
def filled_kernel(things, x, z, low, high):
    """Whether a ramp fills a place it lies over at heights from `low` to `high` [m]: nobody stands inside one."""
    for k in range(len(things)):
        if things[k, 8] == 0.0:
            continue
        dx, dz = x - things[k, 0], z - things[k, 1]
        left, ahead = things[k, 4] * dx - things[k, 5] * dz, things[k, 5] * dx + things[k, 4] * dz
        rise = things[k, 8] * ahead
        if abs(left) <= things[k, 2] and abs(ahead) <= things[k, 3] and things[k, 6] + rise < high and things[k, 7] + rise > low:
            return True
    return False


@kernel
def tread_kernel(things, x, z, below, floor):
    """How high the ground lies at a place [m]: the highest top no higher than `below`, or the world's floor; `floor` where nothing stands about."""
    if len(things) == 0:
        return floor
    height = 0.0
    for k in range(len(things)):
        if things[k, 3] < 0.0:
            continue
        dx, dz = x - things[k, 0], z - things[k, 1]
        left, ahead = things[k, 4] * dx - things[k, 5] * dz, things[k, 5] * dx + things[k, 4] * dz
        if abs(left) <= things[k, 2] and abs(ahead) <= things[k, 3]:
            top = things[k, 7] + things[k, 8] * ahead
            if height < top <= below:
                height = top
    return height


@kernel
def abyss_kernel(things, x, z, level):
    """Whether the ground ends at a place: it is deeper than a step below `level` [m], and nothing stands there."""
    out = np.empty(2)
    if tread_kernel(things, x, z, level + STEP, level) >= level - STEP or filled_kernel(things, x, z, level - 0.1, level + 0.1):
        return False
    return aside_kernel(things, x, z, level - 0.1, level + 0.1, out) > 0.0


@kernel
def hold_kernel(things, floor, size, x, v):
    """Slow a mass centre at x (2,) down, in place, that goes with v (2,) [m/s] towards a wall: hands and trunk hold it there."""
    if len(things) == 0:
        return
    out = np.empty(2)
    room = aside_kernel(things, x[0], x[1], floor + TRUNK[0] * size, floor + TRUNK[1] * size, out) - KEEPS * size
    into = -(v[0] * out[0] + v[1] * out[1]) - max(room, 0.0) / STOPS
    if into > 0.0:
        v[0] += into * out[0]
        v[1] += into * out[1]


@kernel
def point_kernel(things, floor, size, x, v, rate, point):
    """Write the capture point (2,) of a mass centre at x (2,) that goes with v (2,): x + v/ω, no farther than to a wall."""
    out, was = np.empty(2), -math.inf
    for part in range(9):
        share = part / 8.0 if len(things) else 1.0
        px, pz = x[0] + share * v[0] / rate, x[1] + share * v[1] / rate
        if len(things):
            room = aside_kernel(things, px, pz, floor + TRUNK[0] * size, floor + TRUNK[1] * size, out)
            if part and room < KEEPS * size and room < was:
                return
            was = room
        point[0], point[1] = px, pz


@kernel
def stands_kernel(things, body, x, z, yaw, level):
    """How high [m] the ground lies under the ball of a sole at x, z that points to `yaw` [rad]; NaN where that is no step from `level` [m], something stands there, or is higher under heel
    or tip. Over an edge are no more than one of them."""
    height = tread_kernel(things, x, z, level + STEP * body.size, level)
    if height < level - STEP * body.size:
        return math.nan
    out, s, c, over = np.empty(2), math.sin(yaw), math.cos(yaw), 0
    for along in (body.heel[2] - body.toe[2], 0.0, body.tip[2]):
        px, pz = x + along * s, z + along * c
        higher = tread_kernel(things, px, pz, level + STEP * body.size, level) - height
        if higher < -0.05 * body.size:
            over += 1
        if higher > 0.05 * body.size or over > 1:
            return math.nan
        low, high = height + 0.06 * body.size, height + 0.3 * body.size
        if aside_kernel(things, px, pz, low, high, out) < 0.055 * body.size or filled_kernel(things, px, pz, low, high):
            return math.nan
    return height


@kernel
def place_kernel(things, body, side, feet, heading, over, target):
    """Bring a foot (4,) ball x, z [m], yaw [rad], height [m] that is set down to where it stands whole, on the same side of the other, as near as can be. Where there is no such place it comes
    down where it stood; if it may go `over` an edge, where it was to, as high as the other. Whether that is over an edge."""
    level = feet[1 - side, 3]
    target[3] = level
    if len(things) == 0:
        return False
    own, c, s = 1.0 - 2.0 * side, math.cos(heading), math.sin(heading)
    if own * (c * (target[0] - feet[1 - side, 0]) - s * (target[1] - feet[1 - side, 1])) < 0.0:  # it crosses
        own = -own
    for ring in range(9):
        for turn in range(1 if ring == 0 else 16):
            angle = turn * math.pi / 8.0
            x, z = target[0] + 0.05 * ring * math.sin(angle), target[1] + 0.05 * ring * math.cos(angle)
            if ring > 0 and own * (c * (x - feet[1 - side, 0]) - s * (z - feet[1 - side, 1])) < 0.11 * body.size:
                continue
            height = stands_kernel(things, body, x, z, target[2], level)
            if not math.isnan(height):
                target[0], target[1], target[3] = x, z, height
                return False
    if over and abyss_kernel(things, target[0], target[1], level):
        return True
    target[:] = feet[side]
    if abs(target[3] - level) > STEP * body.size:
        target[3] = level
    return False
