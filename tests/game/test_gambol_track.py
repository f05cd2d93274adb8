"""Footage tracked: from masks and from painted pictures, from the truth's first poses or a file's, and what is said of broken folders."""

import json
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from PIL import Image
from scenarios import written
from stand_in import Glide
from test_studio import Drawing
from typer.testing import CliRunner

from gambol.assets import path as asset
from gambol.controllers.mocap import load as load_motion
from gambol.controllers.tracking import Tracker
from gambol.controllers.tracking.cameras import read_cameras
from gambol.controllers.tracking.twists import posed
from gambol.game import cli
from gambol.game.footage import FootageError, first_poses, person_in, read_footage, seen_in
from gambol.game.meshes import surface_of
from gambol.game.scenario.scenario import load
from gambol.game.studio import Plan, Sensor, error_of, followed, imported, overlaid, shoot

SCENARIO = """
title = "Short"
duration = 0.2
fps = 30
[[actors]]
name = "Ann"
moves = [{ for = 1.0, velocity = [0.8, 0, 0] }]
"""
CAMERAS = "".join(f"""
[cam{k}]
size = [96, 96]
eye = [{x}, 1.4, {z}]
target = [0, 0.9, 0]
fov = 36
""" for k, (x, z) in enumerate(((0.5, 4.0), (4.0, -0.4), (-3.0, -2.6))))


@pytest.fixture(scope="module")
def footage(tmp_path_factory):
    """Six frames from three cameras: a light body before dark ground, as its masks say."""
    folder = tmp_path_factory.mktemp("footage")
    (folder / "c.toml").write_text(CAMERAS)
    plan = Plan(load(written(folder, SCENARIO)), read_cameras(folder / "c.toml"), Sensor())
    list(shoot(plan, folder / "out", Glide(), Drawing()))
    made, rng = read_footage(folder / "out"), np.random.default_rng(0)
    for lens in made.lenses:
        for number in range(made.frames):
            mask = made.picture(lens.name, "mask", number)[..., None] > 0
            picture = np.where(mask, (170, 140, 110), (70, 80, 90)) + rng.normal(size=mask.shape) * 5
            Image.fromarray(picture.astype(np.uint8)).save(made.file(lens.name, "frame", number))
    return made


@pytest.fixture(scope="module")
def surface():
    return surface_of(freedom="full")


@pytest.mark.parametrize("masks", [False, True])
def test_somebody_is_followed(footage, surface, masks):
    poses = list(first_poses(footage, surface))
    tracker = Tracker(surface, footage.lenses, footage.fps)
    poses += [one.now for one in followed(footage, tracker, poses, 0, masks)]
    off = error_of(footage, surface, poses)
    assert off.shape == (6, 22) and off[:2].max() < 0.02 and off.mean() < 0.05
    still = [poses[1]] * 6
    assert off[-1].mean() < 0.6 * error_of(footage, surface, still)[-1].mean(), "it goes along"


def test_a_motion_file_says_where_one_begins(footage, surface):
    ours, theirs = first_poses(footage, surface), first_poses(footage, surface, 0, footage.path / "motion.bvh")
    for one, other in zip(ours, theirs):
        np.testing.assert_allclose(posed(surface.chain, one)[0], posed(surface.chain, other)[0], atol=0.01)


def test_contours_are_laid_over_pictures(footage, surface):
    shown = overlaid(footage, surface, 1, first_poses(footage, surface)[1], 96)
    assert shown.shape == (96, 3 * 96, 3)
    for third in np.split(shown, 3, 1):
        assert (third == (255, 40, 40)).all(-1).sum() > 40


def test_people_by_name(footage):
    assert person_in(footage, None) == person_in(footage, "Ann") == 0
    with pytest.raises(FootageError, match="shows no Bob; it has Ann"):
        person_in(footage, "Bob")


def run(*words):
    return CliRunner().invoke(cli.app, ["track", *map(str, words)])


