"""Building a library: a folder of motion capture in, gait primitives out."""

from __future__ import annotations

import fnmatch
import tomllib
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..body import CONTACT_HEIGHT, Clip, forward_kinematics, human, mirror_index, relative, rotations as rot
from ..files import reason, tables
from . import fourier
from .cycles import EVENTS, RATE, SAMPLES, Cycle, Track, cut, track
from .idle import idle_of
from .library import DURATION, LABELS, Library, LibraryError, Primitive, channels, reference_rotations
from .mass_centre import pushable
from .selection import Choice, neighbours, select
from .first_stride_build import starts
from .turning_step_build import turns
from .velocity_correction import settle

if TYPE_CHECKING:  # who walks by a library needs no files of motion
    from ..mocap import Reading

SHORTEST = 0.6
"""What is shorter [s] holds no cycle."""
OUT = -0.6
"""The sine of how high an upper arm is raised that does not hang: 37° below level."""
LONE, STRAIGHT = 4, 0.15
"""Fewer cycles than the first that go straight ahead (turning [rad/s] and going aside [m/s] less than the second) are averaged
with their mirror images: one stride's limp is nobody's gait."""
HAND_HARMONICS = 3
"""Hands turn about their wrists by so many harmonics of a stride."""
Progress = Callable[[str, int, int], None]
"""Called with what is being done, how much of it is done and how much there is."""


@dataclass(frozen=True)
class Source:
    """Files to take cycles from: a glob inside the folder, gait families to look for, a handicap.

    skip: patterns of file names to leave out. rank: handicap in scaled velocity against other
    sources, so that one actor's cycles are preferred and others fill what that actor never did.
    """

    glob: str = "**/*"
    families: tuple[str, ...] = ("walk", "run")
    skip: tuple[str, ...] = ()
    rank: float = 0.0
    rest: bool = True

    def check(self, number: int) -> None:
        """ValueError, naming source and field, unless every field is of its kind."""
        for field, sound, wanted in (
                ("glob", isinstance(self.glob, str) and self.glob and not Path(self.glob).is_absolute(),
                 "a pattern below the folder"),
                ("families", isinstance(self.families, tuple) and self.families
                 and set(self.families) <= set(EVENTS), 'a list of "walk" and "run"'),
                ("skip", isinstance(self.skip, tuple) and all(isinstance(s, str) for s in self.skip),
                 "a list of patterns"),
                ("rank", isinstance(self.rank, (int, float)) and 0 <= self.rank < 10, "a number from 0 to 10"),
                ("rest", isinstance(self.rest, bool), "true or false")):
            if not sound:
                raise ValueError(f"source {number}, {field}: needs {wanted}, got {getattr(self, field)!r}")


def read_recipe(path: str | Path) -> tuple[list[Source], str]:
    """Sources and provenance text of a recipe file (TOML). LibraryError names file and field."""
    try:
        recipe = tables(path)
        given, provenance = recipe.get("source", []), recipe.get("provenance", "")
        if not isinstance(given, list) or not all(isinstance(one, dict) for one in given):
            raise ValueError("sources are tables, each under [[source]]")
        if not isinstance(provenance, str):
            raise ValueError(f"provenance: needs a text, got {provenance!r}")
        fields: list[dict[str, Any]] = [{k: tuple(v) if isinstance(v, list) else v for k, v in s.items()} for s in given]
        sources = [Source(**one) for one in fields]
        for number, source in enumerate(sources, 1):
            source.check(number)
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError, TypeError, ValueError) as error:
        raise LibraryError(f"{path}: not a library recipe: {reason(error)}") from None
    if not sources:
        raise LibraryError(f"{path}: a recipe needs at least one [[source]]")
    return sources, provenance


def gather(folder: Path, sources: list[Source], progress: Progress | None = None, reading: Reading | None = None
           ) -> tuple[list[tuple[Track, Source, str]], list[str]]:
    """All clips of a folder on the standard human, prepared for cutting; and what could not be read.

    Clips on the same skeleton are calibrated together. Each comes with its source and its actor. reading: how all of them are to be read; judged by default.
    """
    from ..mocap import JUDGED, MotionFileError, calibrate, retarget

    found: dict[tuple[int, str], list[Path]] = {}
    for number, source in enumerate(sources):
        for path in sorted(folder.glob(source.glob)):
            if path.suffix.lower() in (".bvh", ".amc") and not any(fnmatch.fnmatch(path.name, s) for s in source.skip):
                found.setdefault((number, str(path.parent)), []).append(path)
    total, done, problems, tracks = sum(map(len, found.values())), 0, [], []
    if not total:
        raise LibraryError(f"{folder}: no .bvh or .amc files in it" + (
            "" if folder.is_dir() else " (it is a file; a folder of them is needed)" if folder.exists() else " (no such folder)"))
    for (number, parent), paths in found.items():
        groups: dict[tuple, list[Clip]] = {}
        for path in paths:
            done += 1
            if progress:
                progress("reading", done, total)
            try:
                clip = (reading or JUDGED).load(path)
                if len(clip) * clip.frame_time > SHORTEST:
                    groups.setdefault(_same_skeleton(clip), []).append(clip)
                else:
                    problems.append(f"{path}: {len(clip) * clip.frame_time:.2f} s are too short for a cycle; more than {SHORTEST:g} are needed")
            except MotionFileError as error:
                problems.append(str(error))
        for clips in groups.values():
            try:
                calibration = calibrate(clips)
            except ValueError as error:
                problems.append(f"{parent}: {', '.join(clip.name for clip in clips[:3])}{', …' * (len(clips) > 3)}: {error}")
                continue
            for clip in clips:
                tracks.append((track(retarget(clip, calibration=calibration)), sources[number], parent))
    return tracks, problems


