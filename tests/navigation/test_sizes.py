"""Goals are planned for the body that goes there: its steps, its head and its shoulders are of its size."""

import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gambol.controllers.contract import Goal, Intent
from gambol.controllers.jump import Physique
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.navigation.obstacles import highest_step
from gambol.controllers.navigation.passing import STEP
from gambol.controllers.person import person
from gambol.controllers.scaled import Scaled
from gambol.controllers.supervisor import Supervisor
from gambol.game.explain.way import cost_of
from gambol.game.scene import Box

DT = 1 / 60


@pytest.fixture(scope="module")
def library():
    return Locomotion.load()


def walker(library, height):
    return Supervisor({"locomotion": Scaled(library, Physique(height=height).size)})


def going(someone, goal, around=(), seconds=20.0, state=None):
    """The states up to where a walk to a goal is done or has failed."""
    states = [someone.start() if state is None else state]
    for _ in range(round(seconds / DT)):
        states.append(someone.step(states[-1], Intent(goal=goal, around=around), DT)[0])
        if someone.status(states[-1]).kind != "running":
            break
    return states


def aside(states):
    """How far to the side he goes [m]."""
    return max(abs(float(state.ground[0])) for state in states)


def stairs(rise):
    treads = (Box((0.0, 0.5 * rise * (n + 1), 2.0 + 0.29 * n), (2.0, rise * (n + 1), 0.29)) for n in range(4))
    return (*treads, Box((0.0, 2.0 * rise, 4.515), (2.0, 4.0 * rise, 3.0)))


def door(wide):
    return tuple(Box((side * (1.5 + 0.5 * wide), 1.75, 2.0), (3.0, 3.5, 0.2)) for side in (-1.0, 1.0))


def test_who_is_tall_walks_up_stairs_that_are_too_high_for_others(library):
    goal = Goal((0.0, 4.2))
    giant = walker(library, 2.1)
    last = going(giant, goal, stairs(0.24))[-1]
    assert giant.status(last).kind == "done" and float(last.floor) == pytest.approx(0.96) and np.hypot(*(last.ground[:2] - goal.floor)) < 0.03
    child = walker(library, 0.9)
    last = going(child, goal, stairs(0.17), 1.0)[-1]
    assert child.status(last).kind == "failed" and np.hypot(*last.ground[:2]) < 0.05, "he does not walk there to be held up"


@pytest.mark.few(1)
@pytest.mark.parametrize("height, rise", [(1.0, 0.17), (1.2, 0.2), (1.35, 0.2)])
def test_a_child_walks_up_the_stairs_of_grown_ups(library, height, rise):
    """Children of 1.1 m climb stairs of 17 cm, a larger share of their height than grown-ups do; and down again."""
    child, goal = walker(library, height), Goal((0.0, 4.2))
    states = going(child, goal, stairs(rise))
    assert child.status(states[-1]).kind == "done" and float(states[-1].floor) == pytest.approx(4 * rise) and np.hypot(*(states[-1].ground[:2] - goal.floor)) < 0.03
    last = going(child, Goal((0.0, 0.5)), stairs(rise), state=states[-1])[-1]
    assert child.status(last).kind == "done" and float(last.floor) == pytest.approx(0.0)


def test_who_is_told_that_steps_are_too_high_is_told_his_own(library):
    for height, most in ((1.0, "0.17"), (1.2, "0.21"), (1.5, "0.21"), (2.4, "0.29")):
        someone = walker(library, height)
        reason = someone.status(going(someone, Goal((0.0, 3.0)), (Box((0.0, 0.4, 3.0), (2.0, 0.8, 2.0)),), 1.0)[-1]).reason
        assert f"steps rise by {most} m at most" in reason


