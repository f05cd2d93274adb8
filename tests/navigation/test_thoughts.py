"""What is thought of beside the steps is used at the same step on every machine, and nothing is planned within a step."""

import itertools
import threading

import numpy as np
import pytest

from gambol.controllers.contract import Goal, Intent, Leap
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.navigation.levels import Crossing, next_leg, run_up
from gambol.controllers.navigation.planning import Plan, goal_planner
from gambol.controllers.navigation.thinking import Going, Thought, poised, steps_of
from gambol.controllers.person import person
from gambol.controllers.supervisor import Supervisor
from gambol.game.scene import Box

DT = 1 / 60
GAP = (Box((0.0, 0.3, 0.0), (2.0, 0.6, 5.0)), Box((0.0, 0.3, 5.9), (2.0, 0.6, 5.0)))


def test_when_a_thought_is_used_is_told_by_what_it_asked():
    assert steps_of(0, DT) == 6 and steps_of(4, DT) == 18 and steps_of(0, 0.1) == 1
    thought = Thought(lambda ask: [ask() for _ in range(4)], DT)
    assert [steps for steps in range(40) if thought.after(steps) is not None][0] == 18
    assert thought.after(17) is None, "whoever goes back finds it as it was"


@pytest.mark.parametrize("questions, due", [(0, 1), (3, 4), (30, 6)])
def test_who_hurries_waits_for_one_question_a_step_and_soon_for_all(questions, due):
    thought = Thought(lambda ask: [ask() for _ in range(questions)], DT)
    assert [steps for steps in range(40) if thought.after(steps, hurried=True) is not None][0] == due


def test_no_step_of_who_hurries_waits_for_the_next_question():
    """The second of three takes until it is let: what a step waits for is the first."""
    begun, let = threading.Event(), threading.Event()

    def act(ask):
        ask()
        ask()
        begun.set()
        let.wait()
        ask()
        return "there"
    thought = Thought(act, DT)
    begun.wait(5.0)
    assert [thought.after(step, hurried=True) for step in range(3)] == [None] * 3
    threading.Timer(0.05, let.set).start()
    assert [thought.after(step, hurried=True) for step in (3, 4)] == [None, "there"]


def test_a_thought_that_takes_its_time_is_waited_for():
    let = threading.Event()

    def act(ask):
        ask()
        let.wait()
        return "there"
    thought = Thought(act, DT)
    assert thought.after(5) is None
    threading.Timer(0.05, let.set).start()
    assert thought.after(9) == "there"


def test_what_was_forgotten_is_thought_anew_where_it_is_asked_for():
    begun, let = threading.Event(), threading.Event()

    def act(ask):
        begun.set()
        let.wait()
        ask()
        return "there"
    thought = Thought(act, DT)
    begun.wait(5.0)
    thought.forget()
    let.set()
    assert thought.after(9) == "there" and thought.after(8) is None


def test_what_thinking_raises_is_told():
    def act(ask):
        raise ValueError("no way")
    with pytest.raises(ValueError, match="no way"):
        Thought(act, DT).after(6)


def test_a_step_plans_nothing(monkeypatch):
    """Ways are planned in another thread, if there is one, or at the step at which they are used."""
    walker, threads, plans = Supervisor({"locomotion": Locomotion.load()}), [], goal_planner.plans
    monkeypatch.setattr(goal_planner, "plans", lambda *a, **k: (threads.append(threading.current_thread()), plans(*a, **k))[1])
    state, goal = walker.start(), Goal((0.5, 2.0), 0.0)
    for step in range(12):
        state, _ = walker.step(state, Intent(goal=goal), DT)
        assert (state.going.planned is None) == (step < 6) and walker.status(state).kind == "running"
        if step == 5:
            state.going.thinking.thought.after(10**6)  # however long the other thread takes
    assert threads and state.going.plans == 1


