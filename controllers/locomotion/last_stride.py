"""Stopping: a body slows down evenly until its last foot has come down beside the other, as recorded people's do.

Who lets go of the stick while walking chooses the strike at which his feet will be together: the next one by which he
can have slowed down without pushing his hardest. Until then he loses as much speed each moment, so that strides get
shorter by themselves and the last one ends beside the foot that stands; there he glides on a little, and both feet stay.
Who runs brakes first, and chooses as soon as he walks. Who is to come to rest at a place (`halt`) sets his last two feet down there.
"""

from __future__ import annotations

import math

import numpy as np

from ..body import spring_kernel
from ..compiled import kernel
from .before_edges import KEEPS
from .cycles import EVENTS
from .foot_points import shown_kernel
from .kernel import HIPS_AT
from .memory import WALK
from .root_motion import short_way, time_ahead

STRIKE = float(EVENTS["walk"][1])
"""The phase in which the left foot comes down; the right one does half a cycle later."""
LEAST = 0.35
"""Who is slower than this [m/s] just stops."""
HARD = 1.0
"""The share of their strength with which legs brake at most, if there is a strike for it."""
SOONEST, AT_PLACE = 0.42, 0.7
"""The last foot comes down no sooner than the first after the wish has gone, in phase: the other one must have been set down for it; nor than the
second where there is a place to stop at: the other one must get there."""
GLIDE = 0.15
"""A body that comes to rest does so this long after its last foot has come down [s]."""
EVEN, STEEPEST = 1.0, 3.0
"""Speed goes with these powers of the time that is left, while the foot is still on its way that the body will stand on, and at most; at first
with the one that goes on braking as hard as he can."""
BRAKING = 0.5
"""Who brakes by more than this share of his push goes on as hard as he can."""
SHORT, LONGER = 0.7, 0.2
"""He slows down with this power of the time that is left at least where his end is given, and sets a foot down at most so far [m] from where it would come down."""
AT, CROWDED = 0.1, 0.08
"""Who is no farther from his place than this [m] is there; a foot that is kept by more than the second [m] from where it belongs is crowded out by the other."""
NOWHERE, AHEAD, STOPS, CHOSE, STAYS = range(5)
"""Whether there is a place where somebody is to come to rest: none; one ahead; he has let go of his wish for it; he stops at one of his own choice; he has stepped there once more, and stays as his feet come down."""
BEYOND, ON_ITS_WAY = 0.1, 0.5 + STRIKE
"""He stops over a foot that he would be beyond by no more than this [m]; one that is on its way with less than the second left, in phase, is known."""
HALFWAY = 0.5
"""Where the other foot is too near to the middle, the last one goes that share of it farther aside; the body makes up the rest."""
OVER, OFF = 0.18, 0.05
"""It comes over its feet with this half-life [s], and rests no farther from their middle than this [m]."""
BESIDE, DECIDED, FADED = 0.08, 0.9, 0.005
"""Feet that are farther than the first from where they rest [m] step once more, as soon as the blend is at rest by the second, and no offset of the hips larger than the third [m] is left."""
TOWARDS, PAST = 0.9, 0.25
"""Who goes to a place does so at less than the angle with this cosine; one that is this near, but not ahead, has been passed [m]."""
TARRIES, EASY, BRISK = 0.3, 1.5, 2.0
"""Who slows down to the end from the second speed [m/s] steps slower, too: a cycle takes him this share longer; from the third on he still brakes hard."""
LAGS, TURNS_ON = 3.0, 0.6
"""Shoulders that come to rest turn a way that is slowed down evenly by less than they turn, by so many times their own time over its; by no more than the second [rad]."""
AT_ONCE, STILL = 3, 0.12
"""What `after_turn` makes of it; and the half-life [s] with which the last step's movement goes as both feet stand."""
LATEST = 3.0
"""No stop takes longer than this [s]."""
BRAKES = 0.15, 1.5
"""A runner lets go so many seconds of his way before he is as near as braking by this share of his push, twice, would take him."""
ROUND = 0.35
"""Who turned on the spot turns so far [rad] over his feet to the end."""
SPEEDS_UP = 1.25
"""Who is asked for so many times his speed still speeds up."""
NO_WISH = 0.02
"""Wishes smaller than this are none [m/s, rad/s]."""


