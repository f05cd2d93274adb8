"""Setting up: nothing twice, one line to type where it may not act itself; starting where the user is."""

import os
import runpy
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import _setup  # noqa: E402
import play  # noqa: E402


@pytest.fixture
def calls(monkeypatch, tmp_path):
    """A machine where every command works and is only noted down."""
    made = []

    def call(command, **_):
        made.append(" ".join(map(str, command)))
        return 0
    monkeypatch.setattr(_setup.subprocess, "call", call)
    monkeypatch.setattr(_setup, "VENV", tmp_path)
    monkeypatch.setattr(_setup, "STAMP", tmp_path / "stamp")
    monkeypatch.setattr(_setup, "TRIED", tmp_path / "tried")
    monkeypatch.setattr(_setup, "PYTHON", Path(sys.executable))
    monkeypatch.setattr(_setup, "_loads", lambda library: True)
    monkeypatch.setattr(_setup.platform, "system", lambda: "Linux")
    monkeypatch.setattr(_setup.shutil, "which", lambda name: f"/usr/bin/{name}")
    monkeypatch.setattr(_setup.os, "geteuid", lambda: 1000, raising=False)
    return made


def test_it_installs_once_and_again_when_the_declaration_changes(calls, monkeypatch):
    _setup.ready()
    _setup.ready()
    assert len(calls) == 1 and calls[0].endswith("--editable .")
    _setup.ready("test")
    _setup.ready("test")
    _setup.ready()  # what was installed stays
    assert len(calls) == 2 and calls[1].endswith("--editable .[test]")
    monkeypatch.setattr(_setup, "_fingerprint", lambda: "another")
    _setup.ready()
    assert len(calls) == 3 and calls[2].endswith(".[test]")


@pytest.mark.parametrize(("given", "side_by_side"), [((), True), (("--thorough",), True), (("--durations=20", "-x"), True),
                                                     (("tests/body",), False), (("-k", "walls"), False), (("-x", "tests/body"), False)])
def test_all_tests_run_side_by_side_whatever_options_are_given_and_those_that_are_named_do_not(calls, monkeypatch, given, side_by_side):
    _setup.ready("test")
    monkeypatch.setattr(sys, "argv", ["test.py", *given])
    assert runpy.run_path(str(ROOT / "scripts" / "test.py"))["main"]() == 0
    assert calls[-1].endswith(" ".join(given)) and (" -n auto " in f"{calls[-1]} ") == side_by_side


def test_a_failed_installation_is_tried_again(calls, monkeypatch):
    monkeypatch.setattr(_setup.subprocess, "call", lambda *a, **k: 1)
    with pytest.raises(SystemExit, match="network"):
        _setup.ready()
    assert not _setup.STAMP.exists()


def test_missing_libraries_are_installed_by_root_and_named_to_others(calls, monkeypatch, capsys):
    monkeypatch.setattr(_setup, "_loads", lambda library: library != "libEGL.so.1")
    _setup.ready()
    assert "Type: sudo apt-get update && sudo apt-get install -y --no-install-recommends libegl1" in capsys.readouterr().out
    assert not any("apt-get" in call for call in calls)
    monkeypatch.setattr(_setup.os, "geteuid", lambda: 0, raising=False)
    _setup.ready()
    assert calls[-2:] == ["apt-get update -qq", "apt-get -qq install -y --no-install-recommends libegl1 libegl-mesa0"]


def test_what_apt_could_not_do_is_said_at_each_start_and_tried_once_a_day(calls, monkeypatch, capsys):
    def call(command, **_):
        calls.append(" ".join(map(str, command)))
        return 100 if command[0] == "apt-get" else 0
    missing = {"libEGL.so.1"}
    monkeypatch.setattr(_setup.subprocess, "call", call)
    monkeypatch.setattr(_setup, "_loads", lambda library: library not in missing)
    monkeypatch.setattr(_setup.os, "geteuid", lambda: 0, raising=False)
    line = "Type: apt-get update && apt-get install -y --no-install-recommends libegl1 libegl-mesa0"

    def tries():
        before = calls.count("apt-get update -qq")
        _setup.ready()
        assert line in capsys.readouterr().out
        return calls.count("apt-get update -qq") - before
    assert [tries(), tries(), tries()] == [1, 0, 0]
    os.utime(_setup.TRIED, (0, _setup.time.time() - 1.01 * _setup.AGAIN))
    assert [tries(), tries()] == [1, 0]
    missing.add("libXi.so.6")
    assert [tries(), tries()] == [1, 0]


