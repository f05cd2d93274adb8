"""Where a body goes that was struck, and its feet: a linear inverted pendulum, caught by steps to its capture point.

Whoever is at x with a velocity v comes to rest over the place x + v/ω, ω = √(g/h) (Pratt 2006). While that capture point is over the soles,
pressure under them holds it there: the body sways. Else a foot goes where the capture point will be as it lands (Koolen 2012), again if that is
too far for one step; where it gets away from all that legs reach, the body falls.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..body import HALF_SOLE, hull_kernel, margin_kernel
from ..compiled import kernel

RATE = 120.0
"""Moments a second."""
LONGEST = 6.0
"""Nobody takes longer to come to rest [s]."""
REACTS, SWINGS, AGAIN, CLOSES = 0.22, 0.31, 0.27, 0.42
"""A standing body lifts a foot so long after it was struck [s] (recorded: 0.20 … 0.27), which swings so long; that of each further step; and that which is set down beside the other at last."""
HASTE = 0.6, 0.35, 0.65
"""Who is pushed faster than the first [m/s] does both sooner, by the second share for each m/s, to the third at most."""
WALKS, GOES_ON = (-0.75, 4.3, 0.55), 0.12
"""Who wants to walk does so once a foot has landed and he goes between the first two ahead and no faster than the third aside [m/s], at standard height; so long
his way is still told [s]."""
STRIDE = 0.5
"""A foot that was in the air when a fast body was struck lands as that has gone so far on [m], at standard height."""
SOONEST = 0.1
"""No foot lands sooner [s]."""
SHOWN = 1.6
"""So long it takes until a body that was pushed has answered with trunk and arms [s]."""
FAR = (0.64, 0.60, 0.50)
"""A mass centre so far ahead of a foot's ball that stands, or behind it, or a hip so far beside it [m], at standard height, when the other lands, was not caught: no leg is
so long."""
HIP = 0.088
"""How far a hip is to its side [m], at standard height."""
STANDS_BOTH = 0.05
"""Both feet stand so long between two steps [s]."""
INSIDE = 0.85
"""Pressure stays within this share of the soles."""
TRACKS, LAGS = 4.0, 0.04
"""The capture point is led to where it shall be with this rate [1/s]; pressure follows what is wanted with this time constant [s]."""
REACH = (0.50, 0.42, 0.42)
"""So far from the mass centre a foot is set down [m] at standard height: ahead, behind, aside."""
OWN = 0.06
"""A foot keeps so far to its own side of the other [m], at standard height."""
APART = 0.27
"""How far apart feet are that rest beside each other [m], at standard height."""
BEYOND = 0.05
"""A foot is set down so far beyond the capture point [m], at standard height: its sole brakes."""
LOST = 0.34
"""A capture point so far off the soles as a foot lands [m], at standard height, was not caught: the body falls."""
MOST = 5
"""Who has not caught himself with so many steps falls."""
HOME, SLOW, NEAR = 0.12, 0.30, 0.015
"""Feet that are farther than the first from where they rest [m] are set down there once the body is slower than the second [m/s] and over one foot; it is at rest with its
capture point as near as the third [m] to their middle."""
SWAYS, STEPS, FALLS = range(3)
"""What becomes of it."""


class Way(NamedTuple):
    """Where it goes. centre, velocity, pressed: (N, 2) x, z of the mass centre [m], its velocity [m/s], and of the pressure under the soles [m], at RATE. steps: (S, 6) of each
    step its side, 0 left or 1 right, when it lifts and lands [s], and where its ball comes down and points: x, z [m], yaw [rad]. fate: SWAYS, STEPS or FALLS. caught: how many
    steps it took to catch it."""

    centre: np.ndarray
    velocity: np.ndarray
    pressed: np.ndarray
    steps: np.ndarray
    fate: int
    caught: int


def way(centre: np.ndarray, velocity: np.ndarray, feet: np.ndarray, free: np.ndarray, heading: float, rate: float, wish: np.ndarray, body) -> Way:
    """The way of a mass centre (2,) x, z [m] that moves with a velocity (2,) [m/s]. feet: (2, 3) where the balls are and point, x, z [m], yaw [rad]; free: (2,) which is
    in the air. rate: ω [1/s]. wish: (2,) [m/s] in the world, how it wants to move on."""
    count = int(LONGEST * RATE)
    out = np.empty((3, count, 2))
    steps = np.empty((2 * MOST + 4, 6))
    n, taken, fate, caught = way_kernel(np.asarray(centre, float), np.asarray(velocity, float), np.array(feet, float), np.array(free, bool), float(heading), float(rate),
                                        np.asarray(wish, float), body, out[0], out[1], out[2], steps)
    return Way(out[0, :n].copy(), out[1, :n].copy(), out[2, :n].copy(), steps[:taken].copy(), fate, caught)


@kernel
def sole_kernel(body, foot, points, first):
    """Write the four corners of what pressure may use of a sole whose ball is at `foot` (3,) into points[first:]; how many there are then."""
    half, s, c = INSIDE * HALF_SOLE * body.size, math.sin(foot[2]), math.cos(foot[2])
    back, tip = body.heel[2] - body.toe[2], body.tip[2]
    middle, reach = 0.5 * (back + tip), 0.5 * INSIDE * (tip - back)
    for along in (middle - reach, middle + reach):
        for aside in (half, -half):
            points[first, 0] = foot[0] + aside * c + along * s
            points[first, 1] = foot[1] - aside * s + along * c
            first += 1
    return first


@kernel
def middle_kernel(body, foot, out):
    """Write the middle (2,) of a sole whose ball is at `foot` (3,)."""
    along = 0.5 * (body.heel[2] - body.toe[2] + body.tip[2])
    out[0], out[1] = foot[0] + along * math.sin(foot[2]), foot[1] + along * math.cos(foot[2])


@kernel
def support_kernel(body, feet, free, points, corners):
    """Write the hull of the soles that stand into corners (9, 2); how many corners it has."""
    count = 0
    for side in range(2):
        if not free[side]:
            count = sole_kernel(body, feet[side], points, count)
    return hull_kernel(points, count, corners)


@kernel
def into_kernel(corners, count, p):
    """Bring a point (2,) into a hull by the shortest way."""
    if margin_kernel(corners, count, p[0], p[1]) >= 0.0:
        return
    nearest, x, z = math.inf, p[0], p[1]
    for i in range(count):
        k = i + 1 if i + 1 < count else 0
        ex, ez = corners[k, 0] - corners[i, 0], corners[k, 1] - corners[i, 1]
        px, pz = p[0] - corners[i, 0], p[1] - corners[i, 1]
        square = ex * ex + ez * ez
        part = min(max((px * ex + pz * ez) / square, 0.0), 1.0) if square > 0.0 else 0.0
        far = math.hypot(px - part * ex, pz - part * ez)
        if far < nearest:
            nearest, x, z = far, corners[i, 0] + part * ex, corners[i, 1] + part * ez
    p[0], p[1] = x, z


@kernel
def sway_kernel(x, v, p, goal, corners, count, rate, dt):
    """Lead mass centre, velocity and pressure (2,) on by dt: the pendulum exactly, its pressure evenly to where it leads the capture point to `goal` (2,). No corners: in the air."""
    wanted, follows = np.empty(2), 1.0 - math.exp(-dt / LAGS)
    for i in range(2):
        point = x[i] + v[i] / rate
        wanted[i] = point + TRACKS / rate * (point - goal[i])
    if count > 0:
        into_kernel(corners, count, wanted)
    for i in range(2):
        p[i] = p[i] + follows * (wanted[i] - p[i])
    if count > 0:
        into_kernel(corners, count, p)
    c, s = math.cosh(rate * dt), math.sinh(rate * dt)
    for i in range(2):
        if count == 0:
            p[i] = x[i] + v[i] * dt
            x[i] = p[i]
            continue
        off = x[i] - p[i]
        x[i], v[i] = p[i] + c * off + s / rate * v[i], rate * s * off + c * v[i]


@kernel
def aim_kernel(body, side, feet, x, v, p, rate, time, heading, wish, target, points, corners):
    """Write where a foot that lands in `time` [s] is set down (3,): where the capture point will be then, a little beyond, as far as legs reach and on its own side."""
    there, moves, press, goal, free = x.copy(), v.copy(), p.copy(), np.empty(2), np.zeros(2, np.bool_)
    free[side] = True
    middle_kernel(body, feet[1 - side], goal)
    count = support_kernel(body, feet, free, points, corners)
    for _ in range(max(int(round(time * RATE)), 1)):
        sway_kernel(there, moves, press, goal, corners, count, rate, 1.0 / RATE)
    pace = math.hypot(wish[0], wish[1])
    c, s = math.cos(heading), math.sin(heading)
    px, pz = moves[0] / rate, moves[1] / rate  # from the mass centre to its capture point
    far = math.hypot(px, pz)
    more = BEYOND * body.size / max(far, 0.05) if pace == 0.0 else 0.0
    back = 0.5 / (math.exp(0.5 * rate) - 1.0)  # who walks on sets his feet down this short of it, for each m/s
    px, pz = px * (1.0 + more) - back * wish[0], pz * (1.0 + more) - back * wish[1]
    ahead, left = s * px + c * pz, c * px - s * pz
    size = body.size
    over = math.hypot(ahead / (REACH[0] if ahead > 0.0 else REACH[1]), left / REACH[2]) / size
    if over > 1.0:
        ahead, left = ahead / over, left / over
    # on its own side of the other, as this is seen from the body
    ox, oz = feet[1 - side, 0] - there[0], feet[1 - side, 1] - there[1]
    own = 1.0 - 2.0 * side
    other = c * ox - s * oz
    if own * (left - other) < (OWN + HALF_SOLE) * size:
        left = other + own * (OWN + HALF_SOLE) * size
    elif abs(left) < 0.3 * abs(ahead):  # straight on: a little to its side, as one walks
        left = left if own * (left - other) > 0.6 * APART * size else other + own * 0.6 * APART * size
    yaw = heading + 0.08 * own
    along = 0.5 * (body.heel[2] - body.toe[2] + body.tip[2])
    target[0] = there[0] + c * left + s * ahead - along * math.sin(yaw)
    target[1] = there[1] - s * left + c * ahead - along * math.cos(yaw)
    target[2] = yaw


@kernel
def far_kernel(foot, x, heading, own, wishes, size):
    """How far a mass centre (2,) is off a foot (3,), over how far it may be. own: 1 of a left one, −1 of a right one. wishes: whether it walks on: then a foot behind leaves in time."""
    c, s = math.cos(heading), math.sin(heading)
    ahead, left = s * (x[0] - foot[0]) + c * (x[1] - foot[1]), c * (x[0] - foot[0]) - s * (x[1] - foot[1]) + own * HIP * size
    return math.hypot(0.0 if wishes else ahead / (FAR[0] if ahead > 0.0 else FAR[1]), left / FAR[2]) / size


@kernel
def walks_kernel(v, heading, size):
    """Whether a body goes with a velocity (2,) with which one walks."""
    c, s, scale = math.cos(heading), math.sin(heading), math.sqrt(size)
    return WALKS[0] * scale < s * v[0] + c * v[1] < WALKS[1] * scale and abs(c * v[0] - s * v[1]) < WALKS[2] * scale


@kernel
def home_kernel(body, side, feet, heading, target):
    """Write where a foot rests (3,) beside the other; how far it is from there [m]."""
    own = 1.0 - 2.0 * side
    c, s = math.cos(heading), math.sin(heading)
    target[0] = feet[1 - side, 0] + own * APART * body.size * c
    target[1] = feet[1 - side, 1] - own * APART * body.size * s
    target[2] = heading + 0.08 * own
    return math.hypot(target[0] - feet[side, 0], target[1] - feet[side, 1])


@kernel
def which_kernel(feet, point, heading):
    """The foot that steps: to the side that the capture point (2,) goes to, else the one that is farther behind; the right one of two alike."""
    mx, mz = 0.5 * (feet[0, 0] + feet[1, 0]), 0.5 * (feet[0, 1] + feet[1, 1])
    x, z = point[0] - mx, point[1] - mz
    c, s = math.cos(heading), math.sin(heading)
    ahead, left = s * x + c * z, c * x - s * z
    if abs(left) > 0.6 * abs(ahead):
        return 0 if left > 0.0 else 1
    behind = (feet[0, 0] - feet[1, 0]) * x + (feet[0, 1] - feet[1, 1]) * z
    return 0 if behind < -0.03 * math.hypot(x, z) else 1


@kernel
def way_kernel(centre, velocity, feet, free, heading, rate, wish, body, centres, velocities, pressures, steps):
    """See `way`. Returns how many moments and steps, the fate, and the steps that caught it."""
    x, v, p, goal, point = centre.copy(), velocity.copy(), centre.copy(), np.empty(2), np.empty(2)
    points, corners, target, other = np.empty((8, 2)), np.empty((9, 2)), np.empty(3), np.empty(2)
    swing, lands, lifts, taken, caught, fate, closing = -1, 0.0, -1.0, 0, 0, SWAYS, False
    landed, last, dt, calm, side = 0.0, 0, 1.0 / RATE, 0.0, -1
    stance = 0 if math.hypot(feet[0, 0] - x[0], feet[0, 1] - x[1]) < math.hypot(feet[1, 0] - x[0], feet[1, 1] - x[1]) else 1
    haste = max(1.0 - HASTE[1] * max(math.hypot(velocity[0], velocity[1]) - HASTE[0], 0.0), HASTE[2])
    first, wishes, ends = not (free[0] or free[1]), wish[0] != 0.0 or wish[1] != 0.0, math.inf
    count = support_kernel(body, feet, free, points, corners)
    if count > 0:
        into_kernel(corners, count, p)
    for n in range(len(centres)):
        now = n * dt
        centres[n], velocities[n], pressures[n] = x, v, p
        for i in range(2):
            point[i] = x[i] + v[i] / rate
        count = support_kernel(body, feet, free, points, corners)
        if swing >= 0:
            if now >= lands - 0.5 * dt:  # it lands
                feet[swing] = target
                free[swing] = False
                if not closing:
                    caught += 1
                last, stance, swing, landed = swing, swing, -1, now
                count = support_kernel(body, feet, free, points, corners)
                behind = not free[1 - last] and far_kernel(feet[1 - last], x, heading, 2.0 * last - 1.0, wishes, body.size) > 1.0
                if margin_kernel(corners, count, point[0], point[1]) < -LOST * body.size or caught > MOST or behind:
                    return n + 1, taken, FALLS, caught
                if not closing and wishes and walks_kernel(v, heading, body.size):
                    ends = now + GOES_ON
        if now > ends:
            return n + 1, taken, fate, caught
        if swing >= 0:
            pass
        elif (free[0] or free[1]) and ends == math.inf:  # struck in the middle of a step: the foot in the air goes on to where it is needed
            side = 0 if free[0] and not free[1] else 1
            if free[0] and free[1]:
                side = 0 if (feet[0, 0] - feet[1, 0]) * v[0] + (feet[0, 1] - feet[1, 1]) * v[1] > 0.0 else 1
            swift = STRIDE * body.size / max(math.hypot(v[0], v[1]), 0.1)
            swing, lands, closing = side, now + max(min(haste * SWINGS, swift), SOONEST), False
            aim_kernel(body, swing, feet, x, v, p, rate, lands - now, heading, wish, target, points, corners)
            steps[taken, 0], steps[taken, 1], steps[taken, 2] = swing, now, lands
            steps[taken, 3:6] = target
            taken += 1
            fate = STEPS
            count = support_kernel(body, feet, free, points, corners)
        if swing < 0 and not (free[0] or free[1]) and ends == math.inf:
            inside = margin_kernel(corners, count, point[0], point[1])
            moves = math.hypot(v[0], v[1])
            if inside < 0.0:  # it has to step
                if lifts < 0.0:
                    lifts = haste * REACTS if first and taken == 0 else now + STANDS_BOTH
                if now >= lifts - 0.5 * dt:
                    swing = which_kernel(feet, point, heading) if taken == 0 else 1 - last
                    long = haste * SWINGS if taken == 0 else AGAIN
                    lands, closing, fate, lifts = now + long, False, STEPS, -1.0
                    aim_kernel(body, swing, feet, x, v, p, rate, long, heading, wish, target, points, corners)
            elif inside >= 0.0:
                lifts = -1.0
                if home_kernel(body, 1 - stance, feet, heading, target) > HOME * body.size:
                    middle_kernel(body, feet[stance], goal)
                    near = math.hypot(point[0] - goal[0], point[1] - goal[1])
                    if moves < SLOW and near < 0.05 * body.size and now > landed + 0.1:
                        swing, closing = 1 - stance, True
                        lands = now + CLOSES
                        home_kernel(body, swing, feet, heading, target)
                else:
                    near = math.hypot(point[0] - goal[0], point[1] - goal[1])
                    if near < NEAR and moves < 0.03:
                        calm += dt
                        if calm > 0.25 and now > SHOWN:
                            return n + 1, taken, fate, caught
            if swing >= 0:
                steps[taken, 0], steps[taken, 1], steps[taken, 2] = swing, now, lands
                steps[taken, 3:6] = target
                taken += 1
                free[swing] = True
                count = support_kernel(body, feet, free, points, corners)
                if taken >= len(steps):
                    return n + 1, taken, FALLS, caught
        middle_kernel(body, feet[0], goal)
        middle_kernel(body, feet[1], other)
        if swing >= 0:
            middle_kernel(body, feet[1 - swing], goal)
        elif home_kernel(body, 1 - stance, feet, heading, target) > HOME * body.size:
            middle_kernel(body, feet[stance], goal)
        else:
            goal[0], goal[1] = 0.5 * (goal[0] + other[0]), 0.5 * (goal[1] + other[1])
        sway_kernel(x, v, p, goal, corners, count, rate, dt)
    return len(centres), taken, fate, caught
