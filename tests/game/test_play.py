"""The game, driven by synthetic events and without a window."""

import math

import numpy as np
import pytest
from PIL import Image

from controllers.person import person
from game.hosts.events import Focus, KeyEvent, MouseMove, PadState, Resize, Scroll
from game.log import LogWriter, fingerprint, read, replay
from game.output import OutputError
from game.play import Play
from game.session import KEPT
from game.studio import Film, Studio, log_file
from stand_in import Glide

FRAME = 1 / 60


@pytest.fixture
def game():
    return Play(Glide())


def press(game, *keys):
    for key in keys:
        game.handle(KeyEvent(key, True))


def release(game, *keys):
    for key in keys:
        game.handle(KeyEvent(key, False))


def tap(game, *keys):
    """Press and let go; a tick apart, as hands do."""
    for key in keys:
        press(game, key)
        release(game, key)
        game.tick(FRAME)


def wait(game, seconds, frame=FRAME):
    for _ in range(round(seconds / frame)):
        game.tick(frame)


def at(game, who=0):
    return game.moment.after.characters[who].state.ground


def wanted(game, who=0):
    return game.moment.after.characters[who].intent.velocity


def camera(game, who=0):
    return game.moment.players[who].camera


def text(game):
    view = game.scene((10, 10))
    return "\n".join((view[0] if isinstance(view, tuple) else view).text)


def pad(left=(0.0, 0.0), right=(0.0, 0.0), triggers=(-1.0, -1.0), *buttons, slot=0):
    return PadState("Pad", (*left, *right, *triggers), frozenset(buttons), slot)


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
        before = getattr(game.overlays, name)
        tap(game, key)
        assert getattr(game.scene((10, 10)).overlays, name) is not before
    tap(game, "F4")
    assert game.panels == {"plots"}
    tap(game, "F2")
    assert not game.panels
    tap(game, "F2")
    assert game.panels == {"space", "plots", "quality", "settings"}


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


def walked(game, seconds=3.0):
    press(game, "W")
    wait(game, seconds)
    release(game, "W")
    return game


def test_rewinding_runs_back_in_real_time_and_stops_where_the_key_is_let_go(game):
    walked(game)
    number, where = game.now.after.number, []
    press(game, "BACKSPACE")
    for _ in range(60):
        game.tick(FRAME)
        where.append(game.scene((10, 10)).figures[0].positions[0, 2])
    release(game, "BACKSPACE")
    assert game.moment.after.number == number - 60
    assert np.all(np.diff(where) <= 0) and np.diff(where).min() > -0.05, "no jump on the way"
    wait(game, 1.0)
    assert game.moment.after.number == number - 60 and game.now.after.number == number
    assert game.history[-1] is game.moment and len(game.history) == number - 60 + 1
    assert "1.0 s ago" in text(game)


def test_scrubbing_goes_step_by_step_and_then_by_itself(game):
    walked(game)
    number = game.now.after.number
    tap(game, "BACKSPACE")  # let go before a tick has seen it
    assert game.look is None
    press(game, "BACKSPACE")
    wait(game, 0.5)
    release(game, "BACKSPACE")
    tap(game, "PERIOD")
    assert game.moment.after.number == number + 1 - 29
    for key, step in (("LEFT", -1), ("RIGHT", 1), ("RIGHT", 1)):
        before = game.moment.after.number
        press(game, key)
        game.tick(FRAME)
        release(game, key)
        game.tick(FRAME)
        assert game.moment.after.number == before + step
    before = game.moment.after.number
    press(game, "LEFT")
    wait(game, 1.0)
    assert before - 50 < game.moment.after.number < before - 30
    wait(game, 10.0)
    assert game.moment.after.number == 0 and "3.0 s ago, of 3 s" in text(game)


def test_playing_on_from_the_past_branches_there(game):
    walked(game)
    press(game, "BACKSPACE")
    wait(game, 1.0)
    release(game, "BACKSPACE")
    then, number = at(game).copy(), game.moment.after.number
    tap(game, "ENTER")
    assert game.look is None and game.now.after.number == number + 1 and np.linalg.norm(at(game) - then) < 0.05
    press(game, "BACKSPACE")
    wait(game, 0.5)
    release(game, "BACKSPACE")
    wait(game, 0.1)
    number = game.moment.after.number
    tap(game, "P")
    assert game.now.paused and game.now.after.number in (number, number + 1)


def test_a_push_plays_on_but_only_one_made_since(game):
    walked(game)
    press(game, "BACKSPACE", "W")
    wait(game, 1.0)
    release(game, "BACKSPACE")
    wait(game, 0.5)
    assert game.look is not None, "W was down all along"
    release(game, "W")
    wait(game, 0.1)
    number = game.moment.after.number
    press(game, "D")
    wait(game, 0.1)
    assert game.look is None and number < game.now.after.number <= number + 6


