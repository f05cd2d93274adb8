"""Our own way to reconstruct: a network that sees the points' last half second, and what the nearest recordings say."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..body import Pose, Skeleton
from .baselines.regressors import Layers, network
from .baselines.windows import Samples
from .chart import SKELETON
from .controls import Controls
from .database import Database
from .method import Fused, Local, LocalRegression, Memory, Method
from .neighbours_cells import Cells
from .prior import Regression
from .segments import Segments
from .solver import Solver
from .store import kept

Progress = Callable[[str, int, int], None]
"""Called with what is being done, how much of it is, and of how much."""
_SOURCES = ("ours.py", "chart.py", "baselines/regressors.py", "baselines/windows.py")
_BATCHES = 6000


def cells(database: Database, controls: Controls, m: int = 3, stride: int = 4) -> Cells:
    """A database's segments with these points, to search; made on the first call."""
    segments = Segments.of(database, m, stride, controls.joints)
    return kept("cells", database, (m, stride, controls.joints.tolist()), lambda: Cells(segments), Cells.save,
                lambda path: Cells.load(path, segments),
                ("chart.py", "segments.py", "features.py", "neighbours.py", "neighbours_cells.py"))


@dataclass(frozen=True, eq=False)
class Ours:
    """What is offered: a method, like any other. method: what it does."""

    method: Method

    def begin(self, frames: np.ndarray, tracks: np.ndarray) -> Memory:
        """See `Method.begin`."""
        return self.method.begin(frames, tracks)

    def step(self, memory: Memory, points: np.ndarray) -> tuple[Memory, Pose]:
        """See `Method.step`."""
        return self.method.step(memory, points)


def ours(database: Database, controls: Controls, *, skeleton: Skeleton = SKELETON, progress: Progress | None = None) -> Ours:
    """The method for some control points, learnt from a database on the first call, and kept on disk."""
    solver = Solver(controls, 1 / database.fps, skeleton=skeleton)

    def learn():
        told = None if progress is None else lambda batch, _: progress("learning", batch + 1, _BATCHES)
        return network(Samples.of(database, Solver(controls, 1 / database.fps)), batches=_BATCHES, progress=told)
    told = (controls.joints.tolist(), controls.offsets.tolist())
    net = kept("network", database, told, learn, Layers.save, Layers.load, _SOURCES)
    near = Local(LocalRegression(Regression(covariance="full")), cells(database, controls))
    return Ours(Method(Fused((near, net)), solver))
