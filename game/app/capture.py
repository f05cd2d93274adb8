"""What one keeps while playing: screenshots, and films that a second program makes of the log.

Neither holds up the game: pictures are packed by a thread, films are drawn by a process that
takes only what time is left over.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..files import OutputError, named, output_file, output_folder, whole
from ..session import SUFFIX, SessionState

OUT = Path("out")
"""Where what is kept while playing goes, unless it is named."""
PROGRESS = re.compile(r"(\d+) of (\d+)")


def unused(folder: Path, stem: str, suffix: str) -> Path:
    """A path that nothing stands at yet: STEM.suffix, STEM-2.suffix, …"""
    for number in range(1, 100_000):
        path = folder / f"{stem}{f'-{number}' if number > 1 else ''}{suffix}"
        if not path.exists() and not path.with_name(f"{path.stem}.part{suffix}").exists():
            return path
    raise FileExistsError(f"{folder}: is full of {stem}{suffix}")


def stamped(folder: Path, suffix: str) -> Path:
    """A path named after the present time that nothing stands at yet."""
    return unused(folder, time.strftime("gambol-%Y%m%d-%H%M%S"), suffix)


def log_file(given: Path | None) -> Path:
    """Where to keep the log of a game: in the file that is named, else in one of its own.

    OutputError for a name that is there already, or where this user may not write; where that is
    not asked for, one plays without rather than not at all.
    """
    if given is None:
        return stamped(OUT, SUFFIX)
    if given.exists() and not given.is_dir():
        raise OutputError(f"{given}: is there already, and a log is never overwritten; name another file")
    return output_file(given, SUFFIX)


class Film:
    """A film of a part of a log that another process makes. arguments: of `gambol render`."""

    def __init__(self, path: Path, arguments: Sequence[str]):
        self.path, self.done, self.total, self.said = path, 0, 0, ""
        command = [sys.executable, "-P", "-m", "gambol.game.cli", "render", *arguments, "-o", str(path), "--background"]
        # one thread of software drawing leaves the game a core of its own
        self._process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                         stderr=subprocess.PIPE, encoding="utf-8", errors="replace",
                                         start_new_session=True,
                                         creationflags=getattr(subprocess, "BELOW_NORMAL_PRIORITY_CLASS", 0),
                                         env=os.environ | {"LP_NUM_THREADS": "1", "OMP_NUM_THREADS": "1",
                                                           "PYTHONIOENCODING": "utf-8"})
        self._reader = threading.Thread(target=self._listen, daemon=True)
        self._reader.start()

    def _listen(self) -> None:
        assert self._process.stderr is not None  # it is a pipe
        for line in self._process.stderr:
            if found := PROGRESS.fullmatch(line.strip()):
                self.done, self.total = int(found[1]), int(found[2])
            elif line.strip():
                self.said = line.strip().removeprefix("gambol: ")

    @property
    def running(self) -> bool:
        """Whether it is still being made."""
        return self._process.poll() is None

    def status(self) -> str:
        """One line for the picture."""
        if self.running:
            return f"{self.path}: {100 * self.done // self.total} %" if self.total else f"{self.path}: beginning"
        self._reader.join(1.0)
        return self.said or str(self.path)

    def wait(self) -> None:
        """Wait until it is made."""
        self._process.wait()

    def stop(self) -> None:
        """Give it up; what was drawn so far is kept beside it."""
        self._process.terminate()
        self._process.wait()


class Capture:
    """Where screenshots and films go. options: what `gambol render` needs to draw the same character."""

    def __init__(self, folder: Path, options: Sequence[str] = ()):
        self.folder, self.options = folder, tuple(options)
        self.films: list[Film] = []
        self._waiting: list[tuple[Path, tuple[str, ...]]] = []
        self._threads: list[threading.Thread] = []
        self._said: list[str] = []

    def screenshot(self, pixels: np.ndarray) -> Path:
        """Keep a picture (H, W, 3 or 4) uint8. Its path; it is there a moment later. OutputError."""
        from PIL import Image

        image = Image.fromarray(np.ascontiguousarray(pixels[..., :3]))
        return self._made(".png", lambda path: image.save(path, compress_level=4))

    def _made(self, suffix: str, write: Callable[[Path], Any]) -> Path:
        """The path of a file that a thread writes. What goes wrong there `tend` tells."""
        path = stamped(output_folder(self.folder), suffix)
        taken = path.with_stem(f"{path.stem}.part")
        with named(path):
            taken.touch(exist_ok=False)  # the name is taken from now on

        def run() -> None:
            try:
                with whole(path) as part:
                    write(part)
            except OutputError as error:
                self._said.append(str(error))
            finally:
                taken.unlink(missing_ok=True)
        self._threads = [thread for thread in self._threads if thread.is_alive()]
        self._threads.append(threading.Thread(target=run))
        self._threads[-1].start()
        return path

    def motion(self, history: Sequence[SessionState]) -> Path:
        """Keep what was played since the last reset as an animated GLB. Its path; it is there a moment later.

        history: one moment for each step of the world. OutputError.
        """
        return self._made(".glb", lambda path: _write_motion(path, history))

    def film(self, log: Path, start: float, end: float, overlays: Sequence[str]) -> Path:
        """Have a part of a log [s] filmed, after the films before it. Its path. OutputError."""
        taken = {film.path for film in self.films} | {path for path, _ in self._waiting}
        folder, number = output_folder(self.folder), 1
        while (path := folder / f"film-{number}.mp4") in taken or path.exists() or path.with_stem(f"{path.stem}.part").exists():
            number += 1
        self._waiting.append((path, ("--replay", str(log), "--from", f"{start:.6f}", "--to", f"{end:.6f}",
                                     "--overlay", ",".join(overlays), *self.options)))
        self.tend()
        return path

    def tend(self) -> tuple[str, ...]:
        """Begin the next film if its turn has come. A line about each that has ended, and what went wrong."""
        over = [film for film in self.films if not film.running]
        self.films = [film for film in self.films if film not in over]
        if self._waiting and not self.films:
            self.films.append(Film(*self._waiting.pop(0)))
        said = [self._said.pop(0) for _ in range(len(self._said))]
        return (*said, *(film.status() for film in over))

    def status(self) -> tuple[str, ...]:
        """A line about each film that is being made."""
        return tuple(film.status() for film in self.films)

    def finish(self, say: Callable[[str], None]) -> None:
        """Wait until everything is made, and say so line by line; an interruption gives up the films."""
        for thread in self._threads:
            thread.join()
        try:
            while True:
                for line in self.tend():
                    say(line)
                if not self.films:
                    return
                for film in self.films:
                    say(f"{film.path} is still being made; Ctrl-C gives it up")
                    film.wait()
        except KeyboardInterrupt:
            for film in self.films:
                film.stop()
            raise


def _write_motion(path: Path, history: Sequence[SessionState]) -> None:
    from ..output import takes, write

    numbers = [moment.after.number for moment in history]
    start = max((i for i in range(1, len(numbers)) if numbers[i] <= numbers[i - 1]), default=0)
    write(path, takes((moment.before, moment.after, 1.0) for moment in history[start:]))
