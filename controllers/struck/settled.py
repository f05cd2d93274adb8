"""Lying on uneven ground: a fall that was recorded on a level floor, bent so that what lay on that lies on treads and edges.

Every place of the body is to be as high over the ground as it was over the floor, the more so the nearer it was, and nothing below it. How the pelvis is turned and spine, neck,
hips, knees, ankles, shoulders and elbows are bent for that is found by least squares for all moments at once, with as little as can be and evenly in time.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from ..body import Skeleton, exp, forward_kinematics, log
from ..jump.body import Physique
from ..jump.motion import FEET
from .stepwise_ground import Ground, rest_kernel
from .held_falls import SPACED, flesh
from .recorded_falls import RATE

EVERY = 5
"""So many moments of the fall are one of these."""
ROUNDS, DAMPED, FARTHEST = 12, 0.05, 0.12
"""So many steps of least squares, damped by so much, each of which lets no place rise or sink by more than this [m]."""
SHINS = np.arange(2 * SPACED, 4 * SPACED)
"""Places of the flesh that are near the ground as one stands, too, beside feet."""
HANGS = 0.25
"""What is farther over the ground than this [m], where something else lies on it, hangs."""
NEAR, HARD, SINKS = 0.10, 3.0, 0.15
"""What is this near the floor [m], at standard height, is to lie as near the ground; what is below that weighs so many times as much, and what is over it this."""
STIFF, UPRIGHT, PLACED, EVEN = 1e-2, 0.3, 3.0, 0.15
"""What it costs to bend a joint by 1 rad; to turn the pelvis of who does not lie, and to lead him aside by 1 m; and that either changes its rate by 1 rad between moments."""
LED, LIFTED = np.linspace(-0.3, 0.3, 21), 0.01
"""So far [m] a body may be led aside so that it gets up where its feet stand; a sole stands all over to this [m]."""
STUBS, HANGING, APART, MOVES, EARLY = 1.0, 0.15, 0.5, 0.3, 0.05
"""What it costs there [m] that a heel or tip is in what is higher than its ball, or a foot in the air; hangs over an edge; that feet are not on one level; that they move by 1 m/s; and
to have got up 1 s sooner."""
RESTS = 0.35
"""Nobody has got up whose feet move faster than this [m/s]."""
CARRIES = 0.025
"""Of a foot that is so much over the ground at most [m] with what is nearest to it, that stands and whatever else is no farther by as much."""
BEGINS = 1e3
"""How firmly it begins as it was."""
LEVEL = 1e-3
"""Ground that is no more uneven under a body [m] is level."""
LEAST, LOCKED = 0.03, 3.0
"""Knees and elbows are bent by no less [rad], and how firmly so."""


class Bends(NamedTuple):
    """What bends: B joints or hinges. joints: (B,); axes: (B,) 0, 1, 2 in the parent's frame, or, of hinges, in their own; hinges: (B,) 0 of none, else the sense in which it bends.
    moves: (P, B) which places of the flesh it moves."""

    joints: np.ndarray
    axes: np.ndarray
    hinges: np.ndarray
    moves: np.ndarray


def uneven(points: np.ndarray, thick: np.ndarray, floor: float, ground: Ground) -> bool:
    """Whether the ground is anywhere else than at `floor` [m] beneath places (N, P, 3) of a body with flesh (P,) [m]."""
    rests = np.empty(points.shape[:2])
    rest_kernel(ground.things, ground.corner, ground.caps, points, thick, False, rests, np.empty((*rests.shape, 2)))
    return bool(np.abs(rests - thick - floor).max() > LEVEL)


def footing(soles: np.ndarray, thick: np.ndarray, floor: float, ground: Ground) -> tuple[int, np.ndarray]:
    """At which of M moments a body has got up, and whither (2,) x, z [m] it is led so that its feet stand on treads then. soles: (M, 6, 3) heel, ball and tip
    of either foot on a level floor [m], 1/RATE apart; thick: (6,) [m]."""
    x, z = (part.ravel() for part in np.meshgrid(LED, LED))
    pace = np.linalg.norm(np.gradient(soles, 1.0 / RATE, axis=0), axis=-1).max(1)
    lifted = (soles[..., 1] - thick - floor).max(1) > 2.0 * LIFTED
    best, least = (len(soles) - 1, np.zeros(2)), np.inf
    for n in np.flatnonzero(pace <= max(RESTS, float(pace.min())))[::-3]:
        places = np.repeat(soles[n][None], len(x), 0)
        places[..., [0, 2]] += np.stack([x, z], -1)[:, None]
        rests = np.empty(places.shape[:2])
        rest_kernel(ground.things, ground.corner, ground.caps, places, thick, False, rests, np.empty((*rests.shape, 2)))
        heights = (rests - thick).reshape(-1, 2, FEET // 2)
        balls, apart = heights[..., 1], np.ptp(heights.max(2), 1)
        stubs, hangs = (heights > balls[..., None] + LIFTED).sum((1, 2)), (heights < balls[..., None] - LIFTED).sum((1, 2))
        cost = np.hypot(x, z) + STUBS * (stubs + lifted[n]) + HANGING * hangs + APART * (apart > LIFTED) + MOVES * pace[n] + EARLY * (len(soles) - 1 - n) / RATE
        if cost.min() < least:
            k = int(cost.argmin())
            best, least = (int(n), np.array([x[k], z[k]])), float(cost[k])
    return best


def stands(soles: np.ndarray, thick: np.ndarray, ground: Ground) -> tuple[float, np.ndarray]:
    """How high [m] the ground lies that carries the lower foot of a body, and which of its heels and balls (4,) stand. soles: (6, 3) heel, ball and tip of either foot; thick: (6,) [m]."""
    rests = np.empty((1, len(soles)))
    rest_kernel(ground.things, ground.corner, ground.caps, soles[None], thick, False, rests, np.empty((*rests.shape, 2)))
    over = (soles[:, 1] - rests[0]).reshape(2, -1)
    lies, near = (rests[0] - thick).reshape(2, -1), over < over.min(1, keepdims=True) + CARRIES
    held = near & (over < 2.0 * CARRIES)
    return float(np.where(near, lies, -np.inf).max(1).min()), np.stack([held[:, 0], held[:, 1:].any(1)], 1).ravel()


@lru_cache(maxsize=16)
def _bends(physique: Physique) -> Bends:
    skeleton = physique.skeleton
    rows = [(skeleton.index(name), axis, 0.0) for name in ("Hips", "Spine", "Neck", "LeftUpLeg", "RightUpLeg", "LeftArm", "RightArm") for axis in range(3)]
    for side, sense in (("Left", -1.0), ("Right", 1.0)):
        rows += [(skeleton.index(side + "Leg"), 0, 1.0), (skeleton.index(side + "ForeArm"), 1, sense), (skeleton.index(side + "Foot"), 0, 0.0)]
    joints, axes, hinges = np.array([row[0] for row in rows]), np.array([row[1] for row in rows]), np.array([row[2] for row in rows])
    # a place is moved by a joint if it moves as that joint turns
    still = np.tile(np.eye(3), (1, len(skeleton), 1, 1))
    base = flesh(physique, *forward_kinematics(skeleton, np.zeros((1, 3)), still))[0][0]
    moves = np.zeros((len(base), len(rows)), bool)
    for joint in set(joints.tolist()):
        moved = np.zeros(len(base), bool)
        for axis in np.eye(3):
            other = still.copy()
            other[0, joint] = exp(0.3 * axis)
            moved |= np.linalg.norm(flesh(physique, *forward_kinematics(skeleton, np.zeros((1, 3)), other))[0][0] - base, axis=1) > 1e-9
        moves[:, joints == joint] = moved[:, None]
    return Bends(joints, axes, hinges, moves)


def settled(physique: Physique, roots: np.ndarray, local: np.ndarray, floor: float, begins: float, ground: Ground) -> tuple[np.ndarray, np.ndarray]:
    """Roots (N, 3) and joints' rotations (N, J, 3, 3) of a body that lies on the ground as it would on a level floor [m]. roots, local: how it lies on that. begins: how high its root is at
    first [m]."""
    from scipy.interpolate import CubicSpline  # no game waits for it at its start

    bends, skeleton = _bends(physique), physique.skeleton
    keys = np.linspace(0, len(roots) - 1, max(len(roots) // EVERY, 4)).round().astype(int)
    root, turns = roots[keys].copy(), local[keys]
    points, thick = flesh(physique, *forward_kinematics(skeleton, root, turns))
    clear = points[..., 1] - thick - floor
    lies = np.exp(-((np.delete(clear[:, :-FEET], SHINS, 1).min(1) / (2.5 * NEAR * physique.size)) ** 2))
    near = np.exp(-((clear / (NEAR * physique.size)) ** 2))
    bent = np.zeros((len(keys), 3 + len(bends.joints)))
    bent[:, 1] = begins - root[0, 1]
    for n in range(ROUNDS):
        bent += _better(physique, bends, root, turns, bent, clear, thick, near, lies, ground, n > ROUNDS // 2)
    every = CubicSpline(keys, bent)(np.arange(len(roots)))
    return roots + every[:, :3], _turned(local, bends, every[:, 3:])


def _turned(local: np.ndarray, bends: Bends, by: np.ndarray) -> np.ndarray:
    """Rotations (N, J, 3, 3), bent by (N, B) [rad]."""
    local = local.copy()
    for joint in dict.fromkeys(bends.joints.tolist()):
        own = bends.joints == joint
        vector = np.zeros((len(local), 3))
        vector[:, bends.axes[own]] = by[:, own]
        local[:, joint] = exp(vector) @ local[:, joint] if own.sum() == 3 else local[:, joint] @ exp(vector)
    return local


def _better(physique, bends, root, turns, bent, clear, thick, near, lies, ground: Ground, aside: bool) -> np.ndarray:
    """What is to be added (N, 3 + B) to where roots are and how far joints are bent: one step of Gauss and Newton over all moments. aside: what is beside a tread may go out of it that way."""
    from scipy.linalg import solveh_banded  # no game waits for it at its start

    skeleton = physique.skeleton
    local = _turned(turns, bends, bent[:, 3:])
    positions, turned = forward_kinematics(skeleton, root + bent[:, :3], local)
    points, _ = flesh(physique, positions, turned)
    rests, ways = np.empty(points.shape[:2]), np.empty((*points.shape[:2], 2))
    rest_kernel(ground.things, ground.corner, ground.caps, points, thick, aside, rests, ways)
    lacks = rests - points[..., 1]
    miss = lacks + clear
    hangs = np.minimum(miss - np.minimum(miss.max(1, keepdims=True), 0.0), 0.0)
    weight = SINKS * near * np.exp(-((hangs / HANGS) ** 2))
    soles = miss[:, -FEET:].reshape(-1, 2, FEET // 2)
    soles[:] = soles.max(2, keepdims=True)  # a sole sinks as far as all of it can
    rises = miss > 0.0
    weight[rises] = near[rises]
    deep = lacks > 0.0
    weight[deep], miss[deep] = HARD, lacks[deep] + np.minimum(clear[deep], 0.0)
    miss, far = np.clip(miss, -FARTHEST, FARTHEST), np.linalg.norm(ways, axis=-1)
    square, right = 0.0, 0.0
    beside = np.stack([ways[..., 0], 0.0 * far, ways[..., 1]], -1) / np.maximum(far, 1e-9)[..., None]
    for way, heavy, short in ((np.broadcast_to([0.0, 1.0, 0.0], points.shape), weight, miss), (beside, HARD, np.minimum(far, FARTHEST))):
        moves = _jacobian(skeleton, bends, positions, turned, points, way)
        heavier = (moves * np.broadcast_to(heavy, miss.shape)[..., None]).swapaxes(1, 2)
        square, right = square + heavier @ moves, right + (heavier @ short[..., None])[..., 0]
        if not far.any():
            break
    count, wide = right.shape
    cost = np.full((count, wide), STIFF)
    cost[:, :3] = np.outer(STIFF + PLACED * (1.0 - lies), [1.0, 0.0, 1.0])
    cost[:, 3:6] = 0.1 * STIFF + UPRIGHT * (1.0 - lies[:, None])
    cost[0] += BEGINS
    right[1:] -= cost[1:] * bent[1:]
    diagonal = np.arange(wide)
    square[:, diagonal, diagonal] += cost + DAMPED
    hinged = np.flatnonzero(bends.hinges)
    now = log(local[:, bends.joints[hinged]])[:, np.arange(len(hinged)), bends.axes[hinged]] * bends.hinges[hinged]
    short = np.maximum(LEAST - now, 0.0)
    right[:, 3 + hinged] += LOCKED * short * bends.hinges[hinged]
    square[:, 3 + hinged, 3 + hinged] += LOCKED * (short > 0.0)
    banded = np.zeros((2 * wide + 1, count * wide))  # upper form, see scipy
    for column in range(wide):
        for row in range(column + 1):
            banded[2 * wide + row - column, column::wide] = square[:, row, column]
    bends_evenly = np.diff(np.eye(count), 2, axis=0)
    bends_evenly = bends_evenly.T @ bends_evenly
    right -= EVEN * bends_evenly @ bent
    for far in range(3):
        banded[(2 - far) * wide, far * wide:] += EVEN * np.repeat(np.diagonal(bends_evenly, far), wide)
    return solveh_banded(banded, right.ravel()).reshape(count, wide)


def _jacobian(skeleton: Skeleton, bends: Bends, positions, turned, points, ways) -> np.ndarray:
    """How far (N, P, 3 + B) places go along `ways` (N, P, 3) for the root's place and each bend."""
    alone = np.bincount(bends.joints)[bends.joints] < 3
    frames = np.where(alone, bends.joints, skeleton.parents[bends.joints])
    lines = np.where((frames < 0)[:, None], np.eye(3)[bends.axes], turned[:, frames, :, bends.axes].swapaxes(0, 1))
    bent = np.cross(points, ways) @ lines.swapaxes(1, 2) - ways @ np.cross(lines, positions[:, bends.joints]).swapaxes(1, 2)
    return np.concatenate([ways, bent * bends.moves], 2)
