"""Elbows that stay bent for a while as a run ends.

A blend that goes over to a walk stretches the arm that swings back within two tenths of a second, and carries the other stretched ahead of it: one forearm hangs, one
lies level. People who stop from a run hold both bent as they slow down, and let them down at its end.
"""

from __future__ import annotations

from ..body import spring_kernel
from ..compiled import kernel
from .kernel import LANES
from .memory import RUN

RECENT = 0.3
"""Half-life with which it is forgotten that one ran [s]: recorded elbows are bent by 60° or more until one is as slow as 0.8 m/s, half a second later by 30°."""
TAKES = 0.12
"""Half-life with which elbows come to be carried [s]."""


@kernel
def carry_arms(m, elbow, bent, row, dt):
    """Hold a walker's forearms, the joints `elbow` (2,) of a series row, for dt as a runner's are on the whole, bent (3, 2) [rad]; the less, the longer ago he ran."""
    runs = m.family == RUN
    m.ran += (1.0 - m.ran if runs else -m.ran) * (1.0 - 2.0 ** (-dt / (TAKES if runs else RECENT)))
    m.carried[0], m.carried[1] = spring_kernel(m.carried[0], m.carried[1], 0.0 if runs else m.ran, TAKES, dt)
    for side in range(2):
        for axis in range(3):
            d = axis * LANES + elbow[side]
            row[d] += m.carried[0] * (bent[axis, side] - row[d])
