"""Turning from rest: two steps with a pivot, as recorded people take them, into a walk another way or on the spot.

Who stands and is told which way he will face in the end (`Intent.towards`) turns there in two steps of a primitive of their
own (`turning_step_build`): shoulders first, then the foot of that side, set down turned most of the way, then the other one.
It has the gait's phase and ends in it, walking or with both feet together; who is told otherwise meanwhile leaves it at once.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..compiled import kernel
from .cycles import EVENTS
from .first_stride import shift_left
from .kernel import COLUMNS, DURATION_AT, HIPS_AT, LABELS_AT, LANES, series_kernel
from .library import Library
from .minimum_jerk import smooth
from .root_motion import SHORTEST, advance, short_way
from .spline import spline_kernel

WALKS, SPOT = 0, 1
"""Kinds of turns: into a walk, and on the spot."""
BEFORE, END = 0.12, 0.92
"""A turn begins this long before its first toe-off and ends this long after it, in phase: its second foot is down."""
WAITING, PER_CYCLE = 4, 24
"""Spline coefficients before the first toe-off, and for each cycle after it."""
WAY_AT = COLUMNS
"""After a row's own columns stand v_f [m/s], how far the ground frame has turned [rad], v_l [m/s]."""
STRIKE = float(EVENTS["walk"][3])
"""The second foot comes down this long after the first left, in phase."""
TEMPO = 1.35, 1.0
"""So many times as fast as the recorded people, who were in no hurry, into a walk and on the spot."""
QUICKEST, LONGEST = (SHORTEST, 0.6), 2.4
"""A phase lasts no shorter, into a walk and on the spot, and no longer than this [s]: as a foot leaves it is told by few frames, and some of those
people stood between their steps."""
SHIFTS, HASTE = (0.65, 0.25), (2.6, 1.0)
"""Recorded people turn their shoulders and shift their weight for this long [s] before their first foot leaves; that begins so many times as fast."""
FROM, FARTHEST = (0.9, 0.6), (4.0, 2.0)
"""Smaller turns than the first [rad] are walked and stepped as the gait has them, into a walk and on the spot; larger ones than the second
are made in two."""
GOES, STANDS = 0.25, 0.05
"""Who will be faster than the first [m/s] turns into a walk, who will be no faster than the second on the spot."""
OTHERWISE = 0.6
"""Who is told to face another way than that by more than this [rad] leaves a turn."""
AFRESH = 0.9, 3.7
"""… or, as no foot has left yet, turns as far as he is told now, if that is more than the first and less than the second [rad] to the same side: a leg that was drawn up for a turn
and let go again within a few frames fluttered."""
THERE, STAYS = 0.02, 0.05
"""Who turns on the spot does so until he is this near [rad] to the way that he is to face; who stands this near stays."""
ENTRY, LEAVING = 0.1, 0.16
"""The half-lives [s] of what is left of the pose before a turn, and of a turn after it."""
GLIDES = 0.12
"""What somebody who walked until a turn is faster than it goes with this half-life [s]."""
RUNS, SECOND, RUNS_ON = (1.3, 2.5), (0.42, 0.6), 0.3
"""Who is to be faster than the first of these [m/s], altogether from the second on, takes the second step of a turn, from and until so long after its first toe-off in
phase, by this share faster."""
STRETCHES, STRETCHED = (0.3, 1.25, 1.08), 0.38
"""Recorded people set off at 1.1 m/s. Whoever is to go slower takes strides that are so many times as long at least, from the first on; whoever is to go faster
longer ones in his second, so many times at most into a walk and into a run. Strides come to be as long within so much phase."""
SMALLEST = 0.0, 1.3
"""Smaller turns than this [rad] are such ones, whose way is turned less: no smaller ones were recorded."""
FOLLOWS = 0.04
"""On the spot shoulders turn by this share of it once both feet stand."""
SHIFTED = 0.6
"""On the spot the body goes back to where it stood until so long after its first foot left, in phase."""
LEAVES = 0.03
"""From so long before its first foot leaves until so long after that [s] phase comes to run ten times as fast: at once, feet were thrown at 2 m/s within a step."""
MOMENT = 0.004
"""How fast a turn begins is told over this long in phase."""
AROUND = (0.05, 0.12)
"""Splines are told evenly in phase, but phase runs five times as fast from the first toe-off on: from so long before it until so long after it
shoulders turn on by the smoothest way in time that there is."""
PIECES = 8
"""The way ahead is followed in so many pieces."""


