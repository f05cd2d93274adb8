"""Feet keep on their body's side of what is too high to step on: where they come down, and on their way there."""

from __future__ import annotations

import math

from ..compiled import kernel
from ..navigation.passing import STEP

BESIDE = 0.05
"""A foot's centre line keeps so far from what stands beside it [m]: half a shoe's width."""
FAR = 1.2
"""What is farther from a body's middle than this [m] no foot gets to."""
PASSED = 0.5
"""What hangs so much higher than a foot stands is passed under by it [m]."""
EDGE = 0.04
"""Right before something is so far from it [m]."""
MOST = 0.8
"""No foot goes farther aside than this [m]: before that a leg would rather touch something."""


@kernel
def out_of_walls(m, tops, floor, foot, line, out):
    """Write into `out` (2,) how far x, z in the world [m] a foot with a centre line (3, 2) must go to be clear of all tops that are too high for a step, never
    through them to their far side, nor out of one into another, and no farther than MOST; whether it must."""
    stands, found = max(m.base[1 - foot], m.left[foot]), False
    out[0] = out[1] = 0.0
    for k in range(tops.shape[0]):
        across, along = _within(tops, k, m.ground[0], m.ground[1])
        if not ((_reaches_in(tops, k, line, out[0], out[1], BESIDE) or _lies_behind(tops, k, line, out[0], out[1], across, along))
                and _is_wall(m, tops, floor, stands, k)):
            continue
        c, s = tops[k, 2], tops[k, 3]
        beside, before = abs(across) - tops[k, 4], abs(along) - tops[k, 5]
        least, free, way_across, way_along = MOST, False, 0.0, 0.0
        for side in range(4):  # out to the left and right, and by both ends, but not beyond
            sign = 1.0 - 2.0 * (side % 2)
            if (beside > 0.0 and sign * across < 0.0) if side < 2 else (before > 0.0 and sign * along < 0.0):
                continue
            need = 0.0
            for i in range(3):  # of what lies within, or on the far side
                u, w = _within(tops, k, line[i, 0] + out[0], line[i, 1] + out[1])
                if abs(w) < tops[k, 5] + BESIDE if side < 2 else abs(u) < tops[k, 4] + BESIDE:
                    need = max(need, (tops[k, 4] - sign * u if side < 2 else tops[k, 5] - sign * w) + BESIDE)
            if not 0.0 < need < MOST:
                continue
            u, w = (sign * need, 0.0) if side < 2 else (0.0, sign * need)
            clear = _clear(m, tops, floor, stands, line, out[0] + c * u + s * w, out[1] - s * u + c * w)
            if clear and not free or clear == free and need < least:
                least, free, way_across, way_along = need, clear, u, w
        if least < MOST:
            out[0] += c * way_across + s * way_along
            out[1] += -s * way_across + c * way_along
            found = True
    return found


@kernel
def _within(tops, k, x, z):
    """How far across and along from top k's middle a place in the world lies [m]."""
    dx, dz = x - tops[k, 0], z - tops[k, 1]
    return tops[k, 2] * dx - tops[k, 3] * dz, tops[k, 3] * dx + tops[k, 2] * dz


@kernel
def _reaches_in(tops, k, line, x, z, beside):
    """Whether a centre line (3, 2), moved by x, z [m], comes nearer to top k than that [m]."""
    for i in range(3):
        u, w = _within(tops, k, line[i, 0] + x, line[i, 1] + z)
        if abs(u) < tops[k, 4] + beside and abs(w) < tops[k, 5] + beside:
            return True
    return False


@kernel
def _lies_behind(tops, k, line, x, z, across, along):
    """Whether a centre line (3, 2), moved by x, z [m], lies on the far side of top k, as seen from a place across and along from its middle [m]: of a thin wall a foot might
    else come down beyond."""
    for i in range(3):
        u, w = _within(tops, k, line[i, 0] + x, line[i, 1] + z)
        if u * across < 0.0 and min(abs(u), abs(across)) > tops[k, 4] and abs(along + across / (across - u) * (w - along)) < tops[k, 5]:
            return True
        if w * along < 0.0 and min(abs(w), abs(along)) > tops[k, 5] and abs(across + along / (along - w) * (u - across)) < tops[k, 4]:
            return True
    return False


@kernel
def _clear(m, tops, floor, stands, line, x, z):
    """Whether a centre line (3, 2), moved by x, z [m], lies in no wall."""
    for i in range(tops.shape[0]):
        if _reaches_in(tops, i, line, x, z, 0.0) and _is_wall(m, tops, floor, stands, i):
            return False
    return True


@kernel
def _is_wall(m, tops, floor, stands, k):
    """Whether top k is too high to step on for feet that stand so high over the floor [m], and neither above them, below their body nor far away.
    A ramp is as high as where it is nearest to the body."""
    across, along = _within(tops, k, m.ground[0], m.ground[1])
    rise = tops[k, 7] * min(max(along, -tops[k, 5]), tops[k, 5])
    if tops[k, 6] + rise - floor <= stands + STEP or tops[k, 8] + rise - floor > stands + PASSED:
        return False
    return 0.0 < max(abs(across) - tops[k, 4], abs(along) - tops[k, 5]) <= FAR and not _stepped_onto(tops, k, across, along, tops[k, 6] + rise)


@kernel
def _stepped_onto(tops, k, across, along, top):
    """Whether somebody whose middle is across and along in top k's frame [m] has something right before it, on the straight way to him, that is no more than
    a step lower than it is there [m], as on stairs; or as high, where it is a ramp that goes on from there."""
    u, w = min(max(across, -tops[k, 4]), tops[k, 4]), min(max(along, -tops[k, 5]), tops[k, 5])
    far = math.hypot(across - u, along - w)
    u, w = u + EDGE / far * (across - u), w + EDGE / far * (along - w)
    c, s = tops[k, 2], tops[k, 3]
    x, z = tops[k, 0] + c * u + s * w, tops[k, 1] - s * u + c * w
    for i in range(tops.shape[0]):
        u, w = _within(tops, i, x, z)
        high = tops[i, 6] + tops[i, 7] * w
        if abs(u) <= tops[i, 4] and abs(w) <= tops[i, 5] and top - STEP <= high < (top + EDGE if tops[k, 7] != 0.0 else top):
            return True
    return False
