"""Whatever is written appears whole or not at all, flushed, and is nobody else's meanwhile; and no pipe is waited for."""

import os
import stat
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from scipy.spatial.transform import Rotation

from gambol import assets
from gambol.controllers.body import Clip, human
from gambol.controllers.files import contents, ordinary, whole
from gambol.controllers.locomotion import Library
from gambol.controllers.locomotion.controller import DEFAULT_LIBRARY
from gambol.controllers.mocap import write_bvh
from gambol.controllers.reconstruction.database.database import Writer
from gambol.controllers.reconstruction.pose_vector import WIDTH
from gambol.controllers.files import printable
from gambol.game.app.capture import Capture
from gambol.game.character.write import Glb
from gambol.game.files.paths import OutputError, exclusive
from gambol.game.output.recorder import Film, Pictures, write_motion

ROOT = Path(assets.__file__).parents[1]
BODY = human()
CLIP = Clip("still", BODY, 1 / 60, np.zeros((3, 3)), np.tile(Rotation.identity().as_quat(), (3, len(BODY), 1)))
PICTURE = np.zeros((16, 16, 3), np.uint8)


def a_database(path):
    with Writer(path) as writer:
        writer.add("clip", "somebody", "walk", np.zeros((4, WIDTH)), np.ones(4, bool))


def a_film(path):
    with Film(path, (16, 16), 30) as film:
        for _ in range(3):
            film.write(PICTURE)


def a_picture(path):
    with Pictures(path.parent, (16, 16)) as pictures:
        pictures.write(PICTURE)


WRITERS = {
    "gaits.npz": lambda path: Library.load(DEFAULT_LIBRARY).save(path), "a.gambolmotion": a_database, "a.mp4": a_film,
    "a.bvh": lambda path: write_bvh(CLIP, path), "b.bvh": lambda path: write_motion(CLIP, path), "a.glb": lambda path: Glb().save(path),
    "frame_00000.png": a_picture}


@pytest.mark.parametrize("name", WRITERS)
def test_what_is_written_is_flushed_before_it_takes_its_place(tmp_path, monkeypatch, name):
    flushed, sync = set(), os.fsync
    path = tmp_path / name
    path.write_bytes(b"what stood here before")

    def watched(number):
        assert path.read_bytes() == b"what stood here before"
        flushed.add(os.fstat(number).st_ino)
        sync(number)
    monkeypatch.setattr(os, "fsync", watched)
    WRITERS[name](path)
    assert path.stat().st_ino in flushed and path.read_bytes() != b"what stood here before"
    assert [file.name for file in tmp_path.iterdir()] == [name]


@pytest.mark.parametrize("name", WRITERS)
def test_a_full_disk_leaves_what_stood_there_and_nothing_else(tmp_path, monkeypatch, name):
    def full(number):
        raise OSError(28, "No space left on device")
    monkeypatch.setattr(os, "fsync", full)
    path = tmp_path / name
    path.write_bytes(b"what stood here before")
    with pytest.raises((OSError, OutputError), match="No space left"):
        WRITERS[name](path)
    assert path.read_bytes() == b"what stood here before"
    left = [file.name for file in tmp_path.iterdir()]
    assert left == [name] or name == "a.mp4" and sorted(left) == ["a.mp4", "a.part.mp4"]  # what was drawn is kept


def test_two_who_write_the_same_do_not_meet(tmp_path):
    path = tmp_path / "a.txt"
    with whole(path) as one:
        one.write_text("one" * 1000)
        with whole(path) as other:
            other.write_text("other")
        assert path.read_text() == "other" and one.read_text() == "one" * 1000
    assert path.read_text() == "one" * 1000 and list(tmp_path.iterdir()) == [path]


def test_two_who_film_the_same_do_not_meet(tmp_path):
    path = tmp_path / "a.mp4"
    with Film(path, (16, 16), 30) as one, Film(path, (16, 16), 30) as other:
        for _ in range(3):
            one.write(PICTURE)
            other.write(PICTURE)
        assert one.part == tmp_path / "a.part.mp4" and other.part == tmp_path / "a.part-2.mp4"
    assert list(tmp_path.iterdir()) == [path]
    assert exclusive(path) == tmp_path / "a-2.mp4"


def test_a_folder_takes_its_place_whole_too(tmp_path):
    path = tmp_path / "learnt"
    for text in ("older", "newer"):
        with whole(path) as part:
            part.mkdir()
            (part / "one").write_text(text)
    assert (path / "one").read_text() == "newer" and list(tmp_path.iterdir()) == [path]


def test_files_are_as_readable_as_any(tmp_path):
    (tmp_path / "plain").touch()
    with whole(tmp_path / "whole") as part:
        part.touch()
    assert stat.S_IMODE((tmp_path / "whole").stat().st_mode) == stat.S_IMODE((tmp_path / "plain").stat().st_mode)


@pytest.mark.skipif(os.name == "nt", reason="needs a program that can be killed outright")
def test_a_kill_in_the_middle_leaves_what_stood_there(tmp_path):
    path = tmp_path / "a.gambolmotion"
    path.write_bytes(b"before")
    code = f"""
import os, signal, sys
sys.path[:0] = {[str(ROOT), str(ROOT / 'tests')]!r}
from gambol.controllers.files import whole
with whole({str(path)!r}) as part:
    part.write_bytes(bytes(1000))
    os.kill(os.getpid(), signal.SIGKILL)
"""
    assert subprocess.run([sys.executable, "-c", code]).returncode == -9
    assert path.read_bytes() == b"before"


def test_a_screenshot_that_fails_is_told_and_takes_no_name(tmp_path, monkeypatch):
    said, studio = [], Capture(tmp_path)
    path = studio.screenshot(PICTURE)
    studio.finish(said.append)
    assert Image.open(path).size == (16, 16) and list(tmp_path.iterdir()) == [path]
    path.unlink()

    def full(number):
        raise OSError(28, "No space left on device")
    monkeypatch.setattr(os, "fsync", full)
    path = studio.screenshot(PICTURE)
    studio.finish(said.append)
    assert said == [f"{path}: can't be written: No space left on device"] and not list(tmp_path.iterdir())


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="only where there are pipes with names")
def test_only_ordinary_files_are_read(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "file").write_bytes(b"content")
    (tmp_path / "link").symlink_to("file")
    assert contents(tmp_path / "link") == b"content" and ordinary(tmp_path / "file") == tmp_path / "file"
    for path, says in ((tmp_path / "pipe", "is a pipe"), (Path("/dev/null"), "is a device"), (tmp_path, "Is a directory"),
                       (tmp_path / "none", "No such file"), (tmp_path / "a\0b", "null")):
        with pytest.raises(OSError, match=says):
            contents(path)
    with pytest.raises(OSError, match="holds 1 MiB; 0 MiB are read at most"):
        contents(tmp_path / "file", 3)


def test_words_of_others_are_shown_in_one_line_and_command_nothing():
    assert printable("LHR-1A2B3C4D") == "LHR-1A2B3C4D" and printable("Ärmel") == "Ärmel"
    assert printable("\x1b]0;owned\x07\n\u202e") == "\\x1b]0;owned\\x07\\n\\u202e" and printable("x" * 100, 10) == "x" * 10 + "…"
    assert all(printable(chr(code)).isprintable() for code in range(0x3000))
