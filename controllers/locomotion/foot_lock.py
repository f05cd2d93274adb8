"""Footing: feet that stand do not move, feet that swing arrive without a jump.

For each foot two points are watched, heel and ball. A point that begins to stand is locked where
it is; while locked it stays there whatever the blend does under it, and when released the
distance between lock and blend decays as a critically damped spring (inertialisation). The foot
is turned so that it passes through both points, the toe bends so that it does not sink, and the
leg follows by two-bone inverse kinematics. A leg that is too short first lifts its heel about the
ball, as legs do, then lowers the pelvis a little, and only then lets go.
"""

from __future__ import annotations

import math

import numpy as np

from ..body import distance_kernel, spring_kernel
from ..compiled import kernel
from .cycles import EVENTS
from .foot_clearance import HALFLIFE, aside_kernel
from .kernel import LABELS_AT
from .legs import (HEEL_RISE, REACH, heel_rise_kernel, leg_kernel, leg_length, localise_kernel, soft_reach, tilt_kernel,
                   toe_kernel)

SWING = (float(EVENTS["walk"][1]), float(EVENTS["run"][3]))
"""The share of the cycle for which a foot swings, walking and running: from its toe-off to its strike."""
STANDING = 0.06
"""A point begins to stand where its blended label exceeds this: early, so that no foot creeps in …"""
LEAVING = (0.08, 0.40)
"""… and leaves where it falls below this, walking and running: a runner's foot must not be held back …"""
GATE = 0.035
"""… and takes hold only when it is lower than this above where it rests [m]."""
LAND_HALFLIFE = 0.03
"""A landing point comes down to the floor with this half-life [s]."""
LIFT_HALFLIFE = 0.02
"""How fast a swinging foot is lifted over the floor it must clear [s]."""
OFFSET_HALFLIFE = 0.07
"""A released foot returns to the blend with this half-life [s]."""
PELVIS_HALFLIFE = 0.08
"""The pelvis follows what the legs need with this half-life [s]."""
PELVIS_DROP = 0.03
"""The most that short legs may lower the pelvis [m]."""
RELEASE = 0.25
"""A lock further than this from where the blend wants the point lets go [m]."""
RISE_RATE = 8.0
"""A heel rises for its leg's sake no faster than this [rad/s] …"""
RISE_HALFLIFE = 0.04
"""… and sinks back with this half-life once its ball is free [s]."""
ANCHOR_HALFLIFE = 0.03
"""A foot's weight rolls from heel to ball with this half-life [s]."""
YIELDING = 0.25
"""A foot gives way to the other fully once this share of its swing is over."""
CLOSE = 0.03
"""A body comes to rest once its feet are this near to where they belong [m]."""


@kernel
def place_feet(m, body, legs, clearance, positions, orientations, local, dt, work):
    """Hold standing feet, land swinging ones, bend the legs after them."""
    ankle = np.empty((2, 3))
    before = m.offset.copy()
    _hold_standing(m, legs.height, dt)
    _hold_free(m, body, before, legs.height, dt)
    need = 0.0
    for foot in range(2):
        hip = legs.hip[foot]
        _turn_foot(m, body, foot, hip + 2, legs.height, clearance, orientations, ankle[foot], dt, work)
        reach = (REACH - 0.001) * leg_length(body, hip)
        _give_way(m, body, foot, hip, reach, positions, orientations, ankle[foot], dt, work)
        flat = (positions[hip, 0] - ankle[foot, 0]) ** 2 + (positions[hip, 2] - ankle[foot, 2]) ** 2
        if flat < reach * reach:
            need = max(need, positions[hip, 1] - ankle[foot, 1] - math.sqrt(reach * reach - flat))
        else:
            need = PELVIS_DROP
    need = min(need, PELVIS_DROP)
    drop, m.pelvis_rate = spring_kernel(m.pelvis, m.pelvis_rate, need, PELVIS_HALFLIFE, dt)
    m.pelvis = min(max(drop, 0.0), PELVIS_DROP)
    for foot in range(2):
        hip = legs.hip[foot]
        for j in range(hip, hip + 3):
            positions[j, 1] -= m.pelvis
        leg_kernel(positions, orientations, hip, ankle[foot], work)
        toe_kernel(body, hip + 2, legs.height, positions, orientations, local, work)
        localise_kernel(orientations, 0, hip, local)
        localise_kernel(orientations, hip, hip + 1, local)
        localise_kernel(orientations, hip + 1, hip + 2, local)


