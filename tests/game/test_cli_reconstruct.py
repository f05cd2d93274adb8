"""`gambol reconstruct`: a body out of points, from a file or a stream, and one clear line for every mistake."""

import os
import re
import signal
import socket
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

sys.path.insert(0, str(Path(__file__).parents[1] / "reconstruction"))
import walks  # noqa: E402
from scipy.spatial.transform import Rotation  # noqa: E402

from gambol.controllers.mocap import load, write_bvh  # noqa: E402
from gambol.controllers.reconstruction.pose_vector import SKELETON  # noqa: E402
from gambol.controllers.reconstruction.control_points import parse  # noqa: E402
from gambol.controllers.reconstruction.live.placing import stances  # noqa: E402
from gambol.game import cli  # noqa: E402
from gambol.game.cli import live, live_clock  # noqa: E402
from test_stream import bundle, message, tracker  # noqa: E402

WORN = "lwrist", "rwrist", "lankle", "rankle"


def gambol(*arguments):
    return CliRunner().invoke(cli.app, [str(a) for a in arguments])


@pytest.fixture(scope="module")
def motion(tmp_path_factory):
    """A database of Gambol's own walk, and a clip of it as BVH."""
    folder = tmp_path_factory.mktemp("motion")
    known, clips = walks.database(folder / "walks.gambolmotion")
    write_bvh(clips[1], folder / "clip.bvh")
    return known.path, folder / "clip.bvh", clips[1]


@pytest.fixture(scope="module")
def brief(motion, tmp_path_factory):
    """A second of that clip."""
    file = tmp_path_factory.mktemp("brief") / "clip.bvh"
    write_bvh(motion[2].slice(0, 60), file)
    return file


@pytest.fixture(scope="module")
def misread(motion, tmp_path_factory):
    """Files that are no performance: no motion, of somebody who lacks a leg, and too short."""
    folder, (_, _, clip) = tmp_path_factory.mktemp("misread"), motion
    offsets = clip.skeleton.offsets.copy()
    offsets[clip.skeleton.index("LeftLeg")] = 0.0
    files = {name: folder / f"{name}.bvh" for name in ("words", "legless", "instant")}
    files["words"].write_text("HIERARCHY of words")
    short = clip.slice(0, 60)
    write_bvh(replace(short, skeleton=replace(clip.skeleton, offsets=offsets)), files["legless"])
    write_bvh(replace(short, frame_time=1e-7), files["instant"])
    return files


@pytest.mark.few(1)
@pytest.mark.parametrize("suffix", [".bvh", ".glb"])
def test_a_clip_from_its_points(motion, brief, tmp_path, suffix):
    database, file, clip = motion[0], brief, motion[2].slice(0, 60)
    out = tmp_path / f"out{suffix}"
    done = gambol("reconstruct", file, "--points", "lwrist,rwrist,lankle,rankle", "--method", "nearest", "--database", database, "-o", out)
    assert done.exit_code == 0, done.output
    away = float(re.search(r"joints in the world\s+([\d.]+) cm", done.output)[1])
    assert away < 3.0 and "joint angles" in done.output and "jitter" in done.output and re.search(r"a frame\s+[\d.]+ ms", done.output)
    if suffix == ".bvh":
        back = load(out)
        assert len(back) == len(clip)
        apart = np.linalg.norm(back.kinematics()[0] - clip.kinematics()[0], axis=-1).mean()
        assert abs(100 * apart - away) < 1.5  # what is told is what is in the file


def test_a_clip_that_is_misread_is_read_as_told(motion, tmp_path):
    """A small child in centimetres has legs as long as an adult's in inches; who is read as few are is told of."""
    database, _, clip = motion
    clip = clip.slice(0, 60)
    write_bvh(replace(clip, skeleton=clip.skeleton.scaled(0.45), root=0.45 * clip.root), tmp_path / "child.bvh")
    said = {}
    for told in ((), ("--unit", "cm"), ("--unit", "cm", "--up", "Y")):
        done = gambol("reconstruct", tmp_path / "child.bvh", "--method", "nearest", "--database", database, "-o", tmp_path / "o.bvh", *told)
        assert done.exit_code == 0, done.output
        said[told] = done.stderr
    assert "child.bvh: read as with Y up and in inches, as of somebody 1.99 m tall; --up and --unit say otherwise" in said[()]
    assert not any("read as with" in said[told] for told in said if told)


