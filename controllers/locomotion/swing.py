"""The way of a foot that swings: from where it is to where it comes down, past the other foot.

What is shown of it is the blend's foot and an offset, which goes to that of its foothold by the smoothest way that there
is: minimum jerk, Flash and Hogan 1985, made anew in every step from the offset's place, speed and acceleration. Blends of
turns and diagonals bring it nearer to the other foot than any recorded step, so that it gives way, early, since it is foretold
where it will pass. How far it must go aside is told in both feet's own frames: smooth in their places, so
that a foot glides along as by a wall.
"""

from __future__ import annotations

import math

import numpy as np

from ..body import spring_kernel
from ..compiled import kernel
from .beside_walls import out_of_walls
from .cycles import EVENTS
from .foot_points import shown_kernel

SWING = (float(EVENTS["walk"][1]), float(EVENTS["run"][3]))
"""The share of the cycle for which a foot swings, walking and running: from its toe-off to its strike."""
SAMPLES = 10
"""At so many moments of its swing it is told where a foot will be."""
SOONEST = 0.06
"""A way takes at least this long to its end [s]."""
AHEAD = 0.2
"""A foot begins to give way so long before it would come too near [s] …"""
LEAD = 0.035
"""… and fully as it would so much later [s] …"""
HALFLIFE, BACK = 0.018, 0.045
"""… with the first half-life [s], and comes back with the second …"""
YIELDING = 0.15
"""… once this share of its swing is over, since it leaves without a jump."""
WIDTH = 0.09
"""The room that is asked for between the centre lines of two feet side by side [m]; recorded walks have 0.07."""
SOFTNESS = 0.015
"""A foot begins to give way about this much before it comes too near [m]."""
FADE = 0.1
"""Before a foot's heel and beyond its toes the need for room fades over this length [m]."""
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
    wanted = np.empty(2)
    _give_way(m, body, foot, ahead, speed_x + rate[0], speed_z + rate[1], height, wanted)
    if tops.shape[0] > 0:
        _keep_clear(m, body, foot, ahead, speed_x + rate[0], speed_z + rate[1], tops, floor, wanted)
    aside, aside_rate = m.aside[foot], m.aside_rate[foot]
    nearer = wanted[0] * aside[0] + wanted[1] * aside[1] < aside[0] ** 2 + aside[1] ** 2
    for i in range(2):
        aside[i], aside_rate[i] = spring_kernel(aside[i], aside_rate[i], wanted[i], BACK if nearer else HALFLIFE, dt)


@kernel
def _give_way(m, body, foot, ahead, speed_x, speed_z, height, out):
    """Write into `out` (2,) how far x, z in the world [m] a swinging foot gives way to the other one: as far as it must now and a
    moment later, and of what it must later the more the sooner that is."""
    there, here = np.empty((3, 2)), np.empty((3, 2))
    out[0] = out[1] = 0.0
    if m.turn != 0.0 and m.spot:  # as recorded, feet pass each other
        return
    if not other_line(m, body, foot, there):
        return
    side, most = 1.0 - 2.0 * foot, 0.0
    for k in range(-2, SAMPLES):
        share, low = _foretold(m, body, foot, ahead, k, speed_x, speed_z, here)
        if share <= 0.0:
            continue
        need = share * need_of_room(there, here, side, FADE) * smooth((HIGH - low + height) / (HIGH - LOW))
        if need > most:
            most = need
            own_side(there, here, side, out)
    out[0] *= most
    out[1] *= most


