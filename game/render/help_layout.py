"""The help sheet: the layout of a page of it, as plain arrays."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from ..scene import Pad, Row, Sheet
from .text import Atlas, atlas, spelled, width_of

INK, DIM, ACCENT, DARK = (0.95, 0.95, 0.93, 1.0), (0.70, 0.73, 0.76, 1.0), (0.97, 0.66, 0.36, 1.0), (0.10, 0.08, 0.06, 1.0)
SHEET, LIT, FAINT = (0.05, 0.06, 0.08, 0.90), (0.93, 0.62, 0.33, 0.22), (0.70, 0.73, 0.76, 0.45)
GAP, BETWEEN, MARGIN = 0.9, 1.7, 0.9
"""Lines between columns, between tables and around everything."""
DIAL = 2.6
"""Lines that a dial is high."""
SHADOW = 0.5
"""How strong the shadow of letters is."""


@dataclass
class Pen:
    """Collects rows as of `layout`."""

    font: Atlas
    rows: list[tuple] = field(default_factory=list)

    def shape(self, left, top, width, height, tint, radius=0.0, rim=0.0) -> None:
        self.rows.append((left, top, width, height, 0, 0, 0, 0, *tint, min(radius, 0.5 * min(width, height)), rim))

    def circle(self, x, y, radius, tint, rim=0.0) -> None:
        self.shape(x - radius, y - radius, 2 * radius, 2 * radius, tint, radius, rim)

    def write(self, line: str, x: float, y: float, tint=INK, shadow=SHADOW) -> float:
        """Where the pen then stands."""
        font = self.font
        for char in spelled(line):
            if char != " ":
                cell = font.cells[char]
                self.rows.append((round(x) - font.margin, round(y) - font.margin, cell[2], cell[3], *cell, *tint, -1, shadow))
            x += font.advances[char]
        return x


def layout(sheet: Sheet, size: tuple[int, int], letters: int) -> tuple[np.ndarray, tuple[float, float]]:
    """Rows (N, 14) of a sheet in the middle of a picture, and its width and height [px].

    letters: how high they are [px]. A row: place and cell in the atlas, left, top, width, height [px], then display RGB and opacity,
    the radius of the corners and the width of the rim [px]; of a letter −1 and the strength of its shadow.
    """
    font = atlas(letters)
    unit, inner = font.line, Pen(font)
    width, tall, bottom = 0.0, 0.0, 1.6 * unit
    for table in sheet.tables:
        left = width + (BETWEEN * unit if width else 0.0)
        width = left + _table(inner, table, left, bottom)
        tall = max(tall, len(table) * unit)
    bottom += tall
    if sheet.tables and (sheet.pads or sheet.note):
        bottom += 0.5 * unit
        inner.shape(0.0, bottom, width, max(1.0, round(unit / 16)), FAINT)
        bottom += 0.5 * unit
    half, beside = 0.5 * (width + BETWEEN * unit), 2 if sheet.tables else 1
    for i, pad in enumerate(sheet.pads):
        row, column = divmod(i, beside)
        width = max(width, _pad(inner, pad, column * half, bottom + row * (DIAL + 1.8) * unit))
    if sheet.pads:
        bottom += (math.ceil(len(sheet.pads) / beside) * (DIAL + 1.8) - 0.6) * unit
    if sheet.note:
        bottom += 0.5 * unit * bool(sheet.pads)
        width = max(width, inner.write(sheet.note, 0.0, bottom, DIM))
        bottom += unit
    outer = Pen(font)
    margin, width = MARGIN * unit, max(width, width_of(spelled(sheet.title), font))
    whole = width + 2 * margin, bottom + 2 * margin
    outer.shape(-margin, -margin, *whole, SHEET, 0.5 * unit)
    outer.write(sheet.title, 0.0, 0.0, ACCENT)
    rows = np.array(outer.rows + inner.rows, np.float32)
    rows[:, :2] += np.round(0.5 * (np.array(size) - whole) + margin)
    return rows, whole


def _table(pen: Pen, table: tuple[Row, ...], left: float, top: float) -> float:
    """Write a table; its width [px]."""
    font, unit = pen.font, pen.font.line
    count = max(len(line.cells) for line in table)
    widths = [max((width_of(spelled(line.cells[i]), font) for line in table if i < len(line.cells)), default=0.0)
              for i in range(count)]
    starts = [left + sum(widths[:i]) + i * GAP * unit for i in range(count)]
    whole = starts[-1] + widths[-1] - left
    for number, line in enumerate(table):
        y = top + number * unit
        if line.lit:
            pen.shape(left - 0.4 * unit, y - 0.1 * unit, whole + 0.8 * unit, unit, LIT, 0.3 * unit)
        for i, (cell, x) in enumerate(zip(line.cells, starts)):
            pen.write(cell, x, y, (ACCENT if i == 0 else DIM) if line.title else DIM if i == 0 and not line.lit else INK)
    return whole


def _pad(pen: Pen, pad: Pad, left: float, top: float) -> float:
    """Draw a pad: dials, bars and lamps; where it ends [px]."""
    unit, thin = pen.font.line, max(1.0, pen.font.line / 16)
    end = pen.write(pad.caption, left, top)
    x, top, radius = left, top + 1.2 * unit, 0.5 * DIAL * unit
    for dial in pad.dials:
        middle = x + radius, top + radius
        reach = 0.9 * radius  # that the dot stays on the dial
        pen.circle(*middle, radius, (0.0, 0.0, 0.0, 0.35))
        pen.circle(*middle, reach, FAINT, thin)
        pen.circle(*middle, reach * dial.full, (*FAINT[:3], 0.2), thin)
        pen.circle(*middle, max(reach * dial.dead_zone, 2.0), FAINT, thin)
        pushed = math.hypot(*dial.at)
        away = reach / max(pushed, 1.0)  # a square gate's corners lie outside the circle
        pen.circle(middle[0] + away * dial.at[0], middle[1] - away * dial.at[1], max(0.17 * unit, 2.0),
                   ACCENT if pushed > dial.dead_zone else INK)
        x += 2 * radius + 0.5 * unit
    for bar in pad.bars:
        wide, high = width_of(spelled(bar.label), pen.font), (DIAL - 1.0) * unit
        at = x + 0.5 * (wide - 0.5 * unit)
        pen.shape(at, top, 0.5 * unit, high, (0.0, 0.0, 0.0, 0.35), 0.15 * unit)
        pen.shape(at, top, 0.5 * unit, high, FAINT, 0.15 * unit, thin)
        if bar.filled > 0.0:
            pen.shape(at, top + (1.0 - bar.filled) * high, 0.5 * unit, bar.filled * high, ACCENT, 0.15 * unit)
        pen.write(bar.label, x, top + high + 0.1 * unit, DIM)
        x += wide + 0.5 * unit
    x += 0.2 * unit
    tall = next(iter(pen.font.cells.values()))[3] - 2 * pen.font.margin
    for number, row in enumerate(pad.lamps):
        at, y = x, top + number * 1.35 * unit
        for lamp in row:
            wide = max(width_of(spelled(lamp.label), pen.font) + 0.5 * unit, 1.1 * unit)
            pen.shape(at, y, wide, 1.1 * unit, ACCENT if lamp.lit else FAINT, 0.35 * unit, 0.0 if lamp.lit else thin)
            pen.write(lamp.label, at + 0.5 * (wide - width_of(spelled(lamp.label), pen.font)),
                      y + 0.5 * (1.1 * unit - tall), DARK if lamp.lit else DIM, 0.0 if lamp.lit else SHADOW)
            at += wide + 0.2 * unit
        end = max(end, at)
    return end
