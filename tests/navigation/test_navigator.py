"""Whoever is told a goal goes there, round what stands about, and says when he has arrived or why he can't."""

from dataclasses import replace

import numpy as np
import pytest

from gambol.controllers.body.rotations import wrap
from gambol.controllers.contract import Controller, Goal, Intent
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.navigation import gap, going as led
from gambol.controllers.scaled import Scaled
from gambol.controllers.supervisor import Supervisor
from gambol.game.scene import Box, Pillar

BOXES = (Box((0.6, 0.5, 1.5), (0.8, 1.0, 0.5), 0.3), Box((-1.2, 0.5, 1.0), (0.5, 1.0, 1.4), -0.4))


@pytest.fixture(scope="module")
def walker():
    return Supervisor({"locomotion": Locomotion.load()})


def going(someone, goal, state=None, around=(), seconds=20.0, until=("done", "failed")):
    """The states up to where a walk to a goal is done or has failed, and a second more; a goal that he had failed to reach is thought of first."""
    states, left = [someone.start() if state is None else state], None
    for _ in range(round(60 * seconds)):
        states.append(someone.step(states[-1], Intent(goal=goal, around=around), 1 / 60)[0])
        if left is None and someone.status(states[-1]).kind in until:
            left = 60
        left = None if left is None else left - 1
        if left == 0:
            break
    return states


def nearest(boxes, states):
    """How near the middle of the body comes to boxes [m]."""
    ground = np.array([[state.ground[0], 0.5, state.ground[1]] for state in states])
    return min(np.min(gap(ground, box)) for box in boxes)


def off(state, goal):
    heading = state.going.heading if goal.heading is None else goal.heading
    return np.hypot(*(state.ground[:2] - goal.floor)), abs(float(wrap(state.ground[2] - heading)))


@pytest.mark.few(2)
@pytest.mark.parametrize("seed", range(6))
def test_random_goals_are_reached(walker, seed):
    rng = np.random.default_rng(seed)
    goal = Goal(rng.uniform(-3, 3, 2), rng.uniform(-np.pi, np.pi))
    last = going(walker, goal)[-1]
    place, turn = off(last, goal)
    assert walker.status(last).kind == "done" and place < 0.03 and np.degrees(turn) < 3, (goal, place, turn)
    assert np.abs(last.velocity).max() < 1e-6, "and he stands"


@pytest.mark.few(1)
@pytest.mark.parametrize(("place", "turn"), [((-1.5, 2.2), -1.8), ((0.3, 3.0), -2.4), ((1.2, 3.0), -1.8)])
def test_who_turns_at_his_place_stands_on_it_after_two_more_steps(walker, place, turn):
    """The other foot stood in the way of the last but one, which came down 16 cm aside, so that the body glided 9 cm off and four small steps brought it back."""
    states = going(walker, Goal(place, float(wrap(np.arctan2(*place) + turn))))
    feet = np.array([np.asarray(state.contacts).reshape(2, 2).any(-1) for state in states])
    ground = np.array([state.ground for state in states])
    goes = np.hypot(*np.diff(ground[:, :2], axis=0, prepend=ground[:1, :2]).T) * 60
    there = (np.hypot(*(ground[:, :2] - place).T) < 0.15) & (np.abs(wrap(ground[:, 2] - ground[-1, 2])) < 0.35) & (goes < 0.12) & feet.all(-1)
    first = int(there.argmax())
    assert (np.diff(feet.astype(int), axis=0)[first:] > 0).any(-1).sum() <= 2
    assert np.hypot(*(ground[first:, :2] - place).T).max() < 0.07


def test_he_walks_round_boxes(walker):
    for place in ((1.2, 2.6), (-2.0, 1.2), (0.0, 3.0)):
        goal = Goal(place, 2.0)
        states = going(walker, goal, around=BOXES)
        assert walker.status(states[-1]).kind == "done" and off(states[-1], goal)[0] < 0.03
        assert nearest(BOXES, states) > 0.25, "what he is off his plan, and no more"


