"""Where results go: a path is checked before the work, so that nobody waits for what can't be kept."""

from __future__ import annotations

import errno
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from gambol.controllers import files


class OutputError(ValueError):
    """A path that nothing can be written to, and what would be right."""


def output_file(path: str | Path, suffix: str) -> Path:
    """The path of a file that can be written; its folder is made. suffix: how its name has to end.

    OutputError for another suffix, a folder of that name, or where this user may not write.
    """
    path = Path(path)
    if path.suffix.lower() != suffix:
        raise OutputError(f"{path}: needs a name that ends in {suffix}")
    with named(path):
        if path.is_dir():
            raise OutputError(f"{path}: is a folder; name a file")
        if path.exists() and not os.access(path, os.W_OK):
            raise OutputError(f"{path}: is there already and write-protected; name another file")
    output_folder(path.parent)
    return path


def output_folder(path: str | Path) -> Path:
    """The path of a folder that can be written into; it is made. OutputError where it can't be."""
    path = Path(path)
    with named(path):
        if path.exists() and not path.is_dir():
            raise OutputError(f"{path}: is a file; name a folder")
        path.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=path):  # what may be written is known best by trying
            pass
    return path


@contextmanager
def whole(path: Path) -> Iterator[Path]:
    """`files.whole`: where to write a file that is to appear whole or not at all. OutputError as of `named`."""
    with named(path), files.whole(path) as part:
        yield part


def exclusive(path: Path) -> Path:
    """A new, empty file that nobody else writes: PATH, or PATH-2, PATH-3, … where that is there already. OSError."""
    for number in range(1, 10_000):
        name = path.with_stem(f"{path.stem}-{number}") if number > 1 else path
        try:
            name.touch(exist_ok=False)
            return name
        except FileExistsError:
            continue
    raise FileExistsError(errno.EEXIST, "is there already, and so are all names like it", str(path))


@contextmanager
def named(path: Path) -> Iterator[None]:
    """What the system or an encoder refuses inside becomes an OutputError that names the path."""
    try:
        yield
    except OSError as error:
        raise OutputError(f"{path}: can't be written: {files.reason(error)}") from error
