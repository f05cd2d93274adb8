"""Films and pictures: complete, readable by others, and safe from a kill."""

import os
import signal
import subprocess
import sys
from fractions import Fraction
from itertools import islice

import av
import numpy as np
import pytest
from PIL import Image

from gambol.controllers.body import human
from gambol.game.files.paths import OutputError, output_file
from gambol.game.output.recorder import Film, Pictures, motion_clip, recorder, write_motion
from gambol.game.world.world import DT
from stand_in import Glide


def picture(i, size=(64, 48), channels=4):
    frame = np.zeros((size[1], size[0], channels), np.uint8)
    frame[..., 0] = 200
    frame[..., 3:] = 255
    frame[:, : 2 * i + 2, 1] = 160
    return frame


def read(path):
    with av.open(str(path)) as film:
        stream = film.streams.video[0]
        return [frame.to_ndarray(format="rgb24") for frame in film.decode(video=0)], stream, float(film.duration / 1e6)


@pytest.mark.parametrize("channels", [3, 4])
def test_a_film_has_every_frame_and_its_length_and_colours(tmp_path, channels):
    path = tmp_path / "new" / "a.mp4"
    with Film(path, (64, 48), 30) as film:
        for i in range(45):
            film.write(picture(i % 30, channels=channels))
    frames, stream, duration = read(path)
    assert len(frames) == 45 and duration == pytest.approx(1.5, abs=0.05) and stream.average_rate == 30
    assert stream.codec_context.name == "h264" and stream.codec_context.pix_fmt == "yuv420p"
    assert np.abs(frames[20][24, 20].astype(int) - picture(20)[24, 20, :3]).max() < 12
    assert [file.name for file in path.parent.iterdir()] == ["a.mp4"]


def test_odd_sizes_become_even(tmp_path):
    with Film(tmp_path / "odd.mp4", (33, 17), 60) as film:
        film.write(picture(3, (33, 17)))
    frames, _, _ = read(tmp_path / "odd.mp4")
    assert frames[0].shape == (16, 32, 3) and film.picture == (32, 16)


def test_an_error_leaves_the_old_film_and_a_playable_part(tmp_path):
    path = tmp_path / "a.mp4"
    path.write_text("an older film")
    with pytest.raises(RuntimeError), Film(path, (64, 48), 30) as film:
        for i in range(10):
            film.write(picture(i))
        raise RuntimeError
    assert path.read_text() == "an older film" and len(read(tmp_path / "a.part.mp4")[0]) == 10


def test_an_error_while_closing_hides_not_the_first(tmp_path, monkeypatch):
    def fail(self):
        raise OSError("the disk is full, too")
    monkeypatch.setattr(Film, "_close", fail)
    with pytest.raises(RuntimeError, match="the first"), Film(tmp_path / "a.mp4", (64, 48), 30):
        raise RuntimeError("the first")


@pytest.mark.skipif(os.name == "nt", reason="needs a limit on the size of files, which Windows lacks")
def test_a_full_disk_is_told_with_the_path_and_leaves_a_playable_part(tmp_path):
    code = f"""
import sys; sys.path[:0] = {sys.path!r}
import resource
import numpy as np
from gambol.game.output.recorder import Film
resource.setrlimit(resource.RLIMIT_FSIZE, (400_000, 400_000))
noise = np.random.default_rng(0).integers(0, 255, (90, 120, 3), np.uint8)
with Film({str(tmp_path / "a.mp4")!r}, (120, 90), 10) as film:
    while True:
        film.write(np.roll(noise, 17 * film.count, 1))
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    last = done.stderr.splitlines()[-1]
    assert last == f"gambol.game.files.paths.OutputError: {tmp_path / 'a.part.mp4'}: can't be written: File too large"
    with av.open(str(tmp_path / "a.part.mp4")) as film:  # whose last frame is cut off
        assert len(list(islice(film.decode(video=0), 5))) == 5


def test_a_film_that_cannot_be_completed_stays_in_its_part(tmp_path):
    path = tmp_path / "a.mp4"
    with pytest.raises(OutputError, match="a.mp4: can't be written"), Film(path, (64, 48), 30) as film:
        film.write(picture(0))
        path.mkdir()
    assert sorted(f.name for f in tmp_path.iterdir()) == ["a.mp4", "a.part.mp4"]
    assert len(read(tmp_path / "a.part.mp4")[0]) == 1


@pytest.mark.thorough
def test_a_killed_recording_can_be_played(tmp_path):
    code = f"""
import sys; sys.path[:0] = {sys.path!r}
import numpy as np
from gambol.game.output.recorder import Film
with Film({str(tmp_path / "a.mp4")!r}, (64, 48), 30) as film:
    for i in range(150):
        film.write(np.full((48, 64, 4), 8 * (i % 30), np.uint8))
    print("ready", flush=True)
    sys.stdin.read()
