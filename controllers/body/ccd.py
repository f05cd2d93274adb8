"""Cyclic coordinate descent: a chain of joints, each with limits, reaches for a place.

Ooi 2015, algorithm 3.1. As printed, θ_R = RD × RE turns the end E away from the goal D; the turn
that brings it nearer is about RE × RD, by atan2(‖RE × RD‖, RE · RD). Joints take their turn from
the end to the root and are held within their limits at once, so every state on the way is one
that the body can take. No turn is taken that moves the end away, so the gap never grows.

A joint's turn is a rotation vector in its own frame, its limits a box about the straight chain
(see `body.anatomy.joint_limits`). Limits that leave it one axis make it a hinge.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..compiled import kernel
from .damped_least_squares import chain_kernel, together_kernel
from .ik import distance_kernel
from .rotation_kernels import exp_kernel, log_kernel

ITERATIONS = 100
"""Enough to converge (the thesis: 100, "with as few as 30 working well")."""
TOLERANCE = 1e-4
"""Nearer than this [m] is there."""
# A chain that points straight at its goal, or away, has no way to turn, and one that its limits caught
# may have to go back to get on: each is tried bent a little [rad], then from the middle of its limits.
_NUDGE, _ATTEMPTS = 0.02, 4
_GOLDEN = 0.6180339887498949


class Reach(NamedTuple):
    """How far a chain got. turns: (..., N, 3) rotation vectors [rad]. joints: (..., N + 1, 3) [m],
    the last its end. orientations: (..., N, 3, 3) of the joints. gap: (...) [m] from end to goal."""

    turns: np.ndarray
    joints: np.ndarray
    orientations: np.ndarray
    gap: np.ndarray


def reach(root: np.ndarray, base: np.ndarray, bones: np.ndarray, turns: np.ndarray, goal: np.ndarray,
          lower: np.ndarray, upper: np.ndarray, *, iterations: int = ITERATIONS,
          tolerance: float = TOLERANCE) -> Reach:
    """Turn the joints of a chain so that its end comes as near to `goal` (..., 3) [m] as it can.

    A leg, a ball and a hinge, comes nearer than `tolerance` [m] to every place to which its limits let it. A longer chain
    that is held by many limits at once may end beside such a place: nothing short of trying all of them would tell.

    root: (..., 3) [m] the first joint. base: (..., 3, 3) the orientation of what it turns against.
    bones: (N, 3) [m] from each joint to the next, the last to the end, in the joint's own frame.
    turns: (..., N, 3) [rad] from where it starts. lower, upper: (N, 3) [rad], lower ≤ upper.
    Leading axes broadcast. ValueError for shapes or limits that make no chain, and for numbers that
    are not finite (limits may be infinite).
    """
    bones, lower, upper = (np.ascontiguousarray(a, float) for a in (bones, lower, upper))
    n = len(bones)
    if n == 0 or any(a.shape != (n, 3) for a in (bones, lower, upper)):
        raise ValueError(f"bones, lower and upper must be (N, 3), got {bones.shape}, {lower.shape}, {upper.shape}")
    if not (lower <= upper).all():
        raise ValueError("a joint's lower limit lies above its upper one")
    shape = np.broadcast_shapes(np.shape(root)[:-1], np.shape(base)[:-2], np.shape(turns)[:-2], np.shape(goal)[:-1])
    flat = []
    for name, value, own in (("root", root, (3,)), ("base", base, (3, 3)), ("turns", turns, (n, 3)), ("goal", goal, (3,))):
        value = np.asarray(value, float)
        if value.shape[value.ndim - len(own):] != own or not np.isfinite(value).all():
            raise ValueError(f"{name} must be finite and end in {own}, got {value.shape}")
        flat.append(np.broadcast_to(value, shape + own).reshape((-1,) + own).copy())
    if not np.isfinite(bones).all():
        raise ValueError("bones must be finite")
    count = len(flat[0])
    joints, orientations, gaps = np.empty((count, n + 1, 3)), np.empty((count, n, 3, 3)), np.empty(count)
    _reach_all(*flat, bones, lower, upper, iterations, tolerance, joints, orientations, gaps)
    return Reach(flat[2].reshape(shape + (n, 3)), joints.reshape(shape + (n + 1, 3)),
                 orientations.reshape(shape + (n, 3, 3)), gaps.reshape(shape))


@kernel
def ccd_kernel(root, base, bones, lower, upper, goal, iterations, tolerance, turns, joints, orientations):
    """One chain: `turns` (N, 3) are changed, joints (N + 1, 3) and orientations (N, 3, 3) written.

    Returns how far the end is from the goal [m].
    """
    n = len(bones)
    for k in range(n):
        for i in range(3):
            turns[k, i] = min(max(turns[k, i], lower[k, i]), upper[k, i])
    chain_kernel(root, base, bones, turns, joints, orientations, 0)
    gap = distance_kernel(joints[n], goal)
    best, least = turns.copy(), gap
    last, longer = np.empty((n, 3)), np.empty((n, 3))
    e, d = np.empty(3), np.empty(3)
    for attempt in range(_ATTEMPTS):
        step = 0.0
        for sweep in range(iterations):
            if gap < tolerance:
                break
            before = gap
            last[:] = turns
            for place in range(n):
                # from end to root; but one newly bent must first be pointed at its goal again
                k = place if sweep == 0 and attempt > 0 else n - 1 - place
                parent = base if k == 0 else orientations[k - 1]
                for i in range(3):
                    e[i], d[i] = 0.0, 0.0
                    for m in range(3):
                        e[i] += parent[m, i] * (joints[n, m] - joints[k, m])
                        d[i] += parent[m, i] * (goal[m] - joints[k, m])
                if _turn_joint(e, d, lower[k], upper[k], turns[k]):
                    chain_kernel(root, base, bones, turns, joints, orientations, k)
            gap = distance_kernel(joints[n], goal)
            # nearly straight chains creep, ever in the same direction: see where that leads
            size = 0.0
            for k in range(n):
                for i in range(3):
                    size += (turns[k, i] - last[k, i]) ** 2
            size = math.sqrt(size)
            if sweep % 3 == 2 and 0.0 < size < step:
                ahead = size / (step - size)
                for k in range(n):
                    for i in range(3):
                        longer[k, i] = min(max(turns[k, i] + ahead * (turns[k, i] - last[k, i]), lower[k, i]), upper[k, i])
                chain_kernel(root, base, bones, longer, joints, orientations, 0)
                there = distance_kernel(joints[n], goal)
                if there < gap:
                    turns[:] = longer
                    gap = there
                else:
                    chain_kernel(root, base, bones, turns, joints, orientations, 0)
            step = size
            if before - gap < 0.01 * tolerance:
                break
        if gap < least:
            least = gap
            best[:] = turns
        if gap < tolerance or attempt == _ATTEMPTS - 1:
            break
        for k in range(n):
            for i in range(3):
                if attempt % 2 == 0:
                    bent = best[k, i] + (_NUDGE if i % 2 == 0 else -_NUDGE)
                else:
                    bent = 0.5 * (max(lower[k, i], -math.pi) + min(upper[k, i], math.pi))
                turns[k, i] = min(max(bent, lower[k, i]), upper[k, i])
        chain_kernel(root, base, bones, turns, joints, orientations, 0)
        gap = distance_kernel(joints[n], goal)
    if least >= tolerance:
        least = together_kernel(root, base, bones, lower, upper, goal, tolerance, best, least, turns, joints, orientations)
    return least


@kernel
def _reach_all(root, base, turns, goal, bones, lower, upper, iterations, tolerance, joints, orientations, gaps):
    for n in range(len(root)):
        gaps[n] = ccd_kernel(root[n], base[n], bones, lower, upper, goal[n], iterations, tolerance, turns[n],
                             joints[n], orientations[n])


@kernel
def _turn_joint(e, d, lower, upper, turn):
    """Turn one joint (3,) within its limits so that its end, at e (3,), points to d (3,) as well as it
    can, both in the parent's frame. Returns whether it turned."""
    reach_e, reach_d = math.sqrt(e[0] ** 2 + e[1] ** 2 + e[2] ** 2), math.sqrt(d[0] ** 2 + d[1] ** 2 + d[2] ** 2)
    if reach_e < 1e-9 or reach_d < 1e-9:
        return False
    hinge = -1
    for i in range(3):
        if upper[i] > lower[i]:
            hinge = i if hinge == -1 else 3
        elif lower[i] != 0.0:
            hinge = 3
    if hinge == -1:
        return False
    if hinge < 3:
        return _turn_hinge(e, d, hinge, lower[hinge], upper[hinge], turn)
    # a ball: the shortest way about RE × RD
    x, y, z = e[1] * d[2] - e[2] * d[1], e[2] * d[0] - e[0] * d[2], e[0] * d[1] - e[1] * d[0]
    sine, cosine = math.sqrt(x * x + y * y + z * z), e[0] * d[0] + e[1] * d[1] + e[2] * d[2]
    if sine < 1e-12 * reach_e * reach_d:
        return False
    angle = math.atan2(sine, cosine) / sine
    now, way, both, wish = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3)), np.empty(3)
    exp_kernel(turn[0], turn[1], turn[2], now)
    wish[0], wish[1], wish[2] = angle * x, angle * y, angle * z
    exp_kernel(wish[0], wish[1], wish[2], way)
    for i in range(3):
        for k in range(3):
            both[i, k] = way[i, 0] * now[0, k] + way[i, 1] * now[1, k] + way[i, 2] * now[2, k]
    log_kernel(both, wish)
    held = False
    for i in range(3):
        inside = min(max(wish[i], lower[i]), upper[i])
        held = held or inside != wish[i]
        wish[i] = inside
    if held:  # the nearest within the box is rarely the best: look along each of its axes
        own = np.empty(3)
        for i in range(3):
            own[i] = now[0, i] * e[0] + now[1, i] * e[1] + now[2, i] * e[2]
        _search(own, d, lower, upper, wish)
        way[0] = turn
        _search(own, d, lower, upper, way[0])
        if _towards(own, d, way[0]) > _towards(own, d, wish):
            wish[:] = way[0]
        if _towards(own, d, wish) <= _towards(own, d, turn):
            return False
    turn[:] = wish
    return True


