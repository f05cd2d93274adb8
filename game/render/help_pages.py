"""The help sheet in pages, where a picture is too small for all of it: letters stay legible, and cells go on in the next line."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ..scene import Row, Sheet
from .help_layout import BETWEEN, GAP, MARGIN, layout
from .text import Atlas, atlas, spelled, width_of, wrapped

LETTERS = 1.0 / 40.0
"""Letters are as high as in other text where there is room, as parts of the picture's height."""
SMALLEST, LARGEST = 11, 96
"""They are never smaller, nor larger [px]."""
ROOM = 0.98
"""How much of the picture's width and height the sheet may take."""
ABOVE, BELOW = 1.6, 2.0
"""Lines that the title takes, and that are kept for the note."""
BLANK = Row(("",))


def arranged(sheet: Sheet, size: tuple[int, int], letters: int | None = None) -> tuple[int, tuple[Sheet, ...]]:
    """The height of letters [px] and the pages of a sheet on a picture of `size` pixels: itself alone, where it fits.

    letters: as found before for the same words and size. A picture without pads shows in pages what keys do; what no page has
    room for, as sticks and lamps, is left out.
    """
    if letters is None:
        letters = wanted = _wanted(size)
        while letters >= SMALLEST and (share := _share(sheet, size, letters)) > 1.0:
            letters = min(int(letters / share), letters - 1)
        if letters < SMALLEST:
            letters = next((high for high in range(wanted, SMALLEST, -1) if _across(sheet, high) <= _room(size, high)), SMALLEST)
    if _share(sheet, size, letters) <= 1.0:
        return letters, (sheet,)
    return letters, _paged(sheet, size, letters)


def _wanted(size: tuple[int, int]) -> int:
    return min(max(round(size[1] * LETTERS), SMALLEST), LARGEST)


def _share(sheet: Sheet, size: tuple[int, int], letters: int) -> float:
    """How much of its room a sheet takes, in the direction in which it is larger."""
    _, whole = layout(sheet, size, letters)
    return max(whole[0] / (ROOM * size[0]), whole[1] / (ROOM * size[1]))


def _room(size: tuple[int, int], letters: int) -> float:
    """The width within a page's margins [px]."""
    return ROOM * size[0] - 2 * MARGIN * atlas(letters).line


def _told(sheet: Sheet) -> list[Row]:
    """All lines of a sheet under each other; without the gamepad's where there is none."""
    rows = [row for number, table in enumerate(sheet.tables) for row in (BLANK,) * (number > 0) + table]
    return rows if sheet.pads else [replace(row, cells=row.cells[:2]) for row in rows if row.title or len(row.cells) < 2 or row.cells[1]]


def _widths(rows: Sequence[Row], font: Atlas) -> list[float]:
    """How wide the cells of each column are [px]."""
    count = max(len(row.cells) for row in rows)
    return [max((width_of(spelled(row.cells[i]), font) for row in rows if i < len(row.cells)), default=0.0) for i in range(count)]


def _across(sheet: Sheet, letters: int) -> float:
    """How wide a column of all lines is [px]."""
    font = atlas(letters)
    widths = _widths(_told(sheet), font)
    return sum(widths) + GAP * font.line * (len(widths) - 1)


def _paged(sheet: Sheet, size: tuple[int, int], letters: int) -> tuple[Sheet, ...]:
    font, rows, room = atlas(letters), _told(sheet), _room(size, letters)
    unit, whole = font.line, _across(sheet, letters)
    side_by_side = max(int((room + BETWEEN * unit) / (whole + BETWEEN * unit)), 1)
    if whole > room:
        widths = _narrowed(_widths(rows, font), room - GAP * unit * (len(rows[0].cells) - 1))
        rows = [line for row in rows for line in _folded(row, widths, font)]
    most = max(int(ROOM * size[1] / unit - 2 * MARGIN - ABOVE - BELOW * bool(sheet.note)), 2)
    columns = _cut(rows, most)
    made = [Sheet(sheet.title, tuple(columns[i:i + side_by_side])) for i in range(0, len(columns), side_by_side)]
    for pads in (sheet.pads, *((pad,) for pad in sheet.pads)):  # all together, or each alone
        if pads and _share(Sheet(f"{sheet.title} 9/9", (), pads), size, letters) <= 1.0:
            made.append(Sheet(sheet.title, (), pads))
            if pads == sheet.pads:
                break
    noted = replace(made[-1], note=sheet.note)
    made[-1] = noted if _share(noted, size, letters) <= 1.0 else made[-1]
    more = "   ↓ or wheel: more"
    more = more if width_of(spelled(f"{sheet.title} 9/9{more}"), font) <= room else ""
    if len(made) == 1:
        return tuple(made)
    return tuple(replace(page, title=f"{sheet.title} {number}/{len(made)}{more}") for number, page in enumerate(made, 1))


def _narrowed(widths: Sequence[float], room: float) -> list[float]:
    """Widths of columns [px] that together have `room`: the widest give way, to one width."""
    free, left = room, sorted(widths)
    for number, width in enumerate(left):
        share = free / (len(left) - number)
        if width >= share:
            return [min(width, share) for width in widths]
        free -= width
    return list(widths)


def _folded(row: Row, widths: Sequence[float], font: Atlas) -> list[Row]:
    """A line in as many as its cells need in columns so wide [px]."""
    cells = [wrapped(cell, font, width) for cell, width in zip(row.cells, widths)]
    high = max(map(len, cells))
    return [replace(row, cells=tuple(parts[k] if k < len(parts) else "" for parts in cells)) for k in range(high)]


def _cut(rows: Sequence[Row], most: int) -> list[tuple[Row, ...]]:
    """Columns of at most so many lines; none begins with a blank line, or ends with a title."""
    made, left = [], list(rows)
    while left:
        if not any(left[0].cells):
            left = left[1:]
            continue
        end = min(most, len(left))
        while 1 < end < len(left) and (left[end - 1].title or not any(left[end - 1].cells)):
            end -= 1
        made.append(tuple(left[:end]))
        left = left[end:]
    return made
