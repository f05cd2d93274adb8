"""Where a head turns: to a place it is told to look at, or else to where its body is about to go."""

from __future__ import annotations

import math

from ..body import spring_kernel
from ..compiled import kernel
from .kernel import HIPS_AT, LANES
from .root_motion import short_way

AHEAD = 0.35
"""A turning body looks to where it will face so much later [s] …"""
ASIDE = 0.5
"""… and one that goes sideways turns its head this share of the way there."""
FARTHEST, NODS = 1.1, 0.5
"""A head turns and nods this far [rad]; what lies behind it is not looked at."""
HALFLIFE = 0.14
"""Half-life of a head's turn [s]."""
QUICKEST = 50.0
"""A head that turns speeds up no faster than this [rad/s²], as people's that look elsewhere."""
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
        turn = AHEAD * wish[1]
        if wish[0] > -0.1:
            turn += ASIDE * math.atan2(wish[2], max(wish[0], 1e-6)) * speed * speed / (speed * speed + SLOW * SLOW)
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
    for j in range(neck, neck + 2):  # half by the neck, half by the head
        row[j] += 0.5 * m.gaze[1]
        row[LANES + j] += 0.5 * m.gaze[0]


@kernel
def look_on(m, axis, goal, dt):
    """Lead how far a head turns (axis 0) or nods (1) to a goal [rad], and how fast."""
    at, rate = spring_kernel(m.gaze[axis], m.gaze_rate[axis], goal, HALFLIFE, dt)
    over = abs(rate - m.gaze_rate[axis]) / (QUICKEST * dt)
    if over > 1.0:
        rate = m.gaze_rate[axis] + (rate - m.gaze_rate[axis]) / over
        at = m.gaze[axis] + 0.5 * (m.gaze_rate[axis] + rate) * dt
    m.gaze[axis], m.gaze_rate[axis] = at, rate