@kernel
def _turn_hinge(e, d, axis, lower, upper, turn):
    """The same about one axis: the nearest to the best angle that the limits leave is the best there is."""
    b, c = (axis + 1) % 3, (axis + 2) % 3
    sine, cosine = e[b] * d[c] - e[c] * d[b], e[b] * d[b] + e[c] * d[c]
    if math.hypot(sine, cosine) < 1e-15:
        return False
    angle = turn[axis] + math.atan2(sine, cosine)
    if not lower <= angle <= upper:
        whole = 2.0 * math.pi  # the same angle, some turns apart, may lie within
        if math.isfinite(lower):
            same = angle + whole * math.ceil((lower - angle) / whole)
        else:
            same = angle - whole * math.ceil((angle - upper) / whole)
        if same <= upper:
            angle = same
        else:
            angle = lower if math.cos(angle - lower) > math.cos(angle - upper) else upper
    moved = angle != turn[axis]
    turn[axis] = angle
    return moved


@kernel
def _towards(own, d, turn):
    """How far along d (3,) a turn brings `own` (3,), an end in the joint's frame."""
    matrix = np.empty((3, 3))
    exp_kernel(turn[0], turn[1], turn[2], matrix)
    total = 0.0
    for i in range(3):
        total += d[i] * (matrix[i, 0] * own[0] + matrix[i, 1] * own[1] + matrix[i, 2] * own[2])
    return total


