"""Stopping: a body slows down evenly until its last foot has come down beside the other, as recorded people's do.

Who lets go of the stick while walking chooses the strike at which his feet will be together: the next one by which he
can have slowed down without pushing his hardest. Until then he loses as much speed each moment, so that strides get
shorter by themselves and the last one ends beside the foot that stands; there he glides on a little, and both feet stay.
"""

from __future__ import annotations

import math

import numpy as np

from ..body import spring_kernel
from ..compiled import kernel
from .cycles import EVENTS
from .foot_points import shown_kernel
from .memory import WALK
from .root_motion import cadence_kernel

STRIKE = float(EVENTS["walk"][1])
"""The phase in which the left foot comes down; the right one does half a cycle later."""
LEAST, MOST = 0.35, 1.4
"""Who is slower than the first [m/s] just stops; who is faster than the second pushes against it as hard as he can."""
HARD = 1.0
"""The share of their strength with which legs brake at most, if there is a strike for it."""
SOONEST = 0.42
"""The last foot comes down no sooner than this after the wish has gone, in phase: the other one must have been set down for it."""
GLIDE = 0.15
"""A body that comes to rest does so this long after its last foot has come down [s]."""
EVEN, STEEPEST = 1.0, 3.0
"""Speed goes with these powers of the time that is left, while the foot is still on its way that the body will stand on, and at most."""
HALFWAY = 0.5
"""Where the other foot is too near to the middle, the last one goes that share of it farther aside; the body makes up the rest."""
OVER = 0.18
"""It comes over its feet with this half-life [s]."""
BESIDE, DECIDED = 0.08, 0.9
"""Feet that are farther than the first from where they rest [m] step once more, as soon as the blend is at rest by the second."""
NO_WISH = 0.02
"""Wishes smaller than this are none [m/s, rad/s]."""


@kernel
def plan_stop(m, most, stance):
    """Choose the strike that ends a walk, as the phase that is left until it, where somebody who walks has no wish any more, and
    how steeply he slows down: so that he comes to rest over the foot that stands. most: what legs push [m/s²]. stance:
    where heels and balls are at rest (4, 2) [m]."""
    if m.settled or abs(m.asked[0]) + abs(m.asked[1]) + abs(m.asked[2]) > NO_WISH:
        m.stop, m.waits = 0.0, 0
        return
    speed = math.hypot(m.command[0], m.command[2])
    if m.waits or m.stop < 0.0:
        return
    if m.stop > 0.0:
        m.steep = _steepness(m, speed, stance)
        return
    if m.family != WALK or speed > MOST:
        m.stop = -1.0
    if m.stop < 0.0 or speed < LEAST:
        return
    left, pace = (STRIKE - m.phase) % 0.5, cadence_kernel(m)
    while left < SOONEST or left / pace + GLIDE < speed / (HARD * most):
        left += 0.5
    m.stop = left
    m.steep = _steepness(m, speed, stance)


@kernel
def _steepness(m, speed, stance):
    """The power of the time that is left with which a body slows down, so that it has come as far as the foot is that it will stand on."""
    if m.stop > 0.5 or speed <= 0.0:  # that one is not down yet
        return EVEN
    point, far = np.empty(2), 0.0
    for k in range(2 - 2 * _last(m), 4 - 2 * _last(m)):
        shown_kernel(m, k, point)
        far += 0.5 * ((point[1] - stance[k, 1]) * m.command[0] + (point[0] - stance[k, 0]) * m.command[2]) / speed
    return min(max(speed * time_to_stop(m) / max(far, 0.01) - 1.0, 1.0), STEEPEST)


@kernel
def _last(m):
    """Which foot comes down last: 0 the left one, 1 the right one."""
    return 0 if abs((m.phase + m.stop) % 1.0 - STRIKE) < 0.25 else 1


@kernel
def bring_together(m, foot, stance):
    """Lead the foot that comes down last to where it belongs beside the other, into m.land."""
    if m.stop <= 0.0 or m.stop > STRIKE or foot != _last(m):
        return
    other, ball, point = 3 - 2 * foot, 2 * foot + 1, np.empty(2)
    shown_kernel(m, other, point)
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    x, z = stance[ball, 0] + HALFWAY * (point[0] - stance[other, 0]), point[1] + stance[ball, 1] - stance[other, 1]
    m.land[foot, 0] = m.ground[0] + c * x + s * z - m.coming[foot, 1, 0]
    m.land[foot, 1] = m.ground[1] - s * x + c * z - m.coming[foot, 1, 1]


@kernel
def time_to_stop(m):
    """How long somebody who stops is still on the way [s]; 0 for others."""
    return m.stop / cadence_kernel(m) + GLIDE if m.stop > 0.0 else 0.0


@kernel
def come_over(m, stance, most, dt):
    """Lead the command of a body whose feet wait: it glides on until it is over them. most: what legs push [m/s²]."""
    x, z, point = 0.0, 0.0, np.empty(2)
    for k in range(4):
        shown_kernel(m, k, point)
        x += 0.25 * (stance[k, 0] - point[0])
        z += 0.25 * (stance[k, 1] - point[1])
    m.rate[0] = (spring_kernel(z, m.command[0], 0.0, OVER, dt)[1] - m.command[0]) / dt
    m.rate[2] = (spring_kernel(x, m.command[2], 0.0, OVER, dt)[1] - m.command[2]) / dt
    share = min(most / max(math.hypot(m.rate[0], m.rate[2]), 1e-9), 1.0)
    for i in (0, 2):
        m.rate[i] *= share
        m.command[i] += m.rate[i] * dt


@kernel
def until_together(m, step, rest):
    """How far of a step in phase runs: no farther than to the last strike. There both feet wait until the body is at rest, and step on
    the spot if one is not in its place then. rest: the number of the rest primitive."""
    if m.waits:
        x, z = m.offset[0, 0] - m.offset[1, 0], m.offset[0, 1] - m.offset[1, 1]
        if m.weights[rest] >= DECIDED and math.hypot(x, z) > 2.0 * BESIDE:
            m.waits = 0
        return 0.0
    if m.stop <= 0.0:
        return step
    if step < m.stop:
        m.stop -= step
        return step
    step, m.stop, m.waits = m.stop, 0.0, 1
    return step
