"""Where a runner's centre of mass is lowest, and where he leaves, who pushes off one foot that has just struck."""

from __future__ import annotations

import math

from ...compiled import kernel
from .bound import longer_kernel
from .going_slowly import LOW, PUSHES
from .thrust import MOMENTS, risen_kernel

YIELDS = 0.04
"""How long a runner's foot gives before it pushes, at least [s]."""
SHORTEST_PUSH = 0.08
"""No foot pushes a runner off in less [s]."""
STRIDE = 1.022
"""How much higher a body leaves off one foot, whose heel is higher, than off two."""
SLACK = 0.03
"""So much higher a runner may leave, on a straighter leg [m], at standard height."""
STRIKE = -0.5
"""How a runner's centre of mass is accelerated as the foot has struck, over gravity: half its weight is carried."""
SOONER, TIMES = 0.85, 5
"""How much sooner a runner leaves that could not come up so far ahead of the foot, at most so often."""
EXACT = 1e-9
"""How long his foot gives is told to so much [s]."""


@kernel
def running_kernel(off, tall, leave, land, velocity, found):
    """The take-off of a runner who pushes off one foot that has just struck, about with a velocity (3,) [m/s] to be at `land` (3,). off: what he takes off from; tall: how high [m] he leaves over his
    foot. found: (4, 3) written, as by `standing_kernel`. Returns the time until the lowest point [s].

    The foot gives while the body passes, then pushes; it pushes as long as the body is about as far behind it
    at first as ahead of it at last, or farther ahead if it is to become faster.
    """
    size, g, most = off.size, -off.gravity[1], off.leads[-1]
    x, z = 0.5 * (off.velocity[0] + velocity[0]), 0.5 * (off.velocity[2] + velocity[2])
    mean = math.hypot(x, z)
    a, c = x / max(mean, 1e-6), z / max(mean, 1e-6)
    behind = (off.centre[0] - off.balls[0]) * a + (off.centre[2] - off.balls[2]) * c
    speed = max(mean, 0.3)
    # the force's mean lean brings the velocity about
    lean = ((velocity[0] - off.velocity[0]) * a + (velocity[2] - off.velocity[2]) * c) / max(velocity[1] - off.velocity[1] + g * 0.2, 1.0)
    lead = min(2.0 * lean * off.stand - behind, most)
    if off.along:
        lead = behind + (longer_kernel(velocity[1], size, g) if off.bound else 1.0) * PUSHES * math.sqrt(9.81 * size / g) * speed
    tall, low = STRIDE * tall, LOW * size * off.skipping
    contact, least, longest, slack = YIELDS + SHORTEST_PUSH, YIELDS, YIELDS, SLACK * size
    for _ in range(TIMES):  # who leaves sooner leaves higher
        contact = max((lead - behind) / speed, YIELDS + SHORTEST_PUSH)
        longest = contact - SHORTEST_PUSH
        if _above(off, longest, contact, contact * speed + behind, velocity[1], tall, low) <= slack or longest <= least:
            break
        lead = behind + SOONER * (lead - behind)
    ends = contact * speed + behind
    yielding = least
    if _above(off, least, contact, ends, velocity[1], tall, low) > 0.0:
        if _above(off, longest, contact, ends, velocity[1], tall, low) >= 0.0:
            yielding = longest
        else:
            while longest - least > EXACT:
                yielding = 0.5 * (least + longest)
                if _above(off, yielding, contact, ends, velocity[1], tall, low) > 0.0:
                    least = yielding
                else:
                    longest = yielding
    rise = risen_kernel(contact - yielding, velocity[1], g)
    for i in range(3):
        found[3, i] = off.balls[i]
    for i, part in ((0, x), (2, z)):
        found[0, i] = off.centre[i] + off.velocity[i] * yielding
        found[1, i] = found[0, i] + part * (contact - yielding)
        found[2, i] = off.velocity[i]
    found[1, 1] = off.floor + _over(tall, max(ends, 0.0)) - low + min(_above(off, yielding, contact, ends, velocity[1], tall, low), slack)
    found[0, 1], found[2, 1] = found[1, 1] - rise, 0.0
    return yielding


@kernel
def _above(off, yielding, contact, ends, up, tall, low):
    """How much too high [m] a body leaves if the foot gives so long [s] of its contact, and it leaves `ends` [m] ahead of it, upward by `up` [m/s]."""
    g, pushed = -off.gravity[1], contact - yielding
    level = (up / pushed + g) / MOMENTS[0]
    sinks = -0.5 * off.velocity[1] * yielding + (level - g - STRIKE * g) * yielding**2 / 12.0
    return off.centre[1] - sinks + risen_kernel(pushed, up, g) - (off.floor + _over(tall, max(ends, 0.0)) - low)


@kernel
def _over(height, aside):
    """See `body.over`."""
    return math.sqrt(max(height**2 - aside**2, 0.25 * height**2))
