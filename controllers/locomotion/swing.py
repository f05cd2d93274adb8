"""The way of a foot that swings: from where it is to where it comes down, past the other foot.

What is shown of it is the blend's foot and an offset, which goes to that of its foothold by the smoothest way that there
is: minimum jerk, Flash and Hogan 1985, made anew in every step from the offset's place, speed and acceleration. Blends of
turns and diagonals bring it nearer to the other foot than any recorded step, so that it gives way, early, since it is foretold
where both will be: by the least acceleration that takes it past the other foot, and past walls, and back as it lands. How far it must go aside is told in both
feet's own frames: smooth in their places, so that a foot glides along as by a wall.
"""

from __future__ import annotations

import math

import numpy as np

from ..compiled import kernel
from .beside_walls import out_of_walls
from .cycles import EVENTS
from .foot_points import shown_kernel

SWING = (float(EVENTS["walk"][1]), float(EVENTS["run"][3]))
"""The share of the cycle for which a foot swings, walking and running: from its toe-off to its strike."""
SAMPLES = 16
"""At so many moments of its swing it is told where a foot will be."""
SOONEST = 0.06
"""A way takes at least this long to its end [s]."""
QUICKEST = 0.035
"""A foot gives way in no less than this [s] …"""
HARDEST = 150.0
"""… and is pushed aside no harder than this [m/s²]."""
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
LOW, HIGH = 0.25, 0.45
"""A foot that swings higher than this above the floor passes freely, the more the higher [m]."""


@kernel
def swing_progress(m, foot):
    """How far through its swing foot 0 (left) or 1 is, by the phase: 0 … 1, beyond while it stands."""
    return ((m.phase - 0.5 * foot) % 1.0) / SWING[m.family]


@kernel
def swing_kernel(m, body, foot, ahead, speed_x, speed_z, height, tops, floor, dt):
    """Lead the offset of a foot that swings on for dt, and how far it gives way.

    ahead: where the blend's foot will be (`foothold`). speed_x, speed_z: how fast it goes now, in the world [m/s]. height: of standing
    heels and balls [m]. tops, floor: of the ground (`uneven_ground`).
    """
    offset, rate, push = m.offset[foot], m.offset_rate[foot], m.offset_push[foot]
    whole = max(ahead.until[foot], SOONEST)
    s = min(dt / whole, 1.0)
    for i in range(3):
        goal = m.land[foot, i] if i < 2 else 0.0
        x, v, a = offset[i] - goal, rate[i], push[i]
        offset[i], rate[i], push[i] = goal + smoothest(x, v, a, whole, s, 0), smoothest(x, v, a, whole, s, 1), smoothest(x, v, a, whole, s, 2)
    push = np.empty(2)
    _give_way(m, body, foot, ahead, speed_x + rate[0], speed_z + rate[1], height, tops, floor, push)
    aside, aside_rate = m.aside[foot], m.aside_rate[foot]
    share = min(HARDEST / (math.hypot(push[0], push[1]) + 1e-9), 1.0)
    for i in range(2):
        push[i] *= share
        aside[i] += dt * (aside_rate[i] + 0.5 * dt * push[i])
        aside_rate[i] += dt * push[i]


