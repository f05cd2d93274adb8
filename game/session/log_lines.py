"""What the lines of an input log say: its head, and blocks of packed wishes, checked before anything is made of them.

A log may come from anybody, so whatever it claims is bounded.
"""

from __future__ import annotations

import json
from bisect import bisect_right
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from gambol.controllers.files import printable

from ..input import PLAYERS, STEPS, Wish

FORMAT = 1
BLOCK = 600
"""A line has so many ticks at most."""
ROOM = 1 << 20
"""A line unpacks to so many bytes at most."""
_PRESSED, _WORDS = 1000, 4000  # actions set off in a tick, letters of one
_NAMES = {"library": 64, "character": 200, "clip": 4096, "database": 4096, "up": 2, "unit": 40}  # letters of each
_CONTROLS = frozenset(chr(code) for code in (*range(32), *range(127, 160)))
_ESCAPES = ((b"\x1b", b"\x1be"), (b"\n", b"\x1bn"))


class LogError(ValueError):
    """A log that can't be played; the message names the file, and the line where there is one."""


class Ticks(Sequence):
    """The ticks of a log, for each one wish for each player; kept as numbers, for hours have a million of them.

    blocks: numbers (T, players, 16) as of `Wish.numbers`, and what was pressed by tick and player.
    """

    def __init__(self, blocks: Sequence[tuple[np.ndarray, dict[tuple[int, int], tuple[str, ...]]]]):
        self._blocks = blocks
        self._ends = np.cumsum([len(numbers) for numbers, _ in blocks], dtype=int).tolist()

    def __len__(self) -> int:
        return self._ends[-1] if self._ends else 0

    def __getitem__(self, at: int | slice) -> Any:
        if isinstance(at, slice):
            return tuple(self[k] for k in range(*at.indices(len(self))))
        if not -len(self) <= at < len(self):
            raise IndexError(f"tick {at} of {len(self)}")
        at %= len(self)
        which = bisect_right(self._ends, at)
        numbers, pressed = self._blocks[which]
        t = at - self._ends[which] + len(numbers)
        return tuple(Wish.of(row, pressed.get((t, who), ())) for who, row in enumerate(numbers[t].tolist()))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Sequence) and tuple(self) == tuple(other)


def head(path: Path, line: bytes) -> dict:
    """The first line's fields. LogError, naming the one that is wrong."""
    try:
        found = json.loads(line)
    except (ValueError, RecursionError):
        found = None
    if not isinstance(found, dict) or found.get("gambol") != "input log":
        raise LogError(f"{path}: line 1: not an input log of Gambol, as `gambol play` keeps")
    if not _whole(found.get("format"), FORMAT, FORMAT):
        raise LogError(f"{path}: line 1: a log of format {_short(found.get('format'))}; this Gambol reads format {FORMAT}")
    if not _whole(found.get("players"), 1, PLAYERS):
        raise LogError(f"{path}: line 1: players: needs a whole number from 1 to {PLAYERS}, not {_short(found.get('players'))}")
    for name, most in _NAMES.items():
        text = found.get(name, None if name in ("library", "character") else "")
        if not isinstance(text, str) or len(text) > most or not _CONTROLS.isdisjoint(text):
            raise LogError(f"{path}: line 1: {name}: needs a name of at most {most} letters, not {_short(text)}")
    return found


def _whole(value: Any, low: int, high: int) -> bool:
    """Whether something is a whole number within bounds: 1, but neither 1.0 nor true."""
    return type(value) is int and low <= value <= high


def _short(value: Any) -> str:
    """What a file says in place of something else, for a line about it."""
    if isinstance(value, (dict, list)):
        return "a table" if isinstance(value, dict) else "a list"
    return printable(json.dumps(value, ensure_ascii=False))


def escaped(data: bytes) -> bytes:
    """Bytes without a line's end."""
    for plain, escape in _ESCAPES:
        data = data.replace(plain, escape)
    return data


def plain(data: bytes) -> bytes:
    """Bytes as they were before `escaped`."""
    for plain, escape in reversed(_ESCAPES):
        data = data.replace(escape, plain)
    return data


def packed(ticks: Sequence[tuple[Wish, ...]], print_: int | None) -> bytes:
    """A line of JSON, then every control's changes from tick to tick, bytes of equal weight together."""
    pressed = [[t, who, list(wish.pressed)] for t, wishes in enumerate(ticks)
               for who, wish in enumerate(wishes) if wish.pressed]
    numbers = np.array([[wish.numbers() for wish in wishes] for wishes in ticks], "<i2")
    numbers = numbers.reshape(len(ticks), -1)
    changes = np.diff(numbers, axis=0, prepend=np.zeros_like(numbers[:1]))  # may wrap round; so does the sum
    planes = np.ascontiguousarray(changes.T).view(np.uint8).reshape(-1, 2).T
    return json.dumps([len(ticks), len(ticks[0]), print_, pressed]).encode() + b"\n" + planes.tobytes()


def unpacked(block: bytes) -> tuple[np.ndarray, dict[tuple[int, int], tuple[str, ...]], int | None]:
    """What `packed` packed. LogError, naming the field, where it can't have."""
    if len(block) == ROOM:
        raise LogError(f"unpacks to {ROOM >> 20} MiB or more")
    line, _, data = block.partition(b"\n")
    try:
        fields = json.loads(line)
    except (ValueError, RecursionError):
        fields = None
    if not isinstance(fields, list) or len(fields) != 4:
        raise LogError("needs ticks, players, fingerprint and actions")
    count, players, print_, pressed = fields
    if not _whole(count, 1, BLOCK):
        raise LogError(f"ticks: needs a whole number from 1 to {BLOCK}, not {_short(count)}")
    if not _whole(players, 1, PLAYERS):
        raise LogError(f"players: needs a whole number from 1 to {PLAYERS}, not {_short(players)}")
    if print_ is not None and not _whole(print_, 0, 0xffffffff):
        raise LogError(f"fingerprint: needs a whole number of 32 bits or null, not {_short(print_)}")
    if len(data) != 2 * count * players * len(STEPS):
        raise LogError(f"{count} ticks need {2 * count * players * len(STEPS)} bytes of controls, not {len(data)}")
    actions = _actions(pressed, count, players)
    planes = np.frombuffer(data, np.uint8).reshape(2, -1)
    changes = np.ascontiguousarray(planes.T).view("<i2").reshape(players * len(STEPS), count).T
    return np.cumsum(changes, axis=0, dtype="<i2").reshape(count, players, len(STEPS)), actions, print_


def _actions(pressed: Any, count: int, players: int) -> dict[tuple[int, int], tuple[str, ...]]:
    """What was pressed, by tick and player. LogError for anything else."""
    if not isinstance(pressed, list):
        raise LogError(f"actions: needs a list, not {_short(pressed)}")
    actions: dict[tuple[int, int], tuple[str, ...]] = {}
    for one in pressed:
        if not isinstance(one, list) or len(one) != 3:
            raise LogError("actions: each needs a tick, a player and names")
        t, who, names = one
        if not _whole(t, 0, count - 1) or not _whole(who, 0, players - 1):
            raise LogError(f"actions: there is no tick {_short(t)} of player {_short(who)} in its {count}")
        if not isinstance(names, list) or len(names) > _PRESSED or not all(
                isinstance(name, str) and len(name) <= _WORDS and name.isprintable() for name in names):
            raise LogError(f"actions: tick {t} needs at most {_PRESSED} names")
        actions[t, who] = tuple(names)
    return actions
