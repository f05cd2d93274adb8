"""Scripted feet: who walks at something solid as he was told stops before it or goes along it, and run-ups are left alone."""

import numpy as np
import pytest

from gambol.controllers.contract import Intent, Leap
from gambol.controllers.navigation import gap
from gambol.controllers.person import person
from gambol.game.scenario import film
from gambol.game.scenario.scenario import load
from gambol.game.scene.scene import Box, Pillar
from gambol.game.world.solid import NEAR, stopped
from scenarios import written
from stand_in import Glide

WALL = Box((0.0, 0.4, 2.0), (3.0, 0.8, 1.0))
RUN = """
title = "Solid"
under = "a platform"
duration = 7
props = [{ centre = [0, %g, 2.5], size = [1.6, %g, 1.6] }]
[[shots]]
kind = "follow"
[[actors]]
name = "A"
moves = [%s]
"""


def standing(z, heading=0.0):
    return Glide().start((0.0, z, heading))


def test_far_away_and_away_from_it_nothing_changes():
    for state, forward in ((standing(-3.0), 1.4), (standing(1.2), -1.0), (standing(1.2, np.pi), 1.4)):
        intent = Intent(np.array([forward, 0.2, 0.0]))
        assert stopped(state, intent, (WALL,)) is intent


def test_the_nearer_the_slower_and_not_at_all_beside_it():
    paces = [stopped(standing(z), Intent(np.array([1.4, 0.0, 0.0])), (WALL,)).velocity[0] for z in (0.8, 1.0, 1.2, 1.5 - NEAR)]
    assert paces == sorted(paces, reverse=True) and paces[0] > 0.9 and paces[-1] == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("heading", [-0.9, 0.4, 0.9])
def test_what_goes_along_it_goes_on(heading):
    intent = Intent(np.array([1.0, 0.0, 0.0]))
    velocity = stopped(standing(1.5 - NEAR, heading), intent, (WALL,)).velocity
    along = velocity[0] * np.sin(heading) + velocity[2] * np.cos(heading)
    into = velocity[0] * np.cos(heading) - velocity[2] * np.sin(heading)
    assert along == pytest.approx(np.sin(heading)) and into == pytest.approx(0.0, abs=1e-6)


def test_steps_what_hangs_and_pillars():
    walk = Intent(np.array([1.4, 0.0, 0.0]))
    step, roof = Box((0.0, 0.1, 2.0), (3.0, 0.2, 1.0)), Box((0.0, 2.2, 2.0), (3.0, 0.2, 1.0))
    assert stopped(standing(1.4), walk, (step, roof)) is walk
    assert stopped(standing(1.4), walk, (Pillar((0.0, 0.0, 1.9), 0.2, 2.0),)).velocity[0] < 0.4


def test_stairs_are_walked_up():
    walk = Intent(np.array([1.4, 0.0, 0.0]))
    stairs = tuple(Box((0.0, 0.1 * (k + 1), 2.0 + 0.3 * k), (2.0, 0.2 * (k + 1), 0.3)) for k in range(4))
    assert stopped(standing(1.7), walk, stairs) is walk
    assert stopped(standing(2.4), walk, stairs[3:]) is not walk


def test_a_landing_as_high_as_the_last_tread_is_no_wall():
    """It took away the speed of who ran up to it, from three metres off."""
    stairs = tuple(Box((0.0, 0.085 * (k + 1), 1.0 + 0.29 * (k + 0.5)), (2.4, 0.17 * (k + 1), 0.29)) for k in range(14))
    landing = Box((0.0, 1.19, 1.0 + 0.29 * 14 + 1.5), (2.4, 2.38, 3.0))
    run = Intent(np.array([3.0, 0.0, 0.0]))
    assert stopped(standing(0.0), run, (*stairs, landing)) is run
    assert stopped(standing(4.0), run, (landing,)) is not run


def test_a_roof_that_ends_with_a_wall_hides_it_from_nobody():
    roof = Box((0.0, 2.35, 1.0), (3.0, 0.1, 3.0))
    assert stopped(standing(1.0), Intent(np.array([3.0, 0.0, 0.0])), (Box((0.0, 1.2, 2.0), (3.0, 2.4, 1.0)), roof)).velocity[0] < 1.0


def test_who_leaps_is_left_alone():
    leap = Intent(np.array([1.4, 0.0, 0.0]), leap=Leap(np.array([0.0, 0.8, 2.0])))
    assert stopped(standing(1.4), leap, (WALL,)) is leap


@pytest.mark.few(1)
@pytest.mark.parametrize("moves, gets, high, floor", [
    ("{ walk_to = [0.2, 6], for = 6 }", (0.0, 1.7), 0.6, 0.0),
    ("{ walk_to = [0, 2.5], jump_to = [0, 2.0], speed = 1.4, for = 5 }, { for = 1, stop = true }", (1.7, 2.9), 0.4, 0.4),
])
def test_nobody_walks_through_a_platform_and_a_run_up_still_leads_onto_it(tmp_path, moves, gets, high, floor):
    scenario = load(written(tmp_path, RUN % (0.5 * high, high, moves)))
    who, props, deepest = person(), scenario.stage(), np.inf
    for _, act in zip(range(60 * 6), film.acts(scenario, who)):
        state = act.world.characters[0].state
        deepest = min(deepest, float(gap(np.asarray(state.pose.root, float)[None], props[0]).min()))
    assert deepest > 0.05 and gets[0] < state.ground[1] < gets[1] and state.floor == pytest.approx(floor), (deepest, state.ground, state.floor)
