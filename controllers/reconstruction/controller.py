"""The reconstruction controller: ``state', pose = reconstruction.step(state, intent, dt)`` follows `intent.points`.

Where the points come from is nobody's business here: a recorded performance, handles that somebody drags, a live
stream (`live.sources`). `follower` follows them with a standard body; here that is in the world, of somebody's size, taken over from
whoever moved the body before and given back.
"""

from __future__ import annotations

import math
import numpy as np

from ..body import STATURE, Pose, Skeleton, human
from ..contract import CharacterState, Controller, Intent, Status, Unable, but, given, level as sound_level, seconds
from ..driven import driven
from .control_points import ControlPoints
from .follower import FADE, GLIDE, SWIFTEST, Follower, Following, Reconstructor
from .following import FAR, Beginning, above, difference, guessed_past, joints_of, moved, reached, rotations
from .pose_vector import SKELETON

READY, HOLDS = 1.0, 1.2
"""How well it bids when a point is seen; how firmly it holds on while points are wanted. A jump in the air holds firmer."""
LOST = 1.0
"""Without a point for so long [s] it gives up."""
ANEW = 0.25
"""Points farther than this from the body's on the average [m] are of another pose: it is begun anew from the points."""


class Reconstruction(Controller):
    """Moves a whole body as a few points on it go.

    method: whose poses. controls: the points, as the method has them. height: of the body [m]; the performer's points
    are taken to be as far apart as on a body of this height. dt: seconds between the method's frames.
    starts: poses to begin from where the body's own is not like the points; without them it begins from its own.
    far: points farther from the body than this on the average [m] are not taken hold of, and a body that is begun anew farther away is there at
    once; with math.inf, for a performer who is to be found again wherever he went unseen, it glides there.
    Pre-condition: a point is seen, and those seen are within reach. Post-condition: the body is where the points were
    and moves as it last did. Expected performance: a point is seen every now and then.
    Characters come singly. ValueError unless height is more than 0, and dt no more than 0.1.
    """

    def __init__(self, method: Reconstructor, controls: ControlPoints, height: float = STATURE, dt: float = 1 / 60,
                 starts: Beginning | None = None, skeleton: Skeleton | None = None, far: float = FAR):
        if not 0.0 < height < math.inf:
            raise ValueError(f"a height of {height!r}: it must be more than 0 m")
        self.controls = controls
        self.factor, self.skeleton = (height / STATURE, human(height)) if skeleton is None else (1.0, skeleton)
        self.follower = Follower(method, controls, SKELETON if skeleton is None else skeleton, seconds(dt), starts, far)

    @property
    def method(self) -> Reconstructor:
        """Whose poses they are."""
        return self.follower.method

    @property
    def starts(self) -> Beginning | None:
        """The poses to begin from."""
        return self.follower.starts

    @property
    def kind(self) -> str:
        """What tells its motion from that of others."""
        return f"Reconstruction {type(self.method).__name__} {','.join(self.controls.names)} × {self.factor:.6f}"

    def precondition(self, state: CharacterState, intent: Intent) -> float:
        """READY if a point is seen; while points are followed, how firmly it holds on, but to no other number of them."""
        if intent.points is None:
            return 0.0
        if isinstance(state.memory, Following):
            return HOLDS if np.shape(intent.points) == (len(self.controls), 3) else 0.0
        return READY if np.isfinite(intent.points).any() else 0.0

    def enter(self, state: CharacterState, intent: Intent) -> CharacterState:
        """The state with the body about to follow. Unable, with the reason, if the points are none of this body's."""
        if isinstance(state.memory, Following):
            return state
        level = float(sound_level(state.floor))
        seen = self._seen(intent, level)
        pose = self._shrunk(state.pose, level)
        away = reached(seen, self.follower.points(pose), self.factor, self.follower.far)
        past = None if state.previous is None or state.elapsed <= 0.0 else self._shrunk(state.previous, level)
        rate = np.zeros((1 + len(SKELETON), 3)) if past is None else difference(pose, past) / state.elapsed
        if away <= ANEW or self.starts is None:
            frames, tracks = guessed_past(pose, past, state.elapsed, self.follower.dt)
        else:
            frames, tracks = self.starts.find(seen, None, self._turns(intent))
        begun = self.follower.frame(self.follower.begun(frames, tracks, seen, self.follower.dt), seen, self._turns(intent))
        # what the body would do next by itself is where the fading begins
        offset = difference(moved(pose, rate * self.follower.dt), begun.pose)
        return but(state, memory=but(begun, ahead=self.follower.dt, offset=offset, level=level, fade=max(FADE, SWIFTEST * away / GLIDE)))

    def begin(self, points: np.ndarray, velocities: np.ndarray | None = None, floor: float = 0.0,
              turns: np.ndarray | None = None) -> CharacterState:
        """A body out of nothing, in a pose that has these points (n, 3) [m], which move at velocities (n, 3) [m/s] and are turned by
        turns (n, 3, 3).

        All NaN where not known. Unable if no point is seen, or none of this body's; it needs `starts`.
        """
        sound_level(floor)
        nobody = CharacterState(np.zeros(3), np.zeros(3), Pose(np.zeros(3), np.eye(3)), np.zeros(4, bool), floor=floor)
        wanted = Intent(points=points, turns=turns)
        seen = self._seen(wanted, floor)
        reached(seen, seen, self.factor)
        if self.starts is None:
            raise Unable("it knows no poses to begin from: enter it from a body, or give it `starts`")
        frames, tracks = self.starts.find(seen, None if velocities is None else velocities / self.factor, self._turns(wanted))
        following = self.follower.begun(frames, tracks, seen)
        pose = self._grown(following.pose, floor)
        ground = np.array([pose.root[0], pose.root[2], tracks[-1, 2]])
        following = but(following, ahead=self.follower.dt, level=float(floor))
        state, _ = self.step(but(nobody, ground=ground, pose=pose, memory=following), wanted, self.follower.dt)
        return state

    def step(self, state: CharacterState, intent: Intent, dt: float) -> tuple[CharacterState, Pose]:
        """One step of dt seconds (0 < dt ≤ 0.1; ValueError otherwise, and for a state that was not entered).

        The method makes a frame each of its own steps; in between, poses are interpolated. Another number of points
        than it follows ends it: the body coasts for this step, and `status` says why. No foot is deep in the floor,
        and contacts are with it; `state.floor` may be set to another from step to step.
        """
        given(state, intent)
        dt = seconds(dt)
        sound_level(state.floor)
        if not isinstance(state.memory, Following):
            raise ValueError("this state's memory is not of a reconstruction: enter it first")
        following = state.memory
        try:
            seen, turns = self._seen(intent, following.level), self._turns(intent)
        except Unable as reason:  # the body coasts, and the next step is somebody else's
            seen, turns = self._seen(Intent(), 0.0), self._turns(Intent())
            following = but(following, fault=str(reason))
        following = self.follower.step(following, seen, turns, dt)
        shown, body = self.follower.shown(following), self.follower.body
        floor = (float(state.floor) - following.level) / self.factor
        pose = self._grown(above(body, shown, *joints_of(shown, body), floor), following.level)
        return driven(state, self.skeleton, pose, following, dt), pose

    def status(self, state: CharacterState) -> Status:
        """Running as long as points are seen now and then."""
        following: Following = state.memory
        if following.fault:
            return Status("failed", following.fault)
        return Status("done", "the points are lost") if following.lost >= LOST else Status("running", self._exchanges(following.gate.order))

    def _exchanges(self, order: np.ndarray) -> str:
        """Which points come under others' numbers, in words; nothing where none does."""
        names = [name for k, name in enumerate(self.controls.names) if order[k] != k]
        return f"{', '.join(names[:-1])} and {names[-1]} have exchanged their numbers" if names else ""

    def _seen(self, intent: Intent, level: float) -> np.ndarray:
        """The points that are wanted (n, 3) as of a standard body on a floor there, NaN where they are not finite. Unable for another number of them."""
        count = len(self.controls)
        if intent.points is None:
            return np.full((count, 3), np.nan)
        points = np.asarray(intent.points, float)
        if points.shape != (count, 3):
            raise Unable(f"points of shape {points.shape}: {count} are followed, {', '.join(self.controls.names)}")
        points = np.where(np.isfinite(points), points, np.nan)  # infinite ones, which are nowhere either, would be reckoned with
        return (points - np.array([0.0, level, 0.0])) / self.factor

    def _turns(self, intent: Intent) -> np.ndarray:
        """How the points are turned (n, 3, 3), NaN where not known or no rotation. Unable for another number of turns."""
        count = len(self.controls)
        if intent.turns is None:
            return np.full((count, 3, 3), np.nan)
        turns = np.asarray(intent.turns, float)
        if turns.shape != (count, 3, 3):
            raise Unable(f"turns of shape {turns.shape}: {count} are followed, {', '.join(self.controls.names)}")
        return rotations(turns)

    def _shrunk(self, pose: Pose, level: float) -> Pose:
        return Pose((np.asarray(pose.root, float) - np.array([0.0, level, 0.0])) / self.factor, np.ascontiguousarray(pose.rotations, float))

    def _grown(self, pose: Pose, level: float) -> Pose:
        return Pose(pose.root * self.factor + np.array([0.0, level, 0.0]), pose.rotations)
