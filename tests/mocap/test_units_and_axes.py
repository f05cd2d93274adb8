"""Units, axes, calibration frames and root offsets are judged rightly, and can be overruled."""

import re
from dataclasses import replace

import numpy as np
import pytest
from motion_samples import AMC, ASF, BVH, standing
from scipy.spatial.transform import Rotation

from gambol.controllers.body import Skeleton
from gambol.controllers.mocap import Detected, MotionFileError, Reading, detect, load, read, standardise, write_bvh
from gambol.controllers.mocap.units_and_axes import LEG_PART, UNITS, unit_of

LYING = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0.0]])  # Y up to Z up


def z_up(clip):
    """The same motion told in axes of which Z points up."""
    skeleton = clip.skeleton
    turned = Skeleton(skeleton.names, skeleton.parents, skeleton.offsets @ LYING.T,
                      skeleton.end_parents, skeleton.end_offsets @ LYING.T)
    quaternions = np.concatenate([clip.quaternions[..., :3] @ LYING.T, clip.quaternions[..., 3:]], -1)
    return replace(clip, skeleton=turned, root=clip.root @ LYING.T, quaternions=quaternions)


@pytest.mark.parametrize("unit", UNITS)
@pytest.mark.parametrize("up", ["y", "z"])
def test_units_and_up_are_found(tmp_path, unit, up):
    clip = standing()
    write_bvh(clip if up == "y" else z_up(clip), tmp_path / "a.bvh", unit=unit)
    found = detect(read(tmp_path / "a.bvh"))
    assert (found.up, found.scale, found.tpose, found.root_offset) == (up, unit, 0, False)
    assert found.stature == pytest.approx(1.741, abs=0.03) and abs(found.floor) < 0.05
    back = load(tmp_path / "a.bvh")
    np.testing.assert_allclose(back.kinematics()[0], clip.kinematics()[0], atol=1e-4)
    np.testing.assert_allclose(back.skeleton.offsets[1:], clip.skeleton.offsets[1:], atol=1e-6)


@pytest.mark.parametrize("up, turn", [("-y", [180, 0, 0]), ("x", [0, 0, -90]), ("-x", [0, 0, 90]), ("-z", [-90, 0, 0])])
def test_any_axis_may_point_up(tmp_path, up, turn):
    """Read as if Y did he stood on his head, or lay."""
    clip, turned = standing(), Rotation.from_euler("xyz", turn, degrees=True).as_matrix()
    skeleton = clip.skeleton
    told = replace(clip, root=clip.root @ turned.T, quaternions=np.concatenate([clip.quaternions[..., :3] @ turned.T, clip.quaternions[..., 3:]], -1),
                   skeleton=Skeleton(skeleton.names, skeleton.parents, skeleton.offsets @ turned.T, skeleton.end_parents, skeleton.end_offsets @ turned.T))
    write_bvh(told, tmp_path / "a.bvh")
    assert detect(read(tmp_path / "a.bvh")).up == up
    np.testing.assert_allclose(load(tmp_path / "a.bvh").kinematics()[0][..., 1], clip.kinematics()[0][..., 1], atol=1e-4)


@pytest.mark.parametrize("turn", [[180, 0, 0], [90, 0, 0], [0, 0, 90], [0, 0, -90]])
def test_who_lies_or_stands_on_his_hands_does_so(turn):
    """The zero pose says which way is up."""
    clip = standing()
    quaternions = clip.quaternions.copy()
    quaternions[:, 0] = (Rotation.from_euler("xyz", turn, degrees=True) * Rotation.from_quat(quaternions[:, 0])).as_quat()
    assert detect(replace(clip, quaternions=quaternions)).up == ("z" if turn == [90, 0, 0] else "y")


@pytest.mark.parametrize("turn", [[90, 0, 0], [75, 0, 0]])
def test_who_crawls_along_z_does_not_walk_up_a_wall(turn):
    """His head is farther along Z than his feet all the time, as of who stands in a file of Z up; but he goes over a floor."""
    clip = standing()
    quaternions, root = clip.quaternions.copy(), clip.root.copy()
    quaternions[:, 0] = (Rotation.from_euler("xyz", turn, degrees=True) * Rotation.from_quat(quaternions[:, 0])).as_quat()
    root[:, 2] += np.linspace(0.0, 2.0, len(root))
    root[:, 1] = 0.4
    assert detect(replace(clip, quaternions=quaternions, root=root)).up == "y"
    root[:, 1:] = np.stack([root[:, 2], root[:, 1]], -1)  # who walks 2 m in a file of Z up has no floor across Y
    assert detect(replace(clip, quaternions=quaternions, root=root)).up == "z"


