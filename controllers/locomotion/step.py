"""One step of a walking character, compiled: command → weights → phase → pose → root → feet."""

from __future__ import annotations

import math

import numpy as np

from ..body import spring_kernel
from ..compiled import kernel
from .carried_arms import carry_arms
from .command import LEAST_STRETCH, MOST_STRETCH, reached, shape_command, stages
from .control_space import SCALE
from .fading import HEAVY, held_up_kernel
from .first_stride import BEFORE, SHIFT, add_start, break_off, leans, leave_rest, shift_left, start_kernel
from .foot_lock import at_rest, place_feet
from .foothold import plan_footholds, stride
from .foretold_way import room_to_plan
from .gait_change import change_kernel
from .gaze import gaze_kernel
from .halt import heed_halt
from .idle import add_idle, idle_kernel
from .last_stride import until_together
from .foot_points import foot_points, on_floor, toe_ends
from .kernel import ACTIVE, COLUMNS, DURATION_AT, HIPS_AT, LABELS_AT, LANES, SCRATCH, duration_kernel, pose_kernel, series_kernel
from .memory import RUN, WALK
from .root_motion import SHORTEST, cadence_kernel, follow_command, locate, tempo_kernel, to_world_kernel
from .sitting_back import sit_back
from .traction import keep_traction, make_up
from .turning_back import pivots, turn_back, turn_corner
from .turning_step import after_turn, begin_turn, end_turn, lead_turn, turned_row
from .uneven_ground import stand_on

STRETCH_HALFLIFE = 0.08
"""Strides lengthen and shorten with this half-life [s]."""
FASTEST_WALK, SLOWEST_RUN = 1.3, 2.4
"""Who is asked to run does so once faster than the one [m/s], who is asked to walk once slower than the other …"""
MOMENTS = 8
"""So many moments of a step are looked at, so that gaits change as early in a long one as in a short one."""
STRAIGHT = 0.2
"""… and who goes no faster to the side than this [m/s], or is so slow that nobody runs."""


@kernel(nogil=True)
def step_kernel(memory, wish, dt, settings, body, legs, walk, run, table, changes, idle, start, turns, masses, tops,
                floors, root, local):
    """Step every character of `memory` (N,) by dt towards its wish (N, 3); write root and local pose.

    tops: the ground (`uneven_ground`), of which none makes it flat. floors: (N,) [m] how high each stands, rewritten.
    root: (N, 3) [m]. local: (N, J, 3, 3). Both float32, in the world. Runs without the interpreter's
    lock, so threads may step parts of a crowd side by side.
    """
    joints = local.shape[1]
    positions = np.empty((joints, 3), np.float32)
    orientations = np.empty((joints, 3, 3), np.float32)
    scratch = np.empty(SCRATCH, np.float32)
    fresh = np.empty(COLUMNS, np.float32)
    work = np.empty((5, 3, 3), np.float64)
    before, came = np.empty((4, 2)), np.empty(2)
    b, p, q, c = np.empty(4), np.empty(3), np.empty(3), np.empty(3)
    ahead = room_to_plan(memory["weights"].shape[1], joints)
    for n in range(memory.shape[0]):
        m = memory[n]
        on_floor(m, before)  # before a turn leads the ground frame back
        came[0], came[1] = m.ground[0], m.ground[1]
        heed_halt(m, wish[n], settings, table, dt)
        onset, first = m.onset, m.first
        pace = _share_of_cycle(m, table, settings.agility, dt) / dt if onset > 0.0 else 0.0
        step = 0.0
        begin_turn(m, turns, wish[n], fresh)
        turn_corner(m, wish[n], dt)
        turn_back(m, turns, wish[n], settings, fresh)
        if onset > 0.0 and m.turn != 0.0:
            break_off(m, start, first, onset, pace)
        if m.turn != 0.0:
            step = lead_turn(m, turns, settings.agility, dt)
            _weigh(m, settings, dt, walk, run, table, changes, fresh, b, p, q, c)
            m.phase = (m.phase + until_together(m, step, legs.rest)) % 1.0
        else:
            leave_rest(m, wish[n])
            family, whole = m.family, _share_of_cycle(m, table, settings.agility, dt)
            lean = leans(m, 0.5 * whole)
            shape_command(m, wish[n], lean, dt, settings, table, walk, run, legs.stance, p, q)
            _weigh(m, settings, dt, walk, run, table, changes, fresh, b, p, q, c)
            advance_phase(m, table, settings.agility, legs.rest, dt, whole if m.family == family else -1.0)
        start_kernel(m, start, wish[n], dt)
        idle_kernel(m, idle, settings.idle, dt)
        if m.turn != 0.0:
            turned_row(m, turns, m.turned, fresh)
            end_turn(m, step)
            show_row(m, settings, fresh, legs, dt)
        else:
            blend_series(m, settings, table, fresh, legs, dt)
        add_idle(m, idle, fresh)
        add_start(m, start, fresh)
        sit_back(m, legs.neck, fresh, dt)
        carry_arms(m, legs.elbow, legs.bent, fresh, dt)
        gaze_kernel(m, wish[n], settings.gaze, legs.neck, fresh, dt)
        pose_kernel(body, fresh, local[n], positions, orientations, scratch)
        follow_command(m, dt)
        make_up(m, dt)
        foot_points(body, legs, positions, orientations, m.points)
        stride(m, m.points, positions)
        if settings.footing:
            toe_ends(body, legs, positions, orientations, ahead.toe)
            plan_footholds(m, settings, walk if m.family == WALK else run, table, turns, body, legs, ahead, tops.shape[0] == 0, dt)
            place_feet(m, body, legs, ahead, settings.clearance, tops, floors[n], before, positions, orientations, local[n], dt, work)
            keep_traction(m, masses, legs, settings, came, floors[n], positions, orientations, local[n], dt, work)
        else:
            for k in range(4):
                m.grip[k] = 1.0 if m.settled or m.row[LABELS_AT + k] > 0.5 else 0.0
                m.standing[k] = 1 if m.grip[k] > 0.5 else 0
        if m.turn == 0.0 and at_rest(m, legs):
            m.settled = 1
        to_world_kernel(m, fresh, root[n], local[n])
        if tops.shape[0] > 0:
            floors[n] += stand_on(m)


