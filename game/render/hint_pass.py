"""A hint: a line of words and keys on a dark strip in the middle below."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..scene import Hint
from .help_layout import FAINT, INK, SHEET, Pen
from .help_pass import RowsPass
from .text import atlas, spelled, width_of

LETTERS = 1.0 / 34.0
"""Letters are so high where there is room, as parts of the picture's shorter side."""
ROOM = 0.94
"""How much of its room a hint may take."""
SMALLEST, LARGEST = 11, 96
BELOW = 0.93
"""Where the middle of its last line is, in parts of the picture's height from the top."""
KEY = 0.07, 0.08, 0.10, 0.55
"""The face of a key."""
Parts = Sequence[tuple[str, bool]]


def layout(hint: Hint, size: tuple[int, int]) -> tuple[np.ndarray, int]:
    """Rows as of `help_layout.layout` of a hint over a picture of `size` pixels, and the height of their letters [px].

    Letters shrink until it fits its room; where they would be too small it goes on in more lines, and where one word is
    wider than its room there are no rows.
    """
    left, right = (share * size[0] for share in hint.room)
    room = ROOM * (right - left)
    letters = int(np.clip(round(min(size) * LETTERS), SMALLEST, LARGEST))
    wide = sum(_widths(hint.parts, letters))
    if wide > room:  # as wide as letters are high, near enough
        letters = max(int(letters * room / wide), SMALLEST)
    lines = _lines(hint.parts, letters, room)
    font = atlas(letters)
    unit, pen = font.line, Pen(font)
    across = max(sum(_widths(line, letters)) for line in lines)
    if across > room:
        return np.zeros((0, 14), np.float32), letters
    tall = next(iter(font.cells.values()))[3] - 2 * font.margin
    centre, apart = 0.5 * (left + right), 1.4 * unit
    high = 2 * unit + apart * (len(lines) - 1)
    top = min(BELOW * size[1] + unit, size[1] - 2.0) - high
    pen.shape(round(centre - 0.5 * across), round(top), round(across), round(high), SHEET, 0.5 * unit)
    for number, line in enumerate(lines):
        widths, middle = _widths(line, letters), top + unit + number * apart
        x, y = centre - 0.5 * sum(widths) + 0.9 * unit, round(middle - 0.5 * tall)
        for (word, key), width in zip(line, widths[1:-1]):
            inside = x + 0.5 * (width - width_of(spelled(word), font))
            if key:
                place = round(x + 0.175 * unit), round(middle - 0.62 * unit), round(width - 0.35 * unit), round(1.24 * unit)
                pen.shape(*place, KEY, 0.28 * unit)
                pen.shape(*place, FAINT, 0.28 * unit, max(1.0, unit / 16))
            pen.write(word, inside, y, INK, 0.0 if key else 0.5)
            x += width
    rows = np.array(pen.rows, np.float32)
    rows[:, 11] *= min(max(hint.opacity, 0.0), 1.0)
    return rows, letters


def _lines(parts: Parts, letters: int, room: float) -> list[Parts]:
    """The parts in lines no wider than `room` [px], broken between words where there is no other way."""
    if sum(_widths(parts, letters)) <= room:
        return [tuple(parts)]
    lines: list[list[tuple[str, bool]]] = [[]]
    words = [(word, key) for text, key in parts for word in ([text] if key else text.split(" "))]
    for word, key in words:
        last = lines[-1]
        joins = bool(last) and not (key or last[-1][1])  # words of one kind stand together
        longer = [*last[:-1], (f"{last[-1][0]} {word}", False)] if joins else [*last, (word, key)]
        if last and sum(_widths(longer, letters)) > room:
            lines.append([(word, key)])
        else:
            lines[-1] = longer
    return [tuple(line) for line in lines]


def _widths(parts: Parts, letters: int) -> list[float]:
    """Of the margin, every part and the margin again [px]."""
    font = atlas(letters)
    unit = font.line
    between = [max(width_of(spelled(word), font) + 0.7 * unit, 1.24 * unit) + 0.35 * unit if key else
               width_of(spelled(word), font) + 0.5 * unit for word, key in parts]
    return [0.9 * unit, *between, 0.9 * unit]


class HintPass(RowsPass):
    """Draws a hint; made once per context."""

    def draw(self, hint: Hint, target: Any) -> None:
        """Draw over a framebuffer."""
        rows, letters = layout(hint, target.size)
        if len(rows):
            self.rows(rows, letters, target)
