"""Who can't leap as he comes goes to where he can off both feet, and leaps from there."""

import math

import numpy as np
import pytest

from gambol.controllers.contract import Intent, Leap
from gambol.controllers.locomotion import Locomotion, Settings
from gambol.controllers.navigation import STEP, floor_at, room
from gambol.controllers.person import person
from gambol.game.input import Jump, Move, Script
from gambol.game.input.stances import Stand, stand_for
from gambol.game.scene.scene import Box
from gambol.game.world import DT, RATE, Character, World


@pytest.fixture(scope="module")
def someone():
    return person(Locomotion.load(settings=Settings(idle=0.0)))


def box(x, z, high, wide, turned=0.0):
    return Box((x, 0.5 * high, z), (wide, high, wide), turned)


def led(who, thing, pace, seconds=9.0):
    """All states of somebody who goes straight on for two metres, and then is to leap onto the middle of a box; and his script after them."""
    place = (thing.centre[0], thing.size[1], thing.centre[2])
    script = Script((Move(2.0 / pace, (pace, 0.0, 0.0)), Move(8.0, (pace, 0.0, 0.0), jump=Jump(place)), Move(1.0)))
    world, states = World((Character("A", who, who.start()),), (thing,)), []
    while len(states) < seconds * RATE and not script.done:
        states.append(world.characters[0].state)
        script, intent = script.step(states[-1], DT)
        script, intent = script.held(who, states[-1], intent, (thing,), DT)
        world = world.step([intent])
    return states, script


@pytest.mark.few(1)
@pytest.mark.parametrize("x, z, high, wide, turned, pace", [(-2.4, 3.1, 0.4, 1.27, 27.0, 1.3), (0.4, 3.2, 0.4, 1.36, 35.0, 1.3), (0.8, 3.7, 0.5, 1.0, -7.0, 2.5)],
                         ids=["aside, farther off than he leaps", "ahead, askew", "aside, at a run"])
def test_who_can_not_leap_onto_a_box_as_he_comes_goes_to_where_he_can_and_leaps_from_there(someone, x, z, high, wide, turned, pace):
    """He came to rest half a metre before it, could not from there, and stood there for good."""
    states, script = led(someone, box(x, z, high, wide, math.radians(turned)), pace)
    assert script.done and not script.refused
    assert float(states[-1].floor) == pytest.approx(high, abs=0.01) and np.hypot(*(states[-1].ground[:2] - [x, z])) < 0.1
    floors = np.array([float(state.floor) for state in states if state.active == "locomotion"])
    assert np.abs(floors[floors < 0.5 * high]).max() < 0.01, "nothing lifts him"


def test_who_can_leap_onto_it_from_nowhere_is_told_why_and_not_led_about(someone):
    states, script = led(someone, box(-1.5, 3.4, 0.6, 1.5), 1.3, 14.0)
    assert all(state.active == "locomotion" for state in states) and len(script.refused) == 1
    rests = next(n for n, state in enumerate(states) if n > 2.5 * RATE and np.abs(state.velocity).max() < 0.1)
    assert np.hypot(*(states[-1].ground - states[rests].ground)[:2]) < 0.15


@pytest.mark.parametrize("turned", [0.0, 0.4])
def test_where_he_is_led_he_has_room_comes_to_freely_and_can_leap_from(someone, turned):
    things, place = (box(0.0, 3.0, 0.4, 1.0, turned),), np.array([0.0, 0.4, 3.0])
    for x, z in ((-1.2, 1.6), (0.0, 1.0), (0.9, 1.9)):
        stand = stand_for(someone, someone.start((x, z, 0.0)), Leap(place), things, (x, z))
        for _ in range(200):
            stand = stand.after(someone.start((x, z, 0.0)), DT)
            if stand.thought is None:
                break
        assert stand.at is not None and stand.goes
        ways = np.linspace([x, z], stand.at[:2], 20)
        assert all(floor_at(*way, things, STEP) == 0.0 for way in ways) and all(room(way, 0.0, things) > 0.0 for way in ways)
        assert not someone.refusal(someone.start(stand.at), Intent(leap=Leap(place), around=things))
        assert abs(math.remainder(stand.at[2] - math.atan2(0.0 - stand.at[0], 3.0 - stand.at[1]), math.tau)) < 1e-6, "he faces it"


def test_who_is_led_somewhere_is_there_once_he_rests_there_and_gives_up_in_time(someone):
    stand = Stand(at=(0.0, 0.3, 0.0))
    assert stand.after(someone.start((0.0, 0.31, 0.02)), DT).there and not stand.after(someone.start((0.0, 0.5, 0.0)), DT).there
    for _ in range(round(6.0 * RATE)):
        stand = stand.after(someone.start((0.0, 2.0, 0.0)), DT)
    assert stand.there and not stand.holds(someone.start()) and stand.leads(someone.start()) is None