def test_noise_is_the_same_for_the_same_seed(motion, brief, tmp_path):
    database, said = motion[0], {}
    for seed in (1, 1, 2):
        done = gambol("reconstruct", brief, "--noise", 2, "--seed", seed, "--method", "nearest", "--database", database, "-o", tmp_path / "o.bvh")
        said.setdefault(seed, set()).add((tmp_path / "o.bvh").read_text())
        assert done.exit_code == 0
    assert len(said[1]) == 1 and said[1] != said[2]


@pytest.mark.parametrize(("arguments", "why"), [
    ([], "needs either a motion file or --stream"),
    (["{clip}", "--stream", "osc", "-o", "o.bvh"], "needs either"),
    (["--stream", "midi", "-o", "o.bvh"], "only osc"),
    (["{clip}", "--points", "elbw", "-o", "o.bvh"], "no control point 'elbw'"),
    (["{clip}", "--points", "", "-o", "o.bvh"], "no control points"),
    (["{clip}", "--points", "lwrist,lwrist", "-o", "o.bvh"], "given twice"),
    (["{clip}", "--method", "magic", "--database", "{database}", "-o", "o.bvh"], "no such method; choose from trackers, ours"),
    (["{clip}", "-o", "o.fbx"], ".bvh or .glb"),
    (["{clip}", "-o", "{clip}"], "would be overwritten; give -o another name"),
    (["--stream", "osc", "-o", "{clip}"], "is there already, and nobody does again what a stream was recorded of; name another file"),
    (["none.bvh", "-o", "o.bvh"], "none.bvh"),
    (["{words}", "-o", "o.bvh"], "words.bvh"),
    (["{legless}", "-o", "o.bvh"], "legless.bvh: LeftUpLeg has no length: LeftLeg is where it is"),
    (["{instant}", "-o", "o.bvh"], "instant.bvh: 60 frames in 5.9e-06 s are too few; a performance needs 4 in 0.05 s at least"),
    (["{clip}", "--database", "{clip}", "-o", "o.bvh"], "is no motion database"),
    (["{clip}", "--database", "none.gambolmotion", "-o", "o.bvh"], "none.gambolmotion: can't be read"),
    (["{clip}", "--port", "9000", "-o", "o.bvh"], "--port goes with --stream"),
    (["{clip}", "--host", "0.0.0.0", "-o", "o.bvh"], "--host goes with --stream"),
    (["--stream", "osc", "--host", "", "-o", "o.bvh", "--database", "{database}", "--method", "nearest"], "host '' is no address of this machine"),
    (["--stream", "osc", "--noise", "1", "-o", "o.bvh"], "--noise goes with a motion file"),
    (["--stream", "osc", "--turns", "-o", "o.bvh"], "--turns goes with a motion file"), (["{clip}", "--turns"], "--turns goes with -o"),
    (["{clip}", "--turns", "--method", "nearest", "--database", "{database}", "-o", "o.bvh"], "--turns goes with a method that hears them"),
    (["{clip}", "--up", "north", "-o", "o.bvh"], "--up: up is one of x, y, z"),
    (["{clip}", "--unit", "parsec", "-o", "o.bvh"], "--unit: a unit is m, dm, cm, mm, ft, in or a number of metres above zero, not 'parsec'"),
    (["--stream", "osc", "--up", "y", "-o", "o.bvh"], "--up goes with CLIP, a .bvh or .amc file"),
    (["--stream", "osc", "--map", "none.toml", "-o", "o.bvh"], "none.toml: can't be read"),
    (["--stream", "osc", "--map", "m.toml", "--points", "4", "-o", "o.bvh"], "give one of them"),
    (["--stream", "osc", "--points", "nose", "-o", "o.bvh"], "no control point 'nose'")])