@kernel
def _search(own, d, lower, upper, turn):
    """Improve a turn by a golden section along each axis of its box in turn."""
    for i in range(3):
        here, at = _towards(own, d, turn), turn[i]
        a, b = max(lower[i], at - 1.0), min(upper[i], at + 1.0)
        if b <= a:
            continue
        p, q = b - _GOLDEN * (b - a), a + _GOLDEN * (b - a)
        turn[i] = p
        at_p = _towards(own, d, turn)
        turn[i] = q
        at_q = _towards(own, d, turn)
        for _ in range(16):
            if at_p > at_q:
                b, q, at_q = q, p, at_p
                p = b - _GOLDEN * (b - a)
                turn[i] = p
                at_p = _towards(own, d, turn)
            else:
                a, p, at_p = p, q, at_q
                q = a + _GOLDEN * (b - a)
                turn[i] = q
                at_q = _towards(own, d, turn)
        best, where = here, at
        for guess in (a, 0.5 * (a + b), b):
            turn[i] = guess
            value = _towards(own, d, turn)
            if value > best:
                best, where = value, guess
        turn[i] = where


@kernel
def foot_turn_kernel(parent, wanted, lower, upper, turn, out):
    """Re-impose an orientation at the end of a chain: the ankle turns back what the leg has turned.

    parent, wanted: (3, 3) world orientations of the last joint's bone and of what it carries.
    Writes the limited rotation vector (3,) [rad] and the orientation (3, 3) it gives. Returns how
    far the limits held it back [rad], by its most limited axis.
    """
    log_kernel(parent.T @ wanted, turn)
    excess = 0.0
    for i in range(3):
        inside = min(max(turn[i], lower[i]), upper[i])
        excess = max(excess, abs(turn[i] - inside))
        turn[i] = inside
    own = np.empty((3, 3))
    exp_kernel(turn[0], turn[1], turn[2], own)
    out[:] = parent @ own
    return excess
