"""Points as trackers give them, made fit to be followed: exchanged ones get their names back, lost ones stay away, wild
ones are refused, returning ones eased in.

Whatever comes back is first taken to be where the body has it already, with the body's velocity; the difference
then settles (inertialisation), so that nothing pops.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...body import damp, settle

SUDDEN = 0.15
"""Farther than this [m] from where its motion leads no point gets within a frame: 540 m/s² is beyond any body."""
FASTEST = 15.0
"""And one of which no motion is known yet no farther than this [m/s] goes."""
NEAR = 0.4
"""A point that comes back within this of where the body has it [m] is believed at once."""
PATIENCE = 0.3
"""Farther away it has to be seen to move like a body for so long [s]."""
STRAY = 1.5
"""… and as much farther as somebody goes [m/s] for as long as no point was followed."""
REACH = 1.5
"""And beyond this [m] it is never believed."""
EASE = 0.1
"""Half-life with which a point that is back comes to where it is seen [s]."""
SLIP = 3.0
"""It is taken to move at most so much faster or slower than it is seen to [m/s]: else it would swing past."""
_RATE = 0.03  # s, half-life of the velocity that is told from places


@dataclass(frozen=True, eq=False)
class Gate:
    """What is remembered of n points. raw: (n, 3) [m] where they were last seen, NaN where they were not.

    rate, smooth: (n, 3) [m/s] how they move, and how they did in the last frames, which noise blurs less. steady: (n,) [s] for how long they have moved like a body. trusted: (n,) bool
    which are followed. offset, slip: (n, 3) [m, m/s] what is added to those until it has settled. order: (n,) under
    which number each one comes now.
    """

    raw: np.ndarray
    rate: np.ndarray
    smooth: np.ndarray
    steady: np.ndarray
    trusted: np.ndarray
    offset: np.ndarray
    slip: np.ndarray
    order: np.ndarray

    @staticmethod
    def before(seen: np.ndarray, motion: np.ndarray) -> Gate:
        """When points were seen for the first time, at (n, 3) [m], NaN where not; taken to move as the body does
        [m/s]. None is followed yet."""
        zero = np.zeros_like(motion)
        return Gate(seen, motion, motion, np.zeros(len(seen)), np.zeros(len(seen), bool), zero, zero, np.arange(len(seen)))

    def named(self, seen: np.ndarray, dt: float) -> tuple[Gate, np.ndarray]:
        """Points (n, 3) [m] as they come dt [s] after the last ones, under their own numbers, and the gate that knows them.

        Two that leapt at once, each to where the other one was going, have only exchanged their numbers. Closer to each
        other than `SUDDEN` they can't be told apart.
        """
        seen, order = seen[self.order], self.order.copy()
        ahead = self.raw + self.rate * dt
        apart = _length(seen[:, None] - ahead)  # of each seen one from where each one was going
        leapt = np.flatnonzero((self.steady > 0.0) & (np.diagonal(apart) > SUDDEN))
        for k, i in enumerate(leapt):
            for j in leapt[k + 1:]:
                if apart[i, j] <= SUDDEN and apart[j, i] <= SUDDEN:
                    seen[[i, j]], order[[i, j]] = seen[[j, i]], order[[j, i]]
        return replace(self, order=order), seen

    def admit(self, seen: np.ndarray, body: np.ndarray, motion: np.ndarray, dt: float, lost: float = 0.0
              ) -> tuple[Gate, np.ndarray]:
        """The gate dt [s] later, and the points (n, 3) [m] to follow, NaN where there is nothing to believe.

        seen: (n, 3) [m] as they come, NaN where lost. body: (n, 3) [m] where the body would have them now.
        motion: (n, 3) [m/s] how it moves them.
        """
        there = np.all(np.isfinite(seen), axis=-1)
        seen = np.where(there[:, None], seen, np.nan)
        known = np.isfinite(self.raw).all(-1)
        moved = seen - self.raw
        away = np.minimum(_length(moved - self.rate * dt), _length(moved - self.smooth * dt))
        limit = SUDDEN + np.where(self.steady > 0.0, 0.0, FASTEST * dt)
        goes_on = there & known & (away <= limit)
        steady = np.where(goes_on, self.steady + dt, 0.0)
        rate = np.where(goes_on[:, None], moved / dt, 0.0)
        smooth = np.where((self.steady > 0.0)[:, None], damp(self.smooth, rate, _RATE, dt), rate)
        gap = _length(seen - body)
        believed = goes_on & (gap <= REACH) & (self.trusted | (gap <= NEAR + STRAY * lost) | (steady >= PATIENCE))
        back = (believed & ~self.trusted)[:, None]
        offset, slip = settle(self.offset, self.slip, EASE, dt)
        back = back & (lost == 0.0)
        offset = np.where(believed[:, None], np.where(back, body - seen, offset), 0.0)
        slip = np.where(believed[:, None], np.where(back, _at_most(motion - smooth, SLIP), slip), 0.0)
        after = replace(self, raw=seen, rate=rate, smooth=smooth, steady=steady, trusted=believed, offset=offset, slip=slip)
        return after, np.where(believed[:, None], seen + offset, np.nan)

    def at_odds(self, dt: float) -> bool:
        """Whether all that is seen, two points or more, has moved like a body for two frames of dt [s], but not like this one:
        then the body is wrong, and not the points."""
        there = np.isfinite(self.raw).all(-1)
        return int(there.sum()) >= 2 and not self.trusted.any() and bool((self.steady[there] > 1.5 * dt).all())

    @property
    def doubtful(self) -> bool:
        """Whether no more than half of the points that go on from where they were, two or more, are believed."""
        going = self.steady > 0.0
        return int(going.sum()) >= 2 and 2 * int(self.trusted.sum()) <= int(going.sum())


def _length(vectors):
    return np.linalg.norm(vectors, axis=-1)


def _at_most(vectors, length):
    return vectors * np.minimum(1.0, length / np.maximum(_length(vectors), 1e-9))[:, None]
