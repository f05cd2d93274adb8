"""Segments: some frames of the past and the frame that came next, as the local models learn from them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class Neighbourhood:
    """The K recorded segments nearest to a query: what a local model is learnt from.

    X: (K, P) float32 features of the past frames, weighted as the query is (`features`).
    Y: (K, D) float32 the frame that followed each, as in `chart`: joints and root.
    distances: (K,) float32, of X from the query, ascending. indices: (K,) int64 the segments' numbers.
    """

    X: np.ndarray
    Y: np.ndarray
    distances: np.ndarray
    indices: np.ndarray
