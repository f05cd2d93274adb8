"""The tracking controller: ``state', pose = tracking.step(state, intent, dt)`` moves a body as `intent.sighting` shows somebody move.

Where pictures come from is nobody's business here: cameras that watch somebody on the stage, or a film. Between two frames of
theirs the body is on its way from the last pose but one to the last.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..body import Pose, exp, log, settle
from ..contract import CharacterState, Controller, Intent, Status, seconds
from ..driven import driven
from .tracker import Track, Tracker, TrackerSettings
from .twists import Configuration, fitted, local_turns

READY, HOLDS = 1.0, 1.2
"""How well it bids when there is a frame; how firmly it holds on while frames come."""
LOST = 0.5
"""Without a frame for so long [s] it is done."""
FADE = 0.1
"""Half-life of the difference between the pose that was taken over and the tracked one [s]."""


@dataclass(frozen=True, eq=False)
class Watching:
    """What is remembered while somebody is watched. track: the tracker's. age: [s] since its newest frame. offset, rate: (1 + J, 3)
    what is added to root and joints until it has settled."""

    track: Track
    age: float
    offset: np.ndarray
    rate: np.ndarray


class Tracking(Controller):
    """Moves a body as cameras see somebody move.

    tracker: of whom. beside: (3,) [m] from whoever is seen to the body that is moved. Pre-condition: the body has nearly the
    pose that is seen; post-condition: it stays where it was seen last. Characters come singly.
    """

    def __init__(self, tracker: Tracker, beside: np.ndarray | tuple[float, float, float] = (0.0, 0.0, 0.0)):
        self.tracker, self.beside = tracker, np.array(beside, float)
        self.skeleton = tracker.surface.chain.skeleton

    @property
    def kind(self) -> str:
        """What tells its motion from that of others."""
        return f"Tracking {len(self.tracker.lenses)} × {self.tracker.rate:g} {self.tracker.settings}"

    @property
    def settings(self) -> TrackerSettings:
        """The tracker's."""
        return self.tracker.settings

    def tuned(self, settings: TrackerSettings) -> Tracking:
        """The same under other settings."""
        return Tracking(replace(self.tracker, settings=settings), self.beside)

    def precondition(self, state: CharacterState, intent: Intent) -> float:
        """READY if there is a frame; while somebody is watched, how firmly it holds on."""
        if isinstance(state.memory, Watching):
            return HOLDS
        return READY if intent.sighting is not None else 0.0

    def enter(self, state: CharacterState, intent: Intent) -> CharacterState:
        """The state with the body about to be tracked, from the pose that it has."""
        if isinstance(state.memory, Watching):
            return state
        now = self._seen(state.pose)
        before = now if state.previous is None else self._seen(state.previous)
        share = 0.0 if state.elapsed <= 0.0 else 1.0 / (self.tracker.rate * state.elapsed)
        chain = self.tracker.surface.chain
        if abs(share - 1.0) > 1e-6:  # the pose a frame ago, not a step
            earlier = _part(local_turns(chain, now), local_turns(chain, before), share)
            before = fitted(chain, earlier.root, earlier.rotations)
        shown = local_turns(chain, now)
        offset = np.concatenate([np.zeros((1, 3)), log(np.swapaxes(shown.rotations, -1, -2) @ np.asarray(state.pose.rotations, float))])
        return replace(state, memory=Watching(self.tracker.start(now, before), 1.0 / self.tracker.rate, offset, np.zeros_like(offset)))

    def step(self, state: CharacterState, intent: Intent, dt: float) -> tuple[CharacterState, Pose]:
        """One step of dt seconds (0 < dt ≤ 0.1; ValueError otherwise, for a state that was not entered, and as of `Tracker.step`)."""
        dt = seconds(dt)
        if not isinstance(state.memory, Watching):
            raise ValueError("this state's memory is not of a tracking: enter it first")
        watching, sighting = state.memory, intent.sighting
        age, track = watching.age + dt, watching.track
        if sighting is not None:
            there = np.asarray(sighting.place, float)
            track, age = _shifted(self.tracker.step(_shifted(track, -there), sighting.pictures), there), 0.0
        found = sighting is not None and track.restarted
        offset, rate = settle(watching.offset, watching.rate, FADE, dt)
        before, now = (local_turns(self.tracker.surface.chain, one) for one in (track.before, track.now))
        seen = _part(before, now, min((age + dt) * self.tracker.rate, 1.0))
        if found:  # arms that were lost go to where they are, and don't jump there
            offset[1:], rate[1:] = log(np.swapaxes(seen.rotations, -1, -2) @ np.asarray(state.pose.rotations, float)), 0.0
        pose = Pose(seen.root + offset[0] + self.beside, seen.rotations @ exp(offset[1:]))
        return driven(state, self.skeleton, pose, Watching(track, age, offset, rate), dt), pose

    def status(self, state: CharacterState) -> Status:
        """Running as long as frames come."""
        return Status("done", "no more pictures come") if state.memory.age >= LOST else Status("running")

    def _seen(self, pose: Pose) -> Configuration:
        """A pose of the moved body as the chain's, where it is seen."""
        return fitted(self.tracker.surface.chain, np.asarray(pose.root, float) - self.beside, np.asarray(pose.rotations, float))


def _part(before: Pose, now: Pose, share: float) -> Pose:
    """The pose `share` of the way from one to another; beyond 1 it goes on."""
    turn = share * log(np.swapaxes(before.rotations, -1, -2) @ now.rotations)
    return Pose(before.root + share * (now.root - before.root), before.rotations @ exp(turn))


def _shifted(track: Track, by: np.ndarray) -> Track:
    """A track seen from elsewhere. by: (3,) [m]."""
    if not by.any():
        return track

    def moved(one: Configuration) -> Configuration:
        root = one.root.copy()
        root[:3, 3] += by
        return Configuration(root, one.angles)
    fit = track.fit if track.fit is None else replace(track.fit, where=moved(track.fit.where))
    sure = track.sure if track.sure is None else moved(track.sure)
    return replace(track, sure=sure, now=moved(track.now), before=moved(track.before), fit=fit, recent=tuple(replace(one, where=moved(one.where)) for one in track.recent))
