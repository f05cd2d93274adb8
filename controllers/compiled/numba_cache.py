"""Numba's compiler with a cache of our own."""

from __future__ import annotations

import hashlib
import os
import pickle
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from numba import njit, types
from numba.core import caching
from numba.core.serialize import dumps

from .cache_places import cache_folder
from .ingredients import Untold, ingredients

CHECKED = 16
"""Bytes of a file's checksum, with which it begins."""
UNTOLD = bytes(32)
"""Stands after it in place of what a kernel is made of, where that can't be said."""


def kernel(function: Callable[..., Any] | None = None, **options: Any) -> Callable[..., Any]:
    """Decorate a function for compilation by numba in no-Python mode, cached. Options are njit's."""
    if function is None:
        return lambda f: kernel(f, **options)
    made: Any = njit(**options)(function)
    if not hasattr(made, "get_call_template"):  # a plain function, where compiling is switched off
        return made
    made._cache = _Cache(made)
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
    """What was compiled of one kernel: a file for each signature, named after it; in it a checksum, what the kernel is made of, and its code."""

    def __init__(self, folder: Path, name: str, made_of: Callable[[Any], bytes]):
        """made_of: what the kernel is made of for a signature, UNTOLD where that can't be said."""
        self._folder, self._name, self._made_of = folder, name, made_of

    def load(self, key: Any) -> Any:
        """What `save` was given, by these sources or by others with the same kernel; None where there is nothing, or nothing whole."""
        path = self._path(key)
        data = _whole(path)
        if data is None and (data := self._elsewhere(path.name, key)) is not None:
            _write(path, data)
        return None if data is None else pickle.loads(memoryview(data)[CHECKED + len(UNTOLD):])

    def save(self, key: Any, made: Any) -> None:
        """Keep what was compiled. Others may read and write the same meanwhile; a full disk keeps nothing."""
        data = self._made_of(key) + dumps(made)
        _write(self._path(key), _checksum(data) + data)

    def _path(self, key: Any) -> Path:
        return self._folder / f"{self._name}-{hashlib.sha256(repr(key).encode()).hexdigest()[:16]}.nbc"

    def _elsewhere(self, name: str, key: Any) -> bytes | None:
        """What other versions of the sources compiled, if it is made of the same."""
        others = [path for path in self._folder.parent.glob(f"kernels-*/{name}") if path.parent != self._folder]
        if not others or (made_of := self._made_of(key)) == UNTOLD:
            return None
        return next((data for path in others if (data := _whole(path)) and data[CHECKED:CHECKED + len(UNTOLD)] == made_of), None)


def _whole(path: Path) -> bytes | None:
    """A file's bytes, if they are as they were written."""
    try:
        data = path.read_bytes()
    except OSError:
        return None
    return data if _checksum(memoryview(data)[CHECKED:]) == data[:CHECKED] else None


def _write(path: Path, data: bytes) -> None:
    own = path.with_name(f"{path.name}.{os.getpid()}")
    try:
        own.write_bytes(data)
        os.replace(own, path)
    except OSError:
        own.unlink(missing_ok=True)


class _Locator(caching._CacheLocator):
    """Where numba is to keep the code of a function."""

    def __init__(self, file):
        self._py_file = file

    @classmethod
    def from_function(cls, py_func, py_file):
        return cls(py_file)

    def get_cache_path(self):
        return str(cache_folder())

    def get_source_stamp(self):
        return cache_folder().name

    def get_disambiguator(self):
        return ""  # a line more above a kernel changes nothing

    def ensure_cache_path(self):
        """It is there, or nothing can be kept."""


class _Kind(caching.CompileResultCacheImpl):
    _locator_classes = [_Locator]


class _Cache(caching.FunctionCache):
    """Numba's cache of a function, but for the files."""

    _impl_class = _Kind

    def __init__(self, made: Any):
        function = made.py_func
        super().__init__(function)

        def made_of(key: tuple[Iterable[types.Type], Any, Any]) -> bytes:
            try:
                return ingredients(made, key[0])
            except Untold:
                return UNTOLD
        self._cache_file = _Files(cache_folder(), f"{function.__module__}.{self._impl.filename_base}", made_of)
