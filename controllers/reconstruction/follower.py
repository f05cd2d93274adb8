"""How points are followed, frame by frame: a gate for what is seen, a method's poses, and what these leap shown as what fades.

All of it is of a standard body on a floor at height 0; worlds, sizes and who moves the body otherwise are `controller`'s. State goes in and comes out: `Following`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from statistics import median
from typing import Any, Protocol

import numpy as np

from ..body import Pose, Skeleton, damp, settle
from ..contract import but
from .control_points import ControlPoints
from .following import APART, KEPT, LATELY, LEAP, NOISY, Beginning, Doubts, Gate, difference, joints_of, kept, led, missed, moved, spread, unbroken
from .pose_vector import SKELETON, decode

ALONE = 0.05
"""Points that are all missing are followed for no longer than this [s] as they went: a body goes on better by itself."""
SHAKEN = 1.0
"""Points may be so noisy that poses shake: no joint leaps that goes by so many times as far as points lately were from where their motion led."""
STEADY = 0.5
"""How a body moves is told from its last frames, with a half-life of so many seconds for each metre that it shakes by beyond `LEAP`: one frame of noise is no motion."""
FADE = 0.15
"""Half-life of the difference between the pose that was taken over and the reconstructed one [s]."""
SHORTEST, LONGEST, HURRY = 0.06, 0.16, 2.4
"""What was leapt fades with such a half-life, between these [s], that it moves no joint faster than this [m/s]; farther than 0.75 m it does."""
GLIDE = 8.0
"""… and from so far away that even so it would be faster than this [m/s], slower."""
SWIFTEST = 2.0 * math.log(2.0) / math.e
"""The greatest speed of what settles from rest: so many of its distances a half-life."""
HALVED = 0.01
"""What carries points too far is shortened by half in so long [s], no faster."""
_NOTHING = np.zeros((1 + len(SKELETON), 3))


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
    frame, (n, 3) and turns (n, 3, 3), NaN where nothing; None right after a frame. doubts: which points may have exchanged their numbers. pose, before: the newest
    frame and the one before; the newest is `ahead` [s] of the present. pace: (1 + J, 3) by what frames lately moved on, noise left out, None where they are not noisy: the last two tell it.
    went: (1 + J, 3) by what the newest frame truly went on. offset, rate: (1 + J, 3) what is added to root and joints until it has settled, with the half-life fade [s]. level: how high [m] height 0 lies in the world, the floor where it began; points
    are told from there as long as they are followed, whatever floor carries the body by and by. lost: [s] since a
    point was followed. loose: how far [m] points may be from where they are seen, as they lately were; None where anything may be. fault: what went wrong.
    """

    memory: Any
    gate: Gate
    seen: np.ndarray
    pose: Pose
    before: Pose
    ahead: float
    offset: np.ndarray
    rate: np.ndarray
    late: tuple[np.ndarray, np.ndarray] | None
    doubts: Doubts
    level: float = 0.0
    fade: float = FADE
    lost: float = 0.0
    fault: str = ""
    pace: np.ndarray | None = None
    went: np.ndarray | None = None
    loose: float | None = None

    @property
    def step(self) -> np.ndarray:
        """By what (1 + J, 3) a frame goes on."""
        return self.pace if self.pace is not None else self.went if self.went is not None else difference(self.pose, self.before)


