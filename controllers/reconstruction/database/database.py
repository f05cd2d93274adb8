"""A motion database: takes of many people on one skeleton, float32 and memory-mapped.

One file: a head of `HEAD` bytes, the frames as `pose_vector` has them (N, WIDTH) float32, a byte for each
frame (1 where it is sound), a JSON table of the takes, and the table's length. It is written from
front to back, so that a build needs little memory, and is read by mapping it, so that it opens at
once however large it is.
"""

from __future__ import annotations

import json
import os
from collections.abc import Collection
from contextlib import ExitStack
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np

from ...body import brief
from ...files import ordinary, reason, whole
from ..pose_vector import ANGLES, JOINTS, REFERENCE, ROOT, SKELETON, WIDTH, mirror

FPS = 60.0
"""The frame rate of databases unless another one is asked for [Hz]."""
SUFFIX = ".gambolmotion"
HEAD = 64
_MAGIC = b"GAMBOL MOTION 1\n"
_CHART = {"joints": [SKELETON.names[j] for j in JOINTS], "root": list(ROOT),
          "reference": np.round(REFERENCE[JOINTS], 6).ravel().tolist()}


class DatabaseError(ValueError):
    """A file that is no motion database, or a database that has not what is asked of it."""


@dataclass(frozen=True)
class Take:
    """A recording without a cut. clip: its path below the folder it came from, without the ending.

    subject: whom it shows. action: what they do ("walk", "run", "jump", "punch", "swing", "other").
    start, stop: its frames in the database. recording: a number that a take and its mirror image
    share. mirrored: whether left and right are exchanged. interpolated: whether it was recorded at a
    lower rate than the database's, so that its accelerations are not a body's.
    """

    clip: str
    subject: str
    action: str
    start: int
    stop: int
    recording: int
    mirrored: bool = False
    interpolated: bool = False


@dataclass(frozen=True, eq=False)
class Database:
    """Frames of motion, and whose they are.

    frames: (N, WIDTH) float32, see `pose_vector`; a memory map. sound: (N,) bool, False where tracking
    failed. takes: those that count, in the order of their frames; a mirror image follows its
    original. fps: [Hz]. path: the file.
    """

    __repr__ = brief

    frames: np.ndarray
    sound: np.ndarray
    takes: tuple[Take, ...]
    fps: float
    path: Path

    @property
    def poses(self) -> np.ndarray:
        """The joints' rotation vectors (N, ANGLES) float32 [rad]."""
        return self.frames[:, :ANGLES]

    @property
    def root(self) -> np.ndarray:
        """Height, pitch, roll, yaw rate, forward and leftward velocity (N, 6) float32 [m, rad, s]."""
        return self.frames[:, ANGLES:]

    def __len__(self) -> int:
        """How many frames its takes have."""
        return sum(take.stop - take.start for take in self.takes)

    @staticmethod
    def open(path: str | Path) -> Database:
        """A database from its file. DatabaseError, naming file and fault, unless it is whole and of this chart."""
        path = Path(path)
        try:
            with ordinary(path).open("rb") as file:
                magic = file.read(len(_MAGIC))
                size = file.seek(0, os.SEEK_END)
                if magic != _MAGIC:
                    raise DatabaseError(f"{path}: is no motion database; `gambol database build` makes one")
                if size < HEAD + 8:
                    raise DatabaseError(f"{path}: ends too early; build it anew")
                file.seek(-8, os.SEEK_END)
                length = int.from_bytes(file.read(8), "little")
                if not 0 < length <= size - HEAD - 8:
                    raise DatabaseError(f"{path}: ends too early; build it anew")
                file.seek(size - 8 - length)
                about = json.loads(file.read(length))
        except OSError as error:
            raise DatabaseError(f"{path}: can't be read: {reason(error)}") from None
        except (ValueError, RecursionError) as error:
            if isinstance(error, DatabaseError):
                raise
            raise DatabaseError(f"{path}: its table of takes is damaged; build it anew") from None
        count = (size - HEAD - 8 - length) // (4 * WIDTH + 1)
        if not isinstance(about, dict) or about.get("chart") != _CHART or about.get("frames") != count:
            raise DatabaseError(f"{path}: was built by another version of Gambol; build it anew")
        try:
            takes, fps = tuple(Take(**take) for take in about["takes"]), float(about["fps"])
            if not 0.0 < fps < 1e4 or any(not 0 <= take.start <= take.stop <= count for take in takes):
                raise ValueError
        except (LookupError, TypeError, ValueError):
            raise DatabaseError(f"{path}: its table of takes is damaged; build it anew") from None
        frames = np.asarray(np.memmap(path, np.float32, "r", HEAD, (count, WIDTH)))
        sound = np.memmap(path, np.uint8, "r", HEAD + 4 * WIDTH * count, (count,)) == 1
        return Database(frames, sound, takes, fps, path)

    def only(self, takes: Collection[Take]) -> Database:
        """The same database with some of its takes only; frames keep their numbers."""
        wanted = set(takes)
        return replace(self, takes=tuple(take for take in self.takes if take in wanted))

    def hold_out(self, clips: Collection[str] = (), subjects: Collection[str] = ()) -> tuple[Database, Database]:
        """What remains, and what is held out: all takes of some clips or subjects, mirror images included.

        DatabaseError for a clip or subject that it has not.
        """
        for what, asked, there in (("clip", clips, {take.clip for take in self.takes}),
                                   ("subject", subjects, {take.subject for take in self.takes})):
            for name in asked:
                if name not in there:
                    raise DatabaseError(f"{self.path}: has no {what} {name!r}")
        held = {take for take in self.takes if take.clip in clips or take.subject in subjects}
        return self.only(set(self.takes) - held), self.only(held)

    def segments(self, m: int, stride: int = 1) -> np.ndarray:
        """Segments of m frames, `stride` apart, and the frame after them: the last frame of each (W,) int64, ascending.

        Segment w has frames last[w], last[w] − stride, … and is followed by last[w] + 1. None goes
        across takes, and none has an unsound frame from its first frame to the one that follows.
        """
        span = (m - 1) * stride
        unsound = np.concatenate([[0], np.cumsum(~self.sound)])
        found = []
        for take in self.takes:
            last = np.arange(take.start + span, take.stop - 1)
            found.append(last[unsound[last + 2] == unsound[last - span]])
        return np.concatenate([*found, np.empty(0, int)]).astype(np.int64)


