"""How to begin with nothing but points: the recorded moment whose points are most like them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ...body import carried, forward_kinematics, yaw
from ..control_points import ControlPoints
from ..database import Database
from ..pose_vector import SKELETON, YAW_RATE, advance, decode
from ..regression import SPAN, in_world

MOST = 20_000
"""So many moments of a database are looked at."""
PACE = 0.1
"""A velocity that is wrong by 1 m/s counts as much as a place that is wrong by this [m]."""


class Beginning(Protocol):
    """What knows poses to begin from: `Starts`, or whatever is used like it."""

    def find(self, points: np.ndarray, velocities: np.ndarray | None = None, turns: np.ndarray | None = None
             ) -> tuple[np.ndarray, np.ndarray]:
        """Frames (T, D) and ground tracks (T, 3) up to a moment with points (n, 3) [m], which move at velocities (n, 3) [m/s] and are
        turned by turns (n, 3, 3), NaN where not known. ValueError if no point is known."""
        ...


@dataclass(frozen=True, eq=False)
class Starts:
    """Moments of a database to begin from. frames: (S,) their numbers. first: (S,) where their takes begin.

    points: (S, n, 3) [m] places of the control points on the moment's own ground. velocities: (S, n, 3) [m/s].
    """

    database: Database
    controls: ControlPoints
    frames: np.ndarray
    first: np.ndarray
    points: np.ndarray
    velocities: np.ndarray

    @staticmethod
    def of(database: Database, controls: ControlPoints) -> Starts:
        """The moments of a database, evenly spread."""
        step = max(1, len(database) // MOST)
        whole = database.segments(2)  # neither across takes nor unsound
        frames = whole[::step]
        starts = np.array([take.start for take in database.takes])
        now, before = (_points(database.frames[frames - k].astype(float), controls) for k in (0, 1))
        newest = database.frames[frames].astype(float)
        before = in_world(before, backed(np.zeros((len(frames), 3)), newest, 1 / database.fps))
        rates = (now - before) * database.fps
        return Starts(database, controls, frames, starts[np.searchsorted(starts, frames, "right") - 1],
                      now.astype(np.float32), rates.astype(np.float32))

    def find(self, points: np.ndarray, velocities: np.ndarray | None = None, turns: np.ndarray | None = None
             ) -> tuple[np.ndarray, np.ndarray]:
        """Frames (≤ SPAN, D) and ground tracks (≤ SPAN, 3) up to the moment most like some points (n, 3) [m].

        Points and velocities (n, 3) [m/s] are in the world, NaN where not known; the tracks end where the points are. Turns tell nothing.
        ValueError if no point is known.
        """
        there = np.isfinite(points).all(-1)
        if not there.any():
            raise ValueError("no point is seen")
        goal, known = points[there], self.points[:, there].astype(float)
        middle, centre = goal.mean(0) * [1, 0, 1], known.mean(1) * [1, 0, 1]
        a, b = known - centre[:, None], goal - middle
        moves = None if velocities is None else np.where(np.isfinite(velocities), velocities, 0.0)[there] * PACE
        rates = self.velocities[:, there] * PACE
        along, across = carried(a, b)
        if moves is not None:
            more = carried(rates, moves)
            along, across = along + more[0], across + more[1]
        heading = np.arctan2(across, along)
        turn = yaw(heading)
        cost = np.sum((a @ np.swapaxes(turn, -1, -2) - b) ** 2, (1, 2))
        if moves is not None:
            cost += np.sum((rates @ np.swapaxes(turn, -1, -2) - moves) ** 2, (1, 2))
        best = int(np.argmin(cost))
        last = int(self.frames[best])
        frames = self.database.frames[max(self.first[best], last - SPAN + 1):last + 1].astype(float)
        spot = middle - turn[best] @ centre[best]
        return frames, _tracks(frames, np.array([spot[0], spot[2], heading[best]]), 1 / self.database.fps)


def _points(frames, controls):
    """Points (S, n, 3) of frames, each on its own ground."""
    return controls.on(*forward_kinematics(SKELETON, *decode(frames, np.zeros((len(frames), 3)))))


def _tracks(frames, newest, dt):
    """The ground tracks (T, 3) of frames whose newest one is at `newest`."""
    tracks = [newest]
    for frame in frames[:0:-1]:
        tracks.insert(0, backed(tracks[0], frame, dt))
    return np.stack(tracks)


def backed(track: np.ndarray, frame: np.ndarray, dt: float) -> np.ndarray:
    """The ground tracks (..., 3) from which frames (..., D) led to `track` (..., 3): the inverse of `pose_vector.advance`."""
    earlier = np.array(track, float)
    earlier[..., 2] -= frame[..., YAW_RATE] * dt
    earlier[..., :2] -= advance(earlier, frame, dt)[..., :2] - earlier[..., :2]
    return earlier
