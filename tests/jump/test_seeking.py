"""Leaps of who stands are sought in pieces: no step makes more than one plan, and the same comes of it as of all at once."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gambol.controllers.contract import Intent, Leap
from gambol.controllers.jump import Jump, Jumping, Refused
from gambol.controllers.jump.reach import SHARE, Seeking, Spread, reach, whole
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.supervisor import Supervisor
from gambol.game.scene import Box

LOW, HIGH = (Box((0.0, high / 2, 0.7), (1.0, high, 0.1)) for high in (0.4, 0.6))


def of(costs, done):
    for cost in costs:
        yield cost
        if isinstance(cost, int):
            done.append(cost)
    return tuple(costs)


@given(st.lists(st.one_of(st.integers(1, SHARE), st.sampled_from(["near", "far"])), max_size=12), st.lists(st.integers(1, 20), min_size=1, max_size=6))
def test_what_is_known_depends_on_the_steps_alone(costs, asked):
    """Whoever asked before, and for how many; no share costs more than a step has time for."""
    steps = [Seeking(of(costs, [])).after(n) for n in range(1, 21)]
    seeking = Seeking(of(costs, []))
    assert [seeking.after(n) for n in asked] == [steps[n - 1] for n in asked]
    assert steps[-1] == whole(of(costs, [])) == tuple(costs)
    done, before = [], 0
    seeking = Seeking(of(costs, done))
    for n in range(1, 21):
        seeking.after(n)
        assert sum(done) - before <= SHARE
        before = sum(done)
        words = [known for known in steps[:n] if isinstance(known, str)]
        assert steps[n - 1] == tuple(costs) or words[-1] in ("", *costs)


def told(costs, known):
    """Questions that cost so much each, in pieces, or at once where that is known already; in which step each was answered."""
    answered = []
    for cost in costs:
        for piece in [*([sum(cost)] if known else cost), 0]:
            number = yield piece
        answered.append(number)
        yield 1
    return answered


@given(st.lists(st.lists(st.integers(1, 9), min_size=1, max_size=4), min_size=1, max_size=6), st.integers(1, 12))
def test_what_is_known_already_is_of_use_after_as_many_steps_as_what_is_found_out(costs, each):
    one, other = Spread(told(costs, False), each), Spread(told(costs, True), each)
    steps = sum(map(sum, costs)) + len(costs) + 2
    assert one.after(steps) == other.after(steps) and isinstance(one.after(steps), list)
    assert [isinstance(one.after(n), list) for n in range(1, steps)] == [isinstance(other.after(n), list) for n in range(1, steps)]
    assert one.after(steps)[-1] <= (sum(map(sum, costs)) + len(costs)) / each


@pytest.fixture(scope="module")
def someone():
    return Supervisor({"locomotion": Locomotion.load(), "jump": Jump()})


@pytest.mark.few(2)
@pytest.mark.parametrize("place, things", [((0.0, 0.0, 5.0), ()), ((0.0, 0.0, 1.4), (HIGH,)), ((0.0, 0.0, 1.3), (LOW,))], ids=["far", "refused", "leapt"])
@pytest.mark.parametrize("crouches", [False, True])
def test_no_step_of_who_stands_makes_two_plans_and_it_ends_as_all_at_once(someone, monkeypatch, place, things, crouches):
    jump, intent, state = someone.parts["jump"], Intent(leap=Leap(np.array(place)), around=things), someone.start()
    for _ in range(60 * crouches):
        state, _ = someone.step(state, Intent(aim=intent.leap, around=things), 1 / 60)
    plans, plan = [], reach.drafted
    monkeypatch.setattr(reach, "drafted", lambda *given: plans.append(1) or plan(*given))
    states = [state]
    for _ in range(60):
        before, state = state, someone.step(state, intent, 1 / 60)[0]
        assert len(plans) <= 1
        plans.clear()
        states.append(state)
        if isinstance(state.memory.memory, Jumping):
            break
    now = someone.active(states[0])[1]
    try:
        made, parted = jump.plan(now, intent), whole(jump._looked_for(now, intent, True)).made
        np.testing.assert_array_equal(parted.local, made.local)
        np.testing.assert_allclose(state.memory.memory.plan.local, jump.enter(someone.active(before)[1], intent).memory.plan.local, atol=1e-4)  # higher by a share of what it was
    except Refused as reason:
        assert state.refused == str(reason) and not isinstance(state.memory.memory, Jumping)
    again = states[3]
    for then in states[4:]:  # from where somebody went back to
        again, _ = someone.step(again, intent, 1 / 60)
        assert again.refused == then.refused and np.array_equal(again.pose.rotations, then.pose.rotations)


def test_no_step_of_who_comes_to_rest_makes_two_plans(someone, monkeypatch):
    """Before he had set his last foot down he looked at all of them in each step, a dozen at once: a game stood still for half a second, over and over."""
    state, plans, plan = someone.start(), [], reach.drafted
    for _ in range(90):
        state, _ = someone.step(state, Intent(np.array([1.3, 0.0, 0.0])), 1 / 60)
    while np.hypot(*state.velocity[[0, 2]]) > 0.28:
        state, _ = someone.step(state, Intent(), 1 / 60)
    assert not someone.parts["jump"]._stands(someone.active(state)[1])
    x, z, heading = state.ground
    there = np.array([x + 1.4 * np.sin(heading), 0.0, z + 1.4 * np.cos(heading)])
    wall = Box((float(x + 0.75 * np.sin(heading)), 0.3, float(z + 0.75 * np.cos(heading))), (1.0, 0.6, 0.1), float(heading))
    monkeypatch.setattr(reach, "drafted", lambda *given: plans.append(1) or plan(*given))
    counts = []
    for _ in range(40):
        state, _ = someone.step(state, Intent(leap=Leap(there), around=(wall,)), 1 / 60)
        counts.append(len(plans))
        plans.clear()
    assert max(counts) == 1 and sum(counts) > 3 and state.refused


@pytest.mark.few(2)
@pytest.mark.parametrize("crouches", [False, True])
@pytest.mark.parametrize("speed", [1e-4, 0.1, 0.5])
def test_a_place_that_moves_is_leapt_to_where_it_is_then(someone, monkeypatch, speed, crouches):
    """It was sought anew in each step, so nobody ever leapt to it, nor was told why."""
    state, plans, plan, top = someone.start(), [], reach.drafted, 0.4
    monkeypatch.setattr(reach, "drafted", lambda *given: plans.append(1) or plan(*given))
    for n in range(60 * (1 + crouches)):
        place = np.array([0.0, top, 1.3 + speed * (n / 60 - crouches)])
        things, leap = (Box((0.0, top / 2, place[2]), (1.0, top, 1.0)),), Leap(place)
        state, _ = someone.step(state, Intent(aim=leap, around=things) if crouches and n < 60 else Intent(leap=leap, around=things), 1 / 60)
        if isinstance(state.memory.memory, Jumping):
            break
        assert len(plans) <= 1
        plans.clear()
    assert n < 60 * crouches + 30, "it leaps"
    lands = state.memory.memory.plan.feet[:, [0, 2]].mean(0)
    assert np.hypot(*(lands - place[[0, 2]])) < 0.1


def test_who_is_refused_a_place_that_moves_is_told_why_all_along(someone):
    state, told = someone.start(), []
    for n in range(60):
        state, _ = someone.step(state, Intent(leap=Leap(np.array([0.0, 0.0, 5.0 + 0.001 * n]))), 1 / 60)
        told.append(state.memory.refused)
    assert all(why.startswith("too far") for why in told[20:])


@pytest.mark.few(1)
@pytest.mark.parametrize("speed, far", [(0.7, 0.45), (0.9, 0.6)])
def test_a_heading_that_turns_a_little_is_no_other_wish(someone, monkeypatch, speed, far):
    """Whose course turned as he slowed down was asked all anew in every step, seventeen plans: a game stood still for seconds."""
    wish, state, plans, plan, made, stances = np.array([speed, 0.0, 0.0]), someone.start(), [], reach.drafted, [], 1
    for _ in range(90):
        state, _ = someone.step(state, Intent(wish), 1 / 60)
    monkeypatch.setattr(reach, "drafted", lambda *given: plans.append(1) or plan(*given))
    z = float(state.ground[1])
    things = (Box((0.0, 0.125, z + far), (1.0, 0.25, 0.1)),)
    for n in range(40):
        after, _ = someone.step(state, Intent(wish, Leap(np.array([0.0, 0.0, z + far + 0.5]), slack=0.5, heading=0.0003 * n), around=things), 1 / 60)
        stances, state = stances + (not np.array_equal(after.contacts, state.contacts)), after
        made.append(len(plans))
        plans.clear()
    assert 0 < sum(count > 4 for count in made) <= stances < 6