def test_a_goal_in_a_box_is_refused_and_he_stays(walker):
    states = going(walker, Goal((0.6, 1.5), 0.0), around=BOXES, seconds=2)
    assert walker.status(states[-1]).kind == "failed" and "in something" in walker.status(states[-1]).reason
    assert np.hypot(*states[-1].ground[:2]) < 0.05
    free = going(walker, Goal((0.6, 1.5), 0.0), states[-1])
    assert walker.status(free[-1]).kind == "done", "once the box has gone, he goes"


def test_the_same_states_and_goals_give_the_same_walk_to_the_bit(walker):
    goal = Goal((-1.0, 0.0, 2.6))
    states = going(walker, goal, around=BOXES)
    again = going(walker, goal, states[70], around=BOXES)
    assert len(states) - 70 == len(again)
    for one, other in zip(states[70:], again):
        assert one.pose.root.tobytes() == other.pose.root.tobytes() and one.pose.rotations.tobytes() == other.pose.rotations.tobytes()
        assert one.going is None or one.going.time == other.going.time


def test_a_goal_that_moves_and_things_that_come_are_planned_for(walker):
    states = going(walker, Goal((0.0, 3.0), 0.0), seconds=1.2)
    assert walker.status(states[-1]).kind == "running"
    goal = Goal((2.0, 1.0), -1.0)
    moved = going(walker, goal, states[-1])
    assert walker.status(moved[-1]).kind == "done" and off(moved[-1], goal)[0] < 0.03 and moved[-1].going.plans == 2
    wall = (Box((0.0, 1.0, 1.8), (1.5, 2.0, 0.2)),)
    states = going(walker, Goal((0.0, 3.0), 0.0), states[-1], around=wall)
    assert walker.status(states[-1]).kind == "done"
    assert nearest(wall, states) > 0.25


def test_whoever_is_pushed_plans_anew_and_who_gets_nowhere_says_so(walker):
    goal = Goal((0.0, 3.0), 0.0)
    state = going(walker, goal, seconds=1.0)[-1]
    pushed = replace(state, ground=state.ground + [0.6, -0.2, 0.0])
    states = going(walker, goal, pushed)
    assert states[-1].going.plans == 2 and off(states[-1], goal)[0] < 0.03
    back = going(walker, goal, replace(states[-1], ground=states[-1].ground - [0.0, 0.5, 0.0]))
    assert walker.status(back[-1]).kind == "done" and off(back[-1], goal)[0] < 0.03, "as is who had arrived"
    for _ in range(60 * 30):  # an unseen wall
        state, _ = walker.step(replace(state, ground=np.minimum(state.ground, [9.0, 1.0, 9.0])), Intent(goal=goal), 1 / 60)
        if walker.status(state).kind == "failed":
            break
    assert "held up" in walker.status(state).reason


def test_without_a_heading_he_looks_as_he_comes(walker):
    last = going(walker, Goal((2.0, -1.0)))[-1]
    assert last.going.heading == pytest.approx(np.arctan2(2.0, -1.0)) and off(last, Goal((2.0, -1.0)))[1] < np.radians(3)
    wall = (Box((0.0, 1.0, 1.5), (3.0, 2.0, 0.2)),)
    round_it = going(walker, Goal((0.0, 2.2)), around=wall)[-1]
    assert abs(round_it.going.heading) > np.radians(60), "round the wall's end, along its back"


def test_he_is_there_in_time_or_says_how_long_it_takes(walker):
    free = going(walker, Goal((0.0, 3.0), 0.0), seconds=0.2)[-1].going.plan.seconds
    hurry = going(walker, Goal((0.0, 3.0), 0.0, 0.9 * free))[-1]
    assert walker.status(hurry).kind == "done" and hurry.going.plan.seconds <= 0.9 * free
    late = going(walker, Goal((0.0, 3.0), 0.0, 0.5), seconds=0.5)[-1]
    assert walker.status(late).kind == "failed" and "0.4 s are given" in walker.status(late).reason, "what thinking leaves of them"


