"""The inner loop of the solver: kinematics of the chart with its Jacobian, and damped Gauss-Newton steps.

Everything is seen from the ground below the hips of the frame before, facing as they did: there the
chart's rates, times the seconds of a frame, are simply the hips' place and heading.
"""

from __future__ import annotations

import math

import numpy as np

from ...compiled import kernel
from ..pose_vector import FORWARD, HEIGHT, LEFTWARD, PITCH, ROLL, YAW_RATE

EXACT = {"reassoc", "contract", "arcp", "nsz"}
"""Fast arithmetic that still knows NaN, which stands for a point not seen."""
FAR = 1e6
"""A point this far away [m] is none: whatever sent it is broken."""


@kernel(fastmath=EXACT, error_model="numpy")
def turn_kernel(x, y, z, rotation, jacobian):
    """exp(v), and the right Jacobian by which exp(v + dv) = exp(v)·exp(J dv), of v = (x, y, z)."""
    square = x * x + y * y + z * z
    if square < 1e-6:
        a, b, c = 1.0 - square / 6.0, 0.5 - square / 24.0, 1.0 / 6.0 - square / 120.0
    else:
        angle = math.sqrt(square)
        a = math.sin(angle) / angle
        b = (1.0 - math.cos(angle)) / square
        c = (1.0 - a) / square
    xx, yy, zz, xy, xz, yz = x * x, y * y, z * z, x * y, x * z, y * z
    rotation[0, 0], rotation[0, 1], rotation[0, 2] = 1.0 - b * (yy + zz), b * xy - a * z, b * xz + a * y
    rotation[1, 0], rotation[1, 1], rotation[1, 2] = b * xy + a * z, 1.0 - b * (xx + zz), b * yz - a * x
    rotation[2, 0], rotation[2, 1], rotation[2, 2] = b * xz - a * y, b * yz + a * x, 1.0 - b * (xx + yy)
    jacobian[0, 0], jacobian[0, 1], jacobian[0, 2] = 1.0 - c * (yy + zz), c * xy + b * z, c * xz - b * y
    jacobian[1, 0], jacobian[1, 1], jacobian[1, 2] = c * xy - b * z, 1.0 - c * (xx + zz), c * yz + b * x
    jacobian[2, 0], jacobian[2, 1], jacobian[2, 2] = c * xz + b * y, c * yz - b * x, 1.0 - c * (xx + yy)


@kernel(fastmath=EXACT, error_model="numpy")
def multiply_kernel(a, b, product):
    """The product of two 3 × 3 matrices."""
    for i in range(3):
        for k in range(3):
            product[i, k] = a[i, 0] * b[0, k] + a[i, 1] * b[1, k] + a[i, 2] * b[2, k]


@kernel(fastmath=EXACT, error_model="numpy")
def kinematics_kernel(frame, dt, parents, offsets, reference, first, positions, orientations, axes, scratch):
    """Joints of a frame (WIDTH,) of the chart, seen from the ground of the frame before.

    first: (J,) the first of a joint's three columns, -1 where it has none. Fills positions (J, 3), orientations
    (J, 3, 3) and axes (J, 3, 3): column k is the world axis about which the joint's k-th number turns.
    """
    turned, jacobian, own = scratch[0], scratch[1], scratch[2]
    for j in range(len(parents)):
        p = parents[j]
        if p < 0:
            heading = frame[YAW_RATE] * dt
            c, s = math.cos(heading), math.sin(heading)
            turn_kernel(frame[PITCH], 0.0, frame[ROLL], turned, jacobian)
            for k in range(3):
                orientations[j, 0, k] = c * turned[0, k] + s * turned[2, k]
                orientations[j, 1, k] = turned[1, k]
                orientations[j, 2, k] = c * turned[2, k] - s * turned[0, k]
            multiply_kernel(orientations[j], jacobian, axes[j])
            axes[j, 0, 1], axes[j, 1, 1], axes[j, 2, 1] = 0.0, 1.0, 0.0
            positions[j, 0] = frame[LEFTWARD] * dt
            positions[j, 1] = frame[HEIGHT]
            positions[j, 2] = frame[FORWARD] * dt
            continue
        for i in range(3):
            positions[j, i] = (positions[p, i] + orientations[p, i, 0] * offsets[j, 0]
                               + orientations[p, i, 1] * offsets[j, 1] + orientations[p, i, 2] * offsets[j, 2])
        if first[j] < 0:
            multiply_kernel(orientations[p], reference[j], orientations[j])
            continue
        turn_kernel(frame[first[j]], frame[first[j] + 1], frame[first[j] + 2], turned, jacobian)
        multiply_kernel(reference[j], turned, own)
        multiply_kernel(orientations[p], own, orientations[j])
        multiply_kernel(orientations[j], jacobian, axes[j])


