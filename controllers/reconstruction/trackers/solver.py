"""The most probable pose on a body of its own: what is believed against where trackers are and how they are turned, what stands
stays where it stands, and joints bend as far as joints do.

The energy (q − μ)ᵀP(q − μ) + Σ |p − g|²/σ² + Σ |log(G Rᵀ)|²/τ² + Σ beyond²/λ² of a placed pose q is minimised by Gauss-Newton
steps, damped where one would climb (Levenberg-Marquardt). All is seen from the ground of the trackers.
"""

from __future__ import annotations

import math

import numpy as np

from ...compiled import kernel
from ..pose_vector import FORWARD, HEIGHT, LEFTWARD, PITCH, ROLL, YAW_RATE
from ..regression import EXACT, kinematics_kernel, positive_solve_kernel

LIMIT = math.radians(1.0)
"""How exactly a joint's limits are kept [rad], a standard deviation."""
_DEEPEST = 16
"""No joint has more above it, itself counted."""


@kernel(fastmath=EXACT, error_model="numpy")
def between_kernel(goal, found, out):
    """Fills out (3,) [rad] with log(goal · foundᵀ): the turn in the world that carries one orientation onto another."""
    a = goal[0, 0] * found[0, 0] + goal[0, 1] * found[0, 1] + goal[0, 2] * found[0, 2]
    b = goal[1, 0] * found[1, 0] + goal[1, 1] * found[1, 1] + goal[1, 2] * found[1, 2]
    c = goal[2, 0] * found[2, 0] + goal[2, 1] * found[2, 1] + goal[2, 2] * found[2, 2]
    x = (goal[2, 0] * found[1, 0] + goal[2, 1] * found[1, 1] + goal[2, 2] * found[1, 2]
         - goal[1, 0] * found[2, 0] - goal[1, 1] * found[2, 1] - goal[1, 2] * found[2, 2])
    y = (goal[0, 0] * found[2, 0] + goal[0, 1] * found[2, 1] + goal[0, 2] * found[2, 2]
         - goal[2, 0] * found[0, 0] - goal[2, 1] * found[0, 1] - goal[2, 2] * found[0, 2])
    z = (goal[1, 0] * found[0, 0] + goal[1, 1] * found[0, 1] + goal[1, 2] * found[0, 2]
         - goal[0, 0] * found[1, 0] - goal[0, 1] * found[1, 1] - goal[0, 2] * found[1, 2])
    sine, cosine = 0.5 * math.sqrt(x * x + y * y + z * z), 0.5 * (a + b + c - 1.0)
    # at half a turn the axis is lost, and with it the pull: a step elsewhere brings it back
    scale = 0.5 * math.atan2(sine, cosine) / sine if sine > 1e-6 else 0.5
    out[0], out[1], out[2] = scale * x, scale * y, scale * z


@kernel(fastmath=EXACT, error_model="numpy")
def misfit_kernel(frame, mean, precision, lower, upper, joints, beside, goals, hold, turns, keep, positions, orientations, points, angles):
    """The energy of a frame whose joints are known. Fills points (n, 3) and angles (n, 3), the turns that are missing."""
    total, size = 0.0, len(mean)
    for i in range(size):
        row = 0.0
        for j in range(size):
            row += precision[i, j] * (frame[j] - mean[j])
        total += row * (frame[i] - mean[i])
    for d in range(len(lower)):
        beyond = max(frame[d] - upper[d], lower[d] - frame[d], 0.0) / LIMIT
        total += beyond * beyond
    for n in range(len(joints)):
        j = joints[n]
        for i in range(3):
            points[n, i] = (positions[j, i] + orientations[j, i, 0] * beside[n, 0] + orientations[j, i, 1] * beside[n, 1]
                            + orientations[j, i, 2] * beside[n, 2])
            if hold[n] > 0.0:
                total += hold[n] * (goals[n, i] - points[n, i]) ** 2
        if keep[n] > 0.0:
            between_kernel(turns[n], orientations[j], angles[n])
            total += keep[n] * (angles[n, 0] ** 2 + angles[n, 1] ** 2 + angles[n, 2] ** 2)
    return total


