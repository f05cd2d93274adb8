"""Points under the pointer: where they are in the picture, and how they are dragged."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gambol.game.app.point_picking import Grip, nearest, project, unproject
from gambol.game.scene.scene import Camera


vectors = st.tuples(*(st.floats(-5, 5),) * 3).map(np.array)


@given(vectors, vectors, st.floats(0.2, 2.0), st.floats(0.5, 3.0), st.floats(0, 3), st.floats(0, 1), st.floats(0.2, 40))
def test_projecting_undoes_unprojecting(eye, away, fov, aspect, x, y, depth):
    camera = Camera(eye, eye + away + [0.0, 0.0, 0.01 + np.linalg.norm(away)], fov=fov)
    place = np.array([x, y, depth])
    assert np.allclose(project(camera, aspect, unproject(camera, aspect, place)), place, atol=1e-6 * depth * (1 + x))


def test_the_renderer_draws_a_point_where_it_is_picked():
    from gambol.game.render import view

    camera, size = Camera(np.array([2.0, 1.5, -3.0]), np.array([0.3, 1.0, 0.0]), fov=0.8), (1280, 720)
    rng = np.random.default_rng(0)
    points = rng.uniform(-1, 1, (50, 3)) + [0, 1, 0]
    matrix = view.perspective(camera.fov, size[0] / size[1]) @ view.look_at(camera.eye, camera.target, camera.up)
    clip = np.concatenate([points, np.ones((50, 1))], 1) @ matrix.T
    pixels = (0.5 + 0.5 * clip[:, :2] / clip[:, 3:] * [1, -1]) * size
    assert np.allclose(project(camera, size[0] / size[1], points)[:, :2] * size[1], pixels, atol=1e-6)
    for number in range(50):
        x, y = pixels[number] / size[1]
        picked = nearest(camera, size[0] / size[1], points, x, y)
        assert np.linalg.norm(project(camera, size[0] / size[1], points[picked])[:2] - [x, y]) < 0.0072
    assert nearest(camera, size[0] / size[1], points, -1.0, 0.5) is None
    behind = camera.eye + 2.0 * (camera.eye - camera.target)
    assert nearest(camera, 1.6, behind[None], 0.8, 0.5) is None


def test_a_drag_stays_in_the_plane_and_deeper_stays_on_the_line_of_sight():
    camera = Camera(np.array([0.0, 1.0, -4.0]), np.array([0.0, 1.0, 0.0]), fov=0.8)
    grip = Grip.of(camera, 1.5, np.array([[0.2, 1.3, 0.5]]), 0, 0.74, 0.41)
    assert np.allclose(grip.place(camera, 1.5, 0.74, 0.41), [0.2, 1.3, 0.5])
    moved = grip.place(camera, 1.5, 0.60, 0.30)
    assert moved[2] == pytest.approx(0.5) and moved[1] > 1.3 and moved[0] > 0.2  # left on the screen is +X, seen from behind
    for deeper in (grip.pushed(3.0), grip.slid(0.0, -0.1)):
        place = deeper.place(camera, 1.5, 0.74, 0.41 - (0.1 if deeper.off != grip.off else 0.0))
        assert place[2] > 0.5
        assert np.allclose(project(camera, 1.5, place)[:2], project(camera, 1.5, np.array([0.2, 1.3, 0.5]))[:2])
