"""What takes longer than a step is worked out in pieces, a few in each step: the same comes of it as of all pieces at once, and after
as many steps however fast a machine is."""

from __future__ import annotations

import threading
from collections.abc import Callable, Generator
from typing import Any, Generic, NamedTuple, TypeVar

T = TypeVar("T")

PATH, PLAN, SHARE = 2, 1, 3
"""What a path costs, what its plan does that is swept, and what a step has time for: a path, and its plan."""

Pieces = Generator[int | str, Any, T]
"""Work in pieces: it yields what each costs before that is done, and in words what is known so far, with which a step is over."""


def whole(pieces: Pieces[T]) -> T:
    """What comes of all pieces at once."""
    while True:
        try:
            next(pieces)
        except StopIteration as end:
            return end.value


def weighed(pieces: Pieces[T]) -> Pieces[tuple[T, int]]:
    """The same pieces, and of what comes of them what they cost together."""
    cost = 0
    while True:
        try:
            piece = next(pieces)
        except StopIteration as end:
            return end.value, cost
        cost += piece if isinstance(piece, int) else 0
        yield piece


def priced(pieces: Pieces[T], dear: int) -> Pieces[T]:
    """The same pieces, each so many times as dear."""
    while True:
        try:
            piece = next(pieces)
        except StopIteration as end:
            return end.value
        yield dear * piece if isinstance(piece, int) else piece


def counted(pieces: Pieces[T], dear: int, ask: Callable[[], None]) -> T:
    """What comes of all pieces at once. ask: is called whenever they have cost so much more."""
    spent = 0
    while True:
        try:
            piece = next(pieces)
        except StopIteration as end:
            return end.value
        before, spent = spent, spent + (piece if isinstance(piece, int) else 0)
        for _ in range(spent // dear - before // dear):
            ask()


class Seeking(Generic[T]):
    """Work that is done a share in each step. What is known of it is a pure function of the steps: each share is worked out once, whoever asks first."""

    def __init__(self, pieces: Pieces[T]):
        self._pieces, self._held, self._ended = pieces, 0, False
        self._known: list[T | str] = []
        self._lock = threading.Lock()

    def after(self, steps: int) -> T | str:
        """What came of it after so many steps, one or more; before it has come to an end, what is known so far, in words."""
        with self._lock:
            while len(self._known) < steps and not self._ended:
                self._known.append(self._share())
            return self._known[min(steps, len(self._known)) - 1]

    def __reduce__(self) -> tuple[Any, ...]:
        """To be pickled or copied it is worked out to its end: half-done work is of this process."""
        with self._lock:
            while not self._ended:
                self._known.append(self._share())
            return _sought, (tuple(self._known),)

    def _share(self) -> T | str:
        """What is known one share later."""
        spent = 0
        while True:
            try:
                piece = self._held or next(self._pieces)
            except StopIteration as end:
                self._ended = True
                return end.value
            self._held = 0
            if isinstance(piece, str):
                return piece
            if spent and spent + piece > SHARE:
                self._held = piece
                return next((known for known in reversed(self._known) if isinstance(known, str)), "")
            spent += piece


class Spread(Seeking[T]):
    """The same of pieces that are sent after how many steps each of them is worked out, so many costs in a step. What costs more than a step has time for is paid off in the next ones: what is known
    already, and costs at once what it cost, is of use after as many steps."""

    def __init__(self, pieces: Pieces[T], share: int):
        super().__init__(pieces)
        self._each, self._spent, self._begun = share, 0, False

    def _share(self) -> T | str:
        number = len(self._known)
        try:
            while self._spent < self._each * (number + 1):
                if self._begun:
                    self._spent += self._held
                piece = self._pieces.send(number if self._begun else None)
                self._held, self._begun = piece if isinstance(piece, int) else 0, True
        except StopIteration as end:
            self._ended = True
            return end.value
        return ""


def _sought(known: tuple[Any, ...]) -> Seeking[Any]:
    """Seeking that has come to its end, of what was known after each step."""
    made: Seeking[Any] = Seeking(iter(()))  # type: ignore[arg-type]
    made._known, made._ended = list(known), True
    return made


class Onward(NamedTuple):
    """How far somebody is with seeking: what, None where he has yet to come to where he seeks from, after how many steps, where (3,) [m] his pelvis was as he began,
    the place (3,) that was asked for then, and whether that was for the second time."""

    seeking: Seeking[Any] | None
    steps: int = 0
    began: Any = None
    place: Any = None
    anew: bool = False