def test_a_child_gets_there_at_its_own_pace(walker):
    child = Supervisor({"locomotion": Scaled(walker.parts["locomotion"], 0.7)})
    last = going(child, Goal((1.5, 2.0), 0.5))[-1]
    assert child.status(last).kind == "done" and off(last, Goal((1.5, 2.0), 0.5))[0] < 0.03
    assert last.going.plan.seconds > going(walker, Goal((1.5, 2.0), 0.5), seconds=0.2)[-1].going.plan.seconds


def test_the_walk_rests_while_somebody_else_is_on_duty(walker):
    goal = Goal((0.0, 3.0), 0.0)
    state = going(walker, goal, seconds=1.0)[-1]
    way, intent = led(state, Intent(np.ones(3), goal=goal), walker, False, 1 / 60)
    assert way.time == state.going.time and way.plan is state.going.plan and intent.leap is None
    assert 0.05 < intent.velocity[0] < 0.5, "he who has landed is told that he has to go on"
    way, intent = led(state, Intent(np.ones(3), goal=goal), walker, True, 1 / 60)
    assert way.time > state.going.time and intent.velocity[0] > 0.5


class Nobody(Controller):
    """Who walks nowhere."""


def test_who_has_no_gaits_says_so(walker):
    way, intent = led(walker.start(), Intent(goal=Goal((0.0, 1.0))), Nobody(), True, 1 / 60)
    assert way.status.kind == "failed" and "nobody here walks" in way.status.reason and not intent.velocity.any()


def test_no_goal_no_going(walker):
    state = going(walker, Goal((0.0, 3.0)), seconds=1.0)[-1]
    assert state.going is not None and walker.step(state, Intent(), 1 / 60)[0].going is None


@pytest.mark.parametrize(("wrong", "said"), [((np.nan, 0.0), "x, z"), ((1.0,), "x, z"), ((0.0, 0.0, 0.0, 0.0), "x, z")])
def test_what_is_no_goal_is_refused(wrong, said):
    with pytest.raises(ValueError, match=said):
        Goal(wrong)
    with pytest.raises(ValueError, match="heading"):
        Goal((0.0, 0.0), np.inf)
    with pytest.raises(ValueError, match="more than 0 s"):
        Goal((0.0, 0.0), None, -1.0)


@pytest.mark.few(1)
@pytest.mark.parametrize("pace", [0.001, 1.0])
def test_what_moves_about_far_away_holds_nobody_up(walker, pace):
    """A goal was thought of anew in each step, and never gone to."""
    state, goal = walker.start(), Goal((0.0, 4.0))
    for k in range(60 * 8):
        state, _ = walker.step(state, Intent(goal=goal, around=(Pillar((30.0 + pace * k / 60, 0.0, 30.0)),)), 1 / 60)
    assert walker.status(state).kind == "done" and off(state, goal)[0] < 0.05
    assert state.going.plans == 1


def test_past_what_moves_beside_his_way_he_gets_there_and_past_what_comes_into_it_he_goes_round(walker):
    state, goal, boxes, apart = walker.start(), Goal((0.0, 5.0)), [], []
    for k in range(60 * 15):
        boxes = [Box((1.5, 0.5, 1.0 + 0.005 * k), (0.4, 1.0, 0.4)), Box((min(-3.0 + 0.02 * k, 0.0), 0.5, 3.5), (0.8, 1.0, 0.3))]
        state, _ = walker.step(state, Intent(goal=goal, around=boxes), 1 / 60)
        apart.append(nearest(boxes, [state]))
    assert walker.status(state).kind == "done" and off(state, goal)[0] < 0.05
    assert min(apart) > 0.15 and state.going.plans > 1
