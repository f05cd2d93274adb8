"""Local regression: three ways of computing it agree with each other, with refitting and with the paper's equations."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gambol.controllers.reconstruction.control_points import parse
from gambol.controllers.reconstruction.pose_vector import SKELETON, WIDTH
from gambol.controllers.reconstruction.regression.beliefs import Gaussian, fuse
from gambol.controllers.reconstruction.regression.local_regression import (
    FORMS, PAPER, Regression, believe, fit, regress, weights)
from gambol.controllers.reconstruction.regression.map_solver import Solver

SEEDS = st.integers(0, 2**32 - 1)


def neighbourhood(seed, count=40, width=12, out=5, noise=0.1, linear=False):
    """A query (P,), segments X (K, P), frames Y (K, D), and the frame that the truth has at the query."""
    rng = np.random.default_rng(seed)
    X, query = rng.normal(0, 0.3, (count, width)) + 2.0, rng.normal(0, 0.2, width) + 2.0
    A = rng.normal(size=(width, out))

    def truth(x):
        return x @ A + 1.0 if linear else np.sin(x @ A)
    return query, X, truth(X) + noise * rng.normal(size=(count, out)), truth(query)


def weighted_ridge(query, X, Y, omega, ridge):
    """The textbook's: weighted means out, then (XᵀDX + λ)⁻¹XᵀDY."""
    x_mean, y_mean = omega @ X / omega.sum(), omega @ Y / omega.sum()
    x, y, D = X - x_mean, Y - y_mean, np.diag(omega)
    a = np.linalg.solve(x.T @ D @ x + ridge * np.eye(X.shape[1]), x.T @ D @ y)
    return y_mean + (query - x_mean) @ a


def ridge_of(X, omega, how):
    x = X - omega @ X / omega.sum()
    return how.ridge * (omega @ (x**2).sum(1)) / len(X)


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("bandwidth", ["knn", "paper"])
@pytest.mark.parametrize("count, width", [(40, 12), (30, 90)])
def test_every_form_is_weighted_ridge_regression_and_refitting_gives_its_residuals(form, bandwidth, count, width):
    query, X, Y, _ = neighbourhood(1, count, width)
    how = Regression(form=form, bandwidth=bandwidth, ridge=1e-3)
    found = fit(query, X, Y, how=how)
    omega = weights(np.linalg.norm(X - query, axis=1), bandwidth)
    ridge = ridge_of(X, omega, how)
    assert np.allclose(found.mean, weighted_ridge(query, X, Y, omega, ridge), atol=1e-10)
    rest = ~np.eye(count, dtype=bool)
    refitted = [Y[k] - weighted_ridge(X[k], X[rest[k]], Y[rest[k]], omega[rest[k]], ridge) for k in range(count)]
    assert np.allclose(found.residuals, refitted, atol=1e-8)


@settings(max_examples=20)
@given(SEEDS, st.integers(2, 60), st.integers(1, 80))
def test_dual_equals_primal(seed, count, width):
    query, X, Y, _ = neighbourhood(seed, count, width)
    dual, primal = (fit(query, X, Y, how=Regression(form=form)) for form in ("dual", "primal"))
    assert np.allclose(dual.mean, primal.mean, atol=1e-9) and np.allclose(dual.residuals, primal.residuals, atol=1e-7)


@given(st.integers(0, 2**32 - 1), st.integers(2, 30), st.integers(30, 60), st.sampled_from(["knn", "paper"]),
       st.floats(1e-3, 1.0))
@settings(max_examples=30, deadline=None)
def test_what_is_compiled_is_the_plain_form(seed, count, width, bandwidth, ridge):
    rng = np.random.default_rng(seed)
    X, Y, query = rng.normal(size=(count, width)), rng.normal(size=(count, WIDTH)), rng.normal(size=width)
    distances = np.linalg.norm(X - query, axis=1) / 4.0
    how = Regression(bandwidth, ridge, loosening=10.0)
    quick, plain = regress(query, X, Y, distances, how), believe(fit(query, X, Y, distances, how), how)
    np.testing.assert_allclose(quick.mean, plain.mean, atol=1e-9)
    np.testing.assert_allclose(quick.variance, plain.variance, rtol=1e-9)


