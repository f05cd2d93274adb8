"""Setting up: nothing twice, and one line to type where it may not act itself."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import _setup  # noqa: E402


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


def test_a_python_without_venv(calls, monkeypatch):
    monkeypatch.setattr(_setup, "_works", lambda: False)
    monkeypatch.setitem(sys.modules, "ensurepip", None)
    package = f"python3.{sys.version_info.minor}-venv"
    with pytest.raises(SystemExit, match=f"venv module is missing. Type: sudo .* {package}"):
        _setup.ready()
    monkeypatch.setattr(_setup.os, "geteuid", lambda: 0, raising=False)
    _setup.ready()
    assert any(package in call for call in calls) and any("-m venv --clear" in call for call in calls)


def test_an_old_python_is_told_so():
    code = "import sys, platform; sys.version_info = (3, 9, 1); platform.python_version = lambda: '3.9.1'; import _setup; _setup.ready()"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT / "scripts", capture_output=True, text=True)
    assert done.returncode == 1 and done.stderr == "Gambol needs Python 3.11 or newer; this is 3.9.1\n"