def test_who_lies_still_on_a_floor_does_not_stand(tmp_path):
    """His head is farther along Z than his feet; but he is as low along Y as who lies, and nowhere near the floor that he would stand on."""
    clip = standing()
    quaternions, root = clip.quaternions.copy(), clip.root.copy()
    quaternions[:, 0] = (Rotation.from_euler("x", 90, degrees=True) * Rotation.from_quat(quaternions[:, 0])).as_quat()
    root[:] = (0.0, 0.25, 0.0)
    lying = replace(clip, quaternions=quaternions, root=root)
    assert detect(lying).up == "y"
    assert detect(replace(lying, root=root + (0.0, 0.0, 0.95))).up == "z"  # his feet are on a floor across Z
    assert detect(replace(lying, root=root - (0.0, 0.25, 0.0))).up == "z"  # half of him would be below a floor across Y
    write_bvh(replace(lying, root=root + (0.0, 0.0, 0.95)), tmp_path / "a.bvh")
    assert np.ptp(Reading("y").load(tmp_path / "a.bvh").kinematics()[0][0, :, 1]) < 0.6  # who knows better says so


def test_a_small_child_in_centimetres_is_one_where_the_unit_is_told(tmp_path):
    """Else its legs are as long as an adult's in inches."""
    child = standing()
    child = replace(child, skeleton=child.skeleton.scaled(0.78 / 1.741), root=child.root * 0.78 / 1.741)
    write_bvh(child, tmp_path / "a.bvh")
    assert detect(read(tmp_path / "a.bvh")).stature == pytest.approx(1.98, abs=0.03)
    for reading in (Reading(unit=0.01), Reading.of(unit="cm"), Reading.of("+Y", " CM "), Reading.of(unit="0.01")):
        assert reading.read(tmp_path / "a.bvh")[1].stature == pytest.approx(0.78, abs=0.02)
        np.testing.assert_allclose(reading.load(tmp_path / "a.bvh").root, child.root, atol=1e-5)


def test_the_unit_of_an_amc_file_is_its_skeletons(tmp_path):
    """The file is read in metres, by what the skeleton says, which may be wrong."""
    (tmp_path / "a.asf").write_text(ASF.replace("name toe", "name foot").replace("shin toe", "shin foot"))
    (tmp_path / "a.amc").write_text(AMC)
    told = Reading.of(unit="in").load(tmp_path / "a.amc").skeleton
    assert np.linalg.norm(told.offsets[2]) == pytest.approx(8 * 0.0254)
    assert np.linalg.norm(Reading.of(unit="cm").load(tmp_path / "a.amc").skeleton.offsets[2]) == pytest.approx(0.08)


@pytest.mark.parametrize("up, unit, says", [("north", None, "up is one of x, y, z"), (None, "parsec", "a unit is m, dm, cm, mm, ft, in or a number of metres above zero, not 'parsec'"),
                                            (None, "0", "not '0'"), (None, "-1", "not '-1'"), (None, "nan", "not 'nan'"), (None, "inf", "not 'inf'"), (None, "", "not ''")])
def test_what_is_no_axis_or_unit_is_told_of(up, unit, says):
    with pytest.raises(ValueError, match=says):
        Reading.of(up, unit)


@pytest.mark.parametrize("scale", [0, -1.0, np.nan, np.inf, "cm"])
def test_a_scale_is_a_length(scale):
    with pytest.raises(ValueError, match="a scale is metres in one unit, above zero, not"):
        detect(standing(), scale=scale)


METRES, INCH = (1.0, 0.01, 0.001), 0.0254


@pytest.mark.parametrize("unit", METRES)
@pytest.mark.parametrize("height", [0.5, 0.6, 0.7, 0.8, 0.85, 1.0, 1.1, 1.5, 2.2, 2.6, 3.0])
def test_the_unit_of_small_and_tall_bodies_is_metric(height, unit):
    """But for who is as tall in centimetres as an adult would be in inches."""
    leg = LEG_PART * height / unit
    assert unit_of(leg) == (INCH if unit == 0.01 and height < 0.83 else unit)


@pytest.mark.parametrize("unit", UNITS)
@pytest.mark.parametrize("height", [1.4, 1.55, 1.741, 1.9, 2.05])
def test_an_adult_is_one_in_any_unit(height, unit):
    assert unit_of(LEG_PART * height / unit) == unit


def with_calibration(clip, count):
    """The clip behind `count` frames of T-pose."""
    still = np.tile([0, 0, 0, 1.0], (count, len(clip.skeleton), 1))
    return replace(clip, quaternions=np.concatenate([still, clip.quaternions]),
                   root=np.concatenate([np.tile(clip.root[0], (count, 1)), clip.root]))


