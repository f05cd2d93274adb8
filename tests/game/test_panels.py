"""What panels tell: settings, signals and reasons of whoever is played, the control space and its ghosts."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gambol.controllers.body.rotations import yaw
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.person import person
from gambol.game.app.app import Play
from gambol.game.character import Build, tailored
from gambol.game.hosts.events import KeyEvent
from gambol.game.hud import reason
from gambol.game.hud.ghost import ghost
from gambol.game.hud.history import STEPS, Trace
from gambol.game.hud.on_duty import acting, own, why
from gambol.game.hud.panels import layout
from gambol.game.hud.plots import runs, ticks
from gambol.game.hud.sliders import Row
from gambol.game.hud.tetrahedra import Mesh, Orbit
from gambol.game.input import Wish
from gambol.game.session.settings import SETTINGS
from gambol.game.session.state import opening, owners
from gambol.game.session.tick import Timeline
from gambol.game.world.embodied import Embodied
from panel_hands import SIZE, button, frames, point, tap
from stand_in import Glide


@pytest.fixture(scope="module")
def locomotion():
    return Locomotion.load()


@pytest.fixture
def game(locomotion):
    played = Play(person(locomotion))
    yield played
    played.close()


def walked(controller, seconds, *wishes):
    timeline = Timeline(opening(controller))
    for wish in wishes:
        for _ in range(round(60 * seconds)):
            timeline.advance((wish,))
    return timeline


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