@kernel
def _give_way(m, body, foot, ahead, speed_x, speed_z, height, tops, floor, push):
    """Write into `push` (2,) how a swinging foot's way aside x, z in the world is accelerated [m/s²]: by the least by which it is back as it lands, and by the least more
    by which it is as far from the other foot, and from what is too high to step on, as it must be at each moment of its way, the soonest last.

    From place x and speed v acceleration a, which falls evenly to nothing, leads to x + v t + a t² / 3 in t seconds: the least (of ∫ a²) that leads there.
    """
    there, here, out = np.empty((3, 2)), np.empty((3, 2)), np.empty(2)
    aside, rate = m.aside[foot], m.aside_rate[foot]
    left = max(ahead.until[foot], SOONEST)
    for i in range(2):
        push[i] = -(6.0 * aside[i] / left + 4.0 * rate[i]) / left
    passes = not (m.turn != 0.0 and m.spot) and other_line(m, body, foot, there)  # on the spot feet pass each other as recorded
    if not passes and tops.shape[0] == 0:
        return
    side = 1.0 - 2.0 * foot
    for k in range(SAMPLES - 1, -3, -1):
        later, low = _foretold(m, foot, ahead, k, speed_x, speed_z, height, here)
        if later < 0.0:
            continue
        later = max(later, QUICKEST)
        if passes:
            other = ahead.beside[foot, k] if k >= 0 else there
            need = need_of_room(other, here, side) * smooth((HIGH - low + height) / (HIGH - LOW))
            if need > 0.0:
                own_side(other, here, side, out)
                _reach(aside, rate, push, later, out[0], out[1], need)
        if tops.shape[0] > 0:
            x = aside[0] + later * (rate[0] + later * push[0] / 3.0)
            z = aside[1] + later * (rate[1] + later * push[1] / 3.0)
            for i in range(3):
                here[i, 0] += x
                here[i, 1] += z
            if out_of_walls(m, tops, floor, foot, here, out):
                far = math.hypot(out[0], out[1]) + 1e-9
                _reach(aside, rate, push, later, out[0] / far, out[1] / far, far + (x * out[0] + z * out[1]) / far)


@kernel
def _reach(x, v, push, later, along_x, along_z, far):
    """Add to `push` (2,) the least that leads as `far` [m] along a unit way x, z from place x (2,) and speed v (2,) in so many seconds."""
    lacks = far - along_x * (x[0] + later * (v[0] + later * push[0] / 3.0)) - along_z * (x[1] + later * (v[1] + later * push[1] / 3.0))
    if lacks > 0.0:
        more = 3.0 * lacks / (later * later)
        push[0] += more * along_x
        push[1] += more * along_z


@kernel
def _foretold(m, foot, ahead, k, speed_x, speed_z, height, here):
    """Write a swinging foot's centre line (3, 2) in the world as it will be without giving way: now and a moment later for k of −2 and −1, then at moment k of its
    way. When that is [s], negative where there is no such moment, and how high [m] the foot is then."""
    if k < 0:  # as it is, and goes
        later = (k + 2) * QUICKEST
        outline_kernel(m, foot, ahead, height, here)
        c, sine = math.cos(m.ground[2]), math.sin(m.ground[2])
        for i in range(3):
            x, z = here[i, 0], here[i, 1]
            here[i, 0] = m.ground[0] + c * x + sine * z - m.aside[foot, 0] + later * speed_x
            here[i, 1] = m.ground[1] - sine * x + c * z - m.aside[foot, 1] + later * speed_z
        return later, min(m.points[2 * foot, 1], m.points[2 * foot + 1, 1])
    s = ahead.shares[foot, k]
    if s <= 0.0 or s >= 1.0:
        return -1.0, 0.0
    line_ahead(m, foot, ahead, k, height, here)
    return s * ahead.until[foot], min(ahead.way[foot, k, 0, 1], ahead.way[foot, k, 1, 1])


@kernel
def line_ahead(m, foot, ahead, k, height, here):
    """Write a swinging foot's centre line (3, 2) in the world as it will be at moment k of its way, without giving way."""
    heel, ball, toe, offset = ahead.way[foot, k, 0], ahead.way[foot, k, 1], ahead.way[foot, k, 2], ahead.vectors[0]
    for i in range(3):
        goal = m.land[foot, i] if i < 2 else 0.0
        offset[i] = goal + smoothest(m.offset[foot, i] - goal, m.offset_rate[foot, i], m.offset_push[foot, i],
                                     max(ahead.until[foot], SOONEST), ahead.shares[foot, k], 0)
    c, s = math.cos(offset[2]), math.sin(offset[2])
    x, z = heel[0] - ball[0], heel[2] - ball[2]
    here[1, 0], here[1, 1] = ball[0] + offset[0], ball[2] + offset[1]
    here[0, 0], here[0, 1] = here[1, 0] + c * x + s * z, here[1, 1] + c * z - s * x
    x, z = toe[0] - ball[0], toe[2] - ball[2]
    _lay_toe(m, foot, c * x + s * z, toe[1] - ball[1], c * z - s * x, ball[1] - height, here)


