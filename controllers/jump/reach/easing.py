"""Leaps whose legs turn no faster than people's.

Along a path the whole body is posed, in the push and as it touches down. Where knees or ankles would turn too fast, `Start.eased` is changed: how far knees are bent as it
leaves, how far heels are up then, how far knees are bent as it touches down, and how far its feet reach ahead then. How much each slows joints is known from leaps
all round, so that a few of Newton's steps do, each along a path of its own.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...body import yaw
from ..body import FLAT, Start
from ..motion import Path, Plan
from ..planner import Draft

LIMITS, WANTED = np.array([16.6, 19.6]), np.array([16.0, 19.0])
"""Knees and ankles that turn faster than this are too fast [rad/s], and what is wanted of them then."""
BENDS, HEELS, SOFTENS, REACHES = (0.03, 1.0), 1.0, 2.0, 1.2
"""For each share by which a joint is too fast: by so much more [rad] a knee is bent as it leaves, beside the first; heels are up; knees are bent as it touches down, which takes
less of a leap, too; and by which share less it reaches ahead with feet that come down behind it."""
SPARES = np.array([0.5, 0.5, 1.0, 0.0])
"""And so much of that where it is too much for the body."""
MOST = np.array([0.5, 0.3, 0.8, 0.6])
"""By so much at most."""
HARDEST = 4.4
"""Who falls faster needs all of his legs to stop [m/s]."""
TRIES = 3
"""So many paths are tried beside the first."""


def eased(start: Start, way: Path, another: Callable[[np.ndarray], tuple[Start, Path, str]], begun: Callable[[Start, Path], Draft]) -> list[Plan]:
    """The leap from a start along a path, and, where its joints turn too fast, one along a path near it before that whose joints do less. another: the start of who
    leaps eased so (4,), his path, and why it can't be gone, if so. begun: a leap from a start along a path."""
    first = begun(start, way)
    made = first.plan()
    fast = first.played(made) / LIMITS - 1.0
    if start.springs or way.hops or -way.falling[1] > HARDEST or not (fast > 0.0).any():  # hoppers' legs are those of recorded hops
        return [made]
    fast, best = LIMITS * (1.0 + fast) / WANTED - 1.0, None
    base, least, lacks = start.eased, _lacks(fast), float(_lacks(fast).sum())
    step = _step(fast, way, base)
    for _ in range(TRIES):
        if not step.any():
            break
        start, way, why = another(np.clip(base + step, -MOST, MOST))
        if why:  # it takes too much of the body: less, and none of what takes more of a leap
            step *= SPARES
            continue
        draft = begun(start, way)
        fast = draft.fastest(first.flown) / WANTED - 1.0  # whose flight is much like the first
        found = _lacks(fast)
        if found.sum() < lacks:
            best, lacks = draft, float(found.sum())
        better = np.repeat(found <= least, 2)  # what slows it as it leaves and as it touches down has little to do with each other
        base, step = np.where(better, start.eased, base), np.where(better, _step(fast, way, start.eased), 0.5 * step)
        least = np.minimum(found, least)
    if best is None:
        return [made]
    other = best.plan()
    return [other, made] if _lacks(best.played(other) / LIMITS - 1.0).sum() < _lacks(first.played(made) / LIMITS - 1.0).sum() else [made]


def _lacks(fast: np.ndarray) -> np.ndarray:
    """How much too fast (2,) joints are in the push and as it touches down that are so by shares (2, 2), see `Draft.fastest`."""
    return (np.maximum(fast, 0.0)**2).sum(1)


def _step(fast: np.ndarray, way: Path, base: np.ndarray) -> np.ndarray:
    """By how much (4,) `Start.eased`, which is base (4,), is to change of who leaps along a path with joints that are too fast by shares (2, 2), see `Draft.fastest`."""
    (knee, ankle), touches = np.maximum(fast, 0.0)
    flat = way.velocity * FLAT
    ahead = float(flat @ yaw(way.heading)[:, 2]) / max(float(np.linalg.norm(flat)), 1e-9)
    heels = max(ahead, 0.0) * knee if knee > ankle else -ankle  # aside and backward they bring nothing nearer
    lands = SOFTENS * float(touches.max())
    nearer = max(lands - (MOST[2] - base[2]), 0.0) / SOFTENS  # than knees can do, where it comes down backward
    return np.array([BENDS[0] * (knee > 0.0) + BENDS[1] * knee, HEELS * heels, max(SOFTENS * knee, lands), REACHES * max(-ahead, 0.0) * nearer])
