"""What was learnt from a database, kept on disk, so that it is learnt once."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import time
from collections.abc import Callable
from dataclasses import asdict
from functools import lru_cache
from pathlib import Path
from typing import Any, TypeVar
from zipfile import BadZipFile

import numpy as np

from ...compiled import DAY, cache_folder
from ...files import whole
from .database import Database

_PROBES = 4096  # frames that tell one database's motion from another's
_UNUSED = 60 * DAY
_HERE = Path(__file__).parents[1]

T = TypeVar("T")


def identity(database: Database) -> str:
    """What distinguishes a database from others, wherever it lies: its takes, less those held out, and their motion."""
    told = hashlib.sha1(json.dumps([database.fps, *(asdict(take) for take in database.takes)]).encode())
    step = max(1, len(database.frames) // _PROBES)
    told.update(np.ascontiguousarray(database.frames[::step]).tobytes())
    told.update(np.ascontiguousarray(database.sound[::step]).tobytes())
    return told.hexdigest()


def folder() -> Path:
    """Where all of it lies: beside the folders of compiled kernels, and not tied to every source as those are."""
    return cache_folder().parent / "learnt"


def kept(kind: str, database: Database, settings: Any, make: Callable[[], T], save: Callable[[T, Path], None],
         load: Callable[[Path], T], sources: tuple[str, ...] = ()) -> T:
    """What `make` makes of a database, made only if it does not lie on disk already.

    settings: all else that it depends on, of a telling repr. save, load: write it to a path and read it. sources:
    files of `reconstruction` whose change makes it stale. What nobody wanted for two months is removed.
    """
    name = hashlib.sha1(f"{identity(database)} {settings!r} {_stamp(sources)}".encode()).hexdigest()[:16]
    home = folder()
    path = home / f"{kind}-{name}"
    try:
        found = load(path)
        os.utime(path)
        return found
    except (OSError, ValueError, EOFError, KeyError, BadZipFile):  # the latter for a file cut short
        pass
    made = make()
    try:
        home.mkdir(parents=True, exist_ok=True)
        for old in home.iterdir():
            if time.time() - old.stat().st_mtime > _UNUSED:
                shutil.rmtree(old) if old.is_dir() else old.unlink()
        with whole(path) as own:
            save(made, own)
    except OSError:  # a full or locked disk: learnt anew next time
        pass
    return made


@lru_cache
def _stamp(sources):
    told = hashlib.sha1()
    for name in sources:
        told.update((_HERE / name).read_bytes())
    return told.hexdigest()
