"""What the methods are measured on, and their outcomes, kept on disk: what was measured once is not measured again."""

from __future__ import annotations

import hashlib
import json
import time
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn
from scipy.spatial.transform import Rotation

import gambol.controllers.reconstruction as method_room
from gambol.controllers.body import forward_kinematics
from gambol.controllers.reconstruction import SKELETON, parse
from gambol.controllers.reconstruction.database import Database, DatabaseError, Take, build, identity
from gambol.controllers.reconstruction.evaluation import trials
from gambol.controllers.reconstruction.regression import SPAN

from reconstruction_methods import RIVALS, Rival

_HOME = Path(method_room.__file__).parent


@dataclass(frozen=True, eq=False)
class Course:
    """Takes to reconstruct, and what to learn from before. name: for the progress bar. most: frames of each take."""

    name: str
    learnt: Database
    takes: tuple[Take, ...]
    most: int = trials.MOST


@dataclass(eq=False)
class Bench:
    """Runs methods on courses. cache: where outcomes are kept. seed: of all that is drawn."""

    cache: Path
    seed: int = 0
    _learnt: dict[str, Any] = field(default_factory=dict)

    def __post_init__(self):
        self.cache.mkdir(parents=True, exist_ok=True)
        self.progress = Progress(TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn(),
                                 console=Console(stderr=True), redirect_stdout=False)

    def database(self, where: Path) -> Database:
        """A database from its file, or built from a folder of motion files."""
        if not where.is_dir():
            return Database.open(where)
        files = [(str(path), path.stat().st_size, path.stat().st_mtime) for path in sorted(where.rglob("*")) if path.is_file()]
        path = self.cache / f"{where.resolve().name}-{_digest(files)}.gambolmotion"
        if not path.exists():
            bar = self.progress.add_task(f"reading {where}")
            build(where, path, progress=lambda done, all_: self.progress.update(bar, completed=done, total=all_))
            self.progress.remove_task(bar)
        return Database.open(path)

    def learn(self, name: str, course: Course, points: str, settings: dict | None = None) -> Any:
        """A method learnt from a course's database; the last one is remembered."""
        baseline = RIVALS[name]
        settings = dict(baseline.settings) | (settings or {})
        key = _digest([name, identity(course.learnt), points, settings, _code(baseline)])
        if key not in self._learnt:
            bar = self.progress.add_task(f"learning {name}, {points} points", total=None)
            self._learnt.clear()
            self._learnt[key] = baseline.learn(course.learnt, parse(points, SKELETON), **settings)
            self.progress.remove_task(bar)
        return self._learnt[key]

    def outcomes(self, name: str, course: Course, points: str, settings: dict | None = None, noise: float = 0.0,
                 hidden: float = 0.0) -> list[trials.Outcome]:
        """What a method makes of a course's takes. settings: instead of the rival's own.

        noise: standard deviation [m] of each coordinate of the points. hidden: for how long each point is lost once [s].
        """
        baseline, tests = RIVALS[name], self.trials(course, points)
        told = [name, identity(course.learnt), [(take.clip, take.mirrored) for take in course.takes], course.most, points,
                dict(baseline.settings) | (settings or {}), noise, hidden, self.seed, _code(baseline)]
        path = self.cache / f"{course.name}-{points}-{name}-{_digest(told)}.npz".replace(" ", "_").replace(",", "")
        if not path.exists():
            method = self.learn(name, course, points, settings)
            bar = self.progress.add_task(f"{course.name}, {points} points: {name}", total=len(tests))
            made = []
            for number, trial in enumerate(tests):
                made.append(trials.run(method, trial, spoilt(trial.points, number, noise, hidden, trial.dt, self.seed)))
                self.progress.advance(bar)
            self.progress.remove_task(bar)
            root = np.concatenate([one.positions[:, 0] for one in made])
            turned = np.concatenate([one.rotations for one in made])
            vectors = Rotation.from_matrix(turned.reshape(-1, 3, 3)).as_rotvec().reshape(*turned.shape[:2], 3)
            with path.with_suffix(".part").open("wb") as file:
                np.savez(file, root=root.astype(np.float32), vectors=vectors.astype(np.float32))
            path.with_suffix(".part").replace(path)
        with np.load(path) as file:
            root, vectors = file["root"].astype(float), file["vectors"].astype(float)
        ends = np.cumsum([len(trial.frames) - SPAN for trial in tests])[:-1]
        rotations = Rotation.from_rotvec(vectors.reshape(-1, 3)).as_matrix().reshape(*vectors.shape[:2], 3, 3)
        return [trials.Outcome(trial, forward_kinematics(SKELETON, place, turned)[0], turned) for trial, place, turned
                in zip(tests, np.split(root, ends), np.split(rotations, ends), strict=True)]

    def trials(self, course: Course, points: str) -> list[trials.Trial]:
        """A course's takes with some control points."""
        controls = parse(points, SKELETON)
        return [trials.trial(course.learnt, take, controls, course.most) for take in course.takes]

    def times(self, name: str, course: Course, points: str, frames: int = 600) -> np.ndarray:
        """How long each frame takes (F, 2) [s], by the clock and of the process, on a course's first takes; nothing is kept."""
        method, found = self.learn(name, course, points), []
        for trial in self.trials(course, points):
            memory = method.begin(trial.frames[:SPAN], trial.tracks[:SPAN])
            for seen in trial.points[SPAN:]:
                began = time.perf_counter(), time.process_time()
                memory, _ = method.step(memory, seen)
                found.append((time.perf_counter() - began[0], time.process_time() - began[1]))
            if len(found) >= frames:
                break
        return np.array(found[10:])


