"""Leap after leap: the landing of one is the wind-up of the next."""

from dataclasses import replace

import numpy as np
import pytest

from gambol.controllers.body import centre_of_mass, contact_points, forward_kinematics
from gambol.controllers.contract import Intent, Leap
from gambol.controllers.jump import Crouching, Jumping

from conftest import ahead

FPS = 60


@pytest.fixture(scope="module")
def rest(person):
    state = person.start()
    for _ in range(10):
        state, _ = person.step(state, Intent(), 1 / FPS)
    return state


def bounced(person, rest, leaps, wished, steps=220):
    """The states of somebody who makes leaps, each wished so long [s] after the take-off of the one before, and the plans that were played."""
    state, states, plans = rest, [rest], []
    for _ in range(steps):
        memory, leap = state.memory.memory, None
        if isinstance(memory, Jumping) and (not plans or memory.plan is not plans[-1]):
            plans.append(memory.plan)
        if not plans:
            leap = leaps[0]
        elif len(plans) < len(leaps) and isinstance(memory, Jumping) and memory.time > memory.plan.take_off + wished:
            leap = leaps[len(plans)]
        state, _ = person.step(state, Intent(leap=leap), 1 / FPS)
        states.append(state)
    return states, plans


def grounded(states, plans):
    """How long [s] feet stood between each leap and the next."""
    begun = [next(n for n, s in enumerate(states) if isinstance(s.memory.memory, Jumping) and s.memory.memory.plan is plan) - 1 for plan in plans]
    return [(b - a) / FPS + after.take_off - plan.touch_down for a, b, plan, after in zip(begun, begun[1:], plans, plans[1:])]


@pytest.fixture(scope="module")
def ahead_thrice(person, rest):
    leaps = [Leap(ahead(rest, far)) for far in (0.7, 1.4, 2.1)]
    return leaps, *bounced(person, rest, leaps, 0.1)


def test_each_goes_off_from_the_landing_before_and_lands_where_it_should(jump, ahead_thrice):
    leaps, states, plans = ahead_thrice
    assert len(plans) == 3 and max(grounded(states, plans)) < 0.5
    down = next(n for n, s in enumerate(states) if isinstance(s.memory.memory, Jumping) and s.memory.memory.plan is plans[2]
                and s.memory.memory.time > plans[2].touch_down + 0.2)
    balls = contact_points(jump.skeleton, *forward_kinematics(jump.skeleton, states[down].pose.root.astype(float),
                                                              states[down].pose.rotations.astype(float))).reshape(2, 2, 3)[:, 1]
    assert np.abs(balls[:, [0, 2]] - plans[2].feet[:, [0, 2]]).max() < 0.01
    assert np.abs(jump.middle(jump.start_of(replace(states[down], memory=None)), 0.0) - leaps[2].place)[[0, 2]].max() < 0.02


def test_the_force_goes_on_and_neither_pulls_nor_strikes(jump, ahead_thrice):
    _, states, plans = ahead_thrice
    placed = [forward_kinematics(jump.skeleton, s.pose.root.astype(float), s.pose.rotations.astype(float)) for s in states]
    height = np.array([centre_of_mass(jump.physique.anatomy, *one)[1] for one in placed])
    force = 1.0 + np.diff(height, 2) * FPS**2 / 9.81
    first = next(n for n, s in enumerate(states) if isinstance(s.memory.memory, Jumping) and s.memory.memory.plan is plans[1])
    around = slice(first - 4, first + 10)  # where one plan gives way to the next
    assert force[around].min() > 0.5 and force[around].max() < 3.2 and np.abs(np.diff(force[around])).max() < 0.8


def test_arms_swing_through_without_a_snap(jump, ahead_thrice):
    """They were first to go back, within two hundredths of a second: hands were thrown at 300 to 560 m/s²."""
    _, states, plans = ahead_thrice
    hands = [jump.skeleton.index(name) for name in ("LeftHand", "RightHand")]
    places = np.array([forward_kinematics(jump.skeleton, s.pose.root.astype(float), s.pose.rotations.astype(float))[0][hands] for s in states])
    pushes = [n for n, s in enumerate(states) if isinstance(s.memory.memory, Jumping) and s.memory.memory.plan in plans[1:] and s.memory.memory.time < s.memory.memory.plan.take_off]
    thrown = np.linalg.norm(np.diff(places, n=2, axis=0), axis=-1) * FPS**2
    assert thrown[np.array(pushes) - 1].max() < 220.0
    assert np.ptp(places[pushes][..., 1], axis=0).max() > 0.3, "they still swing"


