"""What a global regressor sees, the last half second of the control points, and samples of it to learn from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...body import forward_kinematics
from ..database import Database
from ..pose_vector import FORWARD, LEFTWARD, YAW_RATE, decode
from ..regression import Memory, Solver, on_ground

LAGS = (0, 2, 4, 8, 16, 30)
"""How many frames before the coming one the points are looked at."""
ASIDE, ASTRAY = 0.028, 0.08
"""How far off [m] and turned [rad], at most, the newest root is taken to be in half of the samples: as it will be found
when the regressor runs on its own output."""


def window(memory: Memory, seen: np.ndarray) -> np.ndarray:
    """The input (len(LAGS) · n · 3,) for the coming frame: points seen from the ground of the newest one."""
    points = np.stack([seen if lag == 0 else memory.points[lag - 1] for lag in LAGS])
    return on_ground(points, memory.track).ravel()


@dataclass(frozen=True, eq=False)
class Samples:
    """Frames to learn from. points: (N, n, 3) [m] in the world. tracks: (N, 3). frames: (N, D), the database's own, mapped.

    which: (S,) numbers of frames that have one before them. first: (S,) the first frame of each one's take, and
    recording: (S,) what it is of. dt: seconds between frames.
    """

    points: np.ndarray
    tracks: np.ndarray
    frames: np.ndarray
    which: np.ndarray
    first: np.ndarray
    recording: np.ndarray
    dt: float

    @staticmethod
    def of(database: Database, solver: Solver) -> Samples:
        """All sound frames of a database's takes; the control points are the solver's."""
        count = len(database.frames)
        points, tracks = np.empty((count, len(solver.controls), 3)), np.empty((count, 3))
        which, first, recording = [], [], []
        for take in database.takes:
            there = slice(take.start, take.stop)
            points[there], tracks[there] = _of_take(database.frames[there].astype(float), solver)
            sound = database.sound[there]
            good = take.start + 1 + np.flatnonzero(sound[1:] & sound[:-1])
            which.append(good)
            first.append(np.full(len(good), take.start))
            recording.append(np.full(len(good), take.recording))
        return Samples(points, tracks, database.frames, np.concatenate(which), np.concatenate(first),
                       np.concatenate(recording), solver.dt)

    def __len__(self) -> int:
        return len(self.which)

    def draw(self, chosen: np.ndarray, rng: np.random.Generator | None = None) -> tuple[np.ndarray, np.ndarray]:
        """Inputs (B, len(LAGS) · n · 3) and the frames (B, D) to predict, of chosen samples (B,).

        With an rng, half of them are astray.
        """
        at, first = self.which[chosen], self.first[chosen]
        ground, goals = self.tracks[at - 1].copy(), self.frames[at].astype(float)
        if rng is not None:
            off = rng.uniform(-1.0, 1.0, (len(at), 3)) * [ASIDE, ASIDE, ASTRAY] * (rng.random((len(at), 1)) < 0.5)
            ground += off
            way = on_ground(np.stack([self.tracks[at, 0], np.zeros(len(at)), self.tracks[at, 1]], -1)[:, None], ground)[:, 0]
            goals[:, LEFTWARD], goals[:, FORWARD] = way[:, 0] / self.dt, way[:, 2] / self.dt
            goals[:, YAW_RATE] -= off[:, 2] / self.dt
        past = np.maximum(at[:, None] - np.array(LAGS), first[:, None])
        seen = on_ground(self.points[past], ground[:, None])
        return seen.reshape(len(at), -1), goals


def _of_take(frames, solver):
    """Points and tracks of one take, which begins at the origin."""
    rates = frames * solver.dt
    heading = np.concatenate([[0.0], np.cumsum(rates[1:, YAW_RATE])])
    c, s = np.cos(heading[:-1]), np.sin(heading[:-1])
    forward, left = rates[1:, FORWARD], rates[1:, LEFTWARD]
    way = np.stack([s * forward + c * left, c * forward - s * left], -1)
    tracks = np.concatenate([np.concatenate([np.zeros((1, 2)), np.cumsum(way, 0)]), heading[:, None]], -1)
    points = solver.controls.on(*forward_kinematics(solver.skeleton, *decode(frames, tracks)))
    return points, tracks
