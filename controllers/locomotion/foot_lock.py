"""Footing: feet that stand do not move, feet that swing arrive without a jump.

What is shown is the blend's foot plus an offset along the floor and a turn, which keeps a foot that grips the floor (`grip`)
where it is. While a foot swings its offset goes to that of its foothold by the time it lands (`swing`).
The foot is turned so that it passes through both points, the toe bends so that it does not sink, and the leg follows
by two-bone inverse kinematics. A leg that is too short first lifts its heel about the ball, as legs do, then lowers
the pelvis a little, and only then lets go.
"""

from __future__ import annotations

import math

import numpy as np

from ..body import relative_kernel, spring_kernel
from ..compiled import kernel
from .foot_points import on_floor, shown_kernel
from .grip import come_down, hold_kernel, take_foot
from .last_stride import BESIDE, OFF, STAYS
from .legs import REACH, leg_kernel, leg_length, tilt_kernel, toe_kernel
from .root_motion import as_runner
from .short_leg import give_way, lacks_kernel, lower_heel, nearer_kernel
from .swing import SWING, swing_kernel, swing_progress
from .swing_height import lead_up, led_up
from ..navigation.passing import STEP
from .uneven_ground import RECOVERS, follow_ground, leave_level, lie_kernel, rise_ahead, touch

RUNNER_HALFLIFE = 0.1
"""Who runs onto stairs, or off them, comes to a runner's steps there, or leaves them, with this half-life [s]."""
STEEPLY, FREED = (2.5, 1.2), 0.02
"""A point that leaves its place, walking and running, is lifted by so many times as far as it got, less and less and up to the second [m]."""
HELD_AGAIN = 0.4
"""Over so much of a swing's time after it came down a point is still held, not yet about to leave."""
LIFT_HALFLIFE = 0.02
"""How fast a swinging foot is lifted over the floor it must clear [s]."""
PELVIS_HALFLIFE = 0.08
"""The pelvis follows what the legs need with this half-life [s]."""
PELVIS_DROP = 0.05, 0.03
"""The most that short legs may lower the pelvis [m], on level ground and, beside half of what feet are apart in height, elsewhere."""
DOWN, BENDS = 0.12, 0.012
"""Whoever stands on a slope stands lower, by the first at most [m], for both heels to be down: on legs that are the second shorter than straight."""
ANCHOR_HALFLIFE = 0.03
"""A foot's weight rolls from heel to ball with this half-life [s]."""
TOE_HALFLIFE = 0.045
"""Toes that leave the floor bent straighten with this half-life [s]: free at once, they snapped by up to 40° in a frame."""
OVER = 0.3
"""A foot swings higher by this share of how much higher or deeper the other stands."""
CLOSE = 0.06
"""A body comes to rest once its feet are this near to where they belong [m]."""


