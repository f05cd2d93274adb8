"""The nearest recorded segments: one interface, the exact search, and the space the quick ones look in.

Of the quick searches, `Cells` is the one to take; `Tree` is the plainest and `Graph` the paper's. All rank what
they found by the exact distance.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from .segments import Segments

DIMENSIONS = 32
"""Of the space in which quick searches look: with fewer, more candidates have to be ranked again."""
_SAMPLE = 20_000  # segments that tell the principal directions
_CHUNK = 1 << 14


class Search(Protocol):
    """What every search offers."""

    segments: Segments

    def query(self, feature: np.ndarray, k: int, hint: Any = None, forbidden: int | None = None
              ) -> tuple[np.ndarray, np.ndarray, Any]:
        """The k segments nearest to a feature vector (F,), nearest first: numbers (k,) int64 and distances (k,) float32.

        hint: what the query of the frame before returned last, or None. forbidden: a recording of
        which, and of whose mirror image, nothing is to be found. Fewer than k come back where there
        are no more.
        """
        ...


class Exact:
    """Looks at every segment."""

    def __init__(self, segments: Segments):
        self.segments = segments
        self._all = np.arange(len(segments))

    def query(self, feature: np.ndarray, k: int, hint: Any = None, forbidden: int | None = None
              ) -> tuple[np.ndarray, np.ndarray, Any]:
        """See `Search`; there is no hint."""
        first, end = self.segments.span(forbidden)
        which = self._all if first == end else np.concatenate([self._all[:first], self._all[end:]])
        return *ranked(self.segments, feature, which, k), None


def ranked(segments: Segments, feature: np.ndarray, which: np.ndarray, k: int) -> tuple[np.ndarray, np.ndarray]:
    """The k nearest of some segments (C,): numbers (k,) and distances (k,), by the exact distance."""
    squared = segments.squared_distances(feature, which)
    if k < len(which):
        near = np.argpartition(squared, k)[:k]
        which, squared = which[near], squared[near]
    order = np.argsort(squared, kind="stable")
    return which[order], np.sqrt(squared[order])


@dataclass(frozen=True, eq=False)
class Projection:
    """The principal directions of the features. mean: (F,). basis: (F, dimensions), orthonormal; float32."""

    mean: np.ndarray
    basis: np.ndarray

    @staticmethod
    def of(segments: Segments, dimensions: int = DIMENSIONS) -> Projection:
        """Told from some of the segments, evenly spread."""
        step = max(1, len(segments) // _SAMPLE)
        sample = segments.features(np.arange(0, len(segments), step))
        mean = sample.mean(0)
        _, vectors = np.linalg.eigh((sample - mean).T @ (sample - mean))
        return Projection(mean, np.ascontiguousarray(vectors[:, :-dimensions - 1:-1]))

    def __call__(self, features: np.ndarray) -> np.ndarray:
        """Coordinates (..., dimensions) of features (..., F)."""
        return (features - self.mean) @ self.basis

    def all(self, segments: Segments) -> np.ndarray:
        """Coordinates (W, dimensions) of all segments."""
        out = np.empty((len(segments), self.basis.shape[1]), np.float32)
        for start in range(0, len(segments), _CHUNK):
            chunk = np.arange(start, min(start + _CHUNK, len(segments)))
            out[chunk] = self(segments.features(chunk))
        return out
