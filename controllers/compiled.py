"""Compiling hot loops with numba, with a cache that is never stale.

Numba keys its cache of a function on that function's own file alone, so a change in a kernel that
another file calls would go unseen. Here the cache's folder is named after all of our sources.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import time
from functools import lru_cache
from pathlib import Path

import numba
from numba import njit, types

_PACKAGE = Path(__file__).parent
DAY = 86400.0
"""[s]."""


@lru_cache
def cache_folder() -> Path:
    """Where compiled kernels of exactly these sources are kept; those unused for a day beside it are removed,
    younger ones may belong to a program that still runs.

    An installation that can't be written to keeps them in its user's home, apart from any other's.
    """
    stamp = hashlib.sha1(numba.__version__.encode())
    for path in sorted(_PACKAGE.rglob("*.py")):
        about = path.stat()
        stamp.update(f"{path.relative_to(_PACKAGE)} {about.st_mtime_ns} {about.st_size}\n".encode())
    home = _PACKAGE / "__pycache__"
    if not os.access(home if home.exists() else _PACKAGE, os.W_OK):
        home = Path.home() / ".cache" / "gambol" / hashlib.sha1(str(_PACKAGE.resolve()).encode()).hexdigest()[:12]
    folder = home / f"kernels-{stamp.hexdigest()[:12]}"
    for old in home.glob("kernels-*"):
        if old != folder and time.time() - old.stat().st_mtime > DAY:
            shutil.rmtree(old, ignore_errors=True)
    return folder


def cold() -> bool:
    """Whether these sources were never compiled here: the first run then takes half a minute longer."""
    return not any(cache_folder().rglob("*.nbc"))


def kernel(function=None, **options):
    """Decorate a function for compilation by numba in no-Python mode, cached. Options are njit's."""
    if function is None:
        return lambda f: kernel(f, **options)
    before, numba.config.CACHE_DIR = numba.config.CACHE_DIR, str(cache_folder())
    try:
        return _general(njit(cache=True, **options)(function))
    finally:
        numba.config.CACHE_DIR = before


def _general(made):
    """A kernel whose callers' constants are numbers like any: numba would compile it anew for each of them."""
    if hasattr(made, "get_call_template"):  # a plain function has none, where compiling is switched off
        known = made.get_call_template
        made.get_call_template = lambda args, kws: known(
            [types.unliteral(arg) for arg in args], {name: types.unliteral(arg) for name, arg in kws.items()})
    return made
