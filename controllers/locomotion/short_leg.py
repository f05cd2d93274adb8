"""Legs that are too short for where their feet stand: the heel rises about the ball, as legs do.

From where a heel lets go until its foot is well into its swing the leg is as long as the blend's, so that its knee bends as
recorded knees do, however far behind the foot was held; before, it is only kept from being straight.
"""

from __future__ import annotations

import math

from ..body import distance_kernel, spring_kernel
from ..compiled import kernel
from .legs import SOFTNESS, soft_reach, tilt_kernel
from .swing import swing_progress

HEEL_RISE = 0.9
"""The most that a heel may rise about the ball to give a leg length [rad] …"""
NEAREST = 0.95
"""… and how far, as a cosine from 1 on, to where the ankle is nearest to its hip."""
STEEPEST, STEEP_SOFTLY = 0.9, 0.1
"""Of that, for a knee to bend as recorded ones do, only what leaves the foot no steeper than the first [rad], within about the second: recorded walkers and runners leave the floor at 1.1 to 1.3, and feet stood on their toes' tips."""
RISE_RATE = 8.0
"""A heel rises for its leg's sake no faster than this [rad/s] …"""
RISE_HALFLIFE = 0.04
"""… and follows what its leg needs with this half-life [s] once its ball is free."""
TAKE_HALFLIFE, LEAVE_HALFLIFE = 0.03, 0.12
"""A ball comes to bear with the first half-life [s], and to bear no more with the second once it has left …"""
LEND_HALFLIFE = 0.035
"""… and a heel that lets go comes with this one to be free to take what its leg lacks, so that its knee bends as the blend's …"""
BENT = 0.006
"""… and so much shorter than straight a leg is then [m], since a knee that leaves from straight must whip."""
EARLIER = 0.15
"""A foot that swings farther than the blend's does straightens its leg over this share of that, so that its knee brakes before it locks."""
STRAINED = (0.35, 0.8)
"""A ball lets go, the more the farther its heel had to rise [rad] between these."""
CROSSES = (0.006, 0.3)
"""A heel that rises too late to give all that its leg lacks gives it over this length, and over no more than that share of what it lacks [m]: as it came to give more than that, its knee was thrown from straight."""
SLACKENS = 12.0
"""A leg that is held straight is let go no faster than this [1/s]: with its ball, which may be free within two frames, its knee would snap by 23° in one."""
TORN, LATE = 0.02, 1.7
"""A foot lets go that its leg is this much too short for [m], once it stood for long enough for its body to have come down
to it: this many times as long as a swing after it left."""


@kernel
def give_way(m, body, foot, hip, reach, sinks, positions, orientations, ankle, dt, work):
    """A leg too short lifts its heel about the ball, as far as the foot stands on it or has just left it; what then is
    missing still, a foot that does not stand comes nearer, once the pelvis is where it will be (`nearer_kernel`). sinks: by how much the
    pelvis is lower than in positions [m]. How much lower than there it must be for the leg's sake [m], how long the leg is [m], and how firmly its foot stands, or has
    just stood."""
    a, grip = hip + 2, m.grip[2 * foot + 1]
    ball, axis, turned = work[0, 0], work[0, 1], work[1]
    for i in range(3):
        axis[i] = orientations[a, i, 0]
        ball[i] = ankle[i]
        for k in range(3):
            ball[i] += orientations[a, i, k] * body.offsets[a + 1, k]
    on = 1.0 if grip > 0.0 else 0.0
    m.bears[foot], m.bears_rate[foot] = spring_kernel(m.bears[foot], m.bears_rate[foot], on, TAKE_HALFLIFE if grip > 0.0
                                                      else LEAVE_HALFLIFE, dt)
    m.lent[foot], m.lent_rate[foot] = spring_kernel(m.lent[foot], m.lent_rate[foot], 1.0 - m.grip[2 * foot], LEND_HALFLIFE, dt)
    bears = min(max(m.bears[foot], 0.0), 1.0)
    free = bears * m.lent[foot] * (1.0 - min(m.onset, 1.0))
    asked, blended = distance_kernel(positions[hip], ankle), distance_kernel(positions[hip], positions[a])
    over = max(asked - blended, 0.0)
    length = soft_reach(asked - free * over, reach - free * BENT, SOFTNESS + EARLIER * (1.0 - max(grip, m.grip[2 * foot])) * over)
    rise = heel_rise_kernel(positions[hip], ball, ankle, axis, length)
    firm = grip * grip * (3.0 - 2.0 * grip)
    let_go = softly_most(rise, max(STEEPEST - _steepness(body, orientations[a], a), 0.0))
    later, rate = spring_kernel(m.rise[foot], m.rise_rate[foot], let_go * bears, RISE_HALFLIFE, dt)
    later = max(later + firm * (min(rise * bears, m.rise[foot] + firm * RISE_RATE * dt) - later), 0.0)
    m.rise[foot], m.rise_rate[foot] = later, rate + firm * ((later - m.rise[foot]) / dt - rate)
    tilt_kernel(orientations[a], axis, m.rise[foot], turned)
    for i in range(3):
        ankle[i] = ball[i]
        for k in range(3):
            orientations[a, i, k] = turned[i, k]
            ankle[i] -= turned[i, k] * body.offsets[a + 1, k]
    distance = distance_kernel(positions[hip], ankle)
    down = ankle[1] - positions[hip, 1]
    lowered = math.sqrt(max(distance * distance + (2.0 * down + sinks) * sinks, 0.0))
    if swing_progress(m, foot) > LATE and lowered > reach + TORN and m.standing[2 * foot + 1] == 1:  # not even on its toes, and the pelvis lowered: let go before it tears
        m.torn[foot] = 1
    for i in range(3):
        turned[0, i] = ankle[i]
    nearer_kernel(positions[hip], turned[0], length, asked, firm, math.inf)  # what does not stand asks less of the pelvis
    m.taut[foot] = taut = max(grip, m.taut[foot] - SLACKENS * dt)
    return lacks_kernel(positions[hip], turned[0], reach), length, taut * taut * (3.0 - 2.0 * taut) * bears * bears * (3.0 - 2.0 * bears), asked


