"""Cameras, parts of a picture and what lies on the floor: no GL."""

import numpy as np
import pytest
from poses import STRIDE, camera, figure

from gambol.game.render import overlays, view
from gambol.game.scene.scene import Camera, Overlays


def seen(matrix, points):
    h = np.concatenate([points, np.ones((len(points), 1))], 1) @ matrix.T
    return h[:, :3] / h[:, 3:]


def test_the_target_is_in_the_middle_and_left_is_left():
    shot = camera(eye=(0, 1, 5), target=(0, 1, 0))
    matrix = view.perspective(0.8, 16 / 9) @ view.look_at(shot.eye, shot.target, shot.up)
    middle, right, up = seen(matrix, np.array([[0, 1.0, 0], [1, 1, 0], [0, 2, 0]]))
    assert np.allclose(middle[:2], 0, atol=1e-12) and right[0] > 0.1 and up[1] > 0.1 and abs(right[1]) < 1e-12


@pytest.mark.parametrize("target", [(0, 0, 5), (0, 9, 5), (0, 1, 5)])
def test_odd_cameras_still_look_somewhere(target):
    matrix = view.look_at(np.array([0, 1.0, 5]), np.array(target, float), np.array([0, 1.0, 0]))
    assert np.allclose(matrix[:3, :3] @ matrix[:3, :3].T, np.eye(3)) and np.isfinite(matrix).all()


def test_a_far_walk_keeps_the_floor_in_place():
    shot = Camera(np.array([1234.7, 2.0, -998.1]), np.zeros(3))
    origin = view.origin_of(shot)
    assert np.abs(origin - shot.eye)[[0, 2]].max() <= view.TILE / 2 and np.allclose(origin % view.TILE, 0)


def test_ribbons_survive_all_points_in_one_place_and_pass_through_theirs():
    still = np.zeros((40, 3))
    assert len(overlays.ribbon(still, (1, 1, 1), (0, 1), 0.02, overlays.BAND)) == 0
    assert len(overlays.ribbon(np.zeros((0, 3)), (1, 1, 1), (0, 1), 0.02, overlays.BAND)) == 0
    points = np.array([[0, 0, 0], [1, 0, 0.2], [1.5, 0, 1], [1.4, 0, 2.0]])
    curve = overlays.smooth(points)
    for p in points:
        assert np.linalg.norm(curve - p, axis=1).min() < 1e-9


def test_a_ribbon_seen_from_afar_is_no_thinner_than_some_pixels():
    way, metre = np.linspace([0.0, 0.0, 0.0], [0.0, 0.0, 3.0], 7), 700.0
    for high, wide in ((2.0, 0.04), (40.0, overlays.THIN * 40.0 / metre)):
        rows = overlays.ribbon(way, (1, 1, 1), (0, 1), 0.02, overlays.BAND, eye=np.array([0.0, high, 0.0]), metre=metre)
        assert np.ptp(rows[rows[:, 2] == 0.0, 0]) == pytest.approx(wide, rel=0.01)


def test_marks_only_for_what_is_shown():
    posed = figure(options=dict(contacts=np.array([1, 0, 0, 1], bool)))
    assert len(overlays.marks([posed], Overlays())) == 0
    assert len(overlays.marks([posed], Overlays(contacts=True))) == 12


def test_every_bone_runs_from_joint_to_joint():
    posed = figure(**STRIDE)
    rows = overlays.bones(posed)
    ends = rows[:, :3] + rows[:, 3:6]
    assert np.abs(np.sum(rows[:, 3:6] * rows[:, 6:9], 1)).max() < 1e-12
    assert np.allclose(ends[:21], posed.positions[1:]) and len(rows) == 26


def test_parts_that_share_a_border_share_it_in_pixels():
    for width in (320, 321, 1279):
        left, right = (view.part_of((x, 0.0, 0.5, 1.0), (width, 180)) for x in (0.0, 0.5))
        assert left[0][0] == 0 and left[0][2] == right[0][0] and right[0][0] + right[0][2] == width
        assert left[1][0] == 0 and left[1][2] + 2 == right[1][0] - 0 and right[1][0] + right[1][2] == width
    assert view.part_of((0.5, 0.0, 0.5, 0.5), (100, 100))[0] == (50, 50, 50, 50)  # the top is high in OpenGL


def test_far_cameras_see_through_the_fog():
    near, far = (view.clear_air(Camera(np.array([0, 2.0, z]), np.zeros(3))) for z in (5.0, 25.0))
    assert near == 30.0 and far > 45.0
