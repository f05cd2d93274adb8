"""What a game leaves behind: logs, screenshots, films; and how a log is watched."""

import numpy as np
import pytest
from PIL import Image

from gambol.game.app.capture import Film, Capture, log_file
from gambol.game.app.app import Play
from gambol.game.files.paths import OutputError
from gambol.game.input import Wish
from gambol.game.session.fingerprint import fingerprint
from gambol.game.session.input_log import LogWriter, read
from gambol.game.session.replay import replay
from hands import FRAME, at, game, press, tap, text, wait, walked  # noqa: F401, the fixture
from stand_in import Glide


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
    game = Play(Glide(), capture=Capture(tmp_path))
    pixels = np.random.default_rng(0).integers(0, 255, (4, 6, 4), np.uint8)
    for _ in range(2):
        tap(game, "F12")
        assert game.wants_picture and game.scene((10, 10)).text == ()
        game.take(pixels)
        assert not game.wants_picture and ".png" in text(game)
    game.kept.capture.finish(print)
    files = list(tmp_path.glob("*.png"))
    assert len(files) == 2 and all(np.array_equal(np.asarray(Image.open(file)), pixels[..., :3]) for file in files)


def test_what_a_film_made_beside_the_game_says_is_heard(tmp_path, monkeypatch):
    """Whatever lies where the game was started, and whatever letters are said."""
    (tmp_path / "gambol.py").write_text("raise RuntimeError('not ours')")
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
    monkeypatch.setattr("gambol.game.app.capture.Film", Film)
    game = Play(Glide(), log=LogWriter(tmp_path / "a.gambol", Glide(), 1), capture=Capture(tmp_path, ("--library", "x.npz")))
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
    game = Play(Glide(), log=LogWriter(tmp_path / "file" / "a.gambol", Glide(), 1), capture=Capture(tmp_path / "file"))
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


def test_a_log_that_ends_as_a_tick_is_added_does_not_end_the_game(tmp_path):
    """Lines are written as one is full, or somebody joins."""
    (tmp_path / "file").touch()
    game = Play(Glide(), log=LogWriter(tmp_path / "file" / "a.gambol", Glide(), 1))
    for wishes in ([Wish()], [Wish(), Wish()]):
        game.kept.add(wishes)
    assert "the log ends here" in text(game) and game.kept.log is None
