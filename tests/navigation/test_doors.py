"""Doors are found, people queue before them, one side at a time; groups walk side by side."""

import numpy as np
import pytest

from gambol.controllers.locomotion import Locomotion
from gambol.controllers.navigation.crowd import aims, crowd_intent, doors_of, queued, taking_turns, together
from gambol.game.scene import Box, Pillar

WALL = Box((-3.0, 1.0, 0.0), (5.0, 2.0, 0.2)), Box((3.0, 1.0, 0.0), (5.0, 2.0, 0.2))


@pytest.fixture(scope="module")
def walker():
    return Locomotion.load()


def test_a_gap_in_a_wall_is_a_door():
    door, = doors_of(WALL)
    assert np.allclose(door.middle, 0.0) and door.half == pytest.approx(0.5) and abs(door.along[0]) == pytest.approx(1.0)
    turned = [Box((c * x, 1.0, -s * x), (5.0, 2.0, 0.2), 0.5) for x in (-3.0, 3.0) for c, s in [(np.cos(0.5), np.sin(0.5))]]
    assert doors_of(turned)[0].half == pytest.approx(0.5, abs=1e-6)
    assert not doors_of([Box((-1.0, 1.0, 0.0), (0.2, 2.0, 9.0)), Box((1.0, 1.0, 0.0), (0.2, 2.0, 9.0))]), "a corridor is none"
    assert not doors_of([Pillar((-0.7, 0.0, 0.0)), Pillar((0.7, 0.0, 0.0))]), "nor is a gap between pillars"
    assert not doors_of([*WALL, Box((0.0, 1.0, 0.0), (0.3, 2.0, 0.3))]) or all(door.half < 0.5 for door in doors_of([*WALL, Box((0.0, 1.0, 0.0), (0.3, 2.0, 0.3))]))


def test_who_is_nearest_goes_on_and_the_rest_wait():
    places = np.array([[0.0, -0.6], [0.2, -1.2], [-0.2, -1.4], [0.0, -1.7], [0.3, -1.8], [6.0, 5.0]])
    wishes = np.array([[0.0, 1.2]] * 5 + [[1.0, 0.0]])
    found = queued(places, wishes, places + wishes, doors_of(WALL))
    assert np.allclose(found[0], wishes[0]) and np.hypot(*found[4]) < 0.1 and np.allclose(found[5], wishes[5])


def test_who_goes_on_behind_another_keeps_behind_him():
    door = doors_of(WALL)
    for gap, share in ((0.1, 0.0), (0.6, 0.5), (1.0, 1.0)):
        places = np.array([[0.0, -0.3], [0.1, -0.3 - gap]])
        found = queued(places, np.array([[0.0, 1.2]] * 2), places + [0.0, 1.2], door)
        assert np.allclose(found[:, 1], [1.2, 1.2 * share], atol=1e-9)


def test_one_side_at_a_time():
    places, wishes = np.array([[0.1, -0.5], [0.0, 2.5], [0.3, 1.4]]), np.array([[0.0, 1.2], [0.0, -1.2], [0.0, -1.2]])
    found = queued(places, wishes, places + wishes, doors_of(WALL))
    assert np.allclose(found[0], wishes[0]), "who is at the door goes through"
    assert abs(found[2, 1]) < 0.2 and found[2, 0] > 0.3, "who stands in the way steps aside"
    out = queued(np.array([[0.1, 0.8], [0.3, 1.5]]), np.array([[0.0, 1.2], [0.0, -1.2]]), np.array([[0.1, 2.0], [0.0, 0.0]]), doors_of(WALL))
    assert abs(out[1, 1]) < 0.2, "until he is out"


