"""Ground that is not flat: how high it lies under each foot, and the body over both.

Heights are told over the character's own floor, on which it stood last; a top that is farther above or below than a
step is no ground for a foot (`tops`). Where a foot comes down is another's matter (`treads`).
"""

from __future__ import annotations

import math

import numpy as np

from ..compiled import kernel
from ..navigation.passing import STEP
from .before_edges import edge_ahead
from .body_level import lead_level
from .foot_points import ball_kernel, shown_kernel
from .memory import WALK
from .minimum_jerk import smooth
from .root_motion import sooner
from .swing import SAMPLES, line_ahead, swept_line
from .tops import SAME, ground_kernel
from .treads import FOOT, TOE, TURNS, come_down, most_speed, on_stairs, steps_kernel, under_kernel

ASTRAY = 0.06
"""A foot that came down farther than this from where it was to stands on what lies there [m]."""
RECOVERS = 0.35
"""Who slowed down for short steps takes up speed again by so much of the wish a second."""
RISES, SINKS = 0.4, 0.5
"""A foot that goes up is up after this share of its swing; one that goes down stays up for that share of it."""
DROPS, CLIMBS, OF_RUNNERS = 2.0, 3.0, 0.5
"""A foot that must stay over an edge goes down no faster than the first afterwards, nor up faster than the second [m/s], and by the third faster the more he runs on stairs; faster, too, as he
steps oftener there."""
HASTE = 50.0, 100.0, 200.0
"""A foot on its way up gets faster and slower by no more than the first [m/s²] of who runs, walks backward or aside, and the second of who walks ahead, whose
knee is bent as it leaves: a straight one would be thrown; by so much more of who runs on stairs; all by the square of how much oftener he steps there."""
GOES_ON = 0.5
"""… and all of it of who goes ahead this fast [m/s]: who sets off before a riser has time, and his foot was thrown up by 8 cm in a frame."""
LETS_GO = 0.5
"""A foot whose points grip no firmer than this together may go up before a riser."""
TILT_HALFLIFE = 0.05
"""A foot takes on the slope that it will come down on with this half-life [s]."""
RISER = 0.06
"""What lies so much higher before or behind a foot is no slope [m]."""
BETWEEN, SOME = 20, 6
"""So many places on a foot's way are looked at for what it must pass over; and for whether there is anything."""
SOON = 0.03
"""A foot that goes aside is looked for where it will be so much later [s]."""
REACHES = 0.08
"""A foot that goes up is up so far before a riser [m]."""
TOUCHES, VOID = 0.035, 0.25
"""A point higher than the first over the ground does not touch it, and a foot higher than the second stands on nothing [m]."""


