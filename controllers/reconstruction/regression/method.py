"""Reconstruction frame by frame: a prior for the coming pose, the solver, and what is remembered.

Every method, ours and those it is measured against, is a `Method` with a prior of its own; so all get the same
points, the same solver and the same past, their own output.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np

from ...body import Pose
from ..neighbours import Neighbourhood, Segments
from ..pose_vector import JOINTS, REFERENCE, SKELETON, YAW_RATE, advance
from .beliefs import Gaussian, fuse
from .frame_kernel import pose_kernel
from .local_regression import Regression, regress
from .map_solver import Solver, in_world, on_ground

SPAN = 31
"""How many frames are remembered: half a second at 60 Hz, and the newest."""


@dataclass(frozen=True, eq=False)
class Memory:
    """What was reconstructed last. frames: (SPAN, D) of the chart, newest first. track: (3,) the newest one's ground track.

    points: (SPAN, n, 3) [m] world places of the control points, newest first: as they were seen, and where they
    were not, as the body has them. known: (SPAN, n) bool, which were seen. hint: what the prior wants to know again
    in the next frame.
    """

    frames: np.ndarray
    track: np.ndarray
    points: np.ndarray
    known: np.ndarray
    hint: Any = None


class Prior(Protocol):
    """What makes one method differ from another."""

    def believe(self, memory: Memory, seen: np.ndarray, goals: np.ndarray) -> tuple[Gaussian, Any]:
        """The belief about the coming frame, and the next hint.

        seen: (n, 3) [m] the points in the world, those missing guessed. goals: (n, 3) the same seen from the ground
        of the newest frame, NaN where missing.
        """
        ...


@dataclass(frozen=True, eq=False)
class Method:
    """A way to reconstruct. prior: what it believes of poses. solver: how it meets the points."""

    prior: Prior
    solver: Solver

    def begin(self, frames: np.ndarray, tracks: np.ndarray) -> Memory:
        """The memory after known frames (T, D) of the chart with ground tracks (T, 3), the newest last.

        Fewer than `SPAN` are taken to have stood still before.
        """
        which = np.maximum(np.arange(len(frames) - 1, len(frames) - 1 - SPAN, -1), 0)
        frames, tracks = np.asarray(frames, float)[which], np.asarray(tracks, float)[which]
        points = np.stack([self._places(frame, track) for frame, track in zip(frames, tracks, strict=True)])
        return Memory(frames, tracks[0], points, np.ones(points.shape[:2], bool))

    def step(self, memory: Memory, points: np.ndarray) -> tuple[Memory, Pose]:
        """The pose a frame later, for control points (n, 3) [m] in the world, NaN where one is not seen."""
        memory = self.follow(memory, points)
        return memory, posed(memory.frames[0], memory.track)

    def follow(self, memory: Memory, points: np.ndarray) -> Memory:
        """As `step`, for those who want no pose: it is the memory's newest frame."""
        goals = on_ground(np.asarray(points, float), memory.track)
        lost = ~np.all(np.isfinite(goals), axis=-1)
        seen = np.array(points, float)
        if lost.any():  # guessed to go on with the body
            carried = advance(memory.track, memory.frames[0], self.solver.dt)
            seen[lost] = in_world(on_ground(memory.points[0], memory.track), carried)[lost]
        belief, hint = self.prior.believe(memory, seen, goals)
        frame = self.solver.solve(belief, goals).frame
        track = advance(memory.track, frame, self.solver.dt)
        if lost.any():
            seen[lost] = self._places(frame, track)[lost]
        return Memory(np.concatenate([frame[None], memory.frames[:-1]]), track,
                      np.concatenate([seen[None], memory.points[:-1]]),
                      np.concatenate([~lost[None], memory.known[:-1]]), hint)

    def _places(self, frame, track):
        """World places (n, 3) of the points of a frame at its track."""
        still = frame.copy()
        still[YAW_RATE:] = 0.0
        return in_world(self.solver.points(still)[0], track)


_FIRST = np.full(len(SKELETON), -1, np.int64)
_FIRST[JOINTS] = 3 * np.arange(len(JOINTS))


def posed(frame: np.ndarray, track: np.ndarray) -> Pose:
    """The pose of one frame (D,) at its track (3,): `chart.decode`, quicker."""
    root, rotations = np.empty(3), np.empty((len(SKELETON), 3, 3))
    pose_kernel(np.array(frame, float), np.array(track, float), REFERENCE, _FIRST, root, rotations)
    return Pose(root, rotations)


class LocalModel(Protocol):
    """What is learnt from a neighbourhood."""

    def believe(self, feature: np.ndarray, near: Neighbourhood, memory: Memory) -> Gaussian:
        """The belief about the frame after a query (P,)."""
        ...


@dataclass(frozen=True, eq=False)
class Near:
    """What a local prior found last. hint: the search's. frames: (K,) the numbers of the recorded frames that follow the segments."""

    hint: Any
    frames: np.ndarray


@dataclass(frozen=True, eq=False)
class Local:
    """The prior of all local methods: a model learnt, for each frame anew, from the nearest recorded segments. Its hint is a `Near`.

    search: one of `neighbours`, over its segments. count: K. forbidden: a recording never to be found.
    """

    model: LocalModel
    search: Any
    count: int = 100
    forbidden: int | None = None

    def believe(self, memory: Memory, seen: np.ndarray, goals: np.ndarray) -> tuple[Gaussian, Any]:
        """See `Prior`."""
        segments: Segments = self.search.segments
        past = memory.frames[:segments.stride * segments.m:segments.stride]
        feature = segments.query(past, seen, memory.points[0], memory.track)
        last: Near | None = memory.hint
        near, hint = segments.neighbourhood(self.search, feature, self.count, None if last is None else last.hint, self.forbidden)
        return self.model.believe(feature, near, memory), Near(hint, segments.last[near.indices] + 1)


@dataclass(frozen=True, eq=False)
class LocalRegression:
    """The paper's model, and ours, according to the settings.

    reach: the median distance of neighbours beyond which they are believed less and less. What is left out of a
    neighbourhood to tell its errors lies among the others; a query that lies far from all of them errs far more.
    """

    how: Regression
    reach: float = np.inf

    def believe(self, feature: np.ndarray, near: Neighbourhood, memory: Memory) -> Gaussian:
        """See `LocalModel`."""
        belief = regress(feature, near.X, near.Y, near.distances, self.how)
        far = float(near.distances[len(near.distances) // 2]) / self.reach
        return belief.loosened(1.0 + far ** 4) if far > 0.0 else belief


@dataclass(frozen=True, eq=False)
class Fused:
    """Several priors, taken for independent."""

    priors: tuple[Prior, ...]

    def believe(self, memory: Memory, seen: np.ndarray, goals: np.ndarray) -> tuple[Gaussian, Any]:
        """See `Prior`; the hint has one part for each."""
        hints = memory.hint or (None,) * len(self.priors)
        beliefs, hints = zip(*(prior.believe(replace(memory, hint=hint), seen, goals)
                               for prior, hint in zip(self.priors, hints, strict=True)), strict=True)
        return fuse(*beliefs), hints
