"""Who has let go comes to rest before an edge that he would else walk or run over, if he can still stop there.

Nobody who wishes to go on is held back: he steps off. But what is left of a walk, a run or a leap once all is let go of leads nobody off a box: he brakes
in earnest, or harder where that is just enough. Who is too fast for it runs off as he would.
"""

from __future__ import annotations

import math

import numpy as np

from ..compiled import kernel
from ..navigation.passing import STEP
from .tops import ground_kernel

BRAKES, HARDEST = 4.5, 8.0
"""Who comes to an edge brakes by the first [m/s²]; by as much as the second where he could not stop before it otherwise: nobody can who would need more."""
LAG = 0.05
"""He begins to so much sooner [s] than he has to."""
KEEPS, BARELY = 0.24, 0.12
"""He comes to rest with his middle so far before the edge, toes on the floor; and so far where he could not stop before, toes over the edge [m]."""
SLOW = 0.6
"""Who is no faster than this [m/s] stops within a foot's length."""
LOOKS, FINER = 0.1, 4
"""Places ahead are looked at so far apart [m]; where the edge is, is found by halving that so often."""
SEES = 0.5, 0.3
"""Beyond where he is to rest he looks so far [m], and farther by so much for the square of his speed [s²/m]: the last step of a stop is planned before braking for it begins."""
LEAST = 0.03
"""Slower than this [m/s] nobody goes anywhere, or wishes to."""


@kernel
def before_edge(m, was, dt):
    """Slow down the command, as it has been taken up, of somebody who has let go before an edge. was: how fast it was [m/s] `dt` ago."""
    speed, f, side = math.hypot(m.command[0], m.command[2]), m.command[0], m.command[2]
    most = slowed(was, m.brink, dt)
    if speed > most:
        m.command[0], m.command[2] = f * most / speed, side * most / speed
        m.rate[0], m.rate[2] = (f / speed) * (most - was) / dt, (side / speed) * (most - was) / dt


@kernel
def runs_off(m):
    """Whether somebody who has let go comes to an edge too fast to stop before it: who brakes all the same would end half over it."""
    speed = math.hypot(m.command[0], m.command[2])
    return m.brink > 0.0 and speed > SLOW and speed * speed > 2.0 * HARDEST * max(m.brink - BARELY, 0.0)


@kernel
def slowed(speed, far, dt):
    """How fast [m/s] somebody goes at most `dt` later who goes at a speed [m/s] towards an edge so far ahead of his middle [m]."""
    needs = speed * speed / (2.0 * max(far - BARELY, 1e-6))
    room = max(far - KEEPS, 0.0)
    allowed = BRAKES * (math.sqrt(LAG * LAG + 2.0 * room / BRAKES) - LAG)
    return max(allowed, speed - min(max(BRAKES, needs), HARDEST) * dt)


@kernel
def edge_ahead(m, tops, floor):
    """How far ahead of somebody's middle the ground ends [m] where he goes who has let go; 0 where that is farther than he looks, and for others, and less than 0 in the
    first step: whose wish is gone for a step alone goes on. Who is about to leap is left to his leap."""
    speed = math.hypot(m.velocity[0], m.velocity[2])
    if m.settled or m.alert or speed < LEAST or math.hypot(m.wished[0], m.wished[1]) > LEAST:
        return 0.0
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    x, z = (c * m.velocity[2] + s * m.velocity[0]) / speed, (c * m.velocity[0] - s * m.velocity[2]) / speed
    ground = np.empty(3)
    ground_kernel(tops, m.ground[0], m.ground[1], floor, m.level, ground)
    before = ground[0] if ground[0] > m.level - 2.0 * STEP else m.level
    for k in range(1, 2 + int((KEEPS + SEES[0] + SEES[1] * speed * speed) / LOOKS)):
        far = k * LOOKS
        ground_kernel(tops, m.ground[0] + far * x, m.ground[1] + far * z, floor, before, ground)
        if ground[0] > before + STEP:  # a wall
            return 0.0
        if ground[0] < before - STEP:
            near = far - LOOKS
            for _ in range(FINER):
                middle = 0.5 * (near + far)
                ground_kernel(tops, m.ground[0] + middle * x, m.ground[1] + middle * z, floor, before, ground)
                if ground[0] < before - STEP:
                    far = middle
                else:
                    near = middle
            return math.copysign(max(near, 1e-3), 1.0 if m.brink != 0.0 else -1.0)
        before = ground[0]
    return 0.0
