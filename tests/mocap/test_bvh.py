"""BVH: what is written is read; every order of turns is scipy's; another reader agrees."""

import itertools
import warnings
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from motion_samples import BVH, named_points, random_clip, seeds, standing
from pymotion.io.bvh import BVH as OtherReader
from pymotion.ops.skeleton import fk
from scipy.spatial.transform import Rotation

from gambol.controllers.mocap import load, read_bvh, retarget, write_bvh
from gambol.controllers.mocap.parsing import parse_number

ORDERS = ["".join(order) for order in itertools.permutations("XYZ")]


@settings(max_examples=40, deadline=None)
@given(seed=seeds, joints=st.integers(1, 9), frames=st.integers(1, 4), order=st.sampled_from(ORDERS),
       unit=st.sampled_from([1.0, 0.01, 0.0254]))
def test_reading_undoes_writing(tmp_path_factory, seed, joints, frames, order, unit):
    path = tmp_path_factory.mktemp("bvh") / "clip.bvh"
    clip = random_clip(seed, joints, frames)
    write_bvh(clip, path, order, unit)
    back = read_bvh(path)
    assert back.frame_time == pytest.approx(clip.frame_time, rel=1e-8)
    (ours, ends), (theirs, other_ends) = named_points(clip), named_points(back)
    assert set(ours) == set(theirs) and len(ends) == len(other_ends)
    for name in ours:
        np.testing.assert_allclose(theirs[name] * unit, ours[name], atol=1e-5)
    for end, other in zip(sorted_points(ends), sorted_points([e * unit for e in other_ends])):
        np.testing.assert_allclose(other, end, atol=1e-5)


def sorted_points(tracks):
    return sorted(tracks, key=lambda track: tuple(np.round(track[0], 3)))


@settings(max_examples=15, deadline=None)
@given(seed=seeds, order=st.sampled_from(ORDERS))
def test_another_reader_sees_the_same_places(tmp_path_factory, seed, order):
    path = tmp_path_factory.mktemp("bvh") / "clip.bvh"
    write_bvh(random_clip(seed, 7, 4), path, order, 0.01)
    assert_agrees_with_another_reader(path)


def test_another_reader_agrees_on_recorded_motion(shared):
    for name in ("woody2/wd2_WalkForwardNormal03.bvh", "woody2/wd2_cross_walk_90d_slow_17.bvh",
                 "cmu_30fps/69/69_12.bvh", "cmu_bvh/07/07_01.bvh"):
        assert_agrees_with_another_reader(shared / "mocap" / name)


def assert_agrees_with_another_reader(path):
    other = OtherReader()
    other.load(str(path))
    rotations, places, parents, offsets, ends, end_parents = other.get_data()
    positions, _ = fk(rotations, places[:, 0], offsets, parents)
    clip = read_bvh(path)
    assert list(clip.skeleton.names) == list(other.data["names"])
    np.testing.assert_array_equal(clip.skeleton.end_parents, end_parents)
    np.testing.assert_allclose(clip.skeleton.end_offsets, np.reshape(ends, (-1, 3)), atol=1e-9)
    # the other reader computes in single precision
    np.testing.assert_allclose(clip.kinematics()[0], positions, atol=1e-6 * np.abs(positions).max() + 1e-5)


@settings(max_examples=40, deadline=None)
@given(orders=st.lists(st.text("XYZ", min_size=0, max_size=3), min_size=2, max_size=2), seed=seeds)
def test_turns_are_scipys_in_any_order_and_number(tmp_path_factory, orders, seed):
    """Proper Euler orders, single axes and joints without channels too; each joint its own."""
    angles = [np.random.default_rng(seed).uniform(-400, 400, len(order)) for order in orders]
    channels = [f"CHANNELS {len(order)} " + " ".join(f"{axis}rotation" for axis in order) for order in orders]
    text = (f"HIERARCHY ROOT a {{ OFFSET 0 1 0 CHANNELS 1 Yposition JOINT b {{ OFFSET 1 2 3 {channels[0]} "
            f"JOINT c {{ OFFSET 0 1 0 {channels[1]} }} }} }}\nMOTION\nFrames: 1\nFrame Time: 0.1\n"
            + "7 " + " ".join(repr(float(a)) for a in np.concatenate(angles)) + "\n")
    path = tmp_path_factory.mktemp("bvh") / "clip.bvh"
    path.write_text(text)
    clip = read_bvh(path)
    np.testing.assert_array_equal(clip.root, [[0, 7, 0]])
    for joint, order, turn in zip((1, 2), orders, angles):
        expected = np.eye(3)
        for axis, angle in zip(order, turn):
            expected = expected @ Rotation.from_euler(axis, angle, degrees=True).as_matrix()
        np.testing.assert_allclose(clip.rotations[0, joint], expected, atol=1e-12)


