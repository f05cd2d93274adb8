"""Where on uneven ground a foot comes down, and how fast one may come to it.

A foot stands whole on a tread where it can. On one too short for that the ball stands well within it, the toes before the next riser
and the heel over the edge, as people stand on such stairs.
"""

from __future__ import annotations

import math

import numpy as np

from ..compiled import kernel
from ..navigation.passing import STEP
from .beside_walls import out_of_walls
from .foot_points import ball_kernel
from .memory import RUN, WALK
from .root_motion import as_runner, cadence_kernel
from .tops import SAME, ground_kernel

FOOT, TOE = 0.175, 0.095
"""From heel to ball and on to the toes' end [m]."""
ASIDE = 0.05
"""A foot comes down no farther beside where it was planned to than this [m]."""
_AROUND = [[0.0, 0.0]] + [[way * far, side * far] for far in np.arange(0.0125, 0.16, 0.0125) for way, side in ((-1, 0), (1, 0), (0, -1), (0, 1)) if way or far <= ASIDE]
SHIFTS = np.array(_AROUND + [[-far, 0.0] for far in np.arange(0.1625, 0.51, 0.0125)])
"""How much farther or nearer, and how far to its left, a foot comes down where it would not stand well, the nearest first [m]."""
WIDE = np.array(sorted(([along, left] for along in np.arange(-0.4, 0.41, 0.05) for left in np.arange(-0.4, 0.41, 0.05) if math.hypot(along, left) <= 0.42),
                      key=lambda shift: math.hypot(*shift)))
"""The same where it would not stand at all so near, of who goes slower than UNHURRIED: who turns beside an edge."""
UNHURRIED, BY_ITSELF = 0.5, 0.08
"""Who goes slower than the first [m/s] sets a foot anywhere about, so far to its own side of the other one [m]."""
NONE, BALL, HALF, WHOLE = 0, 1, 2, 3
"""How much of a foot stands: nothing that one could stand on; the ball, or else the heel; half of what is behind the ball, too; all."""
WORTH = np.array([9.0, 0.22, 0.12, 0.0])
"""So much farther away a foot is set for more of it to stand [m]."""
EASY, DEAR = 0.2, 3.0
"""A foot is set so many times as far away as what it would be higher or lower there than the other one by more than the first [m], but on slopes: who has stepped down from a ledge
brings the other foot down beside it."""
WITHIN = 0.02
"""A ball stands at least so far within an edge, and toes end so far before a riser [m]."""
TIP, SOLE = 0.07, 0.05
"""Toes are looked at so far before the ball, and so far to both sides of a foot's line, half a shoe's width, lest they stand in a riser that they come to askew [m]."""
BEHIND_BALL = np.array([0.0, WITHIN, 0.5 * FOOT, FOOT])
"""So far behind a ball it is looked whether a foot stands [m]: two places for the ball, halfway to the heel, the heel."""
CERTAIN = 0.35
"""After this share of its swing a foot keeps to the place where it will come down …"""
FARTHEST, KEPT = 0.6, 0.8
"""… unless that gets farther away than this [m], or its foot comes to point so that it would not stand there any more, before the share of its swing at which it is too late for another."""
CLEAR, TURNS = 0.08, 0.3
"""On level ground it keeps to none, but where something is higher or lower within the first [m] of it and its body turns faster than the second [rad/s]."""
SLOWEST = 0.4
"""Who must take shorter steps slows down, to no less than this share of the wish."""
SLOW = 0.1
"""Who goes slower than this [m/s] sets a foot nearer or farther along itself, others along their way."""
EDGE = 0.04
"""What is higher or lower than this one stride of the look ahead on is an edge [m], …"""
LOOKS, FINER = 0.05, 4
"""… which goes by such strides [m]; where the edge is, is found by halving one so often."""
FLIGHT = 0.8
"""Edges no farther apart than this are stairs; others are kerbs [m]."""
STEPS, RISES, LEAST, MOST = (2.6, 3.5), (0.42, 0.55), 0.5, (1.0, 1.4)
"""Nobody goes up or down stairs faster than so many treads a second, walking and running, and so much up or down [m/s], no slower than the third [m/s], nor faster than the last …"""
KERB, RUN_OVER = 1.4, 0.24
"""… nor over a kerb than the first [m/s]: but who runs goes on running over one no higher or deeper than the second [m]."""
BRAKES, BEFORE, LATE = 1.5, 0.45, 0.35
"""Who comes to them brakes by the first [m/s²], to be as slow so far before them [m] as feet reach ahead; the third is how late his speed, not
what he wishes, follows [s]: who has braked need not brake as early as who has not."""
BEHIND = 0.3
"""So far beyond the last edge one foot is still to come over it [m]."""
ON, AROUND = 0.25, 0.6
"""Who is no farther than the first beyond the end of a flight stands on it, whichever way he goes; its treads are looked for so far ahead, behind and beside [m]."""
WALL = 0.2
"""Who comes to what is too high for a step stops so far before it [m]."""


