"""Plücker constraints, the penalty and the solver."""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parent))
from bodies import cameras, masks, stick_body, stride

from gambol.controllers.tracking.pose import (Evidence, Penalty, calmed, carried, constraint, judged, normal_rows, observed, overlap, penalty_of,
                                              penalty_rows, plucker_rows, predicted, solve)
from gambol.controllers.tracking.pose.matching import closest_kernel, shift_kernel, sums_kernel
from gambol.controllers.tracking.silhouettes import skinned
from gambol.controllers.tracking.twists import Configuration, exp, inverse, local_turns, posed, retract_kernel


@pytest.fixture(scope="module")
def surface():
    return stick_body()


def points_and_rays(surface, where, seed=0):
    """Points of the surface and the rays that see them, exactly; each point's shares."""
    positions, orientations, columns = posed(surface.chain, where)
    vertices = skinned(surface, positions, orientations)
    rng, lens = np.random.default_rng(seed), cameras()[seed % 4]
    chosen = rng.choice(len(vertices), 40, replace=False)
    directions = vertices[chosen] - lens.eye
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return vertices[chosen], directions, np.cross(lens.eye, directions), surface.shares[chosen], columns, lens


def moved(chain, where, step):
    root, angles = where.root.copy(), where.angles.copy()
    retract_kernel(chain.first, chain.count, step, root, angles, np.full(len(chain), -9.0), np.full(len(chain), 9.0))
    return Configuration(root, angles)


def test_constraints_are_zero_on_exact_data_and_else_the_distance(surface):
    points, directions, moments, shares, columns, lens = points_and_rays(surface, stride(surface.chain, 0.1))
    np.testing.assert_allclose(constraint(points, directions, moments), 0.0, atol=1e-12)
    aside = np.cross(directions, [0.0, 1.0, 0.0])
    aside *= 0.03 / np.linalg.norm(aside, axis=1, keepdims=True)
    np.testing.assert_allclose(np.linalg.norm(constraint(points + aside + 0.2 * directions, directions, moments), axis=1), 0.03, atol=1e-12)
    rows, wanted = plucker_rows(points, directions, moments, columns, shares)
    np.testing.assert_allclose(wanted, 0.0, atol=1e-12)
    assert {np.linalg.matrix_rank(row[:, :6], tol=1e-9) for row in rows} == {2}, "nothing is said along the line"


def test_plucker_rows_are_the_derivative(surface):
    where, chain = stride(surface.chain, 0.1), surface.chain
    points, directions, moments, shares, columns, _ = points_and_rays(surface, where)
    rng, epsilon = np.random.default_rng(4), 1e-6
    chosen = np.random.default_rng(0).choice(len(surface.vertices), 40, replace=False)
    for _ in range(5):
        step = rng.normal(size=6 + len(chain))
        ends = []
        for sign in (1, -1):
            positions, orientations, _ = posed(chain, moved(chain, where, sign * epsilon * step))
            ends.append(constraint(skinned(surface, positions, orientations)[chosen], directions, moments))
        rows, _ = plucker_rows(points, directions, moments, columns, shares)
        np.testing.assert_allclose(rows @ step, (ends[0] - ends[1]) / (2 * epsilon), atol=2e-6)


def test_gauss_newton_on_exact_rays_finds_the_pose(surface):
    """Eq. (14) alone, as the paper solves it, from half a radian's worth of errors."""
    chain, truth = surface.chain, stride(surface.chain, 0.15)
    every = np.arange(0, len(surface.vertices), 7)
    target = skinned(surface, *posed(chain, truth)[:2])[every]
    lenses = cameras()
    directions = np.stack([(target - lens.eye) / np.linalg.norm(target - lens.eye, axis=1, keepdims=True) for lens in lenses])
    moments = np.stack([np.cross(lens.eye, d) for lens, d in zip(lenses, directions)])
    where = moved(chain, truth, np.random.default_rng(1).normal(size=6 + len(chain)) * 0.1)
    for _ in range(12):
        positions, orientations, columns = posed(chain, where)
        at = skinned(surface, positions, orientations)[every]
        parts = [plucker_rows(at, d, m, columns, surface.shares[every]) for d, m in zip(directions, moments)]
        rows = np.concatenate([p[0].reshape(-1, 6 + len(chain)) for p in parts])
        wanted = np.concatenate([p[1].ravel() for p in parts])
        where = moved(chain, where, np.linalg.lstsq(rows, wanted, rcond=1e-9)[0])
    np.testing.assert_allclose(posed(chain, where)[0], posed(chain, truth)[0], atol=1e-7)


