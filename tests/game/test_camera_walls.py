"""The follow camera beside walls and stairs: it draws in before something comes between, and stays far enough off to see who it follows."""

import numpy as np
import pytest

from gambol.game.camera.arm import CameraSettings
from gambol.game.camera.follow_camera import Follow
from gambol.game.input import Wish
from gambol.game.scene.scene import Box

WALL = Box((2.0, 1.2, 4.0), (0.2, 2.4, 4.0))


@pytest.mark.parametrize("speed", [1.4, 3.0])
def test_walking_on_behind_a_wall_never_throws_the_eye(speed):
    """Seen from the left, 5 m off; the wall comes between after two metres."""
    settings = CameraSettings(rest=np.inf)
    camera, moved, off = Follow.behind(np.zeros(3), settings, yaw=-0.5 * np.pi, distance=5.0), [], []
    for k in range(round(60 * 8.0 / speed)):
        old, camera = camera, camera.step(np.array([0.0, speed * k / 60, 0.0]), np.array([0.0, speed]), Wish(), 1 / 60, (WALL,))
        moved.append(np.linalg.norm(camera.eye - old.eye))
        off.append(np.linalg.norm(camera.eye - camera.target))
    assert min(off) < 2.5, "the wall does come between"
    assert max(moved) < 0.3 and min(off) > 1.15


def test_what_is_looked_at_stays_on_this_side_of_a_wall():
    wall = Box((0.0, 1.2, 1.0), (4.0, 2.4, 0.1))
    camera = Follow.behind(np.zeros(3))
    for k in range(120):
        camera = camera.step(np.array([0.0, min(0.05 * k, 0.7), 0.0]), np.array([0.0, 3.0]), Wish(), 1 / 60, (wall,))
        assert camera.target[2] < 0.95