@kernel
def come_down(m, tops, floor, foot, progress, out):
    """The ground (3,) where a foot comes down: as far from where it was planned to as it must to stand well and no step too
    high. Once its swing is CERTAIN, it keeps to the place."""
    heel, ball = m.coming[foot, 0], m.coming[foot, 1]
    size = math.hypot(ball[0] - heel[0], ball[1] - heel[1]) + 1e-9
    c, s = (ball[1] - heel[1]) / size, (ball[0] - heel[0]) / size
    beside_x, beside_z = m.land[foot, 0], m.land[foot, 1]
    x, z = ball[0] + beside_x, ball[1] + beside_z
    aim = m.aim[foot]
    if m.aimed[foot] == 1 and math.hypot(aim[0] - x, aim[1] - z) < FARTHEST and (progress > KEPT or _still_fits(m, tops, floor, aim, c, s, out)):
        m.land[foot, 0], m.land[foot, 1] = aim[0] - ball[0], aim[1] - ball[1]
        out[0], out[1], out[2] = aim[2] - floor, aim[3], aim[4]
        return
    stands, shift, left, speed = _choose(m, tops, floor, foot, x, z, c, s, out)
    m.kept[foot] = 1 if math.hypot(m.land[foot, 0], m.land[foot, 1]) > ASIDE else 0
    m.land[foot, 0] += beside_x
    m.land[foot, 1] += beside_z
    aim[0], aim[1] = ball[0] + m.land[foot, 0], ball[1] + m.land[foot, 1]
    aim[2], aim[3], aim[4] = out[0] + floor, out[1], out[2]
    even = stands == WHOLE and shift == 0.0 and left == 0.0 and (
        out[1] != 0.0 or out[2] != 0.0 or abs(out[0] - m.base[1 - foot]) < SAME and not (abs(m.velocity[1]) > TURNS and _edge_near(m, tops, floor, aim[0], aim[1], c, s, out[0])))
    runs_up = m.alert and m.family != WALK  # who runs up to a leap has no time to
    m.aimed[foot] = 1 if stands > NONE and progress > CERTAIN and not even and not runs_up else 0
    if m.aimed[foot] == 1 and shift < 0.0:  # steps that must be short are slow ones
        step = max(0.5 * speed / cadence_kernel(m), 0.05)
        m.pace = max(m.pace * max(1.0 + shift / step, 0.5), SLOWEST)


@kernel
def _still_fits(m, tops, floor, aim, c, s, out):
    """Whether a foot that will point to where cosine c and sine s say can stand on the place (5,) that it chose: it chose that for how it was to point by then, which another
    wish may have changed. out: (3,) scratch."""
    stands = under_kernel(m, tops, floor, aim[0], aim[1], c, s, out)
    return stands > NONE and abs(out[0] + floor - aim[2]) < SAME