def test_the_papers_projection_is_weighted_least_squares():
    """Eq. (8) with one D an inner product has rank one; an eigen-solver's vector through eq. (9) gives WLS."""
    query, X, Y, _ = neighbourhood(2, 40, 6)
    omega = weights(np.linalg.norm(X - query, axis=1), "paper")
    D, x, y = np.diag(omega), X - omega @ X / omega.sum(), Y - omega @ Y / omega.sum()
    predicted = []
    for d in range(Y.shape[1]):
        C = np.linalg.inv(x.T @ D @ x) @ x.T @ D @ np.outer(y[:, d], y[:, d]) @ D @ x
        assert np.linalg.svd(C, compute_uv=False)[1] < 1e-12 * np.linalg.norm(C)
        values, vectors = np.linalg.eig(C)
        U = np.real(vectors[:, [np.argmax(np.abs(values))]])
        a = U @ np.linalg.inv(U.T @ x.T @ D @ x @ U) @ U.T @ x.T @ D @ y[:, d]
        predicted.append((query - omega @ X / omega.sum()) @ a + omega @ Y[:, d] / omega.sum())
    assert np.allclose(predicted, weighted_ridge(query, X, Y, omega, 0.0), atol=1e-10)
    exact = Regression(bandwidth="paper", form="projection", ridge=1e-12, loosening=1.0)
    assert np.allclose(fit(query, X, Y, how=exact).mean, predicted, atol=1e-8)


def test_the_papers_prior_stands_though_neighbours_are_fewer_than_regressors():
    query, X, Y, _ = neighbourhood(3, 50, 180, WIDTH)
    belief = regress(query, X, Y, how=PAPER)
    assert np.isfinite(belief.mean).all() and np.isfinite(belief.variance).all() and (belief.variance > 0).all()


def test_sigma_is_the_error_to_expect():
    """The leave-one-out deviation is that of fresh points; the training residual would be far too small."""
    rng = np.random.default_rng(4)
    errors, sigmas = [], []
    for seed in range(60):
        query, X, Y, truth = neighbourhood(seed, 40, 30, noise=0.1, linear=True)
        found = fit(query, X, Y, how=Regression(ridge=1e-3))
        errors.append(truth + 0.1 * rng.normal(size=5) - found.mean)
        sigmas.append(found.sigma)
    assert 0.6 < np.sqrt(np.mean(np.square(errors))) / np.sqrt(np.mean(np.square(sigmas))) < 1.2


def test_weights():
    """Nearest first, never all gone; a median neighbour has exp(−½) under "knn"; those of the paper fall by radians."""
    distances = np.array([0.0, 1.0, 2.0, 3.0, 40.0])
    assert np.allclose(weights(distances, "knn"), np.exp(-0.5 * distances**2 / 4), atol=1e-6)
    assert np.allclose(weights(distances, "paper"), np.exp(-0.5 * distances**2), atol=1e-6)
    assert np.array_equal(weights(1000.0 + distances, "paper")[[0, -1]], [1.0, 1e-6])
    assert np.array_equal(weights(np.zeros(3)), np.ones(3))


def test_floor_and_loosening():
    """Where all neighbours agree exactly the floor remains, times √loosening."""
    query, X, _, _ = neighbourhood(5)
    for covariance in ("diagonal", "full"):
        how = Regression(floor=0.01, loosening=400.0, covariance=covariance)
        belief = regress(query, X, np.ones((40, 3)), how=how)
        assert np.allclose(np.sqrt(np.diag(belief.covariance)), 0.2) and np.allclose(belief.mean, 1.0)


@pytest.mark.parametrize("count", [5, 40])
def test_full_covariance_is_that_of_the_residuals(count):
    query, X, Y, _ = neighbourhood(6, count, 8, 7)
    how = Regression(floor=1e-6, loosening=2.0, covariance="full")
    found, belief = fit(query, X, Y, how=how), regress(query, X, Y, how=how)
    expected = 2 * np.einsum("k,kd,ke->de", found.weights, found.residuals, found.residuals) / found.weights.sum()
    assert np.allclose(belief.covariance, expected, atol=1e-8)
    assert len(belief.factor) == min(count, 7)


