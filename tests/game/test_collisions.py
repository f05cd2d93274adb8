"""Characters who run into each other strike each other; who brushes past does not, and two strikes in one step are one."""

from dataclasses import replace

import numpy as np
import pytest

from gambol.controllers.body import forward_kinematics
from gambol.controllers.contract import Goal, Intent, Leap, Strike
from gambol.controllers.person import person
from gambol.game.input import Script
from gambol.game.world import Character, World
from gambol.game.world.collisions import TRUNK, is_down, run_into


@pytest.fixture(scope="module")
def somebody():
    return person()


def walked(somebody, places, speed, seconds):
    """A world whose people walk as they face, and what struck them on the way."""
    world = World(tuple(Character(str(n), somebody, somebody.start(place)) for n, place in enumerate(places)))
    wish, hits = Intent(np.array([speed, 0.0, 0.0])), []
    for _ in range(round(60 * seconds)):
        intents = [wish] * len(places)
        found = run_into(world.characters, intents, world.number)
        if any(one.strike is not None for one in found):
            hits.append((world, found))
        world = world.step(intents)
    return world, hits


def test_who_runs_into_another_strikes_him_as_he_is_struck(somebody):
    _, hits = walked(somebody, [(0.0, -1.2, 0.0), (0.0, 1.2, np.pi)], 1.2, 1.5)
    assert hits
    world, found = hits[0]
    one, other = (np.array(intent.strike.impulse) for intent in found)
    assert np.allclose(one, -other) and np.hypot(*one) > 40.0 and one[1] < 0.0  # momentum is kept
    after = world.step([Intent(), Intent()])
    assert [state.state.active for state in after.characters] == ["struck", "struck"]


def test_who_brushes_past_is_not_struck(somebody):
    assert not walked(somebody, [(0.0, -1.5, 0.0), (0.42, 1.5, np.pi)], 1.2, 2.5)[1]


def test_nobody_meets_who_is_on_another_level_or_alone(somebody):
    high = Character("high", somebody, somebody.start((0.0, 0.1, 0.0), 2.0))
    low = Character("low", somebody, somebody.start((0.0, 0.0, 0.0)))
    for cast in ((high, low), (low,)):
        intents = [Intent() for _ in cast]
        assert run_into(cast, intents, 0) == intents


@pytest.mark.parametrize("aside", [0.0, 0.2])
def test_who_walks_into_one_who_stands_is_held_and_slides_past(somebody, aside):
    world = World((Character("walks", somebody, somebody.start((aside, -1.5, 0.0))), Character("stands", somebody, somebody.start((0.0, 0.0, np.pi)))))
    wish, nearest = Intent(np.array([1.2, 0.0, 0.0])), np.inf
    for _ in range(240):
        assert all(one.strike is None for one in run_into(world.characters, [wish, Intent()], world.number))
        world = world.step([wish, Intent()])
        one, other = (who.state.ground[:2] for who in world.characters)
        nearest = min(nearest, float(np.hypot(*(one - other))))
    assert nearest > 2.0 * TRUNK - 0.06
    assert (one[1] > 0.5) if aside else (one[1] < -0.3)  # past him, or before him


def test_two_who_insist_do_not_walk_through_each_other(somebody):
    """However slowly."""
    world = World((Character("one", somebody, somebody.start((0.0, -0.6, 0.0))), Character("other", somebody, somebody.start((0.03, 0.6, np.pi)))))
    wish = Intent(np.array([0.3, 0.0, 0.0]))
    for _ in range(360):
        world = world.step([wish, wish])
    one, other = (who.state.ground[:2] for who in world.characters)
    assert np.hypot(*(one - other)) > 2.0 * TRUNK - 0.06


def test_who_lies_is_in_the_way(somebody):
    """A walker ends before him; once he stands again, he is one who stands."""
    mass = somebody.parts["struck"].physique.mass
    world = World((Character("walks", somebody, somebody.start((0.0, -3.0, 0.0))), Character("falls", somebody, somebody.start((0.0, 0.0, 0.5 * np.pi)))))
    went = False
    for n in range(260):
        fallen = world.characters[1]
        intents = [Intent(np.array([1.0, 0.0, 0.0])) if n > 60 else Intent(), Intent(strike=Strike((2.5 * mass, 0.0)) if n == 0 else None)]
        world = world.step(intents)
        if is_down(fallen):
            went = True
            joints = forward_kinematics(somebody.skeleton, fallen.state.pose.root, fallen.state.pose.rotations)[0][:, [0, 2]]
            assert np.linalg.norm(joints - world.characters[0].state.ground[:2], axis=1).min() > 0.15
    assert went


