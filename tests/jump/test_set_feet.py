"""Who leaps in the midst of a turn or a step aside sets his feet first: legs don't go through each other."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from gambol.controllers.body import forward_kinematics
from gambol.controllers.contract import Intent, Leap
from gambol.controllers.jump import SETS_FEET, Crouching, Jumping, Physique
from gambol.controllers.jump.starting import sets_feet
from gambol.game.scene import Box

from conftest import FPS, ahead

sys.path.insert(0, str(Path(__file__).parents[2] / "scripts" / "measure"))
from _limbs import legs_apart  # noqa: E402

NEAREST, LONGEST = 0.10, 0.75
"""Axes of legs come no nearer to each other than the first [m]; nobody sets his feet for longer than the second [s]."""
MIDST = [((0.0, 2.0, 0.0), 1.0), ((0.0, -2.0, 0.0), 1.1), ((0.0, -3.0, 0.0), 1.07), ((0.6, 0.0, 0.5), 1.3), ((-0.5, 0.0, -0.4), 2.1)]
"""Velocities, and after how long [s] with them, that leave feet near each other, turned or crossed."""


def led(person, velocity, seconds):
    """The state of somebody who went so for so long."""
    state = person.start()
    for _ in range(round(seconds * FPS)):
        state, _ = person.step(state, Intent(np.array(velocity)), 1 / FPS)
    return state


def leapt(person, state, leap, velocity=(0.0, 0.0, 0.0)):
    """What he is told as he waits, how long that takes [s], and his states from the leap's beginning to its end."""
    told = []
    while not isinstance(state.memory.memory, Jumping):
        assert len(told) < FPS, "he never leaps"
        state, _ = person.step(state, Intent(np.array(velocity), leap), 1 / FPS)
        told.append(state.refused)
    states = [state]
    while states[-1].active == "jump" and states[-1].memory.memory.time < states[-1].memory.memory.plan.duration:
        states.append(person.step(states[-1], Intent(), 1 / FPS)[0])
    return told[:-1], len(told) / FPS, states


@pytest.mark.few(3)
@pytest.mark.parametrize("far", [None, 0.9])
@pytest.mark.parametrize(("velocity", "seconds"), MIDST)
def test_legs_stay_apart_in_a_leap_out_of_a_turn_or_a_step_aside(person, velocity, seconds, far):
    state = led(person, velocity, seconds)
    told, waits, states = leapt(person, state, Leap(None if far is None else ahead(state, far)))
    assert legs_apart(person.skeleton, [s.pose.root for s in states], [s.pose.rotations for s in states]).min() > NEAREST
    assert told and told[0] == SETS_FEET, "he is told why he waits"
    assert waits < LONGEST


def test_who_asks_for_it_cannot_leap_meanwhile(person):
    state = led(person, *MIDST[0])
    assert person.refusal(state, Intent(leap=Leap(ahead(state, 0.9)))) == SETS_FEET


@pytest.mark.parametrize(("velocity", "seconds"), [((0.0, 0.0, 0.0), 0.3), ((0.8, 0.0, 0.0), 2.0), ((-0.5, 0.0, 0.0), 2.0), ((0.0, 0.0, 0.4), 1.0)])
def test_over_feet_that_are_set_he_is_off_at_once(person, velocity, seconds):
    state = led(person, velocity, seconds)
    told, waits, _ = leapt(person, state, Leap(None))
    assert not told and waits == 1 / FPS


def test_keys_that_go_on_turning_him_do_not_keep_him_from_it(person):
    state = led(person, *MIDST[0])
    _, waits, _ = leapt(person, state, Leap(None), MIDST[0][0])
    assert waits < LONGEST


def test_who_aims_crouches_once_his_feet_are_set(person):
    state = led(person, *MIDST[0])
    for _ in range(2 * FPS):
        state, _ = person.step(state, Intent(aim=Leap(ahead(state, 0.9))), 1 / FPS)
        if isinstance(state.memory.memory, Crouching):
            break
    assert isinstance(state.memory.memory, Crouching)
    leap = Leap(ahead(state, 0.9))
    for _ in range(FPS):
        state, _ = person.step(state, Intent(aim=leap), 1 / FPS)
        assert legs_apart(person.skeleton, [state.pose.root], [state.pose.rotations])[0] > NEAREST


def test_who_stands_still_has_set_his_feet_however_they_stand(person):
    """Nobody waits for a step that is never made."""
    state = replace(person.active(led(person, *MIDST[0]))[1], contacts=np.ones(4, bool))
    assert sets_feet(Physique(), state)
    assert not sets_feet(Physique(), replace(state, velocity=np.zeros(3)))


@pytest.mark.few(2)
@pytest.mark.parametrize(("speed", "past"), [(0.8, 1.20), (0.8, 1.26), (2.4, 1.38)])
def test_nobody_pushes_off_the_air_beyond_an_edge(person, speed, past):
    """Who is about to step off a low platform leaps once feet that push stand on one floor: a foot beyond the edge was lifted by 9 cm in a step."""
    kerb, state, wish = (Box((0.0, 0.1, 0.0), (3.0, 0.2, 3.0)),), person.start((0.0, -1.2, 0.0), 0.2), None
    joints, velocity = [], np.array([speed, 0.0, 0.0])
    for _ in range(4 * FPS):
        if state.ground[1] > past:
            wish = Leap(np.array([0.0, 0.0, state.ground[1] + 0.6 + 0.5 * speed]))
        state, pose = person.step(state, Intent(velocity, wish, around=kerb), 1 / FPS)
        joints.append(forward_kinematics(person.skeleton, pose.root, pose.rotations)[0])
        if isinstance(state.memory.memory, Jumping):
            break
    assert isinstance(state.memory.memory, Jumping)
    assert np.linalg.norm(np.diff(joints[-3:], 2, axis=0), axis=-1).max() * FPS**2 < 250
