"""The studio: masks and depth as rays meet them, pictures that fit them, seeded disturbances."""


import numpy as np
import pytest
from film_set import CAMERAS, Drawing

from gambol.controllers.body import forward_kinematics, human
from gambol.controllers.tracking.cameras import looking_at, read_cameras
from gambol.game import hosts
from gambol.game.character import Build, tailored
from gambol.game.footage import FootageError
from gambol.game.render import worn
from gambol.game.scene import Box, Figure, Pillar, Scene
from gambol.game.studio import COCO, LensWarp, Sensor, Stage, Truth, coco_points, read_sensor, seen_by

BENT = (-0.2, 0.05, 0.001, 0.002, 0.0)


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


def test_the_truth_is_of_the_body_that_is_seen():
    """Wide shoulders and short arms have their wrists where their own skin is, not where the standard human's would be."""
    lens, standard = looking_at("a", (80, 60), (0.0, 1.2, 5.0), (0, 0.9, 0), 0.7), figure()
    broad = Figure(standard.positions, standard.orientations, body=tailored(Build(child=1.0, shoulders=1.4)))
    truth = Truth([lens], ["broad"])
    truth.add([broad], [seen_by(lens, Stage([lens], []).views[0], [broad])])
    own = worn(broad.body, standard.positions[None], standard.orientations[None])[0][0]
    hand = human().index("LeftHand")
    assert np.array_equal(truth.joints[0][0], own) and np.linalg.norm(own[hand] - standard.positions[hand]) > 0.03
    assert np.allclose(truth.pixels[0][0, 0, hand, :2], lens.project(own[hand])[0])


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


def test_coco_has_its_points():
    pixels = np.tile([3.0, 4.0, 2.0], (22, 1))
    pixels[human().index("LeftHand"), 2] = 0
    points = coco_points(pixels)
    assert len(COCO) == len(points) == 17
    assert (points[:5] == 0).all() and (points[9] == 0).all() and (points[10] == [3, 4, 2]).all()


def test_the_shipped_cameras_are_sound():
    from gambol.assets import path

    lenses = read_cameras(path("cameras", "four.toml"))
    assert len(lenses) == 4 and read_sensor(path("cameras", "four.toml")) == Sensor()
    for lens in lenses:
        at, deep = lens.project(np.array([[0.0, 0.05, 0.0], [0.0, 1.8, 0.0]]))
        assert (deep > 3).all() and ((at > 20) & (at < np.array(lens.size) - 20)).all(), "whoever stands at the origin is seen"
