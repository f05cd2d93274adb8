"""The control space: weights that reproduce a wish, never jump, and know how blends bend."""

from itertools import combinations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.spatial import ConvexHull, Delaunay

from gambol.controllers.locomotion.control_space import SCALE, ControlSpace, thin

law = settings(max_examples=20, deadline=None)
seeds = st.integers(0, 2**32 - 1)
BATCHES = ((), (1,), (3, 1, 2, 1))
TETRAHEDRON = np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])


def cloud(seed, count=24):
    """Velocities (N, 3) all around, and the generator that drew them."""
    rng = np.random.default_rng(seed)
    return rng.normal(size=(count, 3)) * SCALE, rng


def inner(points, rng, count):
    """Queries inside the hull of some velocities: random convex combinations."""
    return rng.dirichlet(np.full(len(points), 0.3), count) @ points


@law
@given(seeds, st.integers(5, 40))
def test_weights_reproduce_the_query(seed, count):
    """Eq. (4): Σ w v = q with Σ w = 1 and w ≥ 0, of no more than four primitives."""
    points, rng = cloud(seed, count)
    space = ControlSpace.build(points)
    query = inner(points, rng, 20)
    weights = space.weights(query, correct=0)
    np.testing.assert_allclose(weights @ points, space.clamp(query), atol=1e-9)
    np.testing.assert_allclose(weights.sum(-1), 1.0, atol=1e-12)
    assert np.all(weights >= 0) and np.all((weights > 0).sum(-1) <= 4)


@law
@given(seeds)
def test_locating_agrees_with_scipy(seed):
    points, rng = cloud(seed)
    space = ControlSpace.build(points)
    query = inner(points, rng, 30)
    mesh = Delaunay(points / SCALE)
    simplex = mesh.find_simplex(space.clamp(query) / SCALE)
    assert np.all(simplex >= 0)
    parts = np.einsum("nij,nj->ni", mesh.transform[simplex, :3], space.clamp(query) / SCALE - mesh.transform[simplex, 3])
    wanted = np.zeros((len(query), len(points)))
    np.put_along_axis(wanted, mesh.simplices[simplex], np.concatenate([parts, 1 - parts.sum(-1, keepdims=True)], -1), -1)
    np.testing.assert_allclose(space.weights(query, correct=0), wanted, atol=1e-9)


@law
@given(seeds)
def test_a_primitive_at_its_own_velocity_stands_alone(seed):
    points, _ = cloud(seed)
    weights = ControlSpace.build(points).weights(points, correct=0)
    np.testing.assert_allclose(weights, np.eye(len(points)), atol=1e-4)


@law
@given(seeds)
def test_weights_never_jump(seed):
    """Along any path no weight changes faster than `lipschitz` says, whatever facets it crosses."""
    points, rng = cloud(seed, 12)
    space = ControlSpace.build(points)
    a, b = inner(points, rng, 2)
    path = a + np.linspace(0, 1, 2000)[:, None] * (b - a)
    change = np.abs(np.diff(space.weights(path, correct=0), axis=0)).max()
    assert change <= space.lipschitz() * np.linalg.norm((b - a) / SCALE) / 1999 * (1 + 1e-6) + 1e-9


def test_lipschitz_is_as_steep_as_it_gets():
    """Of a flat tetrahedron, the weight of its tip over the distance from the base."""
    for height in (0.1, 0.5, 2.0):
        points = np.array([[0, 0, 0], [3, 0, 0], [0, 3, 0], [1, 1, height]]) * SCALE
        assert ControlSpace.build(points).lipschitz() == pytest.approx(1 / height) or height > 0.5
    assert ControlSpace.build(TETRAHEDRON * SCALE).lipschitz() == pytest.approx(np.sqrt(3) / 4)


@law
@given(seeds, st.floats(1.0, 50.0))
def test_clamping_lands_in_the_hull_and_keeps_the_direction(seed, far):
    points, rng = cloud(seed)
    space = ControlSpace.build(points)
    query = space.anchor + far * (inner(points, rng, 20) - space.anchor)
    found = space.clamp(query)
    assert space.inside(found).all()
    np.testing.assert_array_equal(ConvexHull(np.concatenate([points, found]) / SCALE).vertices,
                                  ConvexHull(points / SCALE).vertices)
    share = np.sum((found - space.anchor) * (query - space.anchor), -1) / np.sum((query - space.anchor)**2, -1)
    np.testing.assert_allclose(found - space.anchor, share[:, None] * (query - space.anchor), atol=1e-9)
    assert np.all(share <= 1 + 1e-12) and np.all(share > 0)
    outside = ~space.inside(query)
    assert not space.inside(space.anchor + 1.001 * (found - space.anchor))[outside].any(), "as far as it can"
    np.testing.assert_allclose(space.clamp(found), found, atol=1e-9)


