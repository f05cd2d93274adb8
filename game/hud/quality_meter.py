"""The quality meter as a panel: feet, floor, accelerations and frame times, and whether they are good."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

import numpy as np

from ..explain import Quality, quality_of
from ..session import SessionState
from . import style
from .history import STEPS, recent
from .toolkit import imgui

EVERY = 0.5
"""Seconds between measurements."""
ROWS = (  # what, unit, how to show it, good up to, fair up to, what it means
    ("foot drift", "cm", lambda q: 100 * q.drift, "{:.1f}", 0.5, 1.5,
     "How far a heel or ball strays while it stands, on average over its stances."),
    ("worst stance", "cm", lambda q: 100 * q.worst_drift, "{:.1f}", 2.0, 5.0,
     "How far the worst of them strayed."),
    ("skate", "%", lambda q: 100 * q.skate, "{:.1f}", 2.0, 8.0,
     "The part of all contact frames in which the standing point slides faster than 0.2 m/s."),
    ("below floor", "cm", lambda q: 100 * q.sunk, "{:.1f}", 0.3, 1.0, "How deep a heel or ball went below the floor."),
    ("acceleration", "× mocap", lambda q: q.acceleration, "{:.2f}", 1.2, 2.0,
     "The largest acceleration of any joint, over the 99th percentile of that joint in motion capture."))


class Meter:
    """Measures now and then what it is shown; `last` is of the last seconds, `whole` of all seen so far."""

    def __init__(self):
        self.last, self.whole, self.wait, self.until = Quality(), Quality(), 0.0, 0
        self.frames: deque[float] = deque(maxlen=600)

    def frame(self, seconds: float) -> None:
        """A frame was shown `seconds` after the one before."""
        self.frames.append(seconds)

    def look(self, moments: Sequence[SessionState], who: int, seconds: float) -> None:
        """Measure character `who` anew, if it is time to."""
        self.wait -= seconds
        if self.wait > 0.0:
            return
        self.wait, worlds = EVERY, recent(moments)
        self.last = quality_of(worlds, who)
        if worlds[-1].number < self.until:  # gone back or reset: what was counted is of another run
            self.whole, self.until = Quality(), 0
        if len(worlds) == STEPS and worlds[0].number >= self.until:
            self.whole, self.until = self.whole.merged(self.last), worlds[-1].number + 1

    def draw(self) -> None:
        """Fill the current window."""
        if imgui.begin_table("quality", 3, imgui.TableFlags_.sizing_stretch_prop):
            imgui.table_setup_column("", 0, 1.5)
            imgui.table_setup_column("", 0, 0.75)
            imgui.table_setup_column("", 0, 0.75)
            _row(f"last {self.last.seconds:.0f} s", f"all {self.whole.seconds:.0f} s" if self.whole.seconds else "all")
            for name, unit, value, text, good, fair, meaning in ROWS:
                _line(f"{name} [{unit}]", meaning, text, good, fair, value(self.last),
                      value(self.whole) if self.whole.seconds else np.nan)
            times = 1000.0 * np.array(self.frames) if self.frames else np.full(1, np.nan)
            p50, p99 = np.percentile(times, (50, 99))
            _line("frame p50, p99 [ms]", "From one shown frame to the next: half, and all but one in a hundred, take less.",
                  "{:.1f}", 17.5, 34.0, p50, p99)
            imgui.end_table()
        if self.last.joint:
            imgui.text_disabled(f"most accelerated: {self.last.joint}")


def _row(*cells: str) -> None:
    imgui.table_next_row()
    for column, text in enumerate(cells, 1):
        imgui.table_set_column_index(column)
        imgui.text_disabled(text)


def _line(name: str, meaning: str, text: str, good: float, fair: float, last: float, whole: float) -> None:
    imgui.table_next_row()
    imgui.table_set_column_index(0)
    imgui.text(name)
    imgui.set_item_tooltip(meaning)
    for column, value in ((1, last), (2, whole)):
        imgui.table_set_column_index(column)
        if not np.isfinite(value):
            imgui.text_disabled("–")
            continue
        colour = style.GOOD if value <= good else style.FAIR if value <= fair else style.BAD
        imgui.text_colored(imgui.ImVec4(*colour), text.format(value))
