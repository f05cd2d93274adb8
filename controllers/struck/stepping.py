"""Which foot steps, and where it is set down: where the capture point will be as it lands, as far as legs reach and the ground carries."""

from __future__ import annotations

import math

import numpy as np

from ..body import HALF_SOLE, margin_kernel
from ..compiled import kernel
from .passing import PACES, length_kernel
from .swaying import RATE, middle_kernel, support_kernel, sway_kernel
from .surroundings import place_kernel

WALKS = (-0.75, 4.3, 0.55)
"""Who wants to walk does so once he goes between the first two ahead and no faster than the third aside [m/s], at standard height."""
GOES, LEANS = 0.35, 0.35
"""He is on his way who goes faster than the first towards where he wishes [m/s], and walks on from there; who is slower would stand, and be beyond his toes. He first falls ahead over his feet, if
his capture point is no farther that way from his soles than the second [m], at standard height."""
FAR = (0.64, 0.60, 0.50)
"""A mass centre so far ahead of a foot's ball that stands, or behind it, or a hip so far beside it [m], at standard height, when the other lands, was not caught: no leg is
so long."""
HIP = 0.088
"""How far a hip is to its side [m], at standard height."""
REACH = (0.50, 0.42, 0.42)
"""So far from the mass centre a foot is set down [m] at standard height: ahead, behind, aside."""
OWN = 0.06
"""A foot keeps so far to its own side of the other [m], at standard height."""
APART = 0.27
"""How far apart feet are that rest beside each other [m], at standard height."""
CROSSES, NARROWLY, SIDEWAYS = (0.10, 0.22, 0.0), 0.16, 0.6
"""A foot crosses over that belongs so far beyond the other [m]; so far before the other's ball is its own then, or NARROWLY of who swings it as fast as he can [m], at standard height; and it does so first where the capture point is so far
beyond the foot on that side [m]. What is so many times as far aside as ahead is sideways."""
SOONEST, LATER = 0.1, 0.3
"""No foot lands sooner, and none later than the second or its time because it has far to go [s]."""
ROUNDS = 4
"""So often it is looked whether a foot gets there in time."""
BEYOND = 0.05
"""A foot is set down so far beyond the capture point [m], at standard height: its sole brakes."""


@kernel
def short_kernel(rate):
    """Who walks on sets his feet down so short of the capture point [m], for each m/s: as he does with two steps a second."""
    return 0.5 / (math.exp(0.5 * rate) - 1.0)


@kernel
def aim_kernel(things, body, side, feet, x, v, p, rate, time, heading, wish, over, before, target, points, corners):
    """Write where a foot that lands in `time` [s] is set down (4,): where the capture point will be then, a little beyond, as far as legs reach, on its own side or well across, and where ground
    carries it. before: so far before the other [m], at standard height, where it crosses over. Whether that is over an edge, as none is who may not go `over` one."""
    there, moves, press, goal, free = x.copy(), v.copy(), p.copy(), np.empty(2), np.zeros(2, np.bool_)
    free[side] = True
    middle_kernel(body, feet[1 - side], goal)
    count = support_kernel(body, feet, free, points, corners)
    for _ in range(max(int(round(time * RATE)), 1)):
        sway_kernel(things, feet[1 - side, 3], body.size, there, moves, press, goal, corners, count, rate, 1.0 / RATE)
    pace = math.hypot(wish[0], wish[1])
    c, s = math.cos(heading), math.sin(heading)
    px, pz = moves[0] / rate, moves[1] / rate  # from the mass centre to its capture point
    far = math.hypot(px, pz)
    more = BEYOND * body.size / max(far, 0.05) if pace == 0.0 else 0.0
    back = short_kernel(rate)
    px, pz = px * (1.0 + more) - back * wish[0], pz * (1.0 + more) - back * wish[1]
    ahead, left = s * px + c * pz, c * px - s * pz
    size = body.size
    over = math.hypot(ahead / (REACH[0] if ahead > 0.0 else REACH[1]), left / REACH[2]) / size
    if over > 1.0:
        ahead, left = ahead / over, left / over
    along = 0.5 * (body.heel[2] - body.toe[2] + body.tip[2])  # from the ball to the middle of the sole
    # on its own side of the other, as this is seen from the body
    ox, oz = feet[1 - side, 0] - there[0], feet[1 - side, 1] - there[1]
    own = 1.0 - 2.0 * side
    other = c * ox - s * oz
    bx, bz = feet[side, 0] - feet[1 - side, 0], feet[side, 1] - feet[1 - side, 1]
    behind = own * (c * bx - s * bz) < 0.0 and s * bx + c * bz < 0.0  # has crossed there: it does not get before the other on that side
    if own * (left - other) < -CROSSES[0] * size and abs(left) > SIDEWAYS * abs(ahead) and not behind:  # across the other, before it
        ahead = max(ahead, s * ox + c * oz + before * size + along)
    elif own * (left - other) < (OWN + HALF_SOLE) * size:
        left = other + own * (OWN + HALF_SOLE) * size
    elif abs(left) < 0.3 * abs(ahead):  # straight on: a little to its side, as one walks
        left = left if own * (left - other) > 0.6 * APART * size else other + own * 0.6 * APART * size
    yaw = heading + 0.08 * own
    target[0] = there[0] + c * left + s * ahead - along * math.sin(yaw)
    target[1] = there[1] - s * left + c * ahead - along * math.cos(yaw)
    target[2] = yaw
    return place_kernel(things, body, side, feet, heading, over, target)


