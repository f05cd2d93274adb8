"""The sun's shadow maps and where on the floor they are looked up: no GL."""

import numpy as np
import pytest
from poses import STAND, STRIDE, camera, figure

from gambol.game.render import sun
from gambol.game.render.ground import SQUARE, covered, touched_floor
from gambol.game.scene.scene import Box, Camera, Pillar


def seen(matrix, points):
    return points @ matrix[:3, :3].T + matrix[:3, 3]


def test_the_light_box_holds_the_figure_and_its_shadow():
    for posed in (figure(**STAND), figure(**STRIDE, at=(3.3, -7.7)), figure()):
        shot = camera(eye=posed.positions[0] + [1, 1, 4], target=posed.positions[0])
        box = sun.figures_box(shot, (posed,), 1024)
        at = seen(box.matrix(np.zeros(3)), posed.positions)
        assert at.min() > 0.0 and at.max() < 1.0
        shadow = posed.positions - sun.SUN * (posed.positions[:, 1:2] / sun.SUN[1])
        assert np.allclose(seen(box.matrix(np.zeros(3)), shadow)[:, :2], at[:, :2])


def test_the_light_box_moves_in_whole_texels_and_keeps_its_size():
    corners, sizes = [], []
    for k in range(20):
        posed = figure(**STRIDE, at=(0.013 * k, 0.021 * k))
        box = sun.figures_box(camera(), (posed,), 2048)
        corners.append(box.corner / box.size * 2048)
        sizes.append(box.size)
    assert np.ptp(sizes, axis=0).max() < 1e-12
    assert np.abs(np.array(corners) - np.round(corners)).max() < 1e-6


def test_no_light_box_where_nothing_near_casts_a_shadow():
    assert sun.figures_box(camera(), (), 1024) is None
    assert sun.figures_box(camera(), (figure(at=(500, 0)),), 1024) is None
    broken = figure()
    broken.positions[:] = np.nan
    assert sun.figures_box(camera(), (broken,), 1024) is None


@pytest.mark.parametrize("solid", [Box((0, 0.5, 0), (1, 1, 1)), Box((3, 1.2, -2), (0.2, 1.0, 9.0), 0.7),
                                   Box((0, 0.05, 0), (2, 0.1, 2), -2.0), Pillar((1, 0, 2))])
def test_the_solids_light_box_holds_them_and_stays_where_it_is(solid):
    here, there = (sun.solids_box(Camera(np.array([x, 2.0, 5.0]), np.array([x, 1.0, 0.0])), (solid,), 1024)
                   for x in (0, 9.3))
    at = seen(here.matrix(np.zeros(3)), sun.corners(solid))
    assert at.min() > 0.0 and at.max() < 1.0
    assert (here.corner == there.corner).all() and (here.size == there.size).all()


def test_a_large_stage_is_lit_where_one_looks():
    stage = (Box((-200, 1, 0), (1, 2, 1)), Box((200, 1, 0), (1, 2, 1)))
    box = sun.solids_box(Camera(np.array([190.0, 2, 5]), np.array([198.0, 1, 0])), stage, 1024)
    assert box.size.max() <= sun.STAGE_LARGEST and (box.corner % sun.STAGE_STEP == 0).all()
    at = seen(box.matrix(np.zeros(3)), sun.corners(stage[1]))
    assert at.min() > 0.0 and at.max() < 1.0


def test_a_map_is_the_same_counted_from_any_origin():
    box, origin = sun.figures_box(camera(), (figure(),), 1024), np.array([40.0, 0.0, -8.0])
    points = np.random.default_rng(0).normal(size=(20, 3))
    assert np.allclose(seen(box.matrix(np.zeros(3)), points), seen(box.matrix(origin), points - origin))


def holds(triangles, points):
    """Whether each point (N, 3) lies in one of the triangles (K, 3) of the floor."""
    t = triangles.reshape(-1, 3, 3)
    return np.array([(np.cross(np.roll(t, -1, 1) - t, p - t)[..., 1].min(1) > -1e-9).any() for p in points])


def test_the_floor_looks_for_shadows_wherever_one_may_fall_and_little_beyond():
    posed, wall = figure(**STAND), Box((4, 1.0, 3), (0.2, 2.0, 5.0), 0.7)
    triangles = touched_floor((posed,), (wall,), np.zeros(3))
    casters = np.concatenate([posed.positions, sun.corners(wall)])
    assert holds(triangles, casters - sun.SUN * (casters[:, 1:2] / sun.SUN[1])).all()
    assert holds(triangles, posed.positions[[16, 20]] * [1, 0, 1]).all()
    area = 0.5 * SQUARE**2 * len(triangles) / 3
    assert area < 30.0 and not holds(triangles, np.array([[-4.0, 0, -4], [8, 0, 8]])).any()


def test_squares_of_overlapping_outlines_come_once():
    rim = np.array([[0, 0, 0], [0, 0, 1.0], [1.0, 0, 1.0], [1.0, 0, 0]]) + 0.01
    once, twice = covered([rim]), covered([rim, rim + [0.3, 0, 0]])
    assert holds(once, np.array([[0.02, 0, 0.02], [1.0, 0, 0.9]])).all() and len(once) < len(twice) < 1.5 * len(once)
    centres = twice.reshape(-1, 6, 3).mean(1)
    assert len(np.unique(centres, axis=0)) == len(centres)
    area = np.cross(twice[1::3] - twice[::3], twice[2::3] - twice[::3])[:, 1]
    assert np.allclose(area, SQUARE**2)  # all face up
    assert covered([]).shape == (0, 3)


def test_a_vast_platform_costs_no_more_than_the_whole_floor():
    assert len(touched_floor((figure(),), (Box((0, -0.1, 0), (300, 0.4, 300)),), np.zeros(3))) == 6
