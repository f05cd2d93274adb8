"""How what a pose was off by as it began fades: joints at once, the hips, on which the mass hangs, later."""

from __future__ import annotations

import math

from ..body import spring_kernel
from ..compiled import kernel

HEAVY = 2.0
"""An offset of the hips, which the mass hangs on, takes this many times as long to go as one of the joints …"""
SINKS = 0.8
"""… and this many times where it holds them up: who begins to run as his hips go down, or a walk as they rise, would else be carried on through the air; and as long as
it grows downward, as of who begins to walk as his hips go down: they would go down by 10 cm more."""


@kernel
def held_up_kernel(x, v, fade, dt):
    """The offset of the hips' height [m] and its rate after dt: one that holds them up goes sooner, from the moment on at which it begins to, and one that grows downward is caught as soon."""
    while True:
        high, sinks = x > 0.0 or x == 0.0 and v > 0.0, v < 0.0
        half = (SINKS if high or sinks else HEAVY) * fade
        y = 2.0 * math.log(2.0) / (half + 1e-9)
        pull = v + x * y
        first = dt
        if x * pull < 0.0:
            first = min(-x / pull, dt)
        elif not high and sinks:
            first = min(v / (y * pull), dt)
        if first >= dt:
            return spring_kernel(x, v, 0.0, half, dt)
        later, rate = spring_kernel(x, v, 0.0, half, first)
        x, v = (0.0, rate) if x * pull < 0.0 else (later, 0.0)
        dt -= first
