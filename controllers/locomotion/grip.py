"""How firmly the points of feet grip the floor, and what that takes from the blend's movement.

For each foot two points are watched, heel and ball: 0 … 1, from the blend's labels. A point that grips takes none of the blend's movement, one that is free takes all
of it, and between them a share: so a foot comes to stand, and leaves, without a jump of speed.
"""

from __future__ import annotations

import math

from ..body import spring_kernel
from ..compiled import kernel
from ..navigation.passing import STEP
from .first_stride import shift_left
from .kernel import LABELS_AT
from .memory import WALK
from .root_motion import sooner
from .short_leg import STRAINED
from .swing import swing_progress
from .treads import FOOT
from .uneven_ground import lie_kernel

TAKING, LEAVING = (0.05, 0.35), ((0.2, 0.9), (0.5, 0.95))
"""A point is free while its blended label is below the first, and held while it is above the second: early as it
comes to stand, so that it does not creep in, and early as it leaves, walking and running, so that the leg is not held
back …"""
GATE = 0.035
"""… and takes hold only when it is lower than this above where it rests [m], a heel as it has risen for its leg: it was held 12 cm up as a turn began, and its knee thrown."""
HELD_UP = (0.012, 0.03)
"""… and the less, the higher its foot is still held over the floor to clear it, between these [m]: whose steps of a turn are long, or who comes to walk from a run, was let down by 4 cm within four steps."""
GRIP_RATE = 30.0, 25.0
"""How fast a grip may change [1/s]: walking, where both feet are as high; and on stairs, where a foot that stops sooner ends in a riser, and running, since who runs pushes only while a foot
grips."""
NEAR, ENDS, SLOW = (0.006, 0.014), (0.8, 1.2), 0.7
"""A walker's point takes hold before its label does, too, as it has come down: the surer the lower it is between these above where it rests [m], around the end of its swing, over the time of
that, and slower than the last [m/s]. Heels were on the floor and glided on at 0.3 m/s for up to four frames."""
EARLY = 1.5, 1.1
"""On even ground what has come to stand holds on until so long after its swing began, over the time of that, walking and running: labels waver, and are lower in the other gait, as a walker
who has just come down becomes a runner; half let go for a frame or two, a heel went on by 1.7 cm."""
STOPPED = 60.0
"""A walker's foot is stopped no harder than this [m/s²]: where a run becomes a walk just before a strike it comes down at 3.5 m/s, and stood within a frame."""
AIM_HALFLIFE = 0.02
"""A foot that is about to stand on a place that it chose comes to it with this half-life [s]."""
LAND_HALFLIFE = 0.03
"""A point comes down to the floor, or back to the blend's height, with this half-life [s]."""
FLAT_HALFLIFE = 0.06
"""A walker's ball comes down after its heel with this half-life [s], however high a pose that fades has it: feet stood on their heels for a fifth of a second."""
LEAVES, LENT = -1.0, 0.3
"""A ball whose label falls faster than this [1/s], its heel free by more than the second, does not hold on again: its leg would be stretched, and whip."""
LATE, RISEN = 2.0, 0.05
"""Nor does a heel so long after its swing began, over the time of that, its ball firm, or risen for its leg by more than the second [rad]: it has begun to leave. It was pulled down within a frame as a turn began."""
LEFT = 0.85, 0.97
"""On even ground a point that grips less than the first so late leaves, and a ball that its heel's rise strains less than the second; they do not drag for the rest of their stance: labels waver
there as somebody turns."""

LEFT_ALREADY = 0.2
"""Nor does a point that is free take hold over so much of a swing's time after it began: for a step or two, as labels waver, its foot was stopped and let go."""


@kernel
def _grip_rate(m, speed):
    """How fast the grip of a point may change [1/s] that goes so fast [m/s]."""
    if m.family != WALK or m.base[0] != m.base[1]:
        return sooner(m) * GRIP_RATE[1]
    return min(sooner(m) * GRIP_RATE[0], STOPPED / max(speed, 1e-3))


