"""Aiming: where the ring goes, what is asked for when the button is let go. No window, no library."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gambol.controllers.contract import Duty
from gambol.controllers.navigation import drift
from gambol.game.input.aim import PUSH, SWINGS, Aim
from gambol.game.input.aimed import AIRTIME, LONGEST, PATIENCE
from gambol.game.input.wish import Wish
from gambol.game.scene.scene import Box
from gambol.game.world.world import DT
from stand_in import Glide

HELD, FREE = Wish(jump=True), Wish()


def standing(velocity=(0.0, 0.0, 0.0), heading=0.0, refused=""):
    state = Glide().start((1.0, 2.0, heading))
    return replace(state, velocity=np.array(velocity), memory=Duty("glide", None, "", refused))


def aimed(wish, seconds, state, aim=Aim(), yaw=0.0):
    for _ in range(round(seconds / DT)):
        aim = aim.step(wish, yaw, state, False, DT, farthest=2.6)
    return aim


@given(st.floats(-math.pi, math.pi), st.floats(-math.pi, math.pi), st.floats(0.3, 5.0))
def test_the_stick_pushes_the_ring_as_the_camera_looks_and_not_too_far(yaw, stick, seconds):
    push = Wish(jump=True, move=(math.sin(stick), math.cos(stick)))
    aim = aimed(push, seconds, standing(), yaw=yaw)
    away = math.hypot(*aim.offset)
    assert away <= 2.6 + 1e-9
    # right on the stick is to the right of where the camera looks, which is less heading
    assert math.remainder(math.atan2(*aim.offset) - (yaw - stick), math.tau) == pytest.approx(0.0, abs=1e-6)
    assert aim.stands and aim.facing(standing(), ()) == pytest.approx(math.atan2(*aim.offset))


def test_a_ring_that_lies_ahead_at_once_is_where_the_stick_would_have_pushed_it_or_farther():
    """Of somebody whom something holds up, the stick still held: it waits there, and goes back at once."""
    on, back = Wish(jump=True, move=(0.0, 1.0)), Wish(jump=True, move=(0.0, -1.0))
    led = Aim().step(on, 0.0, standing(), False, DT, farthest=2.6, ahead=(0.0, 0.6))
    for seconds in (0.1, 0.3, 0.5, 1.0):
        pushed = aimed(on, seconds, standing()).offset[1]
        assert aimed(on, seconds, standing(), led).offset[1] == pytest.approx(max(0.6, pushed), abs=2.0 * PUSH * DT)
    assert aimed(back, 0.1, standing(), led).offset[1] < 0.5


def test_who_let_go_of_the_stick_is_to_come_to_rest_where_he_lands():
    walks = standing((1.3, 0.0, 0.0))
    for move, rests in (((0.0, 1.0), False), ((0.0, 0.95), False), ((0.0, 0.66), True), ((0.0, 0.0), True)):
        aim = aimed(Wish(jump=True, move=(0.0, 1.0)), 0.2, walks).step(Wish(move=move), 0.0, walks, False, DT)
        assert aim.asked(walks, (), 9.81).stays is rests
    assert not aimed(HELD, 0.5, standing()).step(FREE, 0.0, standing(), False, DT).asked(standing(), (), 9.81).stays, "who stands comes to rest anyway"


def test_nothing_is_asked_for_while_the_button_is_held():
    aim = aimed(HELD, 0.5, standing())
    assert aim.aiming and aim.asked(standing(), (), 9.81) is None
    asked = aim.step(FREE, 0.0, standing(), False, DT).asked(standing(), (), 9.81)
    assert asked.place is None, "no push: straight up"


def test_holding_longer_jumps_higher_up_to_a_limit_and_slower_where_gravity_is_less():
    def airtime(seconds, gravity=9.81):
        return aimed(HELD, seconds, standing()).target(standing(), (), gravity).airtime
    assert AIRTIME <= airtime(0.1) < airtime(0.6) < airtime(5.0) == LONGEST
    assert airtime(5.0, 1.62) == pytest.approx(LONGEST * math.sqrt(9.81 / 1.62))


def test_it_crouches_for_the_jump_that_will_be_aimed_at_and_asks_no_body_for_more_than_it_can():
    aim = aimed(HELD, 0.2, standing())
    now, soon = aim.target(standing(), (), 9.81).airtime, aim.readied(standing(), (), 9.81).airtime
    assert now + 0.05 < soon < LONGEST
    assert aim.target(standing(), (), 9.81, 0.3).airtime == aim.readied(standing(), (), 9.81, 0.3).airtime == 0.3


@pytest.mark.parametrize("held", [0.1, 0.6])
def test_a_body_turns_to_the_ring_in_the_air_and_on_its_feet_while_it_is_aimed(held):
    """It turned before it jumped: from a tap aside or behind it took two or three seconds until it left the floor."""
    aim = aimed(Wish(jump=True, move=(1.0, 0.0)), held, standing())
    assert (aim.facing(standing(), ()) is not None) == (held > 0.2)
    let_go = aim.step(FREE, 0.0, standing(), False, DT)
    assert let_go.facing(standing(), ()) is None
    asked, ring = let_go.asked(standing(), (), 9.81), math.atan2(*let_go.offset)
    if held > 0.2:
        assert asked.heading == pytest.approx(ring)
        assert let_go.asked(standing(heading=ring + 0.2), (), 9.81).heading is None, "it faces it"


def test_a_body_that_aimed_at_something_higher_turns_to_it_before_it_jumps():
    box = (Box((0.0, 0.2, 2.0), (1.2, 0.4, 1.2)),)
    aim = aimed(Wish(jump=True, move=(1.0, 0.0)), 0.6, standing())
    let_go = aim.step(FREE, 0.0, standing(), False, DT)
    faced = let_go.facing(standing(), box)
    assert faced == pytest.approx(math.atan2(*let_go.offset)) and let_go.asked(standing(), box, 9.81) is None
    assert let_go.asked(standing(heading=faced), box, 9.81).place[1] == pytest.approx(0.4)


def test_a_walker_jumps_ahead_and_further_the_faster():
    far = []
    for speed in (1.2, 3.0):
        state = standing((speed, 0.0, 0.0), heading=0.7)
        aim = aimed(HELD, 0.2, state)
        assert aim.moving and not aim.stands and aim.facing(state, ()) is None
        assert math.atan2(*aim.offset) == pytest.approx(0.7)
        far.append(math.hypot(*aim.offset))
    assert far[1] > far[0] + 0.5


def test_the_ring_climbs_onto_what_is_low_enough():
    props = (Box((1.0, 0.25, 3.0), (1.0, 0.5, 1.0)), Box((1.0, 2.0, 2.0), (0.4, 0.2, 0.4)))
    aim = replace(aimed(HELD, 0.2, standing()), offset=(0.0, 1.0))
    assert aim.target(standing(), props, 9.81).place[1] == 0.5
    assert replace(aim, offset=(0.0, 0.3)).target(standing(), (props[1],), 9.81).place[1] == 0.0


def test_a_wish_is_given_up_when_refused_at_rest_or_after_a_while():
    let_go = aimed(HELD, 0.2, standing()).step(FREE, 0.0, standing(), False, DT)
    assert let_go.waiting == PATIENCE
    assert let_go.step(FREE, 0.0, standing(refused="too far"), False, DT) == Aim()
    assert aimed(FREE, PATIENCE - 0.1, standing(), let_go).waiting > 0.0
    assert aimed(FREE, PATIENCE + 0.1, standing(), let_go) == Aim()
    assert let_go.step(FREE, 0.0, standing(), True, DT) == Aim(), "who jumps aims at nothing"
    held = aimed(HELD, 0.2, standing()).step(HELD, 0.0, standing(), True, DT)
    assert not held.wants and not held.step(HELD, 0.0, standing(), False, DT).wants, "nor does who holds the key for a leap that went off by itself"


def test_a_leap_that_is_tapped_as_one_begins_waits_for_its_landing_and_is_lost_to_no_other_step():
    begun = aimed(HELD, 0.1, standing()).step(FREE, 0.0, standing(), False, DT).step(FREE, 0.0, standing(), True, DT)
    tapped = begun
    for wish in (HELD, HELD, FREE, FREE, FREE):
        tapped = tapped.step(wish, 0.0, standing(), True, DT)
    assert tapped.wants and tapped.waiting == PATIENCE
    flown = aimed(FREE, 0.1, standing(), tapped.step(FREE, 0.0, standing(), False, DT, aloft=True))
    assert flown.asked(standing(), (), 9.81) is not None
    assert flown.step(FREE, 0.0, standing(), True, DT) == Aim(), "it has gone off"


def test_who_holds_the_button_looks_where_to_jump_and_who_taps_it_or_jumps_up_does_not():
    push = Wish(jump=True, move=(0.6, 0.8))
    held = aimed(push, 0.8, standing())
    assert held.looked == pytest.approx(math.atan2(*held.offset))
    assert aimed(push, 0.15, standing()).looked is None
    assert aimed(HELD, 0.8, standing()).looked is None, "straight up"
    assert held.step(FREE, 0.0, standing(), False, DT).looked is None
    assert aimed(HELD, 0.8, standing((2.5, 0.0, 0.0), heading=1.0)).looked == pytest.approx(1.0)


def test_a_runner_s_ring_stays_where_it_was_let_go():
    state, velocity = standing((2.5, 0.0, 0.6), heading=0.8), np.array([2.5, 0.0, 0.6])
    aim, place = aimed(HELD, 0.5, state), None
    for _ in range(20):
        moved = drift(state.ground, velocity, np.array([DT]))[0]
        state, aim = replace(state, ground=moved), aim.step(FREE, 0.0, state, False, DT)
        target = aim.asked(state, (), 9.81).place
        assert place is None or np.array_equal(target, place)
        place = target
    assert np.hypot(*(place[[0, 2]] - state.ground[:2])) < 1.4, "it has come nearer"


def test_turning_while_one_aims_says_in_which_heading_to_land_and_nobody_turns_to_the_ring():
    aim = aimed(Wish(jump=True, move=(0.0, 1.0)), 0.5, standing())
    assert aim.heading is None and aim.facing(standing(), ()) == pytest.approx(0.0)
    left = aimed(Wish(jump=True, turn=1.0), 0.4, standing(), aim)
    assert left.heading == pytest.approx(0.4 * SWINGS) and left.facing(standing(), ()) is None
    right = aimed(Wish(jump=True, turn=-1.0), 0.4, standing(), aim)
    assert right.heading == pytest.approx(-0.4 * SWINGS)
    asked = left.step(FREE, 0.0, standing(), False, DT).asked(standing(), (), 9.81)
    assert asked.heading == left.heading and asked.place[2] > 2.5


def test_who_keeps_facing_lands_as_he_stands_wherever_the_ring_is_pushed():
    aim = aimed(Wish(jump=True, move=(1.0, 0.0), strafe=True), 0.5, standing(heading=0.3))
    assert aim.heading == pytest.approx(0.3) and aim.asked(standing(), (), 9.81) is None
    assert aim.readied(standing(heading=0.3), (), 9.81).heading == pytest.approx(0.3), "he crouches as he stands"


def test_a_stick_that_looks_points_the_landing_as_the_camera_sees_it_and_who_walks_has_none():
    aim = aimed(Wish(jump=True, look=(0.0, 1.0)), 0.1, standing(), yaw=1.0)
    assert aim.heading == pytest.approx(1.0)
    assert aimed(Wish(jump=True, turn=1.0), 0.1, standing((1.5, 0.0, 0.0))).heading is None


def test_a_body_that_turns_to_the_ring_behind_it_is_waited_for():
    """Half a turn takes longer than a leap is waited for that is ready."""
    behind = aimed(Wish(jump=True, move=(0.0, -1.0)), 0.5, standing())
    assert aimed(FREE, 2.3, standing(), behind).waiting > 0.1
    turned = standing(heading=math.pi)
    assert aimed(FREE, PATIENCE - 0.1, turned, behind).asked(turned, (), 9.81) is not None
    assert not aimed(FREE, PATIENCE + 0.1, turned, behind).wants


def test_who_comes_down_too_fast_to_leap_straight_up_has_the_ring_ahead_of_him_or_is_waited_for():
    """He was refused: nothing came of a tap in the air once both feet had landed at 1.2 m/s."""
    asked, why = aimed(HELD, 0.2, standing()).step(FREE, 0.0, standing(), False, DT), "too near for this pace: no foot brakes so much in one step"
    rests, fast, slow = standing(refused=why), standing((1.3, 0.0, 0.0), refused=why), standing((0.7, 0.0, 0.0), refused=why)
    led = asked.step(FREE, 0.0, rests, False, DT, even=True, now=fast)
    assert led.moving and led.place == pytest.approx((1.0, 2.0 + math.hypot(*Aim().step(HELD, 0.0, fast, False, DT).offset)))
    assert led.asked(replace(rests, memory=Duty("jump", None, "")), (), 9.81).place[[0, 2]] == pytest.approx(led.place)
    for now, even in ((fast, False), (slow, True)):
        waits = asked.step(FREE, 0.0, rests, False, DT, even=even, now=now)
        assert not waits.moving and 0.0 < waits.waiting < asked.waiting
    assert not asked.step(FREE, 0.0, rests, False, DT, even=True).wants, "who stands is refused at once"
    assert asked.step(FREE, 0.0, standing((0.1, 0.0, 0.0), refused="too far for this pace: no foot speeds up so much in one step"), False, DT).wants, "he rests soon"
    assert not asked.step(FREE, 0.0, standing((0.1, 0.0, 0.0), refused="too far: 2.0 m"), False, DT).wants, "who is refused for something else is told at once"


def test_the_ring_stays_ahead_of_who_lets_go_of_it_in_the_air_and_goes_on():
    """It stayed where it was let go, and who had landed was too near to it: nothing came of leaps that were asked in the air."""
    state = standing((2.5, 0.0, 0.0))
    aim = aimed(HELD, 0.2, state).step(FREE, 0.0, state, False, DT, aloft=True)
    down = replace(state, ground=state.ground + [0.0, 0.8, 0.0])
    later = aim.step(FREE, 0.0, down, False, DT, aloft=True)
    assert np.subtract(later.place, aim.place) == pytest.approx([0.0, 0.8]) and later.waiting == aim.waiting
    landed = later.step(FREE, 0.0, down, False, DT)
    assert landed.place == later.place and landed.waiting < later.waiting
