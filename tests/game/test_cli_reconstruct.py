"""`gambol reconstruct`: a body out of points, from a file or a stream, and one clear line for every mistake."""

import os
import re
import signal
import socket
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

sys.path.insert(0, str(Path(__file__).parents[1] / "reconstruction"))
import walks  # noqa: E402

from gambol.controllers.mocap import load, write_bvh  # noqa: E402
from gambol.controllers.reconstruction.pose_vector import SKELETON  # noqa: E402
from gambol.controllers.reconstruction.control_points import parse  # noqa: E402
from gambol.controllers.reconstruction.live.placing import stances  # noqa: E402
from gambol.game import cli  # noqa: E402

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


@pytest.mark.parametrize("suffix", [".bvh", ".glb"])
def test_a_clip_from_its_points(motion, tmp_path, suffix):
    database, file, clip = motion
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


def test_noise_is_the_same_for_the_same_seed(motion, tmp_path):
    database, file, _ = motion
    said = {}
    for seed in (1, 1, 2):
        done = gambol("reconstruct", file, "--noise", 2, "--seed", seed, "--method", "nearest", "--database", database, "-o", tmp_path / "o.bvh")
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
    (["{clip}", "--method", "magic", "--database", "{database}", "-o", "o.bvh"], "no such method; choose from ours"),
    (["{clip}", "-o", "o.fbx"], ".bvh or .glb"),
    (["none.bvh", "-o", "o.bvh"], "none.bvh"),
    (["{words}", "-o", "o.bvh"], "words.bvh"),
    (["{clip}", "--database", "{clip}", "-o", "o.bvh"], "is no motion database"),
    (["{clip}", "--database", "none.gambolmotion", "-o", "o.bvh"], "none.gambolmotion: can't be read"),
    (["{clip}", "--port", "9000", "-o", "o.bvh"], "--port goes with --stream"),
    (["{clip}", "--host", "0.0.0.0", "-o", "o.bvh"], "--host goes with --stream"),
    (["--stream", "osc", "--host", "", "-o", "o.bvh", "--database", "{database}", "--method", "nearest"], "host '' is no address of this machine"),
    (["--stream", "osc", "--noise", "1", "-o", "o.bvh"], "--noise goes with a motion file"),
    (["--stream", "osc", "--map", "none.toml", "-o", "o.bvh"], "none.toml: can't be read"),
    (["--stream", "osc", "--map", "m.toml", "--points", "4", "-o", "o.bvh"], "give one of them"),
    (["--stream", "osc", "--points", "nose", "-o", "o.bvh"], "no control point 'nose'")])
def test_mistakes_get_one_line(motion, tmp_path, monkeypatch, arguments, why):
    monkeypatch.chdir(tmp_path)
    words = tmp_path / "words.bvh"
    words.write_text("HIERARCHY of words")
    known = {"clip": motion[1], "database": motion[0], "words": words}
    done = gambol("reconstruct", *(a.format(**known) for a in arguments))
    assert done.exit_code == 2
    assert why in done.output and len(done.output.strip().splitlines()) == 1


def test_a_port_in_use_is_a_mistake(motion, tmp_path):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("0.0.0.0", 0))
        done = gambol("reconstruct", "--stream", "osc", "--port", other.getsockname()[1], "--database", motion[0], "-o", tmp_path / "o.bvh")
    assert done.exit_code == 2 and "can't be listened at" in done.output


@pytest.mark.skipif(os.name == "nt", reason="no signals of this kind there")
def test_streams_are_recorded_until_they_are_ended_and_never_lost(motion, tmp_path):
    """By Ctrl-C, by whoever ends the program from outside, and when the time is up: all three at once."""
    with ExitStack() as stack:
        free = [stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM)) for _ in range(3)]
        for one in free:
            one.bind(("127.0.0.1", 0))
        ports = [one.getsockname()[1] for one in free]
    ends, programs = (signal.SIGINT, signal.SIGTERM, None), []
    for port, end in zip(ports, ends):
        programs.append(subprocess.Popen(
            [sys.executable, "-m", "gambol.game.cli", "reconstruct", "--stream", "osc", "--port", str(port), "--points", ",".join(WORN),
             "--method", "nearest", "--database", str(motion[0]), "-o", str(tmp_path / f"{port}.bvh"), *([] if end else ["--seconds", "2"])],
            stderr=subprocess.PIPE, text=True, cwd=Path(__file__).parents[2],
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)))  # a shell's background jobs are deaf to Ctrl-C
    with ThreadPoolExecutor(3) as pool:
        for told in pool.map(lambda *given: performed(motion[2], *given), programs, ports, ends):
            assert "packets were broken" in told
    for port in ports:
        made = load(tmp_path / f"{port}.bvh")
        assert 60 <= len(made) <= 200
        heights = made.kinematics()[0][..., 1]
        assert 1.3 < heights.max(1).mean() < 1.8 and heights.min() > -0.1


def performed(clip, program, port, end):
    """What a program says to a performer 1.4 m tall who stands in T-pose and then walks; the body is of standard size."""
    from test_stream import bundle, tracker

    for line in program.stderr:
        if "stand upright" in line:
            break
    controls = parse("4", SKELETON)
    walk, told, size = controls.extract(clip), [], 0.8
    listener = threading.Thread(target=lambda: told.extend(program.stderr))
    listener.start()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        began = None
        for _ in range(3000):
            if began is None and any("recording" in line for line in list(told)):
                began = time.monotonic()
            since = 0.0 if began is None else time.monotonic() - began
            if program.poll() is not None or (end and since > 2.0):
                break
            points = stances(controls)[1] if since < 0.3 else walk[min(int((since - 0.3) * 60), len(walk) - 1)]
            there = size * points * [-1.0, 1.0, 1.0] + [0.3, 0.1, -0.2]
            sender.sendto(bundle(*(tracker(name, place) for name, place in zip(WORN, there))), ("127.0.0.1", port))
            sender.sendto(b"not OSC", ("127.0.0.1", port))
            time.sleep(1 / 90)
    if end:
        program.send_signal(end)
    assert program.wait(60) == 0, told
    listener.join()
    return "".join(told)