@kernel
def take_foot(m, foot, height, before, now, dt):
    """How firmly a foot's heel and ball grip after dt; one that begins to goes on as it swung, the less the firmer it grips. before, now: (4, 2) where the blend's points
    were and are, in the world [m]."""
    swung = m.grip[2 * foot] <= 0.0 and m.grip[2 * foot + 1] <= 0.0
    aside = m.aside_rate[foot]
    if swung:
        aside[0], aside[1] = aside[0] + m.offset_rate[foot, 0], aside[1] + m.offset_rate[foot, 1]
    for k in range(2 * foot, 2 * foot + 2):
        speed = math.hypot((now[k, 0] - before[k, 0]) / dt + aside[0], (now[k, 1] - before[k, 1]) / dt + aside[1])
        _take_hold(m, k, height, speed, dt)
    if swung and m.grip[2 * foot] <= 0.0 and m.grip[2 * foot + 1] <= 0.0:
        aside[0], aside[1] = aside[0] - m.offset_rate[foot, 0], aside[1] - m.offset_rate[foot, 1]


@kernel
def _take_hold(m, k, height, speed, dt):
    """How firmly point k grips: fully at rest, until a start leaves it and once a stop has set it down, else by its blended label, no less while that rises or it has just come
    down, and only once it is low. speed: how fast it goes [m/s]."""
    wanted, left, even = 1.0, 0.0, m.base[0] == m.base[1]
    if not (m.settled or m.waits or shift_left(m) > 0.0):
        loose, firm = TAKING if m.row_rate[LABELS_AT + k] > 0.0 else LEAVING[m.family]
        share = min(max((m.row[LABELS_AT + k] - loose) / (firm - loose), 0.0), 1.0)
        strain = min(max((m.rise[k // 2] - STRAINED[0]) / (STRAINED[1] - STRAINED[0]), 0.0), 1.0) if k % 2 else 0.0
        if not even:  # on stairs who lets go of one foot stands on the other
            other = 2 * (1 - k // 2)
            strain *= max(m.grip[other], m.grip[other + 1])
        wanted = share * share * (3.0 - 2.0 * share) * (1.0 - (1.0 - m.grip[2 * (k // 2)]) * strain * strain * (3.0 - 2.0 * strain))
        if m.torn[k // 2]:  # it was let go, until it is well into its swing
            wanted = 0.0
            if 0.3 < swing_progress(m, k // 2) < 1.0:
                m.torn[k // 2] = 0
        elif even and (m.row_rate[LABELS_AT + k] > 0.0 or ENDS[0] < swing_progress(m, k // 2) < EARLY[m.family]):
            wanted = max(wanted, m.grip[k])
        if even and swing_progress(m, k // 2) > LATE:
            left = LEFT[1] if strain > 0.0 else LEFT[0]
        wanted = max(wanted, _touches(m, k, height, speed))
    risen = FOOT * math.sin(max(m.rise[k // 2], 0.0)) if k % 2 == 0 else 0.0
    if wanted > m.grip[k] and m.lift[k // 2] > HELD_UP[0] and not (m.settled or m.waits):
        high = min((m.lift[k // 2] - HELD_UP[0]) / (HELD_UP[1] - HELD_UP[0]), 1.0)
        wanted = max(m.grip[k], wanted * (1.0 - high * high * (3.0 - 2.0 * high)))
    if wanted > m.grip[k] and not m.settled and (
            m.points[k, 1] + m.raised[k] + risen > height + lie_kernel(m, k) + GATE or GATE < m.high[k // 2] <= STEP):  # over nothing it stands: and falls
        wanted = m.grip[k]
    if wanted > m.grip[k] and m.lent[k // 2] > LENT:
        if k % 2:
            leaves = m.row_rate[LABELS_AT + k] < LEAVES
        else:
            leaves = not (m.settled or m.waits) and (m.grip[k + 1] >= 1.0 or m.rise[k // 2] > RISEN) and swing_progress(m, k // 2) > LATE
        if leaves:
            wanted = m.grip[k]
    if m.grip[k] < left or even and m.grip[k] <= 0.0 and swing_progress(m, k // 2) < LEFT_ALREADY and not (m.settled or m.waits or shift_left(m) > 0.0):
        wanted = 0.0
    step = dt * _grip_rate(m, speed)
    m.grip[k] += min(max(wanted - m.grip[k], -step), step)
    m.standing[k] = 1 if m.grip[k] > 0.5 else 0


@kernel
def _touches(m, k, height, speed):
    """How surely (0 … 1) a walker's point k, which goes so fast [m/s], has come down to even ground as its swing ends, slowly, or has begun to stand."""
    if m.family != WALK or m.base[0] != m.base[1] or m.torn[k // 2] == 1 or not ENDS[0] < swing_progress(m, k // 2) < ENDS[1]:
        return 0.0
    if m.grip[k] <= 0.0 and speed > SLOW:
        return 0.0
    above = m.points[k, 1] + m.raised[k] - height - lie_kernel(m, k)
    share = min(max((NEAR[1] - above) / (NEAR[1] - NEAR[0]), 0.0), 1.0)
    return share * share * (3.0 - 2.0 * share)


@kernel
def come_down(m, foot, height, dt):
    """Bring a foot's heel and ball to the floor as they grip it, else to the blend's height; a walker's ball as its heel does."""
    heel = 2 * foot
    for k in range(heel, heel + 2):
        share, halflife = m.grip[k], LAND_HALFLIFE
        if k > heel and share <= 0.0 and m.family == WALK and m.base[0] == m.base[1]:
            stands = m.grip[heel] * min(max(m.row[LABELS_AT + k], 0.0), 1.0)
            if stands > 0.0:
                share, halflife = stands, FLAT_HALFLIFE
        below = lie_kernel(m, k) + share * (height - m.points[k, 1])
        m.raised[k], m.raised_rate[k] = spring_kernel(m.raised[k], m.raised_rate[k], below, halflife, dt)


@kernel
def _pivot(heel, ball):
    """About which point a foot turns whose heel and ball grip so firmly: 0 its ball, 1 its heel. About the one that is held, however firmly the other drags."""
    free_heel, free_ball = heel * (1.0 - ball), ball * (1.0 - heel)
    return free_heel / (free_heel + free_ball) if free_heel + free_ball > 1e-6 else heel / (heel + ball)


@kernel
def hold_kernel(m, foot, before, now, dt):
    """Take from a foot that stands, or has begun to, as much of the blend's movement as it grips: the offset of what is shown from the
    blend, x, z of the ball in the world and the foot's turn."""
    h, b = 2 * foot, 2 * foot + 1
    offset, rate = m.offset[foot], m.offset_rate[foot]
    grip = max(m.grip[h], m.grip[b])
    goes_on = 1.0 - grip if m.base[0] == m.base[1] else 0.0  # on a tread it stays where it came down
    for i in range(2):  # as far as it gave way it stays aside, once it has come to a stop there
        m.aside_rate[foot, i] *= goes_on
        offset[i] += m.aside[foot, i] + m.aside_rate[foot, i] * dt
        m.aside[foot, i] = 0.0
    if m.aimed[foot] == 1 and grip < 1.0:  # to the very place that it chose
        for i in range(2):
            offset[i] += (m.land[foot, i] - offset[i]) * (1.0 - grip) * (1.0 - 2.0 ** (-dt / AIM_HALFLIFE))
    heel = _pivot(m.grip[h], m.grip[b])
    was_x, was_z = before[h, 0] - before[b, 0], before[h, 1] - before[b, 1]
    x, z = now[h, 0] - now[b, 0], now[h, 1] - now[b, 1]
    blended = math.atan2(was_z * x - was_x * z, was_x * x + was_z * z)
    c, s = math.cos(offset[2]), math.sin(offset[2])
    px = before[b, 0] + offset[0] + heel * (c * was_x + s * was_z)
    pz = before[b, 1] + offset[1] + heel * (c * was_z - s * was_x)
    px += (1.0 - grip) * (now[b, 0] - before[b, 0] + heel * (x - was_x))
    pz += (1.0 - grip) * (now[b, 1] - before[b, 1] + heel * (z - was_z))
    turn = offset[2] - m.grip[h] * m.grip[b] * blended
    c, s = math.cos(turn), math.sin(turn)
    px -= now[b, 0] + heel * (c * x + s * z)
    pz -= now[b, 1] + heel * (c * z - s * x)
    rate[0], rate[1], rate[2] = (px - offset[0]) / dt, (pz - offset[1]) / dt, (turn - offset[2]) / dt
    offset[0], offset[1], offset[2] = px, pz, turn
    m.offset_push[foot, 0] = m.offset_push[foot, 1] = m.offset_push[foot, 2] = 0.0
    m.swing[foot] = math.sqrt(px * px + pz * pz)
