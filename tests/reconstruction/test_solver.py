"""The solver finds the minimum that a general one finds, whatever the points, and never anything that is no number."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import least_squares

from gambol.controllers.body import forward_kinematics
from gambol.controllers.reconstruction.control_points import SETS, parse
from gambol.controllers.reconstruction.pose_vector import ANGLES, HEIGHT, SKELETON, WIDTH, advance, decode
from gambol.controllers.reconstruction.regression.beliefs import Gaussian
from gambol.controllers.reconstruction.regression.map_solver import Solver, in_world, on_ground
from gambol.controllers.reconstruction.regression.solver_kernel import solve_all_kernel

DT = 1 / 60
SEEDS = st.integers(0, 2**32 - 1)
ANY_POINTS = [*SETS, "head+0.1/0.2/-0.1,LeftToe,relbow+0/0/0.3"]


def case(seed, spread=1.0):
    """A mean frame, its standard deviations, and a frame drawn from that prior."""
    rng = np.random.default_rng(seed)
    mean = rng.normal(0, 0.3, WIDTH)
    mean[HEIGHT] = 1.0
    deviation = rng.uniform(0.05, 0.2, WIDTH)
    deviation[HEIGHT + 1:HEIGHT + 3] = 0.05
    deviation[HEIGHT + 3:] = 1.0
    return mean, deviation, mean + spread * deviation * rng.normal(size=WIDTH)


def scipys(solver, mean, deviation, goals, sigma=0.01):
    """The minimum and its energy as scipy's Levenberg-Marquardt finds them."""
    seen = np.repeat(np.isfinite(goals).all(-1), 3)
    wanted = np.nan_to_num(goals).ravel()
    each = np.repeat(np.broadcast_to(sigma, len(goals)), 3)

    def residuals(x):
        return np.concatenate([(seen * (solver.points(x)[0].ravel() - wanted) / each), (x - mean) / deviation])

    def jacobian(x):
        return np.concatenate([(seen / each)[:, None] * solver.points(x)[1], np.diag(1 / deviation)])
    found = least_squares(residuals, mean, jacobian, method="lm", xtol=1e-13, ftol=1e-13)
    return found.x, 2 * found.cost


@pytest.mark.parametrize("points", ANY_POINTS)
def test_kinematics_are_the_charts(points):
    controls = parse(points, SKELETON)
    frame, track = case(3)[2], np.array([0.3, -0.7, 1.1])
    body = forward_kinematics(SKELETON, *decode(frame, advance(track, frame, DT)))
    assert np.allclose(in_world(Solver(controls, DT).points(frame)[0], track), controls.on(*body), atol=1e-12)


@pytest.mark.parametrize("points", ANY_POINTS)
@pytest.mark.parametrize("size", [1.0, 1e-4, 0.0])  # of the angles: the series near zero as well
def test_jacobian_is_that_of_differences(points, size):
    solver = Solver(parse(points, SKELETON), DT)
    frame = case(4)[2]
    frame[:ANGLES] *= size
    step = 1e-6
    differences = np.stack([(solver.points(frame + h)[0] - solver.points(frame - h)[0]).ravel() / (2 * step)
                            for h in step * np.eye(WIDTH)], -1)
    assert np.allclose(solver.points(frame)[1], differences, atol=1e-8)


@pytest.mark.parametrize("points", ANY_POINTS)
def test_minimum_is_scipys(points):
    solver = Solver(parse(points, SKELETON), DT, steps=40, tolerance=0.0)
    mean, deviation, truth = case(1)
    goals = solver.points(truth)[0]
    found = solver.solve(Gaussian(mean, deviation**2), goals)
    frame, energy = scipys(solver, mean, deviation, goals)
    assert np.isclose(found.energy, energy, rtol=1e-9)
    assert np.allclose(found.frame, frame, atol=1e-5)
    assert np.allclose(found.points, solver.points(found.frame)[0])


@settings(max_examples=25)
@given(SEEDS)
def test_eight_steps_come_close_to_the_minimum(seed):
    """From one step's distance, a third of the prior's own spread, eight steps are as good as any number."""
    solver = Solver(parse("6", SKELETON), DT)
    mean, deviation, truth = case(seed, spread=0.3)
    goals = solver.points(truth)[0]
    assert solver.solve(Gaussian(mean, deviation**2), goals).energy <= 1.001 * scipys(solver, mean, deviation, goals)[1]


def test_missing_points_have_no_say():
    """With NaN, infinite or absurd points the rest decide, as if the others did not exist; with none, the prior."""
    mean, deviation, truth = case(2)
    prior = Gaussian(mean, deviation**2)
    six = Solver(parse("6", SKELETON), DT)
    two = Solver(parse("head,rwrist", SKELETON), DT)
    goals = six.points(truth)[0]
    goals[[1, 2, 4, 5]] = np.array([[np.nan, 1, 1], [np.inf, 0, 0], [0, -1e30, 0], [np.nan] * 3])
    assert np.allclose(six.solve(prior, goals).frame, two.solve(prior, goals[[0, 3]]).frame)
    nothing = six.solve(prior, np.full((6, 3), np.nan))
    assert np.array_equal(nothing.frame, mean) and nothing.energy == 0.0


