"""Points as trackers give them, made fit to be followed: exchanged ones get their names back, those that blink go on as they
went, lost ones stay away, wild ones are refused, returning ones eased in.

Where two points went on as if they were each other, or both were unseen, so that nobody could tell them apart, their question is open: now and then it is asked how
much better the other assignment explains what was seen, and what it says is added up (a CUSUM test, Page 1954). Where enough has come together it is taken.
Whatever comes back after longer than a blink is first taken to be where the body has it already, with the body's velocity; the difference
then settles (inertialisation), so that nothing pops.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from itertools import combinations

import numpy as np

from ...contract import but
from .gate_kernels import NEAR, ROUGHLY, SUDDEN, THERE, admit_kernel, confusable_kernel, leapt_kernel, sound_kernel, swerves_kernel, told_kernel

EVERY, SELDOM = 4, 2
"""In each so-manieth frame one pair is asked about, for which something speaks; where nothing does, so many times more seldom."""
LISTENED = 2.0
"""For so long [s] after two could last have been exchanged: who crosses his arms unseen is as unlikely as exchanged hands, and more so the longer he does."""
CALM = 0.3
"""Energies are told apart as far as they are above this: less is how exactly bodies are met anyway."""
MARGIN, MOST, ENOUGH = 0.2, 2.0, 4.0
"""The logarithm of how many times as much energy this assignment has as the other one speaks for that as far as it is beyond the first of these; a frame
counts up to the second; and the third has to come together. In walks, with 5 cm of noise, too, not more than 1 ever does for a wrong one."""


@dataclass(frozen=True, eq=False)
class Gate:
    """What is remembered of n points.

    raw: (n, 3) [m] where they were last seen, or have gone since then, NaN where lost. rate, smooth: (n, 3) [m/s] how they
    move, and how they did in the last frames, which noise blurs less. swerve, swerved: (n, 3) [m] how they got from where their
    motion led, in the last frame and the one before. gone: (n,) [s] for how long they have not been seen.
    steady: (n,) [s] for how long they have moved like a body. rough: (n,) [m] how far they lately were from where their
    motion led, of what was heard of them (n,), 0 … 1: in the first moments there is little. trusted: (n,) bool, which are followed. offset, slip: (n, 3) [m, m/s] what is added to those until it has
    settled. order: (n,) under which number each one comes now. turned, spin, untold: (n, 3, 3), (n, 3) [rad/s], (n,) [s] how
    they were last told to be turned, or have turned since then, NaN where unknown; how fast they turn, and since when
    that was not told.
    """

    raw: np.ndarray
    rate: np.ndarray
    smooth: np.ndarray
    swerve: np.ndarray
    swerved: np.ndarray
    gone: np.ndarray
    steady: np.ndarray
    rough: np.ndarray
    heard: np.ndarray
    trusted: np.ndarray
    offset: np.ndarray
    slip: np.ndarray
    order: np.ndarray
    turned: np.ndarray
    spin: np.ndarray
    untold: np.ndarray

    @staticmethod
    def before(seen: np.ndarray, motion: np.ndarray) -> Gate:
        """When points were seen for the first time, at (n, 3) [m], NaN where not; taken to move as the body does
        [m/s]. None is followed yet."""
        zero, none = np.zeros_like(motion), np.zeros(len(seen))
        return Gate(seen, motion, motion, zero, zero, none, none, none, none, np.zeros(len(seen), bool), zero, zero, np.arange(len(seen)),
                    np.full((len(seen), 3, 3), np.nan), zero, none)

    def named(self, seen: np.ndarray, dt: float) -> tuple[Gate, np.ndarray]:
        """Points (n, 3) [m] as they come dt [s] after the last ones, under their own numbers, and the gate that knows them.

        Two that leapt at once, farther than noise takes them, each to where the other one was going, have only exchanged their numbers. Closer
        to each other than `SUDDEN` they can't be told apart.
        """
        seen = seen[self.order]
        if leapt_kernel(seen, dt, self.raw, self.rate, self.steady, self.rough) < 2:
            return self, seen
        order, ahead = self.order.copy(), self.raw + self.rate * dt
        apart = _length(seen[:, None] - ahead)  # of each seen one from where each one was going
        leapt = np.flatnonzero((self.steady > 0.0) & (np.diagonal(apart) > self.usual))
        for k, i in enumerate(leapt):
            for j in leapt[k + 1:]:
                if apart[i, j] <= SUDDEN and apart[j, i] <= SUDDEN:
                    seen[[i, j]], order[[i, j]] = seen[[j, i]], order[[j, i]]
        return but(self, order=order), seen

    def confusable(self, pairs: np.ndarray, seen: np.ndarray, dt: float) -> np.ndarray:
        """Which pairs (P, 2) of points could have been exchanged (P,) bool when they came to seen (n, 3), dt [s] after the last ones: where both went
        on hardly nearer to where their own motion led than to where the other's did, or neither was followed for longer than a blink."""
        out = np.empty(len(pairs), bool)
        confusable_kernel(pairs, seen, dt, self.raw, self.rate, self.gone, self.steady, self.trusted, out)
        return out

    def exchanged(self, i: int, j: int) -> Gate:
        """The gate for which two points have had each other's number for some time."""
        order = np.arange(len(self.raw))
        order[[i, j]] = j, i
        return Gate(**{field.name: getattr(self, field.name)[order] for field in fields(self)})

    def admit(self, seen: np.ndarray, body: np.ndarray, motion: np.ndarray, dt: float, lost: float = 0.0
              ) -> tuple[Gate, np.ndarray]:
        """The gate dt [s] later, and the points (n, 3) [m] to follow, NaN where there is nothing to believe.

        seen: (n, 3) [m] as they come, NaN where lost. body: (n, 3) [m] where the body would have them now.
        motion: (n, 3) [m/s] how it moves them.
        """
        after = but(self, raw=self.raw.copy(), rate=self.rate.copy(), smooth=self.smooth.copy(), swerve=np.empty_like(self.swerve), swerved=self.swerve,
                    gone=self.gone.copy(), steady=self.steady.copy(), rough=self.rough.copy(), heard=self.heard.copy(), trusted=self.trusted.copy(),
                    offset=self.offset.copy(), slip=self.slip.copy())
        goals = np.empty_like(after.raw)
        admit_kernel(seen, body, motion, dt, lost, after.raw, after.rate, after.smooth, after.swerve, after.gone, after.steady, after.rough, after.heard,
                     after.trusted, after.offset, after.slip, goals)
        return after, goals

    @property
    def swerves(self) -> float:
        """How far [m] a point that is followed got from where its motion led, in both of the last frames and the same way, as none does that only jumped, and farther than noise takes it. Those that
        still come to where they are seen tell nothing."""
        return swerves_kernel(self.raw, self.swerve, self.swerved, self.gone, self.rough, self.trusted, self.offset)

    def told(self, turns: np.ndarray, dt: float) -> tuple[Gate, np.ndarray]:
        """How points are turned (n, 3, 3) dt [s] after the last ones, under their own numbers, NaN where that is not known, and
        the gate that knows it. A turn that is not told goes on for `BLINK`."""
        after = but(self, turned=self.turned.copy(), spin=self.spin.copy(), untold=self.untold.copy())
        told_kernel(turns, dt, after.turned, after.spin, after.untold)
        return after, after.turned

    @property
    def usual(self) -> np.ndarray:
        """How far (n,) [m] points may get from where their motion led within a frame."""
        return np.clip(ROUGHLY * self.rough, SUDDEN, NEAR)

    @property
    def seen(self) -> np.ndarray:
        """Which (n,) were seen in the last frame."""
        return np.isfinite(self.raw).all(-1) & (self.gone == 0.0)

    @property
    def sure(self) -> np.ndarray:
        """Which (n,) are followed where they were seen in the last frame."""
        return self.trusted & (self.gone == 0.0) & (np.abs(self.offset).max(-1) <= THERE)

    def at_odds(self, dt: float) -> bool:
        """Whether all that is seen, two points or more, has moved like a body for two frames of dt [s], but not like this one:
        then the body is wrong, and not the points."""
        if self.trusted.any():
            return False
        there = self.seen
        return int(there.sum()) >= 2 and bool((self.steady[there] > 1.5 * dt).all())

    @property
    def doubtful(self) -> bool:
        """Whether no more than half of the points that go on from where they were, two or more, are believed."""
        going = self.seen & (self.steady > 0.0)
        return int(going.sum()) >= 2 and 2 * int((self.trusted & going).sum()) <= int(going.sum())


