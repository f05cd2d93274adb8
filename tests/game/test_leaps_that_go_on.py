"""Hands that press the leap as somebody strafes, goes backward or walks slowly have him leap on, and not stop and hop."""

import math

import numpy as np
import pytest

from gambol.controllers.jump import Jumping
from gambol.controllers.locomotion import Locomotion, Settings
from gambol.controllers.person import person
from gambol.game.input import Wish
from gambol.game.scene import Box
from gambol.game.session import Timeline, begin, refused
from gambol.game.world import RATE, Character, World

HELD = 0.15
"""So long hands hold the button [s]."""


@pytest.fixture(scope="module")
def someone():
    return person(Locomotion.load(settings=Settings(idle=0.0)))


def played(someone, way, throw, presses, seconds, strafe=True, props=()):
    """The moments of somebody who goes a way [rad] to the left of where he faces, and presses the leap at these times [s]."""
    line = Timeline(begin(World((Character("A", someone, someone.start()),), props), 1))
    moments = []
    for step in range(round(seconds * RATE)):
        yaw = line.now.players[0].camera.yaw
        move = (-throw * math.sin(way - yaw), throw * math.cos(way - yaw))
        jump = any(0.0 <= step / RATE - at < HELD for at in presses)
        line.advance((Wish(move=move, strafe=strafe, jump=jump).rounded(),))
        moments.append(line.now.after.characters[0].state)
    return moments


def leaps(moments):
    """The plans that were leapt, one after the other."""
    plans = [s.memory.memory.plan for s in moments if isinstance(s.memory.memory, Jumping)]
    return [made for k, made in enumerate(plans) if k == 0 or made is not plans[k - 1]]


def went(moments, seconds):
    """How fast hips went in the mean for the last so many seconds [m/s]."""
    place = np.array([moments[k].pose.root[[0, 2]] for k in (-round(seconds * RATE), -1)])
    return float(np.linalg.norm(place[1] - place[0])) / seconds


@pytest.mark.few(1)
@pytest.mark.parametrize("way, throw", [(90, 1.0), (-90, 1.0), (180, 1.0), (0, 0.5)])
def test_who_is_told_to_leap_on_his_way_does_not_stop_for_it(someone, way, throw):
    strafe = way != 0
    calm = went(played(someone, math.radians(way), throw, (), 5.0, strafe), 2.4)
    moments = played(someone, math.radians(way), throw, (2.6,), 5.0, strafe)
    made, = leaps(moments)
    assert made.path.lands is not None and went(moments, 2.4) > 0.85 * calm


def test_walkers_who_leap_again_and_again_go_on(someone):
    moments = played(someone, 0.0, 1.0, np.arange(2.5, 8.0, 0.9), 8.0, False)
    assert len(leaps(moments)) >= 4 and went(moments, 5.0) > 0.85, "it was 0.6 m/s: every other leap was a hop on the spot"


def test_who_taps_in_the_air_leaps_on_from_the_landing_that_brakes_him(someone):
    line, made = Timeline(begin(World((Character("A", someone, someone.start()),)), 1)), []
    for step in range(round(4.2 * RATE)):  # pressed a tenth of a second later in his stride, he would land walking on
        held, yaw = step < 2.55 * RATE, line.now.players[0].camera.yaw
        flies = len(made) == 1 and made[0].take_off + 0.1 < line.now.after.characters[0].state.memory.memory.time < made[0].take_off + 0.2
        before = line.now
        line.advance((Wish(move=(held * math.sin(yaw), held * math.cos(yaw)), run=0.3, jump=2.4 * RATE <= step < 2.55 * RATE or flies).rounded(),))
        assert not refused(before, line.now)
        memory = line.now.after.characters[0].state.memory.memory
        if isinstance(memory, Jumping) and (not made or memory.plan is not made[-1]):
            made.append(memory.plan)
    assert len(made) == 2 and made[0].path.lands is None
    assert np.linalg.norm((made[1].path.land - made[1].path.leave)[[0, 2]]) > 0.4, "ahead, as fast as he came down"


def test_who_goes_slowly_up_to_a_box_stops_and_aims(someone):
    moments = played(someone, 0.0, 0.5, (1.7,), 3.0, False, (Box((0.0, 0.2, 1.9), (2.0, 0.4, 1.0)),))
    assert all(made.path.lands is None for made in leaps(moments))
