"""How high a foot that swings is led over the blend's: early enough to clear the floor without being stopped by it.

As a gait changes, the pose that fades may put the blend's foot under the floor in the middle of its swing. Held up only there, it fell onto a height over the floor at
five metres a second, was slapped flat within two frames, and slid on over it.
"""

from __future__ import annotations

import math

from ..compiled import kernel
from .swing import HARDEST, QUICKEST, SAMPLES, SOONEST, led_to, push_back, push_on
from .uneven_ground import lie_kernel


@kernel
def led_up(m, foot, ahead):
    """Whether a foot's height is led by where it will be: it swings, and that was foretold."""
    free = m.grip[2 * foot] <= 0.0 and m.grip[2 * foot + 1] <= 0.0
    return free and m.turn == 0.0 and ahead.until[foot] > 0.0 and ahead.shares[foot, SAMPLES - 1] > 0.0


@kernel
def lead_up(m, foot, ahead, height, clears, dt):
    """Lead on for dt how high a foot's heel and ball are over the blend's: by the least acceleration that brings them back as it lands, and by the least more by which
    each is no lower at any moment of its way than it must be, the soonest last. height: of standing points; clears: over that in mid-swing [m]."""
    left = max(ahead.until[foot], SOONEST)
    for k in range(2):
        point = 2 * foot + k
        lie = lie_kernel(m, point)
        x, v = m.raised[point] - lie, m.raised_rate[point]
        push = push_back(x, v, left)
        for j in range(SAMPLES - 1, -1, -1):
            s = ahead.shares[foot, j]
            if s <= 0.0 or s >= 1.0:
                continue
            later = max(s * left, QUICKEST)
            need = height + clears * math.sin(math.pi * (j + 0.5) / SAMPLES) - ahead.way[foot, j, k, 1]
            lacks = need - led_to(x, v, push, later)
            if lacks > 0.0:
                push += push_on(lacks, later)
        push = min(max(push, -HARDEST), HARDEST)
        m.raised[point] = lie + x + dt * (v + 0.5 * dt * push)
        m.raised_rate[point] = v + dt * push
