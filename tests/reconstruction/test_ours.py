"""Our method: what it learns, what it remembers of its errors, that it keeps on disk what it should, and harms nobody."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from trajectories import calm_database, played

from gambol.controllers.body import forward_kinematics
from gambol.controllers.reconstruction.baselines.windows import Samples
from gambol.controllers.reconstruction.control_points import parse
from gambol.controllers.reconstruction.database import store
from gambol.controllers.reconstruction.database.database import DatabaseError
from gambol.controllers.reconstruction.evaluation import metrics
from gambol.controllers.reconstruction.neighbours.cells import Cells
from gambol.controllers.reconstruction.neighbours.segments import Segments
from gambol.controllers.reconstruction.ours import combined, networks
from gambol.controllers.reconstruction.ours.lost_points import LostPoints
from gambol.controllers.reconstruction.ours.networks import (
    LAGS, WORLD, Networks, draw, learn, misfit, placed, seen_from, view)
from gambol.controllers.reconstruction.ours.combined import (FADING, HEARD, KEPT, LASTING, LISTENED, NARROW, NEAR, NEARER,
                                                         Expectation, Ours, Torn, cells, ours)
from gambol.controllers.reconstruction.pose_vector import (FORWARD, HEIGHT, JOINTS, LEFTWARD, SKELETON, WIDTH, YAW_RATE,
                                                           advance, decode)
from gambol.controllers.reconstruction.regression.map_solver import Solver
from gambol.controllers.reconstruction.regression.method import SPAN, Fused, Local, LocalRegression, Method, posed

DT = 1 / 60
GROUNDS = st.tuples(st.floats(-9, 9), st.floats(-9, 9), st.floats(-3, 3)).map(np.array)


@pytest.fixture(scope="module")
def world(tmp_path_factory):
    """A database of calm, made-up motion; a solver for four points; samples."""
    database = calm_database(tmp_path_factory.mktemp("motion") / "made.gambolmotion")
    solver = Solver(parse("4", SKELETON), DT)
    return database, solver, Samples.of(database, solver)


@pytest.fixture(scope="module")
def method(world):
    """Ours with a small network that has learnt that motion."""
    networks = learn(world[2], seeds=1, batches=1100, hidden=(128, 128))
    return Ours(Method(Fused((Expectation(networks, LostPoints.of(world[2]), DT),)), world[1]))


@pytest.fixture(scope="module")
def performance(world):
    """A take of the database somewhere in the world: frames, tracks, joints and points."""
    database, solver, _ = world
    take = database.takes[2]
    frames, tracks = database.frames[take.start:take.start + 150].astype(float), [np.array([5.0, -3.0, 2.0])]
    for frame in frames[1:]:
        tracks.append(advance(tracks[-1], frame, DT))
    positions, orientations = forward_kinematics(SKELETON, *decode(frames, np.stack(tracks)))
    return frames, np.stack(tracks), positions, solver.controls.on(positions, orientations)


def run(method, performance, points, start=SPAN):
    """`played` from frame `start` on."""
    return played(method, performance, points, start)


@given(GROUNDS, GROUNDS, st.integers(0, 99))
def test_grounds_are_left_and_reached_again(one, other, seed):
    """There and back is nothing, and the body stays where it is in the world."""
    pose = np.random.default_rng(seed).normal(0, 0.5, WIDTH)
    there = seen_from(other, pose, one)
    assert np.allclose(seen_from(one, there, other), pose)
    roots = [decode(seen_from(WORLD, p, g), seen_from(WORLD, p, g)[[LEFTWARD, FORWARD, YAW_RATE]]) for p, g in ((pose, one), (there, other))]
    assert np.allclose(roots[0][0], roots[1][0]) and np.allclose(roots[0][1], roots[1][1])


@given(GROUNDS, GROUNDS, st.integers(0, 99))
@settings(max_examples=30, deadline=None)
def test_what_is_compiled_for_one_pose_is_the_plain_form(one, other, seed):
    pose = np.random.default_rng(seed).normal(size=WIDTH)
    off = combined._seen_from(one, pose, other) - seen_from(one, pose, other)
    off[YAW_RATE] = np.sin(off[YAW_RATE])  # ±π is the same heading
    np.testing.assert_allclose(off, 0.0, atol=1e-9)
    root, rotations = decode(pose, one)
    quick = posed(pose, one)
    np.testing.assert_allclose(quick.root, root, atol=1e-9)
    np.testing.assert_allclose(quick.rotations, rotations, atol=1e-9)


def test_one_input_is_seen_as_many_are(world):
    networks = learn(world[2], batches=5, hidden=(16, 32))
    inputs, _ = draw(world[2], np.arange(7))
    np.testing.assert_allclose([networks.predict(one) for one in inputs], networks.predict(inputs), atol=1e-4)


@given(GROUNDS, st.integers(0, 99))
def test_what_is_seen_depends_neither_on_place_nor_heading(ground, seed):
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(len(LAGS), 4, 3))
    moved = networks.in_world(points, np.broadcast_to(ground, (len(LAGS), 3)))
    assert np.allclose(view(points, np.float64(0.3))[0], view(moved, 0.3 + ground[2])[0])


@pytest.mark.parametrize("rng", [None, np.random.default_rng(3)])
def test_samples_show_the_points_of_the_pose_to_be_learnt(world, rng):
    _, solver, samples = world
    inputs, poses = draw(samples, np.arange(0, len(samples), 11), rng)
    newest, plain = inputs.reshape(len(poses), len(LAGS), 4, 3)[:, 0], Solver(solver.controls, 1.0)
    assert np.allclose([plain.points(pose)[0] for pose in poses], newest, atol=1e-5)


def test_the_misfit_is_derived_rightly(world):
    """Against differences; nothing where there is no error; and it is the distances and angles that it says."""
    rng = np.random.default_rng(0)
    truth = draw(world[2], np.array([40, 500, 900]))[1]
    found = truth + rng.normal(0, 0.1, truth.shape)
    loss, slopes = misfit(found, truth)
    steps = 1e-6 * np.eye(found.size).reshape(-1, *found.shape)
    told = np.array([(misfit(found + s, truth)[0] - misfit(found - s, truth)[0]) / 2e-6 for s in steps])
    assert np.allclose(told, slopes.ravel(), atol=1e-5)
    assert misfit(truth, truth)[0] == 0.0 and not misfit(truth, truth)[1].any()
    places = [forward_kinematics(SKELETON, *decode(p, p[:, [LEFTWARD, FORWARD, YAW_RATE]]))[0][:, JOINTS] for p in (found, truth)]
    apart = np.sum((places[0] - places[1]) ** 2) / networks.DISTANCE ** 2
    turned = np.sum((np.delete(found - truth, [HEIGHT, YAW_RATE, FORWARD, LEFTWARD], 1) / networks.ANGLE) ** 2)
    assert np.isclose(loss, 0.5 * (apart + turned) / (3 * len(JOINTS)))


def test_the_same_seed_learns_the_same(world, tmp_path):
    samples = world[2]
    one, two = (learn(samples, seeds=2, batches=5, hidden=(16,)) for _ in range(2))
    inputs = draw(samples, np.arange(7))[0]
    assert np.array_equal(one.predict(inputs), two.predict(inputs)) and np.array_equal(one.errors, two.errors)
    assert not np.array_equal(one.members[0].predict(inputs), one.members[1].predict(inputs))
    one.save(tmp_path / "networks")
    again = Networks.load(tmp_path / "networks")
    assert np.array_equal(again.predict(inputs), one.predict(inputs)) and np.array_equal(again.errors, one.errors)


def test_progress_is_told_to_the_end(world):
    told = []
    learn(world[2], seeds=2, batches=3, hidden=(8,), progress=lambda *about: told.append(about))
    assert told == [(k, 6) for k in range(1, 7)]


class Biased:
    """Networks that know the truth, pose by pose in the order of `known` and `believe`, but for a constant."""

    errors = np.eye(WIDTH)

    def __init__(self, poses, bias):
        self.poses, self.bias = list(poses), bias

    def predict(self, inputs):
        asked = [self.poses.pop(0) for _ in range(len(inputs) if inputs.ndim > 1 else 1)]
        return np.array(asked if inputs.ndim > 1 else asked[0]) + self.bias


def test_what_was_off_is_expected_to_be_off_again(world, performance):
    """The lasting part is told from the known frames; the newest error fades towards it."""
    frames, tracks, _, points = performance
    solver = world[1]
    memory = Method(None, solver).begin(frames[:SPAN], tracks[:SPAN])
    newest = np.arange(SPAN - 1, -1, -1)
    bias = np.random.default_rng(5).normal(0, 0.05, WIDTH)
    grounds = [view(points[np.maximum(t - LAGS, 0)], tracks[t - 1, 2])[1] for t in range(1, SPAN + 1)]
    truth = [seen_from(ground, placed(frames[t], tracks[t]), WORLD) for t, ground in enumerate(grounds, 1)]
    prior = Expectation(Biased([*truth[SPAN - 2::-1], truth[SPAN - 1]], bias), LostPoints.of(world[2]), DT)
    known = prior.known(memory.frames, tracks[newest], memory.points)
    expected = -LASTING * bias
    expected[YAW_RATE] = 0.0
    assert np.allclose(known.lasting, expected)
    belief, hint = prior.believe(replace(memory, hint=known), points[SPAN], points[SPAN])
    assert np.allclose(hint.lasting, KEPT * expected)
    off = bias + KEPT * expected + FADING * (-bias - KEPT * expected)
    there = seen_from(tracks[SPAN - 1], truth[SPAN - 1] + off, grounds[SPAN - 1])
    assert np.allclose(belief.mean[:YAW_RATE], there[:YAW_RATE]) and np.allclose(belief.mean[YAW_RATE:] * DT, there[YAW_RATE:])


def test_a_clip_of_the_database_is_followed_closely(method, performance):
    """Within 3 cm all along on its own output; standing still is farther off at once."""
    found = run(method, performance, performance[3])
    off = metrics.position_error(found, performance[2][SPAN:])
    assert off.mean() < 0.02 and off.max() < 0.05, off


def test_filters_leave_what_is_clean_and_calm_what_is_not(method, performance):
    """Clean: within 3 mm of the unfiltered. 1 cm of noise: an eighth of its jitter, at a little error."""
    rough, truth = replace(method, steady=False), performance[2][SPAN:]
    assert np.abs(run(method, performance, performance[3]) - run(rough, performance, performance[3])).mean() < 0.003
    points = performance[3] + np.random.default_rng(2).normal(0, 0.01, performance[3].shape)
    calm, wild = run(method, performance, points), run(rough, performance, points)
    assert metrics.jitter(calm[15:], DT) < metrics.jitter(wild[15:], DT) / 8
    assert metrics.position_error(calm, truth).mean() < metrics.position_error(wild, truth).mean() + 0.01
    assert abs(metrics.lag(run(method, performance, performance[3]), truth)) < 1.0


def test_lost_points_do_no_harm(method, performance):
    """Single ones, then all, then wild ones; half a second after they are back so is the body."""
    points = performance[3].copy()
    points[40:60, 1] = np.nan
    points[70:80] = np.nan
    points[85, 2] = [np.inf, 1e30, np.nan]
    points[90, 0] = 1e30
    found = run(method, performance, points)
    off = metrics.position_error(found, performance[2][SPAN:])
    assert off[120 - SPAN:].max() < 0.06, off
    assert np.linalg.norm(np.diff(found, axis=0), axis=-1).max() < 0.6


@settings(max_examples=5)
@given(st.integers(0, 1000))
def test_points_that_no_body_can_have_give_a_body_still(method, performance, seed):
    rng = np.random.default_rng(seed)
    points = performance[3] + rng.normal(0, 3.0, performance[3].shape)
    run(method, performance, np.where(rng.random(points.shape) < 0.2, np.nan, points))


@pytest.mark.few(2)
@pytest.mark.parametrize("lost", [[0], [2], [0, 1], [0, 1, 2], [0, 1, 2, 3]], ids=str)
def test_a_body_goes_on_without_points_and_does_not_run_away(method, performance, lost):
    """Half a second without some, or any; then all are there again."""
    points = performance[3].copy()
    points[SPAN + 5:SPAN + 35, lost] = np.nan
    away = metrics.position_error(run(method, performance, points), performance[2][SPAN:len(points)])
    assert away.max() < 0.5 and away[-1] < 0.05


@pytest.fixture(scope="module")
def listening(world, method):
    """Makes ours with neighbours: another expectation of it, and two of the regressions, while all is seen and while not."""
    database, solver, _ = world
    search = Cells(Segments.of(database, 3, 4, solver.controls.joints))
    usual, heard = (Local(LocalRegression(how, reach), search, 60) for how, reach in ((LISTENED, NEAR), (HEARD, NEARER)))

    def make(whole=usual, torn=heard, moments=None):
        expectation = method.method.prior.priors[0]
        expectation = replace(expectation, moments=moments or expectation.moments)
        return replace(method, method=replace(method.method, prior=Fused((expectation, Torn(whole, torn)))))
    return make, usual


def test_what_is_done_about_lost_points_changes_nothing_while_all_are_seen(listening, method, performance):
    """To the bit: then nobody asks for the moments, nor for what neighbours say of lost limbs."""
    class Never:
        def believe(self, memory, seen, goals):
            raise AssertionError("asked")
    make, usual = listening
    nothing = LostPoints(np.full(72, np.nan), np.full((72, 72), np.nan))
    plain = replace(method, method=replace(method.method, prior=Fused((method.method.prior.priors[0], usual))))
    found, points = run(plain, performance, performance[3]), performance[3].copy()
    assert np.array_equal(run(make(torn=Never(), moments=nothing), performance, points), found)
    points[60, 1] = np.nan
    with pytest.raises(AssertionError, match="asked"):
        run(make(torn=Never()), performance, points)


def test_neighbours_tell_where_a_lost_limb_is(listening, performance):
    """Each point in turn is lost for half a second: a quarter less far off, or better, than were they hardly heard."""
    make, usual = listening

    def off(method):
        away = []
        for lost in range(4):
            points = performance[3][:SPAN + 50].copy()
            points[SPAN + 20:, lost] = np.nan
            away.append(metrics.position_error(run(method, performance, points), performance[2][SPAN:SPAN + 50])[20:].mean())
        return np.mean(away)
    heard, hardly = off(make()), off(make(torn=usual))
    assert heard < 0.75 * hardly, (heard, hardly)


def test_few_known_frames_are_enough(method, performance):
    assert metrics.position_error(run(method, performance, performance[3], 1)[:20], performance[2][1:21]).max() < 0.3


@pytest.fixture
def disk(tmp_path, monkeypatch):
    """Networks are learnt in three batches and kept in a folder of the test's own; the list of what was learnt."""
    learnt, learn_ = [], combined.learn
    monkeypatch.setattr(store, "cache_folder", lambda: tmp_path / "kernels")
    monkeypatch.setattr(combined, "learn", lambda samples, progress, **how: learnt.append(how) or learn_(samples, 1, 3, (8,), progress))
    return learnt


