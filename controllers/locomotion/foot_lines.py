"""Centre lines of feet, from heel over ball to toe's end, as seen from above: where they lie, and how far apart.

How far a foot must go aside is told in both feet's own frames: smooth in their places, so that it glides along the other as by a wall.
"""

from __future__ import annotations

import math

from ..compiled import kernel
from .foot_points import shown_kernel
from .minimum_jerk import smooth

WIDTH = 0.09
"""The room that is asked for between the centre lines of two feet side by side [m]; recorded walks have 0.07."""
SOFTNESS = 0.015
"""A foot begins to give way about this much before it comes too near [m]."""
NONE = 5.0
"""… and what is farther by so many times that needs none."""
FADE = 0.1
"""A foot on the other's side is called back the less the farther it is before the other's heel or beyond its toes, up to this length [m]."""
ASTRAY = 0.4
"""A foot this far on the other's side is not called back [m], from half of it on less and less."""
STEEP = 0.08
"""A foot that points down so steeply that its line is shorter than this from above [m] has no sides."""


@kernel
def outline_kernel(m, foot, ahead, height, out):
    """A swinging foot's centre line as it is shown: heel, ball and toe's end (3, 2) in the ground frame."""
    shown_kernel(m, 2 * foot, out[0])
    shown_kernel(m, 2 * foot + 1, out[1])
    toe, c, s = ahead.toe[foot], math.cos(m.offset[foot, 2]), math.sin(m.offset[foot, 2])
    lay_toe(m, foot, c * toe[0] + s * toe[2], toe[1], c * toe[2] - s * toe[0], m.points[2 * foot + 1, 1] - height, out)


@kernel
def standing_line(m, body, foot, out):
    """The centre line of a foot whose toes lie on the floor, as it is shown: heel, ball and toe's end (3, 2) in the ground frame."""
    shown_kernel(m, 2 * foot, out[0])
    shown_kernel(m, 2 * foot + 1, out[1])
    with_toe(body, out)


@kernel
def lay_toe(m, foot, x, y, z, high, line):
    """Add the toe's end to a centre line (3, 2) of which heel and ball are known. x, y, z: from the blend's ball to it; it is bent up about the foot's lateral axis where
    it would be lower than the foot is lifted (`foot_lock`), whose ball is so `high` [m] over where it rests."""
    least = -max(high - m.lift[foot], 0.0)
    if y < least:
        fx, fz = line[1, 0] - line[0, 0], line[1, 1] - line[0, 1]
        far = math.sqrt(fx * fx + fz * fz) + 1e-9
        fx, fz = fx / far, fz / far
        across = x * fz - z * fx
        along = math.sqrt(max(x * x + y * y + z * z - across * across - least * least, 0.0))
        x, z = along * fx + across * fz, along * fz - across * fx
    line[2, 0], line[2, 1] = line[1, 0] + x, line[1, 1] + z


@kernel
def with_toe(body, out):
    """Add the toe's end to a centre line (3, 2) of which heel and ball are known."""
    x, z = out[1, 0] - out[0, 0], out[1, 1] - out[0, 1]
    share = body.toe_end[2] / max(math.sqrt(x * x + z * z), STEEP)
    out[2, 0], out[2, 1] = out[1, 0] + share * x, out[1, 1] + share * z


@kernel
def own_side(there, here, side, out):
    """Write into `out` (2,) which way x, z a foot's own side is (1 left, −1 right), across the lines (3, 2) of both."""
    x = there[1, 0] - there[0, 0] + here[1, 0] - here[0, 0]
    z = there[1, 1] - there[0, 1] + here[1, 1] - here[0, 1]
    size = math.sqrt(x * x + z * z) + 1e-9
    out[0], out[1] = side * z / size, -side * x / size


@kernel
def need_of_room(there, here, side):
    """How far [m] a foot with centre line `here` (3, 2) must still go to that side (1 left, −1 right) of one with the line `there`."""
    need = 0.0
    for i in range(3):
        need = max(need, _room(there, here[i], side), _room(here, there[i], -side))
    return need


@kernel
def _room(line, point, side):
    """How far [m] a point (2,) must still go to that side (1 left, −1 right) of a foot's line (3, 2): until it is WIDTH from every place of it."""
    x, z = line[2, 0] - line[0, 0], line[2, 1] - line[0, 1]
    length = math.sqrt(x * x + z * z) + 1e-9
    x, z = x / length, z / length
    dx, dz = point[0] - line[0, 0], point[1] - line[0, 1]
    along, apart = dx * x + dz * z, side * (dx * z - dz * x)
    beyond = max(-along, along - length, 0.0)
    if apart > WIDTH + NONE * SOFTNESS or beyond > max(1.5 * WIDTH, FADE):
        return 0.0
    wide = math.sqrt(max(WIDTH * WIDTH - beyond * beyond, 0.0))
    room = SOFTNESS * math.log1p(math.exp((wide - max(apart, 0.0)) / SOFTNESS)) * smooth(3.0 - 2.0 * beyond / WIDTH)
    if apart < 0.0:  # a foot that is far on the other side stays there
        room = (room - apart * smooth(1.0 - beyond / FADE)) * smooth((ASTRAY + apart) / (0.5 * ASTRAY))
    return smooth(length / STEEP - 1.0) * room


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
