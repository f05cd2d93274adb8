"""Who walks and leaps to a place does so off the foot that is under him, and keeps his speed."""

import numpy as np
import pytest

from gambol.controllers.contract import Intent, Leap
from gambol.controllers.jump import Jumping
from gambol.game.scene import Box

FPS = 60


def leapt(person, speed, far, around=(), floor=0.0):
    """The plan of one who walks so fast [m/s] and is told a place so far ahead [m], how fast his hips go at the least until he leaves, over 0.1 s, and how far they sink; the last two over
    his speed and in m."""
    wish, state, roots = np.array([speed, 0.0, 0.0]), person.start((0.0, 0.0, 0.0), floor), []
    for _ in range(150):
        state, _ = person.step(state, Intent(wish, around=around), 1 / FPS)
    place = np.array([0.0, floor, state.ground[1] + far])
    for _ in range(180):
        before = state.pose.root
        state, _ = person.step(state, Intent(wish, leap=Leap(place), around=around), 1 / FPS)
        if isinstance(state.memory.memory, Jumping):
            break
    assert isinstance(state.memory.memory, Jumping), state.refused
    made = state.memory.memory.plan
    for _ in range(round(made.take_off * FPS)):
        state, pose = person.step(state, Intent(wish, around=around), 1 / FPS)
        roots.append(np.array(pose.root))
    roots = np.array([before, *roots])
    return made, place, float((roots[6:, 2] - roots[:-6, 2]).min()) * FPS / 6 / speed, float(before[1] - roots[:, 1].min())


@pytest.mark.parametrize("speed", [1.15, 1.3, 1.6])
@pytest.mark.parametrize("far", [2.2, 2.4, 2.6])
def test_he_pushes_off_the_foot_under_him_and_is_not_braked(person, speed, far):
    """He pushed off the foot that had just struck 0.4 m ahead, for half a second, sank by 0.2 m and had 45 % of his speed left."""
    made, place, kept, sinks = leapt(person, speed, far)
    assert made.take_off < 0.3 and made.path.lands is not None
    assert kept > 0.6 and sinks < 0.12
    assert 0.8 < np.linalg.norm(made.path.velocity[[0, 2]]) / speed < 1.5
    assert np.linalg.norm(made.feet[made.path.lands, [0, 2]] - place[[0, 2]]) < 0.2


def test_before_a_gap_he_takes_the_last_foot_that_finds_floor(person):
    things = Box((0.0, 0.5, -3.0), (6.0, 1.0, 14.0)), Box((0.0, 0.5, 8.5), (6.0, 1.0, 8.0))
    wish, state = np.array([1.3, 0.0, 0.0]), person.start((0.0, 0.0, 0.0), 1.0)
    for _ in range(240):
        state, _ = person.step(state, Intent(wish, leap=Leap(np.array([0.0, 1.0, 4.8])), around=things), 1 / FPS)
        if isinstance(state.memory.memory, Jumping):
            break
    assert isinstance(state.memory.memory, Jumping), state.refused
    made = state.memory.memory.plan
    assert not state.memory.memory.fault and made.take_off < 0.3