@kernel
def _weigh(m, settings, dt, walk, run, table, changes, fresh, b, p, q, c):
    """Choose the family, locate the command in its space, low-pass the weights."""
    since = _change(m, table, changes, settings.agility, dt) if m.wanted != m.family and not m.settled else -1.0
    switch = since >= 0.0
    keep, spent = stages(settings, dt)
    space = walk if m.family == WALK else run
    for i in range(3):
        c[i] = 0.0 if m.waits or m.turn != 0.0 and m.spot else m.command[i]
    ahead = c[0]
    c[0] = reached(space, ahead / SCALE[0], m.family) * SCALE[0]
    stretch = min(max(ahead / c[0], LEAST_STRETCH), MOST_STRETCH) if c[0] > 0.0 else 1.0
    m.stretch += (stretch - m.stretch) * (1.0 - 2.0 ** (-dt / STRETCH_HALFLIFE))
    c[1] /= pivots(m)
    simplex = locate(m, space, c, settings, b, p, q)
    vertices = space.vertices[simplex]
    m.simplex[m.family] = simplex
    if switch:
        keep, spent = 0.0, 1.0
    total = 0.0
    for i in range(m.weights.shape[0]):  # what fades is dropped, but not what grows from nothing
        m.weights[i], m.led[i] = keep * m.weights[i] + (1.0 - keep - spent) * m.led[i], keep * m.led[i]
        if m.led[i] < ACTIVE and not _one_of(i, vertices):
            m.led[i] = 0.0
            if m.weights[i] < ACTIVE:
                m.weights[i] = 0.0
    for i in range(4):
        m.led[vertices[i]] += (1.0 - keep) * b[i]
        m.weights[vertices[i]] += spent * b[i]
    for i in range(m.weights.shape[0]):
        total += m.weights[i]
    for i in range(m.weights.shape[0]):
        m.weights[i] /= total
    if switch:  # inertialise: what was shown minus what the other family shows now
        m.fade = settings.switch_halflife
        m.phase = (m.phase - since * _share_of_cycle(m, table, settings.agility, dt)) % 1.0
        series_kernel(table, m.weights, m.phase, fresh)
        for d in range(LABELS_AT):
            m.blend[d] = m.row[d] - fresh[d]
        m.row[DURATION_AT] = fresh[DURATION_AT]  # at the other family's pace, too
        series_kernel(table, m.weights, (m.phase + _share_of_cycle(m, table, settings.agility, dt)) % 1.0, fresh)
        for d in range(LABELS_AT):
            m.blend_rate[d] = m.row_rate[d] - (fresh[d] - (m.row[d] - m.blend[d])) / dt


