"""Coming to rest at a place: when somebody who goes there lets go of his wish, so that the strides of his stop end at it.

Until then he goes as he wishes. A stop takes as long as it takes to the strike that ends it, so that somebody who slows down evenly
comes as far as its speed and that time say; he lets go as soon as that leads to the place (`last_stride`), and what is left is led there.
"""

from __future__ import annotations

import math

from ..compiled import kernel
from .first_stride import shift_left
from .last_stride import AHEAD, NOWHERE, STAYS, STOPS, lets_go, time_to_stop, to_halt
from .root_motion import short_way

THERE, STRAIGHT = 0.02, 0.034
"""Who stands so near to the place [m], so nearly turned as he should [rad], stays."""
NEAR = 0.1
"""Nearer than this [m] his way is bent no more …"""
BENDS = 0.1
"""… and before with this half-life [s]."""
SPARES = 0.9
"""Of the square of his push so much is had for that and for braking."""
STEP, IN = 0.2, 0.35
"""What is no farther is a step away [m], which takes so long [s]."""
SOONEST = 0.25
"""A turn that is left takes at least this long [s]."""


@kernel
def heed_halt(m, wish, settings, table, dt):
    """Take the wish (3,) away from somebody who comes to rest at a place, once it is time for that, and leave him the turn that he still has
    to make."""
    if m.halts == NOWHERE:
        return
    turn = 0.0 if math.isnan(m.halt[2]) else short_way(m.halt[2] - m.ground[2])
    if m.settled:
        m.halts = STAYS if m.halts == STAYS or m.halts == STOPS and (m.kept[0] or m.kept[1]) else AHEAD  # as near as the ground has room for his feet
        if m.halts == STAYS or math.hypot(m.halt[0] - m.ground[0], m.halt[1] - m.ground[1]) <= THERE and abs(turn) <= STRAIGHT:
            wish[0] = wish[1] = wish[2] = 0.0
        else:
            _step_there(m, wish)
        return
    if m.halts == AHEAD and shift_left(m) > 0.0:  # who let go as he sets off beside the place would stand and set off in turns
        _step_there(m, wish)
    elif m.halts == AHEAD and lets_go(m, settings, table):
        m.halts = STOPS
    if m.halts >= STOPS:
        wish[0] = wish[2] = 0.0
        wish[1] = 2.0 * turn / max(time_to_stop(m, settings, table), SOONEST)
        if m.halts == STOPS and m.stop > 0.0 and to_halt(m) > NEAR and m.grip[0] + m.grip[1] + m.grip[2] + m.grip[3] > 0.0:
            _bend(m, settings.acceleration * settings.agility, dt)


@kernel
def _step_there(m, wish):
    """Let somebody who sets off to what is a step away wish to be there in a step's time, whatever else he wishes; who wishes nothing stays."""
    x, z = m.halt[0] - m.ground[0], m.halt[1] - m.ground[1]
    far = math.hypot(x, z)
    if THERE < far < STEP and wish[0] ** 2 + wish[1] ** 2 + wish[2] ** 2 > 0.0:
        c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
        wish[0], wish[2] = (s * x + c * z) / IN, (c * x - s * z) / IN


@kernel
def _bend(m, most, dt):
    """Turn the command of somebody who stops towards the place, with what braking leaves of the push of his legs."""
    x, z = m.halt[0] - m.ground[0], m.halt[1] - m.ground[1]
    off = short_way(math.atan2(x, z) - m.ground[2] - math.atan2(m.command[2], m.command[0]))
    left = math.sqrt(max(SPARES * most * most - m.rate[0] * m.rate[0] - m.rate[2] * m.rate[2], 0.0))
    most = left * dt / max(math.hypot(m.command[0], m.command[2]), 0.1)
    turn = min(max(off * (1.0 - 2.0 ** (-dt / BENDS)), -most), most)
    c, s = math.cos(turn), math.sin(turn)
    m.command[0], m.command[2] = c * m.command[0] - s * m.command[2], s * m.command[0] + c * m.command[2]
