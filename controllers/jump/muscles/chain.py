"""A crouched body as four links in its sagittal plane, and how its muscles straighten it; compiled.

Both legs move as one: foot, shank, thigh and, as one piece, all above the hips. Only with the whole
mass matrix of these links does the work of the muscles become motion and height, nothing more. The
foot turns about its ball once its heel no longer presses on the floor. What the numbers mean is
told in `extension`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...compiled import kernel
from ..body import BodyTables
from .spring_muscles import Muscle, torque_kernel

EXTENDED = 0.975
"""A leg of this share of its length is extended: the push is over."""
CHAIN, MOVED, PRINTED = 0, 1, 2
"""Which inertia the torques turn: the mass matrix, what lies above each joint, the thesis's mass."""
EXPLICIT, SEMI_IMPLICIT, RUNGE_KUTTA = 0, 1, 2
"""How time is stepped."""
COLUMNS = 16
"""Of a thrust's rows: time, bends of hip, knee and ankle, turns of the links, and of the centre of mass place
and velocity (forward, up), the ground's force, the muscles' work, the energy of motion and height."""


class Links(NamedTuple):
    """mass: (4,) [kg]. inertia: (4,) [kg m²] about the links' centres. link, centre: (4, 2) [m] from each
    link's lower joint to the next and to its centre, as it crouches. ball: (2,) [m]. bends: (3,) [rad] of
    hip, knee and ankle there. leg: [m] a straight one."""

    mass: np.ndarray
    inertia: np.ndarray
    link: np.ndarray
    centre: np.ndarray
    ball: np.ndarray
    bends: np.ndarray
    leg: float


@kernel
def links_kernel(body: BodyTables, feet, positions, orientations, bends):
    """The `Links` of a placed body over feet (2, 6); bends: (2, 3) [rad] of both legs."""
    yaw = 0.5 * (feet[0, 3] + feet[1, 3])
    sine, cosine = math.sin(yaw), math.cos(yaw)
    mass, inertia, centre = np.zeros(4), np.zeros(4), np.zeros((4, 2))
    joints, link = np.zeros((4, 2)), np.zeros((4, 2))
    for k in range(4):
        for side in range(2):
            j = body.hip[side] + 3 - k
            joints[k, 0] += 0.5 * (positions[j, 0] * sine + positions[j, 2] * cosine)
            joints[k, 1] += 0.5 * positions[j, 1]
    count = len(body.mass)
    group, flat = np.empty(count, np.int64), np.empty((count, 2))
    for s in range(count):
        j = body.joint[s]
        group[s] = 3
        for side in range(2):
            below = j - body.hip[side]
            if 0 <= below <= 3:
                group[s] = max(2 - below, 0)
        place = np.empty(3)
        around = np.empty(3)
        for i in range(3):
            place[i] = positions[j, i]
            around[i] = cosine * orientations[j, 0, i] - sine * orientations[j, 2, i]  # the hinges' axis, in its frame
            for m in range(3):
                place[i] += orientations[j, i, m] * body.centre[s, m]
        flat[s, 0], flat[s, 1] = place[0] * sine + place[2] * cosine, place[1]
        k = group[s]
        mass[k] += body.mass[s]
        for i in range(3):
            for m in range(3):
                inertia[k] += around[i] * body.inertia[s, i, m] * around[m]
        for i in range(2):
            centre[k, i] += body.mass[s] * flat[s, i]
    for k in range(4):
        for i in range(2):
            centre[k, i] /= mass[k]
    for s in range(count):
        k = group[s]
        inertia[k] += body.mass[s] * ((flat[s, 0] - centre[k, 0]) ** 2 + (flat[s, 1] - centre[k, 1]) ** 2)
    for k in range(4):
        for i in range(2):
            centre[k, i] -= joints[k, i]
            if k < 3:
                link[k, i] = joints[k + 1, i] - joints[k, i]
    return Links(mass, inertia, link, centre, joints[0].copy(), 0.5 * (bends[0] + bends[1]), body.thigh + body.shank)


