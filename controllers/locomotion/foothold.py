"""Footholds: where a foot that swings will come down, planned with the way of the root and anew whenever the wish changes.

The root's way to the end of the swing is that of the command as it is being taken up; there the blend's own foot is
looked up, at the weights and in the phase of that moment. Where it would come too near to the other foot it is set
down beside it. The swing is the blend's, and leads smoothly to that place.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..body import spring_kernel
from ..compiled import kernel
from .command import look_ahead, reached
from .control_space import SCALE
from .cycles import EVENTS
from .foot_clearance import FADE, away_kernel, need_of_room, outline_kernel, with_toe
from .foot_points import foot_points
from .kernel import COLUMNS, HIPS_AT, LANES, SCRATCH, duration_kernel, pose_kernel, query_kernel, series_kernel
from .last_stride import bring_together
from .root_motion import SHORTEST, cadence_kernel

SWING = (float(EVENTS["walk"][1]), float(EVENTS["run"][3]))
"""The share of the cycle for which a foot swings, walking and running: from its toe-off to its strike."""
BESIDE = 0.25
"""The most that a foot goes to its own side of where the blend has it [m]."""
TRIES = 2
"""Then it goes away from the other by the shortest way, so often."""
SOONEST = 0.002
"""Nothing is looked up nearer than this [s]."""


class Ahead(NamedTuple):
    """Room for what is looked up of the time to come."""

    row: np.ndarray
    weights: np.ndarray
    local: np.ndarray
    positions: np.ndarray
    orientations: np.ndarray
    scratch: np.ndarray
    points: np.ndarray
    barycentric: np.ndarray
    vectors: np.ndarray
    lines: np.ndarray


@kernel
def room_to_plan(width, joints):
    """That room, for a library as wide and a body of as many joints."""
    return Ahead(np.empty(COLUMNS, np.float32), np.empty(width, np.float32), np.empty((joints, 3, 3), np.float32),
                 np.empty((joints, 3), np.float32), np.empty((joints, 3, 3), np.float32), np.empty(SCRATCH, np.float32),
                 np.empty((4, 3), np.float32), np.empty(4), np.empty((4, 3)), np.empty((2, 3, 2)))


@kernel
def swing_progress(m, foot):
    """How far through its swing foot 0 (left) or 1 is, by the phase: 0 … 1, beyond while it stands."""
    return ((m.phase - 0.5 * foot) % 1.0) / SWING[m.family]


@kernel
def plan_footholds(m, settings, space, table, body, legs, ahead):
    """Plan where the feet that swing will come down."""
    for foot in range(2):
        progress = swing_progress(m, foot)
        if m.settled or progress >= 1.0:
            continue
        later = (1.0 - progress) * SWING[m.family] / cadence_kernel(m) * _slower(m, table, (1.0 - progress) * SWING[m.family])
        _foresee(m, foot, max(later, SOONEST), settings, space, table, body, legs, ahead)
        _beside(m, body, foot, ahead)
        bring_together(m, foot, legs.stance)


@kernel
def _slower(m, table, share):
    """How much slower the phase runs on average for the next `share` of a cycle than it does now, by Simpson's rule."""
    total, now = 0.0, duration_kernel(table, m.weights, m.phase)
    for k in range(5):
        duration = duration_kernel(table, m.weights, m.phase + 0.25 * k * share) if k > 0 else now
        total += (1.0, 4.0, 2.0, 4.0, 1.0)[k] / 12.0 * duration
    return total / max(now, SHORTEST)


