"""One step of a walking character, compiled: command → weights → phase → pose → root → feet.

A character's memory is one record of a structured array, so a crowd is a longer array, and
keeping, copying or rewinding a state is copying a record.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from ..body.human import CONTACT_HEIGHT, human
from .footing import (GATE, LAND_HALFLIFE, OFFSET_HALFLIFE, PELVIS_DROP, PELVIS_HALFLIFE, REACH, RELEASE, STANDING, heel_rise_kernel,
                      leg_kernel, spring_kernel, tilt_kernel)
from .kernel import (ACTIVE, COLUMNS, DURATION_AT, HIPS_AT, LABELS_AT, LANES, SCRATCH, joint_kernel,
                     pose_kernel, query_kernel, series_kernel)

WALK, RUN = 0, 1


class Settings(NamedTuple):
    """What one may tune. Times in seconds, speeds in m/s."""

    command_halflife: float = 0.10
    weight_halflife: float = 0.06
    drift_halflife: float = 0.03
    switch_halflife: float = 0.10
    run_above: float = 1.85
    walk_below: float = 1.70
    correct: int = 3
    footing: bool = True
    acceleration: float = 4.5
    clearance: float = 0.018
    breath: float = 0.012


class Legs(NamedTuple):
    """Joint numbers: hips' children and the chest, as the step needs them."""

    hip: np.ndarray
    chest: int
    neck: int
    shoulder: np.ndarray
    height: float
    rest: int


def legs_of(library) -> Legs:
    """The joint numbers that the step needs of a library's skeleton."""
    at = library.skeleton.index
    scale = library.skeleton.offsets[0, 1] / human().offsets[0, 1]
    return Legs(np.array([at("LeftUpLeg"), at("RightUpLeg")]), at("Spine2"), at("Neck"),
                np.array([at("LeftShoulder"), at("RightShoulder")]), CONTACT_HEIGHT * scale, library.rest)


def memory_dtype(primitives: int) -> np.dtype:
    """The record of one character.

    ground x, z, θ; command and its rate (shaped velocity wish); velocity achieved (v_f, ω, v_l);
    phase; family (0 walk, 1 run); simplex last located in each family's space; weights; drift
    (lateral, forward: what the stance foot says beyond the nominal velocity); points (the blend's
    heels and balls in the ground frame); standing, lock, offset and its rate of those points;
    anchor (how much each foot hangs on its ball rather than its heel); pelvis offset and rate;
    settled (at rest, feet in place); row and its rate (last series); blend and its rate
    (inertialisation); breath (phase of breathing); swing (how far each foot had to go at release).
    """
    return np.dtype([
        ("ground", "f8", 3), ("lock", "f8", (4, 3)), ("command", "f4", 3), ("rate", "f4", 3),
        ("velocity", "f4", 3), ("phase", "f4"), ("family", "i4"), ("simplex", "i4", 2),
        ("weights", "f4", primitives), ("drift", "f4", 2), ("points", "f4", (4, 3)),
        ("standing", "i4", 4), ("offset", "f4", (4, 3)), ("offset_rate", "f4", (4, 3)),
        ("anchor", "f4", 2), ("pelvis", "f4"), ("pelvis_rate", "f4"), ("settled", "i4"),
        ("row", "f4", COLUMNS), ("row_rate", "f4", COLUMNS), ("blend", "f4", COLUMNS),
        ("blend_rate", "f4", COLUMNS), ("breath", "f4"), ("swing", "f4", 2)], align=True)


@njit(cache=True)
def step_kernel(memory, wish, dt, settings, body, legs, walk, run, table, velocities, root, local):
    """Step every character of `memory` (N,) by dt towards its wish (N, 3); write root and local pose.

    root: (N, 3) [m]. local: (N, J, 3, 3). Both float32, in the world.
    """
    joints = local.shape[1]
    positions = np.empty((joints, 3), np.float32)
    orientations = np.empty((joints, 3, 3), np.float32)
    scratch = np.empty(SCRATCH, np.float32)
    fresh = np.empty(COLUMNS, np.float32)
    work = np.empty((5, 3, 3), np.float64)
    b, p, q = np.empty(4), np.empty(3), np.empty(3)
    for n in range(memory.shape[0]):
        m = memory[n]
        _shape_command(m, wish[n], dt, settings)
        _weigh(m, settings, dt, walk, run, table, fresh, b, p, q)
        _advance_phase(m, wish[n], legs, dt)
        _blend_series(m, settings, table, fresh, legs, dt)
        pose_kernel(body, fresh, local[n], positions, orientations, scratch)
        _move_root(m, settings, body, legs, positions, orientations, velocities, dt)
        drop = 0.0
        if settings.footing:
            drop = _place_feet(m, body, legs, settings.clearance, positions, orientations, local[n], dt, work)
        _to_world(m, fresh, drop, root[n], local[n])