"""
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stdin=subprocess.PIPE) as process:
        assert process.stdout.readline().strip() == b"ready"
        process.send_signal(signal.SIGKILL if hasattr(signal, "SIGKILL") else signal.SIGTERM)
    assert len(read(tmp_path / "a.part.mp4")[0]) >= 100


def test_pictures_are_exact_and_older_ones_go(tmp_path):
    with Pictures(tmp_path, (64, 48)) as pictures:
        for i in range(5):
            pictures.write(picture(i))
    (tmp_path / "frame_mine.png").write_text("not ours")
    with Pictures(tmp_path, (64, 48)) as pictures:
        for i in range(3):
            pictures.write(picture(i + 1))
    assert sorted(f.name for f in tmp_path.iterdir()) == ["frame_00000.png", "frame_00001.png", "frame_00002.png", "frame_mine.png"]
    assert np.array_equal(np.asarray(Image.open(tmp_path / "frame_00002.png")), picture(3)[..., :3])


def test_the_path_says_what_is_recorded(tmp_path):
    assert isinstance(recorder(tmp_path / "a.mp4", (2, 2), 30), Film)
    assert isinstance(recorder(tmp_path / "frames", (2, 2), 30), Pictures)
    assert isinstance(recorder(f"{tmp_path}/v1.2/", (2, 2), 30), Pictures)
    with pytest.raises(ValueError, match="can't record .avi"):
        recorder("a.avi", (2, 2), 30)
    with pytest.raises(ValueError, match="a.gif: has 60 frames a second, a .gif at most 50"):
        recorder("a.gif", (2, 2), 60)


@pytest.mark.parametrize("name, pictures, rate", [("a.mp4", 18, Fraction(24000, 1001)), ("a.webm", 18, Fraction(24000, 1001)), ("a.gif", 12, 25)])
def test_every_kind_of_film_keeps_its_frames_colours_and_rate(tmp_path, name, pictures, rate):
    with recorder(tmp_path / name, (64, 48), rate) as film:
        for i in range(pictures):
            film.write(picture(i + 3))
    frames, stream, duration = read(tmp_path / name)
    assert len(frames) == pictures and stream.average_rate == rate and duration == pytest.approx(pictures / rate, abs=0.05)
    assert all(np.abs(frame[24, 2].astype(int) - [200, 160, 0]).max() < 24 and np.abs(frame[24, 60].astype(int) - [200, 0, 0]).max() < 24
               for frame in frames)
    assert [file.name for file in tmp_path.iterdir()] == [name]


def test_frames_that_do_not_fit_are_refused(tmp_path):
    with Pictures(tmp_path, (64, 48)) as pictures, pytest.raises(ValueError, match="48 × 64 .* got 64 × 48 × 4 of uint8"):
        pictures.write(np.zeros((64, 48, 4), np.uint8))


def test_poses_become_a_clip():
    glide = Glide()
    state = glide.start((1, 2, 0.5))
    clip = motion_clip("A", human(), [state.pose] * 7, 60)
    positions, orientations = clip.kinematics()
    assert len(clip) == 7 and clip.frame_time == DT
    assert np.allclose(positions[3, 0], state.pose.root) and np.allclose(orientations[3, 0], state.pose.rotations[0])


def test_motion_that_cannot_be_written_leaves_nothing(tmp_path, monkeypatch):
    glide = Glide()
    clip = motion_clip("A", human(), [glide.start().pose] * 2, 60)

    def full(number):
        raise OSError(28, "No space left on device")
    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OutputError, match="a.bvh: can't be written: No space left on device"):
        write_motion(clip, tmp_path / "new" / "a.bvh")
    assert not list((tmp_path / "new").iterdir())


def faults(folder):
    """Paths nothing can be written to, and what is said of each."""
    (folder / "file").write_text("")
    (folder / "folder.mp4").mkdir()
    (folder / "old.mp4").write_text("")
    (folder / "old.mp4").chmod(0o444)
    yield "a.avi", "a.avi: needs a name that ends in .mp4"
    yield "folder.mp4", "folder.mp4: is a folder; name a file"
    yield "file/a.mp4", "file: is a file; name a folder"
    yield "file/deeper/a.mp4", "can't be written: Not a directory"
    yield "x" * 300 + ".mp4", "can't be written: File name too long"
    yield "old.mp4", "old.mp4: is there already and write-protected"


def test_a_path_nothing_can_be_written_to_is_found_before_the_work(tmp_path, monkeypatch):
    monkeypatch.setattr(os, "access", lambda path, mode: os.stat(path).st_mode & 0o200 != 0)  # root may do anything
    for path, says in faults(tmp_path):
        with pytest.raises(OutputError) as error:
            output_file(tmp_path / path, ".mp4")
        assert says in str(error.value) and str(error.value).startswith(str(tmp_path)), path
    for path in ("new/deeper/a.mp4", "b.MP4"):
        assert output_file(tmp_path / path, ".mp4") == tmp_path / path and (tmp_path / path).parent.is_dir()
        assert not list((tmp_path / "new" / "deeper").iterdir()), "a check leaves nothing but the folder"
    with pytest.raises(OutputError, match="file: is a file; name a folder"):
        recorder(tmp_path / "file", (64, 48), 30)
    monkeypatch.setattr("tempfile.TemporaryFile", lambda **_: (_ for _ in ()).throw(PermissionError(13, "Permission denied")))
    with pytest.raises(OutputError, match="new: can't be written: Permission denied"):
        recorder(tmp_path / "new" / "c.mp4", (64, 48), 30)
