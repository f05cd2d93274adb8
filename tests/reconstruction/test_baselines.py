"""Every method follows an easy motion, loses points without harm, and never gives anything that is no number."""

import numpy as np
import pytest
from scipy.optimize import approx_fprime
from trajectories import played

from gambol.controllers.body import forward_kinematics
from gambol.controllers.reconstruction.baselines import (SGPLVM, Layers, LocalPCA, LocalPCR, Nearest, Samples, gplvm,
                                                         network, regressors, ridge)
from gambol.controllers.reconstruction.control_points import parse
from gambol.controllers.reconstruction.database.database import Database, Writer
from gambol.controllers.reconstruction.neighbours.search import Exact
from gambol.controllers.reconstruction.neighbours.segments import Segments
from gambol.controllers.reconstruction.pose_vector import (ANGLES, FORWARD, HEIGHT, SKELETON, WIDTH, YAW_RATE, advance,
                                                           decode)
from gambol.controllers.reconstruction.regression.local_regression import FLOOR, PAPER, Regression
from gambol.controllers.reconstruction.regression.map_solver import Solver
from gambol.controllers.reconstruction.regression.method import Fused, Local, LocalRegression, Method

DT = 1 / 60
NAMES = ("regression", "hybrid", "paper", "pca", "pcr", "nearest", "ridge", "network", "gplvm", "fused")


def motion(frames, phase, pace):
    """Frames (T, WIDTH) of a made-up gait: everything swings along with one phase."""
    swing = np.random.default_rng(0).normal(0, 0.15, (2, ANGLES))
    at = phase + 2 * np.pi * pace * DT * np.arange(frames)
    out = np.zeros((frames, WIDTH))
    out[:, :ANGLES] = np.sin(at)[:, None] * swing[0] + np.cos(at)[:, None] * swing[1]
    out[:, HEIGHT] = 0.98 + 0.03 * np.sin(2 * at)
    out[:, FORWARD] = 1.2 * pace + 0.1 * np.sin(2 * at)
    out[:, YAW_RATE] = 0.3 * np.sin(at)
    return out


@pytest.fixture(scope="module")
def world(tmp_path_factory):
    """A database of this motion at several paces, and a solver for four points."""
    path = tmp_path_factory.mktemp("motion") / "made.gambolmotion"
    with Writer(path, mirrors=False) as writer:
        for n, (phase, pace) in enumerate([(0.0, 0.9), (1.0, 1.0), (2.0, 1.1), (4.0, 1.0)]):
            writer.add(f"take{n}", "nobody", "walk", motion(240, phase, pace), np.ones(240, bool))
    return Database.open(path), Solver(parse("4", SKELETON), DT)


@pytest.fixture(scope="module")
def methods(world):
    """Every method by name, learnt from that database."""
    database, solver = world
    plain, seeing = (Exact(Segments.of(database, 3, 2, joints)) for joints in ((), solver.controls.joints))
    samples = Samples.of(database, solver)
    priors = {
        "regression": Local(LocalRegression(Regression()), plain, 40),
        "hybrid": Local(LocalRegression(Regression(covariance="full")), seeing, 40),
        "paper": Local(LocalRegression(PAPER), plain, 40),
        "pca": Local(LocalPCA(), seeing, 40),
        "pcr": Local(LocalPCR(), plain, 40),
        "nearest": Local(Nearest(), seeing, 1),
        "ridge": ridge(samples),
        "network": network(samples, (64, 64), 1200, 64),
        "gplvm": SGPLVM.of(database, solver, active=100, dimensions=2, apart=3.0),
    }
    priors["fused"] = Fused((priors["hybrid"], priors["network"]))
    assert tuple(priors) == NAMES
    return {name: Method(prior, solver) for name, prior in priors.items()}


@pytest.fixture(scope="module")
def performance(world):
    """A motion that the database has not: frames, tracks, joints in the world and the four points."""
    solver = world[1]
    frames = motion(120, 0.5, 1.05)
    tracks = [np.array([3.0, -2.0, 2.5])]
    for frame in frames[1:]:
        tracks.append(advance(tracks[-1], frame, DT))
    positions, orientations = forward_kinematics(SKELETON, *decode(frames, np.stack(tracks)))
    return frames, np.stack(tracks), positions, solver.controls.on(positions, orientations)


def run(method, performance, points, start=20):
    """`played` from frame `start` on."""
    return played(method, performance, points, start)


@pytest.mark.few(3)
@pytest.mark.parametrize("name", NAMES)
def test_an_easy_motion_is_followed(methods, performance, name):
    """Within 2 cm (5 where poses are not interpolated exactly) for 100 frames on its own output; standing still is a metre off."""
    found = run(methods[name], performance, performance[3])
    off = np.linalg.norm(found - performance[2][20:], axis=-1).mean(-1)
    assert off.max() < (0.05 if name in ("nearest", "network", "gplvm") else 0.02), off


@pytest.mark.few(3)
@pytest.mark.parametrize("name", NAMES)
def test_lost_points_do_no_harm(methods, performance, name):
    """Single ones, then all of them, then wild ones; a third of a second after they are back so is the body."""
    points = performance[3].copy()
    points[30:40, 1] = np.nan
    points[50:60] = np.nan
    points[65, 2] = [np.inf, 1e30, np.nan]
    found = run(methods[name], performance, points)
    off = np.linalg.norm(found - performance[2][20:], axis=-1).mean(-1)
    assert off[85 - 20:].max() < 0.08, off
    assert np.linalg.norm(np.diff(found, axis=0), axis=-1).max() < 0.5


@pytest.mark.few(3)
@pytest.mark.parametrize("name", NAMES)
def test_points_that_no_body_can_have_give_a_body_still(methods, performance, name):
    rng = np.random.default_rng(1)
    run(methods[name], performance, performance[3] + rng.normal(0, 5.0, performance[3].shape))


