"""Words that come from others, as they may be shown: in one line, of a bounded length, with nothing in them that a terminal obeys."""

from __future__ import annotations


def printable(text: str, most: int = 60) -> str:
    """The text with whatever can't be printed spelt out as in Python, cut where it is longer than `most` letters."""
    shown = text[:most].encode("unicode_escape").decode() if not text[:most].isprintable() else text[:most]
    return shown + ("…" if len(text) > most else "")
