"""Crowds: as RVO2 has it where walkers are its agents; with people's legs, nobody touches anybody, and all arrive."""

import numpy as np
import pytest

from gambol.controllers.locomotion import Locomotion
from gambol.controllers.navigation import in_world
from gambol.controllers.navigation.crowd import Manners, aims, avoid, crowd_intent, stepping
from gambol.game.scene.scene import Box

AGENTS = Manners(horizon=2.0, halflife=1e-12, aside=0.0, swing=0.0, hurry=1e-9, stir=2.0, right=0.0, first=0.0, sight=np.pi + 1e-3, see=10.0, most=10,
                 still=1e-9, differ=0.0)
"""What RVO2's agents do: no lag, half of every change each, eyes all round."""
PLACES = [[-0.11, 0.75], [-1.52, 0.98], [-1.41, 1.83], [0.84, 0.12], [0.61, -1.08], [0.0, -1.66], [-0.88, -0.86], [-1.34, -0.34]]
MOVING = [[-0.87, -0.95], [-0.33, 0.98], [0.45, -0.14], [-0.6, -0.76], [-0.17, 0.31], [0.65, -0.08], [0.7, 0.62], [0.7, -0.34]]
WISHES = [[-0.07, -0.68], [0.17, -0.92], [-0.06, -0.67], [-0.04, -0.64], [-1.0, -0.16], [-0.14, 0.08], [-0.75, 0.0], [-0.4, -0.84]]
RVO2 = [[-0.5795, -0.5945], [-0.1272, 0.1467], [0.5406, -0.2165], [-0.9661, -1.0445], [-0.0212, 0.2046], [0.3067, -0.2082], [0.9212, 0.8539],
        [-0.4227, -0.7965]]
"""What RVO2 2.0.3 by its authors answers: radii 0.3 m, horizon 2 s, at most 2 m/s."""


def test_it_is_what_its_authors_program_answers():
    assert np.allclose(avoid(PLACES, MOVING, WISHES, 0.3, manners=AGENTS), RVO2, atol=1e-4)


def test_who_is_alone_does_as_he_wishes():
    wish = np.array([[1.0, 0.4]])
    assert np.array_equal(avoid([[0.0, 0.0]], [[0.0, 0.0]], wish, 0.22), wish)
    assert avoid(np.zeros((0, 2)), np.zeros((0, 2)), np.zeros((0, 2)), np.zeros(0)).shape == (0, 2)
    far = avoid([[0.0, 0.0], [20.0, 0.0]], np.zeros((2, 2)), [[1.0, 0.0], [-1.0, 0.0]], 0.22)
    assert np.array_equal(far, [[1.0, 0.0], [-1.0, 0.0]])


def test_nobody_minds_whom_he_does_not_see():
    places, moving = [[0.0, 0.0], [0.3, -1.5]], [[0.0, 0.8], [0.0, 1.5]]
    chosen = avoid(places, moving, moving, 0.22)
    assert np.array_equal(chosen[0], moving[0]) and not np.allclose(chosen[1], moving[1])


def test_who_stands_leaves_it_to_others():
    places, moving = [[0.0, 0.0], [0.1, 2.0]], [[0.0, 0.0], [0.0, -1.2]]
    chosen = avoid(places, moving, moving, 0.22, headings=[0.0, np.pi])
    assert np.hypot(*(chosen[0] - moving[0])) < 0.25 * np.hypot(*(chosen[1] - moving[1]))


def test_all_are_asked_alike_however_many_there_are():
    """A second crowd far away changes nothing of the first."""
    far = np.array(PLACES) + 100.0
    alone = avoid(PLACES, MOVING, WISHES, 0.22)
    both = avoid(np.vstack([PLACES, far]), np.vstack([MOVING, MOVING]), np.vstack([WISHES, WISHES]), 0.22)
    assert np.array_equal(both[:len(PLACES)], alone)


