"""Motion databases: what goes in comes out, unsound frames stay out, and broken files are told of."""

import tracemalloc
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

from gambol.controllers.body.rotations import exp, yaw
from gambol.controllers.locomotion import LibraryError, build_library
from gambol.controllers.mocap import JUDGED, write_bvh
from gambol.controllers.reconstruction import pose_vector as chart
from gambol.controllers.reconstruction.database import default as database_default
from gambol.controllers.reconstruction.database.build_database import build, sound
from gambol.controllers.reconstruction.database.database import HEAD, SUFFIX, Database, DatabaseError, Writer
from trajectories import clip, database, frames

seeds = st.integers(0, 2**32 - 1)


def encoded(one):
    return chart.encode(one.root, one.rotations, one.frame_time)


@settings(max_examples=20)
@given(seeds)
def test_decoding_undoes_encoding(seed):
    one = clip(seed)
    made, track = encoded(one)
    root, rotations = chart.decode(made, track)
    assert np.allclose(root, one.root, atol=1e-9)
    kept = [0, *chart.JOINTS]
    assert np.allclose(rotations[:, kept], one.rotations[:, kept], atol=1e-9)


@settings(max_examples=20)
@given(seeds)
def test_the_rates_add_up_to_the_way(seed):
    one = clip(seed)
    made, track = encoded(one)
    at = track[0]
    for frame in made[1:]:
        at = chart.advance(at, frame, one.frame_time)
    assert np.allclose(at[:2], track[-1, :2], atol=1e-9)
    assert np.allclose(np.exp(1j * at[2]), np.exp(1j * track[-1, 2]), atol=1e-9)


@settings(max_examples=20)
@given(seeds, st.floats(-3, 3), st.floats(-1e3, 1e3))
def test_frames_know_neither_place_nor_heading(seed, turn, away):
    one = clip(seed)
    rotations = one.rotations
    rotations[:, 0] = yaw(turn) @ rotations[:, 0]
    moved, _ = chart.encode(one.root @ yaw(turn).T + [away, 0, -away], rotations, one.frame_time)
    assert np.allclose(moved, encoded(one)[0], atol=1e-7)


@settings(max_examples=20)
@given(seeds)
def test_mirror_images(seed):
    """A mirror image's mirror image is the thing itself, and frames mirror as clips do."""
    one = clip(seed)
    made, _ = encoded(one)
    assert np.array_equal(chart.mirror(chart.mirror(made)), made)
    assert np.allclose(chart.mirror(made), encoded(one.mirror())[0], atol=1e-9)


def test_tilt_and_heading_are_what_scipy_says_they_are():
    heading, tilt = np.linspace(-3, 3, 7), np.array([0.7, -0.4])
    found, pitch_and_roll = chart.yaw_and_tilt(yaw(heading) @ exp([tilt[0], 0.0, tilt[1]]))
    assert np.allclose(found, heading) and np.allclose(pitch_and_roll, tilt)


def test_what_was_written_is_read(tmp_path):
    rng = np.random.default_rng(1)
    made, good = frames(rng, 50, 0), rng.random(50) > 0.2
    with Writer(tmp_path / "a", mirrors=True) as writer:
        writer.add("one/clip", "somebody", "jump", made, good)
    back = Database.open(tmp_path / "a")
    original, image = back.takes
    assert (original.clip, original.subject, original.action, original.stop) == ("one/clip", "somebody", "jump", 50)
    assert image.mirrored and image.recording == original.recording and (image.start, image.stop) == (50, 100)
    assert np.array_equal(back.frames[:50], made.astype(np.float32))
    assert np.array_equal(back.frames[50:], chart.mirror(made).astype(np.float32))
    assert np.array_equal(back.sound, np.tile(good, 2))
    assert np.array_equal(np.concatenate([back.poses, back.root], 1), back.frames)


@settings(max_examples=30)
@given(seeds, st.integers(1, 4), st.integers(1, 5))
def test_segments_stay_within_takes_and_sound_frames(tmp_path_factory, seed, m, stride):
    """All of them, and only those, by looking at every frame of every window."""
    rng = np.random.default_rng(seed)
    path = tmp_path_factory.mktemp("db") / "a"
    with Writer(path, mirrors=False) as writer:
        for number in range(4):
            count = int(rng.integers(1, 40))
            writer.add(str(number), "s", "walk", np.zeros((count, chart.WIDTH)), rng.random(count) > 0.1)
    made = Database.open(path)
    made = made.only(made.takes[1:])
    expected = []
    for take in made.takes:
        for last in range(take.start, take.stop):
            span = np.arange(last - (m - 1) * stride, last + 2)
            if span[0] >= take.start and span[-1] < take.stop and made.sound[span].all():
                expected.append(last)
    assert made.segments(m, stride).tolist() == expected