def test_it_bounces_on_the_spot_as_long_as_it_is_asked_again_and_not_because_the_wish_is_held(person, rest):
    leap = Leap(None, 0.42)
    states, plans = bounced(person, rest, [leap] * 3, 0.05)
    assert len(plans) == 3 and max(grounded(states, plans)) < 0.5
    state, seen = rest, set()
    for _ in range(88):  # until 0.4 s after it has landed
        state, _ = person.step(state, Intent(leap=leap), 1 / FPS)
        seen.add(id(state.memory.memory.plan) if isinstance(state.memory.memory, Jumping) else 0)
    assert len(seen - {0}) == 1


def test_a_leap_that_was_let_go_of_before_it_left_the_floor_may_be_asked_again(person, rest):
    leap, state, plans, wished = Leap(None, 0.42), rest, [], True
    for _ in range(88):  # until 0.4 s after it has landed
        state, _ = person.step(state, Intent(leap=leap if wished else None), 1 / FPS)
        memory = state.memory.memory
        if isinstance(memory, Jumping):
            plans += [memory.plan] if memory.plan not in plans else []
            wished = memory.time > memory.plan.take_off
    assert len(plans) == 2


def test_what_can_t_follow_is_said_once_and_it_lands_as_it_would(person, rest):
    states, plans = bounced(person, rest, [Leap(ahead(rest, 0.7)), Leap(ahead(rest, 9.0))], 0.1, 120)
    assert len(plans) == 1 and any("too far" in s.refused for s in states)
    assert all(np.isfinite(s.pose.root).all() for s in states)


def test_who_still_aims_as_he_lands_waits_in_the_crouch(person, rest):
    state, leap, seen = rest, Leap(ahead(rest, 0.7)), []
    for _ in range(150):
        memory = state.memory.memory
        flies = isinstance(memory, Jumping) and memory.time > memory.plan.take_off
        state, _ = person.step(state, Intent(leap=leap) if not flies and not seen else Intent(aim=Leap(None, 0.45)), 1 / FPS)
        if flies:
            seen.append(state)
        elif seen:
            seen.append(state)
    height = np.array([s.pose.root[1] for s in seen])
    landed = [n for n, s in enumerate(seen) if isinstance(s.memory.memory, Crouching)]
    assert landed and np.abs(np.diff(height[landed[0] - 3:], 2)).max() < 0.008 and height[-1] < 0.9 * float(rest.pose.root[1])


@pytest.mark.parametrize("late", [0.25, 0.35, 0.5])
def test_who_aims_as_he_comes_up_again_goes_down_from_there(person, rest, late):
    """He stood up first, and was off 1.13 s after he landed, whenever he was asked."""
    state, down, went, heights = rest, None, None, []
    for n in range(240):
        memory = state.memory.memory
        if down is None and isinstance(memory, Jumping) and memory.landed:
            down = n
        since = -1.0 if down is None else (n - down) / FPS
        leap = Leap(None)
        intent = Intent(leap=leap) if down is None and not isinstance(memory, Jumping) or since >= late + 0.1 and went is None else Intent(aim=leap if late <= since < late + 0.1 else None)
        state, _ = person.step(state, intent, 1 / FPS)
        heights.append(float(centre_of_mass(person.parts["jump"].physique.anatomy, *forward_kinematics(person.skeleton, state.pose.root.astype(float), state.pose.rotations.astype(float)))[1]))
        if went is None and since >= late:
            assert state.active == "jump" and (since < late + 0.02 or isinstance(state.memory.memory, Crouching | Jumping))
            if isinstance(state.memory.memory, Jumping) and state.memory.memory.time < 0.1:
                went = since + state.memory.memory.plan.take_off
    assert went is not None and went < 0.6 + late
    lifts = np.diff(heights, 2)[down + 3:down + round(FPS * went) - 6] * FPS**2 / 9.81
    assert lifts.min() > -1.1  # the floor does not pull him down