def test_a_past_moment_is_looked_at_from_anywhere_and_nothing_of_it_is_kept(game):
    walked(game)
    press(game, "BACKSPACE")
    wait(game, 0.5)
    release(game, "BACKSPACE")
    press(game, "LEFT_BUTTON")
    before = game.scene((10, 10)).camera.eye
    game.handle(MouseMove(0.5, 0.5, 0.2, 0.0))
    wait(game, 0.5)
    assert np.linalg.norm(game.scene((10, 10)).camera.eye - before) > 1.0
    assert camera(game).yaw == pytest.approx(0.0, abs=0.01)
    game.do("pace.walk=0.9")
    assert "this is the past" in text(game)


def test_half_a_minute_is_kept(game):
    wait(game, KEPT * FRAME + 5)
    press(game, "BACKSPACE")
    wait(game, KEPT * FRAME + 2)
    assert game.moment.number == game.now.number - KEPT


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


def test_a_game_is_watched_from_its_log_until_somebody_walks(tmp_path):
    path = tmp_path / "a.gambol"
    walked(first := Play(Glide(), log=LogWriter(path, Glide(), 1)))
    first.close()
    second = Play(Glide(), log=LogWriter(tmp_path / "b.gambol", Glide(), 1), tape=read(path))
    wait(second, 1.0)
    assert "watching 1 of 3 s" in text(second)
    tap(second, "P")
    number = second.now.number
    wait(second, 0.5)
    assert second.now.number == number
    tap(second, "P")
    wait(second, 3.0 - second.now.number * FRAME)
    assert fingerprint(second.now) == fingerprint(first.now)
    press(second, "D")
    wait(second, 1.0)
    assert "you play on from here" in text(second) and at(second)[0] < -0.3
    second.close()
    *_, last = replay(read(tmp_path / "b.gambol"), Glide())
    assert fingerprint(last) == fingerprint(second.now), "what was watched is in the new log, too"


def test_a_screenshot_is_clean_has_a_name_of_its_own_and_is_said(tmp_path):
    game = Play(Glide(), studio=Studio(tmp_path))
    pixels = np.random.default_rng(0).integers(0, 255, (4, 6, 4), np.uint8)
    for _ in range(2):
        tap(game, "F12")
        assert game.wants_picture and game.scene((10, 10)).text == ()
        game.take(pixels)
        assert not game.wants_picture and ".png" in text(game)
    game.kept.studio.finish(print)
    files = list(tmp_path.glob("*.png"))
    assert len(files) == 2 and all(np.array_equal(np.asarray(Image.open(file)), pixels[..., :3]) for file in files)


def test_what_a_film_made_beside_the_game_says_is_heard(tmp_path, monkeypatch):
    """Whatever lies where the game was started, and whatever letters are said."""
    (tmp_path / "game.py").write_text("raise RuntimeError('not ours')")
    monkeypatch.chdir(tmp_path)
    film = Film(tmp_path / "a.mp4", ["“☃”"])
    film.wait()
    assert film.status().startswith("no scenario is called '“☃”': name a .toml file or one of ") and not film.running


def test_a_film_is_made_of_what_was_played_meanwhile(tmp_path, monkeypatch):
    asked = []

    class Film:
        running = True

        def __init__(self, path, arguments):
            self.path, self.arguments = path, arguments
            asked.append(self)

        def status(self):
            return f"{self.path.name}: 5 %"
    monkeypatch.setattr("game.studio.Film", Film)
    game = Play(Glide(), log=LogWriter(tmp_path / "a.gambol", Glide(), 1), studio=Studio(tmp_path, ("--library", "x.npz")))
    wait(game, 1.0)
    tap(game, "F10")
    wait(game, 1.0)
    assert "filming 1 s" in text(game)
    tap(game, "F10")
    words = " ".join(asked[0].arguments)
    assert f"--replay {tmp_path / 'a.gambol'}" in words and "--from 1.0" in words and "--to 2.0" in words
    assert "--library x.npz" in words and "--overlay mesh,path" in words and asked[0].path == tmp_path / "film-1.mp4"
    assert len(read(tmp_path / "a.gambol").ticks) >= 120, "the log is on the disk before the film begins"
    assert "film-1.mp4: 5 %" in text(game)
    tap(game, "F10", "F10")
    assert len(asked) == 1, "one at a time"
    asked[0].running = False
    game.tick(FRAME)
    assert len(asked) == 2 and asked[1].path == tmp_path / "film-2.mp4"


def test_a_log_that_cannot_be_written_does_not_end_the_game(tmp_path):
    (tmp_path / "file").touch()
    game = Play(Glide(), log=LogWriter(tmp_path / "file" / "a.gambol", Glide(), 1), studio=Studio(tmp_path / "file"))
    wait(game, 1.0)
    assert "the log ends here" in text(game) and game.kept.log is None
    tap(game, "F10")
    game.take(np.zeros((2, 2, 4), np.uint8))
    assert "no film" in text(game) and "is a file" in text(game)
    game.close()


def test_a_log_has_a_name_of_its_own_or_a_new_one(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert log_file(None).parent.name == "out" and not (tmp_path / "out").exists()
    assert log_file(tmp_path / "a.gambol") == tmp_path / "a.gambol"
    (tmp_path / "a.gambol").touch()
    for name, says in (("a.gambol", "is there already"), ("a.txt", "ends in .gambol")):
        with pytest.raises(OutputError, match=says):
            log_file(tmp_path / name)