def test_memory_knows_what_was_seen(methods, performance):
    """Points seen as they were, lost ones as the body has them; nothing of the old memory changes."""
    method = methods["nearest"]
    memory = method.begin(performance[0][:40], performance[1][:40])
    assert np.allclose(memory.points[0], performance[3][39]) and np.allclose(memory.points[30], performance[3][9])
    points = performance[3][40].copy()
    points[1] = np.nan
    after, pose = method.step(memory, points)
    body = method.solver.controls.on(*forward_kinematics(SKELETON, pose.root, pose.rotations))
    assert np.array_equal(after.points[0][[0, 2, 3]], points[[0, 2, 3]]) and np.allclose(after.points[0, 1], body[1])
    assert np.array_equal(after.points[1:], memory.points[:-1]) and np.array_equal(after.frames[1:], memory.frames[:-1])


def test_samples_astray_lead_back(world):
    """From wherever the root is taken to be, the frame to predict leads to the same place and points."""
    database, solver = world
    samples = Samples.of(database, solver)
    chosen = np.arange(0, len(samples), 7)
    straight, strayed = samples.draw(chosen), samples.draw(chosen, np.random.default_rng(3))
    moved = np.abs(strayed[1] - straight[1]).max(-1) > 1e-6
    assert 0.3 < moved.mean() < 0.7
    for inputs, frames in (straight, strayed):
        now = inputs.reshape(len(chosen), -1, 4, 3)[:, 0]
        assert np.allclose([solver.points(frame)[0] for frame in frames], now, atol=1e-5)


def test_a_network_learns_by_its_derivatives():
    rng = np.random.default_rng(2)
    weights, biases = [rng.normal(size=s) for s in ((3, 4), (4, 2))], [rng.normal(size=s) for s in (4, 2)]
    x, y = rng.normal(size=(5, 3)), rng.normal(size=(5, 2))
    sizes = [(3, 4), (4, 2), (4,), (2,)]

    def loss(flat):
        parts = [a.reshape(s) for a, s in zip(np.split(flat, np.cumsum([np.prod(s) for s in sizes])[:-1]), sizes, strict=True)]
        return np.sum((regressors.forward(parts[:2], parts[2:], x)[0] - y) ** 2)
    flat = np.concatenate([a.ravel() for a in (*weights, *biases)])
    found, seen, own = regressors.forward(weights, biases, x)
    slopes = regressors.backward(weights, seen, own, 2 * (found - y))
    assert np.allclose(np.concatenate([s.ravel() for s in slopes]), approx_fprime(flat, loss, 1e-7), atol=1e-4)


def test_the_same_seed_gives_the_same_network(world, tmp_path):
    samples = Samples.of(*world)
    one, two = (network(samples, (16,), 20, 32, seed=5) for _ in range(2))
    other = network(samples, (16,), 20, 32, seed=6)
    inputs = samples.draw(np.arange(9))[0]
    assert np.array_equal(one.predict(inputs), two.predict(inputs))
    assert not np.array_equal(one.predict(inputs), other.predict(inputs))
    one.save(tmp_path / "network.npz")
    again = Layers.load(tmp_path / "network.npz")
    assert np.array_equal(again.predict(inputs), one.predict(inputs)) and again.loosening == one.loosening


def test_a_process_is_learnt_and_derived_rightly(world):
    """The misfit's Gauss-Newton lowers it; slopes of mean and variance are those of differences; learning beats PCA."""
    rng = np.random.default_rng(4)
    turn = rng.uniform(0, 2 * np.pi, 50)
    features = np.stack([np.cos(turn), np.sin(turn), np.cos(2 * turn)], -1) @ rng.normal(size=(3, 8))
    z, y = rng.normal(size=50 * 2 + 3), features - features.mean(0)
    assert np.allclose(gplvm.energy(z, y, 2)[1], approx_fprime(z, lambda z: gplvm.energy(z, y, 2)[0], 1e-7), rtol=1e-3, atol=1e-2)
    process, barely = gplvm.learn(features, 2), gplvm.learn(features, 2, iterations=1)
    assert process.energy < barely.energy
    x = np.array([0.3, -0.2])
    mean, _, slope, widening = process.predict(x)
    for axis in range(2):
        step = 1e-4 * np.eye(2)[axis]
        up, down = process.predict(x + step), process.predict(x - step)
        assert np.allclose(slope[:, axis], (up[0] - down[0]) / 2e-4, rtol=1e-3, atol=1e-4)
        assert np.allclose(widening[:, axis], (up[1] - down[1]) / 2e-4, rtol=1e-3, atol=1e-4)
    placed = process.place(features[7], process.latent[9])
    assert process.misfit(placed, features[7]) < process.misfit(process.latent[9], features[7])
    assert np.allclose(process.predict(process.latent[7])[0], features[7], atol=0.3)


def test_active_sets_are_spread():
    features = np.concatenate([np.zeros((50, 2)), [[5.0, 0], [0, 5.0], [-5.0, 0]]])
    assert set(gplvm.active_set(features, 4)[1:]) == {50, 51, 52}
    assert len(gplvm.active_set(features[:3], 10)) == 3


def test_floors_hold_in_every_belief(methods, performance):
    for name, method in methods.items():
        memory = method.begin(performance[0][:20], performance[1][:20])
        belief, _ = method.prior.believe(memory, performance[3][20], performance[3][20])
        deviation = np.sqrt(np.diag(belief.covariance))
        assert np.isfinite(deviation).all() and (deviation[ANGLES:] > 0).all(), name
        if name != "pca":  # whose subspace has no width of its own; two beliefs of the process make one
            assert (deviation > 0.7 * FLOOR).all(), name
