"""Text: spelling and layout."""

import numpy as np

from game.render import text


def test_every_character_becomes_one_that_the_font_has():
    assert text.spelled("Café → 0.3 m² ± 2 °") == "Cafe → 0.3 m2 ± 2 °"
    assert text.spelled("\N{SNOWMAN}") == "?"
    assert set(text.spelled("".join(map(chr, range(32, 0x3000))))) <= set(text.PLAIN) | set(text.ARROWS)


def test_the_atlas_has_ink_for_every_glyph():
    atlas = text.atlas(18)
    for glyph, (x, y, width, height) in atlas.cells.items():
        if glyph != " ":
            assert atlas.pixels[y:y + height, x:x + width, 0].max() > 100, glyph
    assert not np.array_equal(*[atlas.pixels[y:y + h, x:x + w, 0] for x, y, w, h in
                                (atlas.cells["↑"], atlas.cells["↓"])])


def test_columns_stand_under_each_other():
    lines = ("        keyboard  gamepad", "walk    W         left stick", "run     Shift     right trigger",
             "look              right stick")
    laid = text.columns(lines, text.atlas(18))
    xs = [[x for x, _ in row] for row in laid]
    assert xs[0] == [xs[1][1], xs[1][2]] and xs[2] == xs[1] and xs[3] == [xs[1][0], xs[1][2]]
    atlas = text.atlas(18)
    for row in laid:
        for (x, word), (after, _) in zip(row, row[1:]):
            assert x + text.width_of(word, atlas) < after


def test_a_sheet_lies_in_the_middle_and_no_text_draws_nothing():
    assert text.glyphs((), (), (640, 360), text.atlas(12)).shape == (0, 12)
    rows = text.glyphs((), ("Paused", "", "Esc  leave"), (640, 360), text.atlas(12))
    left, top, width, height = rows[0, :4]
    assert abs(left + width / 2 - 320) <= 1 and abs(top + height / 2 - 180) <= 1 and rows[0, 6] < 0
