"""Footage tracked: from masks and from painted pictures, from the truth's first poses or a file's, and what is said of broken folders."""

import json

import numpy as np
import pytest
from PIL import Image
from scenarios import written
from stand_in import Glide
from test_studio import Drawing
from typer.testing import CliRunner

from gambol.controllers.mocap import load as load_motion
from gambol.controllers.tracking import Tracker
from gambol.controllers.tracking.cameras import read_cameras
from gambol.controllers.tracking.twists import posed
from gambol.game import cli
from gambol.game.meshes import surface_of
from gambol.game.scenario.scenario import load
from gambol.game.studio import (FootageError, Plan, Sensor, error_of, first_poses, followed, overlaid, person_in, read_footage,
                                seen_in, shoot)

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
    one_line(run(footage.path, "-o", out, "--overlay", tmp_path / "film.gif"), "film.gif")
    broken = copied(footage, tmp_path / "one")
    (broken / "truth.npz").write_bytes(b"PK")
    one_line(run(broken, "-o", out), "truth.npz")
    np.savez(broken / "truth.npz", joints=np.zeros((6, 1, 22, 3)))
    one_line(run(broken, "-o", out), "truth.npz", "name a motion file")
    broken = copied(footage, tmp_path / "two")
    (broken / "cam1" / "frame_00003.png").unlink()
    one_line(run(broken, "-o", out), "frame_00003.png")
    Image.new("RGBA", (96, 96)).save(broken / "cam1" / "frame_00003.png")
    one_line(run(broken, "-o", out), "frame_00003.png", "red, green and blue")
    about = json.loads((broken / "footage.json").read_text())
    (broken / "footage.json").write_text(json.dumps(about | {"people": []}))
    one_line(run(broken, "-o", out), "shows nobody")
    (broken / "footage.json").write_text(json.dumps(about | {"complete": False}))
    one_line(run(broken, "-o", out), "not filmed to its end")
    assert not out.exists()


def test_dropped_frames_are_none(footage, tmp_path):
    broken = copied(footage, tmp_path / "one")
    about = json.loads((broken / "footage.json").read_text())
    (broken / "footage.json").write_text(json.dumps(about | {"dropped": {"cam2": [2]}}))
    assert [one is None for one in seen_in(read_footage(broken), 2)] == [False, False, True]