@kernel
def follow_ground(m, body, height, ahead, goes, tops, floor, swing, dt):
    """Lead on the ground under each foot, where it stands or from where it left to where it will come down, and the
    body's level, which follows both. ahead: of the blend's feet (`foothold`); goes: (4, 2) how fast their points go in the world [m/s]. swing: the share of the cycle for which a foot swings."""
    under, place, bears, line = np.empty(3), np.empty(2), np.empty(2), np.empty((3, 2))
    bent = max(m.velocity[0], 0.0) / max(math.hypot(m.velocity[0], m.velocity[2]), 0.1) if m.family == WALK else 0.0
    goes_on = min(max(m.velocity[0], 0.0) / GOES_ON, 1.0)
    faster, soon = sooner(m), 1.0 + goes_on * (sooner(m) - 1.0)
    haste = (HASTE[0] + (HASTE[1] + HASTE[2] * m.runner - HASTE[0]) * bent * goes_on) * soon * soon
    goals = np.empty(2)
    for foot in range(2):
        bears[foot] = goals[foot] = m.base[foot]
        ball = 2 * foot + 1
        firm = max(m.grip[ball - 1], m.grip[ball]) >= 1.0
        if firm and m.held[foot] == 1:
            _left_at(m, foot, place)
            continue
        passed = ((m.phase - 0.5 * foot) % 1.0) / swing
        progress = min(passed, 1.0)
        aim = m.aim[foot]
        if firm:
            m.climb[foot] = 0.0
        if firm or progress >= 1.0:  # it is down: on what lies under it, or it is about to leave that
            if m.held[foot] == 0 or firm:
                ball_kernel(m, foot, place)
                c, s, x, z = math.cos(m.ground[2]), math.sin(m.ground[2]), place[0], place[1]
                if m.aimed[foot] == 0 or math.hypot(x - aim[0], z - aim[1]) > ASTRAY:
                    under_kernel(m, tops, floor, x, z, c, s, under)
                    if under[0] < m.base[1 - foot] - STEP and _upheld(m, tops, floor, 1 - foot, place) and steps_kernel(m, foot, under, x - place[0], z - place[1]) < -STEP:
                        under[0], under[1], under[2] = aim[2] - floor if m.aimed[foot] == 1 else m.base[1 - foot], 0.0, 0.0
                else:
                    under[0] = aim[2] - floor + aim[3] * (x - aim[0]) + aim[4] * (z - aim[1])
                    under[1], under[2] = aim[3], aim[4]
                    if not firm and abs(m.velocity[1]) > TURNS:  # the blend's foot turns with its body by now: it is led to the place, not with that
                        for i in range(2):
                            m.land[foot, i] = aim[i] - (place[i] - m.offset[foot, i] - m.aside[foot, i])
                m.base[foot] += min(max(under[0] - m.base[foot], -DROPS * dt), CLIMBS * dt)
                m.tilt[foot, 0], m.tilt[foot, 1] = under[1], under[2]
                m.high[foot] = m.base[foot] - under[0]
                _left_at(m, foot, place)
            else:
                m.base[foot] = _loose(m, tops, floor, foot, place, haste, dt)
            bears[foot] = m.left[foot]
            if firm and abs(m.high[foot]) < 1e-6:
                m.held[foot], m.aimed[foot] = 1, 0
            continue
        m.held[foot] = 0
        come_down(m, tops, floor, foot, progress, under)
        goals[foot] = under[0]
        share = progress / RISES if under[0] > m.left[foot] else (progress - SINKS) / (1.0 - SINKS)
        path = m.left[foot] + (under[0] - m.left[foot]) * smooth(share)
        along = _along(m, foot, place)
        rising = min(along, under[0])
        if under[0] <= m.left[foot]:  # down a slope, which it left: along it
            rising = path = min(path, max(along, under[0]))
        over = _between(m, body, height, ahead, goes, tops, floor, foot, max(under[0], m.left[foot]), line)
        if abs(under[0] - m.left[foot]) > SAME:
            path = max(path, _beneath(m, tops, floor, foot, max(under[0], m.left[foot]) + SAME, place))
        bearing = path
        if under[0] > m.base[foot] > m.left[foot] + SAME and progress < RISES:  # a riser has sent it up already: on it goes, evenly
            later = (RISES - progress) / (1.0 - progress) * ahead.until[foot]
            path = max(path, m.base[foot] + (under[0] - m.base[foot]) * dt / max(later, dt))
        if over > max(under[0], m.left[foot]) + SAME:  # a foot passes over it, the body does not rise for that
            up, down = smooth(progress / RISES), smooth((progress - SINKS) / (1.0 - SINKS))
            path = max(path, min(m.left[foot] + (over - m.left[foot]) * up, over + (under[0] - over) * down),
                       _beneath(m, tops, floor, foot, over + SAME, place))
        before, goal = m.base[foot], max(path, rising, m.base[foot] - faster * DROPS * dt)
        m.base[foot] = min(goal, before + _rises(m, foot, goal - before, haste, soon * (CLIMBS + OF_RUNNERS * m.runner * goes_on), dt))
        m.climb[foot] = max(m.base[foot] - before, 0.0) / dt
        m.high[foot] = m.base[foot] - under[0]
        bears[foot] = min(m.base[foot], bearing)
        if under[0] < m.left[foot]:  # the body sinks all the way down
            bears[foot] = m.left[foot] + (under[0] - m.left[foot]) * progress * progress * (3.0 - 2.0 * progress)
        for i in range(2):
            m.tilt[foot, i] += (under[1 + i] - m.tilt[foot, i]) * (1.0 - 2.0 ** (-dt / TILT_HALFLIFE))
    lead_level(m, bears, goals, goes_on, faster, place, dt)
    m.stairs, m.brink = on_stairs(m, tops, floor), edge_ahead(m, tops, floor)
    m.most = 0.0 if m.alert and m.stairs == 0.0 else most_speed(m, tops, floor)  # who wants to leap may go at what he leaps onto, but runs on no treads that feet can't find


