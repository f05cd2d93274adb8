"""Corners, and the way back: who is told in his walk or run to go where he came from brakes with a step, turns over it as from rest, and goes.

So do recorded people: the foot ahead takes the speed, both feet stand for a moment, and the one behind is set down turned. Which
way round they turn is up to the foot that is ahead when they are slow. Who walks and is to go aside turns in a step or two, slower meanwhile,
over the foot that stands: faster than anybody turns who walks round in circles, by as much as recorded people do at corners.
"""

from __future__ import annotations

import math

from ..body import spring_kernel
from ..compiled import kernel
from .first_stride import shift_left
from .memory import WALK
from .minimum_jerk import smooth
from .root_motion import cadence_kernel, short_way
from .turning_step import BEFORE, enter_turn

GOES = 0.5
"""Who will be slower than this [m/s] needs no turns of those who walk."""
BACK = 2.75
"""Who is told to face another way by more than this [rad] turns back …"""
LEAST, GONE = 0.5, 1.2
"""… if he goes faster than the first [m/s], until he has less than the second [rad] to turn."""
SLOW = 0.7
"""He turns once he is no faster than this [m/s]."""
MEANWHILE = 0.8
"""So fast he turns while he brakes [rad/s]."""
TAKES_UP, LAST = 0.1, 0.06
"""Braking takes so much longer [s] than at legs' hardest push; a turn that begins nearer to its toe-off than this, in phase, is too late."""
BEYOND = 0.6
"""He goes on to that side as long as it is no more than so much [rad] farther round."""
CORNER, WHOLE = 0.3, 0.8
"""Who walks and is to face another way by more than the first [rad] turns as at a corner, from the second on altogether: …"""
TURNS, HURRIES, GAIN = 1.5, 1.3, 4.0
"""… by so much [rad/s], and more by his speed [m/s], no more than the second, at most, and by so many times what is left; …"""
SLOWS = 0.5
"""… slower by this power of how far he looks that way already; …"""
PIVOTS = 0.5
"""… and his pose is that of somebody who turns slower by up to this share, while his body turns so much farther over the foot that stands, …"""
TAKEN_UP = 0.1
"""… which it takes up with this half-life [s]."""


@kernel
def pivots(m):
    """How many times as fast as his pose somebody turns."""
    return 1.0 + PIVOTS * m.corner


@kernel
def _corner(m):
    """How far (0 … 1) somebody who walks, and is told which way he will go, turns as at a corner."""
    if not m.heads or m.family != WALK or m.backs != 0 or m.turn != 0.0 or m.settled or m.waits or shift_left(m) > 0.0 or m.towards[1] <= GOES:
        return 0.0
    return smooth((abs(short_way(m.towards[0] - m.ground[2])) - CORNER) / (WHOLE - CORNER))


@kernel
def turn_corner(m, wish, dt):
    """Make a wish (3,) straight on and turning that of somebody who takes a corner, whose pose takes it up smoothly."""
    share = _corner(m)
    m.corner, m.corner_rate = spring_kernel(m.corner, m.corner_rate, share, TAKEN_UP, dt)
    if share <= 0.0 or wish[2] != 0.0 or wish[0] <= 0.0:
        return
    left = short_way(m.towards[0] - m.ground[2])
    most = TURNS + min(m.towards[1], HURRIES)
    turn = most * math.tanh(GAIN * left / most)
    if turn * wish[1] > 0.0 and abs(turn) > abs(wish[1]):
        wish[1] += share * (turn - wish[1])
    wish[0] *= 1.0 - share + share * max(0.5 + 0.5 * math.cos(left), 0.0) ** SLOWS


@kernel
def turn_back(m, turns, wish, settings, row):
    """Brake and begin a turn where somebody is to go back, but not on stairs, where his steps would find no treads; who runs brakes to a walk first. wish: (3,), which is changed meanwhile. row: (COLUMNS,) scratch."""
    goes = not (m.settled or m.waits or m.turn != 0.0 or m.stairs > 0.0)
    asked = m.heads and m.towards[1] > GOES and turns.coefficients.shape[3] > 0
    turn, speed = short_way(m.towards[0] - m.ground[2]), math.hypot(m.command[0], m.command[2])
    if not (goes and asked) or (m.backs == 0 or m.family != WALK) and (abs(turn) < BACK or m.command[0] < LEAST):
        m.backs = 0
        return
    if m.family != WALK:  # he brakes first, straight on
        m.backs = 1 if turn > 0.0 else -1
        wish[0] = wish[1] = wish[2] = 0.0
        return
    if abs(turn) > BACK:
        m.backs = _side(m, speed, settings)
    if turn * m.backs < 0.0:
        turn += 2.0 * math.pi * m.backs
    if not GONE < abs(turn) < math.pi + BEYOND:
        m.backs = 0
        return
    since = (m.phase + (0.0 if m.backs == 1 else 0.5)) % 1.0 - 1.0
    if speed < SLOW and -BEFORE <= since < -LAST:
        m.backs, m.spot = 0, 0
        enter_turn(m, turns, turn, since, row)
    else:
        wish[0], wish[1], wish[2] = 0.0, MEANWHILE * m.backs, 0.0


@kernel
def _side(m, speed, settings):
    """To which side, 1 left or -1 right, he turns over the foot that is ahead once he is slow: the other one leaves next."""
    later = cadence_kernel(m) * (TAKES_UP + (speed - SLOW) / settings.acceleration) / settings.agility if speed > SLOW else 0.0
    return 1 if 0.5 - LAST < (m.phase + later) % 1.0 <= 1.0 - LAST else -1