@kernel
def place_feet(m, body, legs, ahead, clearance, tops, floor, before, positions, orientations, local, dt, work):
    """Hold standing feet, land swinging ones, bend the legs after them.

    ahead: of the blend's feet (`foothold`). tops, floor: of the ground (`uneven_ground`). before: (4, 2) where the blend's contact points were one step ago, in
    the world.
    """
    ankle, now, lift, clears = np.empty((2, 3)), np.empty((4, 2)), np.empty(2), np.empty(2)
    length, asked, firm = np.empty(2), np.empty(2), np.empty(2)
    on_floor(m, now)
    m.most = m.stairs = m.high[0] = m.high[1] = 0.0
    m.off[:] = 0
    if tops.shape[0] > 0:
        follow_ground(m, body, legs.height, ahead, (now - before) / dt, tops, floor, SWING[m.family], dt)
    else:
        leave_level(m)
        m.brink = 0.0
    m.pace = min(m.pace + RECOVERS * dt, 1.0)
    m.runner += ((as_runner(m) if m.stairs > 0.0 else 0.0) - m.runner) * (1.0 - 2.0 ** (-dt / RUNNER_HALFLIFE))
    even = m.base[0] == m.base[1] and abs(m.tilt[0, 0]) + abs(m.tilt[0, 1]) + abs(m.tilt[1, 0]) + abs(m.tilt[1, 1]) == 0.0
    for foot in range(2):
        take_foot(m, foot, legs.height, before, now, dt)
        clears[foot] = clearance + OVER * abs(m.base[foot] - m.left[foot])
        if even and m.stairs <= 0.0 and led_up(m, foot, ahead):
            lead_up(m, foot, ahead, legs.height, swings_over(m, foot, clears[foot]), dt)
        else:
            come_down(m, foot, legs.height, dt)
    for foot in range(2):  # both, since who swings passes where the other stands now
        if m.grip[2 * foot] > 0.0 or m.grip[2 * foot + 1] > 0.0:
            hold_kernel(m, foot, before, now, dt)
    for foot in range(2):
        if m.grip[2 * foot] <= 0.0 and m.grip[2 * foot + 1] <= 0.0:
            ball = 2 * foot + 1
            swing_kernel(m, body, foot, ahead, (now[ball, 0] - before[ball, 0]) / dt, (now[ball, 1] - before[ball, 1]) / dt, legs.height, tops, floor, dt)
        lift[foot] = _swing_lift(m, foot, clears[foot], dt)
    need = m.lower = 0.0
    lowered = m.pelvis if even else 0.0  # on stairs, whose feet reach far down, heels rise first
    for foot in range(2):
        for j in range(legs.hip[foot], legs.hip[foot] + 3):
            positions[j, 1] -= lowered
    stands = tops.shape[0] > 0 and (m.settled or m.waits) and not even
    for foot in range(2):
        hip = legs.hip[foot]
        _turn_foot(m, body, foot, hip + 2, legs.height, lift[foot], orientations, ankle[foot], dt, work)
        reach = (REACH - 0.001) * leg_length(body, hip)
        if stands:
            m.lower = max(m.lower, min(lowered + lacks_kernel(positions[hip], ankle[foot], reach - BENDS) + m.middle - m.level, DOWN))
        lacks = lacks_kernel(positions[hip], ankle[foot], reach) if even and m.grip[2 * foot] > 0.5 and ankle[foot, 2] > positions[hip, 2] else -1.0
        missing, length[foot], firm[foot], asked[foot] = give_way(m, body, foot, hip, reach, m.pelvis - lowered, positions, orientations, ankle[foot], dt, work)
        need = max(need, lowered + max(lacks, missing))
    most = PELVIS_DROP[0] if even else PELVIS_DROP[1] + 0.5 * min(abs(m.base[1] - m.base[0]), STEP)
    need = min(need, most)
    drop, m.pelvis_rate = spring_kernel(m.pelvis, m.pelvis_rate, need, PELVIS_HALFLIFE, dt)
    m.pelvis = min(max(drop, 0.0), most)
    for foot in range(2):
        hip = legs.hip[foot]
        for j in range(hip, hip + 3):
            positions[j, 1] -= m.pelvis - lowered
        if not even:
            lower_heel(m, body, foot, hip, length[foot], m.pelvis - lowered, positions, orientations, ankle[foot], work)
        nearer_kernel(positions[hip], ankle[foot], length[foot], asked[foot], firm[foot], REACH * leg_length(body, hip))
        leg_kernel(positions, orientations, hip, ankle[foot], work)
        toes = legs.height + lie_kernel(m, 2 * foot + 1) + body.toe_end[2] * rise_ahead(m, foot)
        _bend_toes(m, body, foot, hip + 2, toes + lift[foot], positions, orientations, local, dt, work)
        relative_kernel(orientations[0], orientations[hip], local[hip])
        relative_kernel(orientations[hip], orientations[hip + 1], local[hip + 1])
        relative_kernel(orientations[hip + 1], orientations[hip + 2], local[hip + 2])
        if tops.shape[0] > 0:
            touch(m, body, hip, foot, legs.height, tops, floor, positions, orientations)


@kernel
def _turn_foot(m, body, foot, a, height, lift, orientations, ankle, dt, work):
    """Turn foot 0 or 1 (joint a) by the smallest rotation that points it from heel to ball as they
    shall be, and write where its ankle then must be (3,): hung on the ball, or on the heel."""
    heel, ball = 2 * foot, 2 * foot + 1
    axis, turned, h, b = work[0, 0], work[1], work[2, 0], work[2, 1]
    for k, out in ((heel, h), (ball, b)):
        shown_kernel(m, k, out)
        out[2] = out[1]
        free = (1.0 - m.grip[k]) * max(lift, _off_the_floor(m, k, foot, out[0], out[2]))
        out[1] = max(m.points[k, 1] + m.raised[k], height + lie_kernel(m, k) + free)
    x, y, z = b[0] - h[0], b[1] - h[1], b[2] - h[2]
    u = m.points[ball, 0] - m.points[heel, 0]
    v = m.points[ball, 1] - m.points[heel, 1]
    w = m.points[ball, 2] - m.points[heel, 2]
    axis[0], axis[1], axis[2] = v * z - w * y, w * x - u * z, u * y - v * x
    sine = math.sqrt(axis[0] ** 2 + axis[1] ** 2 + axis[2] ** 2)
    if sine > 1e-12:
        for i in range(3):
            axis[i] /= sine
        tilt_kernel(orientations[a], axis, math.atan2(sine, u * x + v * y + w * z), turned)
        for i in range(3):
            for k in range(3):
                orientations[a, i, k] = turned[i, k]
    if m.tilt[foot, 0] != 0.0 or m.tilt[foot, 1] != 0.0:
        _roll(m, foot, x, y, z, orientations[a], axis, turned)
    hang = (m.grip[ball] + 0.01) / (m.grip[heel] + m.grip[ball] + 0.02)
    m.anchor[foot] += (hang - m.anchor[foot]) * (1.0 - 2.0 ** (-dt / ANCHOR_HALFLIFE))
    hang = m.anchor[foot]
    for i in range(3):
        from_ball, from_heel = b[i], h[i]
        for k in range(3):
            from_ball -= orientations[a, i, k] * body.offsets[a + 1, k]
            from_heel -= orientations[a, i, k] * body.heel[k]
        ankle[i] = hang * from_ball + (1.0 - hang) * from_heel
    # where heel and ball could not both be met, the other must not sink
    under_heel, under_ball = ankle[1], ankle[1]
    for k in range(3):
        under_heel += orientations[a, 1, k] * body.heel[k]
        under_ball += orientations[a, 1, k] * body.offsets[a + 1, k]
    ankle[1] += max(0.0, height - min(under_heel - lie_kernel(m, heel), under_ball - lie_kernel(m, ball)))


