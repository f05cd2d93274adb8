"""Leaps whose legs turn no faster than people's.

Before a leap is planned its body is posed along the path, in the push and as it touches down. Where knees or ankles would turn too fast, other paths are tried, on knees that
are bent more as it leaves and as it touches down. How much each slows joints is known from leaps all round, so that a step or two of Newton's do.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..body import Start
from ..planner import Draft, begun
from .arcs import Arc, Arcs
from .seeking import PATH, Pieces

LIMITS = np.array([[16.0, 19.0], [17.0, 20.0]])
"""Knees and ankles that turn faster than this [rad/s] are too fast, in the push and from touch-down: the turn with which a body really leaves adds about one to the first."""
WANTED = 0.97
"""By this share of it who leaps otherwise turns them."""
BENDS, SOFTENS = (0.03, 1.0), 2.0
"""For each share by which a joint is too fast: by so much more [rad] a knee is bent as it leaves, beside the first; and as it touches down, which takes less of a leap, too."""
MOST = 0.5, 0.8
"""By so much at most [rad]."""
SHARES = 1.0, 0.5
"""If that takes too much of the body, by this share of it."""
HARDEST = 4.4
"""Who falls faster needs all of his legs to stop [m/s]."""


class Easing(Arcs):
    """Arcs, and easier ones beside them."""

    def begun(self, start: Start, place: np.ndarray, floor: float, arc: Arc) -> Draft:
        """The leap along an arc that can be gone, not yet planned."""
        return begun(self.physique, arc.how.of(start), arc.path, place, floor)

    def eased(self, start: Start, place: np.ndarray, floor: float, around: Sequence[Any], arc: Arc) -> Pieces[list[tuple[Arc, Draft]]]:
        """An arc that can be gone and its leap, and before it the easiest that was tried, if joints turn too fast along that one and slower along this."""
        usual = arc, self.begun(start, place, floor, arc)
        if start.single is not None or start.springs or arc.path.lands is not None or arc.path.hops or -arc.path.falling[1] > HARDEST:
            return [usual]  # legs that swing, hop or stop a fall are as they are
        fast = _too_fast(usual[1])
        if not fast.any():
            return [usual]
        bent = _bent(fast)
        for share in SHARES:
            yield PATH
            tried = self.arc(start, place, floor, around, arc.how._replace(eased=(share * bent[0], share * bent[1])))
            if not tried.why:  # else it takes too much of the body
                easier = tried, self.begun(start, place, floor, tried)
                if _lacks(_too_fast(easier[1])) < _lacks(fast):
                    return [easier, usual]
        return [usual]


def _too_fast(draft: Draft) -> np.ndarray:
    """By which share (2, 2) joints are too fast, see `Pushing.fastest`, of one that is to be slower than that."""
    fast = draft.fastest() / LIMITS
    return np.maximum(fast / WANTED - 1.0, 0.0) * (fast.max() > 1.0)


def _lacks(fast: np.ndarray) -> float:
    """How much too fast joints are in all that are so by shares (2, 2)."""
    return float((fast**2).sum())


def _bent(fast: np.ndarray) -> tuple[float, float]:
    """By how much more [rad] knees are to be bent, see `How`, whose joints are too fast by shares (2, 2)."""
    knee, touches = float(fast[0, 0]), float(fast[1].max())
    return min(BENDS[0] * (knee > 0.0) + BENDS[1] * knee, MOST[0]), min(SOFTENS * max(knee, touches), MOST[1])
