"""Nearest segments by an inverted file: space cut into cells, of which only the nearest few are searched.

Motion goes on: what follows the neighbours of one frame is most of the neighbours of the next. So a
query also looks at the successors of the candidates that the query before came upon, which are its
hint, and needs to search fewer cells. What was found once is kept as long as it stays near.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ...compiled import kernel
from .search import Projection, ranked
from .segments import Segments

_ROUNDS = 4  # of Lloyd's: cells need not be perfect
_PER_CELL = 32  # segments a cell that k-means looks at
_CHUNK = 1 << 13
_FIRST = 8  # dimensions that mostly tell that a segment is too far away


class Cells:
    """k-means cells over principal components (an inverted file: Jégou 2011, without the coding).

    cells: how many; by default 2.5 √W. share: which part of them is searched, at least sixteen cells;
    without a hint `cold` times as many. candidates: how many are ranked again by the exact distance,
    at least four times as many as wanted; they are the hint.
    """

    def __init__(self, segments: Segments, cells: int | None = None, share: float = 1 / 128, cold: int = 4,
                 candidates: int = 600, seed: int = 0):
        self.segments, self.candidates, self.cold = segments, candidates, cold
        self.projection = Projection.of(segments)
        points = self.projection.all(segments)
        count = min(round(2.5 * len(segments) ** 0.5) if cells is None else cells, len(segments))
        self.probes = max(16, round(share * count))
        centres, cell = cluster(points, count, np.random.default_rng(seed))
        self._arrange(centres, cell, points[np.argsort(cell, kind="stable")])

    def _arrange(self, centres, cell, points):
        """points: of the segments, those of a cell together, in the order of time."""
        self.centres, self.cell, self.points = centres, cell, points
        self.order = np.argsort(cell, kind="stable")
        self.place = np.argsort(self.order)
        self.bounds = np.concatenate([[0], np.cumsum(np.bincount(cell, minlength=len(centres)))])
        self._norms = np.einsum("ij,ij->i", centres, centres)

    def save(self, path: str | Path) -> None:
        """Write it as an .npz file."""
        with Path(path).open("wb") as file:
            np.savez(file, mean=self.projection.mean, basis=self.projection.basis, centres=self.centres, cell=self.cell,
                     points=self.points, about=[self.probes, self.cold, self.candidates])

    @staticmethod
    def load(path: str | Path, segments: Segments) -> Cells:
        """Read what `save` wrote of the same segments. OSError or ValueError for anything else."""
        with np.load(path) as file:
            if "centres" not in file or len(file["cell"]) != len(segments):
                raise ValueError(f"{path}: is no index of these segments")
            found = object.__new__(Cells)
            found.segments, found.projection = segments, Projection(file["mean"], file["basis"])
            found.probes, found.cold, found.candidates = (int(number) for number in file["about"])
            found._arrange(file["centres"], file["cell"], file["points"])
        return found

    def query(self, feature: np.ndarray, k: int, hint: np.ndarray | None = None, forbidden: int | None = None
              ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """See `neighbours.Search`; the hint is an array of segments."""
        found = self.candidates_of(feature, k, hint, forbidden)
        return *ranked(self.segments, feature, found, k), found

    def candidates_of(self, feature: np.ndarray, k: int, hint: Any = None, forbidden: int | None = None) -> np.ndarray:
        """Segments (C,) among which the k nearest very likely are, in no order."""
        point = self.projection(feature)
        first, end = self.segments.span(forbidden)
        wanted = max(self.candidates, 4 * k)
        probes, before = (self.cold * self.probes, _NONE) if hint is None else (self.probes, hint)
        away = self._norms - 2 * (self.centres @ point)
        while True:
            whole = probes >= len(away)
            near = np.arange(len(away)) if whole else np.argpartition(away, probes)[:probes]
            found = _scan(point, self.points, self.order, self.bounds, near, self.segments.last, self.cell, self.place,
                          before, first, end, wanted)
            if len(found) >= wanted or whole:
                return found
            probes *= 4  # next to nothing was allowed there


_NONE = np.empty(0, np.int64)


def cluster(points: np.ndarray, count: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """k-means by Lloyd's rounds: centres (count, d), and the nearest one to each point (W,) int32.

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
    """The number of the centre nearest to each point (W,) int32."""
    half = 0.5 * np.einsum("ij,ij->i", centres, centres)
    return np.concatenate([np.argmax(points[start:start + _CHUNK] @ centres.T - half, -1).astype(np.int32)
                           for start in range(0, len(points), _CHUNK)])


@kernel(fastmath=True)
def _scan(point, points, order, bounds, near, last, cell, place, before, first, end, wanted):
    """The `wanted` nearest segments of some cells and of what follows `before`; none of first … end − 1."""
    numbers, squared = np.empty(4 * wanted, np.int64), np.empty(4 * wanted, np.float32)
    count, limit = 0, np.float32(np.inf)
    searched = np.zeros(bounds.shape[0] - 1, np.bool_)
    searched[near] = True
    for w in before:
        after = w + 1
        if after == last.shape[0] or last[after] != last[w] + 1 or first <= after < end or searched[cell[after]]:
            continue
        away = _away(points[place[after]], point, limit)
        if away < limit:
            numbers[count], squared[count] = after, away
            count += 1
            if count == numbers.shape[0]:
                count, limit = _thin(numbers, squared, wanted)
    for c in near:
        for i in range(bounds[c], bounds[c + 1]):
            away = _away(points[i], point, limit)
            if away >= limit or first <= order[i] < end:
                continue
            numbers[count], squared[count] = order[i], away
            count += 1
            if count == numbers.shape[0]:
                count, limit = _thin(numbers, squared, wanted)
    if count > wanted:
        count, _ = _thin(numbers[:count], squared[:count], wanted)
    return numbers[:count].copy()


@kernel(fastmath=True)
def _away(a, b, limit):
    """The squared distance of two points, or of their first dimensions where that is beyond the limit already."""
    total = np.float32(0.0)
    for d in range(_FIRST):
        total += (a[d] - b[d]) * (a[d] - b[d])
    if total < limit:
        for d in range(_FIRST, a.shape[0]):
            total += (a[d] - b[d]) * (a[d] - b[d])
    return total


@kernel
def _thin(numbers, squared, wanted):
    """Keep the `wanted` nearest, in front; how many those are, and the distance of the farthest."""
    limit = np.partition(squared, wanted - 1)[wanted - 1]
    count = 0
    for below in (True, False):  # those at the limit only as far as there is room
        for i in range(count if not below else 0, squared.shape[0]):
            if count < wanted and (squared[i] < limit if below else squared[i] == limit):
                numbers[count], numbers[i] = numbers[i], numbers[count]
                squared[count], squared[i] = squared[i], squared[count]
                count += 1
    return count, limit
