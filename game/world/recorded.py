"""A performer that plays a recorded clip: a controller that wants nothing and goes where the recording went."""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from gambol.controllers.body import (HEIGHT_GATE, WALK_SPEEDS, Clip, Pose, Skeleton, contact_height, contact_points, human,
                                     point_speeds, yaw)
from gambol.controllers.contract import CharacterState, Controller, Intent, Status

FPS = 60.0
LEAST = 4
"""A performance has so many frames at least, and lasts as long as they do."""
SKELETON = human()


@dataclass(frozen=True)
class Playing:
    """Where somebody is in a clip. number: of the frame. place: x, z [m] and heading [rad] that its first one is put at."""

    number: int
    place: tuple[float, float, float]


class Recorded(Controller):
    """Plays a clip from its first frame and stays at its last.

    clip: at 60 frames a second on the standard human. walker: what walks for those who follow it, when it is gone.
    """

    def __init__(self, clip: Clip, walker: Any):
        from gambol.controllers.reconstruction import encode  # a game without a clip starts without

        self.clip, self.walker = clip, walker
        frames, self._track = encode(clip.root, clip.rotations, clip.frame_time)
        rotations = np.asarray(clip.rotations, float)
        origin, heading = self._track[0, :2], self._track[0, 2]
        turn = yaw(np.array(-heading))
        root = clip.root - [origin[0], 0.0, origin[1]]
        rotations[:, 0] = turn @ rotations[:, 0]
        self.root, self.rotations = root @ turn.T, rotations
        soles = contact_points(SKELETON, *clip.kinematics())
        low = soles[..., 1] - contact_height(SKELETON) < HEIGHT_GATE
        self._stands = low & (point_speeds(soles, clip.frame_time) < WALK_SPEEDS)
        self._rates = frames[:, [-2, -3, -1]]  # forward, yaw rate, leftward

    @staticmethod
    def load(path: str | Path, walker: Any, reading: Any = None) -> Recorded:
        """A .bvh or .amc file on the standard human, feet on the floor. reading: a `mocap.Reading`, where its axes or unit are known. MotionFileError, naming it, if it can't be used."""
        return Recorded(performance(path, reading), walker)

    @property
    def kind(self) -> str:
        """What tells its motion from that of others."""
        return "Recorded " + hashlib.sha256(np.ascontiguousarray(self.root).data).hexdigest()[:16]

    @property
    def skeleton(self) -> Skeleton:
        """The standard human."""
        return SKELETON

    def start(self, ground=(0.0, 0.0, 0.0), floor: np.ndarray | float = 0.0) -> CharacterState:
        """The first frame at ground x, z [m], heading [rad], on a floor so high [m]."""
        x, z, heading = (float(v) for v in ground)
        return self._at(Playing(0, (x, z, heading)), floor, None)

    def step(self, state: CharacterState, intent: Intent, dt: float) -> tuple[CharacterState, Pose]:
        """The next frame, whatever is wanted; dt is a frame."""
        playing = state.memory
        after = self._at(Playing(min(playing.number + 1, len(self.root) - 1), playing.place), state.floor, state.pose)
        return after, after.pose

    def precondition(self, state: CharacterState, intent: Intent) -> float:
        """It goes on until its last frame."""
        return 1.0

    def enter(self, state: CharacterState, intent: Intent) -> CharacterState:
        """A state of its own, as it is, or the first frame where the body stands."""
        return state if isinstance(state.memory, Playing) else self.start(state.ground, state.floor)

    def status(self, state: CharacterState) -> Status:
        """Done at the last frame."""
        return Status("done" if state.memory.number == len(self.root) - 1 else "running")

    def _at(self, playing: Playing, floor: np.ndarray | float, previous: Pose | None) -> CharacterState:
        x, z, heading = playing.place
        k, turn = playing.number, yaw(np.array(heading))
        rotations = self.rotations[k].copy()
        rotations[0] = turn @ rotations[0]
        root = turn @ self.root[k] + [x, float(floor), z]
        facing = heading + float(self._track[k, 2] - self._track[0, 2])
        ground = np.array([root[0], root[2], math.remainder(facing, math.tau)])
        return CharacterState(ground, self._rates[k].copy(), Pose(root, rotations), self._stands[k], playing, floor,
                              previous, 0.0 if previous is None else 1.0 / FPS)


def performance(path: str | Path, reading: Any = None) -> Clip:
    """A motion file at 60 frames a second on the standard human, feet on the floor. reading: a `mocap.Reading`, where its axes or unit are known. MotionFileError, naming it,
    if it can't be used."""
    from gambol.controllers.mocap import JUDGED, MotionFileError, hinged, retarget

    clip = (reading or JUDGED).load(path)
    if len(clip) < LEAST or clip.duration * FPS < LEAST - 1.01:
        raise MotionFileError(f"{path}: {len(clip)} frames in {clip.duration:.3g} s are too few; a performance needs {LEAST} in {(LEAST - 1) / FPS:g} s at least")
    try:
        return hinged(retarget(clip)).resample(FPS, smooth=True)
    except ValueError as error:
        raise MotionFileError(f"{path}: {error}") from None
