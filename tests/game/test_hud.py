"""Panels without a window: what they show, what they take from the game and what they ask of it."""

import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gambol.controllers.body.rotations import yaw
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.person import person
from gambol.game.app.app import Play
from gambol.game.character import Build, tailored
from gambol.game.hosts.events import Focus, KeyEvent, MouseMove, Scroll
from gambol.game.hud import Hud, reason
from gambol.game.hud.ghost import ghost
from gambol.game.hud.history import STEPS, Trace
from gambol.game.hud.on_duty import acting, own, why
from gambol.game.hud.panels import layout
from gambol.game.scene import PANELS
from gambol.game.hud.plots import runs, ticks
from gambol.game.hud.sliders import Row
from gambol.game.hud.tetrahedra import Mesh, Orbit
from gambol.game.input import Wish
from gambol.game.session.settings import SETTINGS
from gambol.game.session.state import opening, owners
from gambol.game.session.tick import Timeline
from gambol.game.world.embodied import Embodied
from stand_in import Glide

SIZE = (1280, 720)
NOWHERE = (640, 400)


@pytest.fixture(scope="module")
def locomotion():
    return Locomotion.load()


@pytest.fixture
def game(locomotion):
    played = Play(person(locomotion))
    yield played
    played.close()


def frames(game, count=2):
    for _ in range(count):
        game.tick(1 / 60)
        scene = game.scene(SIZE)
    return scene


def point(game, x, y):
    game.handle(MouseMove(x / SIZE[1], y / SIZE[1], 0.0, 0.0))
    frames(game)


def button(game, pressed):
    game.handle(KeyEvent("LEFT_BUTTON", pressed))
    frames(game)


def click(game, x, y):
    point(game, x, y)
    button(game, True)
    button(game, False)


def tap(game, *keys):
    for key in keys:
        game.handle(KeyEvent(key, True))
        game.handle(KeyEvent(key, False))
    return frames(game)


def walked(controller, seconds, *wishes):
    timeline = Timeline(opening(controller))
    for wish in wishes:
        for _ in range(round(60 * seconds)):
            timeline.advance((wish,))
    return timeline


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
        assert ink.size == size and len(ink.indices) % 3 == 0 and ink.indices.max() < len(ink.vertices)
        assert sum(stroke.count for stroke in ink.strokes) == len(ink.indices)
        assert {stroke.sheet for stroke in ink.strokes} <= set(ink.sheets)
        assert np.isfinite(ink.vertices["place"]).all()


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


def test_every_setting_begins_as_shipped_and_has_something_said_of_it(locomotion):
    rows = [Row.of(setting, owners(opening(locomotion), 0)) for setting in SETTINGS]
    for row in rows:
        assert row is not None and not row.differs and row.about, row
        assert row.setting.low <= row.default <= row.setting.high
    assert Row.of(SETTINGS[0], owners(opening(Glide()), 0)) is None, "a controller without settings has no sliders"


def test_panels_show_any_controller(game):
    glide = Play(Glide())
    tap(glide, "F2")
    assert frames(glide, 40).ink is not None
    glide.close()


def test_signals_are_what_was_played(locomotion):
    timeline = walked(locomotion, 1.5, Wish(move=(0.0, 1.0)), Wish(move=(1.0, 0.0)))
    moments = [*timeline.past, timeline.now]
    signals = Trace().read(moments)
    states = [m.after.characters[0].state for m in moments]
    assert np.array_equal(signals.achieved, [s.velocity for s in states])
    assert np.array_equal(signals.contacts, [s.contacts for s in states])
    assert np.array_equal(signals.asked, [m.after.characters[0].intent.velocity for m in moments])
    np.testing.assert_allclose(signals.seconds, (np.arange(len(moments)) - len(moments) + 1) / 60)
    assert np.abs(signals.blended[-1] - signals.achieved[-30:].mean(0)).max() < 0.4


def test_panels_look_through_a_supervisor(locomotion):
    alone, led = (walked(one, 1.0, Wish(move=(0.3, 1.0))) for one in (locomotion, person(locomotion)))
    seen, told = (Trace().read([*timeline.past, timeline.now]) for timeline in (alone, led))
    assert np.isfinite(told.blended).all() and np.array_equal(seen.blended, told.blended)
    walker, character = (timeline.now.after.characters[0] for timeline in (alone, led))
    assert acting(walker).controller is locomotion and why(walker) == ""
    assert reason(character) == reason(walker) and why(character)


def test_panels_look_through_another_size(locomotion):
    """A child under the panels: what it is asked lies in its library's space, and all that is told is of its own size."""
    game = Play(Embodied.of(person(locomotion), tailored(Build(height=1.15, child=1.0))))
    tap(game, "F2", "W")
    game.handle(KeyEvent("W", True))
    assert frames(game, 120).ink is not None
    whole = game.now.after.characters[0]
    child, signals = acting(whole), Trace().read(game.past.shown)
    assert child.controller is locomotion and child.intent.velocity[0] > whole.intent.velocity[0]
    assert np.abs(signals.blended[-1] - signals.achieved[-30:].mean(0)).max() < 0.3
    assert np.array_equal(signals.asked[-1], whole.intent.velocity) and np.array_equal(signals.achieved[-1], whole.state.velocity)
    assert signals.asked[-1][0] == pytest.approx(own(whole)[0] * child.intent.velocity[0]) and own(whole)[0] < 0.9
    runs = own(whole)[0] * locomotion.settings.run_above
    assert reason(whole) == f"walks: asked {whole.intent.velocity[0]:.1f} m/s is below {runs:.2f} m/s"
    game.close()


