"""Figures are what they say, no take that is told of was learnt from, and a method sees nothing but its own past."""

import sys
from collections import Counter
from dataclasses import replace
from functools import partial
from pathlib import Path, PurePosixPath

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from scipy.stats import bootstrap

from gambol.controllers.body import Pose
from gambol.controllers.reconstruction.control_points import parse
from gambol.controllers.reconstruction.database.database import Database, DatabaseError, Writer
from gambol.controllers.reconstruction.evaluation import metrics, small_of, trials
from gambol.controllers.reconstruction.pose_vector import JOINTS, REFERENCE, SKELETON, WIDTH, decode
from gambol.controllers.reconstruction.regression.method import SPAN

from trajectories import frames as made_up

sys.path.insert(0, str(Path(__file__).parents[2] / "scripts" / "measure"))
COUNT = len(SKELETON)
ACTIONS = ("walk", "run", "jump")
seeds = st.integers(0, 2 ** 31)


@pytest.fixture(scope="module")
def database(tmp_path_factory) -> Database:
    """Three subjects of three actions; one take stands there twice, one has a gap, one was recorded at a lower rate."""
    path, rng = tmp_path_factory.mktemp("motion") / "made.gambolmotion", np.random.default_rng(0)
    with Writer(path) as writer:
        for number in range(36):
            sound = np.ones(100, bool)
            sound[50] = number != 7
            writer.add(f"a/{number:02}", f"subject{number % 3}", ACTIONS[number // 3 % 3], made_up(rng, 100, number % 4), sound,
                       interpolated=number == 8)
        writer.add("b/05", "subject2", "run", made_up(rng, 100, 1), np.ones(100, bool))
        writer.add("c/long", "subject0", "walk", made_up(rng, 400, 0), np.ones(400, bool))
    return Database.open(path)


# ---- figures

@given(seeds)
def test_errors_of_positions_are_mean_distances(seed):
    """Against plain loops; and where the hips are makes no difference once they are aligned."""
    rng = np.random.default_rng(seed)
    found, truth = rng.normal(size=(2, 3, COUNT, 3))
    plain = [np.mean([np.sqrt(sum((found[t, j] - truth[t, j]) ** 2)) for j in JOINTS]) for t in range(3)]
    np.testing.assert_allclose(metrics.position_error(found, truth), plain)
    shift = rng.normal(size=(2, 3, 1, 3))
    np.testing.assert_allclose(metrics.aligned_error(found + shift[0], truth + shift[1]), metrics.aligned_error(found, truth))
    np.testing.assert_allclose(metrics.position_error(truth + shift[0], truth), np.linalg.norm(shift[0][:, 0], axis=-1))


@given(seeds, st.floats(0.0, 3.1))
def test_errors_of_angles_are_what_a_joint_was_turned_by(seed, angle):
    """One of 19 joints turned by an angle about any axis; toes and hips do not count."""
    rng = np.random.default_rng(seed)
    truth = Rotation.random(2 * COUNT, rng).as_matrix().reshape(2, COUNT, 3, 3)
    axis = rng.normal(size=3)
    turn = Rotation.from_rotvec(angle * axis / np.linalg.norm(axis)).as_matrix()
    found, joint = truth.copy(), rng.choice(JOINTS)
    found[1, joint] = found[1, joint] @ turn
    found[:, 0] = found[:, SKELETON.index("LeftToe")] = np.eye(3)
    np.testing.assert_allclose(metrics.angle_error(found, truth), [0.0, angle / np.sqrt(19)], atol=1e-7)


@given(st.integers(0, 56), st.floats(-0.5, 0.5))
def test_errors_of_degrees_of_freedom_are_those_of_the_chart(column, away):
    truth = np.zeros((1, 57))
    found = truth.copy()
    found[0, column] = away
    np.testing.assert_allclose(metrics.column_error(_rotations(found), _rotations(truth)), abs(away) / np.sqrt(57), atol=1e-9)


def _rotations(vectors):
    local = np.tile(np.eye(3), (1, COUNT, 1, 1))
    local[:, JOINTS] = REFERENCE[JOINTS] @ Rotation.from_rotvec(vectors.reshape(-1, 3)).as_matrix()
    return local


@given(seeds, st.floats(0.01, 0.1))
def test_jitter_is_the_third_derivative(seed, dt):
    """Of cubics exactly 6 |c|, whatever comes with them in lower powers."""
    c = np.random.default_rng(seed).normal(size=(4, COUNT, 3))
    t = dt * np.arange(20)[:, None, None]
    path = c[0] + c[1] * t + c[2] * t ** 2 + c[3] * t ** 3
    assert metrics.jitter(path, dt) == pytest.approx(6 * np.linalg.norm(c[3][JOINTS], axis=-1).mean(), rel=1e-4)


@given(seeds, st.floats(-4.0, 4.0))
def test_lag_is_found_to_a_fraction_of_a_frame(seed, late):
    """Of slow motion that comes late or early, and is off by a constant."""
    rng = np.random.default_rng(seed)
    phase, size, away = rng.uniform(0, 6, (COUNT, 3)), rng.normal(size=(COUNT, 3)), rng.normal(size=(COUNT, 3))

    def path(times):
        return size * np.sin(0.1 * times[:, None, None] + phase)
    times = np.arange(200.0)
    assert metrics.lag(path(times - late) + away, path(times)) == pytest.approx(late, abs=0.05)
    assert metrics.lag(path(times[:20] - late), path(times[:20])) == 0.0


def test_intervals_cover_the_mean_as_often_as_they_say():
    rng = np.random.default_rng(0)
    drawn = [metrics.interval(rng.normal(1.0, 2.0, 40), rng, 0.9, 400) for _ in range(400)]
    assert 0.85 < np.mean([low <= 1.0 <= high for low, high in drawn]) < 0.94


def test_intervals_are_those_of_scipy():
    values = np.random.default_rng(1).gamma(2.0, size=22)
    theirs = bootstrap((values,), np.mean, method="percentile", rng=np.random.default_rng(0)).confidence_interval
    np.testing.assert_allclose(metrics.interval(values, np.random.default_rng(0)), theirs, rtol=0.02)


# ---- splits

def _held(split):
    return [*split.test, *split.validation]


def _stem(take):
    return PurePosixPath(take.clip).name


@settings(max_examples=20)
@given(seed=st.integers(0, 1000))
def test_nothing_that_is_held_out_is_learnt(database, seed):
    """No clip, no mirror image, no duplicate; and what is held out is sound and a true recording."""
    split = trials.split(database, 6, 3, seed)
    assert (len(split.test), len(split.validation)) == (6, 3)
    held = {_stem(take) for take in _held(split)}
    assert len(held) == 9
    assert not held & {_stem(take) for take in split.learnt.takes}
    assert not {take.recording for take in _held(split)} & {take.recording for take in split.learnt.takes}
    assert not held & {"05", "07", "08"} and not any(take.mirrored for take in _held(split))
    assert len(split.learnt.takes) == len(database.takes) - 2 * 9
    kinds = Counter((take.action, take.subject) for take in database.takes)
    left = Counter((take.action, take.subject) for take in split.learnt.takes)
    assert all(left[kind] >= count / 2 for kind, count in kinds.items())
    again = trials.split(database, 6, 3, seed)
    assert (again.test, again.validation, again.learnt.takes) == (split.test, split.validation, split.learnt.takes)


def test_splits_differ_by_their_seed_and_say_when_there_is_too_little(database):
    assert trials.split(database, 6, 3, 0).test != trials.split(database, 6, 3, 1).test
    with pytest.raises(DatabaseError, match="takes can be held out, not 99"):
        trials.split(database, 66, 33)


def test_subjects_are_held_out_altogether(database):
    split = trials.split_subjects(database, ["subject1"], 5)
    assert {take.subject for take in split.test} == {"subject1"} and len(split.test) == 5
    assert {take.subject for take in split.learnt.takes} == {"subject0", "subject2"}
    with pytest.raises(DatabaseError, match="no subject 'nobody'"):
        trials.split_subjects(database, ["nobody"])


@settings(max_examples=10)
@given(seed=st.integers(0, 1000))
def test_actions_are_held_out_alike_and_learnt_alike(database, seed):
    """As many takes of each; nothing of them is learnt; the poses of the actions are in balance."""
    avoid = [take for take in database.takes if take.clip == "a/00"]
    split = trials.split_actions(database, 3, 2000, seed, ACTIONS[:2], avoid)
    assert Counter(take.action for take in split.test) == {"walk": 3, "run": 3}
    assert not {_stem(take) for take in split.test} & ({_stem(take) for take in split.learnt.takes} | {"00", "05"})
    poses = Counter()
    for take in split.learnt.takes:
        poses[take.action] += take.stop - take.start
    assert set(poses) == {"walk", "run"} and 2000 <= sum(poses.values()) < 2000 + 2 * 400
    assert abs(poses["walk"] - poses["run"]) <= 2 * 400
    assert Counter(take.clip for take in split.learnt.takes).most_common()[-1][1] == 2, "a mirror image is missing"


def test_long_takes_are_long(database):
    assert [take.clip for take in trials.long_takes(database, 300)] == ["c/long"]
    assert trials.long_takes(database, 300, avoid=[take for take in database.takes if take.clip == "c/long"]) == ()


def test_what_bears_the_same_name_goes_too(database):
    rest = trials.without(database, [take for take in database.takes if take.clip == "a/05"])
    assert not [take for take in rest.takes if _stem(take) == "05"]
    assert len(rest.takes) == len(database.takes) - 4


# ---- trials

class Recorder:
    """A method that answers with the newest pose that it was given, and remembers all it saw."""

    def __init__(self):
        self.seen = []

    def begin(self, frames, tracks):
        self.seen.append((frames.copy(), tracks.copy()))
        return frames[-1], tracks[-1], 1

    def step(self, memory, points):
        frame, track, count = memory
        assert count == len(self.seen), "the memory is not the one returned last"
        root, rotations = decode(frame, track)
        self.seen.append(points.copy())
        return (frame, track, count + 1), Pose(root + points[0], rotations)


def _trial(database, number=0):
    return trials.trial(database, database.takes[number], parse("4", SKELETON))


def test_a_trial_is_the_take(database):
    on = _trial(database)
    assert len(on.frames) == 100 and on.dt == 1 / 60
    np.testing.assert_array_equal(on.frames, database.frames[:100])
    np.testing.assert_array_equal(on.tracks[0], 0.0)
    np.testing.assert_allclose(on.points, on.positions[:, parse("4", SKELETON).joints], atol=1e-12)
    assert len(trials.trial(database, database.takes[-2], parse("2", SKELETON), most=120).frames) == SPAN + 120


def test_a_method_is_given_the_first_frames_and_the_points_alone(database):
    """Whatever the body did after that changes nothing; later points change nothing of earlier poses."""
    on, recorder = _trial(database), Recorder()
    outcome = trials.run(recorder, on)
    np.testing.assert_array_equal(recorder.seen[0][0], on.frames[:SPAN])
    np.testing.assert_array_equal(recorder.seen[0][1], on.tracks[:SPAN])
    np.testing.assert_array_equal(recorder.seen[1:], on.points[SPAN:])
    wrong = on.frames.copy()
    wrong[SPAN:] = np.nan
    blind = replace(on, frames=wrong, tracks=np.where(np.arange(100)[:, None] < SPAN, on.tracks, np.nan),
                    positions=on.positions * np.nan, rotations=on.rotations * np.nan)
    np.testing.assert_array_equal(trials.run(Recorder(), blind).positions, outcome.positions)
    later = on.points.copy()
    later[70:] += 1.0
    other = trials.run(Recorder(), on, later)
    np.testing.assert_array_equal(other.positions[:70 - SPAN], outcome.positions[:70 - SPAN])
    assert np.all(np.abs(other.positions[70 - SPAN:] - outcome.positions[70 - SPAN:]) > 0.9)


def test_the_truth_has_no_error(database):
    on = _trial(database)
    truth = trials.Outcome(on, on.positions[SPAN:], on.rotations[SPAN:])
    np.testing.assert_array_equal(truth.errors, 0.0)


# ---- the script, from end to end

@pytest.fixture(scope="module")
def five(tmp_path_factory) -> Database:
    """A database of the paper's five actions, by three subjects."""
    path, rng = tmp_path_factory.mktemp("five") / "five.gambolmotion", np.random.default_rng(0)
    with Writer(path) as writer:
        for number in range(20):
            action, count = ("walk", "run", "jump", "punch", "swing")[number % 5], 62 + 20 * (number % 5 == 0)
            writer.add(f"take{number:02}", f"subject{number % 2}", action, made_up(rng, count, number % 4), np.ones(count, bool),
                       interpolated=number % 5 > 2)
    return Database.open(path)


@pytest.fixture
def script(monkeypatch, tmp_path):
    """The script with two quick rows and few tries; what it learns is kept apart."""
    import reconstruction as script
    import reconstruction_methods as rivals
    from gambol.controllers.reconstruction.database import store

    monkeypatch.setattr(store, "cache_folder", lambda: tmp_path / "kernels")
    monkeypatch.setattr(rivals, "TRIES", 2)
    for name in set(rivals.RIVALS) - {"LPCR"}:
        monkeypatch.delitem(rivals.RIVALS, name)
    mended = rivals.Rival(partial(rivals.baseline, "mousas"), settings={"ridge": 0.1, "loosening": 100.0})
    monkeypatch.setitem(rivals.RIVALS, "ours", mended)
    return script


def _run(script, monkeypatch, database, tmp_path, *more):
    arguments = [database.path, "--takes", "2", "--cache", tmp_path / "cache", "--out", tmp_path / "out", *more]
    monkeypatch.setattr(sys, "argv", ["measure/reconstruction.py", *map(str, arguments)])
    script.main()


def _rows(text):
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line.startswith("|")]
    return {row[0]: row[1:] for row in cells}


