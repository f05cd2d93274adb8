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
from ..motion import Path
from ..planner import Draft

WANTED = np.array([16.3, 19.2])
"""How fast knees and ankles turn at most [rad/s]: a little less than the fastest of recorded jumps, since bodies are not quite upright as they come down."""
BENDS, HEELS, SOFTENS, REACHES = (0.03, 1.0), 1.0, 2.0, 1.2
"""For each share by which a joint is too fast: by so much more [rad] a knee is bent as it leaves, beside the first; heels are up; knees are bent as it touches down, which takes
less of a leap, too; and by which share less it reaches ahead with feet that come down behind it."""
MOST = np.array([0.5, 0.3, 0.8, 0.7])
"""By so much at most."""
TRIES = 3
"""So many paths are tried beside the first."""


def eased(start: Start, way: Path, another: Callable[[np.ndarray], tuple[Start, Path, str]], begun: Callable[[Start, Path], Draft]) -> Draft:
    """The leap from a start along a path, or along one near it whose joints turn no faster than WANTED; where there is none, along that whose joints are least too fast.
    another: the start of who leaps eased so (4,), his path, and why it can't be gone, if so. begun: a leap from a start along a path."""
    best = begun(start, way)
    if start.springs or way.hops:  # whose legs are those of recorded hops
        return best
    fast = best.fastest() / WANTED - 1.0
    step = _step(fast, way, start.runs)
    for _ in range(TRIES):
        if not step.any():
            break
        start, way, why = another(np.clip(best.start.eased + step, -MOST, MOST))
        if why:  # it takes too much of the body: less, and none of what takes more of a leap
            step *= [0.5, 0.5, 1.0, 0.0]
            continue
        draft = begun(start, way)
        found = draft.fastest() / WANTED - 1.0
        if _lacks(found) < _lacks(fast):
            best, fast = draft, found
            step = _step(fast, way, start.runs)
        else:
            step *= 0.5
    return best


def _lacks(fast: np.ndarray) -> float:
    """How much too fast joints are that are so by shares (2, 2), see `Draft.fastest`."""
    return float((np.maximum(fast, 0.0)**2).sum())


def _step(fast: np.ndarray, way: Path, runs: bool) -> np.ndarray:
    """By how much (4,) `Start.eased` is to change of who leaps along a path with joints that are too fast by shares (2, 2), see `Draft.fastest`. runs: his foot is
    under him as it pushes, and leaves as it does."""
    (knee, ankle), touches = np.maximum(fast, 0.0) * [[not runs], [True]]
    flat = way.velocity * FLAT
    ahead = float(flat @ yaw(way.heading)[:, 2]) / max(float(np.linalg.norm(flat)), 1e-9)
    lands = float(touches.max())
    heels = max(ahead, 0.0) * knee if knee > ankle else -ankle  # aside and backward they bring nothing nearer
    return np.array([BENDS[0] * (knee > 0.0) + BENDS[1] * knee, HEELS * heels, SOFTENS * max(knee, lands), REACHES * max(-ahead, 0.0) * lands])