@kernel
def _foresee(m, foot, later, settings, space, table, body, legs, ahead):
    """Write where the blend's foot comes down in `later` seconds into m.coming: its heel and ball, x and z in the world."""
    ground, command, target, moved = ahead.vectors[0], ahead.vectors[1], ahead.vectors[2], ahead.vectors[3]
    look_ahead(m, settings, later, ground, command)
    command[0] = reached(space, command[0] / SCALE[0], m.family) * SCALE[0]
    simplex = query_kernel(space, command, m.simplex[m.family], settings.correct, ahead.barycentric, target, moved)
    stays = 2.0 ** (-later / settings.weight_halflife)
    for i in range(m.weights.shape[0]):
        ahead.weights[i] = stays * m.weights[i]
    for i in range(4):
        ahead.weights[space.vertices[simplex, i]] += (1.0 - stays) * ahead.barycentric[i]
    series_kernel(table, ahead.weights, (SWING[m.family] + 0.5 * foot) % 1.0, ahead.row)
    if m.fade > 0.0:
        _fading(m, legs.hip[foot], later, ahead.row)
    pose_kernel(body, ahead.row, ahead.local, ahead.positions, ahead.orientations, ahead.scratch)
    foot_points(body, legs, ahead.positions, ahead.orientations, ahead.points)
    stride(m, ahead.points, ahead.positions)
    c, s = math.cos(ground[2]), math.sin(ground[2])
    for k in range(2):
        x, z = ahead.points[2 * foot + k, 0], ahead.points[2 * foot + k, 2]
        m.coming[foot, k, 0] = ground[0] + c * x + s * z
        m.coming[foot, k, 1] = ground[1] - s * x + c * z


@kernel
def _fading(m, hip, later, row):
    """Add what will be left of an offset to the columns of the hips and of a leg."""
    for i in range(3):
        row[HIPS_AT + i] += spring_kernel(m.blend[HIPS_AT + i], m.blend_rate[HIPS_AT + i], 0.0, 2.0 * m.fade, later)[0]
        row[i * LANES] += spring_kernel(m.blend[i * LANES], m.blend_rate[i * LANES], 0.0, m.fade, later)[0]
        for j in range(hip, hip + 3):
            d = i * LANES + j
            row[d] += spring_kernel(m.blend[d], m.blend_rate[d], 0.0, m.fade, later)[0]


@kernel
def _beside(m, body, foot, ahead):
    """Write into m.land how far aside (2,) of where the blend comes down a foot is set, so that it is a shoe's width from the other."""
    here, there = ahead.lines[0], ahead.lines[1]
    outline_kernel(m, body, 1 - foot, there)
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    for i in range(3):
        x, z = there[i, 0], there[i, 1]
        there[i, 0], there[i, 1] = m.ground[0] + c * x + s * z, m.ground[1] - s * x + c * z
    for k in range(2):
        here[k, 0], here[k, 1] = m.coming[foot, k, 0], m.coming[foot, k, 1]
    with_toe(body, here)
    side = 1.0 - 2.0 * foot
    x = there[1, 0] - there[0, 0] + here[1, 0] - here[0, 0]
    z = there[1, 1] - there[0, 1] + here[1, 1] - here[0, 1]
    size = math.sqrt(x * x + z * z) + 1e-9
    x, z = side * z / size, -side * x / size  # to its own side of both
    need = min(need_of_room(there, here, side, FADE), BESIDE)
    away = ahead.barycentric
    away[0], away[1] = need * x, need * z
    m.land[foot, 0] = m.land[foot, 1] = 0.0
    for _ in range(1 + TRIES):
        for i in range(3):
            here[i, 0] += away[0]
            here[i, 1] += away[1]
        m.land[foot, 0] += away[0]
        m.land[foot, 1] += away[1]
        away_kernel(there, here, away)


@kernel
def stride(m, points, positions):
    """Lengthen or shorten the stride of contact points (4, 3), about the pelvis, by what the cadence leaves of the stretch."""
    longer = math.sqrt(m.stretch) - 1.0
    for foot in range(2):
        shift = longer * (0.5 * (points[2 * foot, 2] + points[2 * foot + 1, 2]) - positions[0, 2])
        points[2 * foot, 2] += shift
        points[2 * foot + 1, 2] += shift
