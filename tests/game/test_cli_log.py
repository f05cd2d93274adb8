"""Logs on the command line: filmed as they were seen, refused in one line, and kept whatever happens."""

from pathlib import Path
from types import SimpleNamespace

import av
import numpy as np
import pytest

from gambol.game import hosts
from gambol.game.app.app import Play
from gambol.game.cli.base import Preset
from gambol.game.cli.play import show
from gambol.game.hosts import DisplayError
from gambol.game.hosts.events import KeyEvent
from gambol.game.session.fingerprint import fingerprint
from gambol.game.session.input_log import LogWriter, read
from gambol.game.session.replay import replay
from stand_in import Glide
from test_cli import Stage, gambol


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """What a log holds of two seconds of two who walk, from the second one on."""
    path = tmp_path_factory.mktemp("log") / "a.gambol"
    played = Play(Glide(), 2, log=LogWriter(path, Glide(), 2))
    for frame in range(120):
        if frame == 60:
            played.handle(KeyEvent("W", True))
        played.tick(1 / 60)
    played.close()
    return path.read_bytes()


@pytest.fixture
def log(written, tmp_path, monkeypatch):
    """Such a log."""
    monkeypatch.setattr("gambol.controllers.person.person", lambda *_: Glide())
    monkeypatch.setattr(hosts, "Offscreen", Stage, raising=False)
    path = tmp_path / "a.gambol"
    path.write_bytes(written)
    return path


def feet(scenes):
    return np.array([scene[0].figures[0].positions[0, 2] for scene in scenes])


def test_a_log_is_filmed_side_by_side_as_it_was_seen(log, tmp_path):
    done = gambol("render", "--replay", log, "-o", tmp_path / "a.mp4", "--size", "64x36", "--overlay", "trail")
    assert done.exit_code == 0 and "a.mp4: 120 frames, 2 s, 64 × 36" in done.output
    assert len(list(av.open(str(tmp_path / "a.mp4")).decode(video=0))) == 120
    one, two = Stage.scenes[0]
    assert one.part[2] == two.part[2] == 0.5 and one.overlays.trail and one.text == ()
    walked = feet(Stage.scenes)
    assert np.all(walked[:60] == 0) and walked[-1] > 0.9
    moments = list(replay(read(log), Glide()))
    assert walked[100] == moments[100].after.characters[0].state.pose.root[2]


@pytest.mark.few(1)
@pytest.mark.parametrize("fps", [30, 24, 144])
def test_a_part_of_a_log_at_any_rate_shows_the_same_moments(log, tmp_path, fps):
    gambol("render", "--replay", log, "-o", tmp_path / "all", "--size", "16x16", "--fps", 60)
    whole = feet(Stage.scenes)
    done = gambol("render", "--replay", log, "-o", tmp_path / "part", "--size", "16x16", "--from", 1, "--to", "1.5", "--fps", fps)
    assert done.exit_code == 0 and len(Stage.scenes) == fps // 2
    times = 60 + np.arange(fps // 2) * 60 / fps
    assert np.allclose(feet(Stage.scenes), np.interp(times, np.arange(120), whole), atol=2e-3)


def test_in_the_background_progress_is_told_in_lines_and_others_come_first(log, tmp_path, monkeypatch):
    given = []
    monkeypatch.setattr("os.nice", given.append, raising=False)  # or all tests after this one came last
    done = gambol("render", "--replay", log, "-o", tmp_path / "f", "--size", "16x16", "--to", "0.1", "--background")
    assert done.exit_code == 0 and "1 of 6\n" in done.output and "6 of 6\n" in done.output
    assert len(given) == 1 and given[0] > 0


def test_a_log_that_goes_another_way_is_filmed_with_a_warning(log, tmp_path, monkeypatch):
    monkeypatch.setattr("gambol.controllers.person.person", lambda *_: Glide(halflife=0.3))
    done = gambol("render", "--replay", log, "-o", tmp_path / "f", "--size", "16x16", "--fps", 5)
    assert done.exit_code == 0 and done.output.count("another version of Gambol") == 1


@pytest.mark.parametrize(("arguments", "says"), [
    (("render", "-o", "a.mp4"), "needs either a scenario or --replay LOG"),
    (("render", "demo", "--replay", "a.gambol", "-o", "a.mp4"), "needs either"),
    (("render", "demo", "-o", "a.mp4", "--from", "1"), "--from goes with --replay"),
    (("render", "--replay", "none.gambol", "-o", "a.mp4"), "none.gambol: No such file"),
    (("render", "--replay", "a.gambol", "-o", "a.mp4", "--from", "5"), "has 2.0 s: nothing lies from 5 s"),
    (("render", "--replay", "a.gambol", "-o", "a.bvh"), "a.bvh: a log is filmed"),
    (("play", "--replay", "none.gambol"), "none.gambol: No such file"),
    (("play", "--record", "a.gambol"), "a.gambol: is there already"),
    (("play", "--record", "a.txt"), "needs a name that ends in .gambol"),
])
def test_a_mistake_is_one_line_and_leaves_nothing(log, arguments, says, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    before = log.read_bytes()
    done = gambol(*arguments)
    assert done.exit_code == 2, done.output
    assert len(done.output.strip().splitlines()) == 1 and says in done.output
    assert [p.name for p in tmp_path.iterdir()] == ["a.gambol"] and log.read_bytes() == before


@pytest.mark.few(2)
@pytest.mark.parametrize("end", [None, RuntimeError("the driver is gone"), DisplayError("no display")])
def test_what_was_played_is_kept_however_the_window_ends(log, tmp_path, monkeypatch, end):
    def window(app, size, preset):
        app.tick(0.0)  # the game begins
        app.handle(KeyEvent("W", True))
        for _ in range(100):
            app.tick(1 / 60)
        if end is not None:
            raise end
        window.last = app.game.now
    monkeypatch.setattr(hosts, "run_window", window)
    done = gambol("play", "--record", tmp_path / "new" / "b.gambol", "--players", 2)
    assert "b.gambol: 2 s; `gambol play --replay` shows it" in done.output
    kept = read(tmp_path / "new" / "b.gambol")
    assert kept.players == 2 and len(kept.ticks) == 100
    assert "--character" not in done.output
    if end is None:
        *_, last = replay(kept, Glide())
        assert done.exit_code == 0 and fingerprint(last) == fingerprint(window.last)


def test_a_game_that_never_began_leaves_no_log(log, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(hosts, "run_window", lambda *_: 0)
    assert gambol("play").exit_code == 0
    assert [p.name for p in tmp_path.iterdir()] == ["a.gambol"]


def test_what_shows_a_log_again_names_who_was_played(monkeypatch, capsys):
    monkeypatch.setattr(hosts, "run_window", lambda *_: None)
    game, log = SimpleNamespace(close=lambda: None), SimpleNamespace(begun=True, path=Path("a.gambol"), ticks=60)
    show(game, (640, 360), Preset.full, log, SimpleNamespace(options=("--character", "my kid.glb"), finish=lambda say: None))
    said = "".join(capsys.readouterr())
    assert "`gambol play --replay a.gambol --character 'my kid.glb'` shows it, `gambol render --replay a.gambol --character 'my kid.glb'` films it" in said
