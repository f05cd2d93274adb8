"""The studio: masks and depth as rays meet them, pictures that fit them, seeded disturbances, footage that goes on and is read back."""

import json

import numpy as np
import pytest
from PIL import Image
from scenarios import written
from stand_in import Glide
from typer.testing import CliRunner

from gambol.controllers.body import forward_kinematics, human
from gambol.controllers.mocap import load as load_motion
from gambol.controllers.tracking.cameras import looking_at, read_cameras
from gambol.game import cli, hosts
from gambol.game.cli import film_jobs, filming
from gambol.game.footage import FootageError, read_footage
from gambol.game.scenario.scenario import load
from gambol.game.scene import Box, Figure, Pillar, Scene
from gambol.game.studio import COCO, LensWarp, Plan, Sensor, Stage, coco_points, read_sensor, seen_by, shoot

SCENARIO = """
title = "Short"
duration = 0.2
fps = 20
[[actors]]
name = "A"
moves = [{ for = 1.0, velocity = [1, 0, 0] }]
[[props]]
kind = "box"
centre = [0.4, 0.4, 0.8]
size = [0.3, 0.8, 0.3]
heading = 30
"""
CAMERAS = """
[front]
size = [64, 48]
eye = [0.2, 1.2, 5.0]
target = [0, 0.9, 0]
fov = 40
[side]
size = [48, 64]
eye = [4.0, 1.4, 0.5]
target = [0, 0.9, 0]
fov = 50
distortions = [-0.2, 0.05, 0.001, 0.002]
"""
BENT = (-0.2, 0.05, 0.001, 0.002, 0.0)


class Drawing:
    """A stage that draws where in its picture each pixel is, and counts."""

    def __init__(self):
        self.size, self.count = (16, 16), 0

    def resize(self, size):
        self.size = size

    def frame(self, scene):
        self.count += 1
        width, height = self.size
        out = np.zeros((height, width, 4), np.uint8)
        out[..., 0] = np.linspace(0, 255, width).astype(np.uint8)
        out[..., 1] = np.linspace(0, 255, height).astype(np.uint8)[:, None]
        return out


def figure(at=(0.0, 0.0, 0.0)):
    skeleton = human()
    positions, orientations = forward_kinematics(skeleton, skeleton.offsets[0] + at, np.broadcast_to(np.eye(3), (len(skeleton), 3, 3)).copy())
    return Figure(positions, orientations)


def rays(lens):
    grid = np.stack(np.meshgrid(np.arange(lens.size[0]), np.arange(lens.size[1])), -1).astype(float)
    return lens.directions(grid)


def near_a_change(mask):
    out = np.zeros_like(mask)
    for axis in (0, 1):
        change = np.diff(mask.astype(int), axis=axis, append=np.take(mask, [-1], axis).astype(int)) != 0
        out |= change | np.roll(change, 1, axis)
    return out


@pytest.mark.parametrize("distortion", [(0.0,) * 5, BENT])
@pytest.mark.parametrize("prop", [Box((0.2, 0.5, 0.0), (0.6, 1.0, 0.8), 0.5), Box((0.0, 0.6, 0.0), (0.6, 0.4, 1.0), -0.4, slope=0.3),
                                  Pillar((0.1, 0.2, 0.3), 0.4, 1.3)], ids=["box", "ramp", "pillar"])