def _same_skeleton(clip: Clip) -> tuple:
    return clip.skeleton.names, tuple(np.round(clip.skeleton.offsets[1:], 3).ravel())


@dataclass(frozen=True, eq=False)
class Collection:
    """What a folder yields. rank, actor: (C,) of each cycle: its source's handicap, its folder."""

    tracks: list[tuple[Track, Source, str]]
    cycles: list[Cycle]
    rank: np.ndarray
    actor: np.ndarray
    problems: list[str]


def collect(folder: str | Path, sources: list[Source], progress: Progress | None = None, reading: Reading | None = None) -> Collection:
    """All gait cycles of a folder. LibraryError if there are no motion files in it."""
    tracks, problems = gather(Path(folder), sources, progress, reading)
    cycles, rank, actor = [], [], []
    for number, (one, source, parent) in enumerate(tracks):
        for family in source.families:
            for cycle in cut(one, family):
                cycles.append(cycle)
                rank.append(source.rank)
                actor.append(parent)
        if progress:
            progress("cutting cycles", number + 1, len(tracks))
    return Collection(tracks, cycles, np.array(rank), np.array(actor), problems)


def build_library(folder: str | Path, recipe: str | Path | None = None,
                  progress: Progress | None = None, reading: Reading | None = None) -> tuple[Library, list[str]]:
    """A library from a folder of BVH and ASF/AMC files, all read so, and notes on what was missing or unreadable.

    LibraryError if the folder yields no walk that spans the control space.
    """
    sources, provenance = read_recipe(recipe) if recipe else ([Source()], "")
    found = collect(folder, sources, progress, reading)
    walk, missing = select(found.cycles, found.rank, "walk")
    run, _ = select(found.cycles, found.rank, "run")
    if len(walk) < 8:
        raise LibraryError(f"{folder}: only {len(walk)} usable walking cycles; a library needs steady walking "
                           "in several directions (forward, turning, sideways)"
                           + "".join(f"\n{problem}" for problem in found.problems))
    stills = [one for one, source, _ in found.tracks if source.rest]
    library = assemble(found.cycles, found.actor, walk + run, stills, provenance)
    rest = library.coefficients[library.rest, 0, :LABELS]
    library = replace(library, accelerations=natural_accelerations(found.tracks),
                      idle=idle_of(stills, library.reference, rest))
    library = settle(library, progress)
    library = replace(library, start=starts(stills, library), turn=turns(stills, [one for one, source, _ in found.tracks if source.families[0] == "walk"], library))
    return library, found.problems + [f"no cycle for {label}" for label in missing]


def natural_accelerations(tracks: list[tuple[Track, Source, str]]) -> dict[str, np.ndarray]:
    """By family, the 99th percentile (J,) [m/s²] of every joint's acceleration in its recordings.

    What is jerky is judged against it. A source that may hold both families counts as walking.
    """
    result = {}
    for family in ("walk", "run"):
        found = [t.acceleration for t, source, _ in tracks if source.families[0] == family and len(t.acceleration)]
        if found:
            result[family] = np.percentile(np.concatenate(found), 99, axis=0)
    return result


