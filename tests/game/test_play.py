"""The game, driven by synthetic events and without a window."""

import math

import numpy as np
import pytest

from gambol.controllers.person import person
from gambol.game.app.app import Play
from gambol.game.hosts.events import Focus, KeyEvent, MouseMove, PadState, Resize, Scroll
from hands import FRAME, at, camera, game, pad, press, release, tap, text, wait, wanted  # noqa: F401, the fixture
from stand_in import Glide


def test_a_key_walks_away_from_the_camera_and_letting_go_stops(game):
    press(game, "W")
    wait(game, 1.0)
    assert at(game)[1] > 0.9 and abs(at(game)[0]) < 0.01
    release(game, "W")
    wait(game, 1.0)
    here = at(game).copy()
    wait(game, 0.5)
    assert np.allclose(at(game), here, atol=1e-3)


def test_an_input_changes_the_pose_within_one_step(game):
    wait(game, 0.1)
    before = game.now.after.characters[0].state.pose.root
    press(game, "W")
    game.tick(FRAME)
    assert wanted(game)[0] > 1.0 and np.any(game.now.after.characters[0].state.pose.root != before)


def test_the_pad_does_what_the_keys_do(game):
    game.handle(pad(left=(0.0, -1.0)))
    wait(game, 1.0)
    assert at(game)[1] > 0.9
    game.handle(pad(left=(0.0, -1.0), triggers=(-1.0, 1.0)))
    wait(game, 1.0)
    assert at(game)[1] > 3.0


def test_a_pad_pulled_out_while_pushed_stops_the_character(game):
    game.handle(pad(left=(0.0, -1.0)))
    wait(game, 0.5)
    game.handle(PadState())
    wait(game, 1.0)
    assert np.allclose(wanted(game), 0)
    game.handle(pad((0.0, 0.0), (0.0, 0.0), (-1.0, -1.0), "START"))
    wait(game, 0.1)
    assert not game.now.paused, "what is down when a pad comes was not pressed"


def test_pause_stops_the_world_and_one_step_is_one_step(game):
    press(game, "W")
    wait(game, 0.2)
    tap(game, "P")
    number = game.now.after.number
    wait(game, 1.0)
    assert game.now.after.number == number and "paused: P goes on" in text(game)
    tap(game, "PERIOD")
    assert game.now.after.number == number + 1
    shown = game.scene((10, 10)).figures[0].positions[0, 2]
    assert shown == pytest.approx(game.now.after.characters[0].state.pose.root[2])
    tap(game, "P", "PERIOD")
    assert game.now.after.number == number + 3, "single steps only while paused"


def test_reset_starts_again(game):
    press(game, "W")
    wait(game, 1.0)
    release(game, "W")
    tap(game, "R")
    assert np.allclose(at(game), 0, atol=0.01) and game.now.after.number == 1


def test_help_holds_everything_and_escape_closes_it_first(game):
    tap(game, "F1")
    number = game.now.number
    tap(game, "R", "P", "K")
    wait(game, 0.5)
    assert game.now.number == number and game.scene((10, 10)).sheet is not None
    tap(game, "ESCAPE")
    assert not game.helping and not game.done and not game.now.paused and game.now.slow == 1
    tap(game, "ESCAPE")
    assert game.done


def test_overlays_and_panels_are_toggled(game):
    for key, name in (("1", "mesh"), ("2", "skeleton"), ("3", "contacts"), ("4", "trail"), ("5", "path"),
                      ("6", "jump"), ("7", "balance"), ("8", "forces")):
        before = getattr(game.showing.overlays, name)
        tap(game, key)
        assert getattr(game.scene((10, 10)).overlays, name) is not before
    tap(game, "F4")
    assert game.showing.panels == {"plots"}
    tap(game, "F2")
    assert not game.showing.panels
    tap(game, "F2")
    assert game.showing.panels == {"space", "plots", "quality", "settings"}


def test_the_mouse_turns_the_camera_only_while_dragging(game):
    game.handle(MouseMove(0.5, 0.5, 0.2, 0.0))
    wait(game, 0.5)
    assert camera(game).yaw == pytest.approx(0.0)
    press(game, "LEFT_BUTTON")
    for _ in range(2):  # two movements in one tick are one of both
        game.handle(MouseMove(0.5, 0.5, 0.1, 0.0))
    wait(game, 0.5)
    assert camera(game).yaw == pytest.approx(-0.8, abs=0.01)
    arm = camera(game).distance
    game.handle(Scroll(0.0, 1.0))
    wait(game, 0.1)
    assert camera(game).distance < arm


def test_the_left_bumper_turns_the_camera_with_the_right_stick_even_in_pause(game):
    tap(game, "P")
    game.handle(pad((0.0, 0.0), (1.0, 0.0), (-1.0, -1.0), "LB"))
    wait(game, 0.5)
    assert camera(game).yaw < -0.5


def test_locked_strafing_keeps_facing(game):
    tap(game, "TAB")
    press(game, "A")
    wait(game, 2.0)
    assert at(game)[0] > 0.8 and abs(at(game)[2]) < 0.05
    tap(game, "TAB")
    wait(game, 2.0)
    assert at(game)[2] > 1.0


