"""Root motion: the ground frame moves as it is commanded, and the pose goes with it."""

from __future__ import annotations

import math

import numpy as np

from ..compiled import kernel
from .foot_points import foot_points
from .kernel import DURATION_AT, HIPS_AT, LABELS_AT, query_kernel, time_kernel

DRIFT_HALFLIFE = 0.03
"""Of the standing foot's say where a blend's velocity is measured [s]."""
PATIENCE, HURRY, MOST_HURRY = 0.08, 0.25, 0.6
"""A standing foot this far off [m] makes one step sooner, the more the farther, by at most this share."""

SHORTEST = 0.3
"""No blend's cycle is shorter [s]."""
BRISKEST = 1.4, 2.2
"""Who must take shorter steps takes them at most this many times as often, walking, and running up or down stairs: some 3.5 steps a second, as recorded people."""
SOONEST = 1.35
"""Feet of who runs on stairs take hold, rise and sink so many times as soon: later, and they graze treads; sooner, and they are thrown."""
RUNNER = 1.5, 2.5
"""Who wishes to go ahead no faster than the first [m/s] walks on stairs, who wishes the second runs."""


@kernel
def cadence_kernel(m):
    """Cycles a second, now."""
    return tempo_kernel(m) / max(m.row[DURATION_AT], SHORTEST)


@kernel
def time_ahead(m, table, share):
    """How long the phase will run for that share of a cycle [s], at the weights and the tempo of now: within a cycle its pace changes tenfold."""
    return max(time_kernel(table, m.weights, m.phase, share), SHORTEST * share) / tempo_kernel(m)


@kernel
def tempo_kernel(m):
    """How many times as fast as the blend's own the phase runs: at the command's stretch, more where a foot stands far from where it should,
    and as who stops is quick or who takes short steps brisk."""
    late = 0.0
    for foot in range(2):
        firm = max(m.grip[2 * foot], m.grip[2 * foot + 1])
        late = max(late, firm * firm * (3.0 - 2.0 * firm) * math.hypot(m.offset[foot, 0], m.offset[foot, 1]))
    return m.quick * (1.0 + min(max(late - PATIENCE, 0.0) / HURRY, MOST_HURRY)) * math.sqrt(m.stretch) * briskness(m)


@kernel
def briskness(m):
    """How many times as often somebody takes his steps where they must be short, as on stairs: the gait of a slower walk, played faster."""
    return min(1.0 / max(m.pace, 0.1), BRISKEST[0] + m.runner * (BRISKEST[1] - BRISKEST[0]))


@kernel
def sooner(m):
    """How many times as soon feet take hold, rise and sink of who runs on stairs as of who walks there, and his body after them."""
    return 1.0 + m.runner * (SOONEST - 1.0)


@kernel
def as_runner(m):
    """How much of a runner somebody wishes to be on stairs: 0 who walks, or goes backward or aside, 1 who runs ahead."""
    return min(max((m.wished[1] - RUNNER[0]) / (RUNNER[1] - RUNNER[0]), 0.0), 1.0)


@kernel
def locate(m, space, command, settings, b, p, q):
    """The simplex of the control space whose blend, played as briskly, goes at a command (3,), which becomes the blend's own velocity; b: its barycentric weights."""
    for i in range(3):
        command[i] /= briskness(m)
    return query_kernel(space, command, m.simplex[m.family], settings.correct, b, p, q)


@kernel
def follow_command(m, dt):
    """Move the ground frame at the shaped command, which is what the blend does on average; at rest it stays.

    By the mean of the step's two ends, so that the size of a step does not matter.
    """
    v_f, omega, v_l = m.velocity[0], m.velocity[1], m.velocity[2]
    for i in range(3):
        m.velocity[i] = 0.0 if m.settled else m.command[i]
    advance(m.ground, 0.5 * (v_f + m.velocity[0]), 0.5 * (omega + m.velocity[1]), 0.5 * (v_l + m.velocity[2]), dt)


@kernel
def follow_feet(m, body, legs, positions, orientations, velocities, dt):
    """Move the ground frame so that the standing foot stays: the blend's own mean velocity plus
    what the standing points say beyond it, low-passed. So a blend's true velocity is measured."""
    v_f, omega, v_l = 0.0, 0.0, 0.0
    for i in range(m.weights.shape[0]):
        w = m.weights[i]
        if w > 0.0:
            v_f += w * velocities[i, 0]
            omega += w * velocities[i, 1]
            v_l += w * velocities[i, 2]
    turn = omega * dt
    c, s = math.cos(turn), math.sin(turn)
    points = np.empty((4, 3), np.float32)
    foot_points(body, legs, positions, orientations, points)
    trust, lateral, forward = 1e-6, 0.0, 0.0
    for k in range(4):
        stand = min(max(m.row[LABELS_AT + k], 0.0), 1.0)
        lateral += stand * (m.points[k, 0] - (c * points[k, 0] + s * points[k, 2]))
        forward += stand * (m.points[k, 2] - (-s * points[k, 0] + c * points[k, 2]))
        trust += stand
        for i in range(3):
            m.points[k, i] = points[k, i]
    share = min(trust, 1.0)
    gain = 1.0 - 2.0 ** (-dt / DRIFT_HALFLIFE)
    m.drift[0] += gain * (share * (lateral / trust / dt - v_l) - m.drift[0])
    m.drift[1] += gain * (share * (forward / trust / dt - v_f) - m.drift[1])
    m.velocity[0], m.velocity[1], m.velocity[2] = v_f + m.drift[1], omega, v_l + m.drift[0]
    advance(m.ground, m.velocity[0], omega, m.velocity[2], dt)


@kernel
def advance(ground, v_f, omega, v_l, dt):
    """Lead a ground frame (3,) on for dt at a velocity, by the middle of the turn."""
    turn = omega * dt
    c, s = math.cos(ground[2] + 0.5 * turn), math.sin(ground[2] + 0.5 * turn)
    ground[0] += (c * v_l + s * v_f) * dt
    ground[1] += (-s * v_l + c * v_f) * dt
    ground[2] = math.pi - (math.pi - ground[2] - turn) % (2.0 * math.pi)


@kernel
def short_way(angle):
    """An angle the short way round [rad]."""
    return math.pi - (math.pi - angle) % (2.0 * math.pi)


@kernel
def to_world_kernel(m, row, root, local):
    """Place the pose of the ground frame in the world."""
    c, s = math.cos(m.ground[2]), math.sin(m.ground[2])
    x, z = row[HIPS_AT], row[HIPS_AT + 2]
    root[0] = m.ground[0] + c * x + s * z
    root[1] = row[HIPS_AT + 1] - m.pelvis + m.level
    root[2] = m.ground[1] - s * x + c * z
    for k in range(3):
        x, z = local[0, 0, k], local[0, 2, k]
        local[0, 0, k] = c * x + s * z
        local[0, 2, k] = -s * x + c * z
