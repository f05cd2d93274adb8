"""Ground that is not flat: the tops of boxes and ramps that feet can step on, and how high it lies under a foot.

Heights are told over the character's own floor, on which it stood last; a top that is farther above or below than a
step is no ground for a foot.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..body import spring_kernel
from ..compiled import kernel
from ..navigation import is_box, slope
from .foot_points import shown_kernel
from .root_motion import cadence_kernel

WALK = 0
"""The family that comes down where it chose; who runs has no time to."""

STEP = 0.24
"""A foot comes down no more than this higher or deeper than the other stands [m] …"""
SEEN = 0.5
"""… and what is higher than this over the body's level is no ground [m]."""
SHIFTS = np.concatenate([[0.0], np.outer(np.arange(0.025, 0.16, 0.025), [-1.0, 1.0]).ravel(), -np.arange(0.175, 0.51, 0.025)])
"""How much farther or nearer a foot comes down where it would not stand well, in the order in which it is tried [m]."""
CERTAIN = 0.35
"""After this share of its swing a foot keeps to the place where it will come down …"""
FARTHEST, ASTRAY = 0.6, 0.06
"""… unless that gets farther away than the first [m]; a foot that came down farther from it than the second stands on what
lies there."""
SLOWEST, RECOVERS = 0.4, 0.35
"""Who must take shorter steps slows down, to no less than the first share of the wish, and takes up speed again by so much a
second."""
SLOW = 0.1
"""Slower than this [m/s] nobody chooses where a foot comes down."""
FLAT = np.zeros((0, 8))
"""No tops: the ground is the character's own floor."""


def tops(around: Sequence[Any]) -> np.ndarray:
    """The tops (M, 8) of all boxes that stand around: middle x, z, cosine and sine of the heading, half sizes across and
    along [m], height [m], slope along."""
    rows = [(b.centre[0], b.centre[2], math.cos(b.heading), math.sin(b.heading), 0.5 * b.size[0], 0.5 * b.size[2],
             b.centre[1] + 0.5 * b.size[1], slope(b)) for b in around if is_box(b)]
    return np.array(rows, float) if rows else FLAT


@kernel
def ground_kernel(tops, x, z, floor, level, out):
    """Write into `out` (3,) how high the ground lies at x, z over `floor` [m], and how it rises along x and z.

    floor: absolute. level: of the body, over the floor. Whether there is ground near it; what is not counts as level.
    """
    found = False
    out[0], out[1], out[2] = level, 0.0, 0.0
    if -floor - level <= SEEN:  # the world's own floor
        found, out[0] = True, -floor
    for k in range(tops.shape[0]):
        dx, dz = x - tops[k, 0], z - tops[k, 1]
        c, s = tops[k, 2], tops[k, 3]
        across, along = c * dx - s * dz, s * dx + c * dz
        if abs(across) > tops[k, 4] or abs(along) > tops[k, 5]:
            continue
        high = tops[k, 6] + tops[k, 7] * along - floor
        if high - level <= SEEN and (not found or high > out[0]):
            found = True
            out[0], out[1], out[2] = high, tops[k, 7] * s, tops[k, 7] * c
    return found


RISES, SINKS = 0.4, 0.5
"""A foot that goes up is up after this share of its swing; one that goes down stays up for that share of it."""
DROPS, CLIMBS = 2.0, 4.0
"""A foot that must stay over an edge goes down no faster than the first afterwards, nor up faster than the second [m/s]."""
TILT_HALFLIFE = 0.05
"""A foot takes on the slope that it will come down on with this half-life [s]."""
GRAVITY = 9.81
LEVEL_HALFLIFE = 0.12
"""A body's level follows its feet with this half-life [s]."""
LOW = 0.06
"""A body's level lies no more than this and a quarter of what lies between its feet over the lower one's ground [m]."""
FOOT, TOE = 0.175, 0.095
"""From heel to ball and on to the toes' end [m]: a foot comes down on the higher of what lies under heel and ball."""
SAME = 0.02
"""Grounds nearer to each other than this are the same one [m]."""