@kernel
def plan_stop(m, settings, table, stance):
    """Choose the strike that ends a walk, as the phase that is left until it, where somebody who walks has no wish any more, the place
    where he comes to rest, and how steeply he slows down for it. stance: where heels and balls are at rest (4, 2) [m]."""
    if m.settled or m.halts < STOPS and abs(m.asked[0]) + (0.0 if rounds(m) else abs(m.asked[1])) + abs(m.asked[2]) > NO_WISH:
        if m.waits:
            _absorb(m)
        m.stop, m.waits = 0.0, 0
        return
    speed = math.hypot(m.command[0], m.command[2])
    if m.waits:
        return
    if m.stop <= 0.0:
        if m.halts == CHOSE:  # he has stopped, and steps once more: where he is
            m.halt[0], m.halt[1], m.halts = m.ground[0], m.ground[1], STAYS
        if m.family != WALK or speed < LEAST and m.halts < STOPS:
            return
        far = to_halt(m) if m.halts >= STOPS else 0.0
        m.stop = (STRIKE - m.phase) % 0.5
        while not _ends(m, settings, table, m.stop, speed, far, m.halts >= STOPS) or m.halts < STOPS and not _over_foot(m, settings, speed, stance):
            m.stop += 0.5
        if m.halts < STOPS:
            _choose_place(m, speed, settings, table, stance)
    elif m.stop > STRIKE and m.halts != STOPS and speed > HARD * _most(settings) * time_to_stop(m, settings, table):
        m.stop += 0.5  # he can't any more by then, and takes another step
        _choose_place(m, speed, settings, table, stance)
    if m.halts == CHOSE and m.stop > 0.5:  # until the foot is down that he will stand on
        _place(m, settings, math.hypot(m.halt[0] - m.ground[0], m.halt[1] - m.ground[1]), time_to_stop(m, settings, table))
    m.steep = EVEN if speed <= 0.0 else min(max(speed * time_to_stop(m, settings, table) / max(to_halt(m), 0.01) - 1.0, SHORT), STEEPEST)


@kernel
def rounds(m):
    """Whether somebody whose feet wait after a turn only has his shoulders still to turn, over them."""
    return m.waits and m.heads and m.spot and abs(short_way(m.towards[0] - m.ground[2])) < ROUND


@kernel
def _choose_place(m, speed, settings, table, stance):
    """Where somebody comes to rest who stops now: over the foot that he will stand on, if that comes down soon or stands; else as he gets there by
    slowing down evenly, or by braking as hard as he can if he brakes already."""
    time, most = time_to_stop(m, settings, table), _most(settings)
    brakes = -(m.rate[0] * m.command[0] + m.rate[2] * m.command[2]) > BRAKING * most * speed
    steep = min(max(most * time / speed, EVEN), STEEPEST) if brakes else EVEN
    if m.stop < AT_PLACE:
        steep = min(max(speed * time / max(_to_foot(m, speed, stance), 0.01) - 1.0, EVEN), STEEPEST)
    elif m.stop <= ON_ITS_WAY and settings.footing:
        farthest = max(_to_foot(m, speed, stance) + LONGER, 0.5 * speed * speed / most)
        steep = min(max(speed * time / farthest - 1.0, steep), STEEPEST)
    m.halts, far = CHOSE, speed * time / (steep + 1.0)
    _place(m, settings, min(far, max(m.brink - KEEPS, 0.05)) if m.brink > 0.0 else far, time)


@kernel
def _place(m, settings, far, time):
    """Put the place of his own choice so far off [m] where he goes by himself for so long [s], whose shoulders still turn on a little."""
    y = 2.0 * math.log(2.0) / (0.5 * settings.command_halflife / settings.agility)
    turn = (2.0 * m.command[1] + m.rate[1] / y) / y * max(1.0 - LAGS / (y * max(time, 0.1)), 0.0)
    heading, speed = m.ground[2] + min(max(turn, -TURNS_ON), TURNS_ON), max(math.hypot(m.command[0], m.command[2]), 1e-6)
    c, s = math.cos(heading), math.sin(heading)
    m.halt[0] = m.ground[0] + (c * m.command[2] + s * m.command[0]) * far / speed
    m.halt[1] = m.ground[1] + (c * m.command[0] - s * m.command[2]) * far / speed
    m.halt[2] = math.nan