def test_holding_out_takes_mirror_images_along(tmp_path):
    made = database(tmp_path / "a", takes=6, count=20)
    rest, held = made.hold_out(clips=["clip1"], subjects=["subject2"])
    assert {take.clip for take in held.takes} == {"clip1", "clip2", "clip5"} and len(held.takes) == 6
    assert not {take.recording for take in held.takes} & {take.recording for take in rest.takes}
    assert len(rest) + len(held) == len(made) == 6 * 2 * 20
    with pytest.raises(DatabaseError, match="has no clip 'clip9'"):
        made.hold_out(clips=["clip9"])


def test_opening_maps_and_does_not_read(tmp_path):
    count = 200_000
    with Writer(tmp_path / "a", mirrors=False) as writer:
        writer.add("long", "s", "walk", np.zeros((count, chart.WIDTH), np.float32), np.ones(count, bool))
    tracemalloc.start()
    made = Database.open(tmp_path / "a")
    row = made.frames[count // 2].copy()
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert row.shape == (chart.WIDTH,) and peak < 1_000_000 < made.frames.nbytes / 40


@pytest.mark.parametrize("damage, words", [
    (lambda data: b"BVH" + data[3:], "is no motion database"),
    (lambda data: data[:HEAD], "ends too early"),
    (lambda data: data[:len(data) // 2], "ends too early|damaged"),
    (lambda data: data[:-9] + b"x" + data[-8:], "damaged"),
    (lambda data: data[:HEAD + 4] + data[HEAD + 400:], "another version"),
    (lambda data: b"", "is no motion database"),
])
def test_a_damaged_database_is_told_of(tmp_path, damage, words):
    database(tmp_path / "a", takes=2, count=20)
    (tmp_path / "a").write_bytes(damage((tmp_path / "a").read_bytes()))
    with pytest.raises(DatabaseError, match=words):
        Database.open(tmp_path / "a")


def test_a_build_that_fails_leaves_nothing_behind(tmp_path):
    with pytest.raises(RuntimeError), Writer(tmp_path / "a") as writer:
        writer.add("clip", "s", "walk", np.zeros((5, chart.WIDTH)), np.ones(5, bool))
        raise RuntimeError
    assert not list(tmp_path.iterdir())


@pytest.fixture
def folder(tmp_path):
    made = tmp_path / "mocap"
    (made / "07").mkdir(parents=True)
    (made / "boxing").mkdir()
    write_bvh(clip(1, 41, 30.0), made / "07" / "07_01.bvh")
    write_bvh(clip(2, 80, 120.0), made / "boxing" / "jab_left.bvh")
    (made / "07" / "07_02.bvh").write_text("HIERARCHY\njunk\n")
    write_bvh(clip(3, 3), made / "boxing" / "short.bvh")
    (made / "index.tsv").write_text("path\tfps\taction\n07/07_01.bvh\t30\trun\n")
    return made


def test_a_folder_becomes_a_database(folder, tmp_path):
    told = []
    made = build(folder, tmp_path / "a", progress=lambda *done: told.append(done))
    assert [(t.clip, t.subject, t.action, t.stop - t.start) for t in made.database.takes if not t.mirrored] == \
        [("07/07_01", "07", "run", 81), ("boxing/jab_left", "boxing", "punch", 40)]
    assert len(made.problems) == 2 and "07_02.bvh, line 2" in made.problems[0] and "short.bvh: 3 frames" in made.problems[1]
    assert told == [(1, 4), (2, 4), (3, 4), (4, 4)]
    plain = build(folder, tmp_path / "b", mirrors=False).database
    assert len(made.database) == 2 * len(plain) and not any(take.mirrored for take in plain.takes)


def test_files_are_read_as_told(folder, tmp_path):
    """By the databases' build and by the libraries'."""
    told = []
    reading = SimpleNamespace(load=lambda path: told.append(path.name) or JUDGED.load(path))
    build(folder, tmp_path / "a", reading=reading)
    with pytest.raises(LibraryError, match="usable walking cycles"):
        build_library(folder, reading=reading)
    assert [told.count(path.name) for path in folder.rglob("*.bvh")] == [2] * 4


def test_who_has_a_thigh_of_no_length_is_left_out(folder, tmp_path):
    one = clip(4, 60)
    offsets = one.skeleton.offsets.copy()
    offsets[one.skeleton.index("LeftLeg")] = 0.0
    write_bvh(replace(one, skeleton=replace(one.skeleton, offsets=offsets)), folder / "07" / "07_03.bvh")
    write_bvh(replace(one, frame_time=1e-7), folder / "07" / "07_04.bvh")
    made = build(folder, tmp_path / "a")
    assert len(made.database.takes) == 4 and len(made.problems) == 4
    assert any("07_03.bvh left out: LeftUpLeg has no length" in line for line in made.problems)
    assert any("07_04.bvh: 60 frames in 5.9e-06 s are too few" in line for line in made.problems)


def test_resampling_keeps_rotations(folder, tmp_path):
    """At 30 and at 60 frames a second every other frame is the same pose."""
    slow, fast = (build(folder, tmp_path / str(fps), fps=fps, mirrors=False).database for fps in (30, 60))
    slow, fast = (one.poses[one.takes[0].start:one.takes[0].stop] for one in (slow, fast))
    legs = [3 * k + i for k, joint in enumerate(chart.JOINTS) if "Leg" in chart.SKELETON.names[joint] for i in range(3)]
    assert np.allclose(exp(slow.reshape(-1, 3)), exp(fast[::2].reshape(-1, 3)), atol=2e-3)
    assert np.ptp(slow[:, legs]) > 0.1


def test_jumps_and_impossible_frames_are_unsound():
    one = clip(3, 100)
    made, _ = encoded(one)
    assert sound(one, made).all()
    quaternions = one.quaternions.copy()
    elbow, toe = (chart.SKELETON.index(name) for name in ("LeftForeArm", "LeftToe"))
    quaternions[40:, elbow] = [0, 0, np.sin(0.5), np.cos(0.5)]
    quaternions[60, toe] = [0, 1, 0, 0]
    root = one.root.copy()
    root[80:, 0] += 5.0
    root[90] = [0.0, 30.0, 0.0]
    broken = replace(one, quaternions=quaternions, root=root)
    assert {39, 40, 80, 90} <= set(np.flatnonzero(~sound(broken, encoded(broken)[0]))) <= {39, 40, 80, 90, 91}


@pytest.mark.parametrize("given, words", [
    (["build", __file__], "no .bvh or .amc files in it (it is a file; a folder of them is needed)"),
    (["build", "nowhere"], "no .bvh or .amc files in it (no such folder)"),
    (["build", ".", "-o", "a.bvh"], f"needs a name that ends in {SUFFIX}"),
    (["build", ".", "--fps", "5"], "5 frames a second: a database needs 10 … 240"),
    (["report", "nothing"], "nothing: can't be read: No such file"),
])
def test_mistakes_get_one_line(given, words, tmp_path, monkeypatch):
    from gambol.game import cli

    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(cli.app, ["database", *given])
    assert done.exit_code == 2 and words in done.output and "Traceback" not in done.output
    assert not list(tmp_path.iterdir())


def test_the_command_builds_and_reports(folder, tmp_path):
    from gambol.game import cli

    out = tmp_path / f"made{SUFFIX}"
    done = CliRunner().invoke(cli.app, ["database", "build", str(folder), "-o", str(out)])
    assert done.exit_code == 0 and "07_02.bvh, line 2" in done.output and "2 files or folders left out" in done.output
    done = CliRunner().invoke(cli.app, ["database", "report", str(out), "--takes"])
    assert "242 frames at 60 a second" in done.output and "07/07_01, 07" in done.output


def test_gambols_own_motion_is_the_same_every_time(tmp_path, monkeypatch):
    monkeypatch.setattr(database_default, "_WALKS", {"walk": [(0.5, 1.0, 0, 0)]})
    monkeypatch.setattr(database_default, "_JUMPS", {"jump up": [((0.2, 0, 0, 0), 0.0, 0.48)]})
    for name in "ab":
        database_default.write_own(tmp_path / name)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()
    made = Database.open(tmp_path / "a")
    assert made.sound.all() and [take.action for take in made.takes] == ["walk", "walk", "jump", "jump"]
    jump = made.frames[made.takes[2].start:made.takes[2].stop, chart.HEIGHT]
    assert jump.max() > jump[0] + 0.2


def test_real_recordings(shared, tmp_path):
    """Acclaim and BVH land on the same body: both walk upright on two feet."""
    folder = tmp_path / "mocap"
    for source in ("cmu/07", "cmu_bvh/08"):
        (folder / source).mkdir(parents=True)
        for path in sorted((shared / "mocap" / source).iterdir())[:3]:
            (folder / source / path.name).write_bytes(path.read_bytes())
    made = build(folder, tmp_path / "a").database
    assert {take.subject for take in made.takes} == {"07", "08"}
    for take in made.takes:
        walk = made.frames[take.start:take.stop][made.sound[take.start:take.stop]]
        assert len(walk) > 0.9 * (take.stop - take.start)
        assert 0.85 < walk[:, chart.HEIGHT].mean() < 1.05 and 0.5 < walk[:, chart.FORWARD].mean() < 2.5
