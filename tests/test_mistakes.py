"""What makes no sense gets one clear line, wherever it comes in: numbers that are none, sizes in strange digits, deep brackets, pipes."""

import json
import os
from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

from gambol.controllers.contract import Intent, Leap
from gambol.controllers.jump import Jump
from gambol.controllers.locomotion import Library, LibraryError, Locomotion
from gambol.controllers.locomotion.library_build import read_recipe
from gambol.controllers.mocap import MotionFileError, load
from gambol.controllers.reconstruction.database.database import Database, DatabaseError, Writer
from gambol.controllers.reconstruction.live import StreamError, read_map
from gambol.controllers.reconstruction.pose_vector import WIDTH
from gambol.controllers.scaled import Scaled
from gambol.controllers.tracking.cameras import CalibrationError, read_cameras
from gambol.game.character import load as wear
from gambol.game.character.gltf import CharacterError
from gambol.game.cli import app
from gambol.game.cli.base import pixels_of
from gambol.game.input import remap
from gambol.game.scenario.scenario import ScenarioError, load as play


@pytest.fixture(scope="module")
def walker():
    return Locomotion.load()


@pytest.mark.parametrize("floor", [np.nan, np.inf, -np.inf, 1e6, -1e300, np.float32(np.nan)])
def test_a_floor_is_a_height(walker, floor):
    for someone in (walker, Scaled(walker, 0.7)):
        with pytest.raises(ValueError, match="a floor must be a finite height"):
            someone.start(floor=floor)
        with pytest.raises(ValueError, match="a floor must be a finite height"):
            someone.step(replace(someone.start(), floor=floor), Intent(), 1 / 60)
    jump, standing = Jump(), replace(walker.start(), floor=floor)
    with pytest.raises(ValueError, match="a floor must be a finite height"):
        jump.enter(standing, Intent(leap=Leap(np.array([0.0, 0.0, 0.5]))))


def test_a_crowd_has_floors_of_its_own(walker):
    assert walker.start(np.zeros((2, 3)), np.array([0.0, 3.0])).pose.root[1, 1] > 3.5
    with pytest.raises(ValueError, match="a floor"):
        walker.start(np.zeros((2, 3)), np.array([0.0, np.nan]))


@pytest.mark.parametrize("pull", [-1e9, 1e9, 0.0, 9.81, np.nan, -np.inf, -0.05, -101])
def test_gravity_is_a_worlds(pull):
    with pytest.raises(ValueError, match="gravity must pull straight down by 0.1 … 100 m/s², got"):
        Jump(gravity=(0.0, pull, 0.0))


@pytest.mark.parametrize("pull", [-0.1, -100.0])
def test_gravity_at_its_bounds_is_one(pull):
    assert Jump(gravity=(0.0, pull, 0.0)).gravity[1] == pull


@pytest.mark.parametrize("size", ["²x³", "٣٢٠x٢٤٠", "1280x７２０", "1_280x720", "+640x480", "640 480", "1e3x1e3", "x", "", "9999x16", "15x16",
                                  "9" * 5000 + "x16"])
def test_a_size_is_two_plain_numbers(size):
    with pytest.raises(ValueError, match="needs width x height in pixels, from 16 to 8192"):
        pixels_of(size)
    assert pixels_of("640X0480") == (640, 480)


def command(*arguments):
    done = CliRunner().invoke(app, [str(argument) for argument in arguments])
    assert done.exit_code == 2, done.output
    return done.output


@pytest.mark.parametrize(("arguments", "option"), [
    (("render", "--replay", "none.gambol", "-o", "a.mp4", "--from", "nan"), "--from nan"),
    (("render", "--replay", "none.gambol", "-o", "a.mp4", "--to", "inf"), "--to inf"),
    (("strip", "demo", "-o", "a.png", "--to", "nan"), "--to nan"),
    (("database", "build", "none", "--fps", "nan"), "--fps nan"),
    (("reconstruct", "--stream", "osc", "-o", "a.bvh", "--seconds", "nan"), "--seconds nan"),
    (("reconstruct", "a.bvh", "-o", "a.bvh", "--noise", "nan"), "--noise nan")])
