"""What a misspelt name was meant to be."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


def meant(name: str, known: Iterable[str]) -> list[str]:
    """What somebody may have meant by a name that there is not: the nearest two at most, best first."""
    known = sorted(known)
    # SHIFT and CTRL are parts of names rather than misspellings of them
    return [k for k in known if len(name) > 2 and name in k][:2] or difflib.get_close_matches(name, known, 2, 0.6)


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """The end of a line about a name that there is not; empty where nothing is near it."""
    near = meant(name, known)
    return f"; did you mean {' or '.join(near)}?" if near else ""
