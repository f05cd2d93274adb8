"""Feet that pass each other keep a shoe's width between them.

Blends of turns and diagonals bring a swinging foot nearer to the standing one than any recorded
step. How far it must go aside is told from where the blend wants it, in the standing foot's own
frame: smooth in that place, so that a foot glides along as by a wall.
"""

from __future__ import annotations

import math

import numpy as np

from ..compiled import kernel

WIDTH = 0.09
"""The room that is asked for between the centre lines of two feet side by side [m]; recorded walks have 0.07."""
SOFTNESS = 0.015
"""A foot begins to give way about this much before it comes too near [m] …"""
HALFLIFE = 0.012
"""… and follows what is asked with this half-life [s]: a standing foot lets go of where it was without a jump."""
FADE = 0.15
"""Before a foot's heel and beyond its toes the need for room fades over this length [m]."""
LOW, HIGH = 0.08, 0.16
"""A foot that swings higher than this above the floor passes freely, the more the higher [m]."""


@kernel
def aside_kernel(m, body, foot, height, out):
    """Write into `out` (3,) how far in the world [m] a swinging foot (0 left, 1 right) gives way.

    Nothing while the other foot does not stand.
    """
    out[0], out[1], out[2] = 0.0, 0.0, 0.0
    other = 1 - foot
    if not _stands(m, other) or _stands(m, foot):
        return
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    line = np.empty((2, 2))  # the standing foot's heel and ball, where they are shown
    for i in range(2):
        k = 2 * other + i
        line[i, 0] = m.points[k, 0] + c * m.offset[k, 0] - s * m.offset[k, 2]
        line[i, 1] = m.points[k, 2] + s * m.offset[k, 0] + c * m.offset[k, 2]
    x, z = line[1, 0] - line[0, 0], line[1, 1] - line[0, 1]
    size = math.sqrt(x * x + z * z) + 1e-9
    x, z = x / size, z / size
    length = size + body.toe_end[2]
    side = 1.0 - 2.0 * foot  # the left foot gives way to the left, which is (z, −x)
    heel, ball = m.points[2 * foot], m.points[2 * foot + 1]
    fx, fz = ball[0] - heel[0], ball[2] - heel[2]
    reach = 1.0 + body.toe_end[2] / (math.sqrt(fx * fx + fz * fz) + 1e-9)
    need = 0.0
    for i in range(3):  # heel, ball, end of the toes
        share = 0.0 if i == 0 else 1.0 if i == 1 else reach
        dx, dz = heel[0] + share * fx - line[0, 0], heel[2] + share * fz - line[0, 1]
        along, apart = dx * x + dz * z, side * (dx * z - dz * x)
        beyond = max(-along, along - length)
        room = SOFTNESS * math.log1p(math.exp((WIDTH - apart) / SOFTNESS))
        if apart < 0.0:  # a foot that is wholly on the other side stays there
            room *= _smooth(1.0 + apart / WIDTH)
        need = max(need, _smooth(1.0 - beyond / FADE) * room)
    need *= _smooth((HIGH - min(heel[1], ball[1]) + height) / (HIGH - LOW))
    x, z = need * side * z, -need * side * x
    out[0], out[2] = c * x + s * z, -s * x + c * z


@kernel
def _stands(m, foot):
    return m.standing[2 * foot] == 1 or m.standing[2 * foot + 1] == 1


@kernel
def _smooth(share):
    share = min(max(share, 0.0), 1.0)
    return share * share * (3.0 - 2.0 * share)
