"""Films of several cameras: footage that goes on where it was stopped and is read back, and many of them at once."""

import json
from fractions import Fraction

import numpy as np
import pytest
from PIL import Image
from film_set import CAMERAS, SCENARIO, Drawing
from scenarios import written
from stand_in import Glide
from typer.testing import CliRunner

from gambol.controllers.mocap import load as load_motion
from gambol.controllers.tracking.cameras import read_cameras
from gambol.game import cli, hosts
from gambol.game.cli import film_jobs, filming
from gambol.game.footage import FootageError, read_footage
from gambol.game.scenario.scenario import load
from gambol.game.studio import Plan, Sensor, read_sensor, shoot

@pytest.fixture
def plan(tmp_path):
    file = tmp_path / "c.toml"
    file.write_text(CAMERAS + "[sensor]\nnoise = 0.02\ndropped = 0.5\nseed = 3\n")
    return Plan(load(written(tmp_path, SCENARIO)), read_cameras(file), read_sensor(file))


def test_footage_is_filmed_and_read_back(plan, tmp_path):
    stage = Drawing()
    assert list(shoot(plan, tmp_path / "out", Glide(), stage)) == [2, 2, 2, 2]
    footage = read_footage(tmp_path / "out")
    assert footage.people == ("A",) and footage.frames == 4 and footage.fps == 20
    lost = sum(map(len, footage.dropped.values()))
    assert 0 < lost and stage.count == 8 - lost
    truth = footage.truth()
    for c, lens in enumerate(footage.lenses):
        for t in range(4):
            mask, depth, picture = (footage.picture(lens.name, kind, t) for kind in ("mask", "depth", "frame"))
            assert mask.shape == depth.shape == lens.size[::-1] and mask.any()
            assert (picture is None) == (t in footage.dropped[lens.name])
            person = mask == 1
            assert np.isfinite(depth[person]).all()
            box = truth["boxes"][t, c, 0]
            assert box[4] == person.sum() and person[int(box[1]):int(box[3]), int(box[0]):int(box[2])].sum() == box[4]
            pixels, _ = lens.project(truth["joints"][t, 0])
            np.testing.assert_allclose(truth["pixels"][t, c, 0, :, :2], pixels)
        told = json.loads((tmp_path / "out" / lens.name / "coco.json").read_text())
        assert [len(told[k]) for k in ("images", "annotations", "categories")] == [4, 4, 1]
        first = told["annotations"][0]
        assert len(first["keypoints"]) == 51 and first["num_keypoints"] == sum(v > 0 for v in first["keypoints"][2::3]) >= 10
    clip = load_motion(tmp_path / "out" / "motion.bvh")
    assert len(clip) == 4 and clip.frame_time == pytest.approx(0.05)
    np.testing.assert_allclose(clip.kinematics()[0], truth["joints"][:, 0], atol=1e-3)
    assert truth["contacts"].shape == (4, 1, 4)


def test_filming_goes_on_where_it_was_stopped_to_the_same_bytes(plan, tmp_path):
    list(shoot(plan, tmp_path / "whole", Glide(), Drawing()))
    broken = shoot(plan, tmp_path / "parts", Glide(), Drawing())
    next(broken), next(broken)
    broken.close()
    with pytest.raises(FootageError, match="was not filmed to its end"):
        read_footage(tmp_path / "parts")
    stage = Drawing()
    assert list(shoot(plan, tmp_path / "parts", Glide(), stage)) == [0, 0, 2, 2]
    for file in (tmp_path / "whole").rglob("*"):
        if file.is_file() and file.suffix != ".npz":
            assert (tmp_path / "parts" / file.relative_to(tmp_path / "whole")).read_bytes() == file.read_bytes(), file


def test_another_film_is_not_mixed_in(plan, tmp_path):
    list(shoot(plan, tmp_path / "out", Glide(), Drawing()))
    other = Plan(plan.scenario, plan.lenses, Sensor(noise=0.3))
    with pytest.raises(FootageError, match="holds another film"):
        next(shoot(other, tmp_path / "out", Glide(), Drawing()))
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "letter.txt").write_text("dear")
    with pytest.raises(FootageError, match="is not empty"):
        next(shoot(plan, tmp_path / "mine", Glide(), Drawing()))


@pytest.mark.parametrize("field, value, told", [("fps", 0, "fps: needs frames a second"), ("frames", "x", "frames: needs"), ("people", 3, "people: needs"),
                                                ("dropped", {"x": [1]}, "dropped: needs"), ("version", 9, "no footage of this version")])
def test_broken_footage_is_told_of_in_a_line(plan, tmp_path, field, value, told):
    list(shoot(plan, tmp_path / "out", Glide(), Drawing()))
    file = tmp_path / "out" / "footage.json"
    file.write_text(json.dumps(json.loads(file.read_text()) | {field: value}))
    with pytest.raises(FootageError, match=told) as error:
        read_footage(tmp_path / "out")
    assert "\n" not in str(error.value)