@kernel
def follow_ground(m, tops, floor, swing, dt):
    """Lead on the ground under each foot, where it stands or from where it left to where it will come down, and the
    body's level, which follows both. swing: the share of the cycle for which a foot swings."""
    under, place, bears = np.empty(3), np.empty(2), np.empty(2)
    for foot in range(2):
        bears[foot] = m.base[foot]
        ball = 2 * foot + 1
        firm = max(m.grip[ball - 1], m.grip[ball]) >= 1.0
        if firm and m.held[foot] == 1:
            _left_at(m, foot, place)
            continue
        passed = ((m.phase - 0.5 * foot) % 1.0) / swing
        progress = min(passed, 1.0)
        aim = m.aim[foot]
        if firm or progress >= 1.0:  # it is down: on what lies under it, or it is about to leave that
            if m.held[foot] == 0 or firm:
                _ball(m, foot, place)
                c, s, x, z = math.cos(m.ground[2]), math.sin(m.ground[2]), place[0], place[1]
                if m.aimed[foot] == 0 or math.hypot(x - aim[0], z - aim[1]) > ASTRAY:
                    _under(m, tops, floor, x, z, c, s, under)
                    if under[0] < m.base[1 - foot] - STEP and _upheld(m, tops, floor, 1 - foot, place):
                        under[0], under[1], under[2] = m.base[1 - foot], 0.0, 0.0
                    m.base[foot], m.tilt[foot, 0], m.tilt[foot, 1] = under[0], under[1], under[2]
                else:
                    m.base[foot] = aim[2] - floor + aim[3] * (x - aim[0]) + aim[4] * (z - aim[1])
                    m.tilt[foot, 0], m.tilt[foot, 1] = aim[3], aim[4]
                _left_at(m, foot, place)
            else:
                m.base[foot] = _along(m, foot, place)
            bears[foot] = m.left[foot]
            if firm:
                m.held[foot], m.aimed[foot] = 1, 0
            continue
        m.held[foot] = 0
        _come_down(m, tops, floor, foot, progress, under)
        share = progress / RISES if under[0] > m.left[foot] else (progress - SINKS) / (1.0 - SINKS)
        share = min(max(share, 0.0), 1.0)
        path = m.left[foot] + (under[0] - m.left[foot]) * share * share * (3.0 - 2.0 * share)
        rising = min(_along(m, foot, place), under[0]) if under[0] > m.left[foot] else path
        if abs(under[0] - m.left[foot]) > SAME:
            path = max(path, _beneath(m, tops, floor, foot, max(under[0], m.left[foot]) + SAME, place))
        m.base[foot] = min(max(path, rising, m.base[foot] - DROPS * dt), m.base[foot] + CLIMBS * dt)
        bears[foot] = min(m.base[foot], path) if rising > path else m.base[foot]
        if under[0] < m.left[foot]:  # the body sinks all the way down
            bears[foot] = m.left[foot] + (under[0] - m.left[foot]) * progress * progress * (3.0 - 2.0 * progress)
        for i in range(2):
            m.tilt[foot, i] += (under[1 + i] - m.tilt[foot, i]) * (1.0 - 2.0 ** (-dt / TILT_HALFLIFE))
    low, high = min(bears[0], bears[1]), max(bears[0], bears[1])
    before, rate = m.level, m.level_rate
    m.level, m.level_rate = spring_kernel(m.level, m.level_rate, min(0.5 * (low + high), low + LOW + 0.25 * (high - low)),
                                          LEVEL_HALFLIFE, dt)
    if m.level_rate < rate - GRAVITY * dt:  # nobody sinks faster than they fall
        m.level_rate = rate - GRAVITY * dt
        m.level = before + 0.5 * (rate + m.level_rate) * dt
    for k in range(4):  # what is shown stays where it is
        m.raised[k] -= m.level - before