@kernel
def _to_foot(m, speed, stance):
    """How far on somebody is over the foot that he will stand on [m], where it stands or will come down."""
    c, s, point, far = math.cos(m.ground[2]), math.sin(m.ground[2]), np.empty(2), 0.0
    foot = 1 - _last(m)
    for k in range(2):
        shown_kernel(m, 2 * foot + k, point)
        if m.stop > 0.5:  # it is not down yet
            x, z = m.coming[foot, k, 0] - m.ground[0], m.coming[foot, k, 1] - m.ground[1]
            point[0], point[1] = c * x - s * z, s * x + c * z
        far += 0.5 * ((point[1] - stance[2 * foot + k, 1]) * m.command[0] + (point[0] - stance[2 * foot + k, 0]) * m.command[2]) / speed
    return far


@kernel
def _over_foot(m, settings, speed, stance):
    """Whether somebody who stops over the foot that stands, or comes down soon, can brake as soon as that: he would end leaning away from his feet."""
    longer = LONGER if m.stop >= AT_PLACE else 0.0
    return m.stop > ON_ITS_WAY or not settings.footing or 0.5 * speed * speed / _most(settings) <= max(_to_foot(m, speed, stance) + longer, 0.0) + BEYOND


@kernel
def _ends(m, settings, table, left, speed, far, place):
    """Whether a walk may end with the strike `left` ahead in phase: not too soon, not with a harder push than legs have, and `far` enough [m]."""
    time = _time_until(m, settings, table, left) + GLIDE
    return left >= (AT_PLACE if place else SOONEST) and time >= speed / (HARD * _most(settings)) and (0.5 * speed * time >= far or time > LATEST)


@kernel
def lets_go(m, settings, table):
    """Whether somebody who walks is so near to where he is to come to rest that he stops now: by the soonest strike by which an even stop leads there. Who still
    speeds up goes on until that is the first one by which he can stop at all, or he would creep there."""
    speed, far = math.hypot(m.command[0], m.command[2]), to_halt(m)
    if far <= 0.0:  # he turns to it, or is past it
        return math.hypot(m.halt[0] - m.ground[0], m.halt[1] - m.ground[1]) < PAST
    most = _most(settings)
    if m.family != WALK:
        return far <= speed * BRAKES[0] + speed * speed / (BRAKES[1] * most)
    left, soonest = (STRIKE - m.phase) % 0.5, max(_time_until(m, settings, table, AT_PLACE) + GLIDE, speed / (HARD * most))
    speeds_up = math.hypot(m.asked[0], m.asked[2]) > SPEEDS_UP * speed
    for _ in range(8):
        time = _time_until(m, settings, table, left) + GLIDE
        if left >= AT_PLACE and 0.5 * speed * time >= far:
            return time < soonest + _time_until(m, settings, table, 1.0)
        if left >= AT_PLACE and speeds_up:
            return False
        left += 0.5
    return False


@kernel
def quickness(settings):
    """How many times as fast as usual somebody takes the steps of a stop: legs that push so many times as hard need the root of that less time for them."""
    return max(math.sqrt(settings.agility), 1.0)


@kernel
def _time_until(m, settings, table, left):
    """How long it takes until a strike `left` ahead in phase [s], of who steps as one who stops does."""
    slows = min(max((BRISK - math.hypot(m.command[0], m.command[2])) / (BRISK - EASY), 0.0), 1.0)
    return time_ahead(m, table, left) * (1.0 + TARRIES * slows * min(left, 1.0)) * m.quick / quickness(settings)


@kernel
def _most(settings):
    """What legs push [m/s²]."""
    return settings.acceleration * settings.agility


@kernel
def to_halt(m):
    """How far somebody still is from where he is to come to rest [m], 0 where he does not go there, or stays; beside a place of his own choice, how far ahead it is."""
    if m.halts == STAYS:
        return 0.0
    x, z = m.halt[0] - m.ground[0], m.halt[1] - m.ground[1]
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    ahead = (s * x + c * z) * m.command[0] + (c * x - s * z) * m.command[2]
    far = math.hypot(x, z)
    speed = math.hypot(m.command[0], m.command[2])
    if ahead > TOWARDS * far * speed:
        return far
    return max(ahead / speed, 0.0) if m.halts == CHOSE and speed > 0.0 else 0.0


@kernel
def _last(m):
    """Which foot comes down last: 0 the left one, 1 the right one."""
    return 0 if abs((m.phase + m.stop) % 1.0 - STRIKE) < 0.25 else 1


