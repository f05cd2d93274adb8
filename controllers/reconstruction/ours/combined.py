"""Our own way to reconstruct: networks that see the points' last half second, what they were off by, and neighbours.

What the networks are off by hardly changes from frame to frame: a part of it fades within a sixth of a second, and
more than half of its variance stays as long as a take lasts, since it is how this body is held and its sensors sit.
So the newest error, known from the body's own output, is expected again (an autoregressive model of the error). The
solver corrects that by what the points say, and the correction in turn is kept.

The local regression of the paper has a small say beside them: it knows how limbs turn that no point tells of, but
running on its own output it strays. While a point is lost its say is larger: networks were never shown such points, and
believe whatever is put in their place; neighbours say what a limb does that nothing is seen of.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any

import numpy as np

from ...body import Pose, Skeleton
from ..baselines import Samples
from ..control_points import ControlPoints
from ..database import Database, kept
from ..neighbours import MANY, Cells, Lists, Segments, at_hand
from ..pose_vector import FORWARD, LEFTWARD, SKELETON, WIDTH, YAW_RATE
from ..regression import (FAR, FLOOR, SPAN, Fused, Gaussian, Local, LocalRegression, Memory, Method, Prior, Regression,
                          Solver, posed, seen_kernel)
from .filters import Motion, noise
from .lost_points import LostPoints
from .networks import LAGS, WORLD, Networks, learn, placed, seen_from, view

Progress = Callable[[str, int, int], None]
"""Called with what is being done, how much of it is, and of how much."""
FADING = 0.9
"""What is left of an error's fading part a frame later."""
LASTING = 0.6
"""Which share of the mean error in the known half second is taken to last: as good a guess as so short a time allows."""
KEPT = 0.999
"""What is left of the lasting part a frame later: half of it after twelve seconds."""
LOOSENING = 100.0
"""How much larger than on recordings that were learnt the errors may be: the points are met."""
RESTING = 0.95
"""What is left of the body's velocity a frame later where no point is seen: a third of it after a third of a second."""
NEIGHBOURS = 60
"""From how many recorded segments the local regression is learnt; more gain nothing."""
LISTENED = Regression("paper", ridge=0.1, loosening=1e4)
"""How the local regression is learnt, and how little it is believed: ten times more, and the body strays with it."""
NEAR = 1.5
"""Neighbours that are farther away than this, in the features' units, are hardly believed: they move in another way."""
HEARD = replace(LISTENED, loosening=1e3)
"""How it is believed while a point is lost."""
NEARER = 4.0
"""As `NEAR` while a point is lost: neighbours far away are a better guess than none."""
TOLD = 0.5
"""A lost point is shown to the networks so far from where the body has it to where the others tell that it is. With less
a body on its own output would run away, with more it would not follow what neighbours say."""
PLENTY = 30_000
"""From so many poses on networks are as wide as `learn` has them."""
NARROW = {"hidden": (384, 384), "batches": 2500}
"""How networks learn from fewer: in half the time they are as good on poses like those, seen or not."""
ACCELERATION = 10.0
"""How fast velocities change in human motion [m/s²], and in joints [rad/s²] as far as filters may smooth them."""
ROUGH = 0.003
"""How unsteady poses are even where the points are not [m, rad]."""
_RECENT = 15  # frames that tell the noise
_JUMP = 1.0  # rad or m, beyond which the chart has jumped, as it does upside down: nothing to be smoothed
_SOURCES = ("pose_vector.py", "ours/networks.py", "regression/solver_kernel.py", "baselines/regressors.py", "baselines/windows.py")


@dataclass(frozen=True, eq=False)
class Expected:
    """What the networks made of a frame. pose: (D,) placed, seen from ground (3,). lasting: (D,) error that stays."""

    pose: np.ndarray
    ground: np.ndarray
    lasting: np.ndarray


