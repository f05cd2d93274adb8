"""The command line: what it makes, and one clear line for every mistake."""

import signal
import subprocess
import sys
from dataclasses import fields, replace

import av
import numpy as np
import pytest
from typer.testing import CliRunner

from gambol.controllers.body import Clip, human
from gambol.controllers.mocap import write_bvh
from gambol.game import hosts
from gambol.game import cli
from gambol.game.cli import film_jobs
from gambol.game.app.hints import remember
from gambol.game.character import Build
from gambol.game.scenario.scenario import load
from stand_in import Glide

SHORT = """
title = "Short"
duration = 0.5
fps = 20
size = [64, 48]
[[actors]]
moves = [{ for = 0.5, velocity = [1, 0, 0] }]
"""


class Stage:
    """Draws nothing, in the right size; remembers what it was asked for."""

    scenes = []

    def __init__(self, size, preset):
        self.size = size
        Stage.scenes.clear()

    def __enter__(self):
        return self

    def __exit__(self, *error):
        pass

    def resize(self, size):
        self.size = size

    def frame(self, scene):
        Stage.scenes.append(scene)
        return np.zeros((self.size[1], self.size[0], 4), np.uint8)


@pytest.fixture
def short(tmp_path, monkeypatch):
    monkeypatch.setattr("gambol.controllers.person.person", lambda *_: Glide())
    monkeypatch.setattr(hosts, "Offscreen", Stage, raising=False)
    file = tmp_path / "short.toml"
    file.write_text(SHORT)
    return file


def gambol(*arguments):
    return CliRunner().invoke(cli.app, [str(a) for a in arguments])


