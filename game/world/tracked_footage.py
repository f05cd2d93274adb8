"""A performer who was filmed: a controller that wants nothing and goes as a tracker makes it out of footage, frame by frame."""

from __future__ import annotations

import hashlib
import math
from copy import copy
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from gambol.controllers.body import Pose, Skeleton, forward_kinematics, heading_of
from gambol.controllers.contract import CharacterState, Controller, Intent, Sighting, Status

if TYPE_CHECKING:  # what tracks is loaded by the functions that need it: a game without cameras starts without
    from gambol.controllers.tracking import Watching
    from gambol.controllers.tracking.silhouettes import Surface
    from gambol.controllers.tracking.twists import Configuration

    from ..footage import Footage

STEPS = 60
"""Of the world, in a second."""


@dataclass(frozen=True, eq=False)
class Filming:
    """Where somebody is in footage. number: steps since the first. beside: (3,) [m] from whoever was filmed. watching: of the tracker."""

    number: int
    beside: np.ndarray
    watching: Watching


class Filmed(Controller):
    """Goes as whoever was filmed, from the first frames to the last, and stays there.

    start: the poses of the first frame, or of the first two. person: whose masks, where `masks` are followed instead of pictures.
    walker: what walks for those who follow it, when it is gone. One step is a sixtieth of a second.
    """

    def __init__(self, footage: Footage, surface: Surface, start: tuple[Configuration, ...], walker: Any, person: int = 0, masks: bool = False):
        from gambol.controllers.tracking import Tracker

        self.footage, self.poses, self.walker, self.person, self.masks = footage, start, walker, person, masks
        self.tracker = Tracker(surface, footage.lenses, float(min(footage.fps, STEPS)))

    @staticmethod
    def load(folder: str | Path, walker: Any, person: str | None = None, start: Path | None = None, masks: bool = False) -> Filmed:
        """Somebody in a folder of footage. start: a motion file whose first frames are the poses to begin with, or a .toml file of
        where joints are seen; the truth's by default. FootageError, MotionFileError or ClickError, naming what can't be used."""
        from gambol.controllers.tracking import Tracker

        from ..footage import checked, clicked_pose, first_poses, person_in, read_footage, settled
        from ..meshes import surface_of

        footage = read_footage(folder)
        who = person_in(footage, person)
        footage = checked(footage, masks)
        if start is not None and start.suffix.lower() == ".toml":
            surface, pose = clicked_pose(footage, start)
            begun = (settled(footage, Tracker(surface, footage.lenses, float(footage.fps)), pose, who, masks),)
        else:
            surface = surface_of(freedom="full", level="middle")
            begun = first_poses(footage, surface, who, start)
        return Filmed(footage, surface, begun, walker, who, masks)

    def switched(self) -> Filmed:
        """The same with the penalty on jitter off, or on again."""
        other, settings = copy(self), self.tracker.settings
        other.tracker = replace(self.tracker, settings=replace(settings, penalty=not settings.penalty))
        return other

    @property
    def kind(self) -> str:
        """What tells its motion from that of others: cameras and every picture's file, the first poses, whom, and how."""
        told = hashlib.sha256(f"{self.person} {self.masks} {self.tracker.settings} {len(self.tracker.surface.vertices)}".encode())
        for lens in self.footage.lenses:
            told.update(lens.numbers.tobytes())
            for number in range(self.footage.frames):
                file = self.footage.file(lens.name, "mask" if self.masks else "frame", number)
                told.update(f"{number} {file.stat().st_size if file.exists() else None}".encode())
        for pose in self.poses:
            told.update(pose.root.tobytes() + pose.angles.tobytes())
        return "Filmed " + told.hexdigest()[:16]

    @property
    def skeleton(self) -> Skeleton:
        """That of whoever is tracked."""
        return self.tracker.surface.chain.skeleton

    def start(self, ground=None, floor: np.ndarray | float = 0.0, beside: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> CharacterState:
        """The first pose, `beside` [m] from where it was filmed; for a ground x, z [m] over that, turned as it was filmed."""
        from gambol.controllers.tracking.twists import local_turns

        chain, aside = self.tracker.surface.chain, np.array(beside, float)
        shown = [local_turns(chain, pose) for pose in self.poses]
        middle, heading = self._ground(shown[-1])
        if ground is not None:
            aside = aside + [float(ground[0]) - middle[0], float(floor), float(ground[1]) - middle[1]]
        poses = [Pose(pose.root + aside, pose.rotations) for pose in shown]
        state = CharacterState(np.array([middle[0] + aside[0], middle[1] + aside[2], heading]), np.zeros(3), poses[-1], np.zeros(4, bool), None,
                               float(floor), poses[0] if len(poses) > 1 else None, float(1 / self.footage.fps) if len(poses) > 1 else 0.0)
        entered = self._tracking(aside).enter(state, Intent())
        return replace(entered, memory=Filming(0, aside, entered.memory))

    def step(self, state: CharacterState, intent: Intent, dt: float) -> tuple[CharacterState, Pose]:
        """A sixtieth of a second on, whatever is wanted."""
        filming, sighting = state.memory, None
        now = self.frame(filming.number + 1)
        if now != self.frame(filming.number) and now < self.footage.frames:
            sighting = Sighting(self.seen(now), np.zeros(3))
        after, pose = self._tracking(filming.beside).step(replace(state, memory=filming.watching), Intent(sighting=sighting), dt)
        return replace(after, memory=Filming(filming.number + 1, filming.beside, after.memory), previous=state.pose, elapsed=dt), pose

    def frame(self, number: int) -> int:
        """The last frame that was seen after so many steps; beyond the last one where all were."""
        return len(self.poses) - 1 - (-number * self.footage.fps // STEPS)

    def seen(self, frame: int) -> list[np.ndarray | None]:
        """What each camera has of a frame. FootageError."""
        from ..footage import seen_in

        return seen_in(self.footage, frame, self.person, self.masks)

    def precondition(self, state: CharacterState, intent: Intent) -> float:
        """It goes on until its last frame."""
        return 1.0

    def enter(self, state: CharacterState, intent: Intent) -> CharacterState:
        """A state of its own, as it is, or the first pose where the body stands."""
        return state if isinstance(state.memory, Filming) else self.start(state.ground, state.floor)

    def status(self, state: CharacterState) -> Status:
        """Done at the last frame."""
        return Status("done" if self.frame(state.memory.number) >= self.footage.frames - 1 else "running")

    def _tracking(self, beside: np.ndarray):
        from gambol.controllers.tracking import Tracking

        return Tracking(self.tracker, beside)

    def _ground(self, pose: Pose) -> tuple[np.ndarray, float]:
        """Where somebody is: x, z of the middle of the shoulders [m], and the heading [rad]."""
        positions, orientations = forward_kinematics(self.skeleton, pose.root, np.asarray(pose.rotations, float))
        arms = positions[[self.skeleton.index("LeftArm"), self.skeleton.index("RightArm")]].mean(0)
        return arms[[0, 2]], math.remainder(float(heading_of(orientations[0] @ [0.0, 0.0, 1.0])), math.tau)