@kernel
def _upheld(m, tops, floor, foot, place):
    """Whether a foot has the ground under it that it stands on: who set one foot over an edge has the other one still there."""
    ground = np.empty(3)
    _ball(m, foot, place)
    ground_kernel(tops, place[0], place[1], floor, m.level, ground)
    return ground[0] > m.base[foot] - STEP


@kernel
def _left_at(m, foot, place):
    """Note the ground that a foot is on, and where its ball is, as what it will have left."""
    _ball(m, foot, place)
    m.left[foot], m.left_at[foot, 0], m.left_at[foot, 1] = m.base[foot], place[0], place[1]


@kernel
def _along(m, foot, place):
    """How high the ground that a foot has left lies under it now, if it goes on as it rose there."""
    _ball(m, foot, place)
    return m.left[foot] + m.tilt[foot, 0] * (place[0] - m.left_at[foot, 0]) + m.tilt[foot, 1] * (place[1] - m.left_at[foot, 1])


@kernel
def _ball(m, foot, place):
    """Where a foot's ball is shown: x, z in the world, into `place` (2,)."""
    shown_kernel(m, 2 * foot + 1, place)
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    x, z = place[0], place[1]
    place[0], place[1] = m.ground[0] + c * x + s * z, m.ground[1] - s * x + c * z


@kernel
def _beneath(m, tops, floor, foot, highest, place):
    """How high the ground lies that a swinging foot is over, from its heel to its toes' end: none above `highest`."""
    ground, high = np.empty(3), -1e9
    shown_kernel(m, 2 * foot, place)
    heel_x, heel_z = place[0], place[1]
    shown_kernel(m, 2 * foot + 1, place)
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    for k in range(3):  # heel, ball, toes' end
        along = (0.0, 1.0, 1.0 + TOE / FOOT)[k]
        x, z = heel_x + along * (place[0] - heel_x), heel_z + along * (place[1] - heel_z)
        if ground_kernel(tops, m.ground[0] + c * x + s * z, m.ground[1] - s * x + c * z, floor, m.level, ground) and ground[0] < highest:
            high = max(high, ground[0])
    return high


@kernel
def _come_down(m, tops, floor, foot, progress, out):
    """The ground (3,) where a foot comes down: as far from where it was planned to as it must to stand whole and no step too
    high. Once its swing is CERTAIN, it keeps to the place."""
    heel, ball = m.coming[foot, 0], m.coming[foot, 1]
    size = math.hypot(ball[0] - heel[0], ball[1] - heel[1]) + 1e-9
    c, s = (ball[1] - heel[1]) / size, (ball[0] - heel[0]) / size
    beside_x, beside_z = m.land[foot, 0], m.land[foot, 1]
    x, z = ball[0] + beside_x, ball[1] + beside_z
    aim = m.aim[foot]
    if m.aimed[foot] == 1 and math.hypot(aim[0] - x, aim[1] - z) < FARTHEST:
        m.land[foot, 0], m.land[foot, 1] = aim[0] - ball[0], aim[1] - ball[1]
        out[0], out[1], out[2] = aim[2] - floor, aim[3], aim[4]
        return
    found, shift, speed = _choose(m, tops, floor, foot, x, z, c, s, out)
    m.land[foot, 0] += beside_x
    m.land[foot, 1] += beside_z
    aim[0], aim[1] = ball[0] + m.land[foot, 0], ball[1] + m.land[foot, 1]
    aim[2], aim[3], aim[4] = out[0] + floor, out[1], out[2]
    even = shift == 0.0 and (out[1] != 0.0 or out[2] != 0.0 or abs(out[0] - m.base[1 - foot]) < SAME)
    m.aimed[foot] = 1 if found and progress > CERTAIN and not even and m.family == WALK else 0
    if m.aimed[foot] == 1 and shift < 0.0:  # steps that must be short are slow ones
        step = max(0.5 * speed / cadence_kernel(m), 0.05)
        m.pace = max(m.pace * max(1.0 + shift / step, 0.5), SLOWEST)