def test_a_name_that_cannot_be_is_told_of_before_anything_is_learnt(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("gambol.game.cli.films.learn", lambda *_: pytest.fail("it began to learn"))
    assert gambol("render", "reconstruct", "-o", "a.avi").exit_code == 2


def test_progress_is_told_where_no_bar_can_be_seen(short, tmp_path):
    done = gambol("render", short, "-o", tmp_path / "a.mp4", "--fps", 60)
    frames = round(60 * load(short).duration)
    told = [line for line in done.stderr.splitlines() if line.endswith(f" of {frames}")]
    assert told == [f"{frames * part // 10} of {frames}" for part in range(1, 11)]


def test_hints_are_for_who_plays_first_or_asks_for_them(short, tmp_path, monkeypatch):
    games = []
    monkeypatch.setattr("gambol.game.cli.play.show", lambda opening, *_: games.append(opening.make()))
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    monkeypatch.setenv("APPDATA", str(tmp_path))
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.chdir(tmp_path)
    assert gambol("play").exit_code == 0
    games[0].teacher.tick(games[0].now, 1.0)
    remember(games[0].teacher.file, {"walk"})
    for arguments in ((), ("--hints",), ("--no-hints",)):
        assert gambol("play", *arguments).exit_code == 0
    assert games[0].teacher.hints.done == frozenset() and games[1].teacher.hints.done == {"walk"}
    assert games[2].teacher.hints.done == frozenset() and games[3].teacher is None
    assert games[0].teacher.file.is_relative_to(tmp_path)


def test_a_film(short, tmp_path):
    done = gambol("render", short, "-o", tmp_path / "a.mp4")
    assert done.exit_code == 0 and "a.mp4: 10 frames, 0.5 s, 64 × 48" in done.output
    with av.open(str(tmp_path / "a.mp4")) as film:
        frames = list(film.decode(video=0))
        assert len(frames) == 10 and (frames[0].width, frames[0].height) == (64, 48)
        assert film.streams.video[0].average_rate == 20


def test_pictures_in_another_size_rate_and_dress(short, tmp_path):
    done = gambol("render", short, "-o", tmp_path / "frames", "--size", "32x20", "--fps", 10, "--overlay", "trail, contacts")
    assert done.exit_code == 0
    assert len(list((tmp_path / "frames").glob("frame_*.png"))) == 5 == len(Stage.scenes)
    shown = Stage.scenes[0][0].overlays
    assert shown.mesh and shown.trail and shown.contacts and not shown.path


def test_motion(short, tmp_path):
    done = gambol("render", short, "-o", tmp_path / "a.bvh")
    assert done.exit_code == 0 and "10 frames" in done.output
    text = (tmp_path / "a.bvh").read_text()
    assert "Frames: 10" in text and "HIERARCHY" in text
    two = SHORT + '[[actors]]\nname = "B"\nstart = [1, 0, 0]\n'
    short.write_text(two)
    assert gambol("render", short, "-o", tmp_path / "b.bvh").exit_code == 0
    assert (tmp_path / "b-A.bvh").exists() and (tmp_path / "b-B.bvh").exists()


@pytest.mark.few(2)
@pytest.mark.parametrize("command", [("render", "a.mp4"), ("render", "a.bvh"), ("export", "a.glb"), ("strip", "a.png"), ("film", "footage"),
                                     ("gallery", "page")])
def test_what_nobody_could_do_is_told_whatever_is_written(short, tmp_path, command, monkeypatch):
    monkeypatch.setattr(film_jobs, "somebody", lambda *_: Glide())
    short.write_text(SHORT.replace("duration = 0.5", "duration = 4").replace("{ for = 0.5, velocity = [1, 0, 0] }", "{ jump_to = [0, 40] }"))
    done = gambol(command[0], short, "-o", tmp_path / command[1], *(["--width", 32, "--fps", 5] if command[0] == "film" else []))
    said = f"gambol: {short.stem}: A: " if command[0] == "gallery" else "gambol: A: "
    assert done.exit_code == 0 and done.output.count(f"{said}no jump to (0, 0, 40): ") == 1, done.output


@pytest.mark.parametrize(("arguments", "says"), [
    (("render", "nowhere", "-o", "a.mp4"), "no scenario is called 'nowhere'"),
    (("render", "demo", "-o", "a.avi"), "can't record .avi"),
    (("render", "demo", "-o", "a.gif", "--fps", "60"), "a.gif: has 60 frames a second, a .gif at most 50"),
    (("render", "demo", "-o", "a.mp4", "--fps", "fast"), "--fps: needs frames a second from 1 to 240, such as 30, 29.97 or 30000/1001; got fast"),
    (("strip", "a.gambol", "-o", "a.png"), "a.gambol: is no scenario, which is a .toml file; an input log is filmed with --replay"),
    (("render", "A.BVH", "-o", "a.mp4"), "is no scenario, which is a .toml file; motion is a follower's clip in one"),
    (("export", "kid.glb", "-o", "a.glb"), "is no scenario, which is a .toml file; a body is worn with --character"),
    (("export", "demo", "-o", "a.glb", "--onto", "me.fbx"), "me.fbx: no rig is read from it; name a .glb, .gltf, .vrm, .bvh or .amc file"),
    (("export", "demo", "-o", "a.glb", "--up", "z"), "--up goes with --onto, a .bvh or .amc file"),
    (("export", "demo", "-o", "a.glb", "--onto", "me.glb", "--unit", "cm"), "--unit goes with --onto, a .bvh or .amc file"),
    (("character", "-o", "a.glb", "--unit", "cm"), "--unit goes with --skeleton, a .bvh or .amc file"),
    (("library", "build", ".", "--up", "north"), "--up: up is one of x, y, z"),
    (("database", "build", ".", "--unit", "0"), "--unit: a unit is m, dm, cm"),
    (("track", ".", "-o", "a.bvh", "--up", "z"), "--up goes with --start, a .bvh or .amc file"),
    (("gallery", "nope", "-o", "films"), "no scenario is called 'nope'"),
    (("render", "demo", "-o", "a.mp4", "--size", "12"), "--size '12': needs width x height"),
    (("render", "demo", "-o", "a.mp4", "--size", "axb"), "--size 'axb': needs width x height"),
    (("render", "demo", "-o", "a.mp4", "--overlay", "bones"), "there is no such overlay; choose from mesh, skeleton"),
    (("render", "demo", "-o", "a.mp4", "--library", "no.npz"), "no.npz"),
    (("library", "build", "no_such_folder", "-o", "x.npz"), "no_such_folder"),
    (("library", "report", "no.npz"), "no.npz"),
    (("library", "report", "--picture", "x.xyz"), "x.xyz: needs a name that ends in .png"),
    (("library", "build", ".", "-o", "x.toml"), "x.toml: needs a name that ends in .npz"),
    (("render", "demo", "-o", "a.bvh", "--size", "64x48"), "--size means nothing for a.bvh"),
    (("render", "demo", "-o", "a.BVH", "--overlay", "trail"), "--overlay means nothing for a.BVH"),
    (("render", "demo", "-o", "a.bvh", "--preset", "full"), "--preset means nothing for a.bvh"),
])
def test_a_mistake_is_one_line_and_code_2(arguments, says, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("gambol.controllers.person.preparing.begun", lambda *_: pytest.fail("it began to compile"))
    done = gambol(*arguments)
    assert done.exit_code == 2, done.output
    lines = done.output.strip().splitlines()
    assert len(lines) == 1 and lines[0].startswith("gambol: ") and says in lines[0]
    assert not list(tmp_path.iterdir()), "a mistake leaves nothing behind"


@pytest.mark.parametrize("arguments", [("render", "demo"), ("render", "demo", "-o", "a.mp4", "--fps", "0"),
                                       ("render", "demo", "-o", "a.mp4", "--preset", "best"), ("dance",)])
def test_a_wrong_call_has_code_2_too(arguments):
    assert gambol(*arguments).exit_code == 2


@pytest.mark.parametrize("name", ["a.mp4", "a-B.bvh", "a.npz", "a.png"])
def test_no_work_is_done_for_a_path_that_cannot_be_written(short, tmp_path, monkeypatch, name):
    """A folder is in the way of each; whoever would simulate, draw or build fails loudly."""
    def never(*args, **kwargs):
        raise AssertionError("worked in vain")
    for work in ("gambol.game.scenario.run", "gambol.controllers.locomotion.build_library", "gambol.controllers.locomotion.report"):
        monkeypatch.setattr(work, never)
    monkeypatch.setattr(hosts, "Offscreen", never)
    short.write_text(SHORT + '[[actors]]\nname = "B"\nstart = [1, 0, 0]\n')
    (tmp_path / name).mkdir()
    done = gambol(*{"a.mp4": ("render", short, "-o", tmp_path / "a.mp4"),
                    "a-B.bvh": ("render", short, "-o", tmp_path / "a.bvh"),
                    "a.npz": ("library", "build", tmp_path, "-o", tmp_path / "a.npz"),
                    "a.png": ("library", "report", "--picture", tmp_path / "a.png")}[name])
    assert done.exit_code == 2 and done.output == f"gambol: {tmp_path / name}: is a folder; name a file\n"


def test_a_picture_of_a_library_goes_into_a_new_folder(tmp_path, monkeypatch):
    monkeypatch.setattr("gambol.controllers.locomotion.picture", lambda library, path: path.write_bytes(b"drawn"))
    done = gambol("library", "report", "--picture", tmp_path / "new" / "a.png")
    assert done.exit_code == 0 and (tmp_path / "new" / "a.png").exists()


@pytest.mark.parametrize(("error", "code", "says"), [
    (KeyboardInterrupt(), 130, "gambol: stopped"),
    (hosts.GraphicsError("the driver is gone"), 2, "gambol: the driver is gone"),
    (OSError(5, "Input/output error"), 2, "Input/output error"),
    (MemoryError(), 1, ""),
])
def test_an_interrupted_film_is_kept_and_named(short, tmp_path, monkeypatch, error, code, says):
    def frame(self, scene):
        if len(Stage.scenes) == 4:
            raise error
        Stage.scenes.append(scene)
        return np.zeros((48, 64, 4), np.uint8)
    monkeypatch.setattr(Stage, "frame", frame)
    done = gambol("render", short, "-o", tmp_path / "a.mp4")
    assert done.exit_code == code and says in done.output
    assert f"gambol: what was drawn so far is in {tmp_path / 'a.part.mp4'}" in done.output
    with av.open(str(tmp_path / "a.part.mp4")) as film:
        assert len(list(film.decode(video=0))) == 4


@pytest.mark.skipif(sys.platform == "win32", reason="there a program that is ended from outside is not asked")
def test_who_ends_it_from_outside_ends_what_it_began():
    code = """
import atexit, time
from gambol.game import cli
def app():
    atexit.register(print, "tidied up", flush=True)
    print("runs", flush=True)
    time.sleep(60.0)
cli.app = app
cli.main()
"""
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True) as program:
        assert program.stdout.readline() == "runs\n"
        program.terminate()
        assert program.stdout.read() == "tidied up\n"
    assert program.returncode == 128 + signal.SIGTERM


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="other systems have a display unless told otherwise")
def test_playing_without_a_display_says_what_to_do(short, monkeypatch):
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    done = gambol("play")
    assert done.exit_code == cli.play.NO_DISPLAY and "no display" in done.output and "gambol render" in done.output


