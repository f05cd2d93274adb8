"""What a body stands on: hulls like Qhull's, margins like a distance, and nothing that breaks without an inside."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.spatial import ConvexHull, QhullError

from gambol.controllers.body import forward_kinematics, human
from gambol.controllers.body.support_polygon import CORNERS, centroid, hull, margin, sole_corners, standing_corners

clouds = arrays(float, st.tuples(st.integers(3, 14), st.just(2)), elements=st.integers(-40, 40).map(lambda v: v / 16))


@settings(deadline=None)  # the first calls compile
@given(clouds)
def test_hull_margin_and_centre_agree_with_qhull(points):
    try:
        qhull = ConvexHull(points)
    except QhullError:  # a line or a point: no oracle, but no trouble either
        assert len(hull(points)) <= 2
        return
    corners = hull(points)
    np.testing.assert_allclose(sorted(map(tuple, corners)), sorted(map(tuple, points[qhull.vertices])))
    inside = points.mean(0)  # distances to Qhull's half-planes
    expected = -(qhull.equations[:, :2] @ inside + qhull.equations[:, 2]).max()
    assert margin(corners, inside) == pytest.approx(max(expected, 0.0), abs=1e-9)
    fan = np.stack([np.broadcast_to(corners[0], corners[1:-1].shape), corners[1:-1], corners[2:]], 1)
    areas = 0.5 * np.linalg.det(fan[:, 1:] - fan[:, :1])
    assert areas.sum() == pytest.approx(qhull.volume)
    np.testing.assert_allclose(centroid(corners), areas @ fan.mean(1) / areas.sum(), atol=1e-9)


@settings(deadline=None)
@given(clouds, st.floats(-5, 5), st.floats(-5, 5))
def test_outside_the_margin_is_minus_the_distance(points, x, y):
    corners, point = hull(points), np.array([x, y])
    ahead = np.roll(corners, -1, 0) - corners
    part = np.clip(np.sum((point - corners) * ahead, -1) / np.maximum(np.sum(ahead**2, -1), 1e-300), 0, 1)
    distance = np.linalg.norm(point - corners - part[:, None] * ahead, axis=-1).min()
    assert abs(margin(corners, point)) == pytest.approx(distance, abs=1e-12)
    assert margin(corners, points.mean(0)) >= -1e-12


def test_what_has_no_inside_is_safe():
    assert len(hull(np.zeros((0, 2)))) == 0 and margin(np.zeros((0, 2)), np.zeros(2)) == -np.inf
    point = hull(np.ones((5, 2)))
    np.testing.assert_allclose(point, [[1, 1]])
    assert margin(point, np.array([1.0, 3.0])) == -2.0
    line = hull(np.array([[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]))
    np.testing.assert_allclose(line, [[0, 0], [2, 2]])
    assert margin(line, np.array([1.0, 1.0])) == 0.0
    np.testing.assert_allclose(centroid(line), [1, 1])
    with pytest.raises(ValueError, match="nothing stands"):
        centroid(np.zeros((0, 2)))
    with pytest.raises(ValueError, match="finite"):
        hull(np.array([[0.0, np.nan]]))


def test_soles_lie_on_the_floor_and_risen_heels_do_not_carry():
    skeleton = human(1.5)
    placed = forward_kinematics(skeleton, np.array([0.0, skeleton.offsets[0, 1], 0.0]),
                                np.broadcast_to(np.eye(3), (2, len(skeleton), 3, 3)))
    corners = sole_corners(skeleton, *placed)
    assert corners.shape == (2, CORNERS, 3)
    np.testing.assert_allclose(corners[..., 1], 0.0, atol=1e-12)
    both = hull(corners[0, :, [0, 2]].T)
    toes = hull(corners[0, standing_corners([False, True, False, True])][:, [0, 2]])
    assert centroid(both)[0] == pytest.approx(0.0, abs=1e-12)
    assert toes[:, 1].min() > both[:, 1].min() + 0.1
    assert toes[:, 1].max() == both[:, 1].max()