class Turning(NamedTuple):
    """What the step must know: spline coefficients (2, 2, F, K, COLUMNS + 3): into a walk, on the spot; left or right foot first;
    by each of `features`."""

    coefficients: np.ndarray


def features(turn: ArrayLike) -> np.ndarray:
    """What a turn's coefficients are told over (..., F), of how far it turns (...) [rad]."""
    turn = np.asarray(turn, float)
    return np.stack([np.ones_like(turn), turn, turn * turn], -1)


def turning(library: Library) -> Turning:
    """The kernel's view of a library's turns; no coefficients where it has none."""
    if library.turn is None:
        return Turning(np.zeros((2, 2, 3, 0, COLUMNS + 3), np.float32))
    given = library.turn.coefficients
    joints = len(library.skeleton)
    table = np.zeros(given.shape[:-1] + (COLUMNS + 3,), np.float32)
    for axis in range(3):
        table[..., axis * LANES:axis * LANES + joints] = given[..., axis:3 * joints:3]
    table[..., HIPS_AT:] = given[..., 3 * joints:]
    return Turning(table)


@kernel
def begin_turn(m, turns, wish, row):
    """Begin a turn where somebody who stands is to face another way, and leave one where he is told otherwise; what is left of
    the pose before fades. wish: (3,), of which he who faces that way already turns no more. row: (COLUMNS,) scratch."""
    if turns.coefficients.shape[3] == 0:
        return
    if m.heads and (m.settled or m.waits) and m.towards[1] < STANDS and abs(short_way(m.towards[0] - m.ground[2])) < (STAYS if m.settled else THERE):
        wish[1] = 0.0
    if m.turn != 0.0:
        other = short_way(m.towards[0] - m.turns_to)
        stays, afresh = m.heads and not (m.towards[1] > STANDS if m.spot else m.towards[1] < STANDS), 0.0
        if not m.spot and m.turned < 0.0:
            afresh = short_way(m.towards[0] - m.ground[2])
            afresh += 2.0 * math.pi * (1.0 if m.turn > 0.0 else -1.0) * (afresh * m.turn < 0.0)
        if stays and abs(other) > OTHERWISE and AFRESH[0] < abs(afresh) < AFRESH[1]:
            enter_turn(m, turns, afresh, m.turned, row)
        elif not stays or abs(other) > OTHERWISE:
            leave_turn(m)
        return
    if not m.heads or not (m.settled or m.waits or shift_left(m) > 0.0):
        return
    m.spot = 1 if m.towards[1] < STANDS else 0
    turn = short_way(m.towards[0] - m.ground[2])
    if abs(turn) < FROM[m.spot] or not m.spot and (m.towards[1] < GOES or m.stairs > 0.0):
        return
    if abs(turn) > FARTHEST[m.spot]:
        turn *= 0.5
    enter_turn(m, turns, turn, -BEFORE, row)


@kernel
def enter_turn(m, turns, turn, since, row):
    """Begin to turn that far [rad], so long after the first toe-off in phase, which is negative. row: (COLUMNS,) scratch."""
    m.turns_to = m.towards[0]
    m.turn_ends = m.ground[2] + turn
    m.turn, m.turned, m.first = turn, since, 0 if turn > 0.0 else 1
    m.turn_gain, m.turn_goes, m.turn_stretch = 1.0, m.towards[1], 1.0
    m.turn_haste = 0.0 if m.spot else smooth((m.towards[1] - RUNS[0]) / (RUNS[1] - RUNS[0]))
    m.stray[0] = m.stray[1] = m.glide[0] = m.glide[1] = 0.0
    whole = way_kernel(m, turns, STRIKE if m.spot else END) - way_kernel(m, turns, since)
    m.turn_gain = (1.0 - FOLLOWS * m.spot) * turn / whole
    if m.spot:
        ends = np.empty(3)
        turn_ahead(m, turns, 1.0, BEFORE + STRIKE, ends)
        m.stray[0], m.stray[1] = m.ground[0] - ends[0], m.ground[1] - ends[1]
    m.phase = (1.0 if m.first == 0 else 0.5) + since
    walked = not (m.settled or m.waits or shift_left(m) > 0.0)
    m.settled, m.waits, m.onset = 0, 0, 0.0
    m.stop = BEFORE + STRIKE if m.spot else 0.0
    _begin_smoothly(m, turns, since, walked, row)
    m.row[DURATION_AT] = row[DURATION_AT]
    m.fade = ENTRY


