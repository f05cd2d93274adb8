"""Rolls: who comes down from high up, going ahead, goes on over a shoulder and stands up again."""

import numpy as np
import pytest

from gambol.controllers.body import forward_kinematics
from gambol.controllers.contract import Intent, Leap, Unable
from gambol.controllers.jump.body import vectors
from gambol.controllers.jump.motion import places
from gambol.game.scene import Box

DT = 1.0 / 60.0
HEAD = slice(24, 26)


def stood(person, high):
    """Somebody on a platform so high [m], near its edge, and the platform."""
    platform = (Box((0.0, 0.5 * high, 0.0), (2.0, high, 2.0)),)
    state = person.start((0.0, 0.7, 0.0), high)
    for _ in range(5):
        state, _ = person.step(state, Intent(around=platform), DT)
    return state, platform


def dropped(person, high, far, *things):
    """The plan of who jumps down from so high [m] to so far ahead [m], beside things."""
    state, platform = stood(person, high)
    leap = Leap(np.array([0.0, 0.0, 0.7 + far]))
    return person.parts["jump"].plan(person.active(state)[1], Intent(leap=leap, around=(*platform, *things)))


@pytest.fixture(scope="module")
def roll(person):
    return dropped(person, 2.5, 2.0)


def test_a_drop_of_more_than_two_metres_is_rolled(person, roll):
    """From there on, and only there: legs alone take less."""
    assert roll.rolls > roll.touch_down + 1.0 and dropped(person, 1.5, 2.0).rolls == 0.0
    body = person.parts["jump"].physique
    legs = (roll.times >= roll.touch_down) & (roll.times <= roll.lowest)
    assert roll.forces[legs, 1].max() < 8.2 * 9.81 * body.mass  # as on the feet from 2 m


def test_nothing_is_below_the_floor_and_the_head_is_spared(person, roll):
    body = person.parts["jump"].physique
    late = roll.times >= roll.touch_down
    over = places(body, *forward_kinematics(body.skeleton, roll.roots[late], roll.local[late]))[1]
    assert over.min() > -0.01 and over[:, HEAD].min() > 0.0


def test_it_goes_over_its_back_once_and_stands_up(roll):
    """No pose jumps on the way, nor does the mass centre, and it comes up as it faced."""
    late = roll.times >= roll.lowest
    turned = vectors(roll.local[1:] @ np.swapaxes(roll.local[:-1], -1, -2))[late[1:]]
    assert np.linalg.norm(turned, axis=-1).max() < 0.25
    assert abs(turned[:, 0, 0].sum() - 2.0 * np.pi) < 1.5  # about its own left
    assert np.linalg.norm(np.diff(roll.centres[late], axis=0), axis=-1).max() < 4.0 / 120.0
    assert roll.local[late, 0, 1, 1].min() < -0.7 and roll.local[-1, 0, 1, 1] > 0.95
    assert roll.local[-1, 0, 2, 2] > 0.9 and roll.centres[-1, 1] > 0.9


def test_hands_bear_who_tips_over(person, roll):
    """Both stand on the floor, and stay, while the hips are over them, and no arm jumps as it gives way."""
    body = person.parts["jump"].physique
    tips = (roll.times > roll.lowest + 0.18) & (roll.times < roll.lowest + 0.22)
    positions, turned = forward_kinematics(body.skeleton, roll.roots[tips], roll.local[tips])
    hands = positions[:, [body.skeleton.index(side + "Hand") for side in ("Left", "Right")]]
    assert hands[..., 1].max() < 0.06 and positions[:, 0, 1].min() > 0.5
    assert np.ptp(hands, axis=0).max() < 0.02
    late = roll.times >= roll.lowest
    turned = vectors(roll.local[1:] @ np.swapaxes(roll.local[:-1], -1, -2))[late[1:]]
    assert np.linalg.norm(turned, axis=-1).max() * 120.0 < 30.0
    assert roll.forces[late, 1].min() > -1.2 * 9.81 * body.mass


def test_a_wall_leaves_no_room_to_roll(person):
    with pytest.raises(Unable, match="no room to roll"):
        dropped(person, 2.5, 2.0, Box((0.0, 1.0, 3.6), (4.0, 2.0, 0.2)))


def test_who_rolls_does_so_to_its_end_and_walks_on(person):
    """Whatever is wished meanwhile."""
    state, platform = stood(person, 3.0)
    leap, plan, ended = Leap(np.array([0.0, 0.0, 3.0])), None, 0.0
    for _ in range(360):
        wish = Intent(leap=leap, around=platform) if plan is None else Intent(np.array([1.2, 0.0, 0.0]), around=platform)
        state, _ = person.step(state, wish, DT)
        if state.active == "jump":
            plan, ended = state.memory.memory.plan, state.memory.memory.time
    assert plan is not None and plan.rolls > 0.0 and ended >= plan.rolls - 2.0 * DT
    assert state.active == "locomotion" and state.velocity[0] > 1.0
