"""The game, driven by synthetic events and without a window."""

import math

import numpy as np
import pytest

from game.hosts.events import Focus, KeyEvent, MouseMove, PadState, Resize, Scroll
from game.play import Play
from game.world import replay
from stand_in import Glide

FRAME = 1 / 60


@pytest.fixture
def game():
    return Play(Glide())


def press(game, *keys):
    for key in keys:
        game.handle(KeyEvent(key, True))


def tap(game, key):
    game.handle(KeyEvent(key, True))
    game.handle(KeyEvent(key, False))


def wait(game, seconds, frame=FRAME):
    for _ in range(round(seconds / frame)):
        game.tick(frame)


def at(game):
    return game.after.characters[0].state.ground


def pad(left=(0.0, 0.0), right=(0.0, 0.0), triggers=(-1.0, -1.0), *buttons):
    return PadState("Pad", (*left, *right, *triggers), frozenset(buttons))


def test_a_key_walks_away_from_the_camera_and_letting_go_stops(game):
    press(game, "W")
    wait(game, 1.0)
    assert at(game)[1] > 0.9 and abs(at(game)[0]) < 0.01
    game.handle(KeyEvent("W", False))
    wait(game, 1.0)
    here = at(game).copy()
    wait(game, 0.5)
    assert np.allclose(at(game), here, atol=1e-3)


def test_an_input_changes_the_next_step(game):
    wait(game, 0.1)
    press(game, "W")
    game.tick(FRAME)
    assert game.log[-1][0].velocity[0] > 1.0


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
    assert np.allclose(game.log[-1][0].velocity, 0)
    game.handle(pad((0.0, 0.0), (0.0, 0.0), (-1.0, -1.0), "START"))
    assert not game.paused, "what is down when a pad comes was not pressed"


def test_pause_stops_time_and_one_step_is_one_step(game):
    press(game, "W")
    wait(game, 0.2)
    tap(game, "P")
    number, log = game.after.number, len(game.log)
    wait(game, 1.0)
    assert game.after.number == number and len(game.log) == log and "Paused" in game.scene((10, 10)).panel
    tap(game, "PERIOD")
    assert game.after.number == number + 1
    shown = game.scene((10, 10)).figures[0].positions[0, 2]
    assert shown == pytest.approx(game.after.characters[0].state.pose.root[2])
    tap(game, "P")
    tap(game, "PERIOD")
    assert game.after.number == number + 1, "single steps only while paused"


def test_reset_starts_again_and_the_log_with_it(game):
    press(game, "W")
    wait(game, 1.0)
    tap(game, "R")
    assert np.array_equal(at(game), [0, 0, 0]) and game.log == [] and game.after.time == 0


def test_help_holds_time_shows_every_binding_and_escape_closes_it_first(game):
    tap(game, "F1")
    number = game.after.number
    wait(game, 0.5)
    assert game.after.number == number
    assert any("gamepad" in line for line in game.scene((10, 10)).panel)
    tap(game, "ESCAPE")
    assert not game.helping and not game.done
    tap(game, "ESCAPE")
    assert game.done


def test_overlays_are_toggled(game):
    for key, name in (("1", "mesh"), ("2", "skeleton"), ("3", "contacts"), ("4", "trail"), ("5", "path")):
        before = getattr(game.overlays, name)
        tap(game, key)
        assert getattr(game.scene((10, 10)).overlays, name) is not before


def test_the_mouse_turns_the_camera_only_while_dragging(game):
    game.handle(MouseMove(0.5, 0.5, 0.2, 0.0))
    wait(game, 0.5)
    assert game.camera.yaw == pytest.approx(0.0)
    press(game, "LEFT_BUTTON")
    game.handle(MouseMove(0.5, 0.5, 0.2, 0.0))
    wait(game, 0.5)
    assert game.camera.yaw == pytest.approx(-0.8, abs=0.01)
    arm = game.camera.distance
    game.handle(Scroll(0.0, 1.0))
    assert game.camera.distance < arm


def test_the_left_bumper_turns_the_camera_with_the_right_stick_even_in_pause(game):
    tap(game, "P")
    game.handle(pad((0.0, 0.0), (1.0, 0.0), (-1.0, -1.0), "LB"))
    wait(game, 0.5)
    assert game.camera.yaw < -0.5


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
    wait(game, 0.2)
    assert np.allclose(game.log[-1][0].velocity, 0)
    assert np.all(np.isfinite(game.scene((10, 10)).camera.eye))


def test_a_frame_that_comes_late_is_capped(game):
    game.tick(3.0)
    assert game.after.number == game.clock.cap
    game.tick(math.nan)
    game.tick(-1.0)
    assert game.after.number == game.clock.cap


def test_events_that_mean_nothing_here_are_ignored(game):
    for event in (Resize(10, 10), Focus(False), KeyEvent("F25", True), KeyEvent("SPACE", True), Scroll(0.0, math.nan)):
        game.handle(event)
    wait(game, 0.1)


def test_the_picture_moves_evenly_at_any_display_rate(game):
    press(game, "W")
    wait(game, 1.0)
    shown = []
    for _ in range(100):
        game.tick(1 / 144)
        shown.append(game.scene((10, 10)).figures[0].positions[0, 2])
    steps = np.diff(shown)
    assert steps.min() > 0.8 * steps.mean() and steps.max() < 1.2 * steps.mean()


def test_the_log_replays_the_game_to_the_bit(game):
    press(game, "W")
    wait(game, 0.7, 1 / 50)
    game.handle(pad((0.4, 0.3), (0.9, 0.0)))
    wait(game, 0.7, 1 / 144)
    again = replay(game.opening, game.log).characters[0].state
    assert np.array_equal(again.ground, at(game))
    assert np.array_equal(again.pose.rotations, game.after.characters[0].state.pose.rotations)
