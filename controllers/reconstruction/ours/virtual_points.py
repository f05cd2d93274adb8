"""Ours for trackers that tell how they are turned: each is three virtual points, its place and one along each of two of its axes.

A joint's place and turn are a triangle's three corners, no more and no less. So networks, neighbours and the solver hear turns by being
shown points alone, and where a turn is not told two points are lost, which all of them know what to do about.

Its feet stay where they came down while they stand, and they stand where those of most of the neighbours do.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from ...body import Pose
from ..control_points import ControlPoints
from ..database import Database, contacts, kept
from ..following import Starts
from ..footing import Feet, Footing
from ..regression import Near
from .combined import Ours, Progress, Remembered, ours

ARM = 0.2
"""How far the virtual points lie from the joint [m]: met to a centimetre, as all points are, they tell its turn to three degrees."""
_CORNERS = ARM * np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])


def virtual(controls: ControlPoints) -> ControlPoints:
    """The three virtual points of each of n trackers, 3n in all."""
    names = tuple(f"{name}{corner}" for name in controls.names for corner in ("", " across", " ahead"))
    return ControlPoints(names, np.repeat(controls.joints, 3), (controls.offsets[:, None] + _CORNERS).reshape(-1, 3))


def carried(points: np.ndarray, turns: np.ndarray) -> np.ndarray:
    """Where the virtual points (3n, 3) [m] of trackers at points (n, 3) with turns (n, 3, 3) are; NaN where that is not told."""
    corners = points[:, None] + np.einsum("nij,kj->nki", turns, _CORNERS)
    corners[:, 0] = points
    return corners.reshape(-1, 3)


@dataclass(frozen=True, eq=False)
class Standing:
    """ours: what the method remembers. feet: where feet stand."""

    ours: Remembered
    feet: Feet


@dataclass(frozen=True, eq=False)
class Turning:
    """Ours for n trackers whose turns are told. method: of their virtual points, the last of whose priors is a local one. starts: where it begins from
    nothing. contacts: (N, 4) bool, which soles stand in each of the frames that it learnt from."""

    method: Ours
    starts: Starts
    contacts: np.ndarray
    hears_turns = True

    def begin(self, frames: np.ndarray, tracks: np.ndarray) -> Standing:
        """See `Method.begin`."""
        return Standing(self.method.begin(frames, tracks), Feet.none())

    def step(self, memory: Standing, points: np.ndarray, turns: np.ndarray | None = None) -> tuple[Standing, Pose]:
        """The pose a frame later, for trackers at points (n, 3) [m] in the world with turns (n, 3, 3) of their joints, NaN where not known."""
        points, turns = _told(points, turns)
        after, pose = self.method.step(memory.ours, carried(points, turns))
        near: Near = after.method.hint[-1]
        told = self._footing.told(self.starts.controls.joints[::3], points)
        standing = np.where(np.repeat(told, 2), 0.0, self.contacts[near.frames].mean(0))  # places that are told are met better than held
        feet, pose = self._footing.step(memory.feet, pose, standing, told, self.method.method.solver.dt)
        return Standing(after, feet), pose

    def find(self, points: np.ndarray, velocities: np.ndarray | None = None, turns: np.ndarray | None = None
             ) -> tuple[np.ndarray, np.ndarray]:
        """See `following.Beginning`: the recorded moment whose trackers are placed and turned most like these."""
        points, turns = _told(points, turns)
        return self.starts.find(carried(points, turns), None if velocities is None else np.repeat(velocities, 3, axis=0))

    @cached_property
    def _footing(self) -> Footing:
        """Who plants feet."""
        return Footing(self.method.method.solver.skeleton)


def _told(points, turns):
    points = np.asarray(points, float)
    return points, np.full((len(points), 3, 3), np.nan) if turns is None else np.asarray(turns, float)


def turning(database: Database, controls: ControlPoints, *, progress: Progress | None = None) -> Turning:
    """The method for some trackers that tell how they are turned, learnt from a database on the first call, and kept on disk."""
    points = virtual(controls)
    stands = kept("contacts", database, (), lambda: contacts(database), _save, _load, ("pose_vector.py", "database/contacts.py"))
    return Turning(ours(database, points, progress=progress), Starts.of(database, points), stands)


def _save(stands: np.ndarray, path: Path) -> None:
    with path.open("wb") as file:
        np.save(file, np.packbits(stands, axis=-1))


def _load(path: Path) -> np.ndarray:
    with path.open("rb") as file:
        return np.unpackbits(np.load(file), axis=-1, count=4).astype(bool)