def test_a_machine_without_opengl_says_so_and_leaves_nothing(short, tmp_path, monkeypatch):
    def none(*_):
        raise hosts.GraphicsError("no OpenGL here. Type: apt install it")
    monkeypatch.setattr(hosts, "Offscreen", none)
    done = gambol("render", short, "-o", tmp_path / "a.mp4")
    assert done.exit_code == 2 and done.output == "gambol: no OpenGL here. Type: apt install it\n"
    assert not list(tmp_path.glob("a.*"))


def test_bugs_keep_their_traceback(short, tmp_path, monkeypatch):
    def broken(self, scene):
        raise ValueError("operands do not fit")
    monkeypatch.setattr(Stage, "frame", broken)
    assert isinstance(gambol("render", short, "-o", tmp_path / "a.mp4").exception, ValueError)


def test_scenarios_are_listed():
    done = gambol("scenarios")
    assert done.exit_code == 0 and "corridor" in done.output and "2 actors" in done.output


@pytest.mark.skipif(sys.platform == "win32", reason="Windows reports a closed pipe in another way")
def test_a_reader_who_has_had_enough_is_no_mistake():
    code = "import os, sys; r, w = os.pipe(); os.close(r); os.dup2(w, 1); sys.argv[1:] = ['--help']; from gambol.game.cli import main; main()"
    done = subprocess.run([sys.executable, "-u", "-c", code], capture_output=True, text=True)
    assert done.stderr == "" and done.returncode == 1