@dataclass(frozen=True, eq=False)
class Follower:
    """Who follows: method, controls and starts as of `Reconstruction`; body: whose joints the method poses; dt: between its frames [s]; far: beyond this [m]
    a body that is begun anew is there at once.
    """

    method: Reconstructor
    controls: ControlPoints
    body: Skeleton
    dt: float
    starts: Beginning | None
    far: float

    def begun(self, frames: np.ndarray, tracks: np.ndarray, seen: np.ndarray, late: float = 0.0) -> Following:
        """Before the first frame, after a past that may be guessed. late: when points were seen after its end [s]."""
        before, pose = (Pose(*decode(frames[k], tracks[k])) for k in (max(-2, -len(frames)), -1))
        motion, zero = (self.points(pose) - self.points(before)) / self.dt, np.zeros((1 + len(SKELETON), 3))
        return Following(self.method.begin(frames, tracks), Gate.before(seen - motion * late, motion), seen, pose, before,
                         0.0, zero, zero, None, Doubts.of(len(seen)))

    def step(self, following: Following, seen: np.ndarray, turns: np.ndarray, dt: float) -> Following:
        """dt [s] on, with points (n, 3) and turns (n, 3, 3) as they are seen at its end: as many frames of the method as are due."""
        due = max(0, math.ceil((dt - following.ahead) / self.dt - 1e-6))
        ahead = following.ahead - dt + due * self.dt
        start = following.seen
        if following.late is not None:
            seen = np.where(np.asarray(np.isfinite(seen).all(-1))[:, None], seen, following.late[0])
            turns = np.where(np.asarray(np.isfinite(turns).all((-1, -2)))[:, None, None], turns, following.late[1])
        following = but(following, late=None if due else (seen, turns))
        if due:
            gate, seen = following.gate.named(seen, due * self.dt)
            following = but(following, gate=gate, doubts=following.doubts.heard(gate.confusable(following.doubts.pairs, seen, due * self.dt), due * self.dt))
        for k in range(1, due + 1):
            points = seen if k == due else start + (seen - start) * (k / due)
            following = self.frame(following, points, turns)
        if due:
            following = self.doubted(but(following, seen=seen))
        offset, rate = settle(following.offset, following.rate, following.fade, dt)
        return self.held(but(following, ahead=ahead if ahead > 1e-9 else 0.0, offset=offset, rate=rate), dt)

    def held(self, following: Following, dt: float) -> Following:
        """With an offset that carries no point far from where it is surely seen, dt [s] later: what goes on as its points do did not leap, however suddenly they went."""
        gate, body, pose = following.gate, self.body, following.pose
        own, far = (missed(body, pose, by, self.controls, gate.raw) for by in (_NOTHING, following.offset))
        sure = gate.sure
        new = far[np.where(gate.trusted, ~sure, (gate.gone == 0.0) & (gate.steady == 0.0))]
        loose = following.loose * 0.5 ** (dt / (LATELY * following.fade)) if following.loose is not None else np.fmax.reduce(far, initial=0.0)
        loose = float(max(loose, np.fmax.reduce(new, initial=0.0), own[sure].max(initial=0.0)))
        following = but(following, loose=loose)
        most = KEPT + NOISY * gate.rough + loose
        if not (far[sure] > most[sure]).any():
            return following
        seen = np.where(sure[:, None], gate.raw, np.nan)
        left = kept(body, pose, following.offset, self.controls, seen, most, self.controls.joints[gate.trusted], 0.5 ** (dt / HALVED))
        return but(following, offset=following.offset * left, rate=following.rate * left)

    def shown(self, following: Following) -> Pose:
        """The pose of the present: between the last frames, with what fades."""
        pose = following.pose
        if following.ahead > 0.0:
            pose = moved(pose, difference(following.before, pose) * (following.ahead / self.dt))
        return unbroken(moved(pose, following.offset), pose)

    def frame(self, following: Following, points: np.ndarray, turns: np.ndarray) -> Following:
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
            return self.anew(following, points, self.starts.find(points, gate.smooth, turns), turns)
        there = gate.seen
        if not getattr(self.method, "hears_turns", False):
            memory, pose = self.method.step(following.memory, goals)
        else:  # of points that are refused nothing is believed; inertial trackers know turns alone
            believed = gate.trusted | ~there
            memory, pose = self.method.step(following.memory, goals, np.where(believed[:, None, None], turned, np.nan))  # type: ignore[call-arg]
        if not (np.isfinite(pose.root).all() and np.isfinite(pose.rotations).all()):
            return but(following, fault="the reconstruction came to no pose", before=following.pose, pace=np.zeros_like(following.step))
        lost = 0.0 if (gate.trusted & there).any() else following.lost + self.dt
        went = difference(pose, following.pose)
        shaking = SHAKEN * median(gate.rough.tolist())
        pace = damp(following.step, went, STEADY * (shaking - LEAP), self.dt) if shaking > LEAP else None
        after = but(following, memory=memory, gate=gate, pose=pose, before=following.pose, pace=pace, went=went, lost=lost)
        leaps = led(self.body, following.pose, pose, went, following.step, following.went, self.controls.joints[gate.trusted], max(LEAP, shaking), gate.swerves)
        if leaps is None:
            return after
        step, leapt, none = leaps
        after = but(after, rate=after.rate + none / self.dt)
        if not leapt.any():
            return after
        pace = np.where(leapt[:, None], step, went if pace is None else pace)
        return self.fading(but(after, before=moved(pose, -step), pace=pace), moved(moved(following.pose, step), following.offset))

    def doubted(self, following: Following) -> Following:
        """With two points under each other's number, if what the method has seen for some time is much likelier so."""
        method: Any = self.method
        if not hasattr(method, "exchanged"):
            return following
        doubts, asked = following.doubts.asked()
        if asked is None:
            return but(following, doubts=doubts)
        i, j = doubts.pairs[asked]
        other = method.exchanged(following.memory, i, j)
        doubts, taken = doubts.told(asked, method.energy(following.memory), method.energy(other))
        if not taken:
            return but(following, doubts=doubts)
        best = min(doubts.open, key=lambda pair: method.energy(method.exchanged(following.memory, *doubts.pairs[pair])))
        if best != asked:
            return but(following, doubts=doubts.rather(asked, int(best)))
        doubts = but(doubts, evidence=np.zeros_like(doubts.evidence))
        order = np.arange(len(self.controls))
        order[[i, j]] = j, i
        return but(following, doubts=doubts, memory=other, gate=following.gate.exchanged(i, j), seen=following.seen[order], loose=None)

    def anew(self, following: Following, points: np.ndarray, past: tuple[np.ndarray, np.ndarray], turns: np.ndarray) -> Following:
        """Begun anew, after frames and tracks of a past, from points at odds with the body. It comes there smoothly, unless nobody could."""
        begun = self.frame(self.begun(*past, points, self.dt), points, turns)
        ahead = moved(moved(following.pose, following.step), following.offset)
        far = np.linalg.norm(ahead.root - begun.pose.root) > self.far
        after = but(following, memory=begun.memory, gate=but(begun.gate, order=following.gate.order), pose=begun.pose, before=begun.before, pace=begun.pace, went=begun.went, lost=0.0, loose=None)
        zero = np.zeros_like(following.offset)
        return but(after, offset=zero, rate=zero) if far else self.fading(after, ahead)

    def fading(self, following: Following, shown: Pose) -> Following:
        """With an offset by which a pose is shown for now."""
        away = float(np.linalg.norm(joints_of(shown, self.body)[0] - joints_of(following.pose, self.body)[0], axis=-1).max())
        fade = max(min(max(SHORTEST, SWIFTEST * away / HURRY), LONGEST), SWIFTEST * away / GLIDE)
        return but(following, offset=difference(shown, following.pose), fade=fade)

    def points(self, pose: Pose) -> np.ndarray:
        """Where (n, 3) [m] a standard body has the points."""
        return self.controls.on(*joints_of(pose, self.body))
