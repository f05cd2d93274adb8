"""Nearest segments by walking a neighbour graph from those of the frame before (Chai & Hodgins 2005).

A plain graph of nearest neighbours traps the walk: most links of real motion stay within one take.
So a segment is linked to few of each take, and those some frames apart, beside the segments just
before and after it; and now and then the walk is started anew from the cells.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...compiled import kernel
from .cells import Cells
from .search import ranked
from .segments import Segments

_NEAR_CELLS = 4  # cells in which a segment's links are looked for


@dataclass(frozen=True, eq=False)
class Trail:
    """Where a walk stands. near: (B,) the nearest segments of the last query. age: queries since it was started."""

    near: np.ndarray
    age: int


class Graph:
    """A neighbour graph, built upon cells.

    links: how many a segment has at most; per_take of them to the same take, frames `apart`.
    beam: how many segments are kept from one query to the next. expand: how many of them have their
    links followed in each of the `rounds` of a query. restart: after how many queries the cells are asked.
    """

    def __init__(self, segments: Segments, cells: Cells | None = None, links: int = 16, per_take: int = 4, apart: int = 6,
                 beam: int = 600, expand: int = 96, rounds: int = 2, restart: int = 5):
        self.segments, self.cells = segments, cells or Cells(segments)
        self.beam, self.expand, self.rounds, self.restart = beam, expand, rounds, restart
        self.points = np.empty_like(self.cells.points)
        self.points[self.cells.order] = self.cells.points
        centres = self.cells.centres
        norms = np.einsum("ij,ij->i", centres, centres)
        near = np.argsort(norms - 2 * centres @ centres.T, -1)[:, :_NEAR_CELLS]
        starts = np.array([take.start for take in segments.database.takes])
        take = np.searchsorted(starts, segments.last, "right").astype(np.int32)
        self.links = np.full((len(segments), links), -1, np.int32)
        _link(self.points, take, segments.last, self.cells.order, self.cells.bounds, near, per_take, apart, self.links)

    def query(self, feature: np.ndarray, k: int, hint: Trail | None = None, forbidden: int | None = None
              ) -> tuple[np.ndarray, np.ndarray, Trail]:
        """See `neighbours.Search`. Without a hint the cells are asked."""
        found = np.empty(0, np.int64)
        if hint is not None and hint.age < self.restart:
            first, end = self.segments.span(forbidden)
            found = _walk(self.cells.projection(feature), self.points, self.segments.last, self.links, hint.near,
                          max(self.beam, 2 * k), max(self.expand, k // 2), self.rounds, first, end)
        age = hint.age + 1 if hint is not None and len(found) >= k else 0
        if len(found) < k:
            found = self.cells.candidates_of(feature, k, None, forbidden)
        return *ranked(self.segments, feature, found, k), Trail(found, age)


@kernel(fastmath=True)
def _away(a, b):
    total = np.float32(0.0)
    for d in range(a.shape[0]):
        total += (a[d] - b[d]) * (a[d] - b[d])
    return total


@kernel(fastmath=True)
def _link(points, take, last, order, bounds, near, per_take, apart, links):
    """Fill `links` (W, L), nearest first; -1 where there are no more."""
    for c in range(near.shape[0]):
        count = 0
        for n in near[c]:
            count += bounds[n + 1] - bounds[n]
        there = np.empty(count, np.int64)
        count = 0
        for n in near[c]:
            for i in range(bounds[n], bounds[n + 1]):
                there[count] = order[i]
                count += 1
        there.sort()
        best, squared = np.empty(count, np.int64), np.empty(count, np.float32)
        for i in range(bounds[c], bounds[c + 1]):
            node, runs, begun = order[i], 0, -1
            for other in there:
                if take[other] == take[node] and abs(last[other] - last[node]) < apart:
                    continue
                away = _away(points[other], points[node])
                # of some frames in a row, the nearest one will do
                if runs and take[other] == take[best[runs - 1]] and last[other] - begun < apart:
                    if away < squared[runs - 1]:
                        best[runs - 1], squared[runs - 1] = other, away
                else:
                    best[runs], squared[runs], begun = other, away, last[other]
                    runs += 1
            held = 0
            for r in np.argsort(squared[:runs]):
                same, crowded = 0, False
                for h in range(held):
                    other = links[node, h]
                    if take[other] == take[best[r]]:
                        same += 1
                        crowded |= abs(last[other] - last[best[r]]) < apart
                if same < per_take and not crowded:
                    links[node, held] = best[r]
                    held += 1
                    if held == links.shape[1]:
                        break


@kernel(fastmath=True)
def _walk(point, points, last, links, start, beam, expand, rounds, first, end):
    """The nearest segments (≤ beam,) that a few rounds of following links come upon."""
    most = start.shape[0] + rounds * (beam + start.shape[0]) * (links.shape[1] + 2)
    slots = 1
    while slots < 2 * most and slots < 1 << 15:
        slots *= 2
    most = min(most, slots // 2)
    seen = np.full(slots, -1, np.int64)  # a hash table of what was looked at
    numbers, squared = np.empty(most, np.int64), np.empty(most, np.float32)
    followed = np.zeros(most, np.bool_)
    count = 0
    for w in start:
        ahead = w + 1
        if ahead >= last.shape[0] or last[ahead] != last[w] + 1:
            ahead = w
        count = _look(ahead, point, points, seen, numbers, squared, count, first, end)
    for _ in range(rounds):
        known = count
        limit = np.float32(np.inf)
        if known > expand:
            limit = np.partition(squared[:known], expand - 1)[expand - 1]
        for i in range(known):
            if followed[i] or squared[i] > limit:
                continue
            followed[i] = True
            w = numbers[i]
            if w > 0 and last[w - 1] == last[w] - 1:
                count = _look(w - 1, point, points, seen, numbers, squared, count, first, end)
            if w + 1 < last.shape[0] and last[w + 1] == last[w] + 1:
                count = _look(w + 1, point, points, seen, numbers, squared, count, first, end)
            for other in links[w]:
                if other < 0:
                    break
                count = _look(other, point, points, seen, numbers, squared, count, first, end)
    if count <= beam:
        return numbers[:count].copy()
    limit = np.partition(squared[:count], beam - 1)[beam - 1]
    return numbers[:count][squared[:count] <= limit]


@kernel(fastmath=True)
def _look(w, point, points, seen, numbers, squared, count, first, end):
    """Note a segment that was not looked at yet; the new count."""
    if first <= w < end or count == numbers.shape[0]:
        return count
    slot = (w * 2654435761) & (seen.shape[0] - 1)
    while seen[slot] >= 0:
        if seen[slot] == w:
            return count
        slot = (slot + 1) & (seen.shape[0] - 1)
    seen[slot] = w
    numbers[count], squared[count] = w, _away(points[w], point)
    return count + 1
