"""Thoughts: what takes longer than a step is worked out beside the steps, in a thread, and used so many steps later.

How many is told by what was thought of, not by how long it took: the same states and wishes give the same walks, to the bit, however fast a
machine is. A thought that is not ready when it is to be used is waited for.
"""

from __future__ import annotations

import math
import os
import sys
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from functools import lru_cache
from typing import Any, Generic, TypeVar

T = TypeVar("T")

SOON = 0.1
"""What was thought of is used so long after it was begun [s] ..."""
EACH = 0.05
"""... and so much later for each leap that had to be planned for it [s]."""


HURRIED = 5
"""Who hurries waits in each step for one more question, and after so many for all of them."""


def steps_of(questions: int, dt: float) -> int:
    """After how many steps of dt [s] a thought is used that asked so many questions."""
    return max(math.ceil((SOON + EACH * questions) / dt - 1e-6), 1)


class Forgotten(Exception):
    """Nobody waits for a thought any more."""


class Thought(Generic[T]):
    """Something that is worked out beside the steps of dt [s]. act: works it out; it calls what it is given before each of its questions."""

    def __init__(self, act: Callable[[Callable[[], None]], T], dt: float):
        self._act, self._dt, self._asked = act, dt, 0
        self._working = self._done = self._forgotten = False
        self._result: T | None = None
        self._error: BaseException | None = None
        self._changed = threading.Condition()
        crew = _crew()
        self._begun = None if crew is None else crew.submit(self._work, True)

    def forget(self) -> None:
        """Nobody waits for it any more: who thinks of it stops before the next question. If it is asked for after all it is thought anew."""
        with self._changed:
            self._forgotten = True
        if self._begun is not None:
            self._begun.cancel()

    def after(self, steps: int, hurried: bool = False) -> T | None:
        """What was thought of, so many steps after it was begun; None before it is to be used. hurried: it is used as soon as can be. It raises what thinking did."""
        while True:
            with self._changed:
                while self._working and steps >= self._due(hurried):
                    self._changed.wait()
                if steps < self._due(hurried):
                    return None
                if self._done:
                    if self._error is not None:
                        raise self._error
                    return self._result
            self._work(False)  # nobody has begun with it, or ended it

    def __reduce__(self) -> tuple[Any, ...]:
        """To be pickled or copied it is thought to its end: threads and locks are of this process."""
        with suppress(Exception):  # what it raised goes along
            self.after(sys.maxsize)
        return _thought, (self._result, self._error, self._asked, self._dt)

    def _due(self, hurried: bool) -> int:
        """After how many steps it is to be used if it asks no more than it has asked."""
        return 1 + min(self._asked, HURRIED) if hurried else steps_of(self._asked, self._dt)

    def _work(self, beside: bool) -> None:
        questions = 0

        def ask() -> None:
            nonlocal questions
            questions += 1
            with self._changed:
                self._asked = max(self._asked, questions)
                self._changed.notify_all()
                if beside and self._forgotten:
                    raise Forgotten
        with self._changed:
            if self._working or self._done or beside and self._forgotten:
                return
            self._working = True
        result, error = None, None
        try:
            result = self._act(ask)
        except BaseException as raised:  # whoever asks for it is told
            error = raised
        with self._changed:
            self._working, self._done = False, not isinstance(error, Forgotten)
            self._result, self._error = result, error
            self._changed.notify_all()


def _thought(result: Any, error: BaseException | None, asked: int, dt: float) -> Thought[Any]:
    """A thought that has come to its end, as so many questions."""
    made: Thought[Any] = object.__new__(Thought)
    made._dt, made._asked, made._begun, made._changed = dt, asked, None, threading.Condition()
    made._working, made._done, made._forgotten, made._result, made._error = False, True, False, result, error
    return made


@lru_cache
def _crew() -> ThreadPoolExecutor | None:
    """Two threads beside the steps, lest a thought waits for one that nobody minds any more; none where there is but one core."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return ThreadPoolExecutor(2, "thought") if cores > 1 else None


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_crew.cache_clear)  # threads stay with their parent
