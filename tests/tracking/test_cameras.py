"""Cameras: rays are the inverse of projection, files keep what they are given, and broken ones are told of in one line."""

import numpy as np
import pytest

from gambol.controllers.tracking.cameras import (CalibrationError, Lens, looking_at, read_cameras, ring, write_opencv,
                                                 write_qualisys)

BENT = (-0.05, 0.14, 0.0006, 0.0007, 0.01)


def lens(distortion=BENT):
    return looking_at("front", (640, 480), (1.0, 1.5, 4.0), (0.0, 1.0, 0.0), 0.8, distortion)


def test_a_pixel_is_where_its_ray_goes():
    camera, rng = lens(), np.random.default_rng(0)
    pixels = rng.uniform([0, 0], [639, 479], (50, 2))
    directions, moments = camera.rays(pixels)
    for far in (0.5, 3.0, 20.0):
        points = camera.eye + far * directions
        back, depth = camera.project(points)
        np.testing.assert_allclose(back, pixels, atol=1e-8)
        assert np.all(depth > 0)
        np.testing.assert_allclose(np.cross(points, directions), moments, atol=1e-11)  # eq. (11)


def test_distortion_is_brown_s():
    """Against the formula as OpenCV's documents print it."""
    camera, point = lens(), np.array([0.4, 1.7, 0.3])
    x, y, z = camera.rotation @ point + camera.translation
    x, y = x / z, y / z
    r2, (k1, k2, p1, p2, k3) = x * x + y * y, BENT
    radial = 1 + k1 * r2 + k2 * r2**2 + k3 * r2**3
    u = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)
    v = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y
    np.testing.assert_allclose(camera.project(point)[0], (camera.matrix @ [u, v, 1])[:2], atol=1e-10)


def test_what_is_far_outside_never_folds_back_into_the_picture():
    camera = lens((-0.4, 0.0, 0.0, 0.0, 0.0))  # r (1 − 0.4 r²) comes back to 0
    right = camera.rotation[0]
    ahead = camera.eye + camera.rotation[2] * 2.0
    across = [camera.project(ahead + right * k)[0][0] for k in (1.0, 2.0, 4.0, 8.0)]
    assert np.all(np.diff(across) > 0)


def test_it_looks_at_its_target_upright():
    camera = lens((0, 0, 0, 0, 0))
    np.testing.assert_allclose(camera.project(np.array([0.0, 1.0, 0.0]))[0], [319.5, 239.5], atol=1e-9)
    assert camera.project(np.array([0.0, 1.5, 0.0]))[0][1] < 239.5
    np.testing.assert_allclose(camera.eye, [1.0, 1.5, 4.0], atol=1e-12)


def test_smaller_pictures_see_the_same():
    camera = lens()
    half = camera.scaled(320)
    pixel = camera.project(np.array([0.3, 1.2, 0.4]))[0]
    np.testing.assert_allclose((half.project(np.array([0.3, 1.2, 0.4]))[0] + 0.5) * 2 - 0.5, pixel, atol=1e-9)
    assert half.size == (320, 240)


@pytest.mark.parametrize("name, write", [("a.toml", write_opencv), ("a.qca.txt", write_qualisys)])
def test_files_keep_cameras(tmp_path, name, write):
    cameras = [*ring(4, 4.0, 1.5, (0.0, 1.0, 0.0), (640, 480), 0.7), lens()]
    write(cameras, tmp_path / name)
    back = read_cameras(tmp_path / name)
    assert [c.name for c in back] == [c.name for c in cameras] and [c.size for c in back] == [c.size for c in cameras]
    for was, is_now in zip(cameras, back):
        np.testing.assert_allclose(is_now.numbers, was.numbers, atol=1e-9)


def test_a_camera_that_keeps_a_part_of_its_picture_sees_the_same_there(tmp_path):
    """Qualisys's field of view: its pixels are counted from its own corner, its lens from the whole sensor's."""
    file = tmp_path / "part.qca.txt"
    write_qualisys([lens()], file)
    text = file.read_text()
    assert 'sensorMaxU="40896.0" sensorMaxV="30656.0"' in text  # the last pixel's, in 64ths
    file.write_text(text.replace('left="0" top="0" right="639" bottom="479"', 'left="100" top="50" right="499" bottom="349"'))
    part, = read_cameras(file)
    assert part.size == (400, 300)
    points = np.random.default_rng(2).uniform(-0.5, 1.5, (20, 3))
    np.testing.assert_allclose(part.project(points)[0], lens().project(points)[0] - [100.0, 50.0], atol=1e-6)