@pytest.mark.parametrize("only", [("table1",), pytest.param((), marks=pytest.mark.thorough)], ids=["table 1", "every section"])
def test_the_script_measures_every_section_once(script, five, monkeypatch, tmp_path, capsys, only):
    """What it prints is what the methods did; started again it learns nothing; a changed setting costs its own row alone."""
    from reconstruction_bench import Bench, Courses
    from reconstruction_methods import RIVALS

    pytest.importorskip("matplotlib")
    sections = only or [name for name in script.SECTIONS if name != "time"]
    chosen = ("--only", ",".join(sections), "--points", "4")
    _run(script, monkeypatch, five, tmp_path, *chosen)
    printed = capsys.readouterr().out
    assert all(f"## {script.SECTIONS[name]}" in printed for name in sections) and "nan" not in printed
    assert only or "No take is that long" in printed
    for name in (*(f"{name}.md" for name in sections), "table1.png", *(() if only else ("figure3_4.png", "figure3_6.png"))):
        assert (tmp_path / "out" / name).stat().st_size > 20

    bench, on = Bench(tmp_path / "other"), Courses(five, five, 2, 0)
    method = bench.learn("LPCR", on.seen, "4")
    error = np.mean([trials.run(method, trial).errors.mean() for trial in bench.trials(on.seen, "4")])
    row = _rows((tmp_path / "out" / "table1.md").read_text().split("### 4 points")[1].split("###")[0])["LPCR"]
    assert float(row[0]) == pytest.approx(100 * error, abs=0.006)

    learnt = []
    learn = Bench.learn
    monkeypatch.setattr(Bench, "learn", lambda self, name, *rest: learnt.append(name) or learn(self, name, *rest))
    _run(script, monkeypatch, five, tmp_path, *chosen)
    assert capsys.readouterr().out == printed and not learnt
    monkeypatch.setitem(RIVALS, "LPCR", replace(RIVALS["LPCR"], settings={**RIVALS["LPCR"].settings, "share": 0.9}))
    _run(script, monkeypatch, five, tmp_path, "--only", "table1", "--points", "4")
    assert learnt == ["LPCR"]
    if not only:
        _run(script, monkeypatch, five, tmp_path, "--only", "time")
        assert "Milliseconds" in capsys.readouterr().out


