"""Where what can be made anew is kept: a folder of the user's, and in it one for each version of our sources."""

from __future__ import annotations

import atexit
import hashlib
import os
import shutil
import sys
import tempfile
import time
from functools import lru_cache
from pathlib import Path

from .ingredients import TOOLS

_PACKAGE = Path(__file__).parents[1]
DAY = 86400.0
"""[s]."""
NEWEST = 3
"""So many versions of the sources keep their kernels, however long nobody used them."""


@lru_cache
def cache_home() -> Path:
    """Where Gambol keeps what it can make anew: in GAMBOL_CACHE, else where programs keep such things on this platform;
    where nobody may write there, in a folder that goes when this program ends."""
    home = usual_home()
    try:
        if not home.is_absolute():  # of somebody who has no home, whose folders would lie wherever he is
            raise FileNotFoundError(home)
        home.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=home).close()
        return home
    except OSError:
        home = Path(tempfile.mkdtemp(prefix="gambol-"))
        atexit.register(shutil.rmtree, home, ignore_errors=True)
        return home


def forgets() -> str:
    """Why what is made now has to be made again the next time, "" where it is kept."""
    home = usual_home()
    if cache_home() == home:
        return ""
    where = f"{home}: can't be written" if home.is_absolute() else "you have no home folder"
    return f"{where}, so what is compiled and learnt is kept for this time alone: name a folder for it in the environment's GAMBOL_CACHE"


def usual_home() -> Path:
    """The folder that GAMBOL_CACHE names, else the platform's for what programs can make anew."""
    if named := os.environ.get("GAMBOL_CACHE"):
        return Path(os.path.expanduser(named)).absolute()
    user = Path(os.path.expanduser("~"))
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or user / "AppData" / "Local") / "gambol"
    if sys.platform == "darwin":
        return user / "Library" / "Caches" / "gambol"
    named = os.environ.get("XDG_CACHE_HOME", "")
    return Path(named if os.path.isabs(named) else user / ".cache") / "gambol"


@lru_cache
def cache_folder() -> Path:
    """Where compiled kernels of exactly these sources are kept. Those of others that nobody used for a day are
    removed, but for the last few: younger ones may belong to a program that still runs."""
    stamp = hashlib.sha256(TOOLS.encode())
    for path in sorted(_PACKAGE.rglob("*.py")):
        source = path.read_bytes()
        stamp.update(f"\n{path.relative_to(_PACKAGE).as_posix()} {len(source)}\n".encode() + source)
    folder = cache_home() / f"kernels-{stamp.hexdigest()[:12]}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        os.utime(folder)  # in use
        used = sorted((old.stat().st_mtime, old) for old in folder.parent.glob("kernels-*"))
        for last, old in used[:-NEWEST]:
            if time.time() - last > DAY:
                shutil.rmtree(old, ignore_errors=True)
    except OSError:  # another program clears up, too, or nothing can be kept
        pass
    return folder


def cold() -> bool:
    """Whether these sources were never compiled here: the first run then takes half a minute longer."""
    return not any(cache_folder().glob("*.nbc"))