def test_single_precision_is_enough():
    query, X, Y, _ = neighbourhood(7, 100, 180, 63, noise=0.02)
    double = fit(query, X, Y)
    single = fit(*(a.astype(np.float32) for a in (query, X, Y)))
    assert single.mean.dtype == np.float32
    assert np.allclose(single.mean, double.mean, atol=2e-5) and np.allclose(single.sigma, double.sigma, rtol=1e-3)


def test_recovery_is_exact_where_the_neighbourhood_contains_the_truth():
    """Neighbours on a linear motion: points made from the next true frame give back that frame."""
    rng = np.random.default_rng(8)
    frames = np.zeros((60, WIDTH))
    frames[:, WIDTH - 6] = 1.0
    phase = rng.uniform(-1, 1, 60)
    X = np.stack([phase, 1 + phase], 1)
    frames += 0.3 * phase[:, None] * rng.normal(size=WIDTH)
    query, truth, X, Y = X[0], frames[0], X[1:], frames[1:]
    belief = regress(query, X, Y, how=Regression(ridge=1e-8))
    solver = Solver(parse("4", SKELETON), 1 / 60)
    assert np.allclose(solver.solve(belief, solver.points(truth)[0]).frame, truth, atol=1e-5)


def test_degenerate_neighbourhoods_give_numbers():
    """All alike, or two only, or a query far off."""
    for how in (Regression(), Regression(form="primal"), PAPER, Regression(covariance="full", bandwidth="paper")):
        for count, spread, away in ((10, 0.0, 0.0), (2, 1.0, 0.0), (10, 1.0, 1e4)):
            X = spread * np.random.default_rng(9).normal(size=(count, 4))
            belief = regress(np.full(4, away), X, X[:, np.arange(WIDTH) % 4], how=how)
            assert np.isfinite(belief.mean).all() and np.isfinite(belief.covariance).all()


@settings(max_examples=20)
@given(SEEDS)
def test_fusing_adds_precisions(seed):
    rng = np.random.default_rng(seed)

    def belief(rows):
        return Gaussian(rng.normal(size=4), rng.uniform(0.5, 2, 4), rng.normal(size=(rows, 4)))
    for a, b in ((belief(0), belief(0)), (belief(2), belief(0)), (belief(3), belief(2))):
        both = fuse(a, b)
        precision = [np.linalg.inv(g.covariance) for g in (a, b)]
        assert np.allclose(np.linalg.inv(both.covariance), sum(precision))
        assert np.allclose(sum(precision) @ both.mean, precision[0] @ a.mean + precision[1] @ b.mean)


def test_fusing_keeps_a_singular_belief_in_its_subspace():
    """Along one line, the other belief says where on it; as Σ₁ − Σ₁(Σ₁ + Σ₂)⁻¹Σ₁ has it."""
    rng = np.random.default_rng(10)
    line = Gaussian(rng.normal(size=4), np.zeros(4), rng.normal(size=(1, 4)))
    for other in (Gaussian(rng.normal(size=4), rng.uniform(0.5, 2, 4)),
                  Gaussian(rng.normal(size=4), rng.uniform(0.5, 2, 4), rng.normal(size=(2, 4)))):
        gain = line.covariance @ np.linalg.inv(line.covariance + other.covariance)
        for both in (fuse(line, other), fuse(other, line)):
            assert np.allclose(both.mean, line.mean + gain @ (other.mean - line.mean))
            assert np.allclose(both.covariance, line.covariance - gain @ line.covariance, atol=1e-7)


def test_what_is_wrong_is_said():
    with pytest.raises(ValueError, match="bandwidth 'wide' is not known: there are knn, paper"):
        Regression(bandwidth="wide")
    with pytest.raises(ValueError, match="ridge must be above zero, not 0"):
        Regression(ridge=0)
    with pytest.raises(ValueError, match="two neighbours or more, not 1"):
        regress(np.zeros(3), np.zeros((1, 3)), np.zeros((1, 2)))
