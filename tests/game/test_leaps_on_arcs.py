"""Who goes along an arc leaps on along it: where the ring lies, and that whoever runs or walks so leaps at any moment of his strides."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gambol.controllers.contract import Duty
from gambol.controllers.jump import Jumping
from gambol.controllers.navigation import drift
from gambol.controllers.person import person
from gambol.game.input.aim import Aim
from gambol.game.input.wish import Wish
from gambol.game.session.state import opening
from gambol.game.session.tick import advance
from gambol.game.world.world import DT
from stand_in import Glide

HELD, FREE = Wish(jump=True), Wish()


def going(speed, turn, heading=0.4):
    state = Glide().start((1.0, 2.0, heading))
    return replace(state, velocity=np.array([speed, turn, 0.0]), memory=Duty("glide", None, ""))


def bearing(aim, state):
    """How far [rad] to the left of where somebody faces the ring lies, and how far away [m]."""
    place = aim.target(state, (), 9.81).place
    x, z = place[[0, 2]] - state.ground[:2]
    return math.remainder(math.atan2(x, z) - state.ground[2], math.tau), math.hypot(x, z)


@given(st.floats(1.0, 3.4), st.floats(-1.2, 1.2))
def test_the_ring_of_who_goes_along_an_arc_lies_round_it_as_far_away_as_straight_ahead(speed, turn):
    state, straight = going(speed, turn), going(speed, 0.0)
    (left, far), (_, ahead) = (bearing(Aim().step(HELD, 0.0, one, False, DT), one) for one in (state, straight))
    assert far == pytest.approx(ahead) and -1e-9 <= left * np.sign(turn) <= abs(turn) * 0.4 + 1e-9


@given(st.floats(1.5, 3.4), st.floats(-1.2, 1.2))
def test_the_ring_stays_ahead_of_who_turns_as_he_waits_and_where_it_was_of_who_does_not(speed, turn):
    state = going(speed, turn)
    aim = Aim().step(HELD, 0.0, state, False, DT).step(FREE, 0.0, state, False, DT)
    first, far = bearing(aim, state)
    place = aim.target(state, (), 9.81).place
    for _ in range(15):
        state = replace(state, ground=drift(state.ground, state.velocity, [DT])[0])
        aim = aim.step(FREE, 0.0, state, False, DT)
    left, near = bearing(aim, state)
    assert near < far, "he comes nearer to it"
    if turn == 0.0:
        assert np.array_equal(aim.target(state, (), 9.81).place, place)
    if abs(turn) > 0.3:  # not round by a twentieth of a radian, by which it may lag, seen from half as far away
        assert abs(left - first) < 0.1
        assert aim.asked(state, (), 9.81).heading == pytest.approx(state.ground[2] + left, abs=0.1), "he lands as he will run on"


@pytest.mark.few(1)
@pytest.mark.parametrize("speed, turn", [(1.3, 50.0), (2.2, -50.0), (3.0, 40.0), (3.0, -60.0)])
def test_who_taps_a_leap_as_he_goes_along_an_arc_leaps_on_one_foot_and_goes_on(speed, turn):
    def wished(moment, seconds, jump):
        there, yaw = math.radians(turn) * seconds, moment.players[0].camera.yaw
        return Wish(move=(-math.sin(there - yaw), math.cos(there - yaw)), run=(speed - 1.3) / 1.7, jump=jump).rounded()

    base, step = opening(person()), 0
    for phase in range(5):
        while step < 180 + 8 * phase:
            base, step = advance(base, (wished(base, step * DT, False),)), step + 1
        moment, leapt = base, None
        for n in range(90):
            moment = advance(moment, (wished(moment, (step + n) * DT, n < 8),))
            memory = moment.after.characters[0].state.memory.memory
            if isinstance(memory, Jumping):
                leapt = memory.plan.path
                break
        assert leapt is not None, f"refused, pressed in step {step}"
        along = leapt.velocity[[0, 2]] @ [math.sin(leapt.heading), math.cos(leapt.heading)]
        assert leapt.lands is not None and not memory.fault, "on one foot, to run on"
        assert along > 0.8 * np.hypot(*leapt.velocity[[0, 2]]) and along > 0.7 * speed, "the way he went"
