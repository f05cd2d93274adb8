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
from .foot_points import foot_points
from .kernel import COLUMNS, HIPS_AT, LANES, SCRATCH, pose_kernel, series_kernel
from .last_stride import bring_together, step_first
from .root_motion import advance, locate, short_way, time_ahead
from .turning_back import pivots
from .turning_step import END as TURNED, turn_ahead, turned_row
from .swing import FADE, SAMPLES, SWING, away_kernel, need_of_room, other_line, own_side, with_toe

BESIDE = 0.25
"""The most that a foot goes to its own side of where the blend has it [m]."""
TRIES = 2
"""Then it goes away from the other by the shortest way, so often."""
REPLANS = 20.0
"""The place for a foot that comes down in so many seconds moves no faster than these times that many metres a second: the smoothest way to one that has moved
so takes a push of three times as much [m/s²]."""
SOONEST = 0.002
"""Nothing is looked up nearer than this [s]."""


class Ahead(NamedTuple):
    """Room for what is looked up of the time to come.

    until: (2,) when each foot that swings comes down [s], 0 for one that should be down. way: (2, SAMPLES, 2, 3) where the blend's heels and balls
    will be, x and z in the world and y over the floor, after `shares` (2, SAMPLES) of that time, 0 or less where that is
    past or nothing is planned.
    """

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
    until: np.ndarray
    shares: np.ndarray
    way: np.ndarray
    now: np.ndarray


@kernel
def room_to_plan(width, joints):
    """That room, for a library as wide and a body of as many joints."""
    return Ahead(np.empty(COLUMNS, np.float32), np.empty(width, np.float32), np.empty((joints, 3, 3), np.float32),
                 np.empty((joints, 3), np.float32), np.empty((joints, 3, 3), np.float32), np.empty(SCRATCH, np.float32),
                 np.empty((4, 3), np.float32), np.empty(4), np.empty((4, 3)), np.empty((2, 3, 2)),
                 np.empty(2), np.empty((2, SAMPLES)), np.empty((2, SAMPLES, 2, 3)), np.empty((3, 2, 3)))


@kernel
def plan_footholds(m, settings, space, table, turns, body, legs, ahead, flat, dt):
    """Plan where the feet that swing, or leave in the second half of their stance, will come down, and foretell the blend's way there.
    flat: whether nothing stands about, else feet find their places on it anew."""
    for foot in range(2):
        swing = SWING[m.family]
        left = (swing + 0.5 * foot - m.phase) % 1.0
        coming = left < 0.5 * (1.0 + swing)
        ahead.shares[foot] = 0.0
        ahead.until[foot] = time_ahead(m, table, left) if coming else 0.0
        lifts = coming and max(m.grip[2 * foot], m.grip[2 * foot + 1]) < 1.0
        if m.settled or not (left < swing or lifts):
            continue
        if m.turn != 0.0 and m.turned + left < TURNED:
            ahead.until[foot] = max(turn_ahead(m, turns, settings.agility, left, ahead.vectors[0]), SOONEST)
            turned_row(m, turns, m.turned + left, ahead.row)
            _come_down(m, foot, ahead.until[foot], body, legs, ahead)
        else:
            later = max(ahead.until[foot], SOONEST)
            ahead.until[foot] = later
            _foresee(m, foot, later, settings, space, table, body, legs, ahead)
            _foretell(m, foot, left, legs.paths, ahead)
        x, z = m.land[foot, 0], m.land[foot, 1]
        m.land[foot, 0] = m.land[foot, 1] = 0.0
        bring_together(m, foot, legs.stance)
        wanted_x, wanted_z = m.land[foot, 0], m.land[foot, 1]
        _beside(m, body, foot, ahead, m.turn == 0.0 or not m.spot)
        step_first(m, foot, math.hypot(m.land[foot, 0] - wanted_x, m.land[foot, 1] - wanted_z))
        if m.grip[2 * foot] + m.grip[2 * foot + 1] <= 0.0:
            if flat:
                _still_reached(m, foot, x, z, ahead.until[foot], dt)
        elif left < 0.5 * swing:  # it touches down where it is
            m.land[foot, 0], m.land[foot, 1] = x, z


@kernel
def _foresee(m, foot, later, settings, space, table, body, legs, ahead):
    """Write where the blend's foot comes down in `later` seconds into m.coming: its heel and ball, x and z in the world."""
    ground, command, target, moved = ahead.vectors[0], ahead.vectors[1], ahead.vectors[2], ahead.vectors[3]
    look_ahead(m, settings, table, later, ground, command)
    command[0] = reached(space, command[0] / SCALE[0], m.family) * SCALE[0]
    command[1] /= pivots(m)
    simplex = locate(m, space, command, settings, ahead.barycentric, target, moved)
    stays = 2.0 ** (-later / settings.weight_halflife)
    for i in range(m.weights.shape[0]):
        ahead.weights[i] = stays * m.weights[i]
    for i in range(4):
        ahead.weights[space.vertices[simplex, i]] += (1.0 - stays) * ahead.barycentric[i]
    series_kernel(table, ahead.weights, (SWING[m.family] + 0.5 * foot) % 1.0, ahead.row)
    _come_down(m, foot, later, body, legs, ahead)