def test_who_walks_goes_on_as_he_thinks_and_plans_from_where_he_will_be():
    walker = Supervisor({"locomotion": Locomotion.load()})
    state = walker.start()
    for _ in range(90):
        state, _ = walker.step(state, Intent(np.array([1.2, 0.0, 0.0])), DT)
    for _ in range(7):
        before = state
        state, _ = walker.step(state, Intent(goal=Goal((1.0, 5.0))), DT)
        assert state.velocity[0] > 1.1
    assert np.abs(state.going.plan.at(0.0)[0] - before.ground).max() < 1e-9, "where he was foreseen"


def test_a_leap_that_was_thought_of_is_not_planned_again(monkeypatch):
    someone = person()
    jump, state = someone.parts["jump"], someone.start((0.0, -2.0, 0.0), 0.6)
    planned = []
    monkeypatch.setattr(jump, "planned", lambda *a, made=jump.planned: (planned.append(None), made(*a))[1])
    for _ in range(60 * 12):
        count, before = len(planned), state
        if state.going is not None and state.going.thinking is not None:
            state.going.thinking.thought.after(10**6)
            count = len(planned)
        state, _ = someone.step(state, Intent(goal=Goal((0.0, 7.0)), around=GAP), DT)
        if state.active == "jump" and before.active != "jump":
            assert len(planned) == count and planned, "the step at which he leaps finds the plan made"
            return
    pytest.fail("he never leapt")


def test_a_leap_that_takes_long_to_look_into_counts_more_and_as_much_when_it_is_known():
    """All of them counted for one, so that a step waited for what a dozen plans take."""
    someone = person()
    wall = (Box((0.0, 0.6, 0.7), (3.0, 1.2, 0.2)),)
    counts = []
    for around, _ in itertools.product(((), wall), range(2)):
        asked = []
        why = someone.pondered(someone.start(), Intent(leap=Leap((0.0, 0.0, 1.0)), around=around), lambda asked=asked: asked.append(None))
        counts.append(len(asked))
        assert (why == "") == (not around) and why == someone.refusal(someone.start(), Intent(leap=Leap((0.0, 0.0, 1.0)), around=around))
    assert counts[:2] == [0, 0] and counts[2] == counts[3] > 0


def test_who_can_leap_from_a_stand_looks_for_no_run_up(monkeypatch):
    """They were played ahead, for a second, by who stood near a gap and had no need of one."""
    def never(*_):
        raise AssertionError("a run-up is looked for")
    monkeypatch.setattr(run_up, "goes_off", never)
    someone = person()
    near = Box((0.0, 0.3, 3.3), (2.0, 0.6, 2.0)), Box((0.0, 0.3, 0.0), (2.0, 0.6, 3.6))
    leg = next_leg(someone, someone.start((0.0, 1.2, 0.0), 0.6), Goal((0.0, 3.5)), near)
    assert leg.crossings and not leg.back


def test_the_longest_run_up_that_will_do_is_the_only_one_played_ahead(monkeypatch):
    asked = []
    monkeypatch.setattr(run_up, "goes_off", lambda walker, far, up, back: bool(asked.append(back)) or back < 1.7)
    begins = run_up.start_of(None, Crossing(np.array([0.0, 2.14, 0.0]), np.array([0.0, 0.6, 4.2]), 0.6), GAP)
    assert asked == [1.9, 1.6] and begins == pytest.approx([0.0, 0.54])


@pytest.mark.parametrize("why", ["", "too far"])
def test_a_leap_that_is_refused_as_it_is_thought_of_is_not_asked_for(why):
    """It would be looked into in the step in which it was to go off."""
    class Leaper(Locomotion):
        def refusal(self, state, intent):
            return why

    someone = Leaper(Locomotion.load().library)
    state = someone.start()
    now = Going(Goal((0.0, 1.0)), Plan.none(state.ground, state.ground, ""), 0.0, (), (), crossings=(Crossing(np.zeros(3), np.array([0.0, 0.0, 1.0]), 0.0),))
    thought = poised(now, state, Intent(), someone, 1 / 60).thought.after(steps_of(0, 1 / 60))
    assert now.but(**thought).poised == (why == "") and (now.but(**thought).asked > 0.0) == (why != "")