@pytest.fixture(scope="module")
def lies(somebody):
    """Somebody who lies on the floor, and goes on lying there."""
    world = World((Character("lies", somebody, somebody.start((0.0, 0.0, 0.5 * np.pi))),))
    for n in range(100):
        world = world.step([Intent(strike=Strike((2.5 * somebody.parts["struck"].physique.mass, 0.0)) if n == 0 else None)])
    assert is_down(world.characters[0])
    return world.characters[0]


def test_who_goes_to_a_goal_goes_round_who_lies(somebody, lies):
    """Whose joints he never comes near, and he gets there."""
    joints = lies.joints[0]
    middle = joints[somebody.skeleton.index("Spine2")][[0, 2]]
    world = World((Character("goes", somebody, somebody.start((middle[0], middle[1] - 2.0, 0.0))), lies))
    goal, nearest = Goal((middle[0], middle[1] + 2.0)), np.inf
    for _ in range(660):
        world = world.step([Intent(goal=goal), Intent()])
        world = replace(world, characters=(world.characters[0], lies))
        nearest = min(nearest, float(np.linalg.norm(joints[:, [0, 2]] - world.characters[0].state.ground[:2], axis=1).min()))
    assert nearest > 0.3
    assert np.hypot(*(world.characters[0].state.ground[:2] - goal.place)) < 0.1


def test_nobody_leaps_onto_who_lies(somebody, lies):
    """And is told why; beside him he may."""
    chest = lies.joints[0][somebody.skeleton.index("Spine2")]
    for aside, words in ((0.0, "inside something solid"), (3.0, "")):
        world = World((Character("leaps", somebody, somebody.start((chest[0] + aside, chest[2] - 1.2, 0.0))), lies))
        world = world.step([Intent(leap=Leap(np.array([chest[0] + aside, 0.0, chest[2]]))), Intent()])
        assert words in world.characters[0].state.refused and bool(words) == bool(world.characters[0].state.refused)


def test_two_strikes_in_one_step_of_a_script_are_one(somebody):
    script = Script((), strikes=((0, Strike((10.0, 5.0))), (0, Strike((-4.0, 20.0))), (1, Strike((1.0, 1.0)))))
    _, intent = script.step(somebody.start(), 1 / 60)
    assert intent.strike is not None and np.allclose(intent.strike.impulse, (6.0, 25.0))


@pytest.mark.few(1)
@pytest.mark.parametrize("turn", [0.0, 0.5, 2.0])
@pytest.mark.parametrize("far", [0.9, 1.3])
def test_who_falls_falls_beside_who_stands_there(somebody, far, turn):
    """With trunk, head and legs neither through him, nor knocking him over who is out of reach."""
    world = World((Character("falls", somebody, somebody.start((0.0, 0.0, turn))), Character("stands", somebody, somebody.start((0.0, far, np.pi)))))
    parents = np.array(somebody.skeleton.parents)
    ends = np.array([k for k in np.flatnonzero(parents >= 0) if "Hand" not in somebody.skeleton.names[k] and "Arm" not in somebody.skeleton.names[k]])
    share = np.linspace(0.0, 1.0, 5)[:, None]
    nearest, lowest = np.inf, np.inf
    for number in range(300):
        world = world.step([Intent(strike=None if number else Strike((0.0, 150.0))), Intent()])
        if number % 4 == 0:
            joints = [forward_kinematics(somebody.skeleton, one.state.pose.root.astype(float), one.state.pose.rotations.astype(float))[0] for one in world.characters]
            bones = [(j[parents[ends], None] * (1.0 - share) + j[ends, None] * share).reshape(-1, 3) for j in joints]
            nearest = min(nearest, np.linalg.norm(bones[0][:, None] - bones[1], axis=-1).min())
            lowest = min(lowest, joints[0][0, 1])
    assert nearest > 0.05 and world.characters[1].state.active == "locomotion"
    assert lowest < 0.5 or np.hypot(*world.characters[0].state.ground[:2]) < far, "he falls, or is caught before him"