@kernel
def _choose(m, tops, floor, foot, x, z, c, s, out):
    """The ground (3,) that a foot comes down on near x, z, looking to where cosine c and sine s say: whether there is a good
    place, how far ahead that is [m], and how fast the body goes there [m/s]."""
    along_x, along_z = c * m.velocity[2] + s * m.velocity[0], -s * m.velocity[2] + c * m.velocity[0]
    speed = math.hypot(along_x, along_z)
    m.land[foot, 0] = m.land[foot, 1] = 0.0
    other = m.base[1 - foot]
    if speed > SLOW:
        for shift in SHIFTS:
            shift_x, shift_z = shift * along_x / speed, shift * along_z / speed
            if _under(m, tops, floor, x + shift_x, z + shift_z, c, s, out) and abs(out[0] - other) <= STEP:
                m.land[foot, 0], m.land[foot, 1] = shift_x, shift_z
                return True, shift, speed
    found = _under(m, tops, floor, x, z, c, s, out)
    if speed > SLOW and abs(out[0] - other) > STEP:
        found, out[0], out[1], out[2] = False, other, 0.0, 0.0
    return found, 0.0, speed


@kernel
def _under(m, tops, floor, x, z, c, s, out):
    """The ground (3,) under a foot whose ball is at x, z in the world, heading with cosine c and sine s; whether heel and
    ball have the same under them, and the toes are clear."""
    heel, toe = np.empty(3), np.empty(3)
    found = ground_kernel(tops, x, z, floor, m.level, out)
    found = ground_kernel(tops, x - FOOT * s, z - FOOT * c, floor, m.level, heel) and found
    there = heel[0] + FOOT * (s * heel[1] + c * heel[2])
    whole = found and abs(there - out[0]) < SAME
    if ground_kernel(tops, x + TOE * s, z + TOE * c, floor, m.level, toe):  # toes may hang over an edge, but not be in a riser
        whole = whole and toe[0] < out[0] + TOE * (s * out[1] + c * out[2]) + SAME
    if there > out[0]:
        out[0], out[1], out[2] = there, heel[1], heel[2]
    return whole


@kernel
def lie_kernel(m, k):
    """How high the ground under contact point k lies over the body's level [m]."""
    foot = k // 2
    lie = m.base[foot] - m.level
    if k == 2 * foot and (m.tilt[foot, 0] != 0.0 or m.tilt[foot, 1] != 0.0):
        x, z = m.points[k, 0] - m.points[k + 1, 0], m.points[k, 2] - m.points[k + 1, 2]
        c, s = math.cos(m.ground[2] + m.offset[foot, 2]), math.sin(m.ground[2] + m.offset[foot, 2])
        lie += m.tilt[foot, 0] * (c * x + s * z) + m.tilt[foot, 1] * (c * z - s * x)
    return lie


@kernel
def rise_ahead(m, foot):
    """How the ground under a foot rises to where its toes point."""
    if m.tilt[foot, 0] == 0.0 and m.tilt[foot, 1] == 0.0:
        return 0.0
    x, z = m.points[2 * foot + 1, 0] - m.points[2 * foot, 0], m.points[2 * foot + 1, 2] - m.points[2 * foot, 2]
    c, s = math.cos(m.ground[2] + m.offset[foot, 2]), math.sin(m.ground[2] + m.offset[foot, 2])
    return (m.tilt[foot, 0] * (c * x + s * z) + m.tilt[foot, 1] * (c * z - s * x)) / (math.hypot(x, z) + 1e-9)


@kernel
def stand_on(m):
    """Tell heights over the ground of the foot that stands firmly, from now on, and return how much higher that is [m]."""
    rise = 0.0
    for foot in range(2):
        if max(m.grip[2 * foot], m.grip[2 * foot + 1]) >= 1.0:
            rise = m.base[foot]
    m.level -= rise
    for foot in range(2):
        m.base[foot] -= rise
        m.left[foot] -= rise
    return rise