def test_compiled_sums_are_the_normal_rows(surface):
    """The kernel's matrix and vector against the printed constraints, projected across the contour and in pixels."""
    where = stride(surface.chain, 0.1)
    points, directions, moments, shares, columns, lens = points_and_rays(surface, where)
    rng, count = np.random.default_rng(3), len(points)
    points = points + rng.normal(size=points.shape) * 0.002
    across = np.cross(directions, rng.normal(size=directions.shape))
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    pixel = np.full(count, 0.004)
    rows, wanted = normal_rows(*plucker_rows(points, directions, moments, columns, shares), directions, across)
    metre = 1.0 / (pixel * np.linalg.norm(points - lens.eye, axis=1))
    rows, wanted = rows * metre[:, None], wanted * metre
    weights = np.minimum(1.0, 0.5 / np.maximum(np.abs(wanted), 1e-12))
    size = rows.shape[1]
    matrix, vector = np.zeros((size, size)), np.zeros(size)
    corners = np.stack([np.arange(count)] * 3, 1)
    pairs = np.stack([np.arange(count)] * 2, 1)
    total, used = sums_kernel(points, corners, shares, columns, pairs, np.zeros(count), count, lens.eye, directions, across, pixel,
                              1e9, 0.5, np.zeros(size), matrix, vector)
    np.testing.assert_allclose(np.triu(matrix), np.triu((rows * weights[:, None]).T @ rows), rtol=1e-8, atol=1e-8)
    np.testing.assert_allclose(vector, (rows * weights[:, None]).T @ wanted, rtol=1e-8, atol=1e-8)
    assert used == count and total == pytest.approx(np.abs(wanted).sum())


def test_a_shift_is_the_surfaces_motion_to_first_order(surface):
    chain, where = surface.chain, stride(surface.chain, 0.1)
    positions, orientations, columns = posed(chain, where)
    at = skinned(surface, positions, orientations)
    step = np.random.default_rng(0).normal(size=6 + len(chain)) * 1e-4
    shifted, corners = at.copy(), np.stack([np.arange(len(at))] * 3, 1)
    shift_kernel(shifted, corners, surface.shares, columns, step)
    after = skinned(surface, *posed(chain, moved(chain, where, step))[:2])
    np.testing.assert_allclose(shifted, after, atol=1e-6)


@pytest.mark.parametrize("swap", [False, True])
def test_the_closest_point_is_the_closest(swap):
    rng = np.random.default_rng(5)
    one, other = (np.concatenate([rng.uniform(0, 50, (60, 2)), rng.normal(size=(60, 2))], 1) for _ in range(2))
    other = other[np.argsort(other[:, 1])]
    pairs, squares = np.zeros((60, 2), np.int64), np.zeros(60)
    assert closest_kernel(one, other, 4.0, 1, pairs, squares, swap, 0) == 60
    scale = np.array([1, 1, 4.0, 4.0])
    want = (((one[:, None] - other[None]) * scale) ** 2).sum(-1)
    got = pairs[:, ::-1] if swap else pairs
    np.testing.assert_array_equal(got[:, 0], np.arange(60))
    np.testing.assert_array_equal(got[:, 1], want.argmin(1))
    np.testing.assert_allclose(squares, want.min(1))