@kernel
def _turn_foot(m, body, foot, a, height, clearance, orientations, ankle, dt, work):
    """Turn foot 0 or 1 (joint a) by the smallest rotation that points it from heel to ball as they
    shall be, and write where its ankle then must be (3,): hung on the ball, or on the heel."""
    heel, ball = 2 * foot, 2 * foot + 1
    axis, turned = work[0, 0], work[1]
    lift = _swing_lift(m, foot, clearance, dt)
    h, b = _target(m, heel, height, lift), _target(m, ball, height, lift)
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
    hang = 0.5
    if m.standing[ball] == 1:
        hang = 1.0
    elif m.standing[heel] == 1:
        hang = 0.0
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
    ankle[1] += max(0.0, height - min(under_heel, under_ball))


@kernel
def _give_way(m, body, foot, hip, reach, positions, orientations, ankle, dt, work):
    """A leg too short lifts its heel about a standing ball; any other foot only comes nearer.

    A heel that was lifted when its ball left sinks back gently.
    """
    a = hip + 2
    ball, axis, turned = work[0, 0], work[0, 1], work[1]
    for i in range(3):
        axis[i] = orientations[a, i, 0]
        ball[i] = ankle[i]
        for k in range(3):
            ball[i] += orientations[a, i, k] * body.offsets[a + 1, k]
    stands = m.standing[2 * foot + 1] == 1
    if stands:
        wanted = soft_reach(distance_kernel(positions[hip], ankle), reach)
        rise = heel_rise_kernel(positions[hip], ball, ankle, axis, wanted)
        if rise >= HEEL_RISE:  # not even on its toes: let go before it tears
            m.standing[2 * foot], m.standing[2 * foot + 1] = 2, 2
        m.rise[foot] = min(rise, m.rise[foot] + RISE_RATE * dt)
    else:
        m.rise[foot] *= 2.0 ** (-dt / RISE_HALFLIFE)
    tilt_kernel(orientations[a], axis, m.rise[foot], turned)
    for i in range(3):
        ankle[i] = ball[i]
        for k in range(3):
            orientations[a, i, k] = turned[i, k]
            ankle[i] -= turned[i, k] * body.offsets[a + 1, k]
    if not stands:
        distance = distance_kernel(positions[hip], ankle)
        share = soft_reach(distance, reach) / distance
        for i in range(3):
            ankle[i] = positions[hip, i] + (ankle[i] - positions[hip, i]) * share


@kernel
def at_rest(m, legs):
    """Whether a body that wants to rest may: blended to rest, both feet down and near their places."""
    if m.weights[legs.rest] < 0.98 or abs(m.command[0]) + abs(m.command[1]) + abs(m.command[2]) > 0.02:
        return False
    for foot in range(2):
        offset = m.offset[2 * foot + 1]
        if offset[0] ** 2 + offset[2] ** 2 > CLOSE * CLOSE or m.lift[foot] > 0.003:
            return False
    return True


@kernel
def _swing_progress(m, foot):
    """How far through its swing foot 0 (left) or 1 is, by the phase: 0 … 1, beyond while it stands."""
    return ((m.phase - 0.5 * foot) % 1.0) / SWING[m.family]