def test_a_python_without_venv(calls, monkeypatch):
    monkeypatch.setattr(_setup, "_works", lambda: False)
    monkeypatch.setitem(sys.modules, "ensurepip", None)
    package = f"python3.{sys.version_info.minor}-venv"
    with pytest.raises(SystemExit, match=f"venv module is missing. Type: sudo .* {package}"):
        _setup.ready()
    monkeypatch.setattr(_setup.os, "geteuid", lambda: 0, raising=False)
    _setup.ready()
    assert any(package in call for call in calls) and any("-m venv --clear" in call for call in calls)


@pytest.fixture
def started(calls, monkeypatch, tmp_path):
    """Start with some options where there is no display: what was run, and in which folder."""
    def start(*options):
        made = []

        def call(command, cwd=None):
            made.append((list(command[1:]), cwd))
            return play.NO_DISPLAY if "play" in command else 0
        monkeypatch.setattr(_setup, "ready", lambda: None)
        monkeypatch.setattr(_setup.subprocess, "call", call)
        monkeypatch.setattr(sys, "argv", ["play.py", *options])
        assert play.main() == 0
        return made
    return start


def test_the_film_instead_follows_the_players_options(started, capsys):
    (first, where), (second, there) = started("--library", "mine.npz", "--size=640x360", "--loud", "--preset", "fast")
    assert first == ["-P", "-m", "gambol.game.cli", "play", "--library", "mine.npz", "--size=640x360", "--loud", "--preset", "fast"]
    assert second == ["-P", "-m", "gambol.game.cli", "render", "demo", "-o", "out/demo.mp4", "--fps", "24", "--size", "960x540",
                      "--library", "mine.npz", "--preset", "fast", "--size", "640x360"]
    assert where is None and there is None, "paths are meant from where the user is"
    assert "filmed into out/demo.mp4 (where --loud means nothing)" in capsys.readouterr().out
    started()
    assert "filmed into out/demo.mp4: four minutes or so\n" in capsys.readouterr().out


def test_both_commands_know_what_is_handed_on():
    from gambol.game import cli
    commands = {command.callback.__name__: command.callback for command in cli.app.registered_commands}
    for name in ("play", "render"):
        known = commands[name].__wrapped__.__annotations__
        assert {option.removeprefix("--") for option in play.SHARED} <= set(known), name


def test_it_starts_from_any_folder_and_takes_nothing_there_for_its_own(tmp_path, monkeypatch, capfd):
    (tmp_path / "gambol.py").write_text("raise RuntimeError('not ours')")
    (tmp_path / "mine.npz").write_text("found, but no library")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(_setup, "ready", lambda: None)
    monkeypatch.setattr(_setup, "PYTHON", Path(sys.executable))
    monkeypatch.setattr(sys, "argv", ["play.py", "--library", "mine.npz"])
    assert play.main() == 2
    said = capfd.readouterr().err
    assert said.startswith("gambol: mine.npz: ") and "no such" not in said and said.count("\n") == 1


def test_an_old_python_is_told_so():
    code = "import sys, platform; sys.version_info = (3, 9, 1); platform.python_version = lambda: '3.9.1'; import _setup; _setup.ready()"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT / "scripts", capture_output=True, text=True)
    assert done.returncode == 1 and done.stderr == "Gambol needs Python 3.11 or newer; this is 3.9.1\n"


def test_python_runs_the_package_itself(tmp_path, monkeypatch):
    """Who has no script on the path, or several Pythons, types `python -m gambol`."""
    import setuptools

    installed = {}
    monkeypatch.setattr(setuptools, "setup", installed.update)
    monkeypatch.chdir(ROOT)
    runpy.run_path("setup.py")
    assert "gambol" in installed["packages"]
    done = subprocess.run([sys.executable, "-m", "gambol", "--version"], cwd=tmp_path, capture_output=True, text=True, timeout=120,
                          env=os.environ | {"PYTHONPATH": os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])})
    assert done.returncode == 0 and done.stdout.startswith("gambol "), done.stderr
