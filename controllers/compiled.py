"""Compiling hot loops with numba, and keeping what was compiled.

Numba's own cache goes by the times and paths of files, and by a function's own file alone: a copy would compile all
anew, and a change in a kernel that another file calls would go unseen. Here kernels lie in a folder of the
user's that is named after the contents of all of our sources, so that a checkout, an installation and the tests share
them; each in a file with a checksum, so that what is damaged or half written is as good as not there.
"""

from __future__ import annotations

import atexit
import hashlib
import os
import pickle
import shutil
import sys
import tempfile
import time
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import Any

import numba
from llvmlite import __version__ as LLVMLITE
from numba import njit, types
from numba.core import caching
from numba.core.serialize import dumps
from numpy import __version__ as NUMPY

_PACKAGE = Path(__file__).parent
DAY = 86400.0
"""[s]."""
NEWEST = 3
"""So many versions of the sources keep their kernels, however long nobody used them."""
CHECKED = 16
"""Bytes of a file's checksum, with which it begins."""


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
    stamp = hashlib.sha256(f"{numba.__version__} {LLVMLITE} {NUMPY} {sys.implementation.cache_tag}".encode())
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


def kernel(function: Callable[..., Any] | None = None, **options: Any) -> Callable[..., Any]:
    """Decorate a function for compilation by numba in no-Python mode, cached. Options are njit's."""
    if function is None:
        return lambda f: kernel(f, **options)
    made: Any = njit(**options)(function)
    if not hasattr(made, "get_call_template"):  # a plain function, where compiling is switched off
        return made
    made._cache = _Cache(function)
    return _general(made)


def _general(made):
    """A kernel whose callers' constants are numbers like any: numba would compile it anew for each of them."""
    known = made.get_call_template
    made.get_call_template = lambda args, kws: known(
        [types.unliteral(arg) for arg in args], {name: types.unliteral(arg) for name, arg in kws.items()})
    return made


def _checksum(data) -> bytes:
    return hashlib.blake2b(data, digest_size=CHECKED).digest()


class _Files:
    """What was compiled of one kernel: a file for each signature, named after all that it depends on beside the sources."""

    def __init__(self, folder: Path, name: str):
        self._folder, self._name = folder, name

    def _path(self, key: Any) -> Path:
        return self._folder / f"{self._name}-{hashlib.sha256(repr(key).encode()).hexdigest()[:16]}.nbc"

    def load(self, key: Any) -> Any:
        """What `save` was given; None where there is nothing, or nothing whole."""
        try:
            data = self._path(key).read_bytes()
        except OSError:
            return None
        made = memoryview(data)[CHECKED:]
        return pickle.loads(made) if _checksum(made) == data[:CHECKED] else None

    def save(self, key: Any, made: Any) -> None:
        """Keep what was compiled. Others may read and write the same meanwhile; a full disk keeps nothing."""
        path, data = self._path(key), dumps(made)
        own = path.with_name(f"{path.name}.{os.getpid()}")
        try:
            own.write_bytes(_checksum(data) + data)
            os.replace(own, path)
        except OSError:
            own.unlink(missing_ok=True)


class _Locator(caching._CacheLocator):
    """Where numba is to keep the code of a function."""

    def __init__(self, function, file):
        self._py_file, self._line = file, function.__code__.co_firstlineno

    @classmethod
    def from_function(cls, py_func, py_file):
        return cls(py_func, py_file)

    def get_cache_path(self):
        return str(cache_folder())

    def get_source_stamp(self):
        return cache_folder().name

    def get_disambiguator(self):
        return str(self._line)

    def ensure_cache_path(self):
        """It is there, or nothing can be kept."""


class _Kind(caching.CompileResultCacheImpl):
    _locator_classes = [_Locator]


class _Cache(caching.FunctionCache):
    """Numba's cache of a function, but for the files."""

    _impl_class = _Kind

    def __init__(self, function):
        super().__init__(function)
        self._cache_file = _Files(cache_folder(), f"{function.__module__}.{self._impl.filename_base}")
