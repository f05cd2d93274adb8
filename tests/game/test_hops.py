"""Hops in scenarios: each goes off from the landing of the one before, and as far."""

import numpy as np
import pytest

from gambol.controllers.body.support_polygon import sole_corners
from gambol.controllers.body import forward_kinematics
from gambol.controllers.person import person
from gambol.game.input.making import jumping
from gambol.game.scenario import film
from gambol.game.scenario.scenario import load
from scenarios import written

TEXT = """
title = "Hops"
duration = 4.6
[[actors]]
name = "A"
start = [0.5, 0.2, 40]
moves = [{ for = 0.2, stop = true }, { hops = 2, airtime = 0.4 }, { hops = 3, ahead = 0.4, airtime = 0.3 }]
"""


@pytest.fixture(scope="module")
def hopped(tmp_path_factory):
    plans, refused = [], ()
    for frame in film.run(load(written(tmp_path_factory.mktemp("hops"), TEXT)), person()):
        someone = frame.after.characters[0]
        now, refused = jumping(someone.state), frame.refused
        if now is not None and all(now.plan is not plan for plan in plans):
            plans.append(now.plan)
    return plans, someone.controller.skeleton, refused


def test_hops_are_as_many_and_as_far_as_the_script_says_and_straight_ahead(hopped):
    plans, skeleton, refused = hopped
    assert len(plans) == 5 and not refused
    soles = np.array([sole_corners(skeleton, *forward_kinematics(skeleton, *_pose(plan)))[[0, 1, 4, 5, 6, 7, 10, 11]].mean(0)[[0, 2]] for plan in plans])
    ahead = np.array([np.sin(np.radians(40.0)), np.cos(np.radians(40.0))])
    gone = np.diff(soles, axis=0)
    assert np.abs(gone @ ahead - [0.0, 0.4, 0.4, 0.4]).max() < 0.02
    assert np.abs(gone @ [ahead[1], -ahead[0]]).max() < 0.02


def test_each_goes_off_from_the_landing_before_after_half_a_second_at_most(hopped):
    plans, _, _ = hopped
    for plan in plans[1:]:
        assert plan.take_off < 0.46 and plan.path.airtime == pytest.approx(0.4 if plan is plans[1] else 0.3)


def _pose(plan):
    pose = plan.at(plan.lowest)
    return pose.root, pose.rotations


@pytest.mark.few(1)
@pytest.mark.parametrize("on, lands, airtimes", [("left", [0, 0, None], [0.26] * 3), ("alternate", [0, 1, None], [0.26] * 3), ("skip", [0, 0, 1, None], [0.12, 0.26, 0.12, 0.26])])
def test_hops_are_on_the_feet_that_the_script_says(tmp_path, on, lands, airtimes):
    text = TEXT.replace("{ hops = 2, airtime = 0.4 }, { hops = 3, ahead = 0.4, airtime = 0.3 }", f'{{ hops = {len(lands)}, on = "{on}", ahead = 0.4, airtime = 0.26 }}')
    plans, refused = [], ()
    for frame in film.run(load(written(tmp_path, text)), person()):
        now, refused = jumping(frame.after.characters[0].state), frame.refused
        if now is not None and all(now.plan is not plan for plan in plans):
            plans.append(now.plan)
    assert not refused and [plan.path.lands for plan in plans] == lands
    assert [plan.path.airtime for plan in plans] == pytest.approx(airtimes)