@kernel
def bring_together(m, foot, stance):
    """Lead the foot that comes down last to where it belongs beside the other, into m.land; and that one before, where there is a place
    to stop at, to where it belongs there."""
    other, ball, point = 3 - 2 * foot, 2 * foot + 1, np.empty(2)
    if m.stop <= 0.0 and not m.waits:
        return
    if m.stop <= STRIKE and foot == _last(m):
        shown_kernel(m, other, point)
        c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
        if m.turn != 0.0:  # beside it as the body faces then
            px, pz = m.ground[0] + c * point[0] + s * point[1], m.ground[1] - s * point[0] + c * point[1]
            c, s = math.cos(m.turn_ends), math.sin(m.turn_ends)
            x, z = stance[ball, 0] - stance[other, 0], stance[ball, 1] - stance[other, 1]
            m.land[foot, 0], m.land[foot, 1] = px + c * x + s * z - m.coming[foot, 1, 0], pz - s * x + c * z - m.coming[foot, 1, 1]
            return
        x, z = stance[ball, 0] + HALFWAY * (point[0] - stance[other, 0]), point[1] + stance[ball, 1] - stance[other, 1]
        m.land[foot, 0] = m.ground[0] + c * x + s * z - m.coming[foot, 1, 0]
        m.land[foot, 1] = m.ground[1] - s * x + c * z - m.coming[foot, 1, 1]
    elif m.halts >= STOPS and 0.5 < m.stop <= 0.5 + STRIKE and foot != _last(m):
        heading = m.ground[2] if math.isnan(m.halt[2]) else m.halt[2]
        c, s = math.cos(heading), math.sin(heading)
        place = m.ground if m.halts == STAYS else m.halt
        x = place[0] + c * stance[ball, 0] + s * stance[ball, 1] - m.coming[foot, 1, 0]
        z = place[1] - s * stance[ball, 0] + c * stance[ball, 1] - m.coming[foot, 1, 1]
        share = min(LONGER / max(math.hypot(x, z), 1e-9), 1.0)
        m.land[foot, 0], m.land[foot, 1] = share * x, share * z


@kernel
def step_first(m, foot, aside):
    """Let somebody who turns at his place take another step before he stops, where the foot that he is to stand on can't be set down by `aside` [m] where it belongs: the other one
    stands there."""
    if m.halts == STOPS and 0.5 < m.stop <= 0.5 + STRIKE and foot != _last(m) and aside > CROWDED \
            and math.hypot(m.halt[0] - m.ground[0], m.halt[1] - m.ground[1]) < AT and math.hypot(m.command[0], m.command[2]) < LEAST:
        m.stop += 0.5


@kernel
def time_to_stop(m, settings, table):
    """How long somebody who stops is still on the way [s]; 0 for others."""
    return _time_until(m, settings, table, m.stop) + GLIDE if m.stop > 0.0 else 0.0


@kernel
def come_over(m, stance, most, dt):
    """Lead the command of a body whose feet wait: it glides on to the place where it comes to rest, or as near to it as its feet stand. most: what
    legs push [m/s²]."""
    x, z, point = 0.0, 0.0, np.empty(2)
    for k in range(4):
        shown_kernel(m, k, point)
        x += 0.25 * (stance[k, 0] - point[0])
        z += 0.25 * (stance[k, 1] - point[1])
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    across = s * (m.halt[1] - m.ground[1]) - c * (m.halt[0] - m.ground[0]) - x
    along = -s * (m.halt[0] - m.ground[0]) - c * (m.halt[1] - m.ground[1]) - z
    share = min(OFF / max(math.hypot(across, along), 1e-9), 1.0) if STOPS <= m.halts < STAYS else 0.0
    x, z = x + share * across, z + share * along
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
        faded = not m.spot or not m.left_turn and abs(m.blend[HIPS_AT]) + abs(m.blend[HIPS_AT + 2]) < FADED
        if faded and m.weights[rest] >= DECIDED and math.hypot(x, z) > 2.0 * BESIDE and m.halts < STAYS:
            if m.halts == STOPS and (m.kept[0] or m.kept[1]):
                m.halts = STAYS  # where he is: the ground has no room for both feet there, and he would tread on the spot for good
            m.waits = 0
            _absorb(m)
        return 0.0
    if m.stop <= 0.0:
        return step
    if step < m.stop:
        m.stop -= step
        return step
    step, m.stop, m.waits = m.stop, 0.0, 1
    _absorb(m)
    return step


@kernel
def _absorb(m):
    """Note that the gait stands still from now on, or goes again: how the pose moves goes over into the blend's offset (`after_turn`)."""
    if m.turn == 0.0 and m.left_turn != 1:
        m.left_turn, m.fade = AT_ONCE, STILL