@kernel
def _begin_smoothly(m, turns, since, walked, row):
    """Write a turn's first row (COLUMNS,) and remember how the pose is off it, and moves against it and its ground frame, which sets off at once:
    of somebody who walked that glides on."""
    later = MOMENT * turn_time(m, turns, since)
    turned_row(m, turns, MOMENT + since, row)
    for d in range(LABELS_AT):
        m.blend_rate[d] = m.row_rate[d] - row[d] / later
    turned_row(m, turns, since, row)
    for d in range(LABELS_AT):
        m.blend[d] = m.row[d] - row[d]
        m.blend_rate[d] += row[d] / later
    pace = _tempo(m, since)
    aside, ahead = m.velocity[2] - pace * turn_kernel(m, turns, WAY_AT + 2, since), m.velocity[0] - pace * turn_kernel(m, turns, WAY_AT, since)
    if walked:
        c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
        m.glide[0], m.glide[1] = c * aside + s * ahead, c * ahead - s * aside
    else:
        m.blend_rate[HIPS_AT] += aside
        m.blend_rate[HIPS_AT + 2] += ahead
    turned = way_kernel(m, turns, MOMENT + since) - way_kernel(m, turns, since)
    m.blend_rate[LANES] += m.velocity[1] - turned / later


@kernel
def leave_turn(m):
    """Go on with the gait, from the pose as it is."""
    m.turn, m.left_turn = 0.0, 1
    m.stop *= m.waits


@kernel
def end_turn(m, step):
    """Leave a turn that is over: its second foot is down, and another step in phase would lead beyond it. Cut short, it stood still for what was left of its time."""
    if m.waits or m.turned + step > END:
        leave_turn(m)
        m.waits = m.spot


@kernel
def after_turn(m, table, row, dt):
    """What is left of a turn that has just been left, beside the gait's row (COLUMNS,) of now, which goes on by itself, fades. How fast the
    gait goes, its weights with it, is foretold in the first step, and seen in the second."""
    if m.left_turn >= 2:  # what was seen goes on: after a turn, or as a gait comes to stand or goes again (3, then 2)
        m.left_turn = 2 * (m.left_turn - 2)
        for d in range(LABELS_AT):
            m.blend_rate[d] = m.row_rate[d] - (row[d] - (m.row[d] - m.blend[d])) / dt
        return
    m.left_turn = 2
    m.fade = LEAVING
    later = np.empty(row.shape[0], np.float32)
    ahead = 0.0 if m.waits else dt / max(row[DURATION_AT], SHORTEST)
    series_kernel(table, m.weights, (m.phase + ahead) % 1.0, later)
    for d in range(LABELS_AT):
        by_itself = later[d] - row[d]
        m.blend[d], m.blend_rate[d] = m.row[d] - row[d] + by_itself, m.row_rate[d] - by_itself / dt


@kernel
def turn_kernel(m, turns, d, since):
    """Column d of a character's turn, that long after its first toe-off in phase."""
    at = WAITING + since * PER_CYCLE if since > 0.0 else WAITING * max(1.0 + since / BEFORE, 0.0)
    size = max(abs(m.turn), SMALLEST[m.spot])
    table = turns.coefficients[m.spot, m.first]
    value = (spline_kernel(table[0], d, at)[0] + size * spline_kernel(table[1], d, at)[0]
             + size * size * spline_kernel(table[2], d, at)[0])
    return value * m.turn_gain if d == WAY_AT + 1 else value