@kernel
def _keep_clear(m, body, foot, ahead, speed_x, speed_z, tops, floor, out):
    """Add to `out` (2,) how far x, z in the world [m] a swinging foot that gives way so far goes aside to pass what is too high to step on."""
    here, aside, most = np.empty((3, 2)), np.empty(2), 0.0
    x, z = out[0], out[1]
    for k in range(-2, SAMPLES):
        share, _ = _foretold(m, body, foot, ahead, k, speed_x, speed_z, here)
        if share <= 0.0:
            continue
        for i in range(3):
            here[i, 0] += x
            here[i, 1] += z
        if out_of_walls(m, tops, floor, foot, here, aside) and share * math.hypot(aside[0], aside[1]) > most:
            most = share * math.hypot(aside[0], aside[1])
            out[0], out[1] = x + share * aside[0], z + share * aside[1]


@kernel
def _foretold(m, body, foot, ahead, k, speed_x, speed_z, here):
    """Write a swinging foot's centre line (3, 2) in the world as it will be without giving way: now and a moment later for k of −2 and −1, then at moment k of its
    way. How much that counts, 0 where it does not, and how high [m] the foot is then."""
    if k < 0:  # as it is, and goes
        outline_kernel(m, body, foot, here)
        c, sine = math.cos(m.ground[2]), math.sin(m.ground[2])
        for i in range(3):
            x, z = here[i, 0], here[i, 1]
            here[i, 0] = m.ground[0] + c * x + sine * z - m.aside[foot, 0] + (k + 2) * LEAD * speed_x
            here[i, 1] = m.ground[1] - sine * x + c * z - m.aside[foot, 1] + (k + 2) * LEAD * speed_z
        return min(swing_progress(m, foot) / YIELDING, 1.0), min(m.points[2 * foot, 1], m.points[2 * foot + 1, 1])
    s = ahead.shares[foot, k]
    later = s * ahead.until[foot]
    if s <= 0.0 or s >= 1.0 or later > AHEAD:
        return 0.0, 0.0
    line_ahead(m, body, foot, ahead, k, here)
    return smooth(1.0 - later / AHEAD), min(ahead.way[foot, k, 0, 1], ahead.way[foot, k, 1, 1])


@kernel
def line_ahead(m, body, foot, ahead, k, here):
    """Write a swinging foot's centre line (3, 2) in the world as it will be at moment k of its way, without giving way."""
    heel, ball = ahead.way[foot, k, 0], ahead.way[foot, k, 1]
    for i in range(2):
        goal = m.land[foot, i]
        here[1, i] = ball[2 * i] + goal + smoothest(m.offset[foot, i] - goal, m.offset_rate[foot, i], m.offset_push[foot, i],
                                                    max(ahead.until[foot], SOONEST), ahead.shares[foot, k], 0)
        here[0, i] = here[1, i] + heel[2 * i] - ball[2 * i]
    with_toe(body, here)


@kernel
def swept_line(m, body, foot, goes, until, share, here):
    """Write a swinging foot's centre line (3, 2) in the world as it will be after a share of its way, without giving way, where nothing foretells that: the smoothest way
    from where heel and ball are, and how fast they go, to where they come down. goes: (4, 2) how fast the blend's points go [m/s]; until: when it comes down [s]."""
    outline_kernel(m, body, foot, here)
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    for k in range(2):
        x, z = here[k, 0], here[k, 1]
        here[k, 0], here[k, 1] = m.ground[0] + c * x + s * z - m.aside[foot, 0], m.ground[1] - s * x + c * z - m.aside[foot, 1]
        for i in range(2):
            goal = m.coming[foot, k, i] + m.land[foot, i]
            here[k, i] = goal + smoothest(here[k, i] - goal, goes[2 * foot + k, i] + m.offset_rate[foot, i], 0.0, max(until, SOONEST), share, 0)
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
    outline_kernel(m, body, other, out)
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
        room *= smooth((ASTRAY + apart) / (0.5 * ASTRAY))
    return smooth(1.0 - max(-along, along - length) / fade) * smooth(length / STEEP - 1.0) * room


@kernel
def smooth(share):
    """From 0 to 1, and level at both ends, as a share does; what is beyond them stays there."""
    share = min(max(share, 0.0), 1.0)
    return share * share * (3.0 - 2.0 * share)
