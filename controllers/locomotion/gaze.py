"""Where a head turns: to a place it is told to look at, or else to where its body is about to go."""

from __future__ import annotations

import math

from ..body import spring_kernel
from ..compiled import kernel
from .kernel import HIPS_AT, LANES
from .root_motion import short_way

AHEAD, BEFORE = 0.08, 0.15
"""A turning body looks to where it will face so much later [s], one that is about to turn otherwise to where that alone would take it in so long, beyond
what recorded steps look …"""
ASIDE = 0.15
"""… and one that goes sideways turns its head this share of the way there."""
UNASKED = 0.45
"""No head turns farther than this [rad] by itself."""
FARTHEST, NODS = 1.1, 0.5
"""Told to look somewhere it turns and nods this far [rad]; what lies behind it is not looked at …"""
EASY, SHARED = 0.45, 0.4
"""… and beyond so much of it [rad] shoulders take this share."""
HALFLIFE = 0.14
"""Half-life of a head's turn [s]."""
QUICKEST = 18.0
"""A head that turns speeds up no faster than this [rad/s²]."""
SLOW = 0.25
"""Below this speed [m/s] it counts less and less where somebody goes."""
EYES = 0.62
"""Eyes are this much higher than the hips [m]."""


@kernel
def gaze_kernel(m, wish, amount, neck, row, dt):
    """Turn neck and head (joints `neck` and `neck` + 1) of a series row by dt; wish: (3,) v_f, ω, v_l."""
    turn, nod = 0.0, 0.0
    if not m.looks:
        speed = math.hypot(wish[0], wish[2])
        turn = AHEAD * m.command[1] + BEFORE * (wish[1] - m.command[1])
        if wish[0] > -0.1:
            turn += ASIDE * math.atan2(wish[2], max(wish[0], 1e-6)) * speed * speed / (speed * speed + SLOW * SLOW)
        turn = min(max(turn, -UNASKED), UNASKED)
    else:
        x, z = m.look[0] - m.ground[0], m.look[2] - m.ground[1]
        turn = short_way(math.atan2(x, z) - m.ground[2])
        nod = -math.atan2(m.look[1] - row[HIPS_AT + 1] - EYES, max(math.hypot(x, z), 0.1))
        behind = min(max((math.pi - abs(turn)) / (math.pi - 2.0), 0.0), 1.0)  # nobody looks through the back of his head
        turn, nod = turn * behind, nod * behind
    turn = amount * min(max(turn, -FARTHEST), FARTHEST)
    nod = amount * min(max(nod, -NODS), NODS)
    look_on(m, 0, turn, dt)
    look_on(m, 1, nod, dt)
    shoulders = SHARED * (max(m.gaze[0] - EASY, 0.0) + min(m.gaze[0] + EASY, 0.0))
    row[LANES + neck - 1] += shoulders
    for j in range(neck, neck + 2):  # half by the neck, half by the head
        row[j] += 0.5 * m.gaze[1]
        row[LANES + j] += 0.5 * (m.gaze[0] - shoulders)


@kernel
def look_on(m, axis, goal, dt):
    """Lead how far a head turns (axis 0) or nods (1) to a goal [rad], and how fast."""
    at, rate = spring_kernel(m.gaze[axis], m.gaze_rate[axis], goal, HALFLIFE, dt)
    over = abs(rate - m.gaze_rate[axis]) / (QUICKEST * dt)
    if over > 1.0:
        rate = m.gaze_rate[axis] + (rate - m.gaze_rate[axis]) / over
        at = m.gaze[axis] + 0.5 * (m.gaze_rate[axis] + rate) * dt
    m.gaze[axis], m.gaze_rate[axis] = at, rate
