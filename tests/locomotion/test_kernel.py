"""The compiled hot path against plain double-precision arithmetic, piece by piece."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from gambol.controllers.locomotion import fourier
from gambol.controllers.locomotion.blend import Blender
from gambol.controllers.locomotion.control_space import SCALE, ControlSpace
from gambol.controllers.locomotion.kernel import (COLUMNS, DURATION_AT, HIPS_AT, LABELS_AT, LANES, SCRATCH, body_tables,
                                                  inner_kernel, locate_kernel, pose_kernel, query_kernel, series_kernel,
                                                  series_table, space_tables)

law = settings(max_examples=30, deadline=None)
seeds = st.integers(0, 2**32 - 1)


def plain_pose(library, values):
    """Positions (J, 3), orientations and local rotations of one series value (D,), by scipy and a loop."""
    skeleton = library.skeleton
    joints = len(skeleton)
    local = library.reference @ Rotation.from_rotvec(values[:3 * joints].reshape(joints, 3)).as_matrix()
    positions, orientations = np.zeros((joints, 3)), local.copy()
    positions[0] = values[3 * joints:3 * joints + 3]
    for j in range(1, joints):
        p = skeleton.parents[j]
        positions[j] = positions[p] + orientations[p] @ skeleton.offsets[j]
        orientations[j] = orientations[p] @ local[j]
    return positions, orientations, local


def velocities(rng, count, far=1.0):
    return rng.uniform(-1, 1, (count, 3)) * [1.6, 2.6, 0.7] * far


@pytest.mark.parametrize("correct", (0, 2))
def test_blended_poses_agree_with_plain_arithmetic(locomotion, correct):
    """Eq. (4), (5) and (6) in double precision: positions within 0.1 mm, inside the hull and out."""
    library, rng = locomotion.library, np.random.default_rng(0)
    velocity, phase = velocities(rng, 200), rng.random(200).astype(np.float32)
    positions, orientations, local = Blender(locomotion, correct)(velocity, phase)
    weights = locomotion.walk.weights(velocity, correct)
    members = library.family("walk")
    for n in range(200):
        rows = np.tensordot(weights[n], library.coefficients[members], 1)
        wanted = plain_pose(library, fourier.evaluate(rows, float(phase[n])))
        np.testing.assert_allclose(positions[n], wanted[0], atol=1e-4)
        np.testing.assert_allclose(orientations[n], wanted[1], atol=2e-5)
        np.testing.assert_allclose(local[n], wanted[2], atol=2e-5)


def test_blending_does_not_depend_on_where_the_search_begins(locomotion):
    rng, blend = np.random.default_rng(1), Blender(locomotion)
    velocity, phase = velocities(rng, 50), rng.random(50).astype(np.float32)
    first = blend(velocity, phase)[0]
    anywhere = rng.integers(0, len(locomotion.walk.simplices), 50)
    np.testing.assert_allclose(blend(velocity, phase, anywhere)[0], first, atol=1e-5)
    assert np.all((anywhere >= 0) & (anywhere < len(locomotion.walk.simplices)))


def test_blending_writes_where_it_is_told(locomotion):
    blend = Blender(locomotion)
    output = blend.output(3)
    found = blend(np.zeros((3, 3)), np.zeros(3, np.float32), output=output)
    assert all(a is b for a, b in zip(found, output, strict=True))


@law
@given(seeds, st.floats(0.2, 30.0), st.sampled_from(("walk", "run")))
def test_searching_agrees_with_looking_everywhere(locomotion, seed, far, family):
    """From any simplex, inside the hull or far out: the weights of `ControlSpace`."""
    space, rng = getattr(locomotion, family), np.random.default_rng(seed)
    tables = space_tables(space, np.arange(len(space.points)))
    for velocity in space.anchor + velocities(rng, 10, far):
        part, weights = np.empty(4), np.zeros(len(space.points))
        start, inner = int(rng.integers(len(space.simplices))), np.empty(3)
        inner_kernel(tables, velocity / SCALE, inner)
        simplex = locate_kernel(tables, velocity / SCALE, inner, start, part)
        weights[space.simplices[simplex]] = part
        np.testing.assert_allclose(weights, space.weights(velocity, correct=0), atol=1e-5)


@law
@given(seeds, st.integers(0, 4))
def test_corrected_queries_agree(locomotion, seed, correct):
    """To rounding, unless a correction leads out of the hull: there both keep a millionth off it, each in its own way, and
    what that is times the steepest weight (13) is all that may differ, once. The next correction is told from a place on
    the hull towards which there is hardly any room, and may make much of it: then there is no law but that of weights."""
    space, rng = locomotion.walk, np.random.default_rng(seed)
    tables = space_tables(space, np.arange(len(space.points)))
    for velocity in velocities(rng, 10, 0.6):
        part, weights = np.empty(4), np.zeros(len(space.points))
        simplex = query_kernel(tables, velocity, 0, correct, part, np.empty(3), np.empty(3))
        weights[space.simplices[simplex]] = part
        moved, left = space.clamp(velocity), not space.inside(velocity)
        for _ in range(correct):
            asked = space.clamp(velocity) - space.deviation(moved)
            moved, left = space.clamp(asked, space.clamp(velocity)), left or not space.inside(asked)
        assert weights.min() >= 0.0 and weights.sum() == pytest.approx(1.0)
        if correct < 2 or not left:
            np.testing.assert_allclose(weights, space.weights(velocity, correct), atol=2e-5 if left else 1e-12)


def test_any_numbering_of_the_primitives(locomotion):
    """A family's simplices name its primitives by their numbers in the whole library."""
    members = locomotion.library.family("run")
    tables = space_tables(locomotion.run, members)
    np.testing.assert_array_equal(tables.vertices, members[locomotion.run.simplices])