def test_depth_of_solids_is_what_rays_meet(prop, distortion):
    """Analytic: slabs, pushed aslant for a ramp, and a cylinder; the floor's plane elsewhere."""
    lens = looking_at("a", (96, 72), (1.5, 1.6, 3.0), (0, 0.5, 0), 0.7, distortion)
    got, ways = Stage([lens], [prop]).views[0].depth, rays(lens)
    eye = lens.eye
    with np.errstate(divide="ignore", invalid="ignore"):
        if isinstance(prop, Box):
            c, s = np.cos(prop.heading), np.sin(prop.heading)
            turn = np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]])
            start, along = turn @ (eye - prop.centre), ways @ turn.T
            start[1] -= prop.slope * start[2]
            along[..., 1] -= prop.slope * along[..., 2]
            half = 0.5 * np.array(prop.size)
            first, last = (-half - start) / along, (half - start) / along
            near, far = np.minimum(first, last).max(-1), np.maximum(first, last).min(-1)
            far_off = np.where((near < far) & (near > 0), near, np.inf)
        else:
            d, e = ways[..., [0, 2]], eye[[0, 2]] - [prop.foot[0], prop.foot[2]]
            a, b, q = (d * d).sum(-1), d @ e, e @ e - prop.radius**2
            wall = (-b - np.sqrt(b * b - a * q)) / a
            high = eye[1] + wall * ways[..., 1]
            wall = np.where((high >= prop.foot[1]) & (high <= prop.foot[1] + prop.height), wall, np.inf)
            lid = (prop.foot[1] + prop.height - eye[1]) / ways[..., 1]
            on_lid = np.linalg.norm(e + lid[..., None] * d, axis=-1) <= prop.radius
            far_off = np.fmin(wall, np.where(on_lid & (lid > 0), lid, np.inf))
        floor = np.where(ways[..., 1] < 0, -eye[1] / ways[..., 1], np.inf)
        want = np.fmin(far_off, floor) * (ways @ lens.rotation[2])
    solid = far_off < floor
    inner = ~near_a_change(solid) & np.isfinite(want)
    assert solid.sum() > 300
    off = np.abs(got[inner] - want[inner])
    assert np.percentile(off, 97) < 0.02 and np.median(off) < 0.004
    assert (np.isfinite(got) == np.isfinite(want))[~near_a_change(solid)].all()


def test_who_covers_a_pixel_and_what_hides_whom():
    lens = looking_at("a", (80, 60), (0.0, 1.2, 5.0), (0, 0.9, 0), 0.7)
    wall = Box((0.0, 0.5, 1.5), (4.0, 1.0, 0.1))
    still = Stage([lens], [wall]).views[0]
    mask, depth = seen_by(lens, still, [figure(), figure((0.0, 0.0, -1.0)), figure((0.9, 0.0, 0.5))])
    assert set(np.unique(mask)) <= {0, 1, 2, 3} and {1, 3} <= set(np.unique(mask))
    assert (mask == 1).sum() > 5 * (mask == 2).sum(), "the second one stands behind the first"
    assert np.all(depth[mask == 1] > 4.0) and not mask[depth < 3.7].any(), "the wall hides legs"
    ghost = Figure(figure().positions, figure().orientations, opacity=0.5)
    assert not seen_by(lens, still, [ghost])[0].any()


def test_a_warped_picture_is_where_the_lens_looks():
    """The renderer's picture says where in it each pixel is: the lens's own has to agree with its rays."""
    lens = looking_at("a", (96, 72), (0.0, 1.0, 4.0), (0.3, 0.9, 0.0), 0.8, BENT)
    warp, stage = LensWarp(lens), Drawing()
    stage.resize(warp.size)
    picture = warp.bent(stage.frame(None))
    ahead = rays(lens) @ lens.rotation.T
    focal = 0.5 * warp.size[1] / np.tan(0.5 * warp.camera.fov)
    want = 255 * (ahead[..., 0] / ahead[..., 2] * focal + 0.5 * warp.size[0] - 0.5) / (warp.size[0] - 1)
    assert np.abs(picture[..., 0].astype(float) - want).max() < 2.0
    with pytest.raises(ValueError, match="camera a: sees more than 72° aside"):
        LensWarp(looking_at("a", (960, 96), (0, 1, 4), (0, 1, 0), 1.2))