def test_mistakes_get_one_line(motion, misread, tmp_path, monkeypatch, arguments, why):
    monkeypatch.chdir(tmp_path)
    known = {"clip": motion[1], "database": motion[0], **misread}
    done = gambol("reconstruct", *(a.format(**known) for a in arguments))
    assert done.exit_code == 2
    assert why in done.output and len(done.output.strip().splitlines()) == 1


def test_a_port_in_use_is_a_mistake(motion, tmp_path):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("0.0.0.0", 0))
        done = gambol("reconstruct", "--stream", "osc", "--port", other.getsockname()[1], "--database", motion[0], "-o", tmp_path / "o.bvh")
    assert done.exit_code == 2 and "can't be listened at" in done.output


class Performer:
    """Somebody 1.4 m tall who wears the trackers, and the clock of the program that hears them: when it waits, he moves on.

    He stands in T-pose until `heard` says that it is recorded, and walks from 0.3 s after that on. `then(seconds)` is asked
    what happens next, and whether he is seen, so long after the recording began.
    """

    def __init__(self, clip, port, heard, then=lambda seconds: True):
        controls = parse("4", SKELETON)
        self.standing, self.walk, self.to = controls.on(*stances())[1], controls.extract(clip), ("127.0.0.1", port)
        self.heard, self.then, self.began, self.now = heard, then, None, 1000.0
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)

    def monotonic(self):
        return self.now

    def sleep(self, seconds):
        self.now += seconds
        if self.began is None and self.heard():
            self.began = self.now
        since = -1.0 if self.began is None else self.now - self.began
        if self.then(since):
            self.send(since)

    def send(self, since):
        points = self.standing if since < 0.3 else self.walk[min(int((since - 0.3) * 60), len(self.walk) - 1)]
        there = 0.8 * points * [-1.0, 1.0, 1.0] + [0.3, 0.1, -0.2]
        self.socket.sendto(bundle(*(tracker(name, place) for name, place in zip(WORN, there))), self.to)
        self.socket.sendto(b"not OSC", self.to)


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


@pytest.fixture
def stream(motion, tmp_path, monkeypatch):
    """stream(then, …, held_up=…) → what `gambol reconstruct --stream osc` said of a performer, and the motion it wrote.

    held_up: how long [s] the machine stood still as the recording began.
    """
    def streamed(then=lambda seconds: True, *more, held_up=0.0):
        def say(line):
            told.append(line)
            performer.now += held_up if "recording" in line else 0.0
        told, port = [], free_port()
        performer = Performer(motion[2], port, lambda: any("recording" in line for line in told), then)
        monkeypatch.setattr(live_clock, "time", performer)
        monkeypatch.setattr(live, "clock", lambda: None)  # packets count as of when they are asked for
        monkeypatch.setattr(live, "say", say)
        with performer.socket:
            done = gambol("reconstruct", "--stream", "osc", "--port", port, "--points", ",".join(WORN), "--method", "nearest",
                          "--database", motion[0], "-o", tmp_path / "o.bvh", *more)
        assert done.exit_code == 0, done.output
        return told, load(tmp_path / "o.bvh")
    return streamed


def walked(made):
    """Whether a body as tall as the performer was recorded that stands on the floor."""
    heights = made.kinematics()[0][..., 1]
    return 0.8 * 1.3 < heights.max(1).mean() < 0.8 * 1.8 and heights.min() > -0.1 and np.allclose(made.skeleton.offsets[1:], 0.8 * SKELETON.offsets[1:], atol=0.01)


ENDS = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if os.name != "nt" and hasattr(signal, name)]


@pytest.mark.few(2)
@pytest.mark.parametrize("end", [None, *ENDS])
def test_streams_are_recorded_until_they_are_ended_and_never_lost(stream, end, request):
    """By Ctrl-C, by whoever ends the program from outside, and when the time is up."""
    deaf = signal.signal(signal.SIGINT, signal.default_int_handler)  # where tests run as a shell's background job
    request.addfinalizer(lambda: signal.signal(signal.SIGINT, deaf))

    def then(seconds):
        if end and seconds > 1.99:
            signal.raise_signal(end)
        return True
    told, made = stream(then, *([] if end else ["--seconds", 2]))
    assert "packets were broken" in told[-1] and walked(made)
    assert 120 <= len(made) <= 121


