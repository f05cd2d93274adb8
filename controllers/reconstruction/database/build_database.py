"""Building a motion database: a folder of motion capture in, one file out."""

from __future__ import annotations

import csv
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...body import Clip
from ...mocap import JUDGED, MotionFileError, Reading, calibrate, elbows, hinged, retarget
from ..pose_vector import ANGLES, FORWARD, HEIGHT, JOINTS, LEFTWARD, PITCH, ROLL, encode
from .database import FPS, Database, DatabaseError, Writer

Progress = Callable[[int, int], None]
"""Called with how many files are done and how many there are."""

LEAST = 4
"""A take has so many frames at least, and lasts as long as they do."""
JUMP = 0.6
"""No joint and no pelvis turns further than this [rad] in a sixtieth of a second."""
EDGE = 3.0
"""Rotation vectors longer than this [rad] are about to wrap."""
_TILT = 2.8  # rad: nearly upside down, where the heading is undefined
_FASTEST = 12.0  # m/s, of the hips over ground; the fastest of men run as fast
_HEIGHTS = -1.0, 4.0  # m, of the hips
_CALIBRATING = 20_000  # frames: more than enough stance and walking for one skeleton

_AT_ONCE = 200_000  # frames held in memory, with the clip that goes beyond

_ACTIONS = (("jump", r"jump|hop(?!e)|leap"), ("punch", r"punch|box|hook|jab"), ("swing", r"golf|swing|tennis|stroke"),
            ("run", r"run|jog|sprint"), ("walk", r"walk|stroll|march"))


@dataclass(frozen=True)
class Built:
    """What a build made. problems: one line for each file that was left out."""

    database: Database
    problems: list[str]


def build(folder: str | Path, out: str | Path, *, fps: float = FPS, mirrors: bool = True,
          progress: Progress | None = None, reading: Reading = JUDGED) -> Built:
    """Make a database of all .bvh and .amc files of a folder and those below it.

    fps: [Hz]. mirrors: whether to add the mirror image of every take. reading: how all of them are to be read. Files that can't be read are
    left out and told of. DatabaseError if nothing is left, or for an fps outside 10 … 240.
    """
    folder, problems = Path(folder), []
    if not 10 <= fps <= 240:
        raise DatabaseError(f"{fps:g} frames a second: a database needs 10 … 240")
    paths = sorted((path for path in folder.rglob("*") if path.suffix.lower() in (".bvh", ".amc")),
                   key=lambda path: (path.parent, path))
    if not paths:
        raise DatabaseError(f"{folder}: no .bvh or .amc files in it" + (
            "" if folder.is_dir() else " (it is a file; a folder of them is needed)" if folder.exists() else " (no such folder)"))
    known = actions(folder)
    with Writer(out, fps, mirrors) as writer:
        def keep(clips: list[tuple[Path, Clip]]) -> None:
            for path, clip in _on_our_skeleton(clips, known, folder, problems):
                interpolated = clip.frame_time > 1.01 / fps
                clip = clip.resample(fps)
                frames, _ = encode(clip.root, clip.rotations, clip.frame_time)
                name = path.relative_to(folder).with_suffix("").as_posix()
                writer.add(name, subject(path, folder), _action(path, folder, known), frames, sound(clip, frames),
                           interpolated)

        clips: list[tuple[Path, Clip]] = []
        for done, path in enumerate(paths, 1):
            # the clips of one folder are calibrated together: most often they show one person
            if clips and (path.parent != clips[0][0].parent or sum(len(clip) for _, clip in clips) > _AT_ONCE):
                keep(clips)
                clips = []
            try:
                clips.append((path, _at_most(reading.load(path), fps, path)))
            except MotionFileError as error:
                problems.append(str(error))
            if progress:
                progress(done, len(paths))
        keep(clips)
        if not writer.takes:
            raise DatabaseError(f"{folder}: none of its {len(paths)} motion files can be used"
                                + "".join(f"\n{problem}" for problem in problems[:5]))
    return Built(Database.open(out), problems)


