"""Trials of reconstruction on recorded takes that the methods have not seen.

Whole takes are held out, never frames: at 60 Hz a frame's neighbours are next to the frame itself. A take that
stands in the database twice, as files of two formats, is never held out.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath

import numpy as np

from ...body import forward_kinematics
from ..control_points import ControlPoints
from ..database import Database, DatabaseError, Take
from ..pose_vector import SKELETON, advance, decode
from ..regression import SPAN, Method
from . import metrics

LEAST = 30
"""Fewest frames that a trial has to reconstruct."""
MOST = 600
"""A trial ends after ten seconds."""


@dataclass(frozen=True)
class Split:
    """What is learnt from, settings are tuned on, and results are told of."""

    learnt: Database
    validation: tuple[Take, ...]
    test: tuple[Take, ...]


@dataclass(frozen=True, eq=False)
class Trial:
    """A recorded take, or its first seconds. frames: (T, D) of the chart. tracks: (T, 3). positions: (T, J, 3) [m].

    rotations: (T, J, 3, 3) local. points: (T, n, 3) [m] the control points in the world. dt: [s].
    The first `SPAN` frames are given to the methods, as that much of the past.
    """

    take: Take
    frames: np.ndarray
    tracks: np.ndarray
    positions: np.ndarray
    rotations: np.ndarray
    points: np.ndarray
    dt: float


@dataclass(frozen=True, eq=False)
class Outcome:
    """What a method made of a trial: positions (T − SPAN, J, 3) [m] and local rotations (T − SPAN, J, 3, 3)."""

    trial: Trial
    positions: np.ndarray
    rotations: np.ndarray

    @property
    def errors(self) -> np.ndarray:
        """Mean distance of the joints from the recorded ones in each frame (T − SPAN,) [m]."""
        return metrics.position_error(self.positions, self.trial.positions[SPAN:])


def split(database: Database, test: int = 22, validation: int = 11, seed: int = 0, interpolated: bool = False) -> Split:
    """Hold out takes of seen subjects: of every action and subject in turn, so that no kind fills the test.

    At least half of what a subject did of each action stays. Only takes without a gap are held out; those that were
    recorded at a lower rate than the database's only if `interpolated` is set.
    DatabaseError if there are not enough.
    """
    rng = np.random.default_rng(seed)
    originals = [take for take in database.takes if not take.mirrored]
    groups: dict[tuple[str, str], list[Take]] = {}
    for take in _alone(database, originals):
        if (interpolated or not take.interpolated) and _usable(database, take):
            groups.setdefault((take.action, take.subject), []).append(take)
    count = Counter((take.action, take.subject) for take in originals)
    queues = [[group[i] for i in rng.permutation(len(group))[:count[kind] // 2]] for kind, group in groups.items()]
    chosen: list[Take] = []
    while len(chosen) < test + validation:
        if not any(queues):
            raise DatabaseError(f"{database.path}: only {len(chosen)} takes can be held out, not {test + validation}")
        chosen += [queues[k].pop() for k in rng.permutation(len(queues)) if queues[k]]
    learnt, _ = database.hold_out([take.clip for take in chosen[:test + validation]])
    return Split(learnt, tuple(chosen[test:test + validation]), tuple(chosen[:test]))


def split_subjects(database: Database, subjects: Sequence[str], test: int = 22, seed: int = 0) -> Split:
    """Hold out subjects altogether, and tell results of some takes of theirs, of each subject and action in turn."""
    _, held = database.hold_out(subjects=subjects)
    rng = np.random.default_rng(seed)
    groups: dict[tuple[str, str], list[Take]] = {}
    for take in held.takes:
        if not take.mirrored and not take.interpolated and _usable(database, take):
            groups.setdefault((take.subject, take.action), []).append(take)
    queues = [[group[i] for i in rng.permutation(len(group))] for group in groups.values()]
    chosen = [queue[k] for k in range(max(map(len, queues), default=0)) for queue in queues if k < len(queue)][:test]
    if not chosen:
        raise DatabaseError(f"{database.path}: no take of {', '.join(subjects)} can be held out")
    return Split(database.hold_out(subjects=subjects)[0], (), tuple(chosen))


def split_actions(database: Database, each: int = 4, poses: int = 70_000, seed: int = 0,
                  actions: Sequence[str] = ("walk", "run", "jump", "punch", "swing"), avoid: Collection[Take] = ()) -> Split:
    """Hold out `each` takes of every action, and learn from about so many poses of these actions alone.

    avoid: takes not to hold out. Interpolated takes are among them: compare positions, not accelerations.
    At most half of an action's takes are held out. DatabaseError if none can be.
    """
    rng = np.random.default_rng(seed)
    chosen: list[Take] = []
    for action in actions:
        every = [take for take in database.takes if take.action == action and not take.mirrored]
        good = [take for take in _alone(database, every) if take not in avoid and _usable(database, take)]
        chosen += [good[i] for i in rng.permutation(len(good))[:min(each, len(every) // 2)]]
    if not chosen:
        raise DatabaseError(f"{database.path}: no take of {', '.join(actions)} can be held out")
    rest = without(database, chosen)
    queues = [[take for take in rest.takes if take.action == action and not take.mirrored] for action in actions]
    queues = [[queue[i] for i in rng.permutation(len(queue))] for queue in queues]
    sizes, clips, copies = [0] * len(queues), set(), 2 if any(take.mirrored for take in rest.takes) else 1
    while any(queues) and copies * sum(sizes) < poses:
        least = min((k for k, queue in enumerate(queues) if queue), key=lambda k: sizes[k])
        take = queues[least].pop()
        sizes[least] += take.stop - take.start
        clips.add(take.clip)
    return Split(rest.only([take for take in rest.takes if take.clip in clips]), (), tuple(chosen))


def long_takes(database: Database, frames: int = 3600, count: int = 4, avoid: Collection[Take] = ()) -> tuple[Take, ...]:
    """Takes that go on for so many frames after the warm start, of each subject in turn, the liveliest first."""
    found: dict[str, list[tuple[float, Take]]] = {}
    for take in database.takes:
        sound = database.sound[take.start:take.start + SPAN + frames]
        if not take.mirrored and take not in avoid and take.stop - take.start >= SPAN + frames and sound.all():
            poses = database.poses[take.start:take.start + SPAN + frames]
            found.setdefault(take.subject, []).append((float(np.abs(np.diff(poses, axis=0)).mean()), take))
    queues = [sorted(group, key=lambda one: one[0]) for group in found.values()]
    chosen: list[Take] = []
    while any(queues) and len(chosen) < count:
        chosen += [queue.pop()[1] for queue in queues if queue]
    return tuple(chosen[:count])


def without(database: Database, takes: Collection[Take]) -> Database:
    """A database less some takes, their mirror images, and whatever else bears their name: the same in another format."""
    names = {_stem(take) for take in takes}
    return database.only([take for take in database.takes if _stem(take) not in names])


def _alone(database, takes):
    """Those of some takes that are the only one of their name, mirror images aside."""
    names = Counter(_stem(take) for take in database.takes if not take.mirrored)
    return [take for take in takes if names[_stem(take)] == 1]


def _stem(take):
    return PurePosixPath(take.clip).name


def _usable(database, take):
    """Whether its first seconds are sound and long enough."""
    stop = min(take.stop, take.start + SPAN + MOST)
    return stop - take.start >= SPAN + LEAST and bool(database.sound[take.start:stop].all())


def trial(database: Database, take: Take, controls: ControlPoints, most: int = MOST) -> Trial:
    """A take's first frames, `SPAN` + `most` at most, from the origin on."""
    frames = database.frames[take.start:min(take.stop, take.start + SPAN + most)].astype(float)
    tracks = np.zeros((len(frames), 3))
    for t in range(1, len(frames)):
        tracks[t] = advance(tracks[t - 1], frames[t], 1 / database.fps)
    root, rotations = decode(frames, tracks)
    positions, orientations = forward_kinematics(SKELETON, root, rotations)
    return Trial(take, frames, tracks, positions, rotations, controls.on(positions, orientations), 1 / database.fps)


def run(method: Method, on: Trial, points: np.ndarray | None = None) -> Outcome:
    """A method's reconstruction of a trial on its own output. points: (T, n, 3) seen instead of the true ones."""
    seen = on.points if points is None else points
    memory = method.begin(on.frames[:SPAN], on.tracks[:SPAN])
    root, rotations = np.empty((len(seen) - SPAN, 3)), np.empty((len(seen) - SPAN, len(SKELETON), 3, 3))
    for t in range(SPAN, len(seen)):
        memory, pose = method.step(memory, seen[t])
        root[t - SPAN], rotations[t - SPAN] = pose.root, pose.rotations
    return Outcome(on, forward_kinematics(SKELETON, root, rotations)[0], rotations)