def test_who_walks_needs_more_room_than_who_stands():
    """Arms swing at a walk: beside each other at the same distance those who walk part, those who stand stay."""
    places = [[-0.33, 0.0], [0.33, 0.0]]
    standing = avoid(places, np.zeros((2, 2)), np.zeros((2, 2)), 0.22, headings=[0.0, 0.0])
    walking = avoid(places, [[0.0, 1.2]] * 2, [[0.0, 1.2]] * 2, 0.22, headings=[0.0, 0.0])
    assert not standing.any() and walking[1, 0] - walking[0, 0] > 0.05


def test_walls_are_kept_off():
    wall = Box((0.0, 1.0, 1.0), (4.0, 2.0, 0.2), 0.0)
    chosen = avoid([[0.0, 0.5]], [[0.0, 0.0]], [[0.8, 1.2]], 0.22, [wall])[0]
    assert chosen[0] == pytest.approx(0.8) and chosen[1] <= (0.4 - 0.22) / Manners().brake
    assert np.array_equal(avoid([[0.0, 0.5]], [[0.0, 0.0]], [[0.3, -1.2]], 0.22, [wall]), [[0.3, -1.2]])


@pytest.mark.parametrize("places, says", [([[0.0, np.nan]], "places"), ([0.0, 0.0], "places")])
def test_mistakes_are_named(places, says):
    with pytest.raises(ValueError, match=says):
        avoid(places, np.zeros((1, 2)), np.zeros((1, 2)), 0.22)
    with pytest.raises(ValueError, match="radii"):
        avoid(np.zeros((1, 2)), np.zeros((1, 2)), np.zeros((1, 2)), 0.0)


def test_stepping_moves_as_chosen_and_turns_there():
    ground = np.array([[0.0, 0.0, 0.3]])
    chosen = np.array([[np.sin(0.4), np.cos(0.4)]])
    made = stepping(ground, np.zeros((1, 3)), chosen)
    assert np.allclose(in_world(ground, made), chosen) and made[0, 1] > 0.1
    back = stepping(ground, np.zeros((1, 3)), -chosen)
    assert back[0, 0] > -0.2 and abs(back[0, 1]) > 1.0  # who would go back turns first


def test_ways_lead_through_the_door():
    walls = [Box((-3.0, 1.0, 0.0), (5.0, 2.0, 0.2), 0.0), Box((3.0, 1.0, 0.0), (5.0, 2.0, 0.2), 0.0)]
    found = aims([[-2.0, -2.0], [0.0, -2.0]], [[-2.0, 2.0], [0.0, 2.0]], walls)
    assert abs(found[0, 0]) < 0.5 and abs(found[0, 1]) < 0.6  # at its post
    assert np.array_equal(found[1], [0.0, 2.0])


@pytest.mark.few(1)
@pytest.mark.parametrize("degrees", [45, 90, 180])
def test_two_meet_and_pass(degrees):
    turn = np.radians(degrees)
    ways = np.array([[0.0, 1.0], [np.sin(turn), np.cos(turn)]])
    walked(-4.0 * ways, 6.0 * ways, 12.0)


@pytest.mark.thorough
def test_a_crowd_on_a_circle_changes_sides():
    """Everybody's way leads through the middle: the hardest for all."""
    angles = np.arange(12) * 2 * np.pi / 12
    around = 6.0 * np.stack([np.sin(angles), np.cos(angles)], 1)
    walked(around, -around, 32.0)


def walked(places, goals, seconds):
    """Let walkers go straight to their goals; assert that bodies of 0.22 m never touch and everybody arrives."""
    walker = Locomotion.load()
    offset = goals - places
    state = walker.start(np.column_stack([places, np.arctan2(offset[:, 0], offset[:, 1])]))
    count = len(places)
    for _ in range(round(60 * seconds)):
        state, _ = walker.step(state, crowd_intent(state.ground, state.velocity, goals, 1.25), 1 / 60)
        apart = np.linalg.norm(state.ground[:, None, :2] - state.ground[None, :, :2], axis=-1) + np.eye(count)
        assert apart.min() > 0.44
    assert np.linalg.norm(state.ground[:, :2] - goals, axis=1).max() < 0.4
