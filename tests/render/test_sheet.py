"""The help sheet: fits every picture, nothing overlaps, and what is held shows."""

from dataclasses import replace

import numpy as np
import pytest

from gambol.game.hosts.events import PadState
from gambol.game.input import DEFAULT, Keyboard, help_sheet
from gambol.game.input.remap import remapped
from gambol.game.render.help_layout import layout
from gambol.game.render.help_pages import ROOM, SMALLEST, arranged
from gambol.game.render.text import spelled
from gambol.game.scene.scene import Scene
from poses import camera

REST = PadState("A gamepad with a rather long name for its size")
PUSHED = PadState(REST.name, (1.0, 1.0, -1.0, 0.0, 1.0, 0.2), frozenset({"A", "LB", "START", "UP"}), 1)
LONG = remapped(DEFAULT, {"pause": ("RIGHT_BRACKET", "SCROLL_LOCK", "PRINT_SCREEN")}, {})
SHEETS = {"no pad": help_sheet(DEFAULT), "one": help_sheet(DEFAULT, pads=(PUSHED,)), "long names": help_sheet(LONG),
          "two": help_sheet(DEFAULT, Keyboard(frozenset("W")), (REST, PUSHED), 2)}


@pytest.mark.few(8)
@pytest.mark.parametrize("size", [(640, 360), (1280, 720), (3840, 2160), (720, 1280), (320, 240), (500, 650), (300, 900), (1000, 260)])
@pytest.mark.parametrize("name", SHEETS)
def test_every_page_fits_and_no_letter_lies_on_another(name, size):
    letters, pages = arranged(SHEETS[name], size)
    assert letters >= SMALLEST == 11
    for page in pages:
        rows, (width, height) = layout(page, size, letters)
        assert width <= ROOM * size[0] and height <= ROOM * size[1]
        assert rows[0, :2].min() >= 0, "the sheet itself"
        glyphs = rows[rows[:, 12] < 0][:, :4]
        middle = glyphs[:, :2] + 0.5 * glyphs[:, 2:]
        assert (middle > 0).all() and (middle < size).all()
        away = np.abs(middle[:, None] - middle)
        near = (away[..., 1] < 0.5 * letters) & (away[..., 0] < 0.12 * letters)
        assert near.sum() == len(glyphs), "two letters at one place"


@pytest.mark.parametrize("size", [(1280, 720), (640, 360), (320, 240), (300, 900)])
def test_pages_leave_out_no_key_and_no_button_of_a_pad_that_is_there(size):
    """In the same order, whatever lines words are broken into; a picture with room for all has one page."""
    def words(tables, columns=3):
        return [sorted(word for table in tables for row in table for word in " ".join(map(spelled, row.cells[n:n + 1])).split()) for n in range(columns)]
    for name, columns in (("no pad", 2), ("two", 3)):
        sheet = SHEETS[name]
        _, pages = arranged(sheet, size)
        assert (len(pages) == 1) == (size == (1280, 720))
        told = [tuple(row for row in table if row.title or any(row.cells[1:columns])) for table in sheet.tables]
        shown = [tuple(row for row in table if len(pages) > 1 or row.title or any(row.cells[1:columns])) for page in pages for table in page.tables]
        assert words(shown, columns) == words(told, columns)
    held = help_sheet(DEFAULT, Keyboard(frozenset("P")))
    want, = {row.cells[0] for table in held.tables for row in table if row.lit}
    assert " ".join(row.cells[0] for page in arranged(held, size)[1] for table in page.tables for row in table if row.lit).strip() == want


def test_only_a_sheet_of_several_pages_tells_of_more():
    title = SHEETS["no pad"].title
    for size in ((1280, 720), (800, 500), (640, 360), (320, 240)):
        _, pages = arranged(SHEETS["no pad"], size)
        assert all(page.title.startswith(f"{title} {number}/{len(pages)}") for number, page in enumerate(pages, 1)) if len(pages) > 1 else pages[0].title == title


def test_it_is_drawn_over_the_whole_picture_once(draw):
    scene = Scene(camera())
    left, right = replace(scene, part=(0.0, 0.0, 0.5, 1.0)), replace(scene, part=(0.5, 0.0, 0.5, 1.0))
    plain, sheet = draw((left, right), "fast", (640, 360)), SHEETS["one"]
    over = draw((replace(left, sheet=sheet), right), "fast", (640, 360))
    changed = np.abs(over.astype(int) - plain).max(-1) > 20
    assert changed[180, 110:320].mean() > 0.9 and changed[180, 320:530].mean() > 0.9 and not changed[:2].any()


def test_what_is_held_shows_in_the_picture(draw):
    def picture(pad, keys=()):
        sheet = help_sheet(DEFAULT, Keyboard(frozenset(keys)), (pad,))
        return draw(Scene(camera(), sheet=sheet), "fast", (640, 360)).astype(int)
    rest = picture(REST)
    for pad, keys in ((REST, "P"), (replace(REST, axes=(1.0, 0, 0, 0, -1, -1)), ""), (replace(REST, axes=(0, 0, 0, 0, -1, 1.0)), ""),
                      (replace(REST, buttons=frozenset("B")), "")):
        assert (np.abs(picture(pad, keys) - rest).max(-1) > 40).sum() > 20
    assert np.array_equal(picture(REST), rest)
