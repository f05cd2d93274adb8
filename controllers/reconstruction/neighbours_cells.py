"""Nearest segments by an inverted file: space cut into cells, of which only the nearest few are searched."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..compiled import kernel
from .neighbours import Projection, ranked
from .segments import Segments

_ROUNDS = 8  # of Lloyd's: cells need not be perfect
_PER_CELL = 32  # segments a cell that k-means looks at
_CHUNK = 1 << 13


class Cells:
    """k-means cells over principal components (an inverted file: Jégou 2011, without the coding).

    cells: how many; by default 2.5 √W. share: which part of them is searched, at least eight.
    candidates: how many are ranked again by the exact distance, at least four times as many as wanted.
    """

    def __init__(self, segments: Segments, cells: int | None = None, share: float = 1 / 32, candidates: int = 400,
                 seed: int = 0):
        self.segments, self.candidates = segments, candidates
        self.projection = Projection.of(segments)
        points = self.projection.all(segments)
        count = min(round(2.5 * len(segments) ** 0.5) if cells is None else cells, len(segments))
        self.probes = min(max(8, round(share * count)), count)
        self.centres, cell = cluster(points, count, np.random.default_rng(seed))
        # a cell's segments lie together, in the order of time
        self.order = np.argsort(cell, kind="stable")
        self.bounds = np.concatenate([[0], np.cumsum(np.bincount(cell, minlength=count))])
        self.points = points[self.order]
        self._norms = np.einsum("ij,ij->i", self.centres, self.centres)

    def query(self, feature: np.ndarray, k: int, hint: Any = None, forbidden: int | None = None
              ) -> tuple[np.ndarray, np.ndarray, Any]:
        """See `neighbours.Search`; there is no hint."""
        return *ranked(self.segments, feature, self.candidates_of(feature, k, forbidden), k), None

    def candidates_of(self, feature: np.ndarray, k: int, forbidden: int | None = None) -> np.ndarray:
        """Segments (C,) among which the k nearest very likely are, in no order."""
        point = self.projection(feature)
        first, end = self.segments.span(forbidden)
        wanted, probes = max(self.candidates, 4 * k), self.probes
        away = self._norms - 2 * (self.centres @ point)
        while True:
            near = np.argpartition(away, probes - 1)[:probes] if probes < len(away) else np.arange(len(away))
            numbers, squared = _scan(point, self.points, self.order, self.bounds, near, first, end)
            if len(numbers) >= wanted or probes == len(away):
                break
            probes = min(4 * probes, len(away))  # next to nothing was allowed there
        return numbers if len(numbers) <= wanted else numbers[np.argpartition(squared, wanted)[:wanted]]


def cluster(points: np.ndarray, count: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """k-means by Lloyd's rounds: centres (count, d), and the nearest one to each point (W,).

    points: (W, d) float32. Told from a sample; a centre that loses all its points stays where it is.
    """
    sample = points[rng.permutation(len(points))[:_PER_CELL * count]]
    centres = sample[:count].copy()
    for _ in range(_ROUNDS):
        cell = nearest(sample, centres)
        held = np.bincount(cell, minlength=count)
        sums = np.stack([np.bincount(cell, column, count) for column in sample.T], -1)
        centres[held > 0] = (sums / np.maximum(held, 1)[:, None])[held > 0]
    return centres, nearest(points, centres)


def nearest(points: np.ndarray, centres: np.ndarray) -> np.ndarray:
    """The number of the centre nearest to each point (W,)."""
    half = 0.5 * np.einsum("ij,ij->i", centres, centres)
    return np.concatenate([np.argmax(points[start:start + _CHUNK] @ centres.T - half, -1)
                           for start in range(0, len(points), _CHUNK)])


@kernel(fastmath=True)
def _scan(point, points, order, bounds, near, first, end):
    """Segments of some cells and their squared distances, those numbered first … end − 1 left out."""
    total = 0
    for c in near:
        total += bounds[c + 1] - bounds[c]
    numbers, squared = np.empty(total, np.int64), np.empty(total, np.float32)
    count = 0
    for c in near:
        for i in range(bounds[c], bounds[c + 1]):
            if first <= order[i] < end:
                continue
            away = np.float32(0.0)
            for d in range(point.shape[0]):
                difference = points[i, d] - point[d]
                away += difference * difference
            numbers[count], squared[count] = order[i], away
            count += 1
    return numbers[:count], squared[:count]
