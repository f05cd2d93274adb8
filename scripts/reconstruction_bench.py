"""What the methods are measured on, and their outcomes, kept on disk: what was measured once is not measured again."""

from __future__ import annotations

import hashlib
import json
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn
from scipy.spatial.transform import Rotation

import controllers.reconstruction
from controllers.body import forward_kinematics
from controllers.reconstruction import trials
from controllers.reconstruction.chart import SKELETON
from controllers.reconstruction.controls import parse
from controllers.reconstruction.database import Database, DatabaseError, Take
from controllers.reconstruction.database_build import build
from controllers.reconstruction.method import SPAN
from controllers.reconstruction.store import identity

from reconstruction_rivals import RIVALS, Rival

_HOME = Path(controllers.reconstruction.__file__).parent


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
                                 console=Console(stderr=True))

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
        rival = RIVALS[name]
        settings = dict(rival.settings) | (settings or {})
        key = _digest([name, identity(course.learnt), points, settings, _code(rival)])
        if key not in self._learnt:
            bar = self.progress.add_task(f"learning {name}, {points} points", total=None)
            self._learnt.clear()
            self._learnt[key] = rival.learn(course.learnt, parse(points, SKELETON), **settings)
            self.progress.remove_task(bar)
        return self._learnt[key]

    def outcomes(self, name: str, course: Course, points: str, settings: dict | None = None, noise: float = 0.0,
                 hidden: float = 0.0) -> list[trials.Outcome]:
        """What a method makes of a course's takes. settings: instead of the rival's own.

        noise: standard deviation [m] of each coordinate of the points. hidden: for how long each point is lost once [s].
        """
        rival, tests = RIVALS[name], self.trials(course, points)
        told = [name, identity(course.learnt), [(take.clip, take.mirrored) for take in course.takes], course.most, points,
                dict(rival.settings) | (settings or {}), noise, hidden, self.seed, _code(rival)]
        path = self.cache / f"{course.name}-{points}-{name}-{_digest(told)}.npz".replace(" ", "_").replace(",", "")
        if path.exists():
            with np.load(path) as file:
                root, vectors = file["root"].astype(float), file["vectors"].astype(float)
        else:
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
        ends = np.cumsum([len(trial.frames) - SPAN for trial in tests])[:-1]
        rotations = Rotation.from_rotvec(vectors.reshape(-1, 3)).as_matrix().reshape(*vectors.shape[:2], 3, 3)
        return [trials.Outcome(trial, forward_kinematics(SKELETON, place, turned)[0], turned) for trial, place, turned
                in zip(tests, np.split(root, ends), np.split(rotations, ends), strict=True)]

    def trials(self, course: Course, points: str) -> list[trials.Trial]:
        """A course's takes with some control points."""
        controls = parse(points, SKELETON)
        return [trials.trial(course.learnt, take, controls, course.most) for take in course.takes]

    def times(self, name: str, course: Course, points: str, frames: int = 600) -> np.ndarray:
        """How long each frame takes [s], on the first takes of a course; nothing is kept."""
        method, found = self.learn(name, course, points), []
        for trial in self.trials(course, points):
            memory = method.begin(trial.frames[:SPAN], trial.tracks[:SPAN])
            for seen in trial.points[SPAN:]:
                began = time.perf_counter()
                memory, _ = method.step(memory, seen)
                found.append(time.perf_counter() - began)
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
    """From which frame on each point of a take is lost (n,)."""
    rng = np.random.default_rng([seed, number, 1])
    return rng.integers(SPAN, max(SPAN + 1, frames - 2 * round(hidden / dt)), count)


def courses(main: Database, large: Database, takes: int, seed: int) -> dict[str, Course]:
    """All that is measured on, by name. large: a database with all of main's clips, or main itself.

    DatabaseError where main has too little.
    """
    clips = {take.clip for take in main.takes}
    main = large.only([take for take in large.takes if take.clip in clips])
    if {take.clip for take in main.takes} != clips:
        raise DatabaseError(f"{large.path}: lacks takes of {main.path}; the large database must hold the small one's, too")
    true = main.only([take for take in main.takes if not take.interpolated])
    core = trials.split(true, takes, takes // 2, seed)
    actions = trials.split_actions(main, seed=seed, avoid=core.validation)
    strangers = trials.split_subjects(true, _strangers(true, seed), takes, seed)
    minutes = trials.long_takes(large)
    return {
        "seen": Course("seen subjects", core.learnt, core.test),
        "validation": Course("validation", core.learnt, core.validation, 300),
        "actions": Course("five actions", actions.learnt, actions.test),
        "strangers": Course("unseen subjects", strangers.learnt, strangers.test),
        "seen, large": Course("seen subjects, large database", trials.without(large, core.test), core.test),
        "actions, large": Course("five actions, large database", trials.without(large, actions.test), actions.test),
        "minute": Course("a minute", trials.without(large, minutes), minutes, 3600),
    }


def _strangers(database, seed) -> Sequence[str]:
    """Every third subject."""
    subjects = sorted({take.subject for take in database.takes})
    return sorted(np.random.default_rng(seed).permutation(subjects)[:max(1, len(subjects) // 3)].tolist())


def _code(rival: Rival) -> str:
    told = hashlib.sha1()
    for pattern in rival.sources:
        for path in sorted(_HOME.glob(pattern)):
            told.update(path.read_bytes())
    return told.hexdigest()


def _digest(what) -> str:
    return hashlib.sha1(json.dumps(what, sort_keys=True).encode()).hexdigest()[:12]