@njit(cache=True)
def _shape_command(m, wish, dt, settings):
    """The wish, smoothed: an exact critically damped spring, no faster than legs can push."""
    for i in range(3):
        before = m.command[i]
        x, v = spring_kernel(before - wish[i], m.rate[i], settings.command_halflife, dt)
        most = settings.acceleration if i != 1 else 4.0 * settings.acceleration
        step = wish[i] + x - before
        if abs(step) > most * dt:
            step = math.copysign(most * dt, step)
            v = step / dt
        m.command[i], m.rate[i] = before + step, v


@njit(cache=True)
def _weigh(m, settings, dt, walk, run, table, fresh, b, p, q):
    """Choose the family, locate the command in its space, low-pass the weights."""
    common = 0.25 < m.phase < 0.42 or 0.75 < m.phase < 0.92  # the same foot stands in both families
    wanted = m.family
    if m.command[0] > settings.run_above:
        wanted = RUN
    elif m.command[0] < settings.walk_below:
        wanted = WALK
    switch = wanted != m.family and (common or m.settled != 0)
    if switch:
        m.family = wanted
    keep = 2.0 ** (-dt / settings.weight_halflife)
    if m.family == WALK:
        simplex = query_kernel(walk, m.command, m.simplex[0], settings.correct, b, p, q)
        vertices = walk.vertices[simplex]
    else:
        simplex = query_kernel(run, m.command, m.simplex[1], settings.correct, b, p, q)
        vertices = run.vertices[simplex]
    m.simplex[m.family] = simplex
    if switch:
        keep = 0.0
    total = 0.0
    for i in range(m.weights.shape[0]):
        m.weights[i] *= keep
    for i in range(4):
        m.weights[vertices[i]] += (1.0 - keep) * b[i]
    for i in range(m.weights.shape[0]):
        if m.weights[i] < ACTIVE:
            m.weights[i] = 0.0
        total += m.weights[i]
    for i in range(m.weights.shape[0]):
        m.weights[i] /= total
    if switch:  # inertialise: what was shown minus what the other family shows now
        before = (m.phase - dt / max(m.row[DURATION_AT], 0.3)) % 1.0
        series_kernel(table, m.weights, before, fresh)
        for d in range(COLUMNS):
            m.blend_rate[d] = fresh[d]
        series_kernel(table, m.weights, m.phase, fresh)
        for d in range(LABELS_AT):
            m.blend_rate[d] = m.row_rate[d] - (fresh[d] - m.blend_rate[d]) / dt
            m.blend[d] = m.row[d] - fresh[d]


@njit(cache=True)
def _advance_phase(m, wish, legs, dt):
    """Run the phase on at dφ/dt = 1 / duration(φ); at rest it waits, and starts with a swing."""
    if m.settled:
        if wish[0] ** 2 + wish[1] ** 2 + wish[2] ** 2 < 1e-6:
            return
        # a body at rest starts in the middle of a swing, with the other foot under it
        left_first = wish[1] > 0.05 or (wish[1] >= -0.05 and wish[2] >= 0.0)
        m.phase = 0.08 if left_first else 0.58
        m.settled = 0
    m.phase = (m.phase + dt / max(m.row[DURATION_AT], 0.3)) % 1.0