def test_an_option_is_a_finite_number(arguments, option, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    said = command(*arguments)  # some versions of typer know that nan is within no bounds
    assert said.strip() == f"gambol: {option}: needs a finite number" or f"Invalid value for '{option.split()[0]}'" in said
    assert not list(tmp_path.iterdir())


READERS = {"a.bvh": (load, MotionFileError), "a.amc": (lambda path: load(path, asf=path), MotionFileError), "a.npz": (Library.load, LibraryError),
           "a.gambolmotion": (Database.open, DatabaseError), "a.glb": (wear, CharacterError), "a.vrm": (wear, CharacterError),
           "b.toml": (remap.load, remap.BindingsError), "s.toml": (play, ScenarioError), "m.toml": (read_map, StreamError),
           "r.toml": (read_recipe, LibraryError), "c.toml": (read_cameras, CalibrationError), "c.qca.txt": (read_cameras, CalibrationError)}


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="only where there are pipes with names")
@pytest.mark.parametrize("name", READERS)
def test_no_reader_waits_for_a_pipe_or_reads_a_device_or_folder(tmp_path, name):
    read, error = READERS[name]
    pipe, device, folder = (tmp_path / kind / name for kind in ("pipe", "device", "folder"))
    for path in (pipe, device, folder):
        path.parent.mkdir()
    os.mkfifo(pipe)
    device.symlink_to("/dev/zero")
    folder.mkdir()
    for path, what in ((pipe, "is a pipe"), (device, "is a device"), (folder, "directory")):
        with pytest.raises(error, match=what) as told:
            read(path)
        assert str(told.value).startswith(str(path)) and "\n" not in str(told.value)


@pytest.mark.few(8)
@pytest.mark.parametrize("name", [name for name in READERS if name.endswith(".toml")])
@pytest.mark.parametrize("text", ["a = " + "[" * 20_000, "a = " + "{a=" * 20_000, "[" + "a." * 20_000])
def test_brackets_nested_deeply_are_told_of(tmp_path, name, text):
    (tmp_path / name).write_text(text)
    read, error = READERS[name]
    with pytest.raises(error, match=name) as told:
        read(tmp_path / name)
    assert len(str(told.value)) < 1000


@pytest.mark.parametrize("change", [lambda about: [], lambda about: "x", lambda about: about | {"takes": 3}, lambda about: about | {"fps": None},
                                    lambda about: about | {"fps": float("nan")}, lambda about: about | {"fps": 1e300},
                                    lambda about: about | {"takes": [{"clip": "x"}]},
                                    lambda about: about | {"takes": [about["takes"][0] | {"stop": 10**9}]}])
def test_a_databases_table_is_checked(tmp_path, change):
    path = tmp_path / "a.gambolmotion"
    with Writer(path) as writer:
        writer.add("clip", "somebody", "walk", np.zeros((4, WIDTH)), np.ones(4, bool))
    data = path.read_bytes()
    length = int.from_bytes(data[-8:], "little")
    table = json.dumps(change(json.loads(data[-8 - length:-8]))).encode()
    path.write_bytes(data[:-8 - length] + table + len(table).to_bytes(8, "little"))
    with pytest.raises(DatabaseError, match="a.gambolmotion: .*build it anew"):
        Database.open(path)


def test_a_database_nested_deeply_is_told_of(tmp_path):
    path = tmp_path / "a.gambolmotion"
    with Writer(path):
        pass
    table = b"[" * 100_000
    path.write_bytes(path.read_bytes()[:-8] + table + len(table).to_bytes(8, "little"))
    with pytest.raises(DatabaseError, match="is damaged; build it anew"):
        Database.open(path)


def test_a_file_with_brackets_for_a_name_is_no_markup(tmp_path):
    """A progress bar shows names of files, and would take [/x] for the end of a colour."""
    from gambol.game.cli.base import progress_bar

    with progress_bar() as bar:
        assert list(bar.track([1, 2], 2, description="[/x].bvh [red]")) == [1, 2]
