"""TOML files that users write: their tables, or one line about why there are none."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from gambol.controllers.files import reason, tables

LARGEST = 4 << 20
"""The largest file that is read [bytes]."""


def read(file: str | Path, error: type[ValueError]) -> dict[str, Any]:
    """The tables of a file, in UTF-8 with or without a byte order mark. `error`, naming it, where it can't be read."""
    try:
        return tables(file, LARGEST)
    except UnicodeDecodeError as fault:
        raise error(f"{file}: not UTF-8 text (byte {fault.start})") from None
    except OSError as fault:
        raise error(f"{file}: {reason(fault)}") from None
    except tomllib.TOMLDecodeError as fault:
        raise error(f"{file}: not TOML: {fault}") from None