def test_the_command_tracks(footage, tmp_path):
    done = run(footage.path, "-o", tmp_path / "a.bvh", "--overlay", f"{tmp_path / 'film'}/")
    assert done.exit_code == 0 and "6 frames of Ann; joints" in done.output
    clip = load_motion(tmp_path / "a.bvh")
    assert len(clip) == 6 and clip.frame_time == pytest.approx(1 / 30)
    np.testing.assert_allclose(clip.root[1], footage.truth()["joints"][1, 0, 0], atol=0.01)
    assert len(list((tmp_path / "film").glob("frame_*.png"))) == 4


def one_line(done, *words):
    assert done.exit_code == 2 and "Traceback" not in done.output
    told = [line for line in done.output.splitlines() if line.startswith("gambol: ")]
    assert len(told) == 1 and all(word in told[0] for word in words), done.output


def copied(footage, folder):
    import shutil

    shutil.copytree(footage.path, folder)
    return folder


def test_what_cannot_be_tracked_is_told_in_a_line(footage, tmp_path):
    out = tmp_path / "a.bvh"
    one_line(run(tmp_path / "none", "-o", out), "footage.json", "No such file")
    one_line(run(footage.path, "-o", out, "--person", "Bob"), "shows no Bob")
    one_line(run(footage.path, "-o", tmp_path / "a.txt"), "a.txt")
    one_line(run(footage.path, "-o", out, "--start", tmp_path / "no.bvh"), "no.bvh")
    (tmp_path / "begun.bvh").write_text("kept")
    one_line(run(footage.path, "-o", tmp_path / "begun.bvh", "--start", tmp_path / "begun.bvh"), "would be overwritten")
    assert (tmp_path / "begun.bvh").read_text() == "kept"
    one_line(run(footage.path, "-o", out, "--overlay", tmp_path / "film.avi"), "film.avi")
    broken = copied(footage, tmp_path / "one")
    (broken / "truth.npz").write_bytes(b"PK")
    one_line(run(broken, "-o", out), "truth.npz")
    np.savez(broken / "truth.npz", joints=np.zeros((6, 1, 22, 3)))
    one_line(run(broken, "-o", out), "truth.npz", "name a motion file")
    broken = copied(footage, tmp_path / "two")
    whole = (footage.path / "cam1" / "frame_00003.png").read_bytes()
    (broken / "cam1" / "frame_00003.png").write_bytes(whole[:len(whole) // 2])
    one_line(run(broken, "-o", out), "frame_00003.png", "truncated")
    Image.new("RGB", (64, 96)).save(broken / "cam1" / "frame_00003.png")
    one_line(run(broken, "-o", out), "frame_00003.png", "64 × 96", "96 × 96")
    Image.new("RGBA", (96, 96)).save(broken / "cam1" / "frame_00003.png")
    one_line(run(broken, "-o", out), "frame_00003.png", "red, green and blue")
    about = json.loads((broken / "footage.json").read_text())
    (broken / "footage.json").write_text(json.dumps(about | {"people": []}))
    one_line(run(broken, "-o", out), "shows nobody")
    (broken / "footage.json").write_text(json.dumps(about | {"complete": False}))
    one_line(run(broken, "-o", out), "not filmed to its end")
    for old, new, says in (("matrix = [[", "matrix = [[nan, 0, 0], [", "cam0.matrix: needs 3 × 3 finite numbers"),
                           ("translation = [", "translation = [nan, ", "cam0.translation: needs 3 finite numbers"),
                           ("[96, 96]", "[96, 95]", "frame_00000.png: 96 × 96 pixels, but cam0 has 96 × 95"),
                           ('name = "cam2"', 'name = "left"', "is not there, nor is any frame of left")):
        broken = copied(footage, tmp_path / str(len(list(tmp_path.iterdir()))))
        (broken / "footage.json").write_text(json.dumps(about | {"people": ["Ann"], "complete": True, "dropped": {}, "corrupted": {}}))
        text = (broken / "cameras.toml").read_text()
        (broken / "cameras.toml").write_text(text.replace(old, new, 1))
        one_line(run(broken, "-o", out), says)
    assert not out.exists()


def test_looking_back_is_for_the_command_too(footage, tmp_path):
    """--lag moves poses, only where something was tracked, and leaves their number as it is."""
    for name, lag in (("now", 0), ("late", 2), ("all", 60)):
        assert run(footage.path, "-o", tmp_path / f"{name}.bvh", "--masks", "--lag", lag).exit_code == 0
    now, then, whole = (load_motion(tmp_path / f"{name}.bvh") for name in ("now", "late", "all"))
    assert len(now) == len(then) == len(whole) == 6
    assert np.array_equal(now.root[:2], then.root[:2]) and not np.array_equal(now.root[3:], then.root[3:])
    np.testing.assert_allclose(whole.root, footage.truth()["joints"][:, 0, 0], atol=0.03)


def test_dropped_frames_are_none(footage, tmp_path):
    broken = copied(footage, tmp_path / "one")
    about = json.loads((broken / "footage.json").read_text())
    (broken / "footage.json").write_text(json.dumps(about | {"dropped": {"cam2": [2]}}))
    assert [one is None for one in seen_in(read_footage(broken), 2)] == [False, False, True]


@pytest.mark.few(1)
@pytest.mark.parametrize("kind", ["frame", "mask"])
def test_lost_frames_are_told_and_gone_over_as_far_as_others_tell(footage, tmp_path, kind):
    broken, words = copied(footage, tmp_path / "one"), ["--masks"] if kind == "mask" else []
    for camera, numbers in (("cam0", [2]), ("cam1", [2, 3, 5]), ("cam2", [2])):  # in frame 2 nobody sees anything
        for number in numbers:
            (broken / camera / f"{kind}_{number:05d}.png").unlink()
    done = run(broken, "-o", tmp_path / "a.bvh", *words)
    told = [line for line in done.output.splitlines() if "not there" in line]
    assert done.exit_code == 0 and len(told) == 3 and f"cam1: 3 of 6 {kind}s are not there: 2–3, 5" in told[1], done.output
    clip = load_motion(tmp_path / "a.bvh")
    assert len(clip) == 6
    np.testing.assert_allclose(clip.root, footage.truth()["joints"][:, 0, 0], atol=0.05)
    for camera in ("cam0", "cam1", "cam2"):
        (broken / camera / f"{kind}_00000.png").unlink()
    one_line(run(broken, "-o", tmp_path / "b.bvh", *words), f"no camera has the first {kind}")
    for number in range(6):
        (broken / "cam0" / f"{kind}_{number:05d}.png").unlink(missing_ok=True)
    one_line(run(broken, "-o", tmp_path / "b.bvh", *words), f"{kind}_00000.png: is not there, nor is any {kind} of cam0")


def test_nobody_is_foretold_for_long(footage, tmp_path):
    broken = copied(footage, tmp_path / "one")
    about = json.loads((broken / "footage.json").read_text())
    (broken / "footage.json").write_text(json.dumps(about | {"fps": 5}))  # 3 frames are longer than 0.3 s
    for camera in ("cam0", "cam1", "cam2"):
        for number in (2, 3, 4):
            (broken / camera / f"frame_{number:05d}.png").unlink()
    one_line(run(broken, "-o", tmp_path / "a.bvh"), "no camera has frames 2 to 4")


def mp4(path, pictures, fps=30):
    import av

    with av.open(str(path), "w") as file:
        stream = file.add_stream("libx264", rate=fps)
        stream.width, stream.height, stream.pix_fmt = pictures[0].shape[1], pictures[0].shape[0], "yuv420p"
        for picture in pictures:
            file.mux(stream.encode(av.VideoFrame.from_ndarray(picture, format="rgb24")))
        file.mux(stream.encode())


def test_fast_films_become_footage_of_their_rate(tmp_path):
    lens = replace(read_cameras(asset("cameras", "four.toml"))[0], name="fast").scaled(64)
    mp4(tmp_path / "fast.mp4", [np.zeros((lens.size[1] // 2 * 2, 64, 3), np.uint8)] * 3, 480)
    assert list(imported([tmp_path / "fast.mp4"], [lens], tmp_path / "real")) == [0, 1, 2]
    assert read_footage(tmp_path / "real").fps == 480


def test_real_films_become_footage_and_clicks_begin_a_track(footage, tmp_path):
    """The pictures as films, the first frame's joints as clicks: a body is followed whose truth nobody tells."""
    for lens in footage.lenses:
        mp4(tmp_path / f"{lens.name}.mp4", [footage.picture(lens.name, "frame", number) for number in range(4)], Fraction(30000, 1001))
    films = [tmp_path / f"cam{k}.mp4" for k in (2, 0, 1)]  # named after their cameras
    done = CliRunner().invoke(cli.app, ["footage", *map(str, films), "--cameras", str(footage.path / "cameras.toml"), "-o", str(tmp_path / "real"),
                                        "--name", "Bob"])
    assert done.exit_code == 0 and "3 cameras, 4 frames of Bob" in done.output, done.output
    real = read_footage(tmp_path / "real")
    assert real.people == ("Bob",) and real.fps == Fraction(30000, 1001) and real.frames == 4
    away = np.abs(real.picture("cam0", "frame", 2).astype(int) - footage.picture("cam0", "frame", 2))
    assert away.mean() < 6
    pixels, names = footage.truth()["pixels"][0, :, 0], [str(name) for name in footage.truth()["names"]]
    clicks = "".join(f"[{lens.name}]\n" + "".join(f"{names[j]} = [{x:.1f}, {y:.1f}]\n" for j, (x, y, _) in enumerate(of) if names[j] in CLICKED)
                     for lens, of in zip(footage.lenses, pixels))
    (tmp_path / "clicks.toml").write_text(clicks)
    done = run(tmp_path / "real", "-o", tmp_path / "b.bvh", "--start", tmp_path / "clicks.toml", "--fit", 0)
    assert done.exit_code == 0 and "4 frames of Bob" in done.output, done.output
    clip = load_motion(tmp_path / "b.bvh")
    np.testing.assert_allclose(clip.root[-1], footage.truth()["joints"][3, 0, 0], atol=0.06)
    (tmp_path / "clicks.toml").write_text("[cam0]\nLeftArm = [1, 2]\n")
    one_line(run(tmp_path / "real", "-o", tmp_path / "b.bvh", "--start", tmp_path / "clicks.toml"), "clicks", "two cameras")


CLICKED = {f"{side}{part}" for side in ("Left", "Right") for part in ("Arm", "ForeArm", "Hand", "UpLeg", "Leg", "Foot")} | {"Neck"}


def test_films_that_cannot_be_footage_are_told_in_a_line(footage, tmp_path):
    def make(*films):
        return CliRunner().invoke(cli.app, ["footage", *map(str, films), "--cameras", str(footage.path / "cameras.toml"), "-o", str(tmp_path / "real")])
    (tmp_path / "no.mp4").write_bytes(b"nothing")
    mp4(tmp_path / "small.mp4", [np.zeros((32, 32, 3), np.uint8)] * 2)
    one_line(make(tmp_path / "no.mp4"), "1 films, but 3 cameras")
    one_line(make(*[tmp_path / "no.mp4"] * 3), "no.mp4")
    one_line(make(*[tmp_path / "gone.mp4"] * 3), "gone.mp4")
    one_line(make(*[tmp_path / "small.mp4"] * 3), "small.mp4", "32 × 32", "96 × 96")
    whole = (tmp_path / "small.mp4").read_bytes()
    (tmp_path / "short.mp4").write_bytes(whole[:len(whole) // 2])
    one_line(make(*[tmp_path / "short.mp4"] * 3), "short.mp4", "no film, or one that is cut short")
    for name in ("cam0", "cam1", "other"):
        mp4(tmp_path / f"{name}.mp4", [np.zeros((96, 96, 3), np.uint8)] * 2)
    one_line(make(*[tmp_path / f"{name}.mp4" for name in ("cam1", "cam0", "other")]), "other.mp4", "named after no camera", "without a film: cam2")
