"""The help sheet: fits every picture, nothing overlaps, and what is held shows."""

from dataclasses import replace

import numpy as np
import pytest

from gambol.game.hosts.events import PadState
from gambol.game.input import DEFAULT, Keyboard, help_sheet
from gambol.game.input.remap import remapped
from gambol.game.render.help_pass import ROOM, SMALLEST, layout, letters_for
from gambol.game.scene.scene import Scene
from poses import camera

REST = PadState("A gamepad with a rather long name for its size")
PUSHED = PadState(REST.name, (1.0, 1.0, -1.0, 0.0, 1.0, 0.2), frozenset({"A", "LB", "START", "UP"}), 1)
LONG = remapped(DEFAULT, {"pause": ("RIGHT_BRACKET", "SCROLL_LOCK", "PRINT_SCREEN")}, {})
SHEETS = {"no pad": help_sheet(DEFAULT), "one": help_sheet(DEFAULT, pads=(PUSHED,)), "long names": help_sheet(LONG),
          "two": help_sheet(DEFAULT, Keyboard(frozenset("W")), (REST, PUSHED), 2)}


@pytest.mark.parametrize("size", [(640, 360), (1280, 720), (3840, 2160), (720, 1280)])
@pytest.mark.parametrize("name", SHEETS)
def test_it_fits_and_no_letter_lies_on_another(name, size):
    letters = letters_for(SHEETS[name], size)
    rows, (width, height) = layout(SHEETS[name], size, letters)
    assert letters > SMALLEST and width <= ROOM * size[0] and height <= ROOM * size[1]
    assert rows[0, :2].min() >= 0, "the sheet itself"
    glyphs = rows[rows[:, 12] < 0][:, :4]
    middle = glyphs[:, :2] + 0.5 * glyphs[:, 2:]
    assert (middle > 0).all() and (middle < size).all()
    away = np.abs(middle[:, None] - middle)
    near = (away[..., 1] < 0.5 * letters) & (away[..., 0] < 0.12 * letters)
    assert near.sum() == len(glyphs), "two letters at one place"


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