@kernel
def swept_line(m, body, foot, ahead, goes, share, height, here):
    """Write a swinging foot's centre line (3, 2) in the world as it will be after a share of its way, without giving way, where nothing foretells that: the smoothest way
    from where heel and ball are, and how fast they go, to where they come down. goes: (4, 2) how fast the blend's points go [m/s]."""
    outline_kernel(m, foot, ahead, height, here)
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    for k in range(2):
        x, z = here[k, 0], here[k, 1]
        here[k, 0], here[k, 1] = m.ground[0] + c * x + s * z - m.aside[foot, 0], m.ground[1] - s * x + c * z - m.aside[foot, 1]
        for i in range(2):
            goal = m.coming[foot, k, i] + m.land[foot, i]
            here[k, i] = goal + smoothest(here[k, i] - goal, goes[2 * foot + k, i] + m.offset_rate[foot, i], 0.0, max(ahead.until[foot], SOONEST), share, 0)
    with_toe(body, here)


@kernel
def smoothest(x, v, a, whole, s, order):
    """The smoothest way from place x, speed v and acceleration a to rest at 0 in `whole` seconds, after the share s of that
    time: its place (order 0), speed (1) or acceleration (2)."""
    v, a = v * whole, 0.5 * a * whole * whole
    p, q, r = -10.0 * x - 6.0 * v - 3.0 * a, 15.0 * x + 8.0 * v + 3.0 * a, -6.0 * x - 3.0 * v - a
    if order == 0:
        return x + s * (v + s * (a + s * (p + s * (q + s * r))))
    if order == 1:
        return (v + s * (2.0 * a + s * (3.0 * p + s * (4.0 * q + s * 5.0 * r)))) / whole
    return (2.0 * a + s * (6.0 * p + s * (12.0 * q + s * 20.0 * r))) / (whole * whole)


@kernel
def other_line(m, body, foot, out):
    """Write the centre line (3, 2) in the world of the other foot: where it stands, or where it comes down if it does so before
    this one; whether there is one that this foot must pass."""
    other = 1 - foot
    progress = swing_progress(m, other)
    if m.grip[2 * other] <= 0.0 and m.grip[2 * other + 1] <= 0.0 and progress < 1.0:
        if progress < swing_progress(m, foot):
            return False
        for k in range(2):
            for i in range(2):
                out[k, i] = m.coming[other, k, i] + m.land[other, i]
        with_toe(body, out)
        return True
    standing_line(m, body, other, out)
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    for i in range(3):
        x, z = out[i, 0], out[i, 1]
        out[i, 0], out[i, 1] = m.ground[0] + c * x + s * z, m.ground[1] - s * x + c * z
    return True


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
def outline_kernel(m, foot, ahead, height, out):
    """A swinging foot's centre line as it is shown: heel, ball and toe's end (3, 2) in the ground frame."""
    shown_kernel(m, 2 * foot, out[0])
    shown_kernel(m, 2 * foot + 1, out[1])
    toe, c, s = ahead.toe[foot], math.cos(m.offset[foot, 2]), math.sin(m.offset[foot, 2])
    _lay_toe(m, foot, c * toe[0] + s * toe[2], toe[1], c * toe[2] - s * toe[0], m.points[2 * foot + 1, 1] - height, out)


@kernel
def _lay_toe(m, foot, x, y, z, high, line):
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
def standing_line(m, body, foot, out):
    """The centre line of a foot whose toes lie on the floor, as it is shown: heel, ball and toe's end (3, 2) in the ground frame."""
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
def smooth(share):
    """From 0 to 1, and level at both ends, as a share does; what is beyond them stays there."""
    share = min(max(share, 0.0), 1.0)
    return share * share * (3.0 - 2.0 * share)