def test_broken_pictures_are_told_of(plan, tmp_path):
    list(shoot(plan, tmp_path / "out", Glide(), Drawing()))
    footage = read_footage(tmp_path / "out")
    file = footage.file("front", "mask", 1)
    file.write_bytes(file.read_bytes()[:40])
    with pytest.raises(FootageError, match="mask_00001.png"):
        footage.picture("front", "mask", 1)
    Image.new("L", (10, 10)).save(file)
    with pytest.raises(FootageError, match="10 × 10 pixels, but front has 64 × 48"):
        footage.picture("front", "mask", 1)
    (tmp_path / "out" / "footage.json").write_text("[" * 100_000)
    with pytest.raises(FootageError, match="footage.json: no footage"):
        read_footage(tmp_path / "out")


def test_the_command_films(tmp_path, monkeypatch):
    filmed(monkeypatch)
    file, cameras = written(tmp_path, SCENARIO), tmp_path / "c.toml"
    cameras.write_text(CAMERAS)

    def run(*more):
        return CliRunner().invoke(cli.app, ["film", str(file), "-o", str(tmp_path / "out"), "--cameras", str(cameras), *more])
    done = run()
    assert done.exit_code == 0 and "2 cameras, 4 frames" in done.output
    assert "8 pictures were there already" in run().output
    assert run("--width", "32").exit_code == 2
    slow = run("--fps", "fast")
    assert slow.exit_code == 2 and "--fps: needs frames a second from 1 to 240" in slow.output
    assert run("-o", str(tmp_path / "slower"), "--fps", "23.976").exit_code == 0
    assert read_footage(tmp_path / "slower").fps == Fraction(24000, 1001)
    cameras.write_text("[front]\n")
    broken = run()
    assert broken.exit_code == 2 and "front: is no camera" in broken.output and "Traceback" not in broken.output


def filmed(monkeypatch):
    """Whoever films draws nothing, and steps lightly."""
    class Made(Drawing):
        def __init__(self, size, preset):
            super().__init__()

        def __enter__(self):
            return self

        def __exit__(self, *error):
            pass
    monkeypatch.setattr(film_jobs, "somebody", lambda *_: Glide())
    monkeypatch.setattr(filming, "person_of", lambda *_: None)
    monkeypatch.setattr(hosts, "Offscreen", Made, raising=False)


def contents_of(folder):
    return {str(file.relative_to(folder)): file.read_bytes() for file in sorted(folder.rglob("*")) if file.is_file() and file.suffix != ".npz"}


def test_many_films_are_jobs_and_a_cluster_makes_the_same(tmp_path, monkeypatch):
    """Two scenarios and two seeds, here and by two workers of a local cluster: the same files to the byte."""
    from distributed import LocalCluster

    filmed(monkeypatch)
    one, cameras = written(tmp_path, SCENARIO), tmp_path / "c.toml"
    other = tmp_path / "other.toml"
    other.write_text(one.read_text())
    cameras.write_text(CAMERAS + "[sensor]\nreplaced = 0.1\n")

    def run(out, *more):
        return CliRunner().invoke(cli.app, ["film", str(one), str(other), "--seeds", "2", "-o", str(tmp_path / out), "--cameras", str(cameras), *more])
    done = run("here", "--workers", "1")
    assert done.exit_code == 0 and "4 films, 2 cameras, 16 frames" in done.output
    made = contents_of(tmp_path / "here")
    assert {name.split("/")[0] for name in made} == {f"{file.stem}_seed{k}" for file in (one, other) for k in (0, 1)}
    pictures = [[made[f"{one.stem}_seed{k}/front/{what}_00002.png"] for k in (0, 1)] for what in ("frame", "mask")]
    assert pictures[0][0] != pictures[0][1] and pictures[1][0] == pictures[1][1], "another seed is other noise"
    with LocalCluster(n_workers=2, threads_per_worker=1, processes=False, dashboard_address=None) as cluster:
        done = run("there", "--cluster", cluster.scheduler_address)
    assert done.exit_code == 0, done.output
    assert contents_of(tmp_path / "there") == made
    assert "32 pictures were there already" in run("there", "--workers", "1").output


def test_jobs_that_cannot_be_are_told_in_a_line(tmp_path, monkeypatch):
    filmed(monkeypatch)
    file = written(tmp_path, SCENARIO)
    (tmp_path / "sub").mkdir()
    twin = tmp_path / "sub" / file.name
    twin.write_text(file.read_text())
    done = CliRunner().invoke(cli.app, ["film", str(file), str(twin), "-o", str(tmp_path / "out")])
    assert done.exit_code == 2 and "two films would be called so" in done.output and "Traceback" not in done.output
    done = CliRunner().invoke(cli.app, ["film", "corridr", "-o", str(tmp_path / "out")])
    assert done.exit_code == 2 and "did you mean" in done.output