@given(value=st.floats(allow_nan=False, allow_infinity=False),
       form=st.sampled_from(["{!r}", "{:.6f}", "{:+.3e}", "{:g}", "{:.17g}", "{:.25f}", "{:E}"]))
@settings(max_examples=300, deadline=None)
def test_numbers_are_pythons(value, form):
    text = form.format(value)
    if 0 < abs(float(text)) < 1e-290:  # denormal
        return
    read, behind, good = parse_number(np.frombuffer(text.encode() + b" 7", np.uint8), 0)
    assert behind == len(text) and good == (abs(float(text)) <= 1e15)
    assert not good or read == pytest.approx(float(text), rel=2e-15, abs=1e-300)


@pytest.mark.parametrize("text, good", [
    ("1.", True), (".5", True), ("-0", True), ("1e5", True), ("1.5E-009", True), ("0e999999999", True),
    ("", False), (".", False), ("-", False), ("1e", False), ("1e+", False), ("nan", False), ("inf", False),
    ("1e400", False), ("1e15", True), ("-1.1e15", False), ("1.2.3", False), ("1,5", False), ("0x10", False),
    ("--1", False), ("1_0", False)])
def test_what_is_a_number(text, good):
    assert parse_number(np.frombuffer(text.encode() + b"\n", np.uint8), 0)[2] == good


def test_a_file_is_read_raw(tmp_path):
    clip = read_bvh(written(tmp_path, BVH))
    assert clip.skeleton.names == ("Hips", "LeftFoot") and len(clip) == 2 and clip.frame_time == 0.01
    np.testing.assert_array_equal(clip.root, [[1, 2, 3], [1.5, 2, 3]])
    np.testing.assert_array_equal(clip.skeleton.end_offsets, [[0, -1, 0.5]])
    turn = Rotation.from_euler("ZXY", [-0.4, 0.5, 60], degrees=True).as_matrix()
    np.testing.assert_allclose(clip.rotations[1, 1], turn, atol=1e-12)


@pytest.mark.parametrize("change", [
    lambda text: text.replace("\n", "\r\n"), lambda text: text.replace("\n", "\r"),
    lambda text: "\ufeff" + text, lambda text: text.lower().replace("hips", "Hips").replace("leftfoot", "LeftFoot"),
    lambda text: text + "\n \n\n", lambda text: text.rstrip(), lambda text: text.replace(" ", "\t"),
    lambda text: text.replace("\nROOT Hips\n{", " ROOT Hips{"), lambda text: text.replace("Frames: ", "Frames:")])
def test_dialects_read_the_same(tmp_path, change):
    plain = read_bvh(written(tmp_path, BVH))
    other = read_bvh(written(tmp_path, change(BVH)))
    assert plain.skeleton.names == other.skeleton.names
    np.testing.assert_array_equal(plain.quaternions, other.quaternions)
    np.testing.assert_array_equal(plain.root, other.root)


def test_places_of_other_joints(tmp_path):
    """Constant ones replace the offset, zeros leave it, wandering ones give a median and a warning."""
    text = BVH.replace("CHANNELS 3 ", "CHANNELS 6 Xposition Yposition Zposition ")
    for first, second, expected, warned in (("4 5 6", "4 5 6", (4, 5, 6), False), ("0 0 0",) * 2 + ((1, -2, 3), False),
                                            ("4 5 6", "6 5 6", (5, 5, 6), True)):
        path = written(tmp_path, text.replace("20 30 40", f"20 30 {first} 40").replace(
            "3.0E+1 -4e-1", f"3.0E+1 {second} -4e-1"))
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            clip = read_bvh(path)
        np.testing.assert_array_equal(clip.skeleton.offsets[1], expected)
        assert bool(caught) == warned


