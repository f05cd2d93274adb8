"""Laws of steering and of path following."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gambol.controllers.body.rotations import wrap
from gambol.controllers.navigation import Path, Reach, Steering, drift, follow, in_world, steer, turn_towards
from gambol.controllers.navigation.steering import within

angle = st.floats(-10.0, 10.0)
speed = st.floats(0.0, 3.5)


def wish(speed, direction):
    return speed * np.array([np.sin(direction), np.cos(direction)])


@given(angle, speed, angle, st.one_of(st.none(), angle), st.floats(-3, 3))
def test_an_intent_is_finite_and_within_reach(heading, v, direction, facing, turning):
    intent = steer(np.array([1.0, 2.0, heading]), wish(v, direction), facing, turning).velocity
    assert np.all(np.isfinite(intent))
    assert abs(intent[1]) <= Steering().turn + 1e-9
    reach = Reach()
    along = reach.forward if intent[0] >= 0 else reach.backward
    assert (intent[0] / along) ** 2 + (intent[2] / reach.lateral) ** 2 <= 1 + 1e-9


@given(angle, st.floats(0.01, 1.3))
def test_who_looks_where_it_goes_gets_what_it_wishes(heading, v):
    assert np.allclose(steer(np.array([0, 0, heading]), wish(v, heading)).velocity, [v, 0, 0], atol=1e-9)


@given(angle, st.floats(0.0, 0.5), angle)
def test_strafing_keeps_the_world_velocity(heading, v, direction):
    ground = np.array([0.0, 0.0, heading])
    intent = steer(ground, wish(v, direction), facing=heading)
    assert np.allclose(in_world(ground, intent.velocity), wish(v, direction), atol=1e-9)
    assert abs(intent.velocity[1]) < 1e-9


def test_a_wish_of_nothing_is_rest_and_nothing_jumps_around_it():
    ground = np.array([0.0, 0.0, 0.3])
    assert np.array_equal(steer(ground, np.zeros(2)).velocity, np.zeros(3))
    for direction in np.linspace(0, 2 * np.pi, 24):
        assert np.abs(steer(ground, wish(1e-3, direction)).velocity).max() < 2e-3


@given(angle, st.floats(0.2, 3.0), angle, st.floats(-1e-4, 1e-4))
def test_a_small_change_of_wish_is_a_small_change_of_intent(heading, v, direction, change):
    if abs(abs(wrap(direction - heading)) - np.pi) < 1e-3:
        return  # straight behind, where a choice must fall
    ground = np.array([0.0, 0.0, heading])
    a, b = (steer(ground, wish(v, d)).velocity for d in (direction, direction + change))
    assert np.abs(a - b).max() <= 10 * abs(change) + 1e-12


@pytest.mark.parametrize("turning", [1.0, -1.0])
def test_straight_behind_a_turn_under_way_goes_on(turning):
    for wanted in np.pi + np.linspace(-0.3, 0.3, 13):
        omega, _ = turn_towards(0.0, wanted, turning)
        assert np.sign(omega) == np.sign(turning)


def test_stick_back_from_rest_turns_within_a_pace_and_walks_back():
    ground, omega = np.zeros(3), 0.0
    furthest = 0.0
    for _ in range(240):
        v = steer(ground, np.array([0.0, -1.3]), turning=omega).velocity
        omega = v[1]
        ground = drift(ground, v, [1 / 60])[0]
        furthest = max(furthest, ground[1])
    assert abs(abs(wrap(ground[2])) - np.pi) < 0.02 and ground[1] < -1.0 and furthest < 0.4


def test_batches_agree_with_one_at_a_time():
    rng = np.random.default_rng(3)
    ground, velocity = rng.normal(size=(4, 5, 3)), rng.normal(size=(4, 5, 2))
    facing = np.where(rng.random((4, 5)) < 0.5, np.nan, rng.normal(size=(4, 5)))
    turning = rng.normal(size=(4, 5))
    together = steer(ground, velocity, facing, turning).velocity
    for i in np.ndindex(4, 5):
        alone = steer(ground[i], velocity[i], None if np.isnan(facing[i]) else facing[i], turning[i])
        assert np.allclose(together[i], alone.velocity)


@given(st.lists(st.floats(-3, 3), min_size=3, max_size=3))
def test_drift_is_what_small_steps_add_up_to(velocity):
    ground = np.array([0.3, -0.2, 0.7])
    stepped = ground
    for _ in range(50):
        stepped = drift(stepped, velocity, [0.02])[0]
    assert np.allclose(stepped, drift(ground, velocity, [1.0])[0], atol=1e-9)


def test_within_keeps_direction_and_turning():
    v = np.array([-2.0, 1.3, 1.0])
    short = within(v, Reach())
    assert short[1] == 1.3 and np.isclose(short[0] / short[2], v[0] / v[2]) and abs(short[2]) <= 0.6


def test_a_path_is_walked_to_its_end_even_where_it_crosses_itself():
    path = Path(np.array([[0, 0], [4, 0], [4, 4], [2, 4], [2, -2]]))
    ground, progress, omega, worst, last = np.zeros(3), 0.0, 0.0, 0.0, 0.0
    for _ in range(60 * 20):
        velocity, progress = follow(path, ground, np.float64(progress), 1.2)
        assert progress >= last
        last = progress
        v = steer(ground, velocity, turning=omega).velocity
        omega = v[1]
        ground = drift(ground, v, [1 / 60])[0]
        worst = max(worst, np.linalg.norm(path.at(progress) - ground[:2]))
    assert np.linalg.norm(ground[:2] - [2, -2]) < 0.15 and worst < 0.5


@given(st.floats(-1, 5), st.floats(-1, 1), st.floats(0, 4))
def test_progress_lies_in_its_window_and_is_nearest_there(x, z, since):
    path = Path(np.array([[0, 0], [1.5, 0.2], [4, 0]]))
    wish, found = follow(path, np.array([x, z, 0.3]), since, 1.2, ahead=0.5, brake=0.5)
    until = min(since + 1.0, path.length)
    since = min(since, path.length)
    assert since - 1e-9 <= found <= until + 1e-9
    samples = path.at(np.linspace(since, until, 200))
    gap = np.linalg.norm(path.at(found) - [x, z])
    assert gap <= np.linalg.norm(samples - [x, z], axis=1).min() + 1e-9
    way = path.at(found + 0.5) - [x, z]
    speed = 1.2 * min((path.length - found) / 0.5, 1.0)
    np.testing.assert_allclose(wish, speed * way / max(np.linalg.norm(way), 1e-9), atol=1e-12)


def test_a_batch_follows_as_each_does():
    path = Path(np.array([[0, 0], [1.5, 0.2], [4, 0]]))
    grounds, since = np.random.default_rng(0).uniform(-1, 4, (3, 2, 3)), np.array([0.0, 2.0])
    wish, made = follow(path, grounds, since, 1.2)
    for i in np.ndindex(3, 2):
        one, there = follow(path, grounds[i], since[i[1]], 1.2)
        np.testing.assert_array_equal(wish[i], one)
        assert made[i] == there


@pytest.mark.parametrize("points", [[[0, 0]], [[0, 0], [0, 0]], [0, 1]])
def test_points_that_make_no_path_are_refused(points):
    with pytest.raises(ValueError, match="path"):
        Path(points)