class Writer:
    """Writes a database take by take; the file appears under its name when it is whole.

    mirrors: whether every take is followed by its mirror image. Use it in a `with` statement: where
    that ends with an error, nothing is left behind.
    """

    def __init__(self, path: str | Path, fps: float = FPS, mirrors: bool = True):
        self.path, self.fps, self.mirrors = Path(path), fps, mirrors
        self.takes: list[Take] = []
        self.count = 0
        self._sound: list[np.ndarray] = []

    def __enter__(self) -> Writer:
        with ExitStack() as stack:
            self._file = stack.enter_context(open(stack.enter_context(whole(self.path)), "wb"))
            self._file.write(_MAGIC.ljust(HEAD, b"\0"))
            self._closing = stack.pop_all()
        return self

    def add(self, clip: str, subject: str, action: str, frames: np.ndarray, sound: np.ndarray,
            interpolated: bool = False) -> None:
        """Append a take. frames: (T, WIDTH). sound: (T,) bool. Unsound frames are zero where they are not finite."""
        frames = np.where(np.isfinite(frames), frames, 0.0)
        recording = self.takes[-1].recording + 1 if self.takes else 0
        for mirrored in (False, True) if self.mirrors else (False,):
            self._file.write(np.ascontiguousarray(mirror(frames) if mirrored else frames, np.float32).data)
            self._sound.append(np.asarray(sound, np.uint8))
            self.takes.append(Take(clip, subject, action, self.count, self.count + len(frames), recording, mirrored,
                                   interpolated))
            self.count += len(frames)

    def __exit__(self, *error) -> None:
        with self._closing as closing:
            if error[0] is None:
                self._finish()
            else:
                closing.pop_all().__exit__(*error)

    def _finish(self) -> None:
        for sound in self._sound:
            self._file.write(sound.data)
        table = json.dumps({"fps": self.fps, "frames": self.count, "chart": _CHART,
                            "takes": [asdict(take) for take in self.takes]}).encode()
        self._file.write(table + len(table).to_bytes(8, "little"))