def below_a_reference(clip, path, still=False, all_joints=False):
    """Write a clip's BVH with a joint `Reference` over its hips, which stands aside and turned, and leaves all travel to them.

    all_joints: position channels for every joint, as MotionBuilder and Maya have it. still: the reference's own are 0.
    """
    plain = path.with_name("plain.bvh")
    write_bvh(clip, plain)
    head, body = plain.read_text().split("MOTION\n")
    place, turn = np.array([0.0, 0, 0] if still else [120.0, 0, -40]), np.array([0.0, 0, 0] if still else [0.0, 0, 70])
    skeleton = clip.skeleton
    if all_joints:
        head = head.replace("CHANNELS 3 ", "CHANNELS 6 Xposition Yposition Zposition ")
    head = head.replace("ROOT Hips", "JOINT Hips").replace("HIERARCHY\n", "HIERARCHY\nROOT Reference\n{\nOFFSET 0 0 0\n"
                        "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n")
    rows = np.loadtxt(body.splitlines()[2:])
    back = Rotation.from_euler("ZXY", turn, degrees=True).inv()
    rows[:, :3] = back.apply(rows[:, :3] - place)
    rows[:, 3:6] = (back * Rotation.from_euler("ZXY", rows[:, 3:6], degrees=True)).as_euler("ZXY", degrees=True)
    if all_joints:
        offsets = np.tile(skeleton.offsets[1:] * 100, (len(rows), 1, 1))
        turns = rows[:, 6:].reshape(len(rows), -1, 3)
        rows = np.hstack([rows[:, :6], np.concatenate([offsets, turns], -1).reshape(len(rows), -1)])
    rows = np.hstack([np.tile(np.concatenate([place, turn]), (len(rows), 1)), rows])
    path.write_text(head + "}\nMOTION\n" + "\n".join(body.splitlines()[:2]) + "\n"
                    + "\n".join(" ".join(f"{value:.6f}" for value in row) for row in rows) + "\n")


@pytest.mark.parametrize("still", [True, False])
@pytest.mark.parametrize("all_joints", [True, False])
def test_a_body_whose_hips_travel_below_a_reference_walks(tmp_path, still, all_joints):
    """Every joint is where the file says, and what is made of it on Gambol's skeleton is the same walk."""
    clip, path = standing(), tmp_path / "clip.bvh"
    clip.root[:, [0, 2]] += np.linspace([0.0, 0.0], [0.7, 3.0], len(clip))
    below_a_reference(clip, path, still, all_joints)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        back = load(path)
    ours, theirs = named_points(clip)[0], named_points(back)[0]
    for name in ours:
        np.testing.assert_allclose(theirs[name], ours[name], atol=1e-5)
    np.testing.assert_allclose(retarget(back).root, retarget(clip).root, atol=1e-4)


def test_a_walker_that_is_no_human_walks_too(tmp_path):
    """Without names to go by, the body hangs from the first joint that branches."""
    clip, path = random_clip(3, 7, 5), tmp_path / "clip.bvh"
    names = ("Hips", *clip.skeleton.names[1:])
    parents = np.array([-1, 0, 0, 1, 1, 2, 2])
    clip = replace(clip, skeleton=replace(clip.skeleton, names=names, parents=parents))
    below_a_reference(clip, path)
    ours, theirs = named_points(clip)[0], named_points(read_bvh(path))[0]
    for name in ours:
        np.testing.assert_allclose(theirs[name] * 0.01, ours[name], atol=1e-5)


def test_writing_refuses_what_it_can_not_write(tmp_path):
    clip = random_clip(1)
    with pytest.raises(ValueError, match="takes a Clip first, not (Posix|Windows)Path"):
        write_bvh(tmp_path / "a.bvh", clip)
    with pytest.raises(ValueError, match="not 'XYX'"):
        write_bvh(clip, tmp_path / "a.bvh", "XYX")
    clip.root[0, 0] = np.nan
    with pytest.raises(ValueError, match="not finite"):
        write_bvh(clip, tmp_path / "a.bvh")


def written(folder, text):
    path = folder / "clip.bvh"
    path.write_bytes(text.encode())
    return path