@kernel
def step_kernel(things, body, side, feet, x, v, p, rate, time, swung, heading, wish, over, pace, target, points, corners):
    """Write where a foot that has swung for `swung` [s] and would land in `time` [s] is set down, see `aim_kernel`, if it swings no faster than `pace` [m/s] in the mean: where it has too far
    to go it lands a little later, and short of that. In how long it lands, and whether that is over an edge."""
    latest, share, before = max(time, LATER), 1.0, CROSSES[1] if pace < PACES[-1] else NARROWLY
    for _ in range(ROUNDS):
        gone = aim_kernel(things, body, side, feet, x, v, p, rate, time, heading, wish, over, before, target, points, corners)
        length = length_kernel(feet[side], target, feet[1 - side], 1.0 - 2.0 * side, heading, body.size)
        needs = length / (pace * math.sqrt(body.size)) - swung
        if needs <= time + 0.5 / RATE:
            return time, gone
        share = (time + swung) / (needs + swung)
        if time >= latest:
            break
        time = min(needs, latest)
    for i in range(2):
        target[i] = feet[side, i] + share * (target[i] - feet[side, i])
    return time, place_kernel(things, body, side, feet, heading, over, target)


@kernel
def soon_kernel(things, body, side, feet, x, v, p, rate, time, heading, points, corners):
    """In how long a foot lands that would in `time` [s]: sooner, where the mass centre gets farther from the other than a leg is long."""
    there, moves, press, goal, free = x.copy(), v.copy(), p.copy(), np.empty(2), np.zeros(2, np.bool_)
    free[side] = True
    middle_kernel(body, feet[1 - side], goal)
    count = support_kernel(body, feet, free, points, corners)
    for n in range(int(round(time * RATE))):
        sway_kernel(things, feet[1 - side, 3], body.size, there, moves, press, goal, corners, count, rate, 1.0 / RATE)
        if n >= SOONEST * RATE and far_kernel(feet[1 - side], there, heading, 2.0 * side - 1.0, False, body.size) > 1.0:
            return (n + 1) / RATE
    return time


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
def goes_kernel(v, wish, size):
    """Whether a body goes with a velocity (2,) towards where it wishes to (2,) [m/s]."""
    return v[0] * wish[0] + v[1] * wish[1] > GOES * math.sqrt(size) * math.hypot(wish[0], wish[1])


@kernel
def leans_kernel(corners, count, point, wish, size):
    """Whether a body that is to walk as it wishes (2,) [m/s] need only fall ahead over its soles for that: its capture point (2,) is over them, or beyond them straight that way."""
    pace = math.hypot(wish[0], wish[1])
    if pace < GOES * math.sqrt(size):
        return False
    for k in range(15):
        back = k / 14.0 * LEANS * size / pace
        if margin_kernel(corners, count, point[0] - back * wish[0], point[1] - back * wish[1]) >= 0.0:
            return True
    return False


@kernel
def ahead_kernel(point, wish, size, goal):
    """Move the place (2,) to which a capture point (2,) is led ahead of it, towards where a body wishes to (2,) [m/s]."""
    pace = math.hypot(wish[0], wish[1])
    more = ((point[0] - goal[0]) * wish[0] + (point[1] - goal[1]) * wish[1]) / pace + LEANS * size
    goal[0], goal[1] = goal[0] + more * wish[0] / pace, goal[1] + more * wish[1] / pace


@kernel
def home_kernel(things, body, side, feet, heading, target):
    """Write where a foot rests (4,) beside the other, if the ground carries it there; how far it is from there [m]."""
    own = 1.0 - 2.0 * side
    c, s = math.cos(heading), math.sin(heading)
    target[0] = feet[1 - side, 0] + own * APART * body.size * c
    target[1] = feet[1 - side, 1] - own * APART * body.size * s
    target[2] = heading + 0.08 * own
    place_kernel(things, body, side, feet, heading, False, target)
    return math.hypot(target[0] - feet[side, 0], target[1] - feet[side, 1])


@kernel
def which_kernel(feet, point, heading):
    """The foot that steps: to the side that the capture point (2,) goes to; the other one across, if that point is beyond the foot there, which bears all the weight then; else the one that is farther behind; the right one of two alike."""
    mx, mz = 0.5 * (feet[0, 0] + feet[1, 0]), 0.5 * (feet[0, 1] + feet[1, 1])
    x, z = point[0] - mx, point[1] - mz
    c, s = math.cos(heading), math.sin(heading)
    ahead, left = s * x + c * z, c * x - s * z
    if abs(left) > SIDEWAYS * abs(ahead):
        near = 0 if left > 0.0 else 1
        beyond = (1.0 - 2.0 * near) * (c * (point[0] - feet[near, 0]) - s * (point[1] - feet[near, 1]))
        return 1 - near if beyond > CROSSES[2] else near
    behind = (feet[0, 0] - feet[1, 0]) * x + (feet[0, 1] - feet[1, 1]) * z
    return 0 if behind < -0.03 * math.hypot(x, z) else 1