@kernel
def way_kernel(m, turns, since):
    """How far a character's ground frame has turned [rad], that long after its first toe-off in phase."""
    before, after = -AROUND[0], AROUND[1]
    if not before < since < after:
        return turn_kernel(m, turns, WAY_AT + 1, since)
    begins, ends = _time_since(m, turns, before), _time_since(m, turns, after)
    whole = ends - begins
    t = (_time_since(m, turns, since) - begins) / whole
    a, b = turn_kernel(m, turns, WAY_AT + 1, before), turn_kernel(m, turns, WAY_AT + 1, after)
    u = (a - turn_kernel(m, turns, WAY_AT + 1, before - MOMENT)) * whole / (MOMENT * turn_time(m, turns, before))
    v = (turn_kernel(m, turns, WAY_AT + 1, after + MOMENT) - b) * whole / (MOMENT * turn_time(m, turns, after))
    return a + t * (u + t * (3.0 * (b - a) - 2.0 * u - v + t * (2.0 * (a - b) + u + v)))


@kernel
def _time_since(m, turns, since):
    """How long after its first toe-off a turn is there in phase [s]; negative before it. By the rule of Simpson, and exactly where its pace changes evenly in time."""
    slow, fast = _paces(m, turns)
    at = min(max(since, -LEAVES * slow), LEAVES * fast)
    time = 2.0 * at / (_leaving(slow, fast, at) + _leaving(slow, fast, 0.0)) * turn_time(m, turns, 0.5 * at) * _leaving(slow, fast, 0.5 * at)
    return time + (since - at) * (turn_time(m, turns, at) + 4.0 * turn_time(m, turns, 0.5 * (at + since)) + turn_time(m, turns, since)) / 6.0


@kernel
def turned_row(m, turns, since, row):
    """Write the row (COLUMNS,) that a character's turn has that long after its first toe-off in phase."""
    for d in range(COLUMNS):
        row[d] = turn_kernel(m, turns, d, since)
    row[DURATION_AT] = turn_time(m, turns, since)
    share = _stretched(m, since)
    if share < 1.0:  # legs that reach less far ahead and behind carry hips higher: up to as high as he stood
        row[HIPS_AT + 1] += (1.0 - share * share) * max(turn_kernel(m, turns, HIPS_AT + 1, -BEFORE) - row[HIPS_AT + 1], 0.0)


@kernel
def turn_time(m, turns, since):
    """How long a phase lasts there, at the usual agility [s]: as its first foot leaves it comes to run as fast as after that evenly in time."""
    slow, fast = _paces(m, turns)
    whole = _tempo(m, 0.0) / (slow if since < 0.0 else fast) if since <= 0.0 else _recorded(m, turns, since)
    at = min(max(since, -LEAVES * slow), LEAVES * fast)
    return whole * (slow if since < 0.0 else fast) / (_leaving(slow, fast, at) * _tempo(m, since))


@kernel
def _paces(m, turns):
    """How fast phase runs just before the first toe-off and after it [1/s]."""
    return _tempo(m, 0.0) * BEFORE / SHIFTS[m.spot], _tempo(m, 0.0) / _recorded(m, turns, 0.0)


@kernel
def _leaving(slow, fast, at):
    """How fast phase runs that goes over evenly in time from a slow pace to a fast one, at a phase from −LEAVES slow to LEAVES fast [1/s]."""
    return math.sqrt(max(slow * slow + (fast - slow) * (at / LEAVES + slow), 0.0))


@kernel
def _recorded(m, turns, since):
    """How long a phase of recorded people lasts there, from the first toe-off on [s]."""
    return min(max(turn_kernel(m, turns, DURATION_AT, since), QUICKEST[m.spot]), LONGEST)