def test_a_stick_that_reads_nonsense_does_nothing(game):
    game.handle(PadState("Broken", (math.nan, math.nan, math.inf, 0.0, math.nan, math.nan), frozenset()))
    game.handle(PadState("Beyond", slot=99))
    wait(game, 0.2)
    assert np.allclose(wanted(game), 0)
    assert np.all(np.isfinite(game.scene((10, 10)).camera.eye))


def test_all_time_is_accounted_for(game):
    """Simulated, owed, dropped or held (help, the past): together just what passed."""
    passed = 0.0
    for seconds, key in ((3.0, "W"), (0.013, "F1"), (0.4, "F1"), (0.1, "BACKSPACE"), (0.17, "F12"), (0.3, "K")):
        for _ in range(7):
            game.tick(seconds)
            passed += seconds
        press(game, key)
    game.tick(math.nan)
    game.tick(-1.0)
    clock = game.clock
    assert game.held > 0.5 and clock.dropped > 10
    assert game.now.number * FRAME + clock.owed + clock.dropped + game.held == pytest.approx(passed, abs=1e-9)


def test_events_that_mean_nothing_here_are_ignored(game):
    for event in (Resize(10, 10), Focus(False), KeyEvent("F25", True), KeyEvent("SPACE", True), Scroll(0.0, math.nan)):
        game.handle(event)
    wait(game, 0.1)
    game.do("dance")


@pytest.mark.few(1)
@pytest.mark.parametrize("slower", [0, 1, 2])
def test_the_picture_moves_evenly_at_any_display_rate(game, slower):
    press(game, "W")
    wait(game, 2.0)
    tap(game, *["K"] * slower)
    wait(game, 4.0)
    shown, eyes = [], []
    for _ in range(100):
        game.tick(1 / 144)
        scene = game.scene((10, 10))
        shown.append(scene.figures[0].positions[0, 2])
        eyes.append(scene.camera.eye[2])
    for values in (shown, eyes):
        steps = np.diff(values)
        assert steps.min() > 0.8 * steps.mean() and steps.max() < 1.2 * steps.mean()


def test_settings_are_set_and_mistakes_are_said(game):
    game.do("pace.walk=0.9")
    game.do("pace.hop=1")
    game.do("back=5")
    wait(game, 0.1)
    assert game.now.setting("pace.walk") == 0.9 and game.now.after.number == 6
    assert "there is no setting 'pace.hop'" in text(game) and "no setting 'back'" in text(game)
    wait(game, 5.0)
    assert "no setting" not in text(game)


def test_two_players_share_a_picture(game):
    game = Play(Glide(), players=2)
    game.handle(pad(left=(0.0, -1.0), slot=0))
    press(game, "S")
    wait(game, 1.0)
    assert at(game, 1)[1] > 0.9 > at(game, 0)[1]
    one, two = game.scene((20, 10))
    assert one.part == (0, 0, 0.5, 1) and two.part == (0.5, 0, 0.5, 1)
    assert len(one.figures) == len(two.figures) == 2 and one.figures[0].tint != one.figures[1].tint


def test_a_tap_between_two_ticks_still_jumps():
    game = Play(person())
    tap(game, "SPACE")
    wait(game, 0.5)
    assert game.now.after.characters[0].state.memory.active == "jump"


def test_a_player_who_joins_without_a_pad_is_told_so(game):
    game.do("join")
    wait(game, 0.1)
    assert len(game.now.players) == 2 and "player 2 waits for a gamepad: plug one in" in game.kept.notices


def test_a_second_pad_joins_with_start(game):
    game.handle(pad(slot=0))
    game.handle(pad(slot=1))
    wait(game, 0.1)
    game.handle(pad((0.0, 0.0), (0.0, 0.0), (-1.0, -1.0), "START", slot=1))
    wait(game, 0.1)
    assert game.players == 2 and not game.now.paused
    game.handle(pad(left=(0.0, -1.0), slot=1))
    wait(game, 1.0)
    assert at(game, 1)[1] > 0.9 and abs(at(game, 0)[1]) < 0.01


def test_the_way_to_help_keeps_its_place_whatever_else_is_said(game):
    def place():
        return game.scene((640, 360)).text.index("F1 help")
    before = place()
    game.kept.say("no jump: it is too far")
    game.do("slowmo")
    game.tick(1 / 60)
    assert len(game.scene((640, 360)).text) > 3 and place() == before == 1


def test_the_wheel_and_arrows_leaf_through_the_help_and_move_nothing_else(game):
    tap(game, "F1")
    def page():
        return game.scene((320, 240)).sheet.page
    before = camera(game).distance
    tap(game, "DOWN", "PAGE_DOWN")
    game.handle(Scroll(0.0, -1.0))
    assert page() == 3
    tap(game, "UP")
    game.handle(Scroll(0.0, 0.5))
    assert page() == 1
    tap(game, "F1", "F1")
    assert page() == 0 and camera(game).distance == before and not any(wanted(game))