@dataclass(frozen=True, eq=False)
class Expectation:
    """The prior: the networks' pose, off by what it was off by.

    moments: tell the networks where lost points are. dt: seconds between frames.
    """

    networks: Networks
    moments: LostPoints
    dt: float

    def known(self, frames: np.ndarray, tracks: np.ndarray, points: np.ndarray) -> Expected:
        """The hint after known frames (T, D) with tracks (T, 3) and points (T, n, 3), newest first; two or more."""
        at = np.arange(len(frames) - 1)
        past = np.minimum(at[:, None] + LAGS, len(points) - 1)
        inputs, ground = view(points[past], tracks[at + 1, 2])
        poses = self.networks.predict(inputs).astype(float)
        off = _error(seen_from(ground, placed(frames[at], tracks[at]), WORLD), poses)
        lasting = LASTING * off.mean(0)
        lasting[YAW_RATE] = 0.0  # a heading's error does not last
        return Expected(poses[0], ground[0], lasting)

    def believe(self, memory: Memory, seen: np.ndarray, goals: np.ndarray) -> tuple[Gaussian, Any]:
        """See `method.Prior`."""
        points = np.concatenate([seen[None], memory.points])[LAGS]
        known = np.concatenate([np.all(np.isfinite(goals), axis=-1)[None], memory.known])[LAGS]
        points += TOLD * (self.moments.complete(points, known, memory.track[2]) - points)
        inputs, ground = view(points, memory.track[2])
        pose, off, lasting = self.networks.predict(inputs).astype(float), np.zeros(WIDTH), np.zeros(WIDTH)
        if memory.hint is not None:
            last: Expected = memory.hint
            lasting = KEPT * last.lasting
            newest = memory.frames[0].copy()
            newest[[LEFTWARD, FORWARD, YAW_RATE]] = memory.track
            error = _error(_seen_from(last.ground, newest, WORLD), last.pose)
            off = lasting + FADING * (error - lasting)
        mean = _seen_from(memory.track, pose + off, ground)
        mean[YAW_RATE:] /= self.dt
        if not known[0].any():  # it goes on as it went, and comes to rest
            mean = memory.frames[0].copy()
            mean[YAW_RATE:] *= RESTING
        return Gaussian(mean, *self._spread), Expected(pose, ground, lasting)

    @cached_property
    def _spread(self):
        """Variance (D,) and factor (D, D) of what is believed."""
        errors = self.networks.errors.copy()
        errors[:, YAW_RATE:] /= self.dt
        return LOOSENING * FLOOR ** 2, np.sqrt(LOOSENING) * errors


@dataclass(frozen=True, eq=False)
class Torn:
    """A prior of two: `whole` believes where all points are seen, `torn` where one is lost. Both have the same hint."""

    whole: Prior
    torn: Prior

    def believe(self, memory: Memory, seen: np.ndarray, goals: np.ndarray) -> tuple[Gaussian, Any]:
        """See `method.Prior`."""
        return (self.whole if np.isfinite(goals).all() else self.torn).believe(memory, seen, goals)


def _seen_from(ground, pose, other):
    """`seen_from` for one pose (D,), quicker."""
    out = np.empty(len(pose))
    seen_kernel(pose, other, ground, out)
    return out


def _error(poses, expected):
    """Placed poses (..., D) less expected ones."""
    off = poses - expected
    off[..., YAW_RATE] = (off[..., YAW_RATE] + np.pi) % (2 * np.pi) - np.pi
    return off


@dataclass(frozen=True, eq=False)
class Remembered:
    """method: what the method remembers. recent: (T, n, 3) [m] points as they were seen last, NaN where they were not,
    newest last. points, pose: filtered; the pose is placed in the world."""

    method: Memory
    recent: np.ndarray
    points: Motion
    pose: Motion


