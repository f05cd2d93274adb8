"""Cameras, the sun's box and what lies on the floor: no GL."""

import numpy as np
import pytest
from poses import STAND, STRIDE, camera, figure

from game.render import overlays, view
from game.render.ground import dark_floor, shaded_floor
from game.scene import Box, Camera, Overlays


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


def test_the_light_box_holds_the_figure_and_its_shadow():
    for posed in (figure(**STAND), figure(**STRIDE, at=(3.3, -7.7)), figure()):
        shot = camera(eye=posed.positions[0] + [1, 1, 4], target=posed.positions[0])
        box = view.light_box(shot, (posed,), (), 1024)
        for points in (posed.positions, shaded_floor((posed,), np.zeros(3))):
            inside = seen(box.matrix, points)
            assert inside.min() > -0.1 and inside.max() < 1.1
        at = seen(box.matrix, posed.positions)
        assert at.min() > 0.0 and at.max() < 1.0
        shadow = posed.positions - view.SUN * (posed.positions[:, 1:2] / view.SUN[1])
        assert np.allclose(seen(box.matrix, shadow)[:, :2], at[:, :2])


def test_the_light_box_moves_in_whole_texels_and_keeps_its_size():
    corners, sizes = [], []
    for k in range(20):
        posed = figure(**STRIDE, at=(0.013 * k, 0.021 * k))
        box = view.light_box(camera(), (posed,), (), 2048)
        corners.append(box.matrix[:2, 3] * 2048)
        sizes.append(box.size)
    assert np.ptp(sizes, axis=0).max() < 1e-12
    assert np.abs(np.array(corners) - np.round(corners)).max() < 1e-6


def test_no_light_box_where_nothing_near_casts_a_shadow():
    assert view.light_box(camera(), (), (), 1024) is None
    assert view.light_box(camera(), (figure(at=(500, 0)),), (), 1024) is None
    broken = figure()
    broken.positions[:] = np.nan
    assert view.light_box(camera(), (broken,), (), 1024) is None


def test_the_outline_of_a_shadow_holds_the_shadow_and_little_more():
    posed = figure(**STAND)
    box = view.light_box(camera(), (posed,), (), 1024)
    triangles = shaded_floor((posed,), np.zeros(3)).reshape(-1, 3, 3)
    area = 0.5 * np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])[:, 1]
    assert (area > -1e-9).all() and area.sum() < 0.35 * box.size.prod() / view.SUN[1]
    shadow = posed.positions - view.SUN * (posed.positions[:, 1:2] / view.SUN[1])
    for p in shadow:
        sides = [np.cross(np.roll(t, -1, 0) - t, p - t)[:, 1].min() for t in triangles]
        assert max(sides) > -1e-9


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


@pytest.mark.parametrize("box", [Box((0, 0.5, 0), (1, 1, 1)), Box((3, 1.2, -2), (0.2, 1.0, 9.0), 0.7),
                                 Box((0, 0.05, 0), (2, 0.1, 2), -2.0)])
def test_a_box_shadow_is_the_hull_of_its_corners_shadows(box):
    rim = view.box_shadows((box,))[0]
    corners = view.box_corners(box)
    flat = corners - view.SUN * (corners[:, 1:2] / view.SUN[1])
    side = np.cross(np.roll(rim, -1, 0) - rim, flat[:, None] - rim)[..., 1]
    assert side.min() > -1e-9
    assert all(np.linalg.norm(flat - corner, axis=1).min() < 1e-9 for corner in rim)


def test_a_wall_does_not_make_shadows_coarse():
    wall = Box((0, 1.5, -2), (14, 3, 0.2))
    plain, walled = (view.light_box(camera(), (figure(),), boxes, 1024) for boxes in ((), (wall,)))
    assert plain.texel == walled.texel
    assert seen(walled.matrix, view.box_corners(wall))[:, 2].min() > 0.0
    assert dark_floor((wall,), np.zeros(3)).shape == (12, 3)
