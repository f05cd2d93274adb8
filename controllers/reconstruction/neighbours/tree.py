"""Nearest segments by a k-d tree over principal components, ranked again by the exact distance."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.spatial import cKDTree  # pyright: ignore[reportAttributeAccessIssue]  # compiled, and without hints

from .search import Projection, ranked
from .segments import Segments


class Tree:
    """A k-d tree of scipy's.

    candidates: how many are ranked again, at least four times as many as wanted. slack: how much
    further than the nearest a candidate may be, in parts (scipy's eps).
    """

    def __init__(self, segments: Segments, candidates: int = 400, slack: float = 0.5):
        self.segments, self.candidates, self.slack = segments, candidates, slack
        self.projection = Projection.of(segments)
        self.tree = cKDTree(self.projection.all(segments))

    def query(self, feature: np.ndarray, k: int, hint: Any = None, forbidden: int | None = None
              ) -> tuple[np.ndarray, np.ndarray, Any]:
        """See `neighbours.Search`; there is no hint."""
        point = self.projection(feature)
        first, end = self.segments.span(forbidden)
        wanted = max(self.candidates, 4 * k)
        asked = wanted
        while True:
            asked = min(asked, len(self.segments))
            _, found = self.tree.query(point, range(1, asked + 1), eps=self.slack)
            found = found[(found < first) | (found >= end)]
            if len(found) >= wanted or asked == len(self.segments):
                return *ranked(self.segments, feature, found, k), None
            asked *= 4