def test_what_was_learnt_is_kept_for_the_same_takes_and_points_alone(world, disk):
    database, _, samples = world
    four, inputs = parse("4", SKELETON), draw(samples, np.arange(5))[0]
    one, two = (ours(database, four).method.prior.priors[0].networks.predict(inputs) for _ in range(2))
    assert len(disk) == 1 and np.array_equal(one, two)
    ours(database.hold_out([database.takes[0].clip])[0], four)
    assert len(disk) == 2
    ours(database, parse("lwrist,rwrist,lankle,rankle+0/0/0.1", SKELETON))
    assert len(disk) == 3
    other = replace(database, frames=database.frames + np.float32(0.01))
    ours(other, four)
    assert len(disk) == 4
    ours(database, parse("4", SKELETON), steady=False)
    assert len(disk) == 4


def test_networks_of_few_poses_are_narrow_and_apart_from_wide_ones(world, disk, monkeypatch):
    for plenty in (len(world[0]) + 1, len(world[0])):
        monkeypatch.setattr(combined, "PLENTY", plenty)
        for _ in range(2):
            ours(world[0], parse("4", SKELETON))
    assert disk == [NARROW, {}]


def test_what_is_damaged_on_disk_is_learnt_anew(world, disk, tmp_path):
    database, four = world[0], parse("4", SKELETON)
    ours(database, four)
    for kept in (tmp_path / "learnt").rglob("*.npz"):
        kept.write_bytes(kept.read_bytes()[:100])
    ours(database, four)
    ours(database, four)
    assert len(disk) == 2


def test_a_full_disk_is_no_harm(world, disk, monkeypatch):
    monkeypatch.setattr(Networks, "save", lambda *_: (_ for _ in ()).throw(OSError("no space left")))
    assert np.isfinite(ours(world[0], parse("4", SKELETON)).method.prior.priors[0].networks.errors).all()


def test_cells_from_disk_find_the_same(world, disk, monkeypatch):
    database, solver, _ = world
    made = cells(database, solver.controls)
    monkeypatch.setattr(combined, "Cells", type("Never", (), {"save": None, "load": combined.Cells.load}))
    again = cells(database, solver.controls)
    for feature in made.segments.features(np.array([3, 400, 900])):
        for one, two in zip(made.query(feature, 20), again.query(feature, 20), strict=True):
            assert np.array_equal(one, two)
    with pytest.raises(DatabaseError):
        cells(database.only([]), solver.controls)