def assemble(cycles: list[Cycle], actor: np.ndarray, chosen: list[Choice], stills: list[Track],
             provenance: str = "") -> Library:
    """Fourier coefficients of the chosen cycles, each averaged with its neighbours, and of rest."""
    skeleton = human()
    swap = mirror_index(skeleton)
    reference = reference_rotations([cycles[c.cycle] for c in chosen])
    primitives, velocities, rows = [], [], []
    for choice in chosen:
        seed = cycles[choice.cycle]
        near, weight = neighbours(cycles, actor, choice.cycle, seed.family)
        group = [mirrored(cycles[i], swap) if choice.mirrored else cycles[i] for i in near]
        if len(group) < LONE and max(abs(seed.velocity[1]), abs(seed.velocity[2])) < STRAIGHT:
            group, weight = group + [mirrored(one, swap) for one in group], np.tile(0.5 * weight, 2)
        samples = np.asarray(sum(w * channels(c, reference) for w, c in zip(weight, group)))
        primitives.append(Primitive(choice.label, seed.clip, seed.start, seed.period, seed.family, seed.closure,
                                    tuple(map(float, seed.events)), choice.mirrored, len(near)))
        velocities.append(np.asarray(sum(w * c.velocity for w, c in zip(weight, group))))
        rows.append(_calm_hands(fourier.fit(pushable(samples, reference, velocities[-1]))))
    walking = [i for i, p in enumerate(primitives) if p.family == "walk"]
    rest, clip, start = rest_pose(stills, reference)
    row = np.zeros_like(rows[0])
    row[0, :LABELS] = rest
    row[:, LABELS:] = np.mean([rows[i][:, LABELS:] for i in walking], 0)  # it steps in place until its feet are right
    primitives.append(Primitive("rest", clip, start, float(row[0, DURATION]), "rest", 0.0, tuple(map(float, EVENTS["walk"]))))
    return Library(skeleton, tuple(primitives), np.array(velocities + [np.zeros(3)]), np.array(rows + [row]),
                   reference, provenance)


def _calm_hands(row: np.ndarray) -> np.ndarray:
    """A primitive's coefficients (2 N + 1, D) whose hands turn as smoothly as arms swing: what is quicker is a marker that was lost for a moment."""
    for side in ("Left", "Right"):
        hand = human().index(side + "Hand")
        row[1 + 2 * HAND_HARMONICS:, 3 * hand:3 * hand + 3] = 0.0
    return row


def mirrored(cycle: Cycle, swap: np.ndarray) -> Cycle:
    """The same cycle with left and right exchanged, half a cycle on, so that it starts at left toe-off."""
    half = SAMPLES // 2
    plane = np.diag([-1.0, 1.0, 1.0])
    def turn(samples):
        return np.roll(samples, -half, axis=0)
    return replace(cycle, velocity=cycle.velocity * [1, -1, -1],
                   rotations=turn(plane @ cycle.rotations[:, swap] @ plane), hips=turn(cycle.hips) * [-1, 1, 1],
                   labels=turn(cycle.labels[:, [2, 3, 0, 1]]), duration=turn(cycle.duration))


def rest_pose(tracks: list[Track], reference: np.ndarray) -> tuple[np.ndarray, str, float]:
    """How somebody stands: still, flat, upright, and not far from walking; never with both arms out, as in a T-pose, if there is anything else.

    Of all seconds with quiet feet, the best by speed and flatness of the feet, height of the hips
    and distance from the mean walking pose. Returns chart and hips (3 J + 3,) in the ground frame, and the clip
    and time where it was found. LibraryError without any clip.
    """
    second, candidates = int(RATE), []
    for one in tracks:
        fastest = one.speeds.max(1)
        for a in range(0, max(len(fastest) - second, 1), second // 2):
            speed = float(fastest[a:a + second].mean())
            if speed < 0.05 or not candidates:
                uneven = float(np.abs(one.points[a:a + second, :, 1] - CONTACT_HEIGHT).mean())
                candidates.append((speed / 0.02 + uneven / 0.005, a, one))
    if not candidates:
        raise LibraryError("no clip to take the standing pose from")
    charts, hips = [], []
    for _, a, one in candidates:
        local = one.clip.slice(a, a + second).rotations
        ground = one.ground[a:a + second].mean(0)
        local[:, 0] = rot.yaw(-ground[2]) @ local[:, 0]
        charts.append(rot.log(np.swapaxes(reference, -1, -2) @ rot.mean(local)))
        root = one.clip.root[a:a + second].mean(0)
        place = relative(ground, np.array([root[0], root[2], ground[2]]))
        hips.append([place[0], root[1], place[1]])
    charts, hips = np.array(charts), np.array(hips)
    cost = (np.array([c[0] for c in candidates]) - hips[:, 1] / 0.01
            + np.sqrt(np.mean(np.sum(charts**2, -1), -1)) / 0.10)
    held = arms_out(reference @ rot.exp(charts))
    best = int(np.argmin(cost + (1e9 * held if not held.all() else 0.0)))
    return (np.concatenate([charts[best].ravel(), hips[best]]), candidates[best][2].clip.name,
            candidates[best][1] / RATE)


def arms_out(rotations: np.ndarray) -> np.ndarray:
    """Whether both upper arms of poses (N, J, 3, 3) are farther up than `OUT`: (N,) bool. A guard's fists are high, its elbows are not."""
    skeleton = human()
    places = forward_kinematics(skeleton, np.zeros((len(rotations), 3)), rotations)[0]
    ways = [places[:, skeleton.index(side + "ForeArm")] - places[:, skeleton.index(side + "Arm")] for side in ("Left", "Right")]
    return np.all([way[:, 1] > OUT * np.linalg.norm(way, axis=-1) for way in ways], axis=0)