def spoilt(points: np.ndarray, number: int, noise: float, hidden: float, dt: float, seed: int = 0) -> np.ndarray:
    """The points (T, n, 3) of a take as a poor tracker sees them, NaN where lost; the same for each method.

    Each is lost once, at a time of its own in the middle of the take; the warm start is never spoilt.
    """
    rng = np.random.default_rng([seed, number])
    points = points + np.where(np.arange(len(points))[:, None, None] < SPAN, 0.0, noise * rng.normal(size=points.shape))
    for point, first in enumerate(lost_from(len(points), points.shape[1], number, hidden, dt, seed)):
        points[first:first + round(hidden / dt), point] = np.nan
    return points


def lost_from(frames: int, count: int, number: int, hidden: float, dt: float, seed: int = 0) -> np.ndarray:
    """From which frame on each point of a take is lost (n,): early enough to come back. After the end if it is too short."""
    last = frames - 2 * round(hidden / dt)
    return np.random.default_rng([seed, number, 1]).integers(SPAN, last, count) if last > SPAN else np.full(count, frames)


class Courses:
    """All that is measured on, each made when it is asked for. large: a database with all of main's clips, or main itself."""

    def __init__(self, main: Database, large: Database, takes: int, seed: int):
        self.large, self.takes, self.seed = large, takes, seed
        clips = {take.clip for take in main.takes}
        self.main = large.only([take for take in large.takes if take.clip in clips])
        if {take.clip for take in self.main.takes} != clips:
            raise DatabaseError(f"{large.path}: lacks takes of {main.path}; the large database must hold the small one's, too")
        self.true = self.main.only([take for take in self.main.takes if not take.interpolated])

    @cached_property
    def seen(self) -> Course:
        """Takes of subjects others of whose takes are learnt from."""
        return Course("seen subjects", self._core.learnt, self._core.test)

    @cached_property
    def validation(self) -> Course:
        """Others of the same, to tune on."""
        return Course("validation", self._core.learnt, self._core.validation, 300)

    @cached_property
    def actions(self) -> Course:
        """The paper's five actions, interpolated takes among them; they alone are learnt from."""
        split = trials.split_actions(self.main, seed=self.seed, avoid=self._core.validation)
        return Course("five actions", split.learnt, split.test)

    @cached_property
    def strangers(self) -> Course:
        """Takes of every third subject, none of whom is learnt from."""
        subjects = sorted({take.subject for take in self.true.takes})
        drawn = np.random.default_rng(self.seed).permutation(subjects)[:max(1, len(subjects) // 3)]
        split = trials.split_subjects(self.true, sorted(drawn.tolist()), self.takes, self.seed)
        return Course("unseen subjects", split.learnt, split.test)

    @cached_property
    def seen_large(self) -> Course:
        """As `seen`, all else learnt from."""
        return Course("seen subjects, large database", trials.without(self.large, self.seen.takes), self.seen.takes)

    @cached_property
    def actions_large(self) -> Course:
        """As `actions`, all else learnt from."""
        return Course("five actions, large database", trials.without(self.large, self.actions.takes), self.actions.takes)

    @cached_property
    def minute(self) -> Course:
        """The longest takes there are, a minute of each, all else learnt from; maybe none."""
        takes = trials.long_takes(self.large)
        return Course("a minute", trials.without(self.large, takes), takes, 3600)

    @cached_property
    def _core(self):
        return trials.split(self.true, self.takes, self.takes // 2, self.seed)


def _code(baseline: Rival) -> str:
    told = hashlib.sha1()
    for pattern in baseline.sources:
        for path in sorted(_HOME.glob(pattern)):
            told.update(path.read_bytes())
    return told.hexdigest()


def _digest(what) -> str:
    return hashlib.sha1(json.dumps(what, sort_keys=True).encode()).hexdigest()[:12]
