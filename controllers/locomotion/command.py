"""The command: a wish as legs can take it up, now and in the time to come."""

from __future__ import annotations

import math

import numpy as np

from ..body import spring_kernel
from ..compiled import kernel
from .before_edges import before_edge, runs_off
from .control_space import SCALE
from .kernel import HIPS_AT, clamp_kernel, inner_kernel
from .last_stride import CHOSE, NOWHERE, come_over, plan_stop, quickness, time_to_stop
from .memory import RUN, WALK
from .minimum_jerk import smooth
from .root_motion import advance, briskness, cadence_kernel
from .turning_back import pivots

LEAST_STRETCH, MOST_STRETCH = 0.7, 1.3
"""A gait is slowed down and sped up to these shares of the speeds that were recorded, half of it by its cadence and
half by its strides, so that walks and runs meet between them."""
PUSHES = (1.0, 0.64)
"""The share of their push that legs have on average, since they bear more and less, walking and running."""
LEFT_OVER = 0.4
"""Who pushes round a curve has so much of his push left to speed up or slow down, or more: legs push all together as hard as they can."""
GRAVITY, SPARE = 9.81, 0.15
"""Legs push as hard as they bear, and by so much of a body's weight harder, since soles have some friction to spare."""
BRAKES = 0.25
"""Who slows down from a run does so by this share less of how hard [m/s²] his step brakes him at the moment, and more as it drives him on, up to this share of his push:
his mass centre is slowed evenly. Without it, it was slowed by 8.4 m/s² as he stopped from 3.0 m/s."""
QUICKENS = 0.06
"""Who stops comes to step as fast as he can with this half-life [s]."""
ON_SPOT = 0.5
"""Who is asked to turn and to go slower than this [m/s] …"""
BRAKED, RUNS = 1.3, 2.3
"""… begins to turn between these speeds [m/s]."""
STAGE = 0.7
"""A blend's weights follow those of its command in two stages, each with this share of their half-life: smoothly, or a hand that is held elsewhere in the primitives of the
new way is thrown as a stick is."""
PIECES = 2
"""The way ahead is followed in so many steps before and after the moment whose command the blend will have come to."""


@kernel
def shape_command(m, wish, lean, dt, settings, table, walk, run, stance, p, inner):
    """The wish, brought to what the library holds and smoothed: an exact critically damped spring,
    no faster than legs can push, and as hard only as they bear, so that feet need not slip; before stairs no faster than feet find them. lean: the share of its
    strength with which a body pushes. stance: where heels and balls are at rest (4, 2) [m]."""
    m.wished[0], m.wished[1] = wish[2], wish[0]
    edge = m.brink > 0.0 and (m.halts == NOWHERE or m.halts >= CHOSE)  # who comes to rest at a place was told where
    off = edge and runs_off(m)
    ahead, left = (m.command[0], m.command[2]) if off else (wish[0], wish[2])
    speed = math.hypot(ahead, left)
    share = m.most / speed if 0.0 < m.most < speed else 1.0
    m.wanted = RUN if share * ahead > (settings.run_above if m.wanted == WALK else settings.walk_below) else WALK
    p[0], p[1], p[2] = share * ahead / SCALE[0], wish[1] / SCALE[1], share * left / SCALE[2]
    faster = pivots(m) if m.wanted == WALK else 1.0
    p[1] /= faster
    _within(run if m.wanted == RUN else walk, p, inner, m.wanted)
    p[1] *= faster
    for i in range(3):
        p[i] *= SCALE[i]
    pace = m.pace * briskness(m)  # steps that are as short, and as brisk as they may be
    p[0], p[2] = p[0] * pace, p[2] * pace
    most = settings.acceleration * settings.agility
    round_curve = most / max(math.hypot(p[0], p[2]), math.hypot(m.command[0], m.command[2]), 0.1)
    p[1] = min(max(p[1], -round_curve), round_curve) * _turns(math.hypot(p[0], p[2]), math.hypot(m.command[0], m.command[2]))
    for i in range(3):
        m.asked[i] = p[i]
    push = 1.0
    if not m.settled:  # and not at all while no foot stands
        stands = m.grip[0] + m.grip[1] + m.grip[2] + m.grip[3] > 0.0
        bears, brakes = _load(m, table, dt)
        push = min(max(bears + SPARE, 0.0), 1.0) if stands else 0.0
        if push > 0.0 and m.family == RUN and p[0] < m.command[0] and m.halts == 0:  # who stops at a place brakes as that was planned
            push = min(max(push - BRAKES * brakes / most, 0.0), 1.0 + BRAKES)
    plan_stop(m, settings, table, stance)
    m.quick += ((quickness(settings) if m.stop > 0.0 else 1.0) - m.quick) * (1.0 - 2.0 ** (-dt / QUICKENS))
    if m.waits:
        come_over(m, stance, most, dt)
        push = 0.0
    was = math.hypot(m.command[0], m.command[2])
    _take_up(m.command, m.rate, p, settings, lean, lean * push, PUSHES[m.family], time_to_stop(m, settings, table), m.steep, dt)
    if edge and not off:
        before_edge(m, was, dt)


@kernel
def _turns(asked, speed):
    """How much of a turn somebody makes who is to have a speed [m/s] and has another: none on the spot as long as he runs, since he brakes first."""
    return 1.0 - max(1.0 - asked / ON_SPOT, 0.0) * smooth((speed - BRAKED) / (RUNS - BRAKED))