@dataclass(frozen=True, eq=False)
class Doubts:
    """What is in doubt of n points. pairs: (P, 2) all of them. left: (P,) [s] for how long each is still asked about. evidence: (P,) what
    speaks for its exchange. frames: how many have gone by."""

    pairs: np.ndarray
    left: np.ndarray
    evidence: np.ndarray
    frames: int = 0

    @staticmethod
    def of(count: int) -> Doubts:
        """Of points that nobody has doubted yet."""
        pairs = np.array(list(combinations(range(count), 2)), int).reshape(-1, 2)
        return Doubts(pairs, np.zeros(len(pairs)), np.zeros(len(pairs)))

    def heard(self, confusable: np.ndarray, dt: float) -> Doubts:
        """The doubts dt [s] later. confusable: (P,) bool, which pairs could have been exchanged meanwhile."""
        if not (confusable.any() or self.left.any()):
            return self  # nothing is asked about, and nothing speaks for anything
        left = np.where(confusable, LISTENED, np.maximum(self.left - dt, 0.0))
        return but(self, left=left, evidence=np.where(left > 0.0, self.evidence, 0.0))

    def asked(self) -> tuple[Doubts, int | None]:
        """The doubts a frame later, and the number of the pair that is asked about now."""
        after = but(self, frames=self.frames + 1)
        if after.frames % EVERY:
            return after, None
        strongest = int(np.argmax(self.evidence)) if len(self.pairs) else 0
        if strongest < len(self.pairs) and self.evidence[strongest] > 0.0:
            return after, strongest
        opened = after.open
        turn, rest = divmod(after.frames // EVERY, SELDOM)
        return after, int(opened[turn % len(opened)]) if len(opened) and not rest else None

    def told(self, pair: int, now: float, other: float) -> tuple[Doubts, bool]:
        """The doubts after a pair was found to have the energy `now`, with its numbers exchanged that of `other`, and whether this is to be taken."""
        gain = math.log((now + CALM) / (other + CALM))
        evidence = self.evidence.copy()
        evidence[pair] = max(0.0, evidence[pair] + float(np.clip(gain - MARGIN, -MOST, MOST)))
        return but(self, evidence=evidence), bool(evidence[pair] >= ENOUGH)

    def rather(self, pair: int, other: int) -> Doubts:
        """The doubts after it was found that another pair's exchange explains more than that of the one that was about to be taken."""
        evidence = self.evidence.copy()
        evidence[pair], evidence[other] = 0.0, max(evidence[other], 0.5 * ENOUGH)
        return but(self, evidence=evidence)

    @property
    def open(self) -> np.ndarray:
        """The numbers of the pairs that are in doubt."""
        return np.flatnonzero(self.left > 0.0)


def rotations(turns: np.ndarray) -> np.ndarray:
    """Turns (n, 3, 3) as they were told, NaN where they are no rotations: mirrored, or by more than `SKEW` not orthonormal."""
    out = np.empty_like(turns)
    sound_kernel(turns, out)
    return out


def _length(vectors):
    return np.linalg.norm(vectors, axis=-1)
