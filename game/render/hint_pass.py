"""A hint: a line of words and keys on a dark strip in the middle below."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..scene import Hint
from .help_pass import FAINT, INK, SHEET, Pen, RowsPass
from .text import atlas, spelled, width_of

LETTERS = 1.0 / 34.0
"""Letters are so high where there is room, as parts of the picture's shorter side."""
ROOM = 0.94
"""How much of the picture's width a hint may take."""
SMALLEST, LARGEST = 6, 96
BELOW = 0.93
"""Where its middle is, in parts of the picture's height from the top."""
KEY = 0.07, 0.08, 0.10, 0.55
"""The face of a key."""


def layout(hint: Hint, size: tuple[int, int]) -> tuple[np.ndarray, int]:
    """Rows as of `help_pass.layout` of a hint over a picture of `size` pixels, and the height of their letters [px]."""
    letters = int(np.clip(round(min(size) * LETTERS), SMALLEST, LARGEST))
    wide = sum(_widths(hint, letters))
    if wide > ROOM * size[0]:  # as wide as letters are high, near enough
        letters = max(int(letters * ROOM * size[0] / wide), SMALLEST)
    font, widths = atlas(letters), _widths(hint, letters)
    unit, pen = font.line, Pen(font)
    tall = next(iter(font.cells.values()))[3] - 2 * font.margin
    left, middle = 0.5 * (size[0] - sum(widths)), BELOW * size[1]
    pen.shape(round(left), round(middle - unit), round(sum(widths)), round(2 * unit), SHEET, 0.5 * unit)
    x, y = left + 0.9 * unit, round(middle - 0.5 * tall)
    for (word, key), width in zip(hint.parts, widths[1:-1]):
        inside = x + 0.5 * (width - width_of(spelled(word), font))
        if key:
            across = width - 0.35 * unit
            place = round(x + 0.175 * unit), round(middle - 0.62 * unit), round(across), round(1.24 * unit)
            pen.shape(*place, KEY, 0.28 * unit)
            pen.shape(*place, FAINT, 0.28 * unit, max(1.0, unit / 16))
        pen.write(word, inside, y, INK, 0.0 if key else 0.5)
        x += width
    rows = np.array(pen.rows, np.float32)
    rows[:, 11] *= min(max(hint.opacity, 0.0), 1.0)
    return rows, letters


def _widths(hint: Hint, letters: int) -> list[float]:
    """Of the margin, every part and the margin again [px]."""
    font = atlas(letters)
    unit = font.line
    between = [max(width_of(spelled(word), font) + 0.7 * unit, 1.24 * unit) + 0.35 * unit if key else
               width_of(spelled(word), font) + 0.5 * unit for word, key in hint.parts]
    return [0.9 * unit, *between, 0.9 * unit]


class HintPass(RowsPass):
    """Draws a hint; made once per context."""

    def draw(self, hint: Hint, target: Any) -> None:
        """Draw over a framebuffer."""
        self.rows(*layout(hint, target.size), target)