@njit(cache=True)
def _blend_series(m, settings, table, fresh, legs, dt):
    """The series of the weighted primitives, with inertialisation and breath, into `fresh` and m.row."""
    series_kernel(table, m.weights, m.phase, fresh)
    for d in range(LABELS_AT):
        m.blend[d], m.blend_rate[d] = spring_kernel(m.blend[d], m.blend_rate[d], settings.switch_halflife, dt)
        fresh[d] += m.blend[d]
    for d in range(COLUMNS):
        m.row_rate[d] = (fresh[d] - m.row[d]) / dt
        m.row[d] = fresh[d]
    m.breath = (m.breath + dt * 0.27) % 1.0
    calm = m.weights[legs.rest]
    lift = settings.breath * calm * math.sin(2.0 * math.pi * m.breath)
    fresh[legs.chest] -= lift  # the chest opens, the neck makes up for it
    fresh[legs.neck] += lift
    for side in range(2):
        fresh[2 * LANES + legs.shoulder[side]] += (1.0 - 2.0 * side) * 1.5 * lift
    sway = settings.breath * calm * math.sin(2.0 * math.pi * m.breath * 1.0 + 1.0)
    fresh[HIPS_AT] += 0.3 * sway


@njit(cache=True)
def _foot_points(body, legs, positions, orientations, out):
    for foot in range(2):
        a = legs.hip[foot] + 2
        for i in range(3):
            heel = positions[a, i]
            for k in range(3):
                heel += orientations[a, i, k] * body.heel[k]
            out[2 * foot, i] = heel
            out[2 * foot + 1, i] = positions[a + 1, i]


@njit(cache=True)
def _move_root(m, settings, body, legs, positions, orientations, velocities, dt):
    """Move the ground frame so that the standing foot stays: the blend's own mean velocity plus
    what the standing points say beyond it, low-passed."""
    v_f, omega, v_l = 0.0, 0.0, 0.0
    for i in range(m.weights.shape[0]):
        w = m.weights[i]
        if w > 0.0:
            v_f += w * velocities[i, 0]
            omega += w * velocities[i, 1]
            v_l += w * velocities[i, 2]
    turn = omega * dt
    c, s = math.cos(turn), math.sin(turn)
    points = np.empty((4, 3), np.float32)
    _foot_points(body, legs, positions, orientations, points)
    trust, lateral, forward = 1e-6, 0.0, 0.0
    for k in range(4):
        stand = min(max(m.row[LABELS_AT + k], 0.0), 1.0)
        if m.settled:
            stand = 1.0
        lateral += stand * (m.points[k, 0] - (c * points[k, 0] + s * points[k, 2]))
        forward += stand * (m.points[k, 2] - (-s * points[k, 0] + c * points[k, 2]))
        trust += stand
        for i in range(3):
            m.points[k, i] = points[k, i]
    share = min(trust, 1.0)
    gain = 1.0 - 2.0 ** (-dt / settings.drift_halflife)
    m.drift[0] += gain * (share * (lateral / trust / dt - v_l) - m.drift[0])
    m.drift[1] += gain * (share * (forward / trust / dt - v_f) - m.drift[1])
    v_l += m.drift[0]
    v_f += m.drift[1]
    m.velocity[0], m.velocity[1], m.velocity[2] = v_f, omega, v_l
    c, s = math.cos(m.ground[2] + 0.5 * turn), math.sin(m.ground[2] + 0.5 * turn)
    m.ground[0] += (c * v_l + s * v_f) * dt
    m.ground[1] += (-s * v_l + c * v_f) * dt
    m.ground[2] = math.pi - (math.pi - m.ground[2] - turn) % (2.0 * math.pi)


@njit(cache=True)
def _swing_lift(m, foot, clearance):
    """How high foot 0 (left) or 1 must swing [m]: over the stretch of the phase in which it does,
    and the more the farther it has to go beyond what the blend does by itself."""
    share = 0.38 if m.family == WALK else 0.72
    into = ((m.phase - 0.5 * foot) % 1.0) / share
    if into >= 1.0 or m.settled:
        return 0.0
    return min(clearance + 0.4 * m.swing[foot], 0.06) * math.sin(math.pi * into)