def test_a_stream_that_falls_silent_as_the_recording_begins_is_waited_for(stream):
    told, made = stream(lambda seconds: not 0.0 <= seconds < 0.5, "--seconds", 2, held_up=0.2)
    assert 85 < len(made) < 95 and walked(made)


PROGRAM = """
import sys
from gambol.game.cli import live, live_clock, main
live.clock = lambda: None
ticks = live_clock.ticks
def told(seconds, *more):
    for number, now in enumerate(ticks(seconds, *more)):
        print("tick", number, file=sys.stderr, flush=True)
        yield now
live_clock.ticks = told
main()
"""


@pytest.mark.thorough
@pytest.mark.skipif(os.name == "nt", reason="no signals of this kind there")
def test_a_program_that_hears_a_stream_keeps_it_when_it_is_ended_from_outside(motion, tmp_path):
    """By its own clock, however slow; whoever performs waits for nothing but what it says."""
    port, out = free_port(), tmp_path / "o.bvh"
    program = subprocess.Popen(
        [sys.executable, "-c", PROGRAM, "reconstruct", "--stream", "osc", "--port", str(port), "--points", ",".join(WORN),
         "--method", "nearest", "--database", str(motion[0]), "-o", str(out)], stderr=subprocess.PIPE, text=True,
        cwd=Path(__file__).parents[2],
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))  # a shell's background jobs are deaf to Ctrl-C
    performer, said, recorded = Performer(motion[2], port, lambda: "recording" in "".join(said)), [], 0
    with performer.socket, program:
        for line in program.stderr:
            performer.sleep(1 / 60)
            if not line.startswith("tick"):
                said.append(line)
            elif performer.heard():
                recorded += 1
                if recorded == 20:
                    program.send_signal(signal.SIGINT)
    assert program.returncode == 0, said
    assert "packets were broken" in said[-1] and len(load(out)) >= 19


def test_packets_that_were_kept_are_heard_again_into_a_motion_and_for_another_program(stream, motion, tmp_path, monkeypatch):
    told, made = stream(lambda seconds: True, "--seconds", 2, "--keep", tmp_path / "take.packets")
    assert any("take.packets: all packets" in line for line in told)
    monkeypatch.setattr(live_clock, "time", time)  # nobody performs any more
    common = ["--points", ",".join(WORN), "--method", "nearest", "--database", motion[0]]
    done = gambol("reconstruct", tmp_path / "take.packets", "-o", tmp_path / "again.bvh", *common)
    assert done.exit_code == 0, done.output
    again = load(tmp_path / "again.bvh")
    assert walked(again) and len(again) > 100
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as listener:
        listener.bind(("127.0.0.1", 0))
        done = gambol("reconstruct", tmp_path / "take.packets", "--send", f"127.0.0.1:{listener.getsockname()[1]}", "--seconds", 0.5, *common)
        assert done.exit_code == 0, done.output
        listener.setblocking(False)
        frames = [listener.recv(65535) for _ in range(25)]
    assert all(b"/VMC/Ext/Bone/Pos" in frame and b"LeftUpperLeg" in frame for frame in frames)


class Turning(Performer):
    """… whose trackers, on head and hands, sit anyhow on the joints, and tell how they are turned."""

    def __init__(self, clip, port, heard, turning):
        super().__init__(clip, port, heard)
        self.names, self.turning = ("head", "lwrist", "rwrist"), turning
        controls = parse(",".join(self.names), SKELETON)
        positions, self.turned = clip.kinematics()
        self.walk, self.turned = controls.on(positions, self.turned), self.turned[:, controls.joints]
        stood = stances()
        self.standing, self.upright = controls.on(*stood)[1], stood[1][1, controls.joints]
        self.mounts = Rotation.random(3, random_state=5).as_matrix()

    def send(self, since):
        number = -1 if since < 0.3 else min(int((since - 0.3) * 60), len(self.walk) - 1)
        points, turns = (self.standing, self.upright) if number < 0 else (self.walk[number], self.turned[number])
        quaternions = Rotation.from_matrix(turns @ self.mounts).as_quat() * [1.0, -1.0, -1.0, 1.0] if self.turning else np.tile([0.0, 0.0, 0.0, 1.0], (3, 1))
        self.socket.sendto(bundle(*(message("/VMC/Ext/Tra/Pos", name, *map(float, place * [-1.0, 1.0, 1.0]), *map(float, turn))
                                    for name, place, turn in zip(self.names, points, quaternions))), self.to)