@kernel(fastmath=EXACT, error_model="numpy")
def points_kernel(dt, parents, first, positions, orientations, axes, joints, beside, points, jacobian):
    """Fills points (n, 3) and their Jacobian (3n, WIDTH) against the frame's numbers."""
    jacobian[:] = 0.0
    for n in range(len(joints)):
        j = joints[n]
        for i in range(3):
            points[n, i] = (positions[j, i] + orientations[j, i, 0] * beside[n, 0]
                            + orientations[j, i, 1] * beside[n, 1] + orientations[j, i, 2] * beside[n, 2])
        row = 3 * n
        a = j
        while True:
            root = parents[a] < 0
            if root or first[a] >= 0:
                x, y, z = (points[n, 0] - positions[a, 0], points[n, 1] - positions[a, 1],
                           points[n, 2] - positions[a, 2])
                for k in range(3):
                    column, scale = first[a] + k, 1.0
                    if root:
                        column = PITCH if k == 0 else YAW_RATE if k == 1 else ROLL
                        scale = dt if k == 1 else 1.0
                    u, v, w = axes[a, 0, k] * scale, axes[a, 1, k] * scale, axes[a, 2, k] * scale
                    jacobian[row, column] = v * z - w * y
                    jacobian[row + 1, column] = w * x - u * z
                    jacobian[row + 2, column] = u * y - v * x
            if root:
                break
            a = parents[a]
        jacobian[row, LEFTWARD] = dt
        jacobian[row + 1, HEIGHT] = 1.0
        jacobian[row + 2, FORWARD] = dt


@kernel(fastmath=EXACT, error_model="numpy")
def cholesky_kernel(matrix, size):
    """Write L of matrix = L Lᵀ, of `size` rows, in place of its lower half. False if the matrix is not positive."""
    for i in range(size):
        for j in range(i + 1):
            total = matrix[i, j]
            for k in range(j):
                total -= matrix[i, k] * matrix[j, k]
            if i == j:
                if not total > 0.0:
                    return False
                matrix[i, i] = math.sqrt(total)
            else:
                matrix[i, j] = total / matrix[j, j]
    return True


@kernel(fastmath=EXACT, error_model="numpy")
def positive_solve_kernel(matrix, right, size):
    """Solve matrix x = right in place by Cholesky, both of `size` rows. False if the matrix is not positive."""
    if not cholesky_kernel(matrix, size):
        return False
    for i in range(size):
        for k in range(i):
            right[i] -= matrix[i, k] * right[k]
        right[i] /= matrix[i, i]
    for i in range(size - 1, -1, -1):
        for k in range(i + 1, size):
            right[i] -= matrix[k, i] * right[k]
        right[i] /= matrix[i, i]
    return True


@kernel(fastmath=EXACT, error_model="numpy")
def misfit_kernel(points, goals, precision):
    """Σ |point − goal|² / σ² of the points seen."""
    total = 0.0
    for n in range(len(points)):
        if precision[n] > 0.0:
            for i in range(3):
                total += (points[n, i] - goals[n, i]) ** 2 * precision[n]
    return total


@kernel(fastmath=EXACT, error_model="numpy")
def cover_kernel(variance, factor, pull, out):
    """Fills out (D,) with Σ·pull, Σ = diag(variance) + factor·factorᵀ."""
    for d in range(len(out)):
        out[d] = variance[d] * pull[d]
    for r in range(factor.shape[0]):
        total = 0.0
        for d in range(len(out)):
            total += factor[r, d] * pull[d]
        for d in range(len(out)):
            out[d] += factor[r, d] * total


