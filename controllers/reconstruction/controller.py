"""The reconstruction controller: ``state', pose = reconstruction.step(state, intent, dt)`` follows `intent.points`.

Where the points come from is nobody's business here: a recorded performance, handles that somebody drags, a live
stream (`live.sources`). A method of `regression` makes the poses; here they are taken over from whoever moved the body before,
kept going while points are lost, and given back.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np

from ..body import STATURE, Pose, Skeleton, damp, human, settle
from ..contract import CharacterState, Controller, Intent, Status, Unable, level as sound_level, seconds
from ..driven import driven
from .control_points import ControlPoints
from .following import (APART, FAR, Beginning, Doubts, Gate, above, difference, guessed_past, joints_of, moved, reached,
                        rotations, spread, unbroken)
from .pose_vector import SKELETON, decode

READY, HOLDS = 1.0, 1.2
"""How well it bids when a point is seen; how firmly it holds on while points are wanted. A jump in the air holds firmer."""
ALONE = 0.05
"""Points that are all missing are followed for no longer than this [s] as they went: a body goes on better by itself."""
LOST = 1.0
"""Without a point for so long [s] it gives up."""
ANEW = 0.25
"""Points farther than this from the body's on the average [m] are of another pose: it is begun anew from the points."""
LEAP = 0.03
"""A joint that is farther than this [m] from where its motion leads has leapt: the method has changed its mind, or knows more …"""
SHAKEN = 1.0
"""… unless points are so noisy that poses shake: by so many times as far as points lately were from where their motion led."""
STEADY = 0.5
"""How a body moves is told from its last frames, with a half-life of so many seconds for each metre that it shakes by beyond `LEAP`: one frame of noise is no motion."""
TAKEN = 0.01
"""… and no joint takes more of it [m] at once."""
FADE = 0.15
"""Half-life of the difference between the pose that was taken over and the reconstructed one [s]."""
SHORTEST, LONGEST, HURRY = 0.06, 0.16, 2.4
"""What was leapt fades with such a half-life, between these [s], that it moves no joint faster than this [m/s]; farther than 0.75 m it does."""
GLIDE = 8.0
"""… and from so far away that even so it would be faster than this [m/s], slower."""
_SWIFTEST = 2.0 * math.log(2.0) / math.e  # of what settles from rest: its distances a half-life


class Reconstructor(Protocol):
    """What makes the poses: a `regression.Method`, or anything that is used like one. One with `hears_turns` is given turns, too."""

    def begin(self, frames: np.ndarray, tracks: np.ndarray) -> Any:
        """See `Method`."""
        ...

    def step(self, memory: Any, points: np.ndarray) -> tuple[Any, Pose]:
        """See `Method`."""
        ...