@kernel
def lead_turn(m, turns, agility, dt):
    """How far a turn runs on in phase in dt; command and velocity become those of its ground frame meanwhile."""
    m.turn_stretch = _stretch(m, turns, agility)
    half = 0.5 * dt * agility / turn_time(m, turns, m.turned)
    step = dt * agility / turn_time(m, turns, m.turned + half)
    turned = way_kernel(m, turns, m.turned + step) - way_kernel(m, turns, m.turned)
    pace, fades = _pace(m, agility, m.turned + 0.5 * step), 2.0 ** (-0.5 * dt / GLIDES)
    m.glide[0], m.glide[1] = fades * m.glide[0], fades * m.glide[1]
    c, s = math.cos(m.ground[2] + 0.5 * turned), math.sin(m.ground[2] + 0.5 * turned)
    glides = s * m.glide[0] + c * m.glide[1], 0.0, c * m.glide[0] - s * m.glide[1]
    for i in range(3):
        before = m.command[i]
        m.command[i] = turned / dt if i == 1 else pace * turn_kernel(m, turns, WAY_AT + i, m.turned + 0.5 * step) + glides[i]
        m.velocity[i], m.rate[i], m.asked[i] = m.command[i], (m.command[i] - before) / dt, m.command[i]
    m.glide[0], m.glide[1] = fades * m.glide[0], fades * m.glide[1]
    _back(m, m.ground, m.turned, m.turned + step)
    m.turned += step
    return step


@kernel
def _back(m, ground, since, until):
    """Lead a ground frame (3,) by what a turn on the spot goes back by between two phases."""
    share = smooth(until / SHIFTED) - smooth(since / SHIFTED)
    ground[0] += share * m.stray[0]
    ground[1] += share * m.stray[1]


@kernel
def turn_ahead(m, turns, agility, later, ground):
    """Where the ground frame (3,) will be once a turn has run on by `later` in phase, and how long that takes [s]."""
    whole, step = 0.0, later / PIECES
    for i in range(3):
        ground[i] = m.ground[i]
    for k in range(PIECES):
        since = m.turned + k * step
        time = step * turn_time(m, turns, since + 0.5 * step) / agility
        pace = _pace(m, agility, since + 0.5 * step)
        omega = (way_kernel(m, turns, since + step) - way_kernel(m, turns, since)) / max(time, 1e-6)
        advance(ground, pace * turn_kernel(m, turns, WAY_AT, since + 0.5 * step), omega, pace * turn_kernel(m, turns, WAY_AT + 2, since + 0.5 * step), time)
        _back(m, ground, since, since + step)
        whole += time
    far = (1.0 - 2.0 ** (-whole / GLIDES)) * GLIDES / math.log(2.0)
    ground[0], ground[1] = ground[0] + far * m.glide[0], ground[1] + far * m.glide[1]
    return whole


@kernel
def _pace(m, agility, since):
    """How many times as fast as recorded a turn's ground frame goes there."""
    return agility * _tempo(m, since) * _stretched(m, since)


@kernel
def _stretch(m, turns, agility):
    """How many times as long as recorded a turn's strides come to be, for the speed that is asked for."""
    if m.spot:
        return 1.0
    ends = agility * _tempo(m, END) * math.hypot(turn_kernel(m, turns, WAY_AT, END), turn_kernel(m, turns, WAY_AT + 2, END))
    return min(max(m.turn_goes / ends, STRETCHES[0]), STRETCHES[1] + (STRETCHES[2] - STRETCHES[1]) * m.turn_haste)


@kernel
def _stretched(m, since):
    """How many times as long as recorded they are there."""
    begins = SECOND[0] if m.turn_stretch > 1.0 else 0.0
    return 1.0 + (m.turn_stretch - 1.0) * smooth((since - begins) / STRETCHED)


@kernel
def _tempo(m, since):
    """How many times as fast as recorded a turn is there: at first, while weight shifts, and in the second step of somebody who goes over into a run."""
    pace = TEMPO[m.spot] + (HASTE[m.spot] - TEMPO[m.spot]) * (1.0 - smooth(1.0 + since / BEFORE))
    return pace * (1.0 + RUNS_ON * m.turn_haste * smooth((since - SECOND[0]) / (SECOND[1] - SECOND[0])))