def walked(walker, places, goals, seconds, around=(), groups=None):
    offset = goals - places
    state, trails = walker.start(np.column_stack([places, np.arctan2(offset[:, 0], offset[:, 1])])), []
    lead = goals
    for step in range(round(60 * seconds)):
        lead = aims(state.ground[:, :2], goals, around) if step % 30 == 0 else lead
        state, _ = walker.step(state, crowd_intent(state.ground, state.velocity, lead, 1.2, around=around, groups=groups), 1 / 60)
        trails.append(state.ground[:, :2])
    return np.array(trails)


@pytest.mark.thorough
@pytest.mark.parametrize("shift", [0.0, 0.1, -0.2])
def test_four_of_each_side_get_through_a_door(walker, shift):
    """Two who come to it together go one behind the other, where they pressed into it side by side for six seconds."""
    some = np.array([[x + shift * z, z] for x in (-0.5, 0.6) for z in (-3.0, -2.0)])
    places = np.concatenate([some, -some])
    trails = walked(walker, places, -places * [1.0, 1.3], 19.0, WALL)
    apart = np.linalg.norm(trails[:, :, None] - trails[:, None], axis=-1) + np.eye(8)
    assert apart.min() > 0.42
    assert np.all(np.sign(trails[-1][:, 1]) == -np.sign(places[:, 1])), "everybody is through"


def test_three_walk_abreast_past_one_who_comes(walker):
    places = np.array([[-0.5, 0.0], [0.4, -0.8], [1.2, 0.4], [0.3, 9.0]])
    goals = np.array([[-0.5, 30.0], [0.4, 30.0], [1.2, 30.0], [0.3, -20.0]])
    trails = walked(walker, places, goals, 14.0, groups=[0, 0, 0, -1])
    assert (np.linalg.norm(trails[:, :, None] - trails[:, None], axis=-1) + np.eye(4)).min() > 0.44
    last = trails[-120:, :3]
    assert np.ptp(last[..., 1], axis=1).max() < 0.35, "abreast, as they began otherwise"
    sides = np.sort(last[..., 0], axis=1)
    assert np.all(np.diff(sides, axis=1) > 0.55) and np.all(np.diff(sides, axis=1) < 1.1)


def test_who_walks_alone_wishes_as_before():
    places, wishes = np.array([[0.0, 0.0], [1.0, 0.0], [4.0, 4.0]]), np.array([[0.0, 1.0], [0.0, 1.2], [1.0, 0.0]])
    assert np.array_equal(together(places, wishes, [-1, -1, -1]), wishes)
    found = together(places, wishes, [3, 3, -1])
    assert np.array_equal(found[2], wishes[2]) and found[0, 1] == pytest.approx(found[1, 1])
    with pytest.raises(ValueError, match="groups"):
        together(places, wishes, [0, 0])


def test_whose_turn_it_is_changes_when_nobody_follows_or_the_others_lose_patience():
    doors, away = doors_of(WALL), np.array([[0.0, 9.0], [0.0, -9.0]])
    places, wishes = np.array([[0.0, -0.9], [0.3, 1.8]]), np.array([[0.0, 1.2], [0.0, -1.2]])
    side = np.sign(doors[0].seen(places[0])[1])
    turns = taking_turns(places, wishes, -places, doors, wishes, None, 0.1)
    assert turns.sides.tolist() == [side], "who is nearer begins"
    for _ in range(100):
        turns = taking_turns(places, wishes, -places, doors, wishes, turns, 0.1)
    assert turns.sides.tolist() == [side] and turns.waited[0] == pytest.approx(9.9)
    for _ in range(45):
        turns = taking_turns(places, wishes, -places, doors, wishes, turns, 0.1)
    assert turns.sides.tolist() == [-side], "until the others have waited long enough"
    gone = np.array([[0.0, -0.9], [0.0, -9.0]])
    assert taking_turns(gone, [[0.0, 1.2], [0.0, -1.2]], -gone, doors, wishes, turns, 0.1).sides.tolist() == [side], "who is not there needs no turn"
    assert taking_turns(away, -away, -away * 2.0, (), wishes, turns, 0.1).sides.shape == (0,)
