"""The input log: what the hands did in every tick, in a file of a few kilobytes a minute.

The first line says what it was played with. Every other line holds about a second: a checksum and
its packed wishes, with line ends escaped. Lines are appended as one plays, so that whatever kills the program leaves a
log that plays; a last line that was torn off is left out.
"""

from __future__ import annotations

import io
import json
import zlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from gambol.controllers.files import append, contents, printable, reason

from ..files import OutputError, named
from ..input import Wish
from ..world import RATE
from .fingerprint import digest, fingerprint
from .log_lines import BLOCK, FORMAT, ROOM, LogError, Ticks, escaped, head, packed, plain, unpacked
from .state import SessionState

SUFFIX = ".gambol"
LARGEST = 64 << 20
"""The largest log that is read [bytes]: days of play."""
LONGEST = 12 * 3600 * RATE
"""The longest log that is read or written [ticks]."""


def worn(controller: Any) -> str:
    """The name of the body that somebody wears, as a log keeps it; "" for the mannequin."""
    return "" if controller.body is None else printable(controller.body.name, 100)


@dataclass(frozen=True, eq=False)
class Log:
    """What was played. players: at the beginning. ticks: for each, one wish for each player.

    library: the `digest` of what it was played with. character: the name of the body that was worn,
    if any. prints: tick number → `fingerprint`. clip, database: the files of the recording that the first player was, or
    the folder of footage, and of what the methods of reconstruction learn from; empty where there was none but Gambol's own. up, unit: as which the clip was read, as of `mocap.Reading.of`; empty where that was judged.
    """

    players: int
    library: str
    character: str
    ticks: Sequence[tuple[Wish, ...]]
    prints: dict[int, int] = field(default_factory=dict)
    path: Path = Path("log")
    clip: str = ""
    database: str = ""
    up: str = ""
    unit: str = ""

    @property
    def duration(self) -> float:
        """How long it is [s]."""
        return len(self.ticks) / RATE


class LogWriter:
    """Keeps a log as it is played; the file begins with the first `flush` that has something to write. ticks: so many
    were added.

    clip, database, and told, up and unit: as in `Log`; files are kept as whole paths, as a replay may stand in another folder. OutputError from `flush`
    where it can't be written.
    """

    def __init__(self, path: Path, controller: Any, players: int, clip: str | Path | None = None,
                 database: str | Path | None = None, **told: str | None):
        self.path, self._file, self.ticks = Path(path), None, 0
        needs = {name: str(Path(file).resolve()) for name, file in (("clip", clip), ("database", database)) if file} | {name: word for name, word in told.items() if word}
        self._head = {"gambol": "input log", "format": FORMAT, "version": version("gambol"), "players": players,
                      "library": digest(controller), "character": worn(controller), **needs}
        self._packer, self._waiting = zlib.compressobj(9, strategy=zlib.Z_FILTERED), []
        self._count, self._ended = 0, False

    @property
    def begun(self) -> bool:
        """Whether there is a file."""
        return self._file is not None

    def add(self, wishes: Sequence[Wish]) -> None:
        """One tick more; the wishes must be `rounded`."""
        if self._waiting and (len(self._waiting[0]) != len(wishes) or len(self._waiting) == BLOCK):  # somebody has joined
            self.flush()
        self._waiting.append(tuple(wishes))
        self.ticks += 1

    def flush(self, moment: SessionState | None = None) -> None:
        """Write what was added since the last time. moment: what it led to. Once it could not be written nothing more is: a log
        without a part of it can't be played."""
        if not self._waiting:
            return
        if self._ended:
            raise OutputError(f"{self.path}: has ended")
        self._ended = True
        self._count += len(self._waiting)
        if self._count > LONGEST:
            raise OutputError(f"{self.path}: is {LONGEST / RATE / 3600:g} hours long, and no log is longer")
        block = packed(self._waiting, None if moment is None else fingerprint(moment))
        data = self._packer.compress(block) + self._packer.flush(zlib.Z_SYNC_FLUSH)
        with named(self.path):
            if self._file is None:
                self.path.parent.mkdir(parents=True, exist_ok=True)
                self._file = open(self.path, "xb", buffering=0)
                append(self._file, json.dumps(self._head).encode() + b"\n")
            append(self._file, b"%08x %s\n" % (zlib.crc32(data), escaped(data)))
        self._waiting, self._ended = [], False

    def close(self) -> None:
        """Let the file go; what was not flushed is not in it."""
        if self._file is not None:
            self._file.close()


def read(path: str | Path) -> Log:
    """A log from its file. LogError says what is wrong with it."""
    path = Path(path)
    try:
        data = contents(path, LARGEST)
    except OSError as error:
        raise LogError(f"{path}: {reason(error)}") from None
    lines = io.BytesIO(data)
    about = head(path, lines.readline())
    blocks: list[tuple[np.ndarray, dict]] = []
    count, prints, unpacker = 0, {}, zlib.decompressobj()
    for number, line in enumerate(lines, 2):
        last = data.find(b"\n", lines.tell()) < 0  # what follows the last line's end was torn off
        if last and not line.endswith(b"\n"):
            break
        try:
            crc, _, text = line[:-1].partition(b" ")
            part = plain(text)
            if zlib.crc32(part) != int(crc, 16):
                raise ValueError("checksum")
            block = unpacker.decompress(part, ROOM)
        except (ValueError, zlib.error):
            if last:  # nothing whole comes after it: a power cut, say
                break
            raise LogError(f"{path}: line {number} is damaged, {count / RATE:.0f} s into the log; "
                           f"delete it and what follows to keep what comes before") from None
        try:
            numbers, pressed, print_ = unpacked(block)
            if count + len(numbers) > LONGEST:
                raise LogError(f"with it the log is longer than {LONGEST / RATE / 3600:g} hours")
        except LogError as error:
            raise LogError(f"{path}: line {number}: {error}; delete it and what follows to keep what comes before") from None
        blocks.append((numbers, pressed))
        count += len(numbers)
        if print_ is not None:
            prints[count] = print_
    if not blocks:
        raise LogError(f"{path}: nothing was played yet")
    return Log(about["players"], about["library"], about["character"], Ticks(blocks), prints, path, about.get("clip", ""),
               about.get("database", ""), about.get("up", ""), about.get("unit", ""))