@pytest.mark.parametrize("harmonics", range(13))
def test_series_of_any_length_agree_with_plain_arithmetic(library, harmonics):
    """Odd and even numbers of harmonics, weights that are zero, all columns in their places."""
    rng, joints = np.random.default_rng(harmonics), len(library.skeleton)
    short = replace(library, coefficients=library.coefficients[:, :2 * harmonics + 1])
    weights = rng.random(len(library.primitives)).astype(np.float32) ** 8
    weights[rng.random(len(weights)) < 0.5] = 0
    weights /= weights.sum()
    row = np.empty(COLUMNS, np.float32)
    for phase in (0.0, 0.25, 0.5, 0.99, *rng.random(5)):
        series_kernel(series_table(short), weights, np.float32(phase), row)
        wanted = fourier.evaluate(np.tensordot(weights.astype(float), short.coefficients, 1), np.float32(phase))
        chart = row[:3 * LANES].reshape(3, LANES).T
        np.testing.assert_allclose(chart[:joints], wanted[:3 * joints].reshape(joints, 3), atol=1e-5)
        np.testing.assert_array_equal(chart[joints:], 0)
        np.testing.assert_allclose(row[HIPS_AT:LABELS_AT], wanted[-8:-5], atol=1e-5)
        np.testing.assert_allclose(row[LABELS_AT:DURATION_AT], wanted[-5:-1], atol=1e-5)
        np.testing.assert_allclose(row[DURATION_AT], wanted[-1], atol=1e-5)


@law
@given(seeds, st.sampled_from((0.0, 1e-8, 1e-4, 0.1, 1.0, 3.1)))
def test_any_pose_agrees_with_scipy(library, seed, size):
    """Rotation vectors from nothing to almost half a turn, not just those that walking has."""
    rng, joints = np.random.default_rng(seed), len(library.skeleton)
    turns = rng.normal(size=(joints, 3))
    turns *= size / np.linalg.norm(turns, axis=-1, keepdims=True)
    values = np.concatenate([turns.ravel(), rng.normal(size=3)])
    row = np.zeros(COLUMNS, np.float32)
    for axis in range(3):
        row[axis * LANES:axis * LANES + joints] = turns[:, axis]
    row[HIPS_AT:LABELS_AT] = values[-3:]
    positions, orientations, local = (np.empty((joints, 3) + tail, np.float32) for tail in ((), (3,), (3,)))
    pose_kernel(body_tables(library), row, local, positions, orientations, np.empty(SCRATCH, np.float32))
    wanted = plain_pose(library, values)
    for found, right, tolerance in zip((positions, orientations, local), wanted, (1e-5, 1e-5, 4e-6)):
        np.testing.assert_allclose(found, right, atol=tolerance)


def test_a_space_of_a_single_simplex():
    """The smallest space there is: no neighbours anywhere."""
    corners = np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
    space = ControlSpace.build(corners * SCALE)
    tables = space_tables(space, np.arange(4))
    for p in np.random.default_rng(0).normal(size=(20, 3)) * 2:
        part, weights = np.empty(4), np.zeros(4)
        simplex = locate_kernel(tables, p.copy(), tables.anchor, 0, part)
        weights[space.simplices[simplex]] = part
        np.testing.assert_allclose(weights, space.weights(p * SCALE, correct=0), atol=1e-5)
