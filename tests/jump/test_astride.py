"""Who stands astride an edge crouches and leaps over feet on floors of their own, and knees go on as they were turned."""

from functools import cache

import numpy as np
import pytest

from gambol.controllers.body import contact_points, forward_kinematics
from gambol.controllers.contract import Intent, Leap
from gambol.controllers.jump import Crouching
from gambol.controllers.navigation import gap
from gambol.controllers.struck import flesh
from gambol.game.scene import Box

DT = 1 / 60
STEP = 0.18
THINGS = (Box((0.0, 0.5 * STEP, 2.0), (4.0, STEP, 2.0)),)
HEADINGS = {"its left foot up": 1.65, "its right foot up": -1.77}


def played(person, state, intents):
    states = [state]
    for intent in intents:
        states.append(person.step(states[-1], intent, DT)[0])
    return states


@pytest.fixture(scope="module")
def stands(person):
    """A character that walked along an edge and stands with one foot on either side, in one of two headings."""
    @cache
    def of(name):
        heading = HEADINGS[name]
        begins = (-1.2 * np.sin(heading), 1.0 - 1.2 * np.cos(heading), heading)
        walks = [Intent(np.array([1.0, 0.0, 0.0]), around=THINGS)] * 75 + [Intent(around=THINGS)] * 150
        return played(person, person.start(begins), walks)[-1]
    return of


def placed(skeleton, states):
    return forward_kinematics(skeleton, np.stack([s.pose.root for s in states]).astype(float), np.stack([s.pose.rotations for s in states]).astype(float))


def feet(skeleton, states):
    return contact_points(skeleton, *placed(skeleton, states))


def deepest(jump, states):
    points, thick = flesh(jump.physique, *placed(jump.skeleton, states))
    away = np.minimum(points[..., 1], np.reshape(gap(points.reshape(-1, 3), THINGS[0]), points.shape[:-1]))
    return float((thick - away).max())


@pytest.mark.few(1)
@pytest.mark.parametrize("name", HEADINGS)
def test_it_crouches_and_stands_up_over_feet_that_stay(person, jump, stands, name):
    state = stands(name)
    heights = feet(jump.skeleton, [state])[0, :, 1].reshape(2, 2).mean(1)
    assert abs(heights[0] - heights[1]) > 0.9 * STEP, "it stands astride the edge"
    states = played(person, state, [Intent(aim=Leap(None), around=THINGS)] * 60 + [Intent(around=THINGS)] * 90)
    assert isinstance(states[50].memory.memory, Crouching) and states[-1].active == "locomotion"
    assert states[0].pose.root[1] - states[60].pose.root[1] > 0.08
    moved = feet(jump.skeleton, states) - feet(jump.skeleton, [state])
    assert np.abs(moved[:, 1::2]).max() < 0.005 and np.abs(moved).max() < 0.05, "balls stay; a heel rises where its ankle bends no farther"
    assert deepest(jump, states) < 0.01
    pulls = np.diff(placed(jump.skeleton, states[:70])[0], 2, axis=0) / DT**2
    assert np.linalg.norm(pulls, axis=-1).max() < 40.0, "knees go on as they were turned"


@pytest.mark.few(3)
@pytest.mark.parametrize(("name", "place"), [("its left foot up", (1.1, 0.0, 0.7)), ("its left foot up", (0.3, STEP, 1.6)), ("its right foot up", (-1.1, 0.0, 0.7)),
                                              ("its right foot up", (-0.43, STEP, 1.27))])
@pytest.mark.parametrize("aims", [0, 50])
def test_it_leaps_off_both_floors(person, jump, stands, name, place, aims):
    """At once or out of the crouch, to the floor and onto the box; soles that stand stay until it leaves."""
    state, place = stands(name), np.array(place)
    states = played(person, state, [Intent(aim=Leap(place), around=THINGS)] * aims + [Intent(leap=Leap(place), around=THINGS)] * 20 + [Intent(around=THINGS)] * 130)
    made = next(s.memory.memory.plan for s in states if s.active == "jump" and not isinstance(s.memory.memory, Crouching))
    balls = contact_points(jump.skeleton, *forward_kinematics(jump.skeleton, made.roots, made.local))[:, 1::2]
    pushing = made.times <= made.take_off
    assert np.abs(balls[pushing] - balls[0]).max() < 0.01
    landed = feet(jump.skeleton, states[-1:])[0, :, 1]
    np.testing.assert_allclose(landed, place[1] + jump.physique.tables.sole, atol=0.01)
    assert np.linalg.norm(made.feet[:, :3].mean(0) - place) < 0.15
    assert deepest(jump, states) < 0.02


def test_the_floor_is_that_of_the_lower_foot(person, jump, stands):
    for name in HEADINGS:
        state = person.active(stands(name))[1]
        start, floor = jump.placed(state, None, THINGS)
        assert floor == pytest.approx(0.0, abs=1e-3) and sorted(start.levels) == pytest.approx([0.0, STEP], abs=1e-3)
        np.testing.assert_allclose(start.planted(floor, jump.physique.tables)[:, 1], start.feet[:, 1], atol=1e-5)