@kernel(fastmath=EXACT, error_model="numpy")
def solve_kernel(mean, variance, factor, start, goals, sigma, dt, parents, offsets, reference, first, joints, beside,
                 steps, tolerance, frame, points):
    """Fills frame (D,) with the most probable frame and points (n, 3) with where it has the points. Returns its energy.

    factor: (R, D), the transpose of the prior's. The iterate is always mean + Σ·pull, so that the prior's energy is
    pull·(frame − mean) and its inverse is never needed: Σ may be singular.
    """
    size, count = len(mean), len(joints)
    positions, orientations = np.empty((len(parents), 3)), np.empty((len(parents), 3, 3))
    axes, scratch = np.empty((len(parents), 3, 3)), np.empty((3, 3, 3))
    here, there = np.empty((3 * count, size)), np.empty((3 * count, size))
    kept, normal = np.empty((3 * count, size)), np.empty((3 * count, 3 * count))
    spread = np.empty((3 * count, factor.shape[0]))
    right = np.empty(3 * count)
    pull, candidate_pull, candidate = np.zeros(size), np.empty(size), np.empty(size)
    candidate_points, precision = np.empty((count, 3)), np.zeros(count)
    for n in range(count):
        if abs(goals[n, 0]) < FAR and abs(goals[n, 1]) < FAR and abs(goals[n, 2]) < FAR:  # false for NaN as well
            precision[n] = 1.0 / sigma[n] ** 2
    frame[:] = mean
    kinematics_kernel(frame, dt, parents, offsets, reference, first, positions, orientations, axes, scratch)
    points_kernel(dt, parents, first, positions, orientations, axes, joints, beside, points, here)
    energy = misfit_kernel(points, goals, precision)
    elsewhere = False
    for d in range(size):
        elsewhere = elsewhere or start[d] != mean[d]
    damping = 0.0
    for step in range(steps):
        base, at, jacobian = frame, points, here
        if elsewhere and step == 0:  # linearised where the caller thinks the answer lies
            kinematics_kernel(start, dt, parents, offsets, reference, first, positions, orientations, axes, scratch)
            points_kernel(dt, parents, first, positions, orientations, axes, joints, beside, candidate_points, there)
            base, at, jacobian = start, candidate_points, there
        shrink = 1.0 / (1.0 + damping)
        # with damping in the prior's own metric a step minimises against Σ·shrink around base + shrink (mean − base)
        for n in range(count):
            for i in range(3):
                row = 3 * n + i
                if precision[n] == 0.0:
                    right[row] = 0.0
                    continue
                ahead = 0.0
                for d in range(size):
                    ahead += jacobian[row, d] * (mean[d] - base[d])
                    kept[row, d] = jacobian[row, d] * variance[d]
                right[row] = goals[n, i] - at[n, i] - shrink * ahead
                for r in range(factor.shape[0]):
                    total = 0.0
                    for d in range(size):
                        total += jacobian[row, d] * factor[r, d]
                    spread[row, r] = total
        for row in range(3 * count):
            for column in range(row + 1):
                if precision[row // 3] == 0.0 or precision[column // 3] == 0.0:
                    normal[row, column] = 1.0 if row == column else 0.0
                    continue
                total = 0.0
                for d in range(size):
                    total += kept[row, d] * jacobian[column, d]
                for r in range(factor.shape[0]):
                    total += spread[row, r] * spread[column, r]
                normal[row, column] = shrink * total
                if row == column:
                    normal[row, column] += 1.0 / precision[row // 3]
        if not positive_solve_kernel(normal, right, 3 * count):
            break
        for d in range(size):
            candidate_pull[d] = (1.0 - shrink) * pull[d]
        for row in range(3 * count):
            if precision[row // 3] > 0.0:
                for d in range(size):
                    candidate_pull[d] += shrink * right[row] * jacobian[row, d]
        cover_kernel(variance, factor, candidate_pull, candidate)
        prior = 0.0
        for d in range(size):
            prior += candidate[d] * candidate_pull[d]
            candidate[d] += mean[d]
        kinematics_kernel(candidate, dt, parents, offsets, reference, first, positions, orientations, axes, scratch)
        points_kernel(dt, parents, first, positions, orientations, axes, joints, beside, candidate_points, there)
        reached = misfit_kernel(candidate_points, goals, precision) + prior
        if reached <= energy:
            gained = energy - reached
            energy = reached
            frame[:] = candidate
            pull[:] = candidate_pull
            points[:] = candidate_points
            here, there = there, here
            damping = damping / 4.0 if damping > 0.01 else 0.0
            if gained <= tolerance * energy:
                break
        else:
            damping = max(4.0 * damping, 0.5)
    return energy


@kernel(fastmath=EXACT, error_model="numpy")
def solve_all_kernel(means, variances, factors, starts, goals, sigma, dt, parents, offsets, reference, first, joints,
                     beside, steps, tolerance, frames, points, energies):
    """`solve_kernel` for each of N characters. False if a prior or a start is not finite."""
    for i in range(len(means)):
        if not (np.isfinite(means[i]).all() and np.isfinite(variances[i]).all() and np.isfinite(factors[i]).all()
                and np.isfinite(starts[i]).all()):
            return False
        energies[i] = solve_kernel(means[i], variances[i], factors[i], starts[i], goals[i], sigma[i], dt, parents, offsets,
                                   reference, first, joints, beside, steps, tolerance, frames[i], points[i])
    return True
