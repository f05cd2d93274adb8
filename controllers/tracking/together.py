"""Views side by side: what is done for each camera runs on all cores, as compiled loops let go of the interpreter."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from typing import TypeVar

T = TypeVar("T")


def together(act: Callable[..., T], *columns: Sequence) -> list[T]:
    """What `map` would give, some of it at once. For acts that change nothing that they share."""
    crew = _crew()
    return list(map(act, *columns)) if crew is None or len(columns[0]) < 2 else list(crew.map(act, *columns))


@lru_cache
def _crew() -> ThreadPoolExecutor | None:
    """As many threads as this process may have cores; None where that is one."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return ThreadPoolExecutor(min(cores, 16), "view") if cores > 1 else None


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_crew.cache_clear)  # threads stay with their parent