@law
@given(seeds)
def test_clamping_leaves_the_inside_alone(seed):
    points, rng = cloud(seed)
    space = ControlSpace.build(points)
    query = space.anchor + 0.999 * (inner(points, rng, 20) - space.anchor)
    assert space.inside(query).all()
    np.testing.assert_allclose(space.clamp(query), query, rtol=0, atol=1e-14)
    np.testing.assert_array_equal(space.clamp(space.anchor), space.anchor)


@law
@given(seeds, st.floats(0, 0.3))
def test_an_anchor_may_be_anywhere_inside(seed, share):
    """Towards rest a clamped wish keeps its arc: the ratio of turning to walking."""
    points, rng = cloud(seed)
    anchor = (1 - share) * points.mean(0) + share * inner(points, rng, 1)[0]
    assume(ControlSpace.build(points).inside(anchor * 1.0))
    space = ControlSpace.build(points - anchor, np.zeros(3))
    wish = rng.normal(size=(10, 3)) * 20
    found = space.clamp(wish)
    np.testing.assert_allclose(np.cross(found, wish), 0, atol=1e-9)
    assert np.all(np.sum(found * wish, -1) > 0)


@law
@given(seeds, st.floats(1.0, 50.0))
def test_a_runner_gives_up_turning_before_speed(seed, far):
    """Where speed is kept, a query outside keeps its v_f wherever the hull holds any of that v_f straight on."""
    points, rng = cloud(seed)
    space = ControlSpace.build(points + [3, 0, 0], keep_speed=True)
    query = inner(space.points, rng, 20) * [1, far, far]
    found = space.clamp(query)
    assert space.inside(found).all() and np.all(space.anchor[1:] == 0)
    kept = (query[:, 0] > space.lane[0]) & (query[:, 0] < space.lane[1])
    np.testing.assert_allclose(found[kept, 0], query[kept, 0], atol=1e-9)
    np.testing.assert_allclose(found[kept, 1] * query[kept, 2], found[kept, 2] * query[kept, 1], atol=1e-9)
    assert np.all(found[query[:, 0] > space.lane[1], 0] >= space.lane[1] - 1e-9)
    wild = space.clamp([[-50.0, 9, 9], [50.0, 9, 9]])
    assert space.inside(wild).all() and np.all(wild[:, 0] >= space.lane[0] - 0.5) and wild[1, 0] >= space.lane[1] - 1e-9


def told(space, deviation):
    """A space that knows the deviations (≥ E, 3) of its edges, in their order."""
    pairs, _ = space.edges()
    return space.with_bend(np.concatenate([pairs, deviation[:len(pairs)]], -1))


def test_a_bend_belongs_to_its_edge_whatever_the_order():
    """A triangulation made anew may number its edges otherwise; those it was not told of are straight."""
    points, rng = cloud(5)
    space = ControlSpace.build(points)
    pairs, _ = space.edges()
    bend = np.concatenate([pairs, rng.normal(size=(len(pairs), 3))], -1)
    mixed = space.with_bend(rng.permutation(bend))
    np.testing.assert_array_equal(mixed.bend, space.with_bend(bend).bend)
    assert not space.with_bend(bend[:0]).bend.any()


@pytest.mark.parametrize("batch", BATCHES, ids=str)
def test_any_batch_axes(batch):
    points, rng = cloud(3)
    space = told(ControlSpace.build(points), rng.normal(size=(1000, 3)) * 0.05)
    query = rng.normal(size=batch + (3,)) * SCALE
    flat = query.reshape(-1, 3)
    assert space.inside(query).shape == batch and space.locate(query)[0].shape == batch
    for one in (space.clamp, space.deviation, space.weights, lambda q: space.locate(q)[1]):
        result = one(query)
        np.testing.assert_allclose(result.reshape(len(flat), -1), [one(q) for q in flat], atol=1e-12)
        assert result.shape[:-1] == batch


# slivers

@law
@given(seeds, st.floats(2.0, 12.0))
def test_thinning_leaves_no_sliver(seed, steepest):
    points, _ = cloud(seed, 20)
    left = thin(points, np.zeros(20, bool), steepest)
    assert np.all(np.diff(left) > 0)
    if len(left) > 5:
        assert ControlSpace.build(points[left]).lipschitz() <= steepest * (1 + 1e-9)


@law
@given(seeds)
def test_thinning_keeps_what_it_must(seed):
    points, rng = cloud(seed, 20)
    keep = rng.random(20) < 0.3
    left = thin(points, keep, 3.0)
    assert np.isin(np.flatnonzero(keep), left).all()
    if len(left) > 5:
        space = ControlSpace.build(points[left])
        rows = np.concatenate([space.transform[:, :3], -space.transform[:, :3].sum(1, keepdims=True)], 1)
        steep = np.linalg.norm(rows, axis=-1) > 3.0
        assert keep[left][space.simplices[steep]].all(), "only protected points make slivers still"


