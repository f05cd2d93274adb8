"""The way of a foot that swings: from where it is to where it comes down, past the other foot.

What is shown of it is the blend's foot and an offset, which goes to that of its foothold by the smoothest way that there
is (`minimum_jerk`), made anew in every step from the offset's place, speed and acceleration. Blends of
turns and diagonals bring it nearer to the other foot than any recorded step, so that it gives way, early, since it is foretold
where both will be (`foretold_way`): by the least acceleration that takes it past the other foot, and past walls, and back as it lands.
"""

from __future__ import annotations

import math

import numpy as np

from ..compiled import kernel
from .beside_walls import out_of_walls
from .cycles import EVENTS
from .foot_lines import lay_toe, need_of_room, outline_kernel, own_side, standing_line, with_toe
from .minimum_jerk import smooth, smoothest

SWING = (float(EVENTS["walk"][1]), float(EVENTS["run"][3]))
"""The share of the cycle for which a foot swings, walking and running: from its toe-off to its strike."""
SAMPLES = 16
"""At so many moments of its swing it is told where a foot will be."""
SOONEST = 0.06
"""A way takes at least this long to its end [s]."""
QUICKEST = 0.035
"""A foot gives way in no less than this [s] …"""
HARDEST = 150.0
"""… and is pushed aside, or up, no harder than this [m/s²]."""
LOW, HIGH = 0.25, 0.45
"""A foot that swings higher than this above the floor passes freely, the more the higher [m]."""


@kernel
def swing_progress(m, foot):
    """How far through its swing foot 0 (left) or 1 is, by the phase: 0 … 1, beyond while it stands."""
    return ((m.phase - 0.5 * foot) % 1.0) / SWING[m.family]


@kernel
def push_back(x, v, left):
    """The least acceleration (of ∫ a²) [m/s²] by which what is x off its way and goes at v is back on it, at rest, as so many seconds are over."""
    return -(6.0 * x / left + 4.0 * v) / left


@kernel
def led_to(x, v, push, later):
    """Where an acceleration that falls evenly to nothing, the least that leads there, leads from place x and speed v in so many seconds."""
    return x + later * (v + later * push / 3.0)


@kernel
def push_on(far, later):
    """By how much that acceleration must be more to lead so much farther."""
    return 3.0 * far / (later * later)


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
    """
    there, here, out = np.empty((3, 2)), np.empty((3, 2)), np.empty(2)
    aside, rate = m.aside[foot], m.aside_rate[foot]
    left = max(ahead.until[foot], SOONEST)
    for i in range(2):
        push[i] = push_back(aside[i], rate[i], left)
    passes = not (m.turn != 0.0 and m.spot) and other_line(m, body, foot, there)  # on the spot feet pass each other as recorded
    if not passes and tops.shape[0] == 0:
        return
    side = 1.0 - 2.0 * foot
    for k in range(SAMPLES - 1, -3, -1):
        later, low = _foretold(m, foot, ahead, k, speed_x, speed_z, height, here)
        if later < 0.0:
            continue
        later, x, z = max(later, QUICKEST), 0.0, 0.0
        if passes:
            other = ahead.beside[foot, k] if k >= 0 else there
            need = need_of_room(other, here, side) * smooth((HIGH - low + height) / (HIGH - LOW))
            if need > 0.0:
                own_side(other, here, side, out)
                _reach(aside, rate, push, later, out[0], out[1], need)
                x, z = need * out[0], need * out[1]
        if tops.shape[0] > 0:
            _past_walls(m, tops, floor, foot, here, x, z, later, aside, rate, push, out)


@kernel
def _past_walls(m, tops, floor, foot, here, x, z, later, aside, rate, push, out):
    """Add to `push` (2,) what leads a foot whose line `here` (3, 2) in so many seconds, without giving way, would be in a wall as it gives way: to where it is out of it
    from x, z aside, which do not hang on how it went until now. out: (2,) scratch."""
    gone_x, gone_z = led_to(aside[0], rate[0], push[0], later), led_to(aside[1], rate[1], push[1], later)
    _move(here, gone_x, gone_z)
    if not out_of_walls(m, tops, floor, foot, here, out):
        return
    _move(here, x - gone_x, z - gone_z)
    if out_of_walls(m, tops, floor, foot, here, out):
        x, z = x + out[0], z + out[1]
    far = math.hypot(x - gone_x, z - gone_z) + 1e-9
    along_x, along_z = (x - gone_x) / far, (z - gone_z) / far
    _reach(aside, rate, push, later, along_x, along_z, along_x * x + along_z * z)


@kernel
def _move(line, x, z):
    """Move a centre line (3, 2) by so much [m]."""
    for i in range(3):
        line[i, 0] += x
        line[i, 1] += z


@kernel
def _reach(x, v, push, later, along_x, along_z, far):
    """Add to `push` (2,) the least that leads as `far` [m] along a unit way x, z from place x (2,) and speed v (2,) in so many seconds."""
    lacks = far - along_x * led_to(x[0], v[0], push[0], later) - along_z * led_to(x[1], v[1], push[1], later)
    if lacks > 0.0:
        more = push_on(lacks, later)
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
    lay_toe(m, foot, c * x + s * z, toe[1] - ball[1], c * z - s * x, ball[1] - height, here)


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
