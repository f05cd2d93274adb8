"""When trackers are asked what they say: by a steady clock, or as a file of packets goes on, until somebody ends it."""

from __future__ import annotations

import math
import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from .base import say

FPS = 60
BEHIND, SENDING_BEHIND = 10.0, 0.5
"""Frames of a take, and frames that are sent on, may come late by so much [s] before some are left out."""


def clock() -> Any:
    """What packets are timed by as they come."""
    return time.monotonic


@dataclass
class Stop:
    """gently: whether what was heard until somebody ends it is still worked through; at: when [s] that was."""

    gently: bool = False
    at: float = math.inf


def times(source: Any, seconds: float | None, paced: bool, skipped: list[float], stop: Stop | None = None) -> Iterator[float]:
    """Times [s] to ask a source at, FPS a second: as they come, or those of a file, where they need not be waited for. paced: whether somebody sees
    each as it comes. skipped: where times [s] are put that were left out. stop: when somebody ends it."""
    length = getattr(source, "duration", None)
    if length is None:
        yield from ticks(seconds, SENDING_BEHIND if paced else BEHIND, skipped, stop or Stop())
        return
    number, began, last = 0, time.monotonic(), length if seconds is None else min(length, source.told_until + seconds)
    while (now := source.told_until + 1 / FPS) <= last:
        if paced:
            time.sleep(max(0.0, began + number / FPS - time.monotonic()))
        number += 1
        yield now


def ticks(seconds: float | None, behind: float, skipped: list[float], stop: Stop) -> Iterator[float]:
    """Times [s] of a steady clock, FPS a second, each when it has come; where they come later than by `behind` [s], the next one is now. They go on to when somebody stops it."""
    began, number, told = time.monotonic(), 0, False
    while seconds is None or number < round(seconds * FPS):
        due = began + number / FPS
        late = time.monotonic() - due
        if late > behind and stop.at == math.inf:
            skipped.append(late)
            began, due = began + late, due + late
        if due > stop.at:
            return
        if stop.at < math.inf and not told and late > 1.0:
            say(f"{late:.0f} s of what was heard are still to come; Ctrl-C again leaves them out")
            told = True
        time.sleep(max(0.0, -late))
        yield due
        number += 1


@contextmanager
def stoppable() -> Iterator[Stop]:
    """Whoever ends the program from outside ends it like Ctrl-C does: gently, where that is wished, unless it is the second time."""
    asked = Stop()

    def stop(*_: Any) -> None:
        if not asked.gently or asked.at < math.inf:
            raise KeyboardInterrupt
        asked.at = time.monotonic()
    kinds = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
    before = [signal.signal(kind, stop) for kind in kinds]
    try:
        yield asked
    finally:
        for kind, handler in zip(kinds, before):
            signal.signal(kind, handler)