def test_thinning_leaves_a_good_space_alone():
    grid = np.stack(np.meshgrid(*[[-1.0, 0, 1]] * 3), -1).reshape(-1, 3) + np.random.default_rng(0).normal(size=(27, 3)) * 0.05
    space = ControlSpace.build(grid * SCALE)
    np.testing.assert_array_equal(thin(grid * SCALE, np.zeros(27, bool), space.lipschitz() * 1.01), np.arange(27))


def test_quality_is_one_for_a_regular_tetrahedron():
    turn, _ = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))
    for size in (0.1, 1.0, 7.0):
        space = ControlSpace.build((TETRAHEDRON * size @ turn + [1, 2, 3]) * SCALE)
        np.testing.assert_allclose(space.quality(), 1.0, atol=1e-9)


@law
@given(seeds)
def test_quality_is_three_inradii_over_the_circumradius(seed):
    """By the linear equations of the circumcentre and by the volume of the inner pyramid."""
    points, _ = cloud(seed, 8)
    space = ControlSpace.build(points)
    for corners, quality in zip((points / SCALE)[space.simplices], space.quality()):
        centre = np.linalg.solve(2 * (corners[1:] - corners[0]), np.sum(corners[1:]**2, -1) - np.sum(corners[0]**2))
        area = sum(0.5 * np.linalg.norm(np.cross(b - a, c - a)) for a, b, c in combinations(corners, 3))
        inradius = 3 * abs(np.linalg.det(corners[1:] - corners[0])) / 6 / area
        assert quality == pytest.approx(3 * inradius / np.linalg.norm(corners[0] - centre), rel=1e-6)
        assert 0 < quality <= 1 + 1e-9


# how blends bend

@law
@given(seeds)
def test_deviation_is_exact_for_every_quadratic(seed):
    """Told at the edges' middles, the element knows any quadratic map, and nothing at the corners."""
    points, rng = cloud(seed, 12)
    form = rng.normal(size=(3, 3, 3))
    def bent(v):
        return np.einsum("...i,kij,...j->...k", v, form, v)
    space = ControlSpace.build(points)
    a, b = points[space.edges()[0]].transpose(1, 0, 2)
    middle = 0.5 * (a + b)
    bend = bent(middle) - 0.5 * (bent(a) + bent(b))
    space = told(space, bend)
    query = inner(points, rng, 20)
    blended = space.weights(query, correct=0) @ bent(points)
    np.testing.assert_allclose(space.deviation(query), bent(space.clamp(query)) - blended, atol=1e-6)
    steep = space.lipschitz() * np.abs(bend).max()  # hull points are clamped a millionth inwards
    np.testing.assert_allclose(space.deviation(middle), bend, atol=1e-4 * steep)
    np.testing.assert_allclose(space.deviation(points), 0, atol=1e-4 * steep)


@law
@given(seeds)
def test_correction_inverts_the_bend(seed):
    """With enough corrections the blend moves at the wish: its mean velocity plus its deviation."""
    points, rng = cloud(seed, 30)
    points = points[thin(points, np.zeros(30, bool), 5.0)]
    assume(len(points) > 8)
    space = ControlSpace.build(points)
    space = told(space, rng.normal(size=(1000, 3)) * 0.01 * SCALE)
    query = space.anchor + 0.6 * (inner(points, rng, 20) - space.anchor)

    def error(correct):
        weights = space.weights(query, correct)
        nominal = weights @ points
        return np.abs((nominal + space.deviation(nominal) - query) / SCALE).max()
    assert error(20) < 1e-4
    assert error(20) < error(2) < error(0) or error(0) < 1e-6


@law
@given(seeds)
def test_edges_are_each_named_once(seed):
    points, _ = cloud(seed, 15)
    space = ControlSpace.build(points)
    pairs, number = space.edges()
    assert {tuple(p) for p in pairs} == {tuple(sorted((int(a), int(b)))) for s in space.simplices for a, b in combinations(s, 2)}
    assert len({tuple(p) for p in pairs}) == len(pairs)
    for simplex, numbers in zip(space.simplices, number):
        assert {tuple(pairs[n]) for n in numbers} == {tuple(sorted((int(a), int(b)))) for a, b in combinations(simplex, 2)}


# what can't be triangulated

@pytest.mark.parametrize("points", (
    np.zeros((0, 3)), np.zeros((9, 3)), np.eye(3), np.linspace(0, 1, 9)[:, None] * [1.0, 2.0, 3.0],
    np.random.default_rng(0).normal(size=(20, 3)) * [1, 1, 0], np.random.default_rng(0).normal(size=(20, 3)) * [1, 1, 1e-7],
), ids=("none", "all alike", "three", "on a line", "in a plane", "all but in a plane"))
def test_velocities_that_do_not_span_the_space_are_refused(points):
    with pytest.raises(ValueError, match=f"must span .*{len(points)} points"):
        ControlSpace.build(points)


def test_an_anchor_not_well_inside_moves_in():
    points, _ = cloud(4)
    for anchor in (points[0], 10 * points[0]):
        space = ControlSpace.build(points, anchor)
        assert space.inside(space.anchor)
        assert np.all(space.inside(space.clamp(5 * points)))
