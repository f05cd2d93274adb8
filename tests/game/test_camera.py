"""Cameras: exact damping, never below the floor, nothing between the eye and the character."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from game.camera import Follow, FollowSettings, damp, dolly, fixed
from game.scene import Box

turn = st.floats(-20, 20)


def settle(camera, ground, seconds, steps, velocity=(0.0, 0.0), boxes=()):
    for _ in range(steps):
        camera = camera.step(np.array(ground), np.array(velocity), seconds / steps, boxes)
    return camera


def test_half_the_way_is_left_after_a_half_life():
    assert damp(1.0, 0.0, 0.3, 0.3) == pytest.approx(0.5)
    assert damp(1.0, 0.0, 0.3, 0.0) == 1.0
    assert damp(1.0, 5.0, 0.0, 0.01) == 5.0


@given(st.integers(1, 200), st.integers(1, 200))
def test_damping_does_not_depend_on_the_frame_rate(a, b):
    def after(steps):
        value = 3.0
        for _ in range(steps):
            value = damp(value, -1.0, 0.12, 0.5 / steps)
        return value
    assert after(a) == pytest.approx(after(b), abs=1e-9)


@pytest.mark.parametrize("steps", [5, 30, 144])
def test_the_camera_arrives_at_the_same_view_at_any_frame_rate(steps):
    start = Follow.behind(np.zeros(3)).turned(0.7, 0.2)
    reference = settle(start, (2.0, 1.0, 0.4), 0.5, 1000).view()
    view = settle(start, (2.0, 1.0, 0.4), 0.5, steps).view()
    assert np.allclose(view.eye, reference.eye, atol=1e-6) and np.allclose(view.target, reference.target, atol=1e-9)


@given(st.lists(st.tuples(turn, turn, st.floats(0.1, 4)), max_size=8), st.floats(0.001, 2))
def test_never_below_the_floor(turns, dt):
    camera = Follow.behind(np.zeros(3))
    for yaw, pitch, zoom in turns:
        camera = camera.turned(yaw, pitch).zoomed(zoom).step(np.zeros(3), np.zeros(2), dt)
        view = camera.view()
        assert view.eye[1] >= FollowSettings().floor - 1e-9
        assert np.linalg.norm(view.eye - view.target) > 0.3


def test_it_starts_behind_and_looks_where_the_character_looks():
    view = Follow.behind(np.array([1.0, 2.0, math.pi / 2])).view()
    assert view.eye[0] < -2 and view.eye[2] == pytest.approx(2.0) and view.target == pytest.approx([1, 1, 2])


def test_it_comes_round_behind_a_walker_but_leaves_one_who_comes_towards_it():
    crossing = settle(Follow.behind(np.zeros(3)), np.zeros(3), 6.0, 360, velocity=(1.3, 0.0))
    assert crossing.yaw == pytest.approx(math.pi / 2, abs=0.4)
    towards = settle(Follow.behind(np.zeros(3)), np.zeros(3), 6.0, 360, velocity=(0.0, -1.3))
    assert towards.yaw == pytest.approx(0.0, abs=0.05)
    held = settle(Follow.behind(np.zeros(3)).turned(0.5), np.zeros(3), 1.0, 60, velocity=(1.3, 0.0))
    assert held.yaw == pytest.approx(0.5, abs=0.01)


def test_recentring_goes_the_shorter_way():
    camera = settle(Follow.behind(np.zeros(3)).turned(9 * math.pi + 0.3), np.zeros(3), 1.0, 60)
    assert abs(camera.recentred(0.0).wanted_yaw - camera.yaw) <= math.pi + 1e-9


def test_a_wall_behind_the_character_shortens_the_arm():
    wall = Box((0.0, 1.0, -2.0), (10.0, 2.0, 0.2), heading=0.0)
    view = settle(Follow.behind(np.zeros(3)), np.zeros(3), 1.0, 60, boxes=(wall,)).view()
    assert view.eye[2] > -1.9
    turned = Box((0.0, 1.0, -2.0), (0.2, 2.0, 10.0), heading=math.pi / 2)
    same = settle(Follow.behind(np.zeros(3)), np.zeros(3), 1.0, 60, boxes=(turned,)).view()
    assert np.allclose(view.eye, same.eye)


def test_a_steady_walker_is_followed_without_jitter():
    camera, gaps = Follow.behind(np.zeros(3)), []
    for i in range(600):
        camera = camera.step(np.array([0.0, 1.3 * i / 60, 0.0]), np.array([0.0, 1.3]), 1 / 60)
        gaps.append(1.3 * i / 60 - camera.focus[2])
    assert np.ptp(gaps[300:]) < 1e-6


def test_unplayable_turns_are_ignored():
    camera = Follow.behind(np.zeros(3))
    assert camera.turned(math.nan) is camera and camera.turned(0.0, math.inf) is camera


def test_rails_begin_and_end_where_they_should_and_stay_above_the_floor():
    assert np.allclose(dolly((0, 1, 0), (4, 1, 0), (0, 1, 5), -1).eye, (0, 1, 0))
    assert np.allclose(dolly((0, 1, 0), (4, 1, 0), (0, 1, 5), 2).eye, (4, 1, 0))
    assert dolly((0, 1, 0), (4, -9, 0), (0, 1, 5), 1).eye[1] > 0
    assert fixed((0, -3, 0), (0, 1, 5)).eye[1] > 0