def test_spoilt_points_are_spoilt_as_told():
    from reconstruction_bench import lost_from, spoilt

    points = np.random.default_rng(0).normal(size=(200, 4, 3))
    np.testing.assert_array_equal(spoilt(points, 0, 0.0, 0.0, 1 / 60), points)
    noisy = spoilt(points, 0, 0.01, 0.0, 1 / 60)
    np.testing.assert_array_equal(noisy[:SPAN], points[:SPAN])
    assert np.std(noisy[SPAN:] - points[SPAN:]) == pytest.approx(0.01, rel=0.05)
    np.testing.assert_array_equal(spoilt(points, 0, 0.01, 0.0, 1 / 60), noisy)
    assert not np.array_equal(spoilt(points, 1, 0.01, 0.0, 1 / 60), noisy)
    torn = np.isnan(spoilt(points, 0, 0.0, 0.5, 1 / 60)).all(-1)
    assert np.all(torn.sum(0) == 30) and not torn[:SPAN].any()
    assert np.array_equal(np.argmax(torn, 0), lost_from(200, 4, 0, 0.5, 1 / 60)) and not torn[-30:].any()
    short = points[:SPAN + 60]
    np.testing.assert_array_equal(spoilt(short, 0, 0.0, 0.5, 1 / 60), short)


