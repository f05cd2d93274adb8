"""Ink on the picture: in its place, its colours, inside its clips, and over everything."""

from dataclasses import replace

import numpy as np
import pytest

from gambol.controllers.locomotion import Locomotion
from gambol.game.hud import Hud
from gambol.game.hud.panels import layout
from gambol.game.scene import PANELS
from gambol.game.input import Wish
from gambol.game.render.draw_list_pass import InkPass
from gambol.game.scene.draw_list import VERTEX, Ink, Stroke
from gambol.game.scene.scene import Scene
from gambol.game.session.state import opening
from gambol.game.session.tick import Timeline
from poses import STRIDE, camera, figure

WHITE = np.full((1, 1, 4), 255, np.uint8)
SIZE = (64, 48)


def rectangle(left, top, right, bottom, tint, clip=(0, 0, *SIZE), sheet=1, size=SIZE, sheets=None):
    vertices = np.zeros(4, VERTEX)
    vertices["place"] = (left, top), (right, top), (right, bottom), (left, bottom)
    vertices["uv"] = (0, 0), (1, 0), (1, 1), (0, 1)
    vertices["tint"] = tint
    return Ink(size, vertices, np.array([0, 1, 2, 0, 2, 3], np.uint32), (Stroke(clip, sheet, 0, 6),), sheets or {1: WHITE})


@pytest.fixture(scope="module")
def paint(ctx):
    """paint(ink, …) → picture (H, W, 4) on grey, top row first."""
    target = ctx.framebuffer([ctx.renderbuffer(SIZE, 4)])
    drawn = InkPass(ctx)

    def picture(*inks):
        target.use()
        target.clear(0.5, 0.5, 0.5, 1.0)
        for ink in inks:
            target.viewport = 5, 5, 9, 9  # as a part of a split picture leaves it
            drawn.draw(ink, target)
        return np.frombuffer(target.read(components=4), np.uint8).reshape(SIZE[1], SIZE[0], 4)[::-1]
    yield picture
    drawn.release()


def test_places_count_from_the_top_left_and_colours_are_those_shown(paint):
    picture = paint(rectangle(5, 7, 20, 30, (10, 200, 90, 255)))
    inside = np.zeros(SIZE[::-1], bool)
    inside[7:30, 5:20] = True
    assert np.all(picture[inside][:, :3] == (10, 200, 90)) and np.all(picture[~inside][:, :3] == picture[0, 0, :3])


def test_opacity_mixes_and_leaves_the_picture_opaque(paint):
    picture = paint(rectangle(0, 0, *SIZE, (255, 0, 0, 128)))
    np.testing.assert_allclose(picture[9, 9, :3], (192, 63, 63), atol=1)
    assert picture[9, 9, 3] == 255


def test_clips_cut_and_do_not_outlast_their_stroke(paint):
    picture = paint(rectangle(0, 0, *SIZE, (255, 255, 255, 255), clip=(10, 4, 30, 12)))
    assert (picture[..., 0] == 255).sum() == 20 * 8 and picture[4, 10, 0] == 255 and picture[3, 10, 0] != 255
    assert np.all(paint(rectangle(0, 0, *SIZE, (255, 255, 255, 255)))[..., 0] == 255)
    outside = paint(rectangle(0, 0, *SIZE, (255, 255, 255, 255), clip=(70, 4, 90, 12)))
    assert np.all(outside[..., 0] != 255)


def test_ink_of_another_size_is_stretched(paint):
    big = rectangle(20, 20, 60, 60, (255, 255, 255, 255), clip=(0, 0, 128, 96), size=(128, 96))
    picture = paint(big)
    assert np.all(picture[10:30, 10:30, 0] == 255) and (picture[..., 0] == 255).sum() == 400


def test_a_changed_sheet_is_drawn_as_it_is_now(paint):
    for level in (40, 90):
        sheet = np.full((2, 2, 4), (level, level, level, 255), np.uint8)
        assert paint(rectangle(0, 0, *SIZE, (255, 255, 255, 255), sheets={1: sheet}))[5, 5, 0] == level
    missing = paint(rectangle(0, 0, *SIZE, (255, 255, 255, 255), sheet=7))
    assert missing[5, 5, 0] == 127 or missing[5, 5, 0] == 128


def test_panels_cover_their_places_and_not_the_character(draw):
    """A picture with all panels beside the same without: the middle, where the character is, is the same."""
    size = (1280, 720)
    timeline, hud = Timeline(opening(Locomotion.load())), Hud()
    for _ in range(90):
        timeline.advance((Wish(move=(0.0, 1.0)),))
    for _ in range(3):
        ink, _ = hud.frame(PANELS, [*timeline.past, timeline.now], timeline.now, 0, 90, size, 1 / 60)
    hud.release()
    scene = Scene(camera(), (figure(**STRIDE),))
    bare, covered = (draw(s, "fast", size).astype(int) for s in (scene, replace(scene, ink=ink)))
    changed = np.abs(bare - covered).max(-1) > 3
    places = {name: tuple(round(v) for v in place) for name, place in layout(size, 1.0).items()}
    for name, (left, top, width, height) in places.items():
        part = changed[top + 9:top + height - 9, left + 9:left + width - 9]
        assert part.mean() > 0.97, name
        changed[top - 1:top + height + 1, left - 1:left + width + 1] = False
    assert not changed.any()