@kernel
def _come_down(m, foot, later, body, legs, ahead):
    """Write where a foot of the row in `ahead` comes down in `later` seconds, over the ground frame there, into m.coming."""
    ground = ahead.vectors[0]
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
def _foretell(m, foot, left, paths, ahead):
    """Write into ahead.way where the blend's foot will be until it comes down, `left` further in phase, and into ahead.shares when.

    As the paths of the primitives have it at weights and along a way that lead evenly from now to then, and off it by as much as
    it is now and will be then.
    """
    ground, now, end, at = ahead.vectors[0], ahead.now[0], ahead.now[1], ahead.now[2]
    strike, whole = SWING[m.family] + 0.5 * foot, ahead.until[foot]
    _along_paths(m.weights, ahead.weights, 0.0, paths, strike - left, foot, now)
    _along_paths(m.weights, ahead.weights, 1.0, paths, strike, foot, end)
    for k in range(2):
        for i in range(3):
            now[k, i] = m.points[2 * foot + k, i] - now[k, i]
            end[k, i] = ahead.points[2 * foot + k, i] - end[k, i]
    goes = ahead.vectors[1]  # the ground frame as it moves now, for all that time
    for i in range(3):
        goes[i] = m.ground[i]
    advance(goes, m.velocity[0], m.velocity[1], m.velocity[2], whole)
    turn, turned = short_way(goes[2] - m.ground[2]), short_way(ground[2] - goes[2])
    for k in range(SAMPLES):
        share = 1.0 - SWING[m.family] * (1.0 - (k + 0.5) / SAMPLES) / max(left, 1e-6)
        ahead.shares[foot, k] = share
        if share <= 0.0:
            continue
        _along_paths(m.weights, ahead.weights, share, paths, strike - (1.0 - share) * left, foot, at)
        heading = m.ground[2] + share * turn + share * share * turned
        x = m.ground[0] + share * (goes[0] - m.ground[0]) + share * share * (ground[0] - goes[0])
        z = m.ground[1] + share * (goes[1] - m.ground[1]) + share * share * (ground[1] - goes[1])
        c, s = math.cos(heading), math.sin(heading)
        for p in range(2):
            for i in range(3):
                at[p, i] += now[p, i] + share * (end[p, i] - now[p, i])
            ahead.way[foot, k, p, 0] = x + c * at[p, 0] + s * at[p, 2]
            ahead.way[foot, k, p, 1] = at[p, 1]
            ahead.way[foot, k, p, 2] = z - s * at[p, 0] + c * at[p, 2]


@kernel
def _along_paths(first, last, share, paths, phase, foot, out):
    """Write where heel and ball (2, 3) of a foot are at a phase on the paths (P, PHASES, 4, 3) of primitives, at weights that have
    gone that share of the way from the first to the last."""
    at = (phase % 1.0) * paths.shape[1]
    one = int(at) % paths.shape[1]
    two, part = (one + 1) % paths.shape[1], at - int(at)
    for k in range(2):
        for i in range(3):
            out[k, i] = 0.0
    for p in range(paths.shape[0]):
        w = first[p] + share * (last[p] - first[p])
        if w > 0.0:
            for k in range(2):
                for i in range(3):
                    a, b = paths[p, one, 2 * foot + k, i], paths[p, two, 2 * foot + k, i]
                    out[k, i] += w * (a + part * (b - a))


@kernel
def _beside(m, body, foot, ahead, sides):
    """Add to m.land how far aside (2,) of where it is to come down a foot is set, so that it is a shoe's width from the other; and,
    where feet have sides, on its own."""
    here, there, away = ahead.lines[0], ahead.lines[1], ahead.barycentric
    if not other_line(m, body, foot, there):
        return
    for k in range(2):
        here[k, 0], here[k, 1] = m.coming[foot, k, 0] + m.land[foot, 0], m.coming[foot, k, 1] + m.land[foot, 1]
    with_toe(body, here)
    side = 1.0 - 2.0 * foot
    own_side(there, here, side, away)
    need = min(need_of_room(there, here, side, FADE), BESIDE) if sides else 0.0
    away[0], away[1] = need * away[0], need * away[1]
    for _ in range(1 + TRIES):
        for i in range(3):
            here[i, 0] += away[0]
            here[i, 1] += away[1]
        m.land[foot, 0] += away[0]
        m.land[foot, 1] += away[1]
        away_kernel(there, here, away)


@kernel
def _still_reached(m, foot, x, z, until, dt):
    """Take a foot on its way no farther from where it was to be set, x, z aside of the blend, than it can still swing."""
    far = math.hypot(m.land[foot, 0] - x, m.land[foot, 1] - z)
    share = min(REPLANS * until * dt / max(far, 1e-9), 1.0)
    m.land[foot, 0] = x + share * (m.land[foot, 0] - x)
    m.land[foot, 1] = z + share * (m.land[foot, 1] - z)


@kernel
def stride(m, points, positions):
    """Lengthen or shorten the stride of contact points (4, 3), about the pelvis, by what the cadence leaves of the stretch."""
    longer = math.sqrt(m.stretch) - 1.0
    for foot in range(2):
        shift = longer * (0.5 * (points[2 * foot, 2] + points[2 * foot + 1, 2]) - positions[0, 2])
        points[2 * foot, 2] += shift
        points[2 * foot + 1, 2] += shift
