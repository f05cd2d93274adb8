"""Text: spelling and layout."""

import numpy as np

from gambol.game.render import text


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


def test_lines_stand_under_each_other_and_no_text_draws_nothing():
    atlas = text.atlas(12)
    assert text.corner_rows((), atlas).shape == (0, 12)
    rows = text.corner_rows(("ab", "", "c"), atlas)
    assert len(rows) == 3 and rows[0, 0] == rows[2, 0] and rows[2, 1] - rows[0, 1] == 2 * atlas.line
