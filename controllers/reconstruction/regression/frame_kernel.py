"""What a frame of the local methods costs most, compiled: the local regression, the fusion of beliefs, and the pose.

`prior.fit` is the plain form of the first.
"""

from __future__ import annotations

import math

import numpy as np

from ...compiled import kernel
from ..pose_vector import FORWARD, HEIGHT, LEFTWARD, PITCH, ROLL, YAW_RATE
from .solver_kernel import EXACT, cholesky_kernel, multiply_kernel, turn_kernel

@kernel(fastmath=EXACT, error_model="numpy")
def weights_kernel(distances, relative, out):
    """See `prior.weights`. relative: whether distances count against the median one."""
    count = len(distances)
    scale = 1.0
    if relative:
        middle = np.sort(distances)[count // 2]
        scale = 1.0 / max(float(middle) * float(middle), 1e-12)
    least = float(distances[0]) ** 2 * scale
    for k in range(1, count):
        least = min(least, float(distances[k]) ** 2 * scale)
    for k in range(count):
        out[k] = max(math.exp(-0.5 * (float(distances[k]) ** 2 * scale - least)), 1e-6)


@kernel(fastmath=EXACT, error_model="numpy")
def regress_kernel(query, X, Y, distances, relative, ridge, floor, mean, variance):
    """Fills mean and variance (D,) of the belief after a query (P,), from segments X (K, P) and frames Y (K, D) after
    them: `prior.regress` in the dual form with a diagonal covariance, not loosened. False if no factor is found."""
    count, size, width = X.shape[0], X.shape[1], Y.shape[1]
    one = X.dtype.type
    omega = np.empty(count)
    weights_kernel(distances, relative, omega)
    total = 0.0
    for k in range(count):
        total += omega[k]
    middle, first = np.zeros(size), np.zeros(width)
    for k in range(count):
        share = omega[k] / total
        for p in range(size):
            middle[p] += share * X[k, p]
        for d in range(width):
            first[d] += share * Y[k, d]
    x, y, root = np.empty_like(X), np.empty((count, width), X.dtype), np.empty(count, X.dtype)
    ahead = np.empty(size, X.dtype)
    for p in range(size):
        ahead[p] = query[p] - middle[p]
    spread = 0.0
    for k in range(count):
        root[k] = math.sqrt(omega[k])
        own = 0.0
        for p in range(size):
            x[k, p] = root[k] * (X[k, p] - middle[p])
            own += x[k, p] * x[k, p]
        spread += own
        for d in range(width):
            y[k, d] = root[k] * (Y[k, d] - first[d])
    ridge = max(ridge * spread / count, 1e-9)
    gram = np.dot(x, x.T)
    along = np.dot(x, ahead)
    level = spread / count + ridge
    for i in range(count):
        for j in range(count):
            gram[i, j] += level / total * root[i] * root[j]
        gram[i, i] += ridge
    # L Lᵀ = G, then y becomes L⁻¹y, and L its own inverse
    if not cholesky_kernel(gram, count):
        return False
    inverse = np.zeros_like(gram)
    for i in range(count):
        for j in range(i):
            factor = gram[i, j]
            for c in range(j + 1):
                inverse[i, c] -= factor * inverse[j, c]
        turn = one(1.0) / gram[i, i]
        inverse[i, i] = one(1.0)
        for c in range(i + 1):
            inverse[i, c] *= turn
    half = np.dot(inverse, y)
    solved = np.dot(inverse.T, half)
    for d in range(width):
        mean[d], variance[d] = first[d], 0.0
    for k in range(count):
        diagonal = 0.0
        for i in range(k, count):
            diagonal += inverse[i, k] * inverse[i, k]
        left = (diagonal - root[k] * root[k] / (total * (level + ridge))) * root[k]
        share = omega[k] / total / (left * left)
        for d in range(width):
            mean[d] += along[k] * solved[k, d]
            variance[d] += share * solved[k, d] * solved[k, d]
    for d in range(width):
        variance[d] = max(variance[d], floor[d] * floor[d])
    return True


@kernel(fastmath=EXACT, error_model="numpy")
def fuse_kernel(mean, variance, factor, other, spread, mean_out, variance_out):
    """`beliefs.fuse` of a belief with one that has no factor, other ± √spread. Fills mean and variance (D,); returns
    the factor (R, D)."""
    rows, width = factor.shape
    shrunk, weighed, error = np.empty((rows, width)), np.empty((rows, width)), np.empty(width)
    for d in range(width):
        total = variance[d] + spread[d]
        gain = variance[d] / total
        error[d] = other[d] - mean[d]
        mean_out[d], variance_out[d] = mean[d] + gain * error[d], gain * spread[d]
        for r in range(rows):
            shrunk[r, d] = factor[r, d] * (1.0 - gain)
            weighed[r, d] = factor[r, d] / total
    lower = np.dot(weighed, factor.T)
    told = np.dot(weighed, error)
    for i in range(rows):
        lower[i, i] += 1.0
        for j in range(i + 1):
            rest = lower[i, j]
            for k in range(j):
                rest -= lower[i, k] * lower[j, k]
            if i == j:
                lower[i, i] = math.sqrt(rest)
            else:
                lower[i, j] = rest / lower[j, j]
    for i in range(rows):
        for j in range(i):
            by = lower[i, j]
            told[i] -= by * told[j]
            for d in range(width):
                shrunk[i, d] -= by * shrunk[j, d]
        by = 1.0 / lower[i, i]
        told[i] *= by
        for d in range(width):
            shrunk[i, d] *= by
            mean_out[d] += told[i] * shrunk[i, d]
    return shrunk


@kernel(fastmath=EXACT, error_model="numpy")
def pose_kernel(frame, track, reference, first, root, rotations):
    """Fills root (3,) and rotations (J, 3, 3): `chart.decode` of one frame (D,) at its track (3,).

    first: (J,) the first of a joint's three columns, -1 where it has none.
    """
    root[0], root[1], root[2] = track[0], frame[HEIGHT], track[1]
    turned, jacobian = np.empty((3, 3)), np.empty((3, 3))
    for j in range(len(first)):
        if first[j] >= 0:
            turn_kernel(frame[first[j]], frame[first[j] + 1], frame[first[j] + 2], turned, jacobian)
            multiply_kernel(reference[j], turned, rotations[j])
        else:
            rotations[j] = np.eye(3)
    turn_kernel(frame[PITCH], 0.0, frame[ROLL], turned, jacobian)
    c, s = math.cos(track[2]), math.sin(track[2])
    for k in range(3):
        rotations[0, 0, k] = c * turned[0, k] + s * turned[2, k]
        rotations[0, 1, k] = turned[1, k]
        rotations[0, 2, k] = c * turned[2, k] - s * turned[0, k]


@kernel(fastmath=EXACT, error_model="numpy")
def seen_kernel(pose, other, ground, out):
    """Fills out (D,): `learning.seen_from` of one placed pose (D,)."""
    out[:] = pose
    c, s = math.cos(other[2]), math.sin(other[2])
    x = c * pose[LEFTWARD] + s * pose[FORWARD] + other[0] - ground[0]
    z = c * pose[FORWARD] - s * pose[LEFTWARD] + other[1] - ground[1]
    c, s = math.cos(ground[2]), math.sin(ground[2])
    out[LEFTWARD], out[FORWARD] = c * x - s * z, s * x + c * z
    out[YAW_RATE] = (pose[YAW_RATE] + other[2] - ground[2] + math.pi) % (2.0 * math.pi) - math.pi