@kernel(fastmath=EXACT, error_model="numpy")
def slopes_kernel(frame, mean, precision, lower, upper, parents, first, joints, goals, hold, keep, positions, axes, points, angles,
                  normal, right):
    """Fills the energy's normal matrix (D, D), its lower half, and half its fall (D,) at a frame whose joints are known."""
    size = len(mean)
    for i in range(size):
        total = 0.0
        for j in range(size):
            total += precision[i, j] * (mean[j] - frame[j])
        right[i] = total
        for j in range(i + 1):
            normal[i, j] = precision[i, j]
    stiff = 1.0 / (LIMIT * LIMIT)
    for d in range(len(lower)):
        over, under = frame[d] - upper[d], lower[d] - frame[d]
        if over > 0.0:
            right[d] -= stiff * over
            normal[d, d] += stiff
        elif under > 0.0:
            right[d] += stiff * under
            normal[d, d] += stiff
    columns = np.empty(3 * _DEEPEST + 3, np.int64)
    moves, spins = np.empty((3 * _DEEPEST + 3, 3)), np.empty((3 * _DEEPEST + 3, 3))
    for n in range(len(joints)):
        if hold[n] <= 0.0 and keep[n] <= 0.0:
            continue
        count, a = 0, joints[n]
        while True:
            root = parents[a] < 0
            if root or first[a] >= 0:
                x, y, z = points[n, 0] - positions[a, 0], points[n, 1] - positions[a, 1], points[n, 2] - positions[a, 2]
                for k in range(3):
                    columns[count] = first[a] + k
                    if root:
                        columns[count] = PITCH if k == 0 else YAW_RATE if k == 1 else ROLL
                    u, v, w = axes[a, 0, k], axes[a, 1, k], axes[a, 2, k]
                    spins[count, 0], spins[count, 1], spins[count, 2] = u, v, w
                    moves[count, 0], moves[count, 1], moves[count, 2] = v * z - w * y, w * x - u * z, u * y - v * x
                    count += 1
            if root:
                break
            a = parents[a]
        for k in range(3):
            columns[count] = LEFTWARD if k == 0 else HEIGHT if k == 1 else FORWARD
            for i in range(3):
                spins[count, i], moves[count, i] = 0.0, 1.0 if i == k else 0.0
            count += 1
        if hold[n] > 0.0:
            u, v, w = goals[n, 0] - points[n, 0], goals[n, 1] - points[n, 1], goals[n, 2] - points[n, 2]
        else:
            u, v, w = 0.0, 0.0, 0.0
        for p in range(count):
            i = columns[p]
            if hold[n] > 0.0:
                right[i] += hold[n] * (moves[p, 0] * u + moves[p, 1] * v + moves[p, 2] * w)
            if keep[n] > 0.0:
                right[i] += keep[n] * (spins[p, 0] * angles[n, 0] + spins[p, 1] * angles[n, 1] + spins[p, 2] * angles[n, 2])
            for q in range(count):
                j = columns[q]
                if j <= i:
                    normal[i, j] += (hold[n] * (moves[p, 0] * moves[q, 0] + moves[p, 1] * moves[q, 1] + moves[p, 2] * moves[q, 2])
                                     + keep[n] * (spins[p, 0] * spins[q, 0] + spins[p, 1] * spins[q, 1] + spins[p, 2] * spins[q, 2]))


@kernel(fastmath=EXACT, error_model="numpy")
def fit_kernel(mean, precision, start, lower, upper, parents, offsets, reference, first, joints, beside, goals, hold, turns, keep,
               steps, tolerance, frame, positions, orientations):
    """Fills frame (D,), positions (J, 3) and orientations (J, 3, 3) of the most probable placed pose; returns its energy.

    mean, precision: (D,), (D, D) what is believed. joints, beside: (n,), (n, 3) where trackers and soles are. goals, turns: (n, 3) [m],
    (n, 3, 3) where they should be; hold, keep: (n,) 1/σ² [1/m², 1/rad²], 0 where nothing is known: what is there is never read.
    """
    size, count = len(mean), len(joints)
    axes, scratch = np.empty((len(parents), 3, 3)), np.empty((3, 3, 3))
    normal, damped, right = np.empty((size, size)), np.empty((size, size)), np.empty(size)
    fall, candidate = np.empty(size), np.empty(size)
    points, angles = np.empty((count, 3)), np.zeros((count, 3))
    frame[:] = start
    kinematics_kernel(frame, 1.0, parents, offsets, reference, first, positions, orientations, axes, scratch)
    energy = misfit_kernel(frame, mean, precision, lower, upper, joints, beside, goals, hold, turns, keep, positions, orientations, points, angles)
    slopes_kernel(frame, mean, precision, lower, upper, parents, first, joints, goals, hold, keep, positions, axes, points, angles, normal, right)
    damping, settled = 0.0, True
    for _ in range(steps):
        for i in range(size):
            fall[i] = right[i]
            for j in range(i + 1):
                damped[i, j] = normal[i, j]
            damped[i, i] *= 1.0 + damping
        if not positive_solve_kernel(damped, fall, size):
            break
        for i in range(size):
            candidate[i] = frame[i] + fall[i]
        kinematics_kernel(candidate, 1.0, parents, offsets, reference, first, positions, orientations, axes, scratch)
        reached = misfit_kernel(candidate, mean, precision, lower, upper, joints, beside, goals, hold, turns, keep, positions, orientations,
                                points, angles)
        settled = reached <= energy
        if settled:
            gained = energy - reached
            energy = reached
            frame[:] = candidate
            if gained <= tolerance * energy:
                break
            damping = damping / 4.0 if damping > 0.01 else 0.0
            slopes_kernel(frame, mean, precision, lower, upper, parents, first, joints, goals, hold, keep, positions, axes, points, angles,
                          normal, right)
        else:
            damping = max(4.0 * damping, 0.1)
    if not settled:
        kinematics_kernel(frame, 1.0, parents, offsets, reference, first, positions, orientations, axes, scratch)
    return energy
