"""Who stands between a camera and whom it follows is seen through: smoothly, and nobody else."""

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from gambol.game.camera import Follow, seen_past
from gambol.game.camera.near_bodies import FULL, LEAST, NARROW, SHORT, SOFT, WIDE
from gambol.game.scene.scene import Camera, Figure

HEIGHTS = np.linspace(0.1, 1.7, 17)
coordinate = st.floats(-6.0, 6.0)
place = st.tuples(coordinate, coordinate)
arm = st.floats(0.0, 12.0)
angle = st.floats(-math.pi, math.pi)
STEEPEST = 1.5 * (1.0 - LEAST) / SOFT * (1.0 + (WIDE - NARROW) / FULL)
"""No cover changes faster than this with what is between [1/m]: the steepest of a smooth step, over a cone's flank."""


def someone(x, z):
    return Figure(np.stack([np.full(17, x), HEIGHTS, np.full(17, z)], -1), np.tile(np.eye(3), (17, 1, 1)))


def camera(yaw, length):
    return Follow.behind(np.array([0.0, 0.0, yaw]), distance=length).view()


def cover(at, view):
    return seen_past((someone(0.0, 0.0), someone(*at)), view, (0,))[1].cover


@given(place, angle, arm)
def test_who_is_followed_never_fades_and_others_never_wholly(at, yaw, length):
    view = camera(yaw, length)
    first, other = seen_past((someone(0.0, 0.0), someone(*at)), view, (0,))
    assert first.cover == 1.0 and LEAST <= other.cover <= 1.0
    assert all(one.cover == 1.0 for one in seen_past((someone(*at),) * 2, view, (0, 1)))


@given(place, place, angle, st.floats(0.0, 12.0))
def test_bodies_fade_as_smoothly_as_they_move(a, b, yaw, length):
    view = camera(yaw, length)
    assert abs(cover(a, view) - cover(b, view)) <= STEEPEST * math.dist(a, b) + 1e-9


@given(place, arm, st.floats(-0.01, 0.01))
def test_bodies_fade_as_smoothly_as_the_arm_is_drawn_in(at, length, more):
    length = max(length, 0.1)
    assert abs(cover(at, camera(0.0, length)) - cover(at, camera(0.0, length + more))) <= 12.0 * abs(more) + 1e-9


@given(angle, st.floats(1.5, 12.0), st.floats(0.0, 1.0))
def test_who_stands_in_the_line_of_sight_or_at_the_eye_is_seen_through(yaw, length, share):
    view = camera(yaw, length)
    at = view.eye + share * (1.0 - SHORT / length) * (view.target - view.eye)
    stands = someone(at[0], at[2])
    raised = Figure(stands.positions + [0.0, at[1] - HEIGHTS[-1], 0.0], stands.orientations)
    assert abs(seen_past((someone(0.0, 0.0), raised), view, (0,))[1].cover - LEAST) < 1e-9


@given(angle, st.floats(3.0, 12.0), st.floats(0.0, 3.0), st.floats(-3.0, 3.0))
def test_who_stands_beside_or_beyond_whom_it_follows_stays_whole(yaw, length, beyond, aside):
    ahead, across = np.array([math.sin(yaw), math.cos(yaw)]), np.array([math.cos(yaw), -math.sin(yaw)])
    at = (beyond * ahead + math.copysign(max(abs(aside), 0.8 if beyond < 0.5 else 0.0), aside) * across)
    assert cover(tuple(at), camera(yaw, length)) == 1.0


def test_a_camera_on_its_target_hides_nobody_by_nothing():
    here = np.array([0.0, 1.0, 0.0])
    assert LEAST <= cover((2.0, 0.0), Camera(here, here)) <= 1.0
