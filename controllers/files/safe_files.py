"""Files that are read and written: no pipe is waited for, and what is written appears whole or not at all."""

from __future__ import annotations

import errno
import os
import shutil
import stat
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from io import RawIOBase
from os import PathLike
from pathlib import Path

_KINDS = ((stat.S_ISDIR, errno.EISDIR, "Is a directory; name one file in it"), (stat.S_ISFIFO, errno.EINVAL, "is a pipe, not a file"),
          (stat.S_ISSOCK, errno.EINVAL, "is a socket, not a file"), (stat.S_ISCHR, errno.EINVAL, "is a device, not a file"),
          (stat.S_ISBLK, errno.EINVAL, "is a device, not a file"))


def ordinary(path: str | PathLike[str]) -> Path:
    """The path of an ordinary file, which can be read to its end.

    OSError, whose strerror says it in words, for anything else: a pipe would keep who opens it waiting for ever.
    """
    path = Path(path)
    try:
        mode = path.stat().st_mode
    except ValueError as error:  # a NUL in the name, say
        raise OSError(errno.EINVAL, str(error), str(path)) from None
    for is_one, number, words in _KINDS:
        if is_one(mode):
            raise OSError(number, words, str(path))
    return path


def reason(error: Exception) -> str:
    """What an error says: of one of the system the words alone, without number and path."""
    return getattr(error, "strerror", None) or str(error)


def contents(path: str | PathLike[str], most: int | None = None) -> bytes:
    """All bytes of an ordinary file. most: how many there may be. OSError as of `ordinary`, and for a larger one."""
    path = ordinary(path)
    size = path.stat().st_size
    if most is not None and size > most:
        raise OSError(errno.EFBIG, f"holds {-(-size >> 20)} MiB; {most >> 20} MiB are read at most", str(path))
    return path.read_bytes()


def append(file: RawIOBase, data: bytes) -> None:
    """Write at the end of a file that was opened without a buffer, all of it or nothing. OSError where it can't be, as on a full disk,
    which may take a part without a word."""
    end, rest = file.tell(), memoryview(data)
    try:
        while rest:
            rest = rest[file.write(rest) or 0:]
    except OSError:
        with suppress(OSError):
            file.truncate(end)
            file.seek(end)
        raise


@contextmanager
def whole(path: str | Path) -> Iterator[Path]:
    """Where to write a file, or a folder, that is to appear whole or not at all: under its own name in a folder beside it
    that nobody else has. Where nothing goes wrong it is flushed to the disk and takes its place; nothing else is left."""
    path = Path(path)
    beside = Path(tempfile.mkdtemp(prefix=".gambol-", dir=path.parent))
    try:
        part = beside / path.name
        yield part
        for file in (part.rglob("*") if part.is_dir() else (part,)):
            if file.is_file():
                with open(file, "rb+") as written:
                    os.fsync(written.fileno())
        if part.is_dir() and path.is_dir():  # which no file system replaces by itself
            os.replace(path, beside / "before")
        os.replace(part, path)
    finally:
        shutil.rmtree(beside, ignore_errors=True)