@kernel
def thrust_kernel(links: Links, spring: Muscle, gravity, activation, delays, inertia, integration, dt, most, rows):
    """Straighten a crouched body until it leaves the floor, in at most so many steps of dt [s].

    gravity: [m/s²] downward. activation: 0 … 1. delays: (3,) [s]. rows: (N, COLUMNS), written; the last one
    holds the end if there are more. Returns how many there were, and whether the legs were extended.
    """
    angles, speeds, change = np.zeros(4), np.zeros(4), np.empty((4, 4))
    at, pace, power = np.empty(4), np.empty(4), np.empty(4)
    arms, matrix, solved, torques = np.empty((2, 4, 2)), np.empty((4, 4)), np.empty((4, 5)), np.empty(3)
    before, speeds_before, blow, row = np.empty(4), np.empty(4), np.empty(4), np.zeros(COLUMNS)
    flat, flat_before, work, work_before, used = True, True, 0.0, 0.0, 0
    for n in range(most + 1):
        row[0], row[14] = n * dt, work
        flat, length, power[0] = _state(links, spring, gravity, activation, delays, inertia, flat, row[0], angles, speeds,
                                        arms, matrix, solved, torques, change[0], row)
        extended = length >= EXTENDED * links.leg
        over = extended or row[13] <= 0.0
        if n > 0 and over:  # it left within this step: find when
            low, high = 0.0, dt
            for half in range(12):
                part = high if half == 11 else 0.5 * (low + high)
                row[0], angles[:], speeds[:], flat = (n - 1) * dt, before, speeds_before, flat_before
                flat, length, power[0] = _state(links, spring, gravity, activation, delays, inertia, flat, row[0], angles,
                                                speeds, arms, matrix, solved, torques, change[0], row)
                work = work_before + _step(links, spring, gravity, activation, delays, inertia, integration, flat, row, part,
                                           angles, speeds, at, pace, power, arms, matrix, solved, torques, change)
                row[0], row[14] = (n - 1) * dt + part, work
                flat, length, power[0] = _state(links, spring, gravity, activation, delays, inertia, flat, row[0], angles,
                                                speeds, arms, matrix, solved, torques, change[0], row)
                extended = length >= EXTENDED * links.leg
                if extended or row[13] <= 0.0:
                    high = part
                else:
                    low = part
        rows[min(n, len(rows) - 1)] = row
        used = n + 1
        if n == most or over:
            break
        before[:], speeds_before[:], flat_before, work_before = angles, speeds, flat, work
        work += _step(links, spring, gravity, activation, delays, inertia, integration, flat, row, dt, angles, speeds, at, pace,
                      power, arms, matrix, solved, torques, change)
        if not flat and angles[0] <= 0.0 and speeds[0] < 0.0:  # the heel is down again: a blow that stops the foot
            angles[0], blow[:] = 0.0, 0.0
            blow[0] = 1.0
            _state(links, spring, gravity, activation, delays, inertia, False, row[0] + dt, angles, speeds, arms, matrix, solved,
                   torques, change[0], row)
            _solve(matrix, blow, 0, solved)
            speeds -= blow * (speeds[0] / blow[0])
            flat = True
    return used, extended


@kernel
def _step(links, spring, gravity, activation, delays, inertia, integration, flat, row, dt, angles, speeds, at, pace, power, arms,
          matrix, solved, torques, change):
    """Step angles and speeds (4,) by dt [s] from a state that `_state` has just seen; returns the work done [J]."""
    if integration != RUNGE_KUTTA:
        for k in range(4):
            pace[k] = speeds[k]
            speeds[k] += change[0, k] * dt
            angles[k] += (pace[k] if integration == EXPLICIT else speeds[k]) * dt
            at[k] = 0.5 * (pace[k] + speeds[k])
        return dt * _power(torques, at)
    start, turning = angles.copy(), speeds.copy()
    sum_pace, sum_change, seen = speeds.copy(), change[0].copy(), np.empty(COLUMNS)
    work = power[0]
    for stage in range(1, 4):
        part = dt if stage == 3 else 0.5 * dt
        weight = 1.0 if stage == 3 else 2.0
        for k in range(4):
            at[k] = start[k] + part * (speeds[k] if stage == 1 else pace[k])
        for k in range(4):
            pace[k] = turning[k] + part * change[stage - 1, k]
        _, _, power[stage] = _state(links, spring, gravity, activation, delays, inertia, flat, row[0] + part, at, pace, arms,
                                    matrix, solved, torques, change[stage], seen)
        if flat:
            change[stage, 0] = 0.0
        for k in range(4):
            sum_pace[k] += weight * pace[k]
            sum_change[k] += weight * change[stage, k]
        work += weight * power[stage]
    for k in range(4):
        angles[k] = start[k] + dt / 6.0 * sum_pace[k]
        speeds[k] = turning[k] + dt / 6.0 * sum_change[k]
    return dt / 6.0 * work


