"""Panels without a window, by hand: they open and close, take the mouse where they are, change settings and look back."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gambol.controllers.locomotion import Locomotion
from gambol.controllers.person import person
from gambol.game.app.app import Play
from gambol.game.hosts.events import Focus, KeyEvent, MouseMove, Scroll
from gambol.game.hud import Hud
from gambol.game.hud.canvas import LEGIBLE
from gambol.game.hud.panels import COLUMN, LEAST, layout
from gambol.game.scene import PANELS
from gambol.game.session.settings import SETTINGS
from panel_hands import NOWHERE, SIZE, button, click, frames, point, tap


@pytest.fixture(scope="module")
def locomotion():
    return Locomotion.load()


@pytest.fixture
def game(locomotion):
    played = Play(person(locomotion))
    yield played
    played.close()


@pytest.mark.thorough
def test_who_opens_no_panel_never_loads_imgui():
    done = subprocess.run([sys.executable, "-c", "import gambol.game.app.app, gambol.game.hosts.window, gambol.game.render, sys\n"
                           "print('imgui_bundle' in sys.modules)"], cwd=Path(__file__).parents[2],
                          capture_output=True, text=True, timeout=600)
    assert done.stdout.split() == ["False"], done.stderr


def test_panels_open_and_close_and_leave_a_clean_picture(game):
    assert frames(game).ink is None
    alone = len(tap(game, "F5").ink.vertices)
    assert len(tap(game, "F3", "F4", "F6").ink.vertices) > 3 * alone
    assert tap(game, "F2").ink is None


def test_ink_is_whole(game):
    """Every triangle has its vertices and every stroke its image, whatever the size of the picture."""
    tap(game, "F2")
    for size in ((1280, 720), (1920, 1080), (640, 360), (3840, 2160), (200, 900), (16, 16)):
        for _ in range(2):
            game.tick(1 / 60)
            ink = game.scene(size).ink
        assert ink.size == size and len(ink.indices) % 3 == 0 and (ink.indices < len(ink.vertices)).all()
        assert len(ink.indices) or max(size) < 100, "no panel where none could be read"
        assert sum(stroke.count for stroke in ink.strokes) == len(ink.indices)
        assert {stroke.sheet for stroke in ink.strokes} <= set(ink.sheets)
        assert np.isfinite(ink.vertices["place"]).all()


@given(st.integers(100, 2000), st.integers(100, 1200), st.sets(st.sampled_from(sorted(PANELS)), min_size=1), st.booleans())
def test_panels_never_lie_over_each_other_and_what_is_alone_has_room(width, height, open, told):
    scale = min(max(min(height / 720.0, width / 1000.0), LEGIBLE), 4.0)
    places = layout((width, height), scale, open, told)
    for name, (x, y, wide, high) in places.items():
        assert x >= 0 and y >= 0 and x + wide <= width + 1e-6 and y + high <= height + 1e-6
        assert name == "strip" or name not in PANELS or wide >= scale * COLUMN - 1e-6 and high >= scale * LEAST - 1e-6
        for other, (u, v, across, tall) in places.items():
            assert name == other or x + wide <= u + 1e-6 or u + across <= x + 1e-6 or y + high <= v + 1e-6 or v + tall <= y + 1e-6
    if width >= 320 and height >= 260:
        assert "strip" in places and open & set(places)
        assert next(name for name in ("settings", "quality", "space", "plots") if name in open) in places
    if width >= 1000 and height >= 560:
        assert open <= set(places)


def test_what_has_no_room_is_told(game):
    tap(game, "F2")
    game.tick(1 / 60)
    assert not any("no room" in line for line in game.scene(SIZE).text)
    assert game.scene((320, 240)).text[1:] == ("no room here for control space, velocities, quality",)
    for line in ("one", "two"):
        game.kept.say(line)
    assert game.scene((320, 240)).text[1:] == ("two",), "more lines would lie under the panels"


def test_a_sheet_is_never_written_again(game):
    """Ink once given stays as it was, though letters are added as they are first needed."""
    first = tap(game, "F5").ink
    before = {number: pixels.copy() for number, pixels in first.sheets.items()}
    tap(game, "F2", "F2")
    assert all(np.array_equal(first.sheets[number], pixels) for number, pixels in before.items())


def test_the_mouse_is_the_panels_where_they_are_and_the_games_elsewhere(game):
    tap(game, "F6")
    camera = game.now.players[0].camera
    left, top, width, height = layout(SIZE, 1.0)["settings"]
    point(game, left + 0.5 * width, top + 0.9 * height)
    button(game, True)
    game.handle(MouseMove(0.3, 0.5, 0.2, 0.1))
    game.handle(Scroll(0.0, 3.0))
    frames(game)
    button(game, False)
    after = game.now.players[0].camera
    assert (after.wanted_yaw, after.wanted_pitch, after.distance) == pytest.approx(
        (camera.wanted_yaw, camera.wanted_pitch, camera.distance), abs=0.01)
    point(game, *NOWHERE)
    button(game, True)
    game.handle(MouseMove(0.9, 0.5, 0.1, 0.0))
    frames(game)
    assert abs(game.now.players[0].camera.wanted_yaw - camera.wanted_yaw) > 0.1
    # a drag that began outside goes on over a panel, and ends there
    turned = game.now.players[0].camera.wanted_yaw
    game.handle(MouseMove(0.2, 0.5, -0.1, 0.0))
    frames(game)
    assert abs(game.now.players[0].camera.wanted_yaw - turned) > 0.1
    button(game, False)
    assert not game.hands.keyboard.down


def test_losing_the_window_leaves_nothing_pressed(game):
    tap(game, "F6")
    point(game, *NOWHERE)
    button(game, True)
    game.handle(KeyEvent("LEFT_BUTTON", False))
    game.handle(Focus(False))
    frames(game)
    assert not game.showing.hud.canvas.held


def middle_of(setting):
    """Where the middle of a slider of the walking controller is [px]; they follow one another evenly."""
    left, top, width, _ = layout(SIZE, 1.0)["settings"]
    return left + 0.53 * width, top + 101 + 29 * setting


def test_a_slider_changes_its_setting_and_a_reset_takes_it_back(game):
    tap(game, "F6")
    shipped = [game.now.setting(s.name) for s in SETTINGS]
    click(game, *middle_of(6))
    assert [s.name for s, was in zip(SETTINGS, shipped) if game.now.setting(s.name) != was] == ["locomotion.walk_below"]
    low, high = SETTINGS[6].low, SETTINGS[6].high
    assert game.now.setting("locomotion.walk_below") == pytest.approx(0.5 * (low + high), abs=0.2 * (high - low))
    left, top, *_ = layout(SIZE, 1.0)["settings"]
    click(game, left + 40, top + 45)  # reset all
    assert [game.now.setting(s.name) for s in SETTINGS] == pytest.approx(shipped)


def test_a_number_typed_into_a_slider_is_not_played(game):
    tap(game, "F6")
    point(game, *middle_of(2))
    game.handle(KeyEvent("LEFT_CONTROL", True))
    frames(game)
    button(game, True)
    button(game, False)
    game.handle(KeyEvent("LEFT_CONTROL", False))
    frames(game)
    mesh = game.showing.overlays.mesh
    for key in ("2", "PERIOD", "1", "ENTER"):  # 1 and 2 show and hide the body and the skeleton
        tap(game, key)
    assert game.now.setting("locomotion.acceleration") == pytest.approx(2.1)
    assert game.showing.overlays.mesh == mesh and not game.showing.overlays.skeleton


def test_the_strip_pauses_looks_back_and_plays_on_from_there(game):
    game.handle(KeyEvent("W", True))
    frames(game, 120)
    game.handle(KeyEvent("W", False))
    tap(game, "F5")
    places = layout(SIZE, 1.0)
    left, top, width, _ = places["strip"]
    bar = top + 43
    click(game, left + 30, bar)
    assert game.now.paused
    click(game, left + 0.5 * width, bar)
    behind = game.past.look.behind
    assert 20 < behind < 110 and game.moment is game.past.timeline.past[-behind]
    then = game.moment.after.characters[0].state.ground.copy()
    number = game.now.after.number
    click(game, left + width - 40, bar)
    assert game.past.look is None and not game.now.paused and game.now.after.number < number - 10
    assert np.linalg.norm(game.past.timeline.past[0].after.characters[0].state.ground[:2] - then[:2]) < 2.0


def test_two_huds_do_not_mix(game, locomotion):
    other = Play(locomotion)
    tap(game, "F2")
    tap(other, "F5")
    a, b = frames(game).ink, frames(other).ink
    assert len(a.vertices) > 2 * len(b.vertices) and set(PANELS) == game.showing.panels
    other.close()
    assert frames(game).ink is not None


def test_a_hud_that_was_never_opened_is_given_back():
    Hud().release()