@kernel
def _choose(m, tops, floor, foot, x, z, c, s, out):
    """The ground (3,) that a foot comes down on near x, z, pointing to where cosine c and sine s say: how much of it stands there,
    how far ahead and to the left that is [m], and how fast the body goes there [m/s]. Where nothing can be stepped on it is the highest that lies there."""
    along_x, along_z = c * m.velocity[2] + s * m.velocity[0], -s * m.velocity[2] + c * m.velocity[0]
    speed = math.hypot(along_x, along_z)
    if speed > SLOW:
        along_x, along_z = along_x / speed, along_z / speed
    else:
        along_x, along_z = s, c
    other, here, line, aside, place = m.base[1 - foot], np.empty(3), np.empty((3, 2)), np.empty(2), np.empty(2)
    ball_kernel(m, 1 - foot, place)
    for i in range(3):
        back = (FOOT, 0.0, -TOE)[i]
        line[i, 0], line[i, 1] = x - back * s, z - back * c
    out_of_walls(m, tops, floor, foot, line, aside)
    x, z = x + aside[0], z + aside[1]
    best, left, least, most = 0.0, 0.0, 9.0, NONE
    for k in range(SHIFTS.shape[0]):
        shift, beside = SHIFTS[k, 0], SHIFTS[k, 1]
        far = abs(shift) + abs(beside)
        if far >= least:
            break
        there_x, there_z = x + shift * along_x + beside * along_z, z + shift * along_z - beside * along_x
        stands = under_kernel(m, tops, floor, there_x, there_z, c, s, here)
        worse = WORTH[stands] + (DEAR * max(abs(here[0] - other) - EASY, 0.0) if here[1] == 0.0 and here[2] == 0.0 else 0.0)
        if stands > NONE and far + worse < least and abs(steps_kernel(m, foot, here, there_x - place[0], there_z - place[1])) <= STEP:
            best, left, least, most = shift, beside, far + worse, stands
            out[0], out[1], out[2] = here[0], here[1], here[2]
    if most == NONE and speed < UNHURRIED:
        most, best, left = _all_about(m, tops, floor, foot, x, z, along_x, along_z, c, s, place, out)
    m.land[foot, 0], m.land[foot, 1] = aside[0] + best * along_x + left * along_z, aside[1] + best * along_z - left * along_x
    if most == NONE:
        under_kernel(m, tops, floor, x, z, c, s, out)
        if speed > SLOW and steps_kernel(m, foot, out, x - place[0], z - place[1]) < -STEP:  # over an edge: as the other one, until it is over it, too
            out[0], out[1], out[2] = other, 0.0, 0.0
    return most, best, left, speed


@kernel
def _all_about(m, tops, floor, foot, x, z, along_x, along_z, c, s, other, out):
    """The nearest place all about x, z, on its own side of the other foot's ball (2,), that a foot can stand on, no step too high: how much of it stands there, how far along the way and to the
    left that is [m]; its ground (3,) into out, which is left alone where there is none."""
    here = np.empty(3)
    for k in range(WIDE.shape[0]):
        shift, left = WIDE[k, 0], WIDE[k, 1]
        there_x, there_z = x + shift * along_x + left * along_z, z + shift * along_z - left * along_x
        off_x, off_z = there_x - other[0], there_z - other[1]
        if (1 - 2 * foot) * (c * off_x - s * off_z) < BY_ITSELF:
            continue
        stands = under_kernel(m, tops, floor, there_x, there_z, c, s, here)
        if stands > NONE and abs(steps_kernel(m, foot, here, off_x, off_z)) <= STEP:
            out[0], out[1], out[2] = here[0], here[1], here[2]
            return stands, shift, left
    return NONE, 0.0, 0.0


