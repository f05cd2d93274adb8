"""TOML files that users write: their tables, or one line about why there are none, and what a misspelt name was meant to be."""

from __future__ import annotations

import difflib
import tomllib
from collections.abc import Iterable
from pathlib import Path
from typing import Any


def read(file: str | Path, error: type[ValueError]) -> dict[str, Any]:
    """The tables of a file, in UTF-8 with or without a byte order mark. `error`, naming it, where it can't be read."""
    try:
        return tomllib.loads(Path(file).read_text(encoding="utf-8-sig"))
    except UnicodeDecodeError as fault:
        raise error(f"{file}: not UTF-8 text (byte {fault.start})") from None
    except OSError as fault:
        raise error(f"{file}: {fault.strerror or fault}") from None
    except tomllib.TOMLDecodeError as fault:
        raise error(f"{file}: not TOML: {fault}") from None


def meant(name: str, known: Iterable[str]) -> list[str]:
    """What somebody may have meant by a name that there is not: the nearest two at most, best first."""
    known = sorted(known)
    # SHIFT and CTRL are parts of names rather than misspellings of them
    return [k for k in known if len(name) > 2 and name in k][:2] or difflib.get_close_matches(name, known, 2, 0.6)


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """The end of a line about a name that there is not; empty where nothing is near it."""
    near = meant(name, known)
    return f"; did you mean {' or '.join(near)}?" if near else ""