@dataclass(frozen=True, eq=False)
class Ours:
    """The method with its filters. steady: whether points are filtered as far as they are noisy, and poses a little.

    method: its prior is several, fused, of which the first is an `Expectation`.
    """

    method: Method
    steady: bool = True

    def begin(self, frames: np.ndarray, tracks: np.ndarray) -> Remembered:
        """See `Method.begin`."""
        memory = self.method.begin(frames, tracks)
        which = np.maximum(np.arange(len(frames) - 1, len(frames) - 1 - SPAN, -1), 0)
        prior = self.method.prior
        assert isinstance(prior, Fused)  # see above
        expectation, others = prior.priors[0], prior.priors[1:]
        assert isinstance(expectation, Expectation)
        known = expectation.known(memory.frames, np.asarray(tracks, float)[which], memory.points)
        pose = placed(memory.frames[:2], np.asarray(tracks, float)[which[:2]])
        return Remembered(replace(memory, hint=(known, *(None for _ in others))), memory.points[_RECENT - 1::-1],
                          Motion(memory.points[0], memory.points[0] - memory.points[1]), Motion(pose[0], _error(*pose)))

    def step(self, memory: Remembered, points: np.ndarray) -> tuple[Remembered, Pose]:
        """See `Method.step`."""
        points = np.array(points, float)
        points[~(np.abs(points) < FAR).all(-1)] = np.nan
        if not self.steady:
            after, pose = self.method.step(memory.method, points)
            return replace(memory, method=after), pose
        recent = np.concatenate([memory.recent[1:], points[None]])
        level, reach = noise(recent), ACCELERATION * self.method.solver.dt ** 2
        filtered = memory.points.towards(points, reach / level if level > 0.0 else np.inf)
        after = self.method.follow(memory.method, np.where(np.isfinite(points), filtered.place, np.nan))
        found = placed(after.frames[0], after.track)
        if np.abs(found - memory.pose.place).max() > _JUMP:
            pose = Motion(found, np.zeros(WIDTH))
        else:
            pose = memory.pose.towards(found, reach / (ROUGH + 2.0 * level))
        frame = pose.place
        return Remembered(after, recent, filtered, pose), posed(frame, frame[[LEFTWARD, FORWARD, YAW_RATE]])


def ours(database: Database, controls: ControlPoints, *, skeleton: Skeleton = SKELETON, steady: bool = True,
         progress: Progress | None = None) -> Ours:
    """The method for some control points, learnt from a database on the first call, and kept on disk.

    skeleton: whose poses are made, if its lengths are not the standard human's. steady: see `Ours`.
    """
    plain, how = Solver(controls, 1 / database.fps), NARROW if len(database) < PLENTY else {}

    def make():
        told = None if progress is None else partial(progress, "learning")
        return learn(Samples.of(database, plain), progress=told, **how)
    points = controls.joints.tolist(), controls.offsets.tolist()
    networks = kept("networks", database, (*points, *how.items()), make, Networks.save, Networks.load, _SOURCES)
    moments = kept("moments", database, points, lambda: LostPoints.of(Samples.of(database, plain)), LostPoints.save,
                   LostPoints.load, (*_SOURCES, "ours/lost_points.py"))
    search = cells(database, controls)
    whole, torn = (Local(LocalRegression(how, reach), search, NEIGHBOURS) for how, reach in ((LISTENED, NEAR), (HEARD, NEARER)))
    prior = Fused((Expectation(networks, moments, 1 / database.fps), Torn(whole, torn)))
    return Ours(Method(prior, replace(plain, skeleton=skeleton)), steady)


def cells(database: Database, controls: ControlPoints, m: int = 3, stride: int = 4) -> Cells | Lists:
    """A database's segments to search, with these points; made on the first call, and kept on disk. By Faiss where there are many and it is
    at hand."""
    segments = Segments.of(database, m, stride, controls.joints, offsets=controls.offsets)
    how: type[Cells | Lists] = Lists if len(segments) >= MANY and at_hand() else Cells
    return kept("cells", database, (m, stride, segments.joints, controls.offsets.tolist()), lambda: how(segments), lambda made, path: made.save(path),
                lambda path: how.load(path, segments),
                ("pose_vector.py", "neighbours/segments.py", "neighbours/features.py", "neighbours/search.py",
                 "neighbours/lists.py" if how is Lists else "neighbours/cells.py"))
