"""Who walks and leaps to a place does so off the foot that is under him, and keeps his speed."""

from dataclasses import replace

import numpy as np
import pytest

from gambol.controllers.body import forward_kinematics, sole_corners
from gambol.controllers.contract import Intent, Leap
from gambol.controllers.jump import Jumping
from gambol.controllers.jump.motion import moments, over_ledge
from gambol.controllers.jump.reach.sweep import touch
from gambol.controllers.jump.starting import goes
from gambol.controllers.navigation import steer
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


@pytest.mark.few(3)
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


def told(person, speed, up, beyond=0.35):
    """The plan of one who walks so fast [m/s] at an edge up, or down [m], and is told a place so far beyond it [m]; and the boxes."""
    low, high = Box((0.0, 0.0, 0.0), (8.0, 0.02, 60.0)), abs(up)
    edge = 4.4
    things = (low, Box((0.0, 0.5 * high, edge + 8.0 if up > 0.0 else edge - 8.0), (6.0, high, 16.0)))
    floor, lands = (0.01, high) if up > 0.0 else (high, 0.01)
    wish, state = np.array([speed, 0.0, 0.0]), person.start((0.0, 0.0, 0.0), floor)
    place = np.array([0.0, lands, edge + beyond])
    for _ in range(60):
        state, _ = person.step(state, Intent(wish, around=things), 1 / FPS)
    for _ in range(240):
        state, _ = person.step(state, Intent(wish, leap=Leap(place), around=things), 1 / FPS)
        if isinstance(state.memory.memory, Jumping):
            break
    assert isinstance(state.memory.memory, Jumping), state.refused
    return state.memory.memory, things


@pytest.mark.few(2)
@pytest.mark.parametrize("speed", [1.2, 1.6])
@pytest.mark.parametrize("up", [0.2, 0.35, -0.2, -0.35])
def test_onto_a_step_and_off_one_he_leaps_as_on_the_level(person, speed, up):
    """He sank over the foot that had just struck for half a second, had half his speed left as he came up, and a third as he came down, onto both feet."""
    memory, things = told(person, speed, up)
    made = memory.plan
    assert not memory.fault and made.take_off < 0.36 and made.path.lands is not None
    assert np.linalg.norm(made.path.velocity[[0, 2]]) / speed > 0.8
    assert touch(person.parts["jump"].physique, made, things) is None


def test_his_legs_clear_the_edge_that_he_comes_down_from(person):
    """The leg that swings on lay in what he had leapt off, and the leap was refused."""
    memory, things = told(person, 1.3, -0.35)
    made, jump = memory.plan, person.parts["jump"]
    start = replace(jump.start_of(person.start((0.0, 0.0, 0.0), 0.35)), single=0, bound=True)
    edge = over_ledge(replace(start, feet=start.feet + [0.0, 0.0, 3.8, 0.0, 0.0]), np.array([0.0, 0.01, 4.75]), 0.35, things).ledge
    assert edge.z == pytest.approx(4.4, abs=0.03) and edge.up_z == pytest.approx(-1.0, abs=0.03) and edge.high == pytest.approx(0.34)
    times = np.arange(made.touch_down - 0.1, made.touch_down + 0.12, 1 / 120)
    poses = [made.at(time) for time in times]
    corners = sole_corners(person.skeleton, *forward_kinematics(person.skeleton, np.array([p.root for p in poses]), np.array([p.rotations for p in poses])))
    before = corners[..., 2] < 4.4
    assert before.any() and corners[..., 1][before].min() > 0.34


def test_who_turns_to_a_place_waits_for_a_foot_that_will_have_turned_on(person):
    """He saw none to come, as none sends him there who would go straight on, and pushed off the foot that had just struck, for half a second."""
    state, jump, waits = person.start(), person.parts["jump"], []
    for _ in range(190):
        state, _ = person.step(state, Intent(np.array([1.3, 0.0, 0.0])), 1 / FPS)
    place = np.array([state.ground[0] + 2.3 * np.sin(0.9), 0.0, state.ground[1] + 2.3 * np.cos(0.9)])
    for _ in range(36):
        state, _ = person.step(state, steer(state.ground, 1.3 * (place[[0, 2]] - state.ground[:2]) / np.hypot(*(place[[0, 2]] - state.ground[:2])), None, state.velocity[1]), 1 / FPS)
        own = person.active(state)[1]
        start, contacts = jump.start_of(own), np.asarray(state.contacts).reshape(2, 2).any(1)
        for side in np.flatnonzero(contacts):
            off = replace(start, single=int(side), along=True, bound=True)
            waits.append([moments(jump.physique, off, goes(state), place, 0.0, 9.81, lambda foot: True, turns=turns)[1] for turns in (0.0, float(state.velocity[1]))])
    straight, turning = np.sum(waits, 0)
    assert turning > straight + 4