@given(st.floats(0.3, 3.0), st.floats(0.3, 3.0))
def test_the_highest_step_goes_with_the_body(one, other):
    """In its own metres a larger body's is no lower, a grown-up's is the standard one's; in the standard body's size none is higher than legs take."""
    small, large = sorted((one, other))
    assert highest_step(1.0) == 0.21 and highest_step(large) <= highest_step(small) < STEP
    assert small * highest_step(small) <= large * highest_step(large) + 1e-12


@pytest.mark.few(2)
@pytest.mark.parametrize("height, under, round_it", [(0.9, 1.1, False), (2.1, 2.05, True), (2.1, 2.5, False)])
def test_whoever_fits_under_a_beam_walks_under_it_and_others_round_it(library, height, under, round_it):
    someone = walker(library, height)
    states = going(someone, Goal((0.0, 4.0)), (Box((0.0, under + 0.25, 2.0), (2.0, 0.5, 0.3)),))
    assert someone.status(states[-1]).kind == "done" and (aside(states) > 1.0) == round_it


def test_a_child_walks_through_a_door_of_half_a_metre_and_a_giant_round_one_of_his_shoulders(library):
    child, giant = walker(library, 0.9), walker(library, 2.4)
    states = going(child, Goal((0.0, 3.5)), door(0.5))
    assert child.status(states[-1]).kind == "done" and aside(states) < 0.3
    states = going(giant, Goal((0.0, 4.0)), door(0.7))
    assert giant.status(states[-1]).kind == "done" and aside(states) > 3.0


def test_a_child_leaps_onto_a_kerb_that_is_too_high_for_his_step():
    child = person(physique=Physique(height=0.9, mass=10.0))
    goal = Goal((0.0, 2.6))
    states = going(child, goal, (Box((0.0, 0.085, 2.9), (3.0, 0.17, 3.0)),))
    last = states[-1]
    assert child.status(last).kind == "done" and float(last.floor) == pytest.approx(0.17) and np.hypot(*(last.ground[:2] - goal.floor)) < 0.03
    assert any(state.active == "jump" for state in states)
    leap = next(state.going.crossings[0] for state in states[1:] if state.going.crossings)
    assert leap.place[1] == pytest.approx(0.17) and leap.ground[1] < 1.4 < leap.place[2], "told where it is in the world"


def test_his_way_is_told_in_his_own_world(library):
    giant = walker(library, 2.4)
    states = going(giant, Goal((1.0, 3.0), 0.5), seconds=1.0)
    way, before = states[-1].going, next(state for state, after in zip(states, states[1:]) if after.going.plans)
    assert np.allclose(way.plan.goal, [1.0, 3.0, 0.5], atol=1e-9) and way.goal == way.planned == Goal((1.0, 3.0), 0.5)
    assert np.abs(way.plan.at(0.0)[0] - before.ground).max() < 1e-9, "from where he was foreseen"
    off = way.plan.at(way.time)[0] - states[-1].ground
    assert np.hypot(*off[:2]) < 0.05 and 0.5 < way.time < 1.0
    assert np.allclose(way.wished(states[-1].ground, states[-1].velocity), way.plan.at(way.time)[1], atol=0.5)
    assert cost_of(way.costed).sum() == pytest.approx(way.plan.cost, rel=0.01)
    wall = (Box((1.0, 1.0, 3.5), (1.0, 2.0, 0.2)),)
    assert "the goal is 0.40 m from something, 0.41 m are needed" in giant.status(going(giant, Goal((1.0, 3.0)), wall)[-1]).reason


def test_the_way_of_another_size_goes_on_to_the_bit_wherever_it_is_taken_up(library):
    child, goal, wall = walker(library, 1.2), Goal((0.5, 3.0)), (Box((0.0, 0.5, 1.5), (1.0, 1.0, 0.2)),)
    states = going(child, goal, wall)
    for copy in (lambda state: state, lambda state: pickle.loads(pickle.dumps(state))):
        again = going(child, goal, wall, state=copy(states[40]))
        assert len(states) - 40 == len(again)
        assert all(one.pose.root.tobytes() == other.pose.root.tobytes() for one, other in zip(states[40:], again))
