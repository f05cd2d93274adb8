"""Footholds: where a foot that swings will come down, planned with the way of the root and anew whenever the wish changes.

The root's way to the end of the swing is that of the command as it is being taken up; there the blend's own foot is
looked up, at the weights and in the phase of that moment. Where it would come too near to the other foot it is set
down beside it. The swing is the blend's, and leads smoothly to that place.
"""

from __future__ import annotations

import math

from ..body import spring_kernel
from ..compiled import kernel
from .command import look_ahead, reached, stages
from .control_space import SCALE
from .foot_lines import away_kernel, need_of_room, own_side, with_toe
from .foot_points import foot_points
from .fading import HEAVY, held_up_kernel
from .foretold_way import foretell_way
from .kernel import HIPS_AT, LANES, pose_kernel, series_kernel
from .last_stride import bring_together, step_first
from .root_motion import locate, time_ahead
from .short_leg import STRAINED
from .turning_back import pivots
from .turning_step import END as TURNED, turn_ahead, turned_row
from .swing import SWING, other_line

BESIDE = 0.25
"""The most that a foot goes to its own side of where the blend has it [m]."""
TRIES = 2
"""Then it goes away from the other by the shortest way, so often."""
REPLANS = 20.0
"""The place for a foot that comes down in so many seconds moves no faster than these times that many metres a second: the smoothest way to one that has moved
so takes a push of three times as much [m/s²]."""
FADED = 0.02
"""An offset that is smaller [m, rad] needs no second look."""
SOONEST = 0.002
"""Nothing is looked up nearer than this [s]."""


@kernel
def plan_footholds(m, settings, space, table, turns, body, legs, ahead, flat, dt):
    """Plan where the feet that swing, or leave in the second half of their stance, will come down, and foretell the blend's way there.
    flat: whether nothing stands about, else feet find their places on it anew."""
    for foot in range(2):
        swing = SWING[m.family]
        left = (swing + 0.5 * foot - m.phase) % 1.0
        # one that is torn off, or let go as its leg is strained, early in its stance comes down with the next strike
        coming = left < 0.5 * (1.0 + swing) or m.torn[foot] == 1 or m.rise[foot] > STRAINED[0]
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
            fades = _fades(m, legs.hip[foot])
            if fades:
                _halfway(m, foot, left, later, table, body, legs, ahead)
            foretell_way(m, body, foot, left, legs, ahead, fades)
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
    keep, spent = stages(settings, later)
    for i in range(m.weights.shape[0]):
        ahead.weights[i] = keep * m.weights[i] + (1.0 - keep - spent) * m.led[i]
    for i in range(4):
        ahead.weights[space.vertices[simplex, i]] += spent * ahead.barycentric[i]
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
def _halfway(m, foot, left, later, table, body, legs, ahead):
    """Write where the blend's heels and balls are halfway through what is `left` of a swing, in phase, while an offset fades, into ahead.halfway (4, 3)."""
    for i in range(m.weights.shape[0]):
        ahead.between[i] = 0.5 * (m.weights[i] + ahead.weights[i])
    series_kernel(table, ahead.between, (SWING[m.family] + 0.5 * foot - 0.5 * left) % 1.0, ahead.row)
    _fading(m, legs.hip[foot], 0.5 * later, ahead.row)
    pose_kernel(body, ahead.row, ahead.local, ahead.positions, ahead.orientations, ahead.scratch)
    foot_points(body, legs, ahead.positions, ahead.orientations, ahead.halfway)
    stride(m, ahead.halfway, ahead.positions)


@kernel
def _fades(m, hip):
    """Whether an offset of the hips or of a leg is still to fade."""
    most = 0.0
    for i in range(3):
        most = max(most, abs(m.blend[HIPS_AT + i]), abs(m.blend[i * LANES]))
        for j in range(hip, hip + 3):
            most = max(most, abs(m.blend[i * LANES + j]))
    return most > FADED


@kernel
def _fading(m, hip, later, row):
    """Add what will be left of an offset to the columns of the hips and of a leg."""
    for i in range(3):
        row[HIPS_AT + i] += (held_up_kernel(m.blend[HIPS_AT + i], m.blend_rate[HIPS_AT + i], m.fade, later) if i == 1 else
                             spring_kernel(m.blend[HIPS_AT + i], m.blend_rate[HIPS_AT + i], 0.0, HEAVY * m.fade, later))[0]
        row[i * LANES] += spring_kernel(m.blend[i * LANES], m.blend_rate[i * LANES], 0.0, m.fade, later)[0]
        for j in range(hip, hip + 3):
            d = i * LANES + j
            row[d] += spring_kernel(m.blend[d], m.blend_rate[d], 0.0, m.fade, later)[0]


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
    need = min(need_of_room(there, here, side), BESIDE) if sides else 0.0
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
