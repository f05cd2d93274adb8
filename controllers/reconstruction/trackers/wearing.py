"""Which trackers somebody wears, how ill they sit and how often they are lost: drawn for the network to learn on."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...body import exp
from .slots import LAGS, PLACES

_SETS = (
    (0.24, "Hips Head LeftHand RightHand LeftFoot RightFoot"),
    (0.22, "LeftHand RightHand LeftFoot RightFoot"),
    (0.15, "Head LeftHand RightHand"),
    (0.06, "Hips LeftHand RightHand LeftFoot RightFoot"),
    (0.05, "LeftHand LeftFoot RightFoot"),
    (0.04, "LeftHand RightFoot"),
    (0.06, "Head LeftHand RightHand LeftFoot RightFoot"),
    (0.03, "Hips Spine2 Head LeftHand RightHand LeftFoot RightFoot"),
    (0.03, "Hips Spine2 Head LeftHand RightHand LeftFoot RightFoot LeftLeg RightLeg"),
    (0.02, " ".join(PLACES)),
)
"""How often which trackers are worn together; the rest is any of them, each with `_ANY`."""
_ANY = 0.6
_TURNING, _SOME, _HEAD = 0.45, 0.1, 0.8
"""So often all of them turn, so often some; and so often where head and hands are all there is."""
_UNPLACED = 0.2
"""So many of any trackers that turn don't know where they are: inertial ones."""
_BEGINNING, _LOST, _BACK = 0.15, 0.2, 0.1
"""How often the past is not known, trackers are lost, and trackers are back after they were."""
_TRUE, _SEATED = 0.5, 0.5
"""How often places and turns are without noise; how often trackers sit as they were calibrated …"""
_NOISE, _SHAKE, _OFF, _TWISTED = 0.008, 0.015, 0.01, 0.05
"""… else they are off by this: noise [m, rad], at most; and how they sit [m, rad], a standard deviation."""
_ASTRAY = ((0.35, 0.1), (0.15, 0.5))
"""How often the heading is off by how much [rad], a standard deviation: there is none to be told from trackers that don't turn."""


def members(text: str) -> np.ndarray:
    """Which places (S,) bool are named in a text, by spaces."""
    named = text.split()
    return np.array([place in named for place in PLACES])


@dataclass(frozen=True, eq=False)
class Worn:
    """placed, turned: (B, L, S) bool, what is known at each lag. moved: (B, L, S, 3) [m], off: (B, 1, S, 3) [m] in the trackers' frames.
    spun: (B, L, S, 3, 3), by how much orientations are wrong. heading: (B,) [rad], by how much the last one is."""

    placed: np.ndarray
    turned: np.ndarray
    moved: np.ndarray | None
    off: np.ndarray | None
    spun: np.ndarray | None
    heading: np.ndarray

    def among(self, there: np.ndarray) -> Worn:
        """The same where there is a past (B, L) bool at all."""
        return replace(self, placed=self.placed & there[..., None], turned=self.turned & there[..., None])

    def spoilt(self, places: np.ndarray, turns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """What such trackers say of joints at places (B, L, S, 3) with turns (B, L, S, 3, 3)."""
        if self.off is not None:
            places = places + np.matmul(turns, self.off[..., None])[..., 0]
        if self.moved is not None:
            places = places + self.moved
        return places, turns if self.spun is None else turns @ self.spun


def sets() -> dict[str, np.ndarray]:
    """Which trackers (K, S) bool are worn together, and how often (K,)."""
    return {"kinds": np.stack([members(text) for _, text in _SETS]), "often": np.array([share for share, _ in _SETS])}


def exactly(count: int, placed: np.ndarray, turned: np.ndarray) -> Worn:
    """Some trackers, placed and turned (S,) bool, ideal ones, in each of so many samples."""
    shape = count, len(LAGS), len(PLACES)
    return Worn(np.broadcast_to(placed, shape), np.broadcast_to(turned, shape), None, None, None, np.zeros(count))


def worn(count: int, rng: np.random.Generator) -> Worn:
    """Trackers as people wear them, for `count` samples."""
    shape = count, len(LAGS), len(PLACES)
    kinds, often = sets().values()
    kind = np.searchsorted(np.cumsum(often), rng.random(count))
    placed = kinds[np.minimum(kind, len(kinds) - 1)]
    free = kind >= len(kinds)
    placed[free] = rng.random((int(free.sum()), len(PLACES))) < _ANY
    sure = rng.integers(2, 7, count)
    placed[np.arange(count), sure] |= ~placed.any(-1)
    turning, way = np.where(kind == 2, _HEAD, _TURNING), rng.random(count)
    turned = placed & (way < turning)[:, None]
    some = (way >= turning) & (way < turning + _SOME)
    turned |= placed & some[:, None] & (rng.random(placed.shape) < 0.5)
    unplaced = turned & free[:, None] & (rng.random(placed.shape) < _UNPLACED)
    unplaced[np.arange(count), sure] = False
    placed = placed & ~(unplaced & placed[np.arange(count), sure][:, None])
    placed, turned = np.broadcast_to(placed[:, None], shape), np.broadcast_to(turned[:, None], shape)
    known = _known(count, rng)
    moved, spun = _noise(shape, rng)
    astray, draw, begin = np.zeros(count), rng.random(count), 0.0
    for share, size in _ASTRAY:
        astray += rng.normal(size=count) * size * ((draw >= begin) & (draw < begin + share))
        begin += share
    seated = rng.random(count) < _SEATED
    off = np.where(seated[:, None, None, None], 0.0, rng.normal(size=(count, 1, len(PLACES), 3)) * _OFF)
    return Worn(placed & known, turned & known, moved, off, spun, astray)


def _known(count, rng):
    """At which lags (B, L, S) trackers were seen."""
    lag = np.arange(len(LAGS))[None, :, None]
    shape = count, 1, len(PLACES)
    way = rng.random((count, 1, 1))
    begun = rng.integers(1, len(LAGS), (count, 1, 1))
    known = np.broadcast_to((way >= _BEGINNING) | (lag < begun), (count, len(LAGS), len(PLACES))).copy()
    since = rng.integers(1, len(LAGS) + 1, shape)
    losing = (way >= _BEGINNING) & (way < _BEGINNING + _LOST) & (rng.random(shape) < 0.4)
    known &= ~(losing & (lag < since))
    returned = (way >= _BEGINNING + _LOST) & (way < _BEGINNING + _LOST + _BACK) & (rng.random(shape) < 0.4)
    return known & ~(returned & (lag >= np.minimum(since, len(LAGS) - 1)))


def _noise(shape, rng):
    """What is added to places (B, L, S, 3) [m], and what turns are multiplied by (B, L, S, 3, 3)."""
    count = shape[0]
    level = np.where(rng.random(count) < _TRUE, 0.0, rng.random(count))[:, None, None, None]
    sitting = np.where(rng.random(count) < _SEATED, 0.0, _TWISTED)[:, None, None, None]
    moved = level * _NOISE * rng.normal(size=(*shape, 3))
    twist = level * _SHAKE * rng.normal(size=(*shape, 3)) + sitting * rng.normal(size=(count, 1, shape[2], 3))
    return moved, exp(twist)