@kernel
def _swing_lift(m, foot, clearance, dt):
    """How high a foot is held over the floor [m]: over the stretch of the phase in which it swings,
    and the more the farther it has to go beyond what the blend does by itself."""
    wanted, progress = 0.0, _swing_progress(m, foot)
    if progress < 1.0 and not m.settled:
        wanted = min(clearance + 0.4 * m.swing[foot], 0.06) * math.sin(math.pi * progress)
    m.lift[foot], m.lift_rate[foot] = spring_kernel(m.lift[foot], m.lift_rate[foot], wanted, LIFT_HALFLIFE, dt)
    return max(m.lift[foot], 0.0)


@kernel
def _hold_standing(m, height, dt):
    """Lock the points that begin to stand, release those that end, keep the standing on their locks."""
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    for k in range(4):
        stands = _stands(m, k, height)
        x = m.ground[0] + c * m.points[k, 0] + s * m.points[k, 2]
        z = m.ground[1] - s * m.points[k, 0] + c * m.points[k, 2]
        offset, rate = m.offset[k], m.offset_rate[k]
        if stands and m.standing[k] != 1:
            m.standing[k] = 1
            m.lock[k, 0], m.lock[k, 1] = x + offset[0], z + offset[2]
        elif not stands and m.standing[k] == 1:
            m.standing[k] = 2
            m.swing[k // 2] = math.sqrt(offset[0] ** 2 + offset[2] ** 2)
        if m.standing[k] == 1:
            offset[0], offset[2] = m.lock[k, 0] - x, m.lock[k, 1] - z
            rate[0], rate[2] = 0.0, 0.0
            below = height - m.points[k, 1]
            offset[1], rate[1] = spring_kernel(offset[1], rate[1], below, LAND_HALFLIFE, dt)
            if offset[0] ** 2 + offset[2] ** 2 > RELEASE * RELEASE:
                m.standing[k] = 2


@kernel
def _hold_free(m, body, before, height, dt):
    """Take the free points along with their foot's standing point, or else back to the blend, but
    aside of the other foot.

    before: (4, 3) the offsets one step ago.
    """
    aside, wanted = m.aside.copy(), np.empty(3)
    for foot in range(2):
        aside_kernel(m, body, foot, height, wanted)
        share = min(_swing_progress(m, foot) / YIELDING, 1.0)
        for i in range(3):
            m.aside[foot, i], m.aside_rate[foot, i] = spring_kernel(m.aside[foot, i], m.aside_rate[foot, i],
                                                                    share * wanted[i], HALFLIFE, dt)
    for k in range(4):
        if m.standing[k] == 1:
            continue
        other = k ^ 1
        for i in range(3):
            was, goal = aside[k // 2, i], m.aside[k // 2, i]
            if m.standing[other] == 1:
                was, goal = 0.0, 0.0
                if i != 1:
                    was, goal = before[other, i], m.offset[other, i]
            m.offset[k, i], m.offset_rate[k, i] = spring_kernel(m.offset[k, i] + goal - was, m.offset_rate[k, i],
                                                                goal, OFFSET_HALFLIFE, dt)


@kernel
def _target(m, k, height, lift):
    """Where contact point k shall be: x, y, z in the ground frame."""
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    least = height if m.standing[k] == 1 else height + lift
    return (m.points[k, 0] + c * m.offset[k, 0] - s * m.offset[k, 2],
            max(m.points[k, 1] + m.offset[k, 1], least),
            m.points[k, 2] + s * m.offset[k, 0] + c * m.offset[k, 2])


@kernel
def _stands(m, k, height):
    """Whether point k stands: always at rest, else by its blended label, and only once it is low."""
    if m.settled:
        return True
    label = m.row[LABELS_AT + k]
    if m.standing[k] == 1:
        return label > LEAVING[m.family] or m.row_rate[LABELS_AT + k] > 0.0
    if m.standing[k] == 2 and 0.3 < _swing_progress(m, k // 2) < 1.0:
        m.standing[k] = 0  # it has left for good: the next contact may take hold
    return m.standing[k] == 0 and label > STANDING and m.points[k, 1] + m.offset[k, 1] < height + GATE