def test_the_prediction_goes_on_as_before_from_either_side(surface):
    """Eq. (17): M_t M_{t−1}⁻¹ M_t, wherever the world's origin and whichever frame of the body is meant."""
    chain, rng = surface.chain, np.random.default_rng(2)
    before, now = stride(chain, 0.10), stride(chain, 0.12)
    got = predicted(chain, now, before)
    np.testing.assert_allclose(got.root, now.root @ (inverse(before.root) @ now.root), atol=1e-12)
    left, right = exp(rng.normal(size=6)), exp(rng.normal(size=6))
    other = predicted(chain, Configuration(left @ now.root @ right, now.angles), Configuration(left @ before.root @ right, before.angles))
    np.testing.assert_allclose(other.root, left @ got.root @ right, atol=1e-12)
    hinge = chain.names.index("LeftLeg.x")
    assert got.angles[hinge] == pytest.approx(2 * now.angles[hinge] - before.angles[hinge])
    ball = chain.skeleton.index("LeftArm")
    a, b, c = (local_turns(chain, one).rotations[ball] for one in (before, now, got))
    np.testing.assert_allclose(c, b @ a.T @ b, atol=1e-9)


def test_a_calmed_prediction_lies_on_the_way_to_it(surface):
    chain, before, now = surface.chain, stride(surface.chain, 0.10), stride(surface.chain, 0.12)
    target = predicted(chain, now, before)
    np.testing.assert_allclose(calmed(chain, now, target, 0.0).angles, now.angles, atol=1e-12)
    np.testing.assert_allclose(local_turns(chain, calmed(chain, now, target, 1.0)).rotations, local_turns(chain, target).rotations, atol=1e-9)
    half, ball = calmed(chain, now, target, 0.5), chain.skeleton.index("LeftArm")
    a, b, c = (local_turns(chain, one).rotations[ball] for one in (now, half, target))
    np.testing.assert_allclose(b @ a.T @ b, c, atol=1e-9)
    assert half.root is target.root


def test_predictions_of_predictions_stay_rigid(surface):
    """Rounding would double with each of them."""
    before, now = stride(surface.chain, 0.10), stride(surface.chain, 0.12)
    for _ in range(120):
        before, now = now, predicted(surface.chain, now, before)
    np.testing.assert_allclose(now.root[:3, :3] @ now.root[:3, :3].T, np.eye(3), atol=1e-12)


def test_penalty_rows_are_exact_to_first_order(surface):
    """One full step of them alone leads to the prediction, wherever the scene is; eq. (26)."""
    chain, rng = surface.chain, np.random.default_rng(3)
    where = stride(chain, 0.1)
    for away in (0.0, 50.0):
        here = Configuration(exp(np.r_[away, 0, away, 0, 0, 0]) @ where.root, where.angles)
        target = moved(chain, here, np.concatenate([[0.02, 0.01, -0.03, 0, 0, 0], rng.normal(size=len(chain)) * 0.2]))
        target = Configuration(target.root @ exp(np.r_[0, 0, 0, 0.2, -0.1, 0.1]), target.angles)
        centre = here.root[:3, 3]
        step = penalty_rows(chain, Penalty(target, np.ones(6 + len(chain))), here, centre)
        shift = np.r_[-centre, 0, 0, 0]
        centred = moved(chain, Configuration(exp(shift) @ here.root, here.angles), step)
        np.testing.assert_allclose(exp(-shift) @ centred.root, target.root, atol=1e-10)
        np.testing.assert_allclose(local_turns(chain, centred).rotations[1:], local_turns(chain, target).rotations[1:], atol=1e-10)
        assert np.linalg.norm(step[:3]) < 0.06, "a turn about the hips is no shift, however far the origin"


