"""Points as trackers give them, made fit to be followed: exchanged ones get their names back, those that blink go on as they
went, lost ones stay away, wild ones are refused, returning ones eased in.

Where two points went on as if they were each other, or both were unseen, so that nobody could tell them apart, their question is open: now and then it is asked how
much better the other assignment explains what was seen, and what it says is added up (a CUSUM test, Page 1954). Where enough has come together it is taken.
Whatever comes back after longer than a blink is first taken to be where the body has it already, with the body's velocity; the difference
then settles (inertialisation), so that nothing pops.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from itertools import combinations

import numpy as np

from ...body import damp, exp, log, settle

SUDDEN = 0.15
"""Farther than this [m] from where its motion leads no point gets within a frame: 540 m/s² is beyond any body."""
ROUGHLY = 3.0
"""Noise takes it farther, up to so many times as far as it lately did, but no farther than `NEAR`."""
FASTEST = 15.0
"""And one of which no motion is known yet no farther than this [m/s] goes."""
BLINK = 0.15
"""A point or a turn that is missing for no longer than this [s] goes on as it went; then it is lost."""
SWERVE = 3.0
"""Meanwhile it gets so much farther [m/s] from where its motion led: of recorded points five in a thousand do."""
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
NOISY = 2.0
"""Noise makes points swerve by up to so many times as far as they were lately off."""
THERE = 0.01
"""It has come there as soon as it is nearer than this [m]."""
SLIP = 3.0
"""It is taken to move at most so much faster or slower than it is seen to [m/s]: else it would swing past."""
SKEW = 0.1
"""What no rotation's RᵀR is farther from 1 than."""
PLAIN = 0.5
"""Two points that are no nearer to where their own motion led than by this times their distance from where the other one's did may have been exchanged."""
EVERY, SELDOM = 4, 2
"""In each so-manieth frame one pair is asked about, for which something speaks; where nothing does, so many times more seldom."""
LISTENED = 2.0
"""For so long [s] after two could last have been exchanged: who crosses his arms unseen is as unlikely as exchanged hands, and more so the longer he does."""
CALM = 0.3
"""Energies are told apart as far as they are above this: less is how exactly bodies are met anyway."""
MARGIN, MOST, ENOUGH = 0.2, 2.0, 4.0
"""The logarithm of how many times as much energy this assignment has as the other one speaks for that as far as it is beyond the first of these; a frame
counts up to the second; and the third has to come together. In walks, with 5 cm of noise, too, not more than 1 ever does for a wrong one."""
_ROUGH = 0.2  # s, half-life of the roughness that is told from places
_RATE = 0.03  # s, half-life of the velocity that is told from places


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
        seen, order = seen[self.order], self.order.copy()
        ahead = self.raw + self.rate * dt
        apart = _length(seen[:, None] - ahead)  # of each seen one from where each one was going
        leapt = np.flatnonzero((self.steady > 0.0) & (np.diagonal(apart) > self.usual))
        for k, i in enumerate(leapt):
            for j in leapt[k + 1:]:
                if apart[i, j] <= SUDDEN and apart[j, i] <= SUDDEN:
                    seen[[i, j]], order[[i, j]] = seen[[j, i]], order[[j, i]]
        return replace(self, order=order), seen

    def confusable(self, pairs: np.ndarray, seen: np.ndarray, dt: float) -> np.ndarray:
        """Which pairs (P, 2) of points could have been exchanged (P,) bool when they came to seen (n, 3), dt [s] after the last ones: where both went
        on hardly nearer to where their own motion led than to where the other's did, or neither was followed for longer than a blink."""
        a, b = pairs.T
        ahead, lost = self.raw + self.rate * dt, ~self.trusted & ((self.gone > 0.0) | (self.steady > 0.0))
        own, others = (np.square(seen - ahead).sum(-1), np.square(seen[a] - ahead[b]).sum(-1) + np.square(seen[b] - ahead[a]).sum(-1))
        return (own[a] + own[b] >= PLAIN ** 2 * others) | (lost[a] & lost[b])

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
        there = np.all(np.isfinite(seen), axis=-1)
        seen = np.where(there[:, None], seen, np.nan)
        known = np.isfinite(self.raw).all(-1)
        since = self.gone + dt
        moved, ahead = seen - self.raw, self.raw + self.smooth * dt
        away = np.minimum(_length(moved - self.rate * dt), _length(seen - ahead))
        usual = self.usual
        limit = usual + np.where(self.steady > 0.0, SWERVE * self.gone, FASTEST * since)
        goes_on = there & known & (away <= limit)
        blinks = ~there & known & (since <= BLINK)
        steady = np.where(blinks, self.steady, np.where(goes_on, self.steady + since, 0.0))
        rate = np.where(blinks[:, None], self.smooth, 0.0)
        rate = np.where(goes_on[:, None], (moved + self.rate * self.gone[:, None]) / since[:, None], rate)
        heard = np.where(there & known, damp(self.heard, 1.0, _ROUGH, dt), self.heard)
        rough = np.where(there & known, damp(self.rough * self.heard, np.minimum(away, NEAR), _ROUGH, dt) / np.maximum(heard, 1e-9), self.rough)
        smooth = np.where((self.steady > 0.0)[:, None], damp(self.smooth, rate, _RATE, dt), rate)
        place = np.where(blinks[:, None], ahead, seen)
        gap = _length(place - body)
        believed = (gap <= REACH) & (blinks & self.trusted
                                     | goes_on & (self.trusted | (gap <= NEAR + STRAY * lost) | (steady >= PATIENCE)))
        back = (believed & there & ~(self.trusted & (away <= usual)))[:, None]
        offset, slip = settle(self.offset, self.slip, EASE, dt)
        back = back & (lost == 0.0)
        offset = np.where(believed[:, None], np.where(back, body - seen, offset), 0.0)
        slip = np.where(believed[:, None], np.where(back, _at_most(motion - smooth, SLIP), slip), 0.0)
        swerve = np.where((goes_on & (self.gone == 0.0))[:, None], moved - self.rate * dt, 0.0)
        after = replace(self, raw=place, rate=rate, smooth=smooth, swerve=swerve, swerved=self.swerve, gone=np.where(there, 0.0, since), steady=steady, rough=rough,
                        heard=heard, trusted=believed, offset=offset, slip=slip)
        return after, np.where(believed[:, None], place + offset, np.nan)

    @property
    def swerves(self) -> float:
        """How far [m] a point that is followed got from where its motion led, in both of the last frames and the same way, as none does that only jumped, and farther than noise takes it. Those that
        still come to where they are seen tell nothing."""
        once = np.minimum(_length(self.swerve), _length(self.swerved)) * (np.sum(self.swerve * self.swerved, -1) > 0.0)
        return float((once - NOISY * self.rough)[self.trusted & self.seen & (_length(self.offset) <= THERE)].max(initial=0.0))

    def told(self, turns: np.ndarray, dt: float) -> tuple[Gate, np.ndarray]:
        """How points are turned (n, 3, 3) dt [s] after the last ones, under their own numbers, NaN where that is not known, and
        the gate that knows it. A turn that is not told goes on for `BLINK`."""
        there, known = (np.asarray(np.isfinite(some).all((-1, -2))) for some in (turns, self.turned))
        since = self.untold + dt
        blinks, goes_on = known & ~there & (since <= BLINK), known & there
        old, new = (np.where(which[:, None, None], some, np.eye(3)) for which, some in ((known, self.turned), (there, turns)))
        found = (log(np.swapaxes(old, -1, -2) @ new) + self.spin * self.untold[:, None]) / since[:, None]
        spin = np.where(goes_on[:, None], damp(self.spin, found, _RATE, dt), np.where(blinks[:, None], self.spin, 0.0))
        turned = np.where(blinks[:, None, None], old @ exp(self.spin * dt), np.where(there[:, None, None], new, np.nan))
        return replace(self, turned=turned, spin=spin, untold=np.where(there, 0.0, since)), turned

    @property
    def usual(self) -> np.ndarray:
        """How far (n,) [m] points may get from where their motion led within a frame."""
        return np.clip(ROUGHLY * self.rough, SUDDEN, NEAR)

    @property
    def seen(self) -> np.ndarray:
        """Which (n,) were seen in the last frame."""
        return np.isfinite(self.raw).all(-1) & (self.gone == 0.0)

    def at_odds(self, dt: float) -> bool:
        """Whether all that is seen, two points or more, has moved like a body for two frames of dt [s], but not like this one:
        then the body is wrong, and not the points."""
        there = self.seen
        return int(there.sum()) >= 2 and not self.trusted.any() and bool((self.steady[there] > 1.5 * dt).all())

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
        left = np.where(confusable, LISTENED, np.maximum(self.left - dt, 0.0))
        return replace(self, left=left, evidence=np.where(left > 0.0, self.evidence, 0.0))

    def asked(self) -> tuple[Doubts, int | None]:
        """The doubts a frame later, and the number of the pair that is asked about now."""
        after = replace(self, frames=self.frames + 1)
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
        return replace(self, evidence=evidence), bool(evidence[pair] >= ENOUGH)

    def rather(self, pair: int, other: int) -> Doubts:
        """The doubts after it was found that another pair's exchange explains more than that of the one that was about to be taken."""
        evidence = self.evidence.copy()
        evidence[pair], evidence[other] = 0.0, max(evidence[other], 0.5 * ENOUGH)
        return replace(self, evidence=evidence)

    @property
    def open(self) -> np.ndarray:
        """The numbers of the pairs that are in doubt."""
        return np.flatnonzero(self.left > 0.0)


def rotations(turns: np.ndarray) -> np.ndarray:
    """Turns (n, 3, 3) as they were told, NaN where they are no rotations: mirrored, or by more than `SKEW` not orthonormal."""
    known = np.isfinite(turns).all((-1, -2), keepdims=True)
    some = np.where(known, np.clip(turns, -9.0, 9.0), np.eye(3))
    skew = np.abs(np.swapaxes(some, -1, -2) @ some - np.eye(3)).max((-1, -2), keepdims=True)
    return np.where(known & (skew <= SKEW) & (np.linalg.det(some)[:, None, None] > 0.5), turns, np.nan)


def _length(vectors):
    return np.linalg.norm(vectors, axis=-1)


def _at_most(vectors, length):
    return vectors * np.minimum(1.0, length / np.maximum(_length(vectors), 1e-9))[:, None]