@dataclass(frozen=True, eq=False)
class Following:
    """What is remembered while points are followed; lengths as of a standard body on a floor at height 0.

    memory: the method's. gate: what is known of the points, which were last at seen (n, 3). late: what was seen since the newest
    frame, (n, 3) and turns (n, 3, 3), NaN where nothing. doubts: which points may have exchanged their numbers. pose, before: the newest
    frame and the one before; the newest is `ahead` [s] of the present. pace: (1 + J, 3) by what frames lately moved on, noise left out, None where they are not noisy: the last two tell it. offset, rate: (1 + J, 3) what is added to root
    and joints until it has settled, with the half-life fade [s]. level: how high [m] height 0 lies in the world, the floor where it began; points
    are told from there as long as they are followed, whatever floor carries the body by and by. lost: [s] since a
    point was followed. fault: what went wrong.
    """

    memory: Any
    gate: Gate
    seen: np.ndarray
    pose: Pose
    before: Pose
    ahead: float
    offset: np.ndarray
    rate: np.ndarray
    late: tuple[np.ndarray, np.ndarray]
    doubts: Doubts
    level: float = 0.0
    fade: float = FADE
    lost: float = 0.0
    fault: str = ""
    pace: np.ndarray | None = None

    @property
    def step(self) -> np.ndarray:
        """By what (1 + J, 3) a frame goes on."""
        return difference(self.pose, self.before) if self.pace is None else self.pace


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
        self.method, self.controls, self.starts, self.dt, self.far = method, controls, starts, seconds(dt), far
        self.factor, self.skeleton = (height / STATURE, human(height)) if skeleton is None else (1.0, skeleton)
        self.body = SKELETON if skeleton is None else skeleton

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
        away = reached(seen, self._points(pose), self.factor, self.far)
        past = None if state.previous is None or state.elapsed <= 0.0 else self._shrunk(state.previous, level)
        rate = np.zeros((1 + len(SKELETON), 3)) if past is None else difference(pose, past) / state.elapsed
        if away <= ANEW or self.starts is None:
            frames, tracks = guessed_past(pose, past, state.elapsed, self.dt)
        else:
            frames, tracks = self.starts.find(seen, None, self._turns(intent))
        begun = self._frame(self._begun(frames, tracks, seen, self.dt), seen, self._turns(intent))
        # what the body would do next by itself is where the fading begins
        offset = difference(moved(pose, rate * self.dt), begun.pose)
        return replace(state, memory=replace(begun, ahead=self.dt, offset=offset, level=level, fade=max(FADE, _SWIFTEST * away / GLIDE)))

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
        following = self._begun(frames, tracks, seen)
        pose = self._grown(following.pose, floor)
        ground = np.array([pose.root[0], pose.root[2], tracks[-1, 2]])
        following = replace(following, ahead=self.dt, level=float(floor))
        state, _ = self.step(replace(nobody, ground=ground, pose=pose, memory=following), wanted, self.dt)
        return state

    def _begun(self, frames: np.ndarray, tracks: np.ndarray, seen: np.ndarray, late: float = 0.0) -> Following:
        """Before the first frame, after a past that may be guessed. late: when points were seen after its end [s]."""
        before, pose = (Pose(*decode(frames[k], tracks[k])) for k in (max(-2, -len(frames)), -1))
        motion, zero = (self._points(pose) - self._points(before)) / self.dt, np.zeros((1 + len(SKELETON), 3))
        return Following(self.method.begin(frames, tracks), Gate.before(seen - motion * late, motion), seen, pose, before,
                         0.0, zero, zero, (np.full_like(seen, np.nan), np.full((len(seen), 3, 3), np.nan)), Doubts.of(len(seen)))

    def step(self, state: CharacterState, intent: Intent, dt: float) -> tuple[CharacterState, Pose]:
        """One step of dt seconds (0 < dt ≤ 0.1; ValueError otherwise, and for a state that was not entered).

        The method makes a frame each of its own steps; in between, poses are interpolated. Another number of points
        than it follows ends it: the body coasts for this step, and `status` says why. No foot is deep in the floor,
        and contacts are with it; `state.floor` may be set to another from step to step.
        """
        dt = seconds(dt)
        sound_level(state.floor)
        if not isinstance(state.memory, Following):
            raise ValueError("this state's memory is not of a reconstruction: enter it first")
        following = state.memory
        try:
            seen, turns = self._seen(intent, following.level), self._turns(intent)
        except Unable as reason:  # the body coasts, and the next step is somebody else's
            seen, turns = self._seen(Intent(), 0.0), self._turns(Intent())
            following = replace(following, fault=str(reason))
        due = max(0, math.ceil((dt - following.ahead) / self.dt - 1e-6))
        ahead = following.ahead - dt + due * self.dt
        start, (late, turned) = following.seen, following.late
        seen = np.where(np.asarray(np.isfinite(seen).all(-1))[:, None], seen, late)
        turns = np.where(np.asarray(np.isfinite(turns).all((-1, -2)))[:, None, None], turns, turned)
        late = (seen, turns) if not due else (np.full_like(seen, np.nan), np.full_like(turns, np.nan))
        following = replace(following, late=late)
        if due:
            gate, seen = following.gate.named(seen, due * self.dt)
            following = replace(following, gate=gate, doubts=following.doubts.heard(gate.confusable(following.doubts.pairs, seen, due * self.dt), due * self.dt))
        for k in range(1, due + 1):
            points = seen if k == due else start + (seen - start) * (k / due)
            following = self._frame(following, points, turns)
        if due:
            following = self._doubted(replace(following, seen=seen))
        offset, rate = settle(following.offset, following.rate, following.fade, dt)
        following = replace(following, ahead=ahead if ahead > 1e-9 else 0.0, offset=offset, rate=rate)
        shown = following.pose
        if following.ahead > 0.0:
            shown = moved(shown, difference(following.before, shown) * (following.ahead / self.dt))
        shown = unbroken(moved(shown, offset), shown)
        floor = (float(state.floor) - following.level) / self.factor
        pose = self._grown(above(self.body, shown, *joints_of(shown, self.body), floor), following.level)
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

    def _frame(self, following: Following, points: np.ndarray, turns: np.ndarray) -> Following:
        """One frame of the method on."""
        earlier = following.before if following.pace is None else moved(following.pose, -following.pace)
        now, earlier = joints_of(following.pose, self.body), joints_of(earlier, self.body)
        body = self.controls.on(*now)
        motion = (body - self.controls.on(*earlier)) / self.dt
        blind = 0.0 if following.gate.trusted.any() else following.lost
        gate, goals = following.gate.admit(points, body + motion * self.dt, motion, self.dt, blind)
        goals = goals if gate.gone.min() <= ALONE + 1e-6 else np.full_like(goals, np.nan)
        gate, turned = gate.told(turns[gate.order], self.dt)
        back = blind > 0.0 and gate.trusted.any()
        if self.starts is not None and (gate.at_odds(self.dt) or back and gate.doubtful) and spread(points) <= APART:
            turns = turns[gate.order]
            return self._anew(following, points, self.starts.find(points, gate.smooth, turns), turns)
        if not getattr(self.method, "hears_turns", False):
            memory, pose = self.method.step(following.memory, goals)
        else:  # of points that are refused nothing is believed; inertial trackers know turns alone
            believed = gate.trusted | ~gate.seen
            memory, pose = self.method.step(following.memory, goals, np.where(believed[:, None, None], turned, np.nan))  # type: ignore[call-arg]
        if not (np.isfinite(pose.root).all() and np.isfinite(pose.rotations).all()):
            return replace(following, fault="the reconstruction came to no pose", before=following.pose)
        lost = 0.0 if (gate.trusted & gate.seen).any() else following.lost + self.dt
        shaking = SHAKEN * float(np.median(gate.rough))
        pace = damp(following.step, difference(pose, following.pose), STEADY * (shaking - LEAP), self.dt) if shaking > LEAP else None
        after = replace(following, memory=memory, gate=gate, pose=pose, before=following.pose, pace=pace, lost=lost)
        leap = float(np.linalg.norm(joints_of(pose, self.body)[0] - 2.0 * now[0] + earlier[0], axis=-1).max())
        if leap <= max(LEAP, shaking):
            return after
        # a little of it may be how bodies change their pace, and the rest fades
        step = following.step
        step = step + TAKEN / leap * (difference(pose, following.pose) - step)
        ahead = moved(following.pose, step)
        return self._fading(replace(after, before=moved(pose, -step), pace=step), moved(ahead, following.offset))

    def _doubted(self, following: Following) -> Following:
        """With two points under each other's number, if what the method has seen for some time is much likelier so."""
        method: Any = self.method
        if not hasattr(method, "exchanged"):
            return following
        doubts, asked = following.doubts.asked()
        if asked is None:
            return replace(following, doubts=doubts)
        i, j = doubts.pairs[asked]
        other = method.exchanged(following.memory, i, j)
        doubts, taken = doubts.told(asked, method.energy(following.memory), method.energy(other))
        if not taken:
            return replace(following, doubts=doubts)
        best = min(doubts.open, key=lambda pair: method.energy(method.exchanged(following.memory, *doubts.pairs[pair])))
        if best != asked:
            return replace(following, doubts=doubts.rather(asked, int(best)))
        doubts = replace(doubts, evidence=np.zeros_like(doubts.evidence))
        order = np.arange(len(self.controls))
        order[[i, j]] = j, i
        return replace(following, doubts=doubts, memory=other, gate=following.gate.exchanged(i, j), seen=following.seen[order])

    def _fading(self, following: Following, shown: Pose) -> Following:
        """With an offset by which a pose is shown for now."""
        away = float(np.linalg.norm(joints_of(shown, self.body)[0] - joints_of(following.pose, self.body)[0], axis=-1).max())
        fade = max(min(max(SHORTEST, _SWIFTEST * away / HURRY), LONGEST), _SWIFTEST * away / GLIDE)
        return replace(following, offset=difference(shown, following.pose), fade=fade)

    def _anew(self, following: Following, points: np.ndarray, past: tuple[np.ndarray, np.ndarray], turns: np.ndarray) -> Following:
        """Begun anew, after frames and tracks of a past, from points at odds with the body. It comes there smoothly, unless nobody could."""
        begun = self._frame(self._begun(*past, points, self.dt), points, turns)
        ahead = moved(moved(following.pose, following.step), following.offset)
        far = np.linalg.norm(ahead.root - begun.pose.root) > self.far
        after = replace(following, memory=begun.memory, gate=replace(begun.gate, order=following.gate.order), pose=begun.pose, before=begun.before, pace=begun.pace, lost=0.0)
        zero = np.zeros_like(following.offset)
        return replace(after, offset=zero, rate=zero) if far else self._fading(after, ahead)

    def _seen(self, intent: Intent, level: float) -> np.ndarray:
        """The points that are wanted (n, 3) as of a standard body on a floor there. Unable for another number of them."""
        count = len(self.controls)
        if intent.points is None:
            return np.full((count, 3), np.nan)
        points = np.asarray(intent.points, float)
        if points.shape != (count, 3):
            raise Unable(f"points of shape {points.shape}: {count} are followed, {', '.join(self.controls.names)}")
        return (points - [0.0, level, 0.0]) / self.factor

    def _turns(self, intent: Intent) -> np.ndarray:
        """How the points are turned (n, 3, 3), NaN where not known or no rotation. Unable for another number of turns."""
        count = len(self.controls)
        turns = np.full((count, 3, 3), np.nan) if intent.turns is None else np.asarray(intent.turns, float)
        if turns.shape != (count, 3, 3):
            raise Unable(f"turns of shape {turns.shape}: {count} are followed, {', '.join(self.controls.names)}")
        return rotations(turns)

    def _points(self, pose: Pose) -> np.ndarray:
        """Where (n, 3) [m] a standard body has the points."""
        return self.controls.on(*joints_of(pose, self.body))

    def _shrunk(self, pose: Pose, level: float) -> Pose:
        return Pose((np.asarray(pose.root, float) - [0.0, level, 0.0]) / self.factor, np.asarray(pose.rotations, float))

    def _grown(self, pose: Pose, level: float) -> Pose:
        return Pose(pose.root * self.factor + [0.0, level, 0.0], pose.rotations)