@kernel
def _loose(m, tops, floor, foot, place, haste, dt):
    """How high the ground lies under a foot that has stood and has let go, or nearly, before it swings: over a riser that it comes to, up as its swing goes on to. Who steps back comes to none: his foot was
    thrown up for a frame or two, and dropped as it swung."""
    high = goal = _along(m, foot, place)
    if m.velocity[0] > 0.0 and m.grip[2 * foot] + m.grip[2 * foot + 1] <= LETS_GO and (m.base[foot] > high + SAME or _goes_over(m, tops, floor, foot)):
        riser = _beneath(m, tops, floor, foot, m.left[foot] + STEP + SAME, place)
        goal = riser if riser > high + RISER else high
    before = m.base[foot]
    lifted = before > high + SAME or goal > high
    now = max(goal, before - DROPS * dt) if lifted else high
    if now > before:
        now = min(now, before + _rises(m, foot, now - before, haste, DROPS, dt))
    m.climb[foot] = max(now - before, 0.0) / dt if lifted else 0.0
    m.high[foot] = now - high  # it takes no hold up there
    return now


@kernel
def _goes_over(m, tops, floor, foot):
    """Whether something that can be stepped on lies higher on the way of a foot that leaves to where it will come down: who turns beside a riser has none."""
    ground = np.empty(3)
    for k in range(SOME):
        share = (k + 1.0) / SOME
        x = m.left_at[foot, 0] + share * (m.coming[foot, 1, 0] + m.land[foot, 0] - m.left_at[foot, 0])
        z = m.left_at[foot, 1] + share * (m.coming[foot, 1, 1] + m.land[foot, 1] - m.left_at[foot, 1])
        if ground_kernel(tops, x, z, floor, m.level, ground) and RISER < ground[0] - m.left[foot] < 2.0 * STEP + SAME:
            return True
    return False


@kernel
def _rises(m, foot, left, haste, most, dt):
    """How far a foot goes up in dt that still has so far to go up [m], no faster than `most` [m/s]."""
    return min(m.climb[foot] + haste * dt, most, math.sqrt(2.0 * haste * max(left, 0.0))) * dt


@kernel
def _between(m, body, height, ahead, goes, tops, floor, foot, highest, line):
    """How high the ground lies at most between where a foot left and where it comes down, and below its way from now on from heel to tip, slopes apart,
    as far as it can be stepped over from `highest`: as far aside as it gives way. goes: (4, 2) how fast the blend's contact points go [m/s]; line: (3, 2) scratch."""
    ground, most = np.empty(3), -1e9
    for k in range(BETWEEN):
        share = (k + 1.0) / (BETWEEN + 1.0)
        x = m.left_at[foot, 0] + share * (m.coming[foot, 1, 0] + m.land[foot, 0] - m.left_at[foot, 0])
        z = m.left_at[foot, 1] + share * (m.coming[foot, 1, 1] + m.land[foot, 1] - m.left_at[foot, 1])
        if ground_kernel(tops, x, z, floor, m.level, ground) and ground[0] <= highest + STEP:
            most = max(most, ground[0])
    for k in range(SAMPLES):
        if m.turn != 0.0 or 0.0 < ahead.shares[foot, k] < 1.0:
            if ahead.shares[foot, k] > 0.0:
                line_ahead(m, foot, ahead, k, height, line)
            else:
                swept_line(m, body, foot, ahead, goes, (k + 0.5) / SAMPLES, height, line)
            for i in range(3):
                line[i, 0] += m.aside[foot, 0] + SOON * m.aside_rate[foot, 0]
                line[i, 1] += m.aside[foot, 1] + SOON * m.aside_rate[foot, 1]
                found = ground_kernel(tops, line[i, 0], line[i, 1], floor, m.level, ground)
                if found and ground[0] <= highest + STEP and ground[1] == 0.0 and ground[2] == 0.0:  # soles lie along a slope
                    most = max(most, ground[0])
    return most