def test_weights_come_from_bounds_on_acceleration(surface):
    at_60, at_30 = (penalty_of(surface.chain, surface.chain.rest(), rate).weights for rate in (60.0, 30.0))
    np.testing.assert_allclose(at_60[:3] ** -0.5, 0.007, rtol=0.01)
    np.testing.assert_allclose(at_60[6:] ** -0.5, 0.07, rtol=0.01)
    np.testing.assert_allclose(at_30 * 16, at_60)


def test_without_pictures_the_penalty_alone_decides(surface):
    lenses, chain = cameras(), surface.chain
    target = stride(chain, 0.13)
    nothing = [observed(lens, np.zeros(lens.size[::-1], bool)) for lens in lenses]
    fit = solve(surface, nothing, stride(chain, 0.1), penalty_of(chain, target, 60.0))
    np.testing.assert_allclose(posed(chain, fit.where)[0], posed(chain, target)[0], atol=1e-6)
    stays = solve(surface, nothing, stride(chain, 0.1))
    np.testing.assert_allclose(stays.where.angles, stride(chain, 0.1).angles, atol=1e-9)


def test_both_directions_of_matching_beat_one(surface):
    from gambol.controllers.tracking.pose import SolverSettings

    chain, lenses, off = surface.chain, cameras(160), {}
    truth = stride(chain, 0.2)
    views = [observed(lens, mask) for lens, mask in zip(lenses, masks(surface, truth, lenses))]
    for both in (True, False):
        fit = solve(surface, views, stride(chain, 0.12), settings=SolverSettings(both=both, outer=6))
        off[both] = np.linalg.norm(posed(chain, fit.where)[0] - posed(chain, truth)[0], axis=1).mean()
    assert off[True] < 0.004 and off[True] < off[False]


def test_overlap():
    one, other = np.zeros((4, 4), bool), np.zeros((4, 4), bool)
    assert np.isnan(overlap(one, other))
    one[:2], other[1:3] = True, True
    assert overlap(one, other) == pytest.approx(1 / 3)


def test_a_corrupted_picture_is_noticed_and_patience_ends():
    evidence = Evidence.fresh(2)
    for _ in range(20):
        evidence, believed = judged(evidence, np.array([0.9, 0.6]))
        assert believed.all()
    evidence, believed = judged(evidence, np.array([0.9, 0.1]))
    assert believed.tolist() == [True, False] and evidence.usual[1] == pytest.approx(0.6, abs=0.02)
    seen = []
    for _ in range(7):
        evidence, believed = judged(evidence, np.array([0.9, 0.2]))
        seen.append(bool(believed[1]))
    assert seen == [False] * 5 + [True, False]


def test_a_mask_of_another_size_is_told():
    with pytest.raises(ValueError, match="cam01: a mask of 5 × 4 pixels, but its pictures have 96 × 96"):
        observed(cameras()[0], np.zeros((4, 5), bool))


def test_arms_are_drawn_to_how_people_carry_them():
    """Where nothing is seen an arm turns back to between what both pulls want; other joints stay, and what is not asked for changes nothing."""
    surface = stick_body()
    chain, names = surface.chain, surface.chain.names
    turned = Configuration(chain.rest().root, np.clip(np.full(len(chain), 0.3), chain.lower, chain.upper))
    penalty = penalty_of(chain, turned, 60.0)
    drawn = carried(chain, penalty, float(penalty.weights[-1]))
    for k, name in enumerate(names):
        half = name in ("LeftArm.x", "RightArm.x", "LeftForeArm.x", "LeftHand.y", "LeftHand.z", "RightForeArm.x", "RightHand.y", "RightHand.z")
        assert drawn.target.angles[k] == pytest.approx(turned.angles[k] * (0.5 if half else 1.0))
        assert drawn.weights[6 + k] == pytest.approx(penalty.weights[6 + k] * (2.0 if half else 1.0))
    np.testing.assert_array_equal(carried(chain, penalty, 0.0).weights, penalty.weights)
    np.testing.assert_array_equal(drawn.weights[:6], penalty.weights[:6])
