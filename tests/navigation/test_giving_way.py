"""Who goes to a goal and is led aside by others: his plan waits, is made anew where he is led off it, and is given up in the end."""

import numpy as np
import pytest

from gambol.controllers.contract import Goal, Intent
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.navigation import wish
from gambol.controllers.navigation.goal import progress
from gambol.controllers.navigation.navigator import PATIENCE
from gambol.controllers.supervisor import Supervisor

GOAL = Goal((0.0, 3.0), 0.0)


@pytest.fixture(scope="module")
def walker():
    return Supervisor({"locomotion": Locomotion.load()})


def stopped(state):
    """What is added to a walk to a goal by whoever may not go on."""
    way = state.going
    return None if way is None else -wish(way.plan, way.time, state.ground, state.velocity)


def test_progress_is_the_share_of_the_way():
    ahead = np.array([1.2, 0.3, 0.0])
    assert progress(ahead, ahead) == 1.0 and progress(ahead, 2.0 * ahead) == 1.0 and progress(ahead, -ahead) == 0.0
    assert progress(ahead, np.array([0.6, -1.0, 0.4])) == pytest.approx(0.5), "what is stepped aside and turned counts for nothing"
    assert progress(np.array([0.0, 1.0, 0.0]), np.zeros(3)) == 1.0, "nobody is kept from turning"


def test_a_plan_waits_for_who_is_kept_from_it(walker):
    state = walker.start()
    for _ in range(90):
        state, _ = walker.step(state, Intent(goal=GOAL), 1 / 60)
    for _ in range(90):  # until he stands
        state, _ = walker.step(state, Intent(goal=GOAL, aside=stopped(state)), 1 / 60)
    time, plans = state.going.time, state.going.plans
    for _ in range(60):
        state, _ = walker.step(state, Intent(goal=GOAL, aside=stopped(state)), 1 / 60)
    assert state.going.time - time < 0.1 and state.going.plans - plans <= 1 and state.going.waits > 0.9
    for _ in range(60 * 10):
        state, _ = walker.step(state, Intent(goal=GOAL), 1 / 60)
    assert walker.status(state).kind == "done" and np.hypot(*(state.ground[:2] - GOAL.floor)) < 0.03


def test_who_is_led_off_his_plan_makes_another(walker):
    state = walker.start()
    for tick in range(60 * 12):
        aside = np.array([0.0, 0.0, 1.0]) if 60 < tick < 130 else None
        state, _ = walker.step(state, Intent(goal=GOAL, aside=aside), 1 / 60)
        if tick == 130:
            assert state.ground[0] > 0.2, "he is beside his way"
    assert state.going.plans > 1 and state.going.held == 0
    assert walker.status(state).kind == "done" and np.hypot(*(state.ground[:2] - GOAL.floor)) < 0.03


def test_who_is_never_let_through_says_so(walker):
    state = walker.start()
    for _ in range(round(30 * (PATIENCE + 2.0))):
        state, _ = walker.step(state, Intent(goal=GOAL, aside=stopped(state)), 1 / 30)
        if walker.status(state).kind == "failed":
            break
    assert "others have been in the way" in walker.status(state).reason and "before the goal" in walker.status(state).reason
