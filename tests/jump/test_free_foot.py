"""The foot of who leaps or lands off the other one keeps out of the floor, however deep the body goes."""

import numpy as np
import pytest

from gambol.controllers.body import forward_kinematics, sole_corners
from gambol.controllers.contract import Intent, Leap
from gambol.controllers.jump import Jumping
from gambol.controllers.jump.body import Physique
from gambol.controllers.jump.controller import Jump

FPS = 60
ROOM = 0.008
"""So deep [m] soles may be in the floor: as deep as a walker's toe is as it leaves it."""


def lowest(skeleton, made, times):
    """How high [m] the lowest of each foot is at these times of a plan (N, 2)."""
    poses = [made.at(time) for time in times]
    placed = forward_kinematics(skeleton, np.stack([p.root for p in poses]), np.stack([p.rotations for p in poses]))
    return sole_corners(skeleton, *placed).reshape(len(times), 2, -1, 3)[..., 1].min(-1)


@pytest.fixture(scope="module", params=[0.2, 0.6, 1.0])
def aside(request, person):
    """The plan of a walker who leaps so far off his way [rad] that he waits for his weight to come over his foot, ever deeper."""
    wish, state = np.array([1.33, 0.0, 0.0]), person.start()
    for k in range(240):
        x, z, heading = state.ground
        way = heading + request.param
        leap = Leap(np.array([x + 1.38 * np.sin(way), 0.0, z + 1.38 * np.cos(way)])) if k > 120 else None
        state, _ = person.step(state, Intent(wish, leap), 1 / FPS)
        if isinstance(state.memory.memory, Jumping):
            return state.memory.memory.plan
    raise AssertionError(state.memory.refused)


def test_a_walkers_swinging_foot_stays_over_the_floor_as_he_goes_down_to_leap(aside, jump):
    assert aside.path.single, "off one foot"
    low = lowest(jump.skeleton, aside, np.arange(0.0, aside.take_off, 1 / 120))
    assert low.min() > -ROOM


def test_who_leaps_aside_lands_on_both_feet(aside):
    """No gait goes on aside at 1.6 m/s: hips that came down on one foot slowed by 1.3 m/s in one step."""
    way, _, ahead = aside.path.velocity
    assert (aside.path.lands is None) == (abs(way) > 0.45 * ahead or ahead < 0.5), "all of them walk along z"


@pytest.mark.parametrize("gravity, up, far", [(9.81, 0.0, 1.4), (9.81, 0.44, 1.5), (9.81, 0.35, 2.2), (9.81, -0.2, 2.0), (3.71, 0.35, 2.2), (3.71, 0.0, 3.0)])
def test_the_foot_that_swings_on_passes_over_the_floor_as_the_other_lands(running, gravity, up, far):
    jump = Jump(Physique(strength=1.2), gravity=(0.0, -gravity, 0.0))
    x, z = running.ground[:2]
    made = jump.plan(running, Intent(leap=Leap(np.array([x, up, z + far]))))
    times = np.arange(made.touch_down, made.through, 1 / 120)
    assert (lowest(jump.skeleton, made, times) - up).min() > -0.005
