"""Nearest segments by Faiss: inverted lists whose centres lie in a neighbour graph, for millions of poses (Douze et al. 2024).

It finds what `Cells` finds in a tenth of the time where there are ten million; below three million nobody needs it. Faiss is
installed with `pip install -e ".[search]"`.
"""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from .search import Projection, ranked
from .segments import Segments

MANY = 3_000_000
"""From so many segments on it is worth having."""
_PER_LIST = 40  # segments a list that k-means looks at
_CHUNK = 1 << 18


def at_hand() -> bool:
    """Whether Faiss is installed."""
    return find_spec("faiss") is not None


def _faiss() -> Any:
    return import_module("faiss")  # which says nothing of its types, and takes a moment to load


class Lists:
    """Inverted lists over principal components. ImportError where Faiss is not installed.

    lists: how many; by default 5 √W. probes: how many of them are searched. candidates: how many are ranked again by the exact
    distance, at least four times as many as wanted. There is no hint: a query needs none.
    """

    def __init__(self, segments: Segments, lists: int | None = None, probes: int = 32, candidates: int = 600):
        faiss = _faiss()

        self.segments, self.probes, self.candidates = segments, probes, candidates
        self.projection = Projection.of(segments)
        points = self.projection.all(segments)
        count = min(round(5.0 * len(points) ** 0.5) if lists is None else lists, max(len(points) // _PER_LIST, 1))
        self.index = faiss.index_factory(points.shape[1], f"IVF{count}_HNSW32,Flat")
        self.index.cp.min_points_per_centroid = 1  # a few segments are no mistake
        self.index.train(points[np.random.default_rng(0).permutation(len(points))[:_PER_LIST * count]])
        for start in range(0, len(points), _CHUNK):
            self.index.add(points[start:start + _CHUNK])

    def save(self, path: str | Path) -> None:
        """Write it into a folder of its own."""
        faiss = _faiss()

        Path(path).mkdir()
        faiss.write_index(self.index, str(Path(path) / "lists"))
        np.savez(Path(path) / "about.npz", mean=self.projection.mean, basis=self.projection.basis, about=[self.probes, self.candidates])

    @staticmethod
    def load(path: str | Path, segments: Segments) -> Lists:
        """Read what `save` wrote of the same segments. OSError or ValueError for anything else."""
        faiss = _faiss()

        found = object.__new__(Lists)
        with np.load(Path(path) / "about.npz") as file:
            found.segments, found.projection = segments, Projection(file["mean"], file["basis"])
            found.probes, found.candidates = (int(number) for number in file["about"])
        try:
            found.index = faiss.read_index(str(Path(path) / "lists"))
        except RuntimeError as error:  # all that Faiss says of a broken file
            raise ValueError(f"{path}: is no index: {error}") from None
        if found.index.ntotal != len(segments):
            raise ValueError(f"{path}: is no index of these segments")
        return found

    def query(self, feature: np.ndarray, k: int, hint: Any = None, forbidden: int | None = None
              ) -> tuple[np.ndarray, np.ndarray, Any]:
        """See `neighbours.Search`; there is no hint."""
        faiss = _faiss()

        first, end = self.segments.span(forbidden)
        allowed = faiss.IDSelectorNot(faiss.IDSelectorRange(first, end))
        point, wanted, probes = self.projection(feature)[None].astype(np.float32), max(self.candidates, 4 * k), self.probes
        while True:
            how = faiss.SearchParametersHNSW(efSearch=max(64, probes))
            _, found = self.index.search(point, wanted, params=faiss.SearchParametersIVF(sel=allowed, nprobe=probes, quantizer_params=how))
            found = found[0][found[0] >= 0]
            if len(found) >= wanted or probes >= self.index.nlist:
                return *ranked(self.segments, feature, found, k), None
            probes = min(4 * probes, self.index.nlist)  # next to nothing was allowed there
