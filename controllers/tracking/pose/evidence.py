"""How well pictures fit what was expected, and which of them are not to be believed: a corrupted frame is noticed, not fitted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

SHARE = 0.72
"""A picture whose overlap with the expected silhouette is below so much of the usual one is not believed."""
MEMORY = 0.15
"""How much of the usual overlap each frame that is believed replaces."""
PATIENCE = 6
"""After so many frames that were not believed, they are: then it was us who were wrong."""
LEAST = 0.2
"""But not one that overlaps less than this: its contours are another's than those expected near them."""


@dataclass(frozen=True, eq=False)
class Evidence:
    """What a gate remembers of each of C cameras. usual: (C,) overlap, 0 … 1. doubted: (C,) frames in a row."""

    usual: np.ndarray
    doubted: np.ndarray

    @staticmethod
    def fresh(cameras: int) -> Evidence:
        """Nothing seen yet."""
        return Evidence(np.full(cameras, 0.8), np.zeros(cameras, int))


def overlap(one: np.ndarray, other: np.ndarray, hidden: np.ndarray | None = None) -> float:
    """The intersection of two masks over their union, but for what is hidden; NaN where both are empty."""
    if hidden is not None:
        one, other = one & ~hidden, other & ~hidden
    union = np.count_nonzero(one | other)
    return np.count_nonzero(one & other) / union if union else np.nan


def judged(evidence: Evidence, overlaps: np.ndarray) -> tuple[Evidence, np.ndarray]:
    """What is remembered now, and which cameras (C,) bool are believed in this frame. overlaps: (C,) with the expected; NaN of
    a camera that neither shows somebody nor should, which is not doubted for that."""
    silent = np.isnan(overlaps)
    believed = silent | (overlaps >= SHARE * evidence.usual) | (evidence.doubted >= PATIENCE) & (overlaps >= LEAST)
    usual = np.where(believed & ~silent, (1 - MEMORY) * evidence.usual + MEMORY * overlaps, evidence.usual)
    return Evidence(usual, np.where(believed, 0, evidence.doubted + 1)), believed
