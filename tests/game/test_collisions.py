"""Characters who run into each other strike each other; who brushes past does not, and two strikes in one step are one."""

import numpy as np
import pytest

from gambol.controllers.contract import Intent, Strike
from gambol.controllers.person import person
from gambol.game.input import Script
from gambol.game.world import Character, World
from gambol.game.world.collisions import run_into


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


def test_two_strikes_in_one_step_of_a_script_are_one(somebody):
    script = Script((), strikes=((0, Strike((10.0, 5.0))), (0, Strike((-4.0, 20.0))), (1, Strike((1.0, 1.0)))))
    _, intent = script.step(somebody.start(), 1 / 60)
    assert intent.strike is not None and np.allclose(intent.strike.impulse, (6.0, 25.0))