def test_every_point_has_its_own_sigma():
    solver = Solver(parse("2", SKELETON), DT, sigma=np.array([0.001, 0.1]), steps=40)
    mean, deviation, truth = case(6, spread=3.0)
    goals = solver.points(truth)[0]
    found = solver.solve(Gaussian(mean, deviation**2), goals)
    assert np.isclose(found.energy, scipys(solver, mean, deviation, goals, solver.sigma)[1], rtol=1e-6)
    other = solver.solve(Gaussian(mean, deviation**2), goals, sigma=np.array([0.1, 0.001]))
    missed, other_missed = (np.linalg.norm(s.points - goals, axis=-1) for s in (found, other))
    assert missed[0] < other_missed[0] and missed[1] > other_missed[1]


def test_covariance_may_be_singular_or_full():
    """diag(v) is the same as rows √v; along one line only, the answer stays on the line."""
    solver = Solver(parse("4", SKELETON), DT, steps=20, tolerance=0.0)
    mean, deviation, truth = case(7)
    goals = solver.points(truth)[0]
    plain = solver.solve(Gaussian(mean, deviation**2), goals)
    rows = solver.solve(Gaussian(mean, np.zeros(WIDTH), np.diag(deviation)), goals)
    assert np.allclose(plain.frame, rows.frame, atol=1e-6) and np.isclose(plain.energy, rows.energy)
    line = 0.3 * (truth - mean)
    on = solver.points(mean + 2.0 * line)[0]
    found = solver.solve(Gaussian(mean, np.zeros(WIDTH), 10 * line[None]), on)
    assert np.allclose(found.frame, mean + 2.0 * line, atol=1e-3)


def test_start_matters_only_on_the_way():
    solver = Solver(parse("6", SKELETON), DT, steps=40, tolerance=0.0)
    mean, deviation, truth = case(8)
    goals = solver.points(truth)[0]
    prior = Gaussian(mean, deviation**2)
    assert np.allclose(solver.solve(prior, goals, start=truth).frame, solver.solve(prior, goals).frame, atol=1e-5)


def test_batches_are_single_solves():
    solver = Solver(parse("4", SKELETON), DT)
    means, deviations, truths = (np.stack(a).reshape(2, 3, WIDTH) for a in zip(*(case(s) for s in range(6)), strict=True))
    goals = np.stack([solver.points(t)[0] for t in truths.reshape(6, -1)]).reshape(2, 3, 4, 3)
    together = solver.solve(Gaussian(means, deviations**2), goals)
    means.setflags(write=False)
    alone = [solver.solve(Gaussian(m, d**2), g).frame for m, d, g in
             zip(means.reshape(6, -1), deviations.reshape(6, -1), goals.reshape(6, 4, 3), strict=True)]
    assert len(solve_all_kernel.signatures) == 1  # whoever calls: each kind of array would be compiled for anew
    assert np.array_equal(together.frame.reshape(6, -1), alone)
    assert together.energy.shape == (2, 3) and together.points.shape == goals.shape


@settings(max_examples=50)
@given(SEEDS, st.floats(0.0, 1e5), st.floats(1e-6, 1e3))
def test_answers_are_finite_and_no_worse_than_the_prior(seed, far, loose):
    """However far the points are thrown, and however loose or tight the prior."""
    solver = Solver(parse("6", SKELETON), DT, steps=10)
    mean, deviation, truth = case(seed)
    goals = far * np.random.default_rng(seed).normal(size=(6, 3)) + solver.points(truth)[0]
    found = solver.solve(Gaussian(mean, (loose * deviation)**2), goals)
    before = np.sum((solver.points(mean)[0] - goals)**2) / 0.01**2
    assert np.isfinite(found.frame).all() and np.isfinite(found.points).all() and found.energy <= before * (1 + 1e-12)


def test_what_is_wrong_is_said():
    solver = Solver(parse("2", SKELETON), DT)
    mean, deviation, _ = case(0)
    with pytest.raises(ValueError, match=r"\(3, 3\) do not fit 2 control points: expected \(..., 2, 3\)"):
        solver.solve(Gaussian(mean, deviation**2), np.zeros((3, 3)))
    mean[4] = np.nan
    with pytest.raises(ValueError, match="not finite"):
        solver.solve(Gaussian(mean, deviation**2), np.zeros((2, 3)))
    with pytest.raises(ValueError, match="sigma must be above zero"):
        Solver(parse("2", SKELETON), DT, sigma=0.0)
    with pytest.raises(ValueError, match="sigma must be above zero"):
        solver.solve(Gaussian(np.zeros(WIDTH), deviation**2), np.zeros((2, 3)), sigma=np.array([0.01, 0.0]))


@given(SEEDS)
@settings(max_examples=20)
def test_ground_and_world_are_inverse(seed):
    rng = np.random.default_rng(seed)
    points, track = rng.normal(size=(2, 5, 3)), rng.normal(size=(2, 3)) * 3
    assert np.allclose(in_world(on_ground(points, track), track), points)