def test_the_script_names_what_is_wrong(script, five, database, monkeypatch, tmp_path):
    for wrong, told in ((("--only", "table9"), "no section 'table9'"), (("--points", "7"), "no set of points '7'"),
                        (("--methods", "magic"), "no method 'magic'"), (("--large", database.path), "lacks takes")):
        with pytest.raises(SystemExit, match=told):
            _run(script, monkeypatch, five, tmp_path, *wrong)
    monkeypatch.setattr(sys, "argv", ["measure/reconstruction.py", str(tmp_path / "nothing"), "--cache", str(tmp_path / "cache")])
    with pytest.raises(SystemExit, match="can't be read"):
        script.main()


def test_a_large_database_must_hold_the_small_folder_and_know_what_its_takes_show(tmp_path):
    """Takes are held out by what they show: a database that was told otherwise would hold out others."""
    folder, file = tmp_path / "small", tmp_path / "large.gambolmotion"
    (folder / "a").mkdir(parents=True)
    for name in ("one", "two"):
        (folder / "a" / f"{name}.bvh").touch()
    frames = np.zeros((40, WIDTH))
    with Writer(file) as writer:
        writer.add("a/one", "a", "walk", frames, np.ones(40, bool))
        writer.add("a/two", "a", "other", frames, np.ones(40, bool))
    assert {take.clip for take in small_of(Database.open(file), folder).takes} == {"a/one", "a/two"}
    index = folder / "index.tsv"
    index.write_text("path\taction\na/one.bvh\twalk\n")
    small_of(Database.open(file), folder)
    index.write_text("path\taction\na/two.bvh\trun\n")
    with pytest.raises(DatabaseError, match="a/two is said to show other, but run in .*index.tsv; build it"):
        small_of(Database.open(file), folder)
    (folder / "a" / "three.bvh").touch()
    with pytest.raises(DatabaseError, match="lacks takes of"):
        small_of(Database.open(file), folder)
