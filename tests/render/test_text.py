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


def test_lines_too_wide_for_the_picture_go_on_in_the_next_one():
    """At spaces, but for those that hold a name and its number together; nothing is lost, and none is wider than the picture."""
    atlas = text.atlas(12)
    line = "  cost 17.2: time\u00a04.1 forward\u00a01.0 turning\u00a00.2 looking\u00a0away\u00a010.6"
    for width in (90.0, 160.0, 240.0):
        parts = text.wrapped(line, atlas, width)
        assert " ".join(parts) == text.spelled(line) and "time 4.1" in " | ".join(parts)
        assert max(text.width_of(part, atlas) for part in parts) <= max(width, text.width_of("looking away 10.6", atlas))
    assert text.wrapped(line, atlas, 1e9) == [text.spelled(line)]
    assert text.corner_rows((line, "c"), atlas, 260)[-1, 1] > text.corner_rows((line, "c"), atlas)[-1, 1]


def test_lines_keep_off_what_lies_over_the_corner():
    """They end before it and go on below it, or begin below it where too little is left beside; nothing is lost."""
    atlas = text.atlas(12)
    words = ("tracked without the penalty on jitter: Z brings it back",) * 6
    for width, taken in ((640, (260, 90)), (640, (260, 40)), (500, (380, 90)), (300, (264, 120)), (300, (0, 0))):
        rows = text.corner_rows(words, atlas, width, taken)
        left, top, wide, high = rows[:, :4].T + np.array([[atlas.margin], [atlas.margin], [-2 * atlas.margin], [-2 * atlas.margin]])
        assert len(rows) == sum(len(line.replace(" ", "")) for line in words) and (left + wide <= width).all()
        assert not ((left + wide > width - taken[0]) & (top + 0.3 * high < taken[1])).any()
        assert taken[1] > 0 or top.min() < 2 * atlas.line