@kernel
def _upheld(m, tops, floor, foot, place):
    """Whether a foot has the ground under it that it stands on: who set one foot over an edge has the other one still there."""
    ground = np.empty(3)
    ball_kernel(m, foot, place)
    ground_kernel(tops, place[0], place[1], floor, m.level, ground)
    return ground[0] > m.base[foot] - STEP


@kernel
def _left_at(m, foot, place):
    """Note the ground that a foot is on, and where its ball is, as what it will have left."""
    ball_kernel(m, foot, place)
    m.left[foot], m.left_at[foot, 0], m.left_at[foot, 1] = m.base[foot], place[0], place[1]


@kernel
def leave_level(m):
    """Note where feet stand while nothing is about: what comes about in mid-swing is passed over from there on."""
    place = np.empty(2)
    for foot in range(2):
        m.kept[foot] = 0
        if max(m.grip[2 * foot], m.grip[2 * foot + 1]) >= 1.0:
            _left_at(m, foot, place)


@kernel
def _along(m, foot, place):
    """How high the ground that a foot has left lies under it now, if it goes on as it rose there."""
    ball_kernel(m, foot, place)
    return m.left[foot] + m.tilt[foot, 0] * (place[0] - m.left_at[foot, 0]) + m.tilt[foot, 1] * (place[1] - m.left_at[foot, 1])


@kernel
def _beneath(m, tops, floor, foot, highest, place):
    """How high the ground lies that a swinging foot is over, from its heel to its toes' end and a little on, as what its ball is to be over: a sole lies as its foot is tilted. None above `highest`."""
    ground, high = np.empty(3), -1e9
    shown_kernel(m, 2 * foot, place)
    heel_x, heel_z = place[0], place[1]
    shown_kernel(m, 2 * foot + 1, place)
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    size = max(math.hypot(place[0] - heel_x, place[1] - heel_z), 0.25 * FOOT)
    for k in range(4):  # heel, ball, toes' end, which lie flat however high the heel is
        along = (0.0, 1.0, 1.0 + TOE / size, 1.0 + (TOE + REACHES) / size)[k]
        x, z = heel_x + along * (place[0] - heel_x), heel_z + along * (place[1] - heel_z)
        if ground_kernel(tops, m.ground[0] + c * x + s * z, m.ground[1] - s * x + c * z, floor, m.level, ground) and ground[0] < highest:
            x, z = x - place[0], z - place[1]
            high = max(high, ground[0] - m.tilt[foot, 0] * (c * x + s * z) - m.tilt[foot, 1] * (c * z - s * x))
    return high


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


@kernel
def touch(m, body, hip, foot, height, tops, floor, positions, orientations):
    """Note which points of a foot, held or not, are off the ground where they are shown: over an edge, or on their way; none of a foot
    that stands on nothing, and is about to fall. hip: the joint that its leg hangs on."""
    ground, point, over, c, s = np.empty(3), np.empty(3), np.empty(2), math.cos(m.ground[2]), math.sin(m.ground[2])
    for k in range(2):
        for i in range(3):
            point[i] = positions[hip + 2 + k, i]
            for j in range(3):
                point[i] += (1 - k) * orientations[hip + 2, i, j] * body.heel[j]
        x, y, z = point[0], point[1], point[2]
        ground_kernel(tops, m.ground[0] + c * x + s * z, m.ground[1] - s * x + c * z, floor, m.level, ground)
        over[k] = y + m.level - height - ground[0]
    for k in range(2):
        m.off[2 * foot + k] = 1 if over[k] > TOUCHES and min(over[0], over[1]) < VOID else 0