def test_pictures_fit_their_masks():
    """Drawn by OpenGL before the sky, through a bent lens: what is no sky is the mask, but for its edge."""
    try:
        stage = hosts.Offscreen((16, 16), "fast")
    except hosts.GraphicsError as error:
        pytest.skip(str(error))
    lens = looking_at("a", (160, 120), (0.6, 0.25, 3.0), (0, 1.25, 0), 0.7, BENT)
    warp, who = LensWarp(lens), figure()
    with stage:
        stage.resize(warp.size)
        with_, without = (warp.bent(stage.frame(Scene(warp.camera, people))).astype(int) for people in ((who,), ()))
    mask, _ = seen_by(lens, Stage([lens], []).views[0], [who])
    sky = rays(lens)[..., 1] > 0.02
    seen = np.abs(with_ - without).max(-1) > 12
    inner = sky & ~near_a_change(mask > 0)
    assert (mask > 0)[inner].sum() > 500
    assert (seen[inner] == (mask > 0)[inner]).mean() > 0.995


def test_disturbances_are_seeded_and_as_many_as_asked():
    sensor, picture = Sensor(replaced=0.15, rectangles=2, corrupted=0.1, dropped=0.2, light=0.3, noise=0.05, seed=7), np.full((60, 80, 3), 128, np.uint8)
    again = sensor.disturbed(picture, 1, 5, 0.1)
    np.testing.assert_array_equal(sensor.disturbed(picture, 1, 5, 0.1), again)
    assert np.any(sensor.disturbed(picture, 2, 5, 0.1) != again)
    assert np.any(Sensor(**sensor.model_dump() | {"seed": 8}).disturbed(picture, 1, 5, 0.1) != again)
    np.testing.assert_array_equal(Sensor().disturbed(picture, 0, 3, 0.0), picture)
    only = Sensor(replaced=0.15).disturbed(np.zeros((200, 200, 3), np.uint8), 0, 3, 0.0)
    assert (only.max(-1) > 0).mean() == pytest.approx(0.15, abs=0.01)
    fates = [sensor.fate(c, t) for c in range(10) for t in range(2, 202)]
    assert fates.count("dropped") / 2000 == pytest.approx(0.2, abs=0.03)
    assert fates.count("corrupted") / 2000 == pytest.approx(0.08, abs=0.02)
    assert {sensor.fate(c, t) for c in range(30) for t in (0, 1)} == {"kept"}, "a track begins somewhere"


@pytest.mark.parametrize("text, told", [("noise = 2", "sensor.noise: .*less than or equal to 1, not 2"), ("nois = 1", "sensor.nois: there is no such field; did you mean noise"),
                                        ("seed = -1", "sensor.seed"), ("light = nan", "sensor.light"), ("rectangles = 1.5", "sensor.rectangles")])
def test_a_wrong_sensor_is_told_of(tmp_path, text, told):
    file = tmp_path / "c.toml"
    file.write_text(CAMERAS + "[sensor]\n" + text)
    with pytest.raises(FootageError, match=told) as error:
        read_sensor(file)
    assert str(error.value).startswith(str(file)) and "\n" not in str(error.value)


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


@pytest.mark.parametrize("field, value, told", [("fps", 0, "fps: needs a whole"), ("frames", "x", "frames: needs"), ("people", 3, "people: needs"),
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


def test_coco_has_its_points():
    pixels = np.tile([3.0, 4.0, 2.0], (22, 1))
    pixels[human().index("LeftHand"), 2] = 0
    points = coco_points(pixels)
    assert len(COCO) == len(points) == 17
    assert (points[:5] == 0).all() and (points[9] == 0).all() and (points[10] == [3, 4, 2]).all()


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


def test_the_shipped_cameras_are_sound():
    from gambol.assets import path

    lenses = read_cameras(path("cameras", "four.toml"))
    assert len(lenses) == 4 and read_sensor(path("cameras", "four.toml")) == Sensor()
    for lens in lenses:
        at, deep = lens.project(np.array([[0.0, 0.05, 0.0], [0.0, 1.8, 0.0]]))
        assert (deep > 3).all() and ((at > 20) & (at < np.array(lens.size) - 20)).all(), "whoever stands at the origin is seen"
