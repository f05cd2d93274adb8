"""Where a body goes that was struck, and its feet: a linear inverted pendulum, caught by steps to its capture point.

Whoever is at x with a velocity v comes to rest over the place x + v/ω, ω = √(g/h) (Pratt 2006). While that capture point is over the soles,
pressure under them holds it there: the body sways. Else a foot goes where the capture point will be as it lands (Koolen 2012), again if that is
too far for one step; where it gets away from all that legs reach, the body falls. Feet come down where the ground carries them (`surroundings`): who is not caught short of an
edge goes over it.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..body import margin_kernel
from ..compiled import kernel
from .passing import PACES
from .swaying import RATE, into_kernel, middle_kernel, support_kernel, sway_kernel
from .stepping import (SOONEST, ahead_kernel, far_kernel, goes_kernel, home_kernel, leans_kernel, short_kernel, soon_kernel, step_kernel,
                       walks_kernel, which_kernel)
from .surroundings import NOTHING, point_kernel, tread_kernel

LONGEST = 6.0
"""Nobody takes longer to come to rest [s]."""
STILL, ENOUGH = 0.03, 0.4
"""Who stands on both feet and has not moved faster than this [m/s] for so long [s] is at rest wherever he is: what stands about may keep feet from where they rest."""
REACTS, SWINGS, AGAIN, CLOSES = 0.22, 0.31, 0.27, 0.42
"""A standing body lifts a foot so long after it was struck [s] (recorded: 0.20 … 0.27), which swings so long; that of each further step; and that which is set down beside the other at last."""
HASTE = 0.6, 0.35, 0.65
"""Who is pushed faster than the first [m/s] does both sooner, by the second share for each m/s, to the third at most."""
GOES_ON = 0.12
"""Who walks on once a foot has landed: so long his way is still told [s]."""
TRIES = 1.0
"""So long he may fall ahead over his soles until he goes [s]."""
STRIDE = 0.5
"""A foot that was in the air when a fast body was struck lands as that has gone so far on [m], at standard height."""
SHOWN = 1.6
"""So long it takes until a body that was pushed has answered with trunk and arms [s]."""
STANDS_BOTH = 0.05
"""Both feet stand so long between two steps [s]."""
LOST = 0.34
"""A capture point so far off the soles as a foot lands [m], at standard height, was not caught: the body falls."""
STRIDES = 0.65
"""A foot that the mass centre will soon have left farther behind than this [m], at standard height, leaves at once: no leg is so long, and hips would go down."""
MOST = 5
"""Who has not caught himself with so many steps falls."""
HOME, SLOW, NEAR = 0.12, 0.30, 0.015
"""Feet that are farther than the first from where they rest [m] are set down there once the body is slower than the second [m/s] and over one foot; it is at rest with its
capture point as near as the third [m] to their middle."""
SWAYS, STEPS, FALLS, DROPS = range(4)
"""What becomes of it: the last goes over an edge, a foot on nothing."""


class Way(NamedTuple):
    """Where it goes. centre, velocity: (N, 2) x, z of the mass centre [m] and its velocity [m/s], at RATE. steps: (S, 7) of each
    step its side, 0 left or 1 right, when it lifts and lands [s], and where its ball comes down and points: x, z [m], yaw [rad], and how high the ground lies there [m]. levels: (2,)
    how high it lies under the feet as they stand [m]. fate: SWAYS, STEPS, FALLS or DROPS. caught: how many steps it took to catch it. goes: from when on [s] it can walk as it
    wishes, infinite where it does not."""

    centre: np.ndarray
    velocity: np.ndarray
    steps: np.ndarray
    levels: np.ndarray
    fate: int
    caught: int
    goes: float = math.inf


def way(centre: np.ndarray, velocity: np.ndarray, feet: np.ndarray, free: np.ndarray, heading: float, rate: float, wish: np.ndarray, body, floor: float = 0.0,
        things: np.ndarray = NOTHING, over: bool = False, pace: float = PACES[0]) -> Way:
    """The way of a mass centre (2,) x, z [m] that moves with a velocity (2,) [m/s]. feet: (2, 3) where the balls are and point, x, z [m], yaw [rad]; free: (2,) which is
    in the air. rate: ω [1/s]. wish: (2,) [m/s] in the world, how it wants to move on. floor: [m] on which it stands. things: (K, 9) what stands about, as of `about`. over: it is not to
    fall, but to go on until a foot comes down over an edge. pace: how fast feet swing at most [m/s], in the mean, at standard height."""
    count = int(LONGEST * RATE)
    out = np.empty((2, count, 2))
    steps, stood = np.empty((2 * MOST + 4, 7)), np.empty((2, 4))
    stood[:, :3] = feet
    for side in range(2):
        stood[side, 3] = floor if free[side] else tread_kernel(things, stood[side, 0], stood[side, 1], floor + 0.2, float(floor))
    levels = stood[:, 3].copy()
    n, taken, fate, caught, goes = way_kernel(np.asarray(centre, float), np.asarray(velocity, float), stood, np.array(free, bool), float(heading), float(rate),
                                              np.asarray(wish, float), body, things, bool(over), float(pace), out[0], out[1], steps)
    return Way(out[0, :n].copy(), out[1, :n].copy(), steps[:taken].copy(), levels, fate, caught, goes)


@kernel
def way_kernel(centre, velocity, feet, free, heading, rate, wish, body, things, over, pace, centres, velocities, steps):
    """See `way`. Returns how many moments and steps, the fate, the steps that caught it, and when it can walk on [s]."""
    x, v, p, goal, point = centre.copy(), velocity.copy(), centre.copy(), np.empty(2), np.empty(2)
    points, corners, target, other = np.empty((8, 2)), np.empty((9, 2)), np.empty(4), np.empty(2)
    swing, lands, lifts, taken, caught, fate, closing = -1, 0.0, -1.0, 0, 0, SWAYS, False
    landed, last, dt, calm, still, side, gone, closed, leans, leaned = 0.0, 0, 1.0 / RATE, 0.0, 0.0, -1, False, False, False, 0.0
    stance = 0 if math.hypot(feet[0, 0] - x[0], feet[0, 1] - x[1]) < math.hypot(feet[1, 0] - x[0], feet[1, 1] - x[1]) else 1
    haste = max(1.0 - HASTE[1] * max(math.hypot(velocity[0], velocity[1]) - HASTE[0], 0.0), HASTE[2])
    first, wishes, ends = not (free[0] or free[1]), wish[0] != 0.0 or wish[1] != 0.0, math.inf
    count, short = support_kernel(body, feet, free, points, corners), short_kernel(rate)
    if count > 0:
        into_kernel(corners, count, p)
    for n in range(len(centres)):
        now = n * dt
        centres[n], velocities[n] = x, v
        point_kernel(things, feet[stance, 3], body.size, x, v, rate, point)
        count = support_kernel(body, feet, free, points, corners)
        if swing >= 0:
            if now >= lands - 0.5 * dt:  # it lands
                feet[swing] = target
                free[swing] = False
                closed = closing
                if not closing:
                    caught += 1
                if gone:
                    return n + 1, taken, DROPS, caught, math.inf
                last, stance, swing, landed = swing, swing, -1, now
                count = support_kernel(body, feet, free, points, corners)
                behind = not free[1 - last] and far_kernel(feet[1 - last], x, heading, 2.0 * last - 1.0, wishes, body.size) > 1.0
                inside = max(margin_kernel(corners, count, point[0], point[1]), margin_kernel(corners, count, point[0] - short * wish[0], point[1] - short * wish[1]))
                lost = inside < -LOST * body.size or caught > MOST or behind
                if lost and not over or caught > 2 * MOST:
                    return n + 1, taken, FALLS, caught, math.inf
                if not closing and wishes and walks_kernel(v, heading, body.size):
                    ends = now + GOES_ON if goes_kernel(v, wish, body.size) else math.inf
        if taken > 0 and swing < 0 and ends == math.inf and not (free[0] or free[1]):  # it falls ahead until it goes, unless something holds it
            leans = leaned < TRIES and walks_kernel(v, heading, body.size) and leans_kernel(corners, count, point, wish, body.size)
            leaned += dt * leans
            if leans and goes_kernel(v, wish, body.size):
                ends = now + GOES_ON
        if now > ends:
            return n + 1, taken, fate, caught, ends - GOES_ON
        if swing >= 0:
            pass
        elif (free[0] or free[1]) and ends == math.inf:  # struck in the middle of a step: the foot in the air goes on to where it is needed
            side = 0 if free[0] and not free[1] else 1
            if free[0] and free[1]:
                side = 0 if (feet[0, 0] - feet[1, 0]) * v[0] + (feet[0, 1] - feet[1, 1]) * v[1] > 0.0 else 1
            swift = STRIDE * body.size / max(math.hypot(v[0], v[1]), 0.1)
            swing, lands, closing = side, now + max(min(haste * SWINGS, swift), SOONEST), False
            if over:
                lands = now + soon_kernel(things, body, swing, feet, x, v, p, rate, lands - now, heading, points, corners)
            long, gone = step_kernel(things, body, swing, feet, x, v, p, rate, lands - now, now, heading, wish, over, pace, target, points, corners)
            lands = now + long
            steps[taken, 0], steps[taken, 1], steps[taken, 2] = swing, 0.0, lands  # it has swung since the strike
            steps[taken, 3:7] = target
            taken += 1
            fate = STEPS
            count = support_kernel(body, feet, free, points, corners)
        drags = swing < 0 and taken > 0 and not free[1 - last] and math.hypot(x[0] + GOES_ON * v[0] - feet[1 - last, 0], x[1] + GOES_ON * v[1] - feet[1 - last, 1]) > STRIDES * body.size
        if swing < 0 and not (free[0] or free[1]) and (drags or ends == math.inf and not leans):
            inside = margin_kernel(corners, count, point[0], point[1])
            moves = math.hypot(v[0], v[1])
            if drags or inside < 0.0:  # it has to step
                if drags:
                    lifts = now
                elif lifts < 0.0:
                    lifts = haste * REACTS if first and taken == 0 else now + STANDS_BOTH
                if now >= lifts - 0.5 * dt:
                    swing = which_kernel(feet, point, heading) if taken == 0 else 1 - last
                    long = haste * SWINGS if taken == 0 else AGAIN
                    if over:
                        long = soon_kernel(things, body, swing, feet, x, v, p, rate, long, heading, points, corners)
                    long, gone = step_kernel(things, body, swing, feet, x, v, p, rate, long, 0.0, heading, wish, over, pace, target, points, corners)
                    lands, closing, fate, lifts = now + long, False, STEPS, -1.0
            elif inside >= 0.0:
                lifts = -1.0
                still = still + dt if moves < STILL else 0.0
                if still > ENOUGH and now > SHOWN:
                    return n + 1, taken, fate, caught, math.inf
                if home_kernel(things, body, 1 - stance, feet, heading, target) > HOME * body.size and not closed:
                    middle_kernel(body, feet[stance], goal)
                    near = math.hypot(point[0] - goal[0], point[1] - goal[1])
                    if (moves < SLOW and near < 0.05 * body.size or still > 0.5 * ENOUGH) and now > landed + 0.1:
                        swing, closing = 1 - stance, True
                        lands = now + CLOSES
                        home_kernel(things, body, swing, feet, heading, target)
                else:
                    near = math.hypot(point[0] - goal[0], point[1] - goal[1])
                    if near < NEAR and moves < 0.03:
                        calm += dt
                        if calm > 0.25 and now > SHOWN:
                            return n + 1, taken, fate, caught, math.inf
            if swing >= 0:
                leans = False
                steps[taken, 0], steps[taken, 1], steps[taken, 2] = swing, now, lands
                steps[taken, 3:7] = target
                taken += 1
                free[swing] = True
                count = support_kernel(body, feet, free, points, corners)
                if taken >= len(steps):
                    return n + 1, taken, FALLS, caught, math.inf
        middle_kernel(body, feet[0], goal)
        middle_kernel(body, feet[1], other)
        if swing >= 0:
            middle_kernel(body, feet[1 - swing], goal)
        elif home_kernel(things, body, 1 - stance, feet, heading, target) > HOME * body.size and not closed:
            middle_kernel(body, feet[stance], goal)
        else:
            goal[0], goal[1] = 0.5 * (goal[0] + other[0]), 0.5 * (goal[1] + other[1])
        if leans:  # pressure goes back, so that it falls ahead
            ahead_kernel(point, wish, body.size, goal)
        sway_kernel(things, feet[stance, 3], body.size, x, v, p, goal, corners, count, rate, dt)
    return len(centres), taken, fate, caught, math.inf
