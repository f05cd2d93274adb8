"""Who runs up, down or across a ramp and taps a leap leaps on one foot and runs on, at any moment of his strides."""

import math

import numpy as np
import pytest

from gambol.controllers.jump import Jumping
from gambol.controllers.navigation import floor_at
from gambol.controllers.person import person
from gambol.game.input.wish import Wish
from gambol.game.scene import Box
from gambol.game.session.state import begin
from gambol.game.session.tick import advance
from gambol.game.world.world import DT, Character, World

RISE = math.tan(math.radians(15.0))
RAMP = (Box((0.0, 20.0 * RISE, 0.0), (40.0, 40.0 * RISE, 40.0), slope=RISE),)


@pytest.mark.few(1)
@pytest.mark.parametrize("speed, ground", [(3.0, (0.0, -12.0, 0.0)), (2.2, (0.0, 12.0, math.pi)), (2.2, (-8.0, 0.0, math.pi / 2))])
def test_who_taps_a_leap_as_he_runs_on_a_ramp_leaps_on_one_foot(speed, ground):
    someone = person()
    base = begin(World((Character("A", someone, someone.start(ground, floor_at(*ground[:2], RAMP, 99.0))),), RAMP), 1)

    def wished(moment, jump):
        aside = ground[2] - moment.players[0].camera.yaw
        return Wish(move=(-math.sin(aside), math.cos(aside)), run=(speed - 1.3) / 1.7, jump=jump).rounded()

    step = 0
    for phase in range(4):
        while step < 150 + 12 * phase:
            base, step = advance(base, (wished(base, False),)), step + 1
        moment, leapt = base, None
        for n in range(90):
            moment = advance(moment, (wished(moment, n < 8),))
            memory = moment.after.characters[0].state.memory.memory
            if isinstance(memory, Jumping):
                leapt = memory.plan
                break
        assert leapt is not None, f"refused, pressed after {step * DT:.2f} s"
        way = (leapt.path.land - leapt.path.leave)[[0, 2]]
        assert leapt.path.lands is not None and way @ [math.sin(ground[2]), math.cos(ground[2])] > 0.9 * np.hypot(*way) > 0.4
