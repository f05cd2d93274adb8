"""How high a body is over feet that stand on ground of different heights: low enough for the lower leg to reach, and no lower."""

from __future__ import annotations

import math

from ..body import spring_kernel
from ..compiled import kernel
from .foot_points import ball_kernel
from .memory import WALK
from .minimum_jerk import smooth
from .tops import SAME

GRAVITY = 9.81
LEVEL_HALFLIFE = 0.12
"""A body's level follows its feet with this half-life [s]."""
STROLLS, RUNS = 1.4, 2.2
"""A walker's level rises and sinks with a slope by itself, too, the more the faster he is between these [m/s]: a run that is let go of becomes a walk as fast."""
LOW, CLIMBING = (0.02, 0.075), (0.06, 0.25)
"""A body's level lies no more than the first [m] and the second share of what lies between its feet over the lower one's ground: its leg must reach there; but higher of who climbs ahead, whose
lower leg is about to leave: he went up squatting."""


@kernel
def lead_level(m, bears, goals, goes_on, faster, place, dt):
    """Lead on the body's level. bears, goals: (2,) how high the ground lies that bears a foot, and where it stands or will [m]. goes_on: how far (0 … 1) the body goes ahead.
    faster: how many times as often it steps as usual. place: (2,) scratch."""
    low, high = min(bears[0], bears[1]), max(bears[0], bears[1])
    before, rate = m.level, m.level_rate
    up = goes_on * _climbs_ahead(m, goals, place)
    most = LOW[0] + up * (CLIMBING[0] - LOW[0]) + (LOW[1] + up * (CLIMBING[1] - LOW[1])) * (high - low)
    m.middle = min(0.5 * (low + high), low + most)
    climbs = _climbs(m)
    m.level, m.level_rate = spring_kernel(m.level, m.level_rate - climbs, m.middle - m.lower, LEVEL_HALFLIFE / faster, dt)
    m.level, m.level_rate = m.level + climbs * dt, m.level_rate + climbs
    if m.level_rate < rate - GRAVITY * dt:  # nobody sinks faster than they fall
        m.level_rate = rate - GRAVITY * dt
        m.level = before + 0.5 * (rate + m.level_rate) * dt
    for k in range(4):  # what is shown stays where it is
        m.raised[k] -= m.level - before


@kernel
def _climbs_ahead(m, goals, place):
    """Whether who goes ahead climbs: a foot that swings comes down higher than it left, or, both down, the higher one is ahead. goals: (2,) how high feet stand, or will [m]."""
    higher = 0 if m.left[0] > m.left[1] else 1
    ball_kernel(m, higher, place)
    x, z = place[0], place[1]
    ball_kernel(m, 1 - higher, place)
    climbs = m.left[higher] > m.left[1 - higher] + SAME and math.sin(m.ground[2]) * (x - place[0]) + math.cos(m.ground[2]) * (z - place[1]) > 0.0
    for foot in range(2):
        if abs(goals[foot] - m.left[foot]) > SAME and m.held[foot] == 0:
            climbs = goals[foot] > m.left[foot]
    return 1.0 if climbs else 0.0


@kernel
def _climbs(m):
    """How fast the level of who runs, or still walks as fast, rises with a slope [m/s], which would else follow his feet too late for legs to have room."""
    share = smooth((math.hypot(m.velocity[0], m.velocity[2]) - STROLLS) / (RUNS - STROLLS)) if m.family == WALK else 1.0
    if share <= 0.0:
        return 0.0
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    x, z = c * m.velocity[2] + s * m.velocity[0], c * m.velocity[0] - s * m.velocity[2]
    return 0.5 * share * ((m.tilt[0, 0] + m.tilt[1, 0]) * x + (m.tilt[0, 1] + m.tilt[1, 1]) * z)