@kernel
def _state(links, spring, gravity, activation, delays, inertia, flat, time, angles, speeds, arms, matrix, solved, torques,
           change, row):
    """Write the links' angular accelerations (4,) `change`, and of a row all but time and work.

    Returns whether the sole stays flat, the distance from ankle to hip [m] and the muscles' power [W].
    """
    total = 0.0
    for k in range(4):
        c, s = math.cos(angles[k]), math.sin(angles[k])
        arms[0, k, 0], arms[0, k, 1] = c * links.link[k, 0] + s * links.link[k, 1], c * links.link[k, 1] - s * links.link[k, 0]
        arms[1, k, 0], arms[1, k, 1] = (c * links.centre[k, 0] + s * links.centre[k, 1],
                                        c * links.centre[k, 1] - s * links.centre[k, 0])
        total += links.mass[k]
        for j in range(4):
            matrix[k, j] = 0.0
    pull, turning, shift = np.zeros(4), np.zeros(4), np.zeros((2, 4))
    px, py, vx, vy, bx, by = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(4):
        m, x, y, back_x, back_y = links.mass[k], links.ball[0], links.ball[1], 0.0, 0.0
        for j in range(k + 1):
            own = 1 if j == k else 0
            x += arms[own, j, 0]
            y += arms[own, j, 1]
            back_x -= speeds[j] ** 2 * arms[own, j, 0]
            back_y -= speeds[j] ** 2 * arms[own, j, 1]
        for j in range(k + 1):
            own = 1 if j == k else 0
            ax, ay = arms[own, j, 0], arms[own, j, 1]
            pull[j] -= m * gravity * ax
            turning[j] += m * (ay * back_x - ax * back_y)
            shift[0, j] += m * ay
            shift[1, j] -= m * ax
            for i in range(k + 1):
                of = 1 if i == k else 0
                matrix[j, i] += m * (ax * arms[of, i, 0] + ay * arms[of, i, 1])
        matrix[k, k] += links.inertia[k]
        px += m * x
        py += m * y
        bx += m * back_x
        by += m * back_y
    # how the bends of hip, knee and ankle follow from the turns of foot, shank, thigh and trunk
    row[1] = links.bends[0] - angles[2] + angles[3]
    row[2] = links.bends[1] + angles[1] - angles[2]
    row[3] = links.bends[2] - angles[0] + angles[1]
    holding = (-pull[3], pull[2] + pull[3], -pull[1] - pull[2] - pull[3])
    for j in range(3):
        full = torque_kernel(row[1 + j], spring) * 2.0
        held = min(max(holding[j], 0.0), full)
        active = 1.0 if time >= delays[j] else time / delays[j]
        torques[j] = held + active * (activation * full - held)
    if inertia == CHAIN:
        change[0] = torques[2] - pull[0] - turning[0]
        change[1] = -torques[1] - torques[2] - pull[1] - turning[1]
        change[2] = torques[0] + torques[1] - pull[2] - turning[2]
        change[3] = -torques[0] - pull[3] - turning[3]
        heel = change[0]
        if flat:
            _solve(matrix, change, 1, solved)
            pressed = -heel
            for j in range(1, 4):
                pressed += matrix[0, j] * change[j]
            flat = pressed >= 0.0  # while the floor has to hold the heel up
            if flat:
                change[0] = 0.0
            else:
                change[0] = heel
                change[1] = -torques[1] - torques[2] - pull[1] - turning[1]
                change[2] = torques[0] + torques[1] - pull[2] - turning[2]
                change[3] = -torques[0] - pull[3] - turning[3]
        if not flat:
            _solve(matrix, change, 0, solved)
    else:
        _apart(links, matrix, torques, holding, inertia, change)
    fx, fy, kinetic = bx, by + total * gravity, 0.0
    for k in range(4):
        fx += shift[0, k] * change[k]
        fy += shift[1, k] * change[k]
        vx += shift[0, k] * speeds[k]
        vy += shift[1, k] * speeds[k]
        row[4 + k] = angles[k]
        for j in range(4):
            kinetic += 0.5 * speeds[k] * matrix[k, j] * speeds[j]
    row[8], row[9], row[10], row[11], row[12], row[13] = px / total, py / total, vx / total, vy / total, fx, fy
    row[15] = kinetic + gravity * py
    length = math.hypot(arms[0, 1, 0] + arms[0, 2, 0], arms[0, 1, 1] + arms[0, 2, 1])
    return flat, length, _power(torques, speeds)


@kernel
def _power(torques, speeds):
    """Of the muscles [W]: what they straighten, they do not bend."""
    return (torques[0] * (speeds[2] - speeds[3]) + torques[1] * (speeds[2] - speeds[1])
            + torques[2] * (speeds[0] - speeds[1]))


@kernel
def _solve(matrix, given, first, solved):
    """Solve the mass matrix, its rows from `first` on, for `given` (4,), which becomes the answer: Gauss, no pivots
    (it is positive definite)."""
    for i in range(first, 4):
        for j in range(first, 4):
            solved[i, j] = matrix[i, j]
    for i in range(first, 4):
        for j in range(i + 1, 4):
            factor = solved[j, i] / solved[i, i]
            for k in range(i, 4):
                solved[j, k] -= factor * solved[i, k]
            given[j] -= factor * given[i]
    for i in range(3, first - 1, -1):
        for j in range(i + 1, 4):
            given[i] -= solved[i, j] * given[j]
        given[i] /= solved[i, i]


@kernel
def _apart(links, matrix, torques, holding, inertia, change):
    """The links' angular accelerations (4,) if each joint turned by itself what lies above it, over flat feet."""
    shank, thigh, trunk = 0.0, 0.0, 0.0
    for k in range(3):
        first, turned = 3 - k, 0.0
        for i in range(first, 4):
            if inertia == PRINTED:
                turned += links.mass[i]
            else:
                for j in range(first, 4):
                    turned += matrix[i, j]
        bend = -(torques[k] - holding[k]) / turned
        if k == 0:
            trunk = bend
        elif k == 1:
            thigh = bend
        else:
            shank = bend
    change[0], change[1], change[2] = 0.0, shank, shank - thigh
    change[3] = change[2] + trunk
