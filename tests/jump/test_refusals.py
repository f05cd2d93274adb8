"""A leap that can not be made is refused without seeking what can not be found."""

from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest

from gambol.controllers.contract import Intent, Leap
from gambol.controllers.jump import Refused
from gambol.controllers.jump.reach import whole
from gambol.game.scene import Box

from conftest import ahead

grounded = import_module("gambol.controllers.jump.motion.grounded")


@pytest.fixture
def courses(monkeypatch):
    """The courses along the floor that were sought so far: how far outside the soles [m] the pressure would lie on each."""
    found, sought = [], grounded._course

    def count(*asked):
        course = sought(*asked)
        found.append(course.outside)
        return course
    monkeypatch.setattr(grounded, "_course", count)
    return found


@pytest.mark.few(2)
@pytest.mark.parametrize(("ahead", "high", "far", "most"), [(0.7, 0.5, 1.6, 100), (0.9, 0.5, 2.0, 130), (0.6, 0.3, 2.4, 90)])
def test_who_stands_before_a_hurdle_is_refused_by_few_courses(jump, standing, courses, ahead, high, far, most):
    place = np.array([standing.ground[0], 0.0, standing.ground[1] + far])
    hurdle = Box((0.0, 0.5 * high, standing.ground[1] + ahead), (2.0, high, 0.2))
    with pytest.raises(Refused):
        jump.plan(standing, Intent(leap=Leap(place), around=(hurdle,)))
    assert len(courses) < most


def test_a_course_that_is_hopeless_is_not_sought_again(jump, running, courses):
    """A runner who would have to stop within a step presses far ahead of his foot, whatever comes of it."""
    start = jump.start_of(running)
    place = jump.middle(start, 0.0)
    grounded.grounded(jump.physique, start, jump.path(start, place, 0.0), 0.0)
    assert len(courses) == 1 and courses[0] > grounded.HOPELESS


@pytest.mark.parametrize("leap", [Leap((0.0, np.nan, 1.0)), Leap((0.0, 1.0)), Leap((0.0, 0.0, 1.0), on="foo"),
                                  Leap((0.0, 0.0, 1.0), heading=np.nan), Leap((0.0, 0.0, 1.0), airtime=np.nan), Leap(None, airtime=99.0)])
def test_what_nobody_can_leap_to_is_told_as_a_step_tells_it(jump, person, standing, leap):
    intent = Intent(leap=leap)
    state, _ = person.step(person.start(), intent, 1 / 60)
    assert state.refused and state.refused == jump.refusal(standing, intent) == person.refusal(person.start(), intent)
    assert jump.found(standing, intent) is None and person.found(person.start(), intent) is None


@pytest.mark.parametrize("place", [(0.0, 1.0), (0.0, np.nan, 1.0), np.zeros((2, 3)), 1.0])
def test_what_is_no_place_can_not_be_surveyed(jump, standing, place):
    start = jump.start_of(standing)
    for ask in (jump.survey, jump.nearest):
        with pytest.raises(ValueError, match="the target must be three finite numbers"):
            ask(start, place, 0.0)
        with pytest.raises(ValueError, match="a floor must be"):
            ask(start, (0.0, 0.0, 1.0), np.nan)
        with pytest.raises(ValueError, match="the airtime must be"):
            ask(start, (0.0, 0.0, 1.0), 0.0, np.nan)
        with pytest.raises(ValueError, match=r"looked for from jump\.start_of\(state\); got a CharacterState"):
            ask(standing, (0.0, 0.0, 1.0), 0.0)
    assert jump.survey(start, [0.0, 0.0, 1.0], 0)[1] == "", "a list is a place, too"