@pytest.mark.parametrize("count", [0, 1, 2])
def test_calibration_frames_are_cut_off(count):
    clip = standing()
    # arms alone move between the T-pose and standing: a human in motion differs more
    clip = replace(clip, quaternions=(Rotation.from_quat(clip.quaternions)
                                      * Rotation.from_rotvec([0.2, 0, 0])).as_quat())
    raw = with_calibration(clip, count)
    assert detect(raw).tpose == count
    assert len(standardise(raw, detect(raw))) == len(clip)
    assert len(standardise(raw, detect(raw, tpose=1))) == len(raw) - 1


def test_a_lone_calibration_frame_stays():
    raw = standing(1)
    assert len(standardise(raw, detect(raw, tpose=1))) == 1


def test_the_root_offset_counts_only_where_it_leads_to_the_floor():
    clip = standing()  # its offset repeats where the hips stand: absolute channels
    assert not detect(clip).root_offset
    relative = replace(clip, root=clip.root - clip.skeleton.offsets[0])
    found = detect(relative)
    assert found.root_offset and abs(found.floor) < 0.05
    np.testing.assert_allclose(standardise(relative, found).root, clip.root, atol=1e-12)
    assert not detect(relative, root_offset=False).root_offset


def test_what_is_given_is_taken_for_granted(tmp_path):
    write_bvh(standing(), tmp_path / "a.bvh")
    clip = load(tmp_path / "a.bvh", up="x", scale=0.5, tpose=3, root_offset=True)
    raw = read(tmp_path / "a.bvh")
    assert len(clip) == len(raw) - 3
    np.testing.assert_allclose(clip.root[:, 1], 0.5 * raw.root[3:, 0], atol=1e-12)
    with pytest.raises(ValueError, match="up is one of"):
        load(tmp_path / "a.bvh", up="north")


def test_what_can_not_be_judged_is_asked_for(tmp_path):
    path = tmp_path / "a.bvh"
    path.write_text(BVH.replace("LeftFoot", "antenna"))
    with pytest.raises(MotionFileError, match="a.bvh: no foot or ankle .*antenna.*LeftFoot"):
        load(path)
    assert load(path, scale=2.0).root[0].tolist() == [2, 4, 6]
    path.write_text(re.sub(r"OFFSET .*", "OFFSET 0 0 0", BVH))
    with pytest.raises(MotionFileError, match="a.bvh: all offsets of its joints are zero"):
        load(path)
    path.write_text(BVH.replace("OFFSET 1 -2 3", "OFFSET 1e9 0 0"))
    with pytest.raises(MotionFileError, match="a leg of .* units is no human's"):
        load(path)


EXPECTED = {  # up, unit, calibration frames, whether the root offset counts
    "woody2/wd2_spiral_walk01.bvh": ("y", 0.0254, 0, False), "woody2/wd2_WalkBackward00.bvh": ("y", 0.01, 0, False),
    "woody2/wd2_Physics_Raise00.bvh": ("y", 0.01, 0, False), "woody2/wd2_idle_65.bvh": ("y", 0.0254, 0, False),
    "woody2/wd2_t-pose.bvh": ("y", 0.01, 0, False), "cmu_30fps/69/69_42.bvh": ("y", 0.01, 0, False),
    "cmu_bvh/07/07_01.bvh": ("y", 0.0254 / 0.45, 1, False), "cmu_bvh/07/07_12.bvh": ("y", 0.0254 / 0.45, 2, False),
    "cmu_bvh/35/35_29.bvh": ("y", 0.0254 / 0.45, 1, False), "cmu/49/49_08.amc": ("y", 1.0, 0, False),
    "cmu/16/16_35.amc": ("y", 1.0, 0, False), "tennis/tennis_KangTennisF15.bvh": ("y", 0.01, 0, False),
    "boxing/boxing_boxman_stand_dir_onetwo.bvh": ("y", 0.0254, 0, False)}


@pytest.mark.parametrize("name", EXPECTED)
def test_recorded_motion_is_judged_rightly(shared, name):
    found = detect(read(shared / "mocap" / name))
    assert (found.up, found.scale, found.tpose, found.root_offset) == EXPECTED[name]


def test_recorded_motion_loads(shared):
    """Every eleventh file of every folder: an adult, on the floor, upright most of the time."""
    files = sorted(path for path in (shared / "mocap").rglob("*") if path.suffix in (".bvh", ".amc"))
    for path in files[::11]:
        found = detect(read(path))
        assert isinstance(found, Detected) and 1.4 < found.stature < 2.1 and abs(found.floor) < 0.2, (path, found)