@kernel
def _take_up(command, rate, asked, settings, turning, push, mean, left, steep, dt):
    """Lead a command (3,) and its rate (3,) towards what is asked (3,): shoulders turn in half the time, and in the air, too.

    mean: the share of their push that legs have on average: who speeds up or comes to rest makes up for it, so that a runner, who pushes
    only while a foot stands, takes that up in the time in which a walker does. left: how long somebody who stops is still on the way [s], 0 for others; steep: with which power of that he slows down.
    """
    most, halflife = settings.acceleration * settings.agility, settings.command_halflife / settings.agility
    before = command[1]
    command[1], rate[1] = spring_kernel(before, rate[1], asked[1], 0.5 * halflife, turning * dt)
    turn = (command[1] - before) / (4.0 * most * dt)
    if abs(turn) > 1.0:
        command[1], rate[1] = before + math.copysign(4.0 * most * dt, turn), math.copysign(4.0 * most, turn)
    if push <= 0.0:
        return
    if asked[0] > command[0] or asked[0] < ON_SPOT:
        halflife *= mean
    round_curve = 0.5 * (abs(before) + abs(command[1])) * math.hypot(command[0], command[2])
    most = math.sqrt(max(most * most - round_curve * round_curve, (LEFT_OVER * most) ** 2))
    forward, forward_rate = spring_kernel(command[0], rate[0], asked[0], halflife, push * dt)
    lateral, lateral_rate = spring_kernel(command[2], rate[2], asked[2], halflife, push * dt)
    forward, lateral = forward - command[0], lateral - command[2]
    if left > 0.0:
        share = 1.0 - max(1.0 - dt / left, 0.0) ** steep
        forward, lateral = -share * command[0], -share * command[2]
        forward_rate, lateral_rate = forward / dt, lateral / dt
    over = math.hypot(forward, lateral) / (most * push * dt)
    if over > 1.0:
        forward, lateral = forward / over, lateral / over
        forward_rate, lateral_rate = forward / (push * dt), lateral / (push * dt)
    command[0] += forward
    command[2] += lateral
    rate[0], rate[2] = forward_rate, lateral_rate


@kernel
def _load(m, table, dt):
    """What legs bear halfway through a step, in body weights, and how hard they brake along the way [m/s²]: from how the blend's hips go."""
    pace = cadence_kernel(m)
    angle = 2.0 * math.pi * (m.phase + 0.5 * dt * pace)
    c1, s1 = math.cos(angle), math.sin(angle)
    total, ahead = 0.0, 0.0
    for p in range(table.shape[0]):
        w = m.weights[p]
        if w <= 0.0:
            continue
        c, s = c1, s1
        for k in range(1, table.shape[1] - 1, 2):
            order = 0.5 * (k + 1)
            total -= w * order * order * (c * table[p, k, HIPS_AT + 1] + s * table[p, k + 1, HIPS_AT + 1])
            ahead -= w * order * order * (c * table[p, k, HIPS_AT + 2] + s * table[p, k + 1, HIPS_AT + 2])
            c, s = c * c1 - s * s1, s * c1 + c * s1
    squared = (2.0 * math.pi * pace) ** 2
    return 1.0 + total * squared / GRAVITY, -ahead * squared


@kernel
def stages(settings, dt):
    """What is left after dt of weights that follow others in a stage, and the share that the followed ones have then after two."""
    x = dt * math.log(2.0) / (STAGE * settings.weight_halflife)
    keep = math.exp(-x)
    return keep, 1.0 - keep * (1.0 + x)


@kernel
def look_ahead(m, settings, table, later, ground, command):
    """Where the ground frame (3,) will be in `later` seconds, and the command (3,) that the blend's weights will have come to by then,
    if the same is asked for all the while."""
    rate, now = np.empty(3), np.empty(3)
    for i in range(3):
        ground[i], now[i], rate[i] = m.ground[i], m.command[i], m.rate[i]
    # the moment whose command weights that follow from now on have come to, if commands change evenly
    lag = STAGE * settings.weight_halflife / math.log(2.0)
    keep, spent = stages(settings, later)
    moment = (later - 2.0 * lag + keep * (2.0 * lag + later)) / spent if spent > 1e-4 else later / 3.0
    left = time_to_stop(m, settings, table)
    for k in range(2 * PIECES):
        dt = (moment if k < PIECES else later - moment) / PIECES
        v_f, omega, v_l = now[0], now[1], now[2]
        _take_up(now, rate, m.asked, settings, 1.0, PUSHES[m.family], PUSHES[m.family], left, m.steep, dt)
        left = max(left - dt, 0.0)
        advance(ground, 0.5 * (v_f + now[0]), 0.5 * (omega + now[1]), 0.5 * (v_l + now[2]), dt)
        if k == PIECES - 1:
            for i in range(3):
                command[i] = now[i]


@kernel
def _within(space, p, inner, family):
    """Bring a scaled wish `p` (3,) into a space. Walks go a little faster than any that was recorded, runs
    slower, straight on, so that the two meet."""
    ahead = p[0]
    p[0] = reached(space, ahead, family)
    stretch = ahead / p[0] if p[0] > 0.0 else 1.0
    inner_kernel(space, p, inner)
    clamp_kernel(space, p, inner)
    p[0] *= min(max(stretch, LEAST_STRETCH), MOST_STRETCH)


@kernel
def reached(space, ahead, family):
    """The scaled forward speed, of one that is stretched to, that a family has recorded."""
    return min(ahead, space.straight[1]) if family == WALK else max(ahead, space.straight[0])
