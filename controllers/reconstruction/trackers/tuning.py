"""Somebody's own network: the one that ships, learnt on from their own motion, and held near where it was.

What it was learnt from is not here. So that it forgets little of that, weights are pulled back to where they began (L2-SP, Li et al.
2018), the rate is small, and what is used in the end lies between what it was and what it became (WiSE-FT, Wortsman et al. 2022).
"""

from __future__ import annotations

import hashlib

import numpy as np

from .learning import SIZE, Learner
from .network import Network
from .samples import Moments

RATE = 3e-4
"""At most; a quarter of what the network was learnt with."""
BATCHES = 1000
"""Some minutes on one core."""
HOLD = 1e-3
"""How firmly weights are held where they began: so much of what they are off is taken back in a batch while the rate is greatest."""


SHARE = 0.5
"""So far from the one to the other: 0 is the network as it was, 1 all that was learnt."""


class Tuner(Learner):
    """A network while it is learnt on. began: what it was. moments, batches, seed, size: as of a `Learner`. share: see `SHARE`."""

    rate = RATE

    def __init__(self, began: Network, moments: Moments, batches: int = BATCHES, seed: int = 0, share: float = SHARE, size: int = SIZE):
        super().__init__(moments, batches, seed, tuple(len(bias) for bias in began.biases[:-1]), size)
        self.began, self.taken, self.outs, self.added = began, share, began.outs, began.added
        self.anchors = [*began.weights, *began.biases]
        self.values, self.means = ([value.copy() for value in self.anchors] for _ in range(2))
        told = hashlib.sha1(f"{batches}".encode())
        for part in (*self.anchors, moments.which, np.ascontiguousarray(moments.database.frames[::100])):
            told.update(part.tobytes())
        self.of = told.hexdigest()

    def step(self) -> float:
        """Learn from one batch more. Returns its loss."""
        back = np.float32(HOLD * self.share())
        total = super().step()
        for value, anchor in zip(self.values, self.anchors, strict=True):
            value -= back * (value - anchor)
        return total

    def used(self) -> list[np.ndarray]:
        """Weights, then biases: between what they were and what they became."""
        return [anchor + np.float32(self.taken) * (mean - anchor) for anchor, mean in zip(self.anchors, self.means, strict=True)]

    def believed(self, covariance: np.ndarray, placed: np.ndarray, turned: np.ndarray) -> np.ndarray:
        """Halfway between what errors were on what was learnt from, where they are always small, and what they were before."""
        return 0.5 * (covariance + self.began.spread(placed, turned))

    def range(self) -> tuple[np.ndarray, np.ndarray]:
        """The range of joints' rotation vectors (ANGLES,) each [rad], here or before."""
        low, high = super().range()
        return np.minimum(low, self.began.lower), np.maximum(high, self.began.upper)
