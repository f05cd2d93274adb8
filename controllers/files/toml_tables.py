"""The tables of a TOML file, whoever wrote it."""

from __future__ import annotations

import tomllib
from os import PathLike
from typing import Any

from .safe_files import contents


def tables(path: str | PathLike[str], most: int = 1 << 20) -> dict[str, Any]:
    """The tables of a file of at most so many bytes, in UTF-8 with or without a byte order mark.

    OSError as of `contents`; UnicodeDecodeError; tomllib.TOMLDecodeError, also where brackets are nested too deeply.
    """
    text = contents(path, most).decode("utf-8-sig")
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise tomllib.TOMLDecodeError("brackets are nested too deeply") from None
