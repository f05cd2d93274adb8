"""Films and pictures: complete, readable by others, and safe from a kill."""

import signal
import subprocess
import sys

import av
import numpy as np
import pytest
from PIL import Image

from controllers.body import human
from game.recorder import Film, Pictures, motion_clip, recorder
from game.world import DT
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
    assert frames[0].shape == (16, 32, 3)


def test_an_error_leaves_the_old_film_and_a_playable_part(tmp_path):
    path = tmp_path / "a.mp4"
    path.write_text("an older film")
    with pytest.raises(RuntimeError), Film(path, (64, 48), 30) as film:
        for i in range(10):
            film.write(picture(i))
        raise RuntimeError
    assert path.read_text() == "an older film" and len(read(tmp_path / "a.part.mp4")[0]) == 10


def test_a_killed_recording_can_be_played(tmp_path):
    code = f"""
import sys; sys.path[:0] = {sys.path!r}
from test_recorder import Film, picture
with Film({str(tmp_path / "a.mp4")!r}, (64, 48), 30) as film:
    for i in range(150):
        film.write(picture(i % 30))
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
    with pytest.raises(ValueError, match="can't record .gif"):
        recorder("a.gif", (2, 2), 30)


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