def _at_most(clip: Clip, fps: float, path: Path) -> Clip:
    """The clip at no more than fps [Hz]: what is thrown away later need not be retargeted."""
    if len(clip) < LEAST or clip.duration * fps < LEAST - 1.01:
        raise MotionFileError(f"{path}: {len(clip)} frames in {clip.duration:.3g} s are too few; a take needs {LEAST} in {(LEAST - 1) / fps:.3g} s at least")
    return clip.resample(fps) if clip.frame_time < 0.99 / fps else clip


def _on_our_skeleton(clips, known, folder, problems) -> Iterator[tuple[Path, Clip]]:
    """The clips of one folder on our skeleton, those of the same one calibrated together."""
    groups: dict[tuple, list[tuple[Path, Clip]]] = {}
    for path, clip in clips:
        key = clip.skeleton.names, tuple(np.round(clip.skeleton.offsets[1:], 3).ravel())
        groups.setdefault(key, []).append((path, clip))
    for group in groups.values():
        # walking tells most about how a skeleton stands
        order = sorted(group, key=lambda one: _action(one[0], folder, known) != "walk")
        before = np.cumsum([0, *(len(clip) for _, clip in order[:-1])])
        try:
            calibration = calibrate([clip for (_, clip), start in zip(order, before) if start < _CALIBRATING])
        except ValueError as error:
            some = ", ".join(path.name for path, _ in group[:3]) + ", …" * (len(group) > 3)
            problems.append(f"{group[0][0].parent}: {some} left out: {error}")
            continue
        ours = [retarget(clip, calibration=calibration) for _, clip in group]
        rolls = elbows(ours)
        yield from ((path, hinged(clip, rolls)) for (path, _), clip in zip(group, ours, strict=True))


def sound(clip: Clip, frames: np.ndarray) -> np.ndarray:
    """Which frames (T,) are sound: neither end of a jump, finite, humanly possible, inside the chart.

    clip: at the database's rate, on our skeleton. frames: (T, WIDTH) the same encoded. Toes are not
    looked at. `JUMP` is of a sixtieth of a second, and in proportion for others.
    """
    joints = [0, *JOINTS]
    alike = np.abs(np.sum(clip.quaternions[1:, joints] * clip.quaternions[:-1, joints], -1))
    turn = 2 * np.arccos(np.clip(alike, 0.0, 1.0))
    jumps = (turn > JUMP * 60 * clip.frame_time).any(1)
    good = np.all(np.isfinite(frames), axis=1)
    good[1:] &= ~jumps
    good[:-1] &= ~jumps
    turned = np.linalg.norm(frames[:, :ANGLES].reshape(len(frames), -1, 3), axis=-1).max(1)
    good &= (turned < EDGE) & (np.hypot(frames[:, PITCH], frames[:, ROLL]) < _TILT)
    good &= np.hypot(frames[:, FORWARD], frames[:, LEFTWARD]) < _FASTEST
    return good & (frames[:, HEIGHT] > _HEIGHTS[0]) & (frames[:, HEIGHT] < _HEIGHTS[1])


def actions(folder: Path) -> dict[str, str]:
    """What an `index.tsv` in the folder says each file shows, by path; empty where there is none."""
    index = folder / "index.tsv"
    if not index.is_file():
        return {}
    with index.open(encoding="utf-8", errors="replace", newline="") as file:
        rows = csv.DictReader(file, delimiter="\t", quoting=csv.QUOTE_NONE)
        return {row["path"]: row["action"] for row in rows if row.get("path") and row.get("action")}


def _action(path: Path, folder: Path, known: dict[str, str]) -> str:
    """From the index, else from words in the path, else "other"."""
    name = path.relative_to(folder).as_posix()
    words = name.lower()
    return known.get(name) or next((action for action, pattern in _ACTIONS if re.search(pattern, words)), "other")


def subject(path: Path, folder: Path) -> str:
    """Whom a file shows: CMU's names begin with the subject's number (`07_05.amc`); otherwise its folder."""
    numbered = re.fullmatch(r"(\d{2,3})_\d{2,3}", path.stem)
    return numbered[1] if numbered else path.parent.relative_to(folder).as_posix() or folder.name