@kernel
def softly_most(x, most):
    """x [rad], but no more than `most`, to which it comes smoothly."""
    return max(x - STEEP_SOFTLY * math.log1p(math.exp((x - most) / STEEP_SOFTLY)), 0.0)


@kernel
def _steepness(body, orientation, a):
    """How steeply a foot (of joint a) stands on its ball [rad]: 0 as it lies flat."""
    down = size = 0.0
    for k in range(3):
        along = body.heel[k] - body.offsets[a + 1, k]
        down += orientation[1, k] * along
        size += along * along
    return math.asin(min(max(down / math.sqrt(size), -1.0), 1.0))


@kernel
def lower_heel(m, body, foot, hip, length, sinks, positions, orientations, ankle, work):
    """Let the heel of a foot that stands down again as far as the pelvis, lowered by `sinks` [m] after the heel had risen for its leg, `length` [m] long, has spared it that:
    with both the knee would snap by 15° in a frame, as the leg comes to be long enough."""
    grip = m.grip[2 * foot + 1]
    if m.rise[foot] <= 0.0 or grip <= 0.0 or sinks <= 0.0:
        return
    a, ball, axis, flat, above, turned = hip + 2, work[0, 0], work[0, 1], work[0, 2], work[2, 0], work[1]
    for i in range(3):
        axis[i] = orientations[a, i, 0]
        above[i] = positions[hip, i] + (sinks if i == 1 else 0.0)
        ball[i] = ankle[i]
        for k in range(3):
            ball[i] += orientations[a, i, k] * body.offsets[a + 1, k]
    tilt_kernel(orientations[a], axis, -m.rise[foot], turned)
    for i in range(3):
        flat[i] = ball[i]
        for k in range(3):
            flat[i] -= turned[i, k] * body.offsets[a + 1, k]
    needed = min(m.rise[foot], heel_rise_kernel(above, ball, flat, axis, length))
    spared = grip * grip * (3.0 - 2.0 * grip) * max(needed - heel_rise_kernel(positions[hip], ball, flat, axis, length), 0.0)
    tilt_kernel(orientations[a], axis, -spared, turned)
    for i in range(3):
        ankle[i] = ball[i]
        for k in range(3):
            orientations[a, i, k] = turned[i, k]
            ankle[i] -= turned[i, k] * body.offsets[a + 1, k]


@kernel
def nearer_kernel(hip, ankle, length, asked, firm, most):
    """An ankle that is farther from its hip than its leg is long comes nearer, as far as its foot does not stand firmly, and to `most` [m] in any case; smoothly where its
    leg was `asked` to be longer [m]."""
    distance = distance_kernel(hip, ankle)
    far = min(distance, most)
    within = min(CROSSES[0], CROSSES[1] * max(asked - length, 0.0))
    far -= (1.0 - firm) * over_kernel(far - length, within)
    if far < distance:
        share = far / distance
        for i in range(3):
            ankle[i] = hip[i] + (ankle[i] - hip[i]) * share


@kernel
def over_kernel(x, within):
    """How far x is over 0, coming to be so evenly as it goes from −within to within."""
    if x <= -within:
        return 0.0
    return x if x >= within else (x + within) ** 2 / (4.0 * within)


@kernel
def lacks_kernel(hip, ankle, reach):
    """How much lower a hip must be for its ankle to be within reach [m]; 1 where no depth is enough."""
    flat = (hip[0] - ankle[0]) ** 2 + (hip[2] - ankle[2]) ** 2
    return hip[1] - ankle[1] - math.sqrt(reach * reach - flat) if flat < reach * reach else 1.0


@kernel
def heel_rise_kernel(hip, ball, ankle, axis, reach):
    """The angle [rad] about the ball and the foot's lateral axis that brings the ankle within reach.

    Zero if it is, or if a rising heel would only lead it away; at most HEEL_RISE, and not quite where it is nearest, which
    it would come to infinitely fast. The square of the distance goes as c + p cos θ + q sin θ.
    """
    x, y, z = ankle[0] - ball[0], ankle[1] - ball[1], ankle[2] - ball[2]
    u, v, w = ball[0] - hip[0], ball[1] - hip[1], ball[2] - hip[2]
    along = axis[0] * x + axis[1] * y + axis[2] * z
    still = (axis[0] * u + axis[1] * v + axis[2] * w) * along
    p = 2.0 * (u * x + v * y + w * z - still)
    q = 2.0 * (u * (axis[1] * z - axis[2] * y) + v * (axis[2] * x - axis[0] * z) + w * (axis[0] * y - axis[1] * x))
    c = u * u + v * v + w * w + x * x + y * y + z * z + 2.0 * still
    if c + p <= reach * reach or q >= 0.0:
        return 0.0
    cosine = max((reach * reach - c) / math.hypot(p, q), -NEAREST)
    return min(max(math.atan2(q, p) + math.acos(min(cosine, 1.0)), 0.0), HEEL_RISE)
