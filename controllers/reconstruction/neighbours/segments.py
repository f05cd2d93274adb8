"""Segments: some frames of the past and the frame that came next, as the local models learn from them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ...compiled import kernel
from ..database import Database, DatabaseError
from ..pose_vector import WIDTH
from .features import Weights, of_past, of_points, of_recorded


@dataclass(frozen=True, eq=False)
class Neighbourhood:
    """The K recorded segments nearest to a query: what a local model is learnt from.

    X: (K, P) float32 features of the past frames, weighted as the query is (`features`).
    Y: (K, D) float32 the frame that followed each, as in `pose_vector`: joints and root.
    distances: (K,) float32, of X from the query, ascending. indices: (K,) int64 the segments' numbers.
    """

    X: np.ndarray
    Y: np.ndarray
    distances: np.ndarray
    indices: np.ndarray


@dataclass(frozen=True, eq=False)
class Segments:
    """All segments of a database, and their features.

    m, stride: a segment is m frames of the past, `stride` apart. joints: numbers of the joints that
    control points are on, in the order of the query's; none for the paper's query. weights: of the features.
    last: (W,) int64 the newest frame of each segment, ascending; the frame it predicts is the one after.
    points: (W, 6 n) float32 features of the control points.
    Features of the past are made of the mapped frames when they are asked for, not kept.
    """

    database: Database
    m: int
    stride: int
    joints: tuple[int, ...]
    weights: Weights
    last: np.ndarray
    points: np.ndarray

    @staticmethod
    def of(database: Database, m: int = 3, stride: int = 4, joints: Iterable[int] = (), weights: Weights = Weights(),
           offsets: np.ndarray | None = None) -> Segments:
        """The segments of a database. offsets: (n, 3) [m] of control points that are beside their joints. DatabaseError if it has
        none so long."""
        last, joints = database.segments(m, stride), tuple(int(joint) for joint in joints)
        if not len(last):
            raise DatabaseError(f"{database.path}: has no sound take of {(m - 1) * stride + 2} frames or more")
        points = of_recorded(database.frames, last, joints, 1 / database.fps, weights, offsets)
        return Segments(database, m, stride, joints, weights, last, points)

    def __len__(self) -> int:
        return len(self.last)

    @property
    def width(self) -> int:
        """How many features a segment has."""
        return self.m * WIDTH + self.points.shape[1]

    @cached_property
    def recordings(self) -> np.ndarray:
        """The recording that each segment is of (W,) int32."""
        starts = np.array([take.start for take in self.database.takes])
        numbers = np.array([take.recording for take in self.database.takes], np.int32)
        return numbers[np.searchsorted(starts, self.last, "right") - 1]

    def span(self, recording: int | None) -> tuple[int, int]:
        """From which segment on, and up to which, a recording and its mirror image reach; (0, 0) for None."""
        if recording is None:
            return 0, 0
        # keys of another type would have the whole array converted
        first, end = np.searchsorted(self.recordings, np.array([recording, recording + 1], np.int32))
        return int(first), int(end)

    def query(self, past: np.ndarray, points: np.ndarray | None = None, before: np.ndarray | None = None,
              track: np.ndarray | None = None) -> np.ndarray:
        """Features (width,) float32 to search for. past: (m, WIDTH) frames, newest first, `stride` apart.

        points, before, track: as `of_points` takes them, where these segments have control points: ValueError without.
        """
        seen = of_past(past, self.weights)
        if not self.joints:
            return seen
        if points is None or before is None or track is None:
            raise ValueError(f"these segments have {len(self.joints)} control points: tell where they are, were and the track")
        return np.concatenate([seen, of_points(points, before, track, 1 / self.database.fps, self.weights)], -1)

    def features(self, which: np.ndarray) -> np.ndarray:
        """Features (K, width) float32 of some segments (K,)."""
        frames = self.last[which][:, None] - self.stride * np.arange(self.m)
        return np.concatenate([of_past(self.database.frames[frames], self.weights), self.points[which]], -1)

    def targets(self, which: np.ndarray) -> np.ndarray:
        """The frames (K, WIDTH) float32 that follow some segments (K,)."""
        return self.database.frames[self.last[which] + 1]

    def squared_distances(self, feature: np.ndarray, which: np.ndarray) -> np.ndarray:
        """Squared distances (K,) float32 of some segments (K,) from a query (width,)."""
        out = np.empty(len(which), np.float32)
        _squared(self.database.frames, self.weights.columns, self.last, self.stride, self.points, feature, which, out)
        return out

    def neighbourhood(self, search: Any, feature: np.ndarray, k: int, hint: Any = None, forbidden: int | None = None
                      ) -> tuple[Neighbourhood, Any]:
        """The k nearest to a query (width,) by one of the searches of `neighbours`, and its hint for the next one.

        forbidden: a recording that must not be found.
        """
        indices, distances, hint = search.query(feature, k, hint, forbidden)
        return Neighbourhood(self.features(indices), self.targets(indices), distances, indices), hint


@kernel(fastmath=True)
def _squared(frames, columns, last, stride, points, feature, which, out):
    width, extra = columns.shape[0], points.shape[1]
    m = (feature.shape[0] - extra) // width
    for i in range(which.shape[0]):
        w = which[i]
        total = np.float32(0.0)
        for j in range(m):
            row = frames[last[w] - j * stride]
            seen = feature[j * width:(j + 1) * width]
            for c in range(width):
                difference = row[c] * columns[c] - seen[c]
                total += difference * difference
        ahead = feature[m * width:]
        for c in range(extra):
            difference = points[w, c] - ahead[c]
            total += difference * difference
        out[i] = total
