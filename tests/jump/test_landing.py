"""The landing's way down and up, as laws: whatever the fall, the body and the world."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gambol.controllers.contract import Intent, Leap
from gambol.controllers.jump.body import airtime_up
from gambol.controllers.jump.motion.landing import TIME, absorb

SOLES = np.array([[x, 0.0, z] for x in (-0.15, 0.15) for z in (-0.12, 0.15)])
TIMES = np.linspace(0.0, TIME, 2701)


def landed(fall, size, pull, touches):
    stand = 0.975 * size
    goal = np.array([0.0, stand, 0.0])
    return absorb(goal + [0.0, -touches * size, 0.0], np.array([0.0, -fall, 0.0]), goal, SOLES * size, pull)


@given(st.floats(0.0, 6.5), st.floats(0.5, 1.3), st.floats(1.6, 25.0), st.floats(-0.01, 0.3))
def test_the_force_begins_at_nothing_never_pulls_and_goes_on_without_a_step_until_the_body_stands(fall, size, pull, touches):
    way = landed(fall * np.sqrt(size * pull / 9.81), size, pull, touches)
    place, rate, gains = way.motion(TIMES)
    force = gains[:, 1] / pull + 1.0
    assert abs(force[0]) < 1e-9 and force.min() > -1e-9
    down = way.down[0]
    before, after = way.motion(np.array([down - 1e-7, down + 1e-7]))[:2], way.motion(np.array([down + 1e-7]))[2]
    assert np.abs(before[1][:, 1]).max() < 1e-4 and abs(after[0, 1] - way.motion(np.array([down - 1e-7]))[2][0, 1]) < 1e-2 * pull
    assert place[:, 1].min() == pytest.approx(place[0, 1] - way.deep, abs=1e-3)
    assert np.diff(place[:, 1] / size).max() < 0.01


@given(st.floats(1.2, 5.0), st.floats(0.6, 1.3))
def test_a_fall_is_stopped_with_hardly_more_force_than_its_way_needs(fall, size):
    way = landed(fall, size, 9.81, 0.06)
    force = way.motion(TIMES)[2][:, 1] / 9.81 + 1.0
    assert force.max() < 1.3 * (1.0 + fall**2 / (2.0 * 9.81 * way.deep))


def test_a_body_that_falls_so_comes_to_stand(jump, standing):
    made = jump.plan(standing, Intent(leap=Leap(None, airtime_up(jump.physique, 0.3, jump.gravity))))
    force = made.forces[made.times >= made.touch_down, 1] / (9.81 * jump.physique.mass)
    assert force.max() < 3.0 and force[0] < 0.2 and force[-1] == pytest.approx(1.0, abs=0.02)
    assert np.linalg.norm(made.velocities[-1]) < 0.06