def test_how_trackers_are_turned_is_heard_by_the_method_that_ships_and_again_from_their_packets(motion, tmp_path, monkeypatch):
    """Hands and head are turned as the performer's, however trackers sit on them; without turns they can't be."""
    clip, off = motion[2], {}
    joints = parse("head,lwrist,rwrist", SKELETON).joints
    truth = clip.kinematics()[1][:, joints]

    def away(made):
        """How far head and hands are turned from the performer's on the average [°], a few frames apart at most."""
        found = made.kinematics()[1][:, joints]
        return min(np.degrees(Rotation.from_matrix((np.swapaxes(truth[20:80], -1, -2) @ found[20 + lag:80 + lag]).reshape(-1, 3, 3)).magnitude().mean())
                   for lag in range(10, 30))

    for turning in (True, False):
        told, port, out = [], free_port(), tmp_path / f"{turning}.bvh"
        performer = Turning(clip, port, lambda told=told: any("recording" in line for line in told), turning)
        with performer.socket, monkeypatch.context() as patched:
            for module, name, value in ((live_clock, "time", performer), (live, "clock", lambda: None), (live, "say", told.append)):
                patched.setattr(module, name, value)
            done = gambol("reconstruct", "--stream", "osc", "--port", port, "--points", "head,lwrist,rwrist", "-o", out, "--seconds", 2,
                          "--keep", tmp_path / f"{turning}.packets")
        assert done.exit_code == 0, done.output
        off[turning] = away(load(out))
    assert off[True] < 8.0 and off[False] > 1.5 * off[True], off
    done = gambol("reconstruct", tmp_path / "True.packets", "--points", "head,lwrist,rwrist", "-o", tmp_path / "again.bvh")
    assert done.exit_code == 0, done.output
    assert away(load(tmp_path / "again.bvh")) < 8.0
    for _ in range(2):  # the second time as the file says
        done = gambol("reconstruct", tmp_path / "True.packets", "--points", "head,lwrist,rwrist", "-o", tmp_path / "worn.bvh", "--calibration", tmp_path / "me.toml")
        assert done.exit_code == 0 and "m tall" in done.output and (tmp_path / "me.toml").is_file(), done.output


def test_a_clip_tells_how_its_points_are_turned(motion, tmp_path):
    joints, found = parse("6", SKELETON).joints, []
    for more in ([], ["--turns"]):
        done = gambol("reconstruct", motion[1], "--points", "6", "-o", tmp_path / "o.bvh", *more)
        assert done.exit_code == 0, done.output
        turned = [clip.kinematics()[1][30:, joints] for clip in (motion[2], load(tmp_path / "o.bvh"))]
        away = Rotation.from_matrix((np.swapaxes(turned[0], -1, -2) @ turned[1]).reshape(-1, 3, 3)).magnitude()
        found.append(float(np.degrees(away.mean())))
    assert found[1] < 0.5 * found[0], found


@pytest.mark.parametrize("arguments, why", [
    (["take.packets"], "into a motion, -o FILE, or for another program"), (["take.packets", "-o", "o.bvh", "--keep", "b.packets"], "--keep goes with --stream"),
    (["take.packets", "-o", "o.bvh", "--noise", "1"], "--noise goes with a motion file"), (["a.bvh", "--send", "x"], "--send goes with --stream"),
    (["--stream", "osc", "--window"], "--window goes with"), (["--stream", "osc", "--send", "x", "--window", "--seconds", "1"], "--seconds goes with"),
    (["take.packets", "-o", "o.bvh"], "can't be read"), (["take.packets", "--send", "a:b"], "can't be read")])
def test_mistakes_about_packets_are_told_in_a_line(arguments, why, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = gambol("reconstruct", *arguments)
    assert done.exit_code == 2 and why in done.output, done.output
