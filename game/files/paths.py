"""Where results go: a path is checked before the work, so that nobody waits for what can't be kept."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


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
    """Where to write a file that is to appear whole or not at all; it takes its place when nothing went wrong.

    OutputError as of `named`.
    """
    part = path.with_name(f"{path.name}.part")
    with named(path):
        try:
            yield part
            os.replace(part, path)
        finally:
            part.unlink(missing_ok=True)


@contextmanager
def named(path: Path) -> Iterator[None]:
    """What the system or an encoder refuses inside becomes an OutputError that names the path."""
    try:
        yield
    except OSError as error:
        raise OutputError(f"{path}: can't be written: {error.strerror or error}") from error
