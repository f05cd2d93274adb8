"""What is foretold of a character is what it does, for one and for a batch."""

import numpy as np
import pytest

from gambol.controllers.body import contact_points, forward_kinematics
from gambol.controllers.contract import Intent
from gambol.controllers.person import forecast
from gambol.controllers.locomotion import Locomotion


@pytest.fixture(scope="module")
def walker():
    return Locomotion.load()


def after(walker, state, wish, seconds):
    for _ in range(round(60 * seconds)):
        state, _ = walker.step(state, Intent(np.array(wish)), 1 / 60)
    return state


def footprints(walker, state, wish, seconds):
    """By foot, when it first comes down and where its ball is in the middle of that stance, in steps of 1/60 s."""
    balls, stands = [], []
    for _ in range(round(60 * seconds)):
        state, pose = walker.step(state, Intent(np.array(wish)), 1 / 60)
        points = contact_points(walker.skeleton, *forward_kinematics(walker.skeleton, pose.root, pose.rotations))
        balls.append(points[[1, 3]])
        stands.append(state.contacts.reshape(2, 2).any(-1))
    balls, stands = np.array(balls), np.array(stands)
    for foot in range(2):
        down = np.flatnonzero(stands[1:, foot] & ~stands[:-1, foot]) + 1
        up = np.flatnonzero(~stands[:, foot])
        until = np.append(up[up > down[0]], len(stands))[0]
        yield (down[0] + 1) / 60, balls[(down[0] + until - 1) // 2, foot]


@pytest.mark.few(2)
@pytest.mark.parametrize("wish", [(1.3, 0.0, 0.0), (0.8, 0.9, 0.0), (3.0, 0.0, 0.0), (0.0, 0.0, 0.4), (-0.5, 0.0, 0.0)])
def test_feet_come_down_where_it_is_foretold(walker, wish):
    state = after(walker, walker.start((0.4, -0.2, 0.7)), (1.0, 0.3, 0.0), 2.35)
    told = forecast(walker, state, Intent(np.array(wish)), 1.4)
    coarse = forecast(walker, state, Intent(np.array(wish)), 1.4, 1 / 30)
    for foot, (when, ball) in enumerate(footprints(walker, state, wish, 1.4)):
        assert told.when[foot] == pytest.approx(when)
        assert np.allclose(told.foothold[foot, :3], ball, atol=1e-5)
        assert abs(coarse.when[foot] - when) <= 0.05
        assert np.linalg.norm(coarse.foothold[foot, :3] - ball) < 0.08
    later = after(walker, state, wish, 1.4)
    assert np.linalg.norm(told.ground[-1, :2] - later.ground[:2]) < 1e-9


def test_who_stands_has_no_foothold_to_come(walker):
    told = forecast(walker, walker.start(), Intent(np.zeros(3)), 0.5)
    assert np.isnan(told.when).all() and np.isnan(told.foothold).all()
    assert np.allclose(told.ground, 0.0) and len(told.times) == 30 and told.times[-1] == pytest.approx(0.5)


def test_a_crowd_is_foretold_as_each_of_it(walker):
    places = np.array([[0.0, 0.0, 0.0], [2.0, 1.0, 1.0], [-1.0, 3.0, -2.0]])
    wishes = np.array([[1.2, 0.0, 0.0], [0.0, 0.8, 0.0], [0.0, 0.0, 0.0]])
    told = forecast(walker, walker.start(places), Intent(wishes), 1.2)
    assert told.ground.shape == (3, 72, 3) and told.when.shape == (3, 2) and told.foothold.shape == (3, 2, 4)
    for n in range(3):
        alone = forecast(walker, walker.start(places[n]), Intent(wishes[n]), 1.2)
        for one, many in zip(alone[1:], told[1:]):
            assert np.allclose(one, many[n], equal_nan=True)


def test_a_forecast_has_a_step(walker):
    with pytest.raises(ValueError, match="has no step"):
        forecast(walker, walker.start(), Intent(), 0.0)