@pytest.mark.parametrize("speed", [1.2, 3.0])
def test_who_walks_or_runs_is_not_told_that_he_is_weak(locomotion, jump, speed):
    """In the midst of a stride no foot may be under him, and he is told that; his muscles are as strong as ever."""
    state, wish, told = locomotion.start(), Intent(np.array([speed, 0.0, 0.0])), []
    for k in range(180):
        before = state
        state, _ = locomotion.step(state, wish, 1 / 60)
        if k > 130 and k % 8 == 0:
            moving = replace(state, previous=before.pose, elapsed=1 / 60)
            there = jump.middle(jump.start_of(moving), 0.0)
            for airtime in (None, 0.55):
                told.append(jump.refusal(moving, Intent(leap=Leap(there + [0.0, 0.0, 1.4], airtime))))
    assert any("no foot is under it" in why for why in told)
    assert not any("weak" in why for why in told), told


@pytest.mark.few(1)
@pytest.mark.parametrize("speed", [0.8, 1.3, 3.0])
def test_the_nearest_place_to_one_that_can_be_leapt_to_is_that_one(locomotion, jump, speed):
    """And who walks is told of one where the place itself is too far, though he can't leap where he stands."""
    state, wish, reached, offered = locomotion.start(), Intent(np.array([speed, 0.0, 0.0])), [], []
    for k in range(100):
        before = state
        state, _ = locomotion.step(state, wish, 1 / 60)
        if k > 60 and k % 16 == 0:
            moving = replace(state, previous=before.pose, elapsed=1 / 60)
            start = jump.start_of(moving)
            for far in (0.3, 0.6, 1.0, 1.5):
                place = np.array([state.ground[0], 0.0, state.ground[1] + far])
                nearest, refused = jump.nearest(start, place, 0.0), jump.refusal(moving, Intent(leap=Leap(place)))
                if not refused:
                    assert nearest is not None and np.array_equal(nearest, place)
                reached.append(not refused)
                offered.append(bool(refused) and nearest is not None and jump.attempt(start, nearest, 0.0, None, ())[0] is not None)
    assert any(reached)
    if speed < 1.0:
        assert sum(offered) >= sum(not one for one in reached) - 2


def test_who_is_held_down_by_a_wall_is_not_told_that_his_body_can_not(jump, standing):
    wall = Box((standing.ground[0], 1.2, standing.ground[1] + 0.57), (6.0, 2.4, 0.3))
    leap = Leap(None, airtime=0.52)
    assert jump.plan(standing, Intent(leap=leap)).path.airtime == pytest.approx(0.52, abs=0.01)
    with pytest.raises(Refused, match=r"would hit something.*could be made in 0\.\d\d s"):
        jump.plan(standing, Intent(leap=leap, around=(wall,)))


def test_what_legs_fall_far_short_of_is_not_looked_at_on_the_ground(jump, standing, running, courses):
    """An estimated path tells as much; what they nearly give is looked at."""
    for state, far in ((standing, 4.5), (running, 40.0)):
        why = jump.refusal(state, Intent(leap=Leap(ahead(state, far))))
        assert why and not courses
    assert jump.refusal(running, Intent(leap=Leap(ahead(running, 2.0)))) == "" and courses


def test_who_runs_on_is_told_no_place_by_his_foot_of_now(jump, running):
    """He is elsewhere when it is known; who asks for a whole plan is told."""
    intent = Intent(leap=Leap(ahead(running, 40.0)))
    with pytest.raises(Refused) as told:
        jump.seek(running, intent)
    assert told.value.onward is None and told.value.nearest is None
    with pytest.raises(Refused) as told:
        jump.plan(running, intent)
    assert told.value.nearest is not None


def test_no_place_is_sought_farther_away_than_it_is_of_use(jump, running, courses):
    start, floor = jump.placed(running)
    place = jump.middle(start, floor) + 30.0 * np.array([np.sin(running.ground[2]), 0.0, np.cos(running.ground[2])])
    assert whole(jump.nearby(start, place, floor, None, (), 0.3)) == (None, None)
    few = len(courses)
    nearest, found = whole(jump.nearby(start, place, floor, None, ()))
    assert nearest is not None and found is not None and len(courses) > 2 * few
    near = nearest + 0.2 * (place - nearest) / np.linalg.norm(place - nearest)
    again, _ = whole(jump.nearby(start, near, floor, None, (), 0.3))
    assert again is not None and np.linalg.norm(again - near) <= 0.3