@njit(cache=True)
def _hold_standing(m, height, dt):
    """Lock the points that begin to stand, release those that end, keep the standing on their locks."""
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    for k in range(4):
        stands = _stands(m, k, height)
        x = m.ground[0] + c * m.points[k, 0] + s * m.points[k, 2]
        z = m.ground[1] - s * m.points[k, 0] + c * m.points[k, 2]
        offset, rate = m.offset[k], m.offset_rate[k]
        if stands and m.standing[k] == 0:
            m.standing[k] = 1
            m.lock[k, 0], m.lock[k, 1], m.lock[k, 2] = x + offset[0], height, z + offset[2]
        elif not stands and m.standing[k] != 0:
            m.standing[k] = 0
            m.swing[k // 2] = math.sqrt(offset[0] ** 2 + offset[2] ** 2)
        if m.standing[k] == 1:
            offset[0], offset[2] = m.lock[k, 0] - x, m.lock[k, 2] - z
            rate[0], rate[2] = 0.0, 0.0
            below = height - m.points[k, 1]
            rise, rate[1] = spring_kernel(offset[1] - below, rate[1], LAND_HALFLIFE, dt)
            offset[1] = rise + below
            if offset[0] ** 2 + offset[2] ** 2 > RELEASE * RELEASE:
                m.standing[k] = 2  # let go until the label says swing


@njit(cache=True)
def _hold_free(m, before, dt):
    """Take the free points along with their foot's standing point, or else back to the blend.

    before: (4, 3) the offsets one step ago.
    """
    for k in range(4):
        if m.standing[k] == 1:
            continue
        other = k ^ 1
        for i in range(3):
            was, goal = 0.0, 0.0
            if m.standing[other] == 1 and i != 1:
                was, goal = before[other, i], m.offset[other, i]
            rest, m.offset_rate[k, i] = spring_kernel(m.offset[k, i] - was, m.offset_rate[k, i],
                                                      OFFSET_HALFLIFE, dt)
            m.offset[k, i] = goal + rest


@njit(cache=True)
def _target(m, k, height, lift):
    """Where contact point k shall be: x, y, z in the ground frame."""
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    least = height if m.standing[k] == 1 else height + lift
    return (m.points[k, 0] + c * m.offset[k, 0] - s * m.offset[k, 2],
            max(m.points[k, 1] + m.offset[k, 1], least),
            m.points[k, 2] + s * m.offset[k, 0] + c * m.offset[k, 2])


@njit(cache=True)
def _stands(m, k, height):
    """Whether point k stands: always at rest, else by its blended label, and only once it is low."""
    if m.settled:
        return True
    low = m.standing[k] != 0 or m.points[k, 1] + m.offset[k, 1] < height + GATE
    return low and m.row[LABELS_AT + k] > STANDING


@njit(cache=True)
def _place_feet(m, body, legs, clearance, positions, orientations, local, dt, work):
    """Hold standing feet, land swinging ones, bend the legs after them. Returns the pelvis offset [m]."""
    height = legs.height
    ankle = np.empty((2, 3))
    direction, axis, turned = np.empty(3), np.empty(3), np.empty((3, 3))
    need = 0.0
    before = m.offset.copy()
    _hold_standing(m, height, dt)
    _hold_free(m, before, dt)
    for foot in range(2):
        a = legs.hip[foot] + 2
        heel, ball = 2 * foot, 2 * foot + 1
        lift = _swing_lift(m, foot, clearance)
        hx, hy, hz = _target(m, heel, height, lift)
        bx, by, bz = _target(m, ball, height, lift)
        hang = 0.5
        if m.standing[ball] == 1:
            hang = 1.0
        elif m.standing[heel] == 1:
            hang = 0.0
        m.anchor[foot] += (hang - m.anchor[foot]) * (1.0 - 2.0 ** (-dt / 0.03))
        # turn the foot by the smallest rotation that points it from heel to ball
        direction[0], direction[1], direction[2] = bx - hx, by - hy, bz - hz
        rx = m.points[ball, 0] - m.points[heel, 0]
        ry = m.points[ball, 1] - m.points[heel, 1]
        rz = m.points[ball, 2] - m.points[heel, 2]
        axis[0] = ry * direction[2] - rz * direction[1]
        axis[1] = rz * direction[0] - rx * direction[2]
        axis[2] = rx * direction[1] - ry * direction[0]
        sine = math.sqrt(axis[0] ** 2 + axis[1] ** 2 + axis[2] ** 2)
        cosine = rx * direction[0] + ry * direction[1] + rz * direction[2]
        if sine > 1e-12:
            for i in range(3):
                axis[i] /= sine
            tilt_kernel(orientations[a], axis, math.atan2(sine, cosine), turned)
            for i in range(3):
                for k in range(3):
                    orientations[a, i, k] = turned[i, k]
        # where the ankle must be: hung on the ball, or on the heel
        hang = m.anchor[foot]
        target = (bx, by, bz)
        other = (hx, hy, hz)
        for i in range(3):
            from_ball, from_heel = target[i], other[i]
            for k in range(3):
                from_ball -= orientations[a, i, k] * body.offsets[a + 1, k]
                from_heel -= orientations[a, i, k] * body.heel[k]
            ankle[foot, i] = hang * from_ball + (1.0 - hang) * from_heel
        # a leg too short lifts its heel about the ball
        hip = positions[legs.hip[foot]]
        upper, lower = -body.offsets[legs.hip[foot] + 1, 1], -body.offsets[a, 1]
        reach = (REACH - 0.001) * (upper + lower)
        if m.standing[ball] == 1:
            for i in range(3):
                axis[i] = orientations[a, i, 0]
                direction[i] = ankle[foot, i]
                for k in range(3):
                    direction[i] += orientations[a, i, k] * body.offsets[a + 1, k]
            rise = heel_rise_kernel(hip, direction, ankle[foot], axis, reach)
            if rise > 0.0:
                tilt_kernel(orientations[a], axis, rise, turned)
                for i in range(3):
                    ankle[foot, i] = direction[i]
                    for k in range(3):
                        orientations[a, i, k] = turned[i, k]
                        ankle[foot, i] -= turned[i, k] * body.offsets[a + 1, k]
        flat = (hip[0] - ankle[foot, 0]) ** 2 + (hip[2] - ankle[foot, 2]) ** 2
        if flat < reach * reach:
            need = max(need, hip[1] - ankle[foot, 1] - math.sqrt(reach * reach - flat))
        else:
            need = PELVIS_DROP
    need = min(need, PELVIS_DROP)
    x, m.pelvis_rate = spring_kernel(m.pelvis - need, m.pelvis_rate, PELVIS_HALFLIFE, dt)
    m.pelvis = min(max(need + x, 0.0), PELVIS_DROP)
    close = True
    for foot in range(2):
        hip = legs.hip[foot]
        a = hip + 2
        for j in range(hip, hip + 3):
            positions[j, 1] -= m.pelvis
        leg_kernel(positions, orientations, hip, ankle[foot], work)
        _bend_toe(body, a, legs.height, positions, orientations, local, work)
        _localise(orientations, 0, hip, local)
        _localise(orientations, hip, hip + 1, local)
        _localise(orientations, hip + 1, a, local)
        offset = m.offset[2 * foot + 1]
        close = close and offset[0] ** 2 + offset[2] ** 2 < 0.03**2
    calm = m.weights[legs.rest] > 0.98 and abs(m.command[0]) + abs(m.command[1]) + abs(m.command[2]) < 0.02
    if calm and close:
        m.settled = 1
    return m.pelvis


@njit(cache=True)
def _bend_toe(body, a, height, positions, orientations, local, work):
    """Bend the toe joint a + 1 up about the foot's lateral axis until the toe's end is not below the floor."""
    joint_kernel(body, a + 1, local, positions, orientations)
    t = a + 1
    rise, size, length = 0.0, 0.0, 0.0
    for k in range(3):
        rise += orientations[t, 1, k] * body.toe_end[k]
        length += body.toe_end[k] ** 2
    length = math.sqrt(length)
    low = (height - positions[t, 1]) / length
    now = rise / length
    if now < low:
        angle = math.asin(min(max(low, -1.0), 1.0)) - math.asin(min(max(now, -1.0), 1.0))
        axis, turned = work[0, 0], work[1]
        for i in range(3):
            axis[i] = orientations[a, i, 0]
        tilt_kernel(orientations[t], axis, -angle, turned)
        for i in range(3):
            for k in range(3):
                orientations[t, i, k] = turned[i, k]
        _localise(orientations, a, t, local)


@njit(cache=True)
def _localise(orientations, parent, joint, local):
    for i in range(3):
        for k in range(3):
            total = 0.0
            for a in range(3):
                total += orientations[parent, a, i] * orientations[joint, a, k]
            local[joint, i, k] = total


@njit(cache=True)
def _to_world(m, row, drop, root, local):
    """Place the pose of the ground frame in the world."""
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    x, z = row[HIPS_AT], row[HIPS_AT + 2]
    root[0] = m.ground[0] + c * x + s * z
    root[1] = row[HIPS_AT + 1] - drop
    root[2] = m.ground[1] - s * x + c * z
    for k in range(3):
        x, z = local[0, 0, k], local[0, 2, k]
        local[0, 0, k] = c * x + s * z
        local[0, 2, k] = -s * x + c * z