def test_signals_do_not_reach_over_a_reset(locomotion):
    timeline = walked(locomotion, 0.5, Wish(move=(0.0, 1.0)))
    timeline.advance((Wish(pressed=("reset",)),))
    for _ in range(9):
        timeline.advance((Wish(),))
    assert 9 <= len(Trace().read([*timeline.past, timeline.now]).numbers) <= 11
    assert STEPS == 600


def test_the_reason_names_what_was_asked_and_where_the_gaits_part(locomotion):
    def after(seconds, *wishes):
        return reason(walked(locomotion, seconds, *wishes).now.after.characters[0])
    ahead, fast = Wish(move=(0.0, 1.0)), Wish(move=(0.0, 1.0), run=1.0)
    assert after(1, Wish()).startswith("rests")
    assert after(2, ahead) == f"walks: asked 1.3 m/s is below {locomotion.settings.run_above:.2f} m/s"
    assert after(2, fast) == f"runs: asked 3.0 m/s is above {locomotion.settings.run_above:.2f} m/s"
    assert after(0.1, fast).startswith("speeds up")
    assert reason(opening(Glide()).after.characters[0]) == "running"


@settings(max_examples=40, deadline=None)
@given(st.floats(-3.0, 3.0), st.floats(-1.5, 1.5), st.floats(0.5, 4.0))
def test_the_space_fits_its_panel_however_it_is_turned(yaw_, pitch, aspect):
    points = np.random.default_rng(1).normal(size=(30, 3)) * [1.0, 1.5, 0.4]
    size = 300.0 * aspect, 300.0
    orbit = Orbit(yaw_, pitch).towards(points, size, 1 / 60)
    flat = np.abs(orbit.project(points, (0.0, 0.0))[:, :2]).max(0)
    assert np.all(flat <= np.array(size) * 0.54) and np.any(flat >= np.array(size) * 0.5)


def test_the_space_is_seen_as_from_behind_the_character():
    orbit = Orbit(yaw=0.0, pitch=0.3, room=100.0)
    here, ahead, left, turning = orbit.project([[0, 0, 0], [1, 0, 0], [0, 0, 0.3], [0, 1, 0]], (0.0, 0.0))
    assert ahead[2] > here[2] and left[0] < here[0] and turning[1] < here[1] and ahead[1] < here[1]


def test_the_mesh_has_every_edge_once_and_knows_its_hull(locomotion):
    mesh = Mesh.of(locomotion, "walk")
    on_hull = set(mesh.edges[mesh.outer].ravel().tolist())
    from scipy.spatial import ConvexHull

    from gambol.controllers.locomotion.control_space import SCALE
    assert on_hull == set(ConvexHull(mesh.points / SCALE).vertices.tolist())
    # Euler: a closed surface of triangles over V vertices has 3 V - 6 edges
    assert mesh.outer.sum() == 3 * len(on_hull) - 6


def test_a_vertex_that_is_clicked_plays_beside_the_character_until_clicked_again(game):
    tap(game, "F3")
    left, top, width, height = layout(SIZE, 1.0)["space"]
    for x in np.arange(left + 20, left + width - 20, 7):
        point(game, x, top + 0.4 * height)
        if game.showing.hud.space.hovered is not None:
            break
    number = game.showing.hud.space.hovered
    assert number is not None
    button(game, True)
    button(game, False)
    assert game.showing.hud.space.chosen == number
    figures = frames(game).figures
    assert len(figures) == 2 and np.linalg.norm(figures[1].positions[0] - figures[0].positions[0]) > 0.5
    button(game, True)
    button(game, False)
    assert len(frames(game).figures) == 1


@settings(max_examples=10, deadline=None)
@given(st.floats(-math.pi, math.pi), st.floats(-9, 9), st.floats(-9, 9), st.floats(0, 1))
def test_a_ghost_moves_as_its_ground_does(locomotion, heading, x, z, phase):
    here, there = (ghost(locomotion.library, 3, phase, np.array(ground)) for ground in ((0, 0, 0.0), (x, z, heading)))
    turn = yaw(np.array(heading))
    np.testing.assert_allclose(there.positions, here.positions @ turn.T + [x, 0.0, z], atol=1e-6)
    np.testing.assert_allclose(there.orientations, turn @ here.orientations, atol=1e-6)


def test_ticks_are_round_and_few_and_have_zero():
    for low, high in ((0.0, 1.5), (-0.6, 4.2), (-6.0, 30.0), (-1.0, 0.0)):
        marks = ticks(low, high)
        assert 0.0 in marks and len(marks) <= 4 and low <= min(marks) and max(marks) <= high


def test_runs_are_the_stretches_of_a_mask():
    assert runs(np.array([1, 1, 0, 1, 0, 0, 1], bool)) == [(0, 2), (3, 4), (6, 7)]
    assert runs(np.zeros(3, bool)) == [] and runs(np.ones(2, bool)) == [(0, 2)]


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
