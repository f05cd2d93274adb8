"""Feet that pass each other keep a shoe's width between them.

Blends of turns and diagonals bring a swinging foot nearer to the standing one than any recorded
step. How far it must go aside is told from where the blend wants it, in the standing foot's own
frame: smooth in that place, so that a foot glides along as by a wall.
"""

from __future__ import annotations

import math

import numpy as np

from ..compiled import kernel
from .foot_points import shown_kernel

WIDTH = 0.09
"""The room that is asked for between the centre lines of two feet side by side [m]; recorded walks have 0.07."""
SOFTNESS = 0.015
"""A foot begins to give way about this much before it comes too near [m] …"""
HALFLIFE, BACK = 0.012, 0.045
"""… and follows what is asked with the first half-life [s]: a standing foot lets go of where it was without a jump; it comes
back with the second …"""
LEAD = 0.025
"""… so that it looks this far ahead, too [s]."""
FADE, WIDELY = 0.1, 0.17
"""Before a foot's heel and beyond its toes the need for room fades over the first length [m], until the middle of a swing over the
second."""
ASTRAY = 0.4
"""A foot this far on the other's side is not called back [m], from half of it on less and less."""
STEEP = 0.08
"""A foot that points down so steeply that its line is shorter than this from above [m] has no sides."""
LOW, HIGH = 0.25, 0.45
"""A foot that swings higher than this above the floor passes freely, the more the higher [m]."""


@kernel
def aside_kernel(m, body, foot, progress, swings, speed_x, speed_z, height, out):
    """Write into `out` (3,) how far in the world [m] a swinging foot (0 left, 1 right) gives way.

    progress: through its swing. swings: whether it is its turn to, though the other foot does not stand either, as in the flight of a run.
    speed_x, speed_z: how fast it goes in the world [m/s].
    """
    out[0], out[1], out[2] = 0.0, 0.0, 0.0
    other = 1 - foot
    if _stands(m, foot) or not (swings or _stands(m, other)):
        return
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    there, here = np.empty((3, 2)), np.empty((3, 2))  # heel, ball and toe's end of the other foot and of this one
    outline_kernel(m, body, other, there)
    outline_kernel(m, body, foot, here)
    for i in range(3):  # without what it gives way already
        here[i, 0] -= c * m.aside[foot, 0] - s * m.aside[foot, 2]
        here[i, 1] -= s * m.aside[foot, 0] + c * m.aside[foot, 2]
    fade = FADE + (WIDELY - FADE) * _smooth(2.0 - 2.5 * progress)
    side = 1.0 - 2.0 * foot  # the left foot gives way to the left, which is (z, −x)
    need = need_of_room(there, here, side, fade)
    for i in range(3):
        here[i, 0] += LEAD * (c * speed_x - s * speed_z)
        here[i, 1] += LEAD * (s * speed_x + c * speed_z)
    need = max(need, need_of_room(there, here, side, fade))
    low = min(m.points[2 * foot, 1], m.points[2 * foot + 1, 1])
    need *= _smooth((HIGH - low + height) / (HIGH - LOW))
    x, z = there[1, 0] - there[0, 0], there[1, 1] - there[0, 1]
    size = math.sqrt(x * x + z * z) + 1e-9
    x, z = need * side * z / size, -need * side * x / size
    out[0], out[2] = c * x + s * z, -s * x + c * z


@kernel
def need_of_room(there, here, side, fade):
    """How far [m] a foot with centre line `here` (3, 2) must still go to that side (1 left, −1 right) of one with the line `there`."""
    need = 0.0
    for i in range(3):
        need = max(need, _room(there, here[i], side, fade), _room(here, there[i], -side, fade))
    return need


@kernel
def away_kernel(there, here, out):
    """Write into `out` (2,) the shortest way x, z by which a foot with centre line `here` (3, 2) comes no nearer than WIDTH to one
    with the line `there`."""
    least = 1e9
    for k in range(4):
        i = 2 * (k // 2)
        point, line, sign = (here[i], there, 1.0) if k % 2 == 0 else (there[i], here, -1.0)
        x, z = line[2, 0] - line[0, 0], line[2, 1] - line[0, 1]
        dx, dz = point[0] - line[0, 0], point[1] - line[0, 1]
        share = min(max((dx * x + dz * z) / (x * x + z * z + 1e-12), 0.0), 1.0)
        dx, dz = sign * (dx - share * x), sign * (dz - share * z)
        far = math.sqrt(dx * dx + dz * dz) + 1e-9
        if far < least:
            least = far
            room = SOFTNESS * math.log1p(math.exp((WIDTH - far) / SOFTNESS)) / far
            out[0], out[1] = room * dx, room * dz


@kernel
def outline_kernel(m, body, foot, out):
    """A foot's centre line as it is shown: heel, ball and toe's end (3, 2) in the ground frame."""
    shown_kernel(m, 2 * foot, out[0])
    shown_kernel(m, 2 * foot + 1, out[1])
    with_toe(body, out)


@kernel
def with_toe(body, out):
    """Add the toe's end to a centre line (3, 2) of which heel and ball are known."""
    x, z = out[1, 0] - out[0, 0], out[1, 1] - out[0, 1]
    share = body.toe_end[2] / max(math.sqrt(x * x + z * z), STEEP)
    out[2, 0], out[2, 1] = out[1, 0] + share * x, out[1, 1] + share * z


@kernel
def _room(line, point, side, fade):
    """How far [m] a point (2,) must still go to that side (1 left, −1 right) of a foot's line (3, 2)."""
    x, z = line[2, 0] - line[0, 0], line[2, 1] - line[0, 1]
    length = math.sqrt(x * x + z * z) + 1e-9
    x, z = x / length, z / length
    dx, dz = point[0] - line[0, 0], point[1] - line[0, 1]
    along, apart = dx * x + dz * z, side * (dx * z - dz * x)
    room = SOFTNESS * math.log1p(math.exp((WIDTH - apart) / SOFTNESS))
    if apart < 0.0:  # a foot that is far on the other side stays there
        room *= _smooth((ASTRAY + apart) / (0.5 * ASTRAY))
    return _smooth(1.0 - max(-along, along - length) / fade) * _smooth(length / STEEP - 1.0) * room


@kernel
def _stands(m, foot):
    return m.standing[2 * foot] == 1 or m.standing[2 * foot + 1] == 1


@kernel
def _smooth(share):
    share = min(max(share, 0.0), 1.0)
    return share * share * (3.0 - 2.0 * share)