@kernel
def steps_kernel(m, foot, ground, x, z):
    """How much higher a ground (3,) is than the other foot's [m] that is x, z nearer, but for what a slope on which either lies leads up or down: runners' strides on one are more than a step."""
    high = ground[0] - m.base[1 - foot]
    here, there = high - ground[1] * x - ground[2] * z, high - m.tilt[1 - foot, 0] * x - m.tilt[1 - foot, 1] * z
    if abs(here) < abs(high):
        high = here
    return there if abs(there) < abs(high) else high


@kernel
def _edge_near(m, tops, floor, x, z, c, s, high):
    """Whether the ground is not as high all about a foot whose ball is at x, z in the world."""
    ground = np.empty(3)
    for k in range(9):
        along, left = (TOE + CLEAR, 0.0, -FOOT - CLEAR)[k // 3], (k % 3 - 1) * CLEAR
        ground_kernel(tops, x + along * s + left * c, z + along * c - left * s, floor, m.level, ground)
        if abs(ground[0] - high) > SAME:
            return True
    return False


@kernel
def under_kernel(m, tops, floor, x, z, c, s, out):
    """The ground (3,) under a foot whose ball is at x, z in the world, pointing to where cosine c and sine s say: the highest under heel
    and ball; and how much of it stands there."""
    part, there = np.empty(3), np.empty(len(BEHIND_BALL))
    found, top = True, -9.0
    for k in range(len(BEHIND_BALL)):
        back = BEHIND_BALL[k]
        found = ground_kernel(tops, x - back * s, z - back * c, floor, m.level, part) and found
        there[k] = part[0] + back * (s * part[1] + c * part[2])
        if there[k] > top:
            top = there[k]
            out[0], out[1], out[2] = top, part[1], part[2]
    if ground_kernel(tops, x + (TOE + WITHIN) * s, z + (TOE + WITHIN) * c, floor, m.level, part):  # toes may hang over an edge
        found = found and part[0] - (TOE + WITHIN) * (s * part[1] + c * part[2]) < top + SAME
    for k in range(8):
        along, left = (TIP, 0.0, -0.5 * FOOT, -FOOT)[k // 2], SOLE - 2.0 * SOLE * (k % 2)
        dx, dz = along * s + left * c, along * c - left * s
        if found and ground_kernel(tops, x + dx, z + dz, floor, m.level, part):
            found = part[0] - dx * part[1] - dz * part[2] < top + SAME
    ground_kernel(tops, x - (FOOT + WITHIN) * s, z - (FOOT + WITHIN) * c, floor, m.level, part)
    if not found or part[0] + (FOOT + WITHIN) * (s * part[1] + c * part[2]) > top + SAME:
        return NONE
    half, heel = there[2] > top - SAME, there[3] > top - SAME
    if min(there[0], there[1]) > top - SAME:
        return WHOLE if half and heel else HALF if half else BALL
    return BALL if half and heel else NONE  # over an edge ahead


@kernel
def most_speed(m, tops, floor):
    """How fast one may go to where one wishes, for feet to find the edges that lie there [m/s]; 0 where nothing tells."""
    speed = math.hypot(m.wished[0], m.wished[1])
    if speed < 1e-3:
        return 0.0
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    along_x, along_z = (c * m.wished[0] + s * m.wished[1]) / speed, (-s * m.wished[0] + c * m.wished[1]) / speed
    now = math.hypot(m.velocity[0], m.velocity[2])
    goes = max(speed, now)
    sees = BEFORE + LATE * goes + max(speed * speed - LEAST**2, 0.0) / (2.0 * BRAKES)
    ground = np.empty(3)
    ground_kernel(tops, m.ground[0] - BEHIND * along_x, m.ground[1] - BEHIND * along_z, floor, m.level, ground)
    before = ground[0] if ground[0] > m.level - 2.0 * STEP else m.level  # what one has the brink of behind one is no ground
    first, rose, limit = -9.0, 0.0, m.stairs if m.stairs > 0.0 else 9.0
    for k in range(1, 2 + int((sees + BEHIND + FLIGHT) / LOOKS)):
        far = k * LOOKS - BEHIND
        ground_kernel(tops, m.ground[0] + far * along_x, m.ground[1] + far * along_z, floor, before, ground)
        rise = ground[0] - before
        if abs(rise) < EDGE:
            before = ground[0]
            continue
        if rise < -STEP:  # nobody walks on from here
            break
        if rise > STEP:
            if far > 0.0:
                limit = min(limit, math.sqrt(2.0 * BRAKES * max(far - WALL - LATE * now, 0.0)))  # as he goes now: who stands a metre off may come up to it, however fast he wishes to
            break
        far = _edge(m, tops, floor, along_x, along_z, far, before, rise, before, ground)
        tread, at = far - first, far
        if tread < FLIGHT:
            most, at = _on_treads(tread, rise, as_runner(m) if rise * rose > 0.0 else 0.0), first  # over what leads down again at once nobody runs
        else:
            most = 9.0 if m.wanted == RUN and abs(rise) < RUN_OVER else KERB
        first, rose, before = far, rise, before + rise
        limit = min(limit, math.sqrt(most * most + 2.0 * BRAKES * max(at - BEFORE - LATE * now, 0.0)))
        if far > sees:
            break
    return max(limit, 1e-3) if limit < speed else 0.0


@kernel
def _edge(m, tops, floor, along_x, along_z, far, before, rise, level, ground):
    """How far along a line from the body an edge is [m] that is no farther than `far` and less than a look nearer. before: how high the ground lies before it;
    level: from where it is seen [m]."""
    near = far - LOOKS
    for _ in range(FINER):
        middle = 0.5 * (near + far)
        ground_kernel(tops, m.ground[0] + middle * along_x, m.ground[1] + middle * along_z, floor, level, ground)
        if abs(ground[0] - before) > 0.5 * abs(rise):
            far = middle
        else:
            near = middle
    return far


@kernel
def _on_treads(tread, rise, runs):
    """How fast one may go over treads so long that rise by so much [m/s], the faster the more of a runner he is to be, 0 … 1."""
    steps = min(STEPS[0] + runs * (STEPS[1] - STEPS[0]), (RISES[0] + runs * (RISES[1] - RISES[0])) / abs(rise))
    return min(max(steps * tread, LEAST), MOST[0] + runs * (MOST[1] - MOST[0]))


@kernel
def on_stairs(m, tops, floor):
    """How fast somebody may go in any direction who stands on stairs [m/s], 0 for others: between two edges, or just beyond them, that both rise or both fall
    on a line ahead, aside or between."""
    limit, ground, half = 9.0, np.empty(3), math.sqrt(0.5)
    along_x, along_z = math.sin(m.ground[2]), math.cos(m.ground[2])
    for k in range(4):
        c, s = (1.0, half, 0.0, -half)[k], (0.0, half, 1.0, half)[k]
        x, z = c * along_x + s * along_z, c * along_z - s * along_x
        ground_kernel(tops, m.ground[0] - AROUND * x, m.ground[1] - AROUND * z, floor, m.level, ground)
        before, last, rose = ground[0], -9.0, 0.0
        for i in range(1, 1 + int(2.0 * AROUND / LOOKS)):
            far = i * LOOKS - AROUND
            ground_kernel(tops, m.ground[0] + far * x, m.ground[1] + far * z, floor, m.level, ground)
            rise = ground[0] - before
            if abs(rise) >= EDGE:
                far = _edge(m, tops, floor, x, z, far, before, rise, m.level, ground)
                if max(abs(rise), abs(rose)) <= STEP and rise * rose > 0.0 and far - last < FLIGHT and last < ON and far > -ON:
                    limit = min(limit, _on_treads(far - last, rise, as_runner(m)))
                last, rose = far, rise
            before = before + rise
    return limit if limit < 9.0 else 0.0
