"""Through narrow passages people turn aside: no gap is passed that has no room, wide ones are walked straight, and in between they are side-stepped through."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gambol.controllers.contract import Goal, Intent
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.navigation.obstacles import DEPTH, SHOULDER
from gambol.controllers.navigation.planning import goal_planner, plan
from gambol.controllers.navigation.planning.goal_planner import MARGIN
from gambol.controllers.navigation.planning.limits import keep_clear, reach
from gambol.controllers.navigation.planning.room import narrow, room_on
from gambol.controllers.navigation.routes import shapes_of
from gambol.controllers.supervisor import Supervisor
from gambol.game.scene import Box, Pillar
from test_plans import LIMITS

GIRTH = np.array([SHOULDER, *DEPTH])


def gap(wide):
    """A wall with a gap, whose other ends are walls, too: no way leads round it."""
    across = [Box((side * (wide / 2 + 2.0), 0.9, 2.0), (4.0, 1.8, 0.15)) for side in (1, -1)]
    return (*across, *(Box((side * 4.0, 0.9, 2.0), (0.1, 1.8, 9.0)) for side in (1, -1)),
            *(Box((0.0, 0.9, z), (8.0, 1.8, 0.1)) for z in (-2.5, 6.5)))


@given(st.floats(-4, 4), st.floats(-4, 4))
def test_a_body_is_as_wide_as_its_arms_and_as_deep_as_its_trunk(bearing, heading):
    n, by, other = (np.sin(bearing), np.cos(bearing)), np.empty(2), np.empty(2)
    there = reach(*n, heading, GIRTH, by)
    assert min(DEPTH) - 1e-12 <= there <= SHOULDER + 1e-12
    step = 1e-6
    after, before = (reach(*n, heading + d, GIRTH, other) for d in (step, -step))
    assert by[0] == pytest.approx((after - before) / (2 * step), abs=1e-6)
    reach(*n, heading + step, GIRTH, other)
    bend = other[0]
    reach(*n, heading - step, GIRTH, other)
    assert by[1] == pytest.approx((bend - other[0]) / (2 * step), abs=1e-4)


def test_who_is_turned_reaches_less_ahead_and_back_than_aside():
    by = np.empty(2)
    assert reach(1.0, 0.0, 0.0, GIRTH, by) == pytest.approx(SHOULDER), "beside him"
    assert reach(0.0, -1.0, 0.0, GIRTH, by) == pytest.approx(DEPTH[0]), "what he faces lies where its distance falls"
    assert reach(0.0, 1.0, 0.0, GIRTH, by) == pytest.approx(DEPTH[1])


def test_the_derivatives_of_the_clearance_are_its_derivatives():
    rng, shapes = np.random.default_rng(1), shapes_of([Pillar((0.2, 0, 0.1), 0.3, 1.0), Box((1.0, 0.5, 0.4), (0.6, 1.0, 0.2), 0.4)])
    girth, multipliers = np.array([0.9, 0.75, 0.6]), np.array([2.0, 3.0])

    def at(y):
        g, h = np.zeros(9), np.zeros((9, 9))
        return keep_clear(y, shapes, girth, multipliers, 30.0, 1.0, g, h)[0], g, h
    for _ in range(30):
        y = np.append(rng.uniform(-1.2, 1.2, 2), rng.uniform(-4, 4, 7))
        if np.abs(np.hypot(*(y[:2] - [0.2, 0.1])) - 0.3) < 0.05:
            continue
        _, g, h = at(y)
        ups, downs = ([at(y + sign * 1e-6 * e)for e in np.eye(9)[:3]] for sign in (1, -1))
        slopes = [(up[0] - down[0]) / 2e-6 for up, down in zip(ups, downs)]
        bends = np.array([(up[1] - down[1]) / 2e-6 for up, down in zip(ups, downs)])[:, :3]
        if np.abs(h).max() < 1e4:  # at a corner itself the slope jumps
            assert np.allclose(slopes, g[:3], atol=1e-3) and np.allclose(bends, h[:3, :3], atol=0.05)


@pytest.mark.parametrize("wide", [sum(DEPTH) - 0.01, 0.3])
def test_no_gap_is_passed_that_is_narrower_than_he_is_deep(wide):
    made = plan((0.2, 0.2, 0.0), (-0.3, 4.0, 0.0), limits=LIMITS, around=gap(wide))
    assert "no way leads there that is 0.45 m wide" in made.reason


@pytest.mark.parametrize("wide", [2 * (SHOULDER + MARGIN) + 0.01, 0.8])
def test_a_gap_as_wide_as_his_arms_is_walked_straight(wide):
    made = plan((0.0, 0.2, 0.0), (0.0, 4.0, 0.0), limits=LIMITS, around=gap(wide))
    assert made.reason == "" and np.abs(made.sampled()[1][:, 2]).max() < 0.2


@pytest.mark.parametrize("wide", [0.52, 0.56, 0.6])
@pytest.mark.parametrize("start", [(0.0, 0.2, 0.0), (-0.8, 0.4, 0.3)])
def test_a_gap_in_between_is_passed_turned_aside(wide, start):
    around = gap(wide)
    made = plan(start, (0.3, 3.8, 0.0), limits=LIMITS, around=around)
    assert made.reason == "" and room_on(made.coefficients, shapes_of(around), GIRTH) >= 0.0
    ground = made.sampled(400)[1]
    within = np.abs(ground[:, 1] - 2.0) < 0.075
    assert np.abs(np.sin(ground[within, 2])).min() > 0.7, "turned aside in it"
    away = np.abs(ground[:, 1] - 2.0) > 1.0
    assert np.abs(np.sin(ground[away, 2])).min() < 0.6, "and not before and after it"


def test_only_what_is_narrow_on_both_sides_is_narrow():
    shapes = shapes_of(gap(0.5))
    assert narrow(np.array([[0.0, 2.0], [0.0, 1.0], [1.0, 1.75]]), shapes, SHOULDER).tolist() == [True, False, False]


def test_he_side_steps_through_and_planned_anew_in_the_gap_goes_on_so():
    walker, around = Supervisor({"locomotion": Locomotion.load()}), gap(0.56)
    state, passed, replanned = walker.start((0.0, 0.6, 0.0)), [], False
    for _ in range(60 * 12):
        goal = Goal((0.2, 3.6), 0.0) if replanned else Goal((0.0, 3.6), 0.0)
        state, _ = walker.step(state, Intent(goal=goal, around=around), 1 / 60)
        if abs(state.ground[1] - 2.0) < 0.075:
            passed.append(state.ground)
            replanned = True  # the goal moves while he is in it
        if walker.status(state).kind != "running":
            break
    assert walker.status(state).kind == "done" and np.hypot(*(state.ground[:2] - [0.2, 3.6])) < 0.03
    headings, aside = np.array(passed)[:, 2], np.abs(np.array(passed)[:, 0])
    assert np.abs(np.sin(headings)).min() > 0.7 and aside.max() < 0.05


@pytest.mark.few(1)
@pytest.mark.parametrize("wide", [0.485, 0.49, 0.5])
def test_a_gap_of_less_than_half_a_metre_is_passed_by_who_comes_aslant(wide):
    """Rather than going round a wall of 24 m."""
    wall = [Box((side * (wide / 2 + 6.0), 0.6, 2.0), (12.0, 1.2, 0.15)) for side in (1, -1)]
    made = plan((-2.0, 1.0, 1.5), (1.5, 3.0, 0.0), limits=Locomotion.load().limits(0.9), around=wall)
    assert made.reason == "" and np.abs(made.sampled()[1][:, 0]).max() < 3.0


def test_no_plan_takes_more_work_than_it_is_given(monkeypatch):
    """Newton's steps times intervals: so much for the ways that he walks straight, and as much for those on which he turns aside."""
    spent, search = [], goal_planner.search

    def counted(splines, *rest):
        search(splines, *rest)
        spent.append((splines.shape[1] - 3) * int(np.abs(rest[-1]).sum()))
    monkeypatch.setattr(goal_planner, "search", counted)
    wall = [Box((side * 2.3, 0.6, 2.0), (4.0, 1.2, 0.15)) for side in (1, -1)]
    plan((0.0, 0.0, 1.5), (0.0, 4.0, 0.0), limits=LIMITS, around=wall)
    whole = sum(spent)
    for work in (600, 1500, 2500):
        spent.clear()
        monkeypatch.setattr(goal_planner, "WORK", work)
        monkeypatch.setattr(goal_planner, "MENDS", work // 5)
        made = plan((0.0, 0.0, 1.5), (0.0, 4.0, 0.0), limits=LIMITS, around=wall)
        assert sum(spent) <= (6 if made.reason else 2) * work, (work, spent)
    assert whole > 2 * 600, "or nothing is cut here"
