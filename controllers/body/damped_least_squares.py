"""All joints of a chain at once, by damped least squares (Levenberg and Marquardt): what a cyclic descent is ended by.

A place that only a chain held at its limits can come to may lie beyond a hollow in which every descent from afar
ends. So one begins where the cyclic descent ended, and then anew from places spread over the joints' limits, as
many on their edges as between them.
"""

from __future__ import annotations

import math

import numpy as np

from ..compiled import kernel
from .ik import distance_kernel
from .rotation_kernels import exp_kernel

_STARTS, _STEPS = 40, 60
_SLOPE, _STIFF = 1e-6, 1e3
"""How far a joint is turned to see where that leads [rad]; a damping [m²] that leaves no step worth taking."""


@kernel
def together_kernel(root, base, bones, lower, upper, goal, tolerance, begin, gap, turns, joints, orientations):
    """Bring a chain's end nearer to its goal than `gap` [m], which is where `begin` (N, 3) has it.

    `turns` (N, 3), joints (N + 1, 3) and orientations (N, 3, 3) are written. Returns the gap they leave, `gap` itself if
    there is none less. What lies farther away than the chain is long is not tried.
    """
    n = len(bones)
    length = 0.0
    for k in range(n):
        length += math.sqrt(bones[k, 0] ** 2 + bones[k, 1] ** 2 + bones[k, 2] ** 2)
    starts = _STARTS if distance_kernel(root, goal) <= length + tolerance else 0
    spread = 2.0  # the root of x^(3n + 1) = x + 1: its powers spread points evenly over 3n axes (Roberts 2018)
    for _ in range(40):
        spread = (1.0 + spread) ** (1.0 / (3.0 * n + 1.0))
    best, least = begin.copy(), gap
    for start in range(starts):
        for k in range(n):
            for i in range(3):
                share = 0.5 + start / spread ** (3 * k + i + 1)
                a, b = max(lower[k, i], -math.pi), min(upper[k, i], math.pi)
                somewhere = a + (2.0 * (share - math.floor(share)) - 0.5) * (b - a)
                turns[k, i] = begin[k, i] if start == 0 else min(max(somewhere, lower[k, i]), upper[k, i])
        found = _descend(root, base, bones, lower, upper, goal, tolerance, turns, joints, orientations)
        if found < least:
            least = found
            best[:] = turns
        if least < tolerance:
            break
    turns[:] = best
    chain_kernel(root, base, bones, turns, joints, orientations, 0)
    return least


@kernel
def _descend(root, base, bones, lower, upper, goal, tolerance, turns, joints, orientations):
    """From one start, as far as it goes. Returns the gap [m]."""
    n = len(bones)
    chain_kernel(root, base, bones, turns, joints, orientations, 0)
    gap, damping = distance_kernel(joints[n], goal), 1e-3
    slopes, trial, square = np.empty((n, 3, 3)), turns.copy(), np.empty((3, 3))
    for _ in range(_STEPS):
        if gap < tolerance or damping > _STIFF:
            break
        end, off = joints[n].copy(), goal - joints[n]
        for k in range(n):
            for i in range(3):
                slopes[k, i] = 0.0
                if upper[k, i] > lower[k, i]:
                    ahead = _SLOPE if turns[k, i] + _SLOPE <= upper[k, i] else -_SLOPE
                    trial[k, i] = turns[k, i] + ahead
                    chain_kernel(root, base, bones, trial, joints, orientations, 0)
                    trial[k, i] = turns[k, i]
                    slopes[k, i] = (joints[n] - end) / ahead
                    nearer = slopes[k, i, 0] * off[0] + slopes[k, i, 1] * off[1] + slopes[k, i, 2] * off[2]
                    if (turns[k, i] <= lower[k, i] and nearer < 0.0) or (turns[k, i] >= upper[k, i] and nearer > 0.0):
                        slopes[k, i] = 0.0  # its limit holds it
        while damping <= _STIFF:
            square[:] = 0.0
            for m in range(3):
                square[m, m] = damping
                for j in range(3):
                    for k in range(n):
                        for i in range(3):
                            square[m, j] += slopes[k, i, m] * slopes[k, i, j]
            pull = np.linalg.solve(square, off)
            for k in range(n):
                for i in range(3):
                    step = slopes[k, i, 0] * pull[0] + slopes[k, i, 1] * pull[1] + slopes[k, i, 2] * pull[2]
                    trial[k, i] = min(max(turns[k, i] + step, lower[k, i]), upper[k, i])
            chain_kernel(root, base, bones, trial, joints, orientations, 0)
            there = distance_kernel(joints[n], goal)
            if there < gap:
                turns[:] = trial
                gap, damping = there, max(0.1 * damping, 1e-9)
                break
            trial[:] = turns
            damping *= 10.0
    return gap


@kernel
def chain_kernel(root, base, bones, turns, joints, orientations, first):
    """Forward kinematics of a chain from joint `first` on."""
    own = np.empty((3, 3))
    for k in range(first, len(bones)):
        parent = base if k == 0 else orientations[k - 1]
        if k == 0:
            joints[0, 0], joints[0, 1], joints[0, 2] = root[0], root[1], root[2]
        exp_kernel(turns[k, 0], turns[k, 1], turns[k, 2], own)
        for i in range(3):
            joints[k + 1, i] = joints[k, i]
            for m in range(3):
                orientations[k, i, m] = (parent[i, 0] * own[0, m] + parent[i, 1] * own[1, m] + parent[i, 2] * own[2, m])
            for m in range(3):
                joints[k + 1, i] += orientations[k, i, m] * bones[k, m]
