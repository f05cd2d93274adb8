"""What is kept of a game while it is played, its log, films, pictures and motion, and what is said of that."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from ..files import OutputError
from ..input import Wish
from ..session import LogWriter, SessionState
from ..world import DT, RATE
from .capture import Capture

SAVED_EVERY = 0.75
"""How often the log is written [s]."""
NOTICE = 4.0
"""How long something is said in the picture [s]."""


class Recordings:
    """Keeps what is played and filmed, where there is anything to keep it in; nothing that fails ends the game.

    log, capture: None keeps none. filming: the tick in which a film was begun, None without one.
    """

    def __init__(self, log: LogWriter | None = None, capture: Capture | None = None):
        self.log, self.capture = log, capture
        self.filming: int | None = None
        self._unsaved = 0.0
        self._notices: list[tuple[float, str]] = []

    def say(self, text: str) -> None:
        """Say something in the picture for a few seconds; what is said there already stays for as long again."""
        self._notices = [(left, said) for left, said in self._notices if said != text] + [(NOTICE, text)]

    @property
    def notices(self) -> tuple[str, ...]:
        """What is being said."""
        return tuple(text for _, text in self._notices)

    def status(self, now: SessionState) -> tuple[str, ...]:
        """A line about each film that is being taken or made."""
        filming = () if self.filming is None else (f"filming {(now.number - self.filming) * DT:.0f} s",)
        return filming + (self.capture.status() if self.capture is not None else ())

    def tend(self, seconds: float) -> None:
        """`seconds` have passed: what has been said long enough goes, and what the studio says comes."""
        self._notices = [(left - seconds, text) for left, text in self._notices if left > seconds]
        for line in self.capture.tend() if self.capture is not None else ():
            self.say(line)

    def add(self, wishes: Sequence[Wish]) -> None:
        """One tick more for the log."""
        self._logged(lambda log: log.add(wishes))

    def save_sometimes(self, seconds: float, now: SessionState) -> None:
        """`seconds` have passed: save what was played if it is time to."""
        self._unsaved += seconds
        if self._unsaved >= SAVED_EVERY:
            self.save(now)

    def save(self, now: SessionState) -> None:
        """Write what was played since the last time. now: what it led to."""
        self._unsaved = 0.0
        self._logged(lambda log: log.flush(now))

    def picture(self, pixels: np.ndarray) -> None:
        """Keep a picture (H, W, 3 or 4)."""
        self._told(lambda capture: capture.screenshot(pixels))

    def motion(self, history: Sequence[SessionState]) -> None:
        """Keep the motion of some moments, or since the last reset among them."""
        self._told(lambda capture: capture.motion(history))

    def film(self, now: SessionState, overlays: Sequence[str]) -> None:
        """Begin a film, or end it and have it made with some overlays."""
        if self.capture is None or self.log is None:
            return self.say("no film: no log is kept")
        if self.filming is None:
            self.filming = now.number
            return
        start, self.filming = self.filming, None
        self.save(now)
        if self.log is not None and now.number > start:
            path = self.log.path
            self._told(lambda capture: f"{capture.film(path, start / RATE, now.number / RATE, overlays)} is being made")

    def close(self, now: SessionState, overlays: Sequence[str]) -> None:
        """Write the rest of the log; a film that was begun ends here."""
        if self.filming is not None:
            self.film(now, overlays)
        self.save(now)
        if self.log is not None:
            self.log.close()

    def _logged(self, keep: Callable[[LogWriter], None]) -> None:
        """Have the log keep something; where it can't it ends, and the game goes on: a disk may be full."""
        if self.log is not None:
            try:
                keep(self.log)
            except OutputError as error:
                self.log.close()
                self.log = None
                self.say(f"the log ends here: {error}")

    def _told(self, make: Callable[[Capture], Path | str]) -> None:
        """Have the studio make something, and say where it is or why it can't be."""
        if self.capture is not None:
            try:
                self.say(str(make(self.capture)))
            except OutputError as error:
                self.say(str(error))