@kernel
def _change(m, table, changes, agility, dt):
    """Change to the other family, and to its phase, if that may be within dt, at the moment from which on it may be, so that
    the size of a step does not matter; after which share of the step that is, negative if it may not."""
    whole = _share_of_cycle(m, table, agility, dt)
    for k in range(MOMENTS):
        share = k / MOMENTS
        ahead = m.velocity[0] + share * (m.command[0] - m.velocity[0])
        straight = abs(m.velocity[2] + share * (m.command[2] - m.velocity[2])) < STRAIGHT
        fits = straight and ahead > FASTEST_WALK if m.wanted == RUN else ahead < (SLOWEST_RUN if straight else FASTEST_WALK)
        common, phase = change_kernel(changes, m.family, (m.phase + share * whole) % 1.0)
        if fits and common:
            m.family = m.wanted
            m.phase = phase
            return share
    return -1.0


@kernel
def _one_of(i, vertices):
    return i == vertices[0] or i == vertices[1] or i == vertices[2] or i == vertices[3]


@kernel
def advance_phase(m, table, agility, rest, dt, before):
    """Run the phase on; at rest it waits. before: how far it would by the weights of the step's beginning, whose mean with that by
    those of its end is right to the second order; negative if they are of another gait."""
    if m.settled:
        return
    step = _share_of_cycle(m, table, agility, dt)
    step = until_together(m, step if before < 0.0 else 0.5 * (step + before), rest)
    m.onset = max(m.onset - step, 0.0)
    m.phase = (m.phase + step) % 1.0


@kernel
def _share_of_cycle(m, table, agility, dt):
    """How far the phase runs in dt, no faster than weight is shifted before a start's first toe-off."""
    left = shift_left(m)
    if left <= 0.0:
        return _run_on(m, table, 0.0, dt)
    shifting = min(cadence_kernel(m), agility * BEFORE / SHIFT)
    return min(shifting * dt, left) + _run_on(m, table, left, max(dt - left / shifting, 0.0))


@kernel
def _run_on(m, table, begin, dt):
    """How far the phase runs in dt from `begin` ahead of where it is: its pace changes within a cycle, by the rule of Runge and Kutta."""
    if dt <= 0.0:
        return 0.0
    pace = tempo_kernel(m)
    step = total = 0.0
    for k in range(4):
        at = begin + (0.0, 0.5, 0.5, 1.0)[k] * step
        step = pace / max(duration_kernel(table, m.weights, m.phase + at), SHORTEST) * dt
        total += (1.0, 2.0, 2.0, 1.0)[k] / 6.0 * step
    return total


@kernel
def blend_series(m, settings, table, fresh, legs, dt):
    """The series of the weighted primitives, with inertialisation and breath, into `fresh` and m.row."""
    series_kernel(table, m.weights, m.phase, fresh)
    if m.left_turn:
        after_turn(m, table, fresh, dt)
    show_row(m, settings, fresh, legs, dt)


@kernel
def show_row(m, settings, fresh, legs, dt):
    """Add to a row (COLUMNS,) what is left of an offset, and breath, and remember it as m.row."""
    for d in range(LABELS_AT):
        if d == HIPS_AT + 1:
            m.blend[d], m.blend_rate[d] = held_up_kernel(m.blend[d], m.blend_rate[d], m.fade, dt)
        else:
            m.blend[d], m.blend_rate[d] = spring_kernel(m.blend[d], m.blend_rate[d], 0.0, m.fade if d < HIPS_AT else HEAVY * m.fade, dt)
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
    fresh[HIPS_AT] += sway_kernel(float(m.breath), float(settings.breath), float(calm))


@kernel
def sway_kernel(phase, breath, calm):
    """How far aside hips sway [m] in a phase (0 … 1) of a breath that turns the chest so far [rad], of somebody so calm (0 … 1)."""
    return 0.3 * breath * calm * math.sin(2.0 * math.pi * phase + 1.0)