@kernel
def _bend_toes(m, body, foot, a, height, positions, orientations, local, dt, work):
    """Bend a foot's toes (of joint a) up as far as the floor has them; free of it they straighten smoothly. height: of the floor for their end."""
    kept, rate = spring_kernel(m.toe[foot], m.toe_rate[foot], 0.0, TOE_HALFLIFE, dt)
    bent = toe_kernel(body, a, height, max(kept, 0.0), positions, orientations, local, work)
    m.toe_rate[foot] = rate if bent <= max(kept, 0.0) else min((bent - m.toe[foot]) / dt, 0.0)
    m.toe[foot] = bent


@kernel
def _off_the_floor(m, k, foot, x, z):
    """How high point k is held over the floor [m] where it is shown in the ground frame, having left: as high as it is far from
    where it stood, so that it does not slide."""
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    x, z = m.ground[0] + c * x + s * z, m.ground[1] - s * x + c * z
    if m.grip[k] >= 1.0:
        m.stood[k, 0], m.stood[k, 1] = x, z
        return 0.0
    progress = swing_progress(m, foot)
    over = FREED * (1.0 - math.exp(-STEEPLY[m.family] / FREED * math.hypot(x - m.stood[k, 0], z - m.stood[k, 1])))
    return over * min(max(2.0 - 2.0 * progress, (progress - 1.0) / HELD_AGAIN, 0.0), 1.0)


@kernel
def _roll(m, foot, x, y, z, orientation, axis, turned):
    """Turn a foot that points along x, y, z in the ground frame about that line, as far as its ground rises to its left."""
    flat, size = math.sqrt(x * x + z * z) + 1e-9, math.sqrt(x * x + y * y + z * z) + 1e-9
    axis[0], axis[1], axis[2] = x / size, y / size, z / size
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    rise = (m.tilt[foot, 0] * (c * z - s * x) - m.tilt[foot, 1] * (c * x + s * z)) / flat
    tilt_kernel(orientation, axis, math.atan(rise), turned)
    for i in range(3):
        for k in range(3):
            orientation[i, k] = turned[i, k]


@kernel
def at_rest(m, legs):
    """Whether a body that wants to rest may: blended to rest, both feet down and near their places."""
    for v in (m.command, m.asked):
        if abs(v[0]) + abs(v[1]) + abs(v[2]) > 0.02:
            return False
    if m.weights[legs.rest] < 0.98:
        return False
    for foot in range(2):
        x, z = m.offset[foot, 0] + m.aside[foot, 0], m.offset[foot, 1] + m.aside[foot, 1]
        far = math.hypot(x, z)
        if m.cramped:  # walls leave them no room there: near to where they were set down
            far = min(far, math.hypot(x - m.land[foot, 0], z - m.land[foot, 1]))
        if far > (BESIDE + OFF + 0.01 if m.waits else CLOSE) and not (m.waits and m.halts == STAYS) or m.lift[foot] > 0.003:
            return False
    return True


@kernel
def swings_over(m, foot, clearance):
    """How high a foot is held over the floor in mid-swing [m]."""
    return min(clearance + 0.4 * m.swing[foot], 0.06)


@kernel
def _swing_lift(m, foot, clearance, dt):
    """How high a foot is held over the floor [m]: over the stretch of the phase in which it swings,
    and the more the farther it has to go beyond what the blend does by itself."""
    wanted, progress = 0.0, swing_progress(m, foot)
    if progress < 1.0 and not m.settled:
        wanted = swings_over(m, foot, clearance) * math.sin(math.pi * progress)
    m.lift[foot], m.lift_rate[foot] = spring_kernel(m.lift[foot], m.lift_rate[foot], wanted, LIFT_HALFLIFE, dt)
    return max(m.lift[foot], 0.0)