def test_a_real_calibration_is_read(shared):
    """Qualisys's, of a treadmill: all four cameras see its corner, and a body that stands a metre high there."""
    cameras = read_cameras(shared / "multiview" / "calibration" / "Calib.qca.txt")
    assert [c.name for c in cameras] == ["cam01", "cam02", "cam03", "cam04"]
    for camera in cameras:
        assert camera.size == (1088, 1920)
        foot, deep = camera.project(np.array([-1.0, 0.1, 0.1]))
        top, _ = camera.project(np.array([-1.0, 1.8, 0.1]))
        assert 2 < deep < 6 and np.all((foot > 0) & (foot < camera.size)) and top[1] < foot[1]


def test_z_up_files_are_turned(tmp_path):
    file = tmp_path / "z.toml"
    file.write_text('[metadata]\nup = "z"\n[a]\nsize = [64, 48]\neye = [3, -4, 2]\ntarget = [0, 0, 1]\nfov = 40\n')
    np.testing.assert_allclose(read_cameras(file)[0].eye, [3, 2, 4], atol=1e-12)


GOOD = 'size = [64, 48]\neye = [0, 1, 4]\ntarget = [0, 1, 0]\nfov = 40\n'


@pytest.mark.parametrize("text, told", [
    ("", "has no camera"), ("[a]\n" + GOOD.replace("[64, 48]", "[64, 4]"), "a.size: needs a width and a height from 16"),
    ("[a]\nsize = [64, 48]\n", "a.rotation: is missing"), ("[a]\n" + GOOD + "matrix = 3\n", "a.eye: a camera has either"),
    ("[a]\n" + GOOD.replace("40", "nan"), "a.fov: needs a finite number"), ("[a]\n" + GOOD.replace("40", "200"), "a.fov: needs 0.6 to 160"),
    ("[a]\n" + GOOD.replace("[0, 1, 0]", "[0, 1, 4]"), "a.target: is where the camera is"), ("[a]\n" + GOOD + "zoom = 3\n", "a.zoom: there is no such field"),
    ("[a]\n" + GOOD + 'name = "../b"\n', "a.name: folders are named after it"), ("[a]\n" + GOOD + "distortions = [1]\n", "a.distortions: needs 4 or 5"),
    ("[a]\n" + GOOD + "fisheye = true\n", "a.fisheye"), ("[a]\n" + GOOD + '[b]\nname = "a"\n' + GOOD, "need different names; twice: a"),
    ("[a\n", "not TOML"), ('[metadata]\nup = "x"\n[a]\n' + GOOD, "metadata.up"), ("[a]\nlens = 3\n", "a: is no camera"),
    ("[a]\nsize = [64, 48]\nrotation = [0, 0, 0]\ntranslation = [0, 0, 4]\nmatrix = [[50, 9, 32], [0, 50, 24], [0, 0, 1]]\n", "a.matrix: needs .fx 0 cx")])
def test_broken_toml_is_told_of_in_a_line(tmp_path, text, told):
    file = tmp_path / "c.toml"
    file.write_text(text)
    with pytest.raises(CalibrationError, match=told) as error:
        read_cameras(file)
    assert str(error.value).startswith(str(file)) and "\n" not in str(error.value)


def test_broken_qualisys_files_are_told_of_in_a_line(tmp_path):
    whole = tmp_path / "whole.txt"
    write_qualisys([lens()], whole)
    text = whole.read_text()
    for change, told in (((text[: len(text) // 2]), "neither a .toml file nor Qualisys"), (text.replace("r11=", "q11="), "transform.r11: is missing"),
                         (text.replace('r11="', 'r11="9'), "no rotation"), (text.replace('focalLengthU="', 'focalLengthU="x'), "intrinsic.focalLengthU"),
                         ('<!DOCTYPE a [<!ENTITY b "c">]><a>&b;</a>', "document type"), ("<a/>", "has no camera")):
        file = tmp_path / "broken.txt"
        file.write_text(change)
        with pytest.raises(CalibrationError, match=told) as error:
            read_cameras(file)
        assert str(error.value).startswith(str(file)) and "\n" not in str(error.value)


@pytest.mark.parametrize("field, value", [("matrix", np.eye(4)), ("rotation", -np.eye(3)), ("translation", np.full(3, np.nan)), ("size", (4, 4))])
def test_a_lens_is_sound(field, value):
    good = {"name": "a", "size": (64, 48), "matrix": np.eye(3), "rotation": np.eye(3), "translation": np.zeros(3), "distortion": np.zeros(5)}
    with pytest.raises(ValueError, match=field):
        Lens(**good | {field: value})