def test_help_comes_without_loading_the_rest():
    code = "import sys, gambol.game.cli; print(*[m for m in ('numpy', 'scipy', 'numba', 'pydantic', 'av') if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == ""
    done = subprocess.run([sys.executable, "-m", "gambol.game.cli", "--help"], capture_output=True, text=True)
    assert done.returncode == 0 and "render" in done.stdout


def test_a_size_is_read_as_it_is_told():
    assert cli.pixels_of("1280x720") == cli.pixels_of("1280 × 720") == cli.pixels_of("1280X720") == (1280, 720)


@pytest.mark.parametrize("name", [field.name for field in fields(Build)])
def test_a_build_is_refused_in_the_words_that_were_typed(name, tmp_path):
    done = CliRunner().invoke(cli.app, ["character", "-o", str(tmp_path / "a.glb"), f"--{name}", "nan"])
    assert done.exit_code == 2 and done.stderr.startswith(f"gambol: {name} nan: needs a number from")


def test_a_mannequin_is_made_around_no_skeleton_whose_thigh_has_no_length(tmp_path):
    body = human()
    offsets = body.offsets.copy()
    offsets[body.index("LeftLeg")] = 0.0
    write_bvh(Clip("x", replace(body, offsets=offsets), 1 / 60, body.offsets[:1].repeat(4, 0), np.tile([0.0, 0.0, 0.0, 1.0], (4, 22, 1))), tmp_path / "legless.bvh")
    done = CliRunner().invoke(cli.app, ["character", "-o", str(tmp_path / "a.glb"), "--skeleton", str(tmp_path / "legless.bvh")])
    assert done.exit_code == 2 and "legless.bvh: LeftUpLeg has no length: LeftLeg is where it is" in done.stderr and len(done.stderr.splitlines()) == 1
