"""Replay: the moments of an input log, played again to the bit, and whether they are those that were played."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from gambol.controllers.files import printable

from ..world import RATE, Filmed, Recorded, methods
from .comparison import wanted
from .fingerprint import digest, fingerprint
from .input_log import Log, worn
from .log_lines import LogError
from .settings import SettingError
from .state import SessionState, opening
from .tick import Timeline


def performer_of(log: Log, controller: Any) -> Any:
    """Who moved in a log: a controller, or the recording or the footage that the log names.

    LogError where a file that it needs is not there.
    """
    for what, file, needed in (("clip", log.clip, True), ("motion database", log.database, bool(wanted(log.ticks)))):
        if file and needed and not (Path(file).is_file() or Path(file, "footage.json").is_file()):
            raise LogError(f"{log.path}: was played with the {what} {file}, which is not there: put it back")
    if not log.clip:
        return controller
    if Path(log.clip).is_dir():
        return Filmed.load(log.clip, controller)
    from gambol.controllers.mocap import Reading  # a game without a clip starts without

    try:
        reading = Reading.of(log.up or None, log.unit or None)
    except ValueError as error:
        raise LogError(f"{log.path}: line 1: {error}") from None
    return Recorded.load(log.clip, controller, reading)


def of_library(log: Log, controller: Any) -> Log:
    """The log, if it was played with a library and a body that move like this controller's; else LogError."""
    if log.library != digest(controller):
        if log.clip:
            raise LogError(f"{log.path}: was played with another clip than {log.clip} holds now")
        raise LogError(f"{log.path}: was played {_otherwise(log.character, worn(controller))}")
    return log


def _otherwise(played: str, now: str) -> str:
    """How a log was played otherwise than somebody would play it now, and what to name; both are told by whose body is worn."""
    if played != now:
        return f"as the character {played!r}: name its file with --character" if played else "as the mannequin: leave out --character"
    if not played:
        return "with another gait library: name it with --library"
    return f"with another gait library, or another character {played!r}: name them with --library and --character"


def replay(log: Log, controller: Any) -> Iterator[SessionState]:
    """The opening and the moment after every tick, to the bit as they were played.

    LogError for what can't be played.
    """
    timeline = Timeline(opening(controller, log.players, methods(log.database or None)))
    yield timeline.now
    for number, wishes in enumerate(log.ticks):
        try:
            if len(wishes) != len(timeline.now.players):
                raise SettingError(f"{len(wishes)} players instead of {len(timeline.now.players)}")
            timeline.advance(wishes)
        except SettingError as error:
            raise LogError(f"{log.path}: {number / RATE:.1f} s into the log: {printable(str(error), 1000)}") from None
        yield timeline.now


def strayed(log: Log, moment: SessionState) -> bool:
    """Whether a replay is elsewhere than the player was: another version of Gambol walks another way."""
    return log.prints.get(moment.number, fingerprint(moment)) != fingerprint(moment)
