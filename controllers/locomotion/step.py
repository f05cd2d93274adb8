"""One step of a walking character, compiled: command → weights → phase → pose → root → feet."""

from __future__ import annotations

import math

import numpy as np

from ..body import spring_kernel
from ..compiled import kernel
from .control_space import SCALE
from .foot_lock import at_rest, place_feet
from .kernel import (ACTIVE, COLUMNS, DURATION_AT, HIPS_AT, LABELS_AT, LANES, SCRATCH, clamp_kernel, inner_kernel,
                     pose_kernel, query_kernel, series_kernel)
from .memory import RUN, WALK
from .root_motion import move_root, to_world_kernel


@kernel(nogil=True)
def step_kernel(memory, wish, dt, settings, body, legs, walk, run, table, velocities, root, local):
    """Step every character of `memory` (N,) by dt towards its wish (N, 3); write root and local pose.

    root: (N, 3) [m]. local: (N, J, 3, 3). Both float32, in the world. Runs without the interpreter's
    lock, so threads may step parts of a crowd side by side.
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
        _shape_command(m, wish[n], dt, settings, walk, run, p, q)
        _weigh(m, settings, dt, walk, run, table, fresh, b, p, q)
        advance_phase(m, wish[n], dt)
        blend_series(m, settings, table, fresh, legs, dt)
        pose_kernel(body, fresh, local[n], positions, orientations, scratch)
        move_root(m, settings, body, legs, positions, orientations, velocities, dt)
        if settings.footing:
            place_feet(m, body, legs, settings.clearance, positions, orientations, local[n], dt, work)
        else:
            for k in range(4):
                m.standing[k] = 1 if m.settled or m.row[LABELS_AT + k] > 0.5 else 0
        if at_rest(m, legs):
            m.settled = 1
        to_world_kernel(m, fresh, root[n], local[n])


@kernel
def _shape_command(m, wish, dt, settings, walk, run, p, inner):
    """The wish, brought to what the library holds and smoothed: an exact critically damped spring,
    no faster than legs can push."""
    for i in range(3):
        p[i] = wish[i] / SCALE[i]
    if wish[0] > (settings.run_above if m.family == WALK else settings.walk_below):
        inner_kernel(run, p, inner)
        clamp_kernel(run, p, inner)
    else:
        inner_kernel(walk, p, inner)
        clamp_kernel(walk, p, inner)
    for i in range(3):
        before = m.command[i]
        x, v = spring_kernel(before, m.rate[i], p[i] * SCALE[i], settings.command_halflife, dt)
        most = settings.acceleration if i != 1 else 4.0 * settings.acceleration
        step = x - before
        if abs(step) > most * dt:
            step = math.copysign(most * dt, step)
            v = step / dt
        m.command[i], m.rate[i] = before + step, v


@kernel
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
    for i in range(m.weights.shape[0]):  # what fades is dropped, but not what grows from nothing
        m.weights[i] *= keep
        if m.weights[i] < ACTIVE and not _one_of(i, vertices):
            m.weights[i] = 0.0
    for i in range(4):
        m.weights[vertices[i]] += (1.0 - keep) * b[i]
    for i in range(m.weights.shape[0]):
        total += m.weights[i]
    for i in range(m.weights.shape[0]):
        m.weights[i] /= total
    if switch:  # inertialise: what was shown minus what the other family shows now
        m.fade = settings.switch_halflife
        series_kernel(table, m.weights, m.phase, fresh)
        for d in range(LABELS_AT):
            m.blend[d] = m.row[d] - fresh[d]
        m.row[DURATION_AT] = fresh[DURATION_AT]  # at the other family's pace, too
        series_kernel(table, m.weights, _next_phase(m, dt), fresh)
        for d in range(LABELS_AT):
            m.blend_rate[d] = m.row_rate[d] - (fresh[d] - (m.row[d] - m.blend[d])) / dt


@kernel
def _one_of(i, vertices):
    return i == vertices[0] or i == vertices[1] or i == vertices[2] or i == vertices[3]


@kernel
def advance_phase(m, wish, dt):
    """Run the phase on at dφ/dt = 1 / duration(φ); at rest it waits, and starts with a swing."""
    if m.settled:
        if wish[0] ** 2 + wish[1] ** 2 + wish[2] ** 2 < 1e-6:
            return
        # a body at rest starts in the middle of a swing, with the other foot under it
        left_first = wish[1] > 0.05 or (wish[1] >= -0.05 and wish[2] >= 0.0)
        m.phase = 0.03 if left_first else 0.53
        m.settled = 0
    m.phase = _next_phase(m, dt)


@kernel
def _next_phase(m, dt):
    return (m.phase + dt / max(m.row[DURATION_AT], 0.3)) % 1.0


@kernel
def blend_series(m, settings, table, fresh, legs, dt):
    """The series of the weighted primitives, with inertialisation and breath, into `fresh` and m.row."""
    series_kernel(table, m.weights, m.phase, fresh)
    for d in range(LABELS_AT):
        m.blend[d], m.blend_rate[d] = spring_kernel(m.blend[d], m.blend_rate[d], 0.0,
                                                      m.fade, dt)
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
    sway = settings.breath * calm * math.sin(2.0 * math.pi * m.breath + 1.0)
    fresh[HIPS_AT] += 0.3 * sway
