"""Walls: whoever walks or runs at them, however fast and from wherever, is stopped before them or goes along them, wished well or not."""

from functools import cache

import numpy as np
import pytest

from gambol.controllers.contract import Intent, Leap
from gambol.controllers.jump import Physique
from gambol.controllers.navigation import gap
from gambol.controllers.navigation.passing import NEAR
from gambol.controllers.person import person
from gambol.game.scene.scene import Box, Pillar
from gambol.game.world.solid import stopped

SLACK = 0.02
SECONDS = 5.0


@cache
def somebody(height=None):
    return person() if height is None else person(physique=Physique(22.0 * height * height, height))


def stage(rng):
    """Boxes, thin walls and pillars before somebody who stands at the origin, none nearer than he may come."""
    found = []
    for _ in range(rng.integers(1, 4)):
        far, aside, heading = rng.uniform(0.3, 6.0), rng.uniform(-0.6, 0.6), rng.uniform(-np.pi, np.pi)
        x, z = far * np.sin(aside), far * np.cos(aside)
        found.append((Box((x, 1.2, z + 0.6), tuple(rng.uniform((0.4, 0.8, 0.4), (3.0, 2.4, 3.0))), heading),
                      Box((x, 1.2, z), (rng.uniform(1.0, 5.0), 2.4, 0.1), heading),
                      Pillar((x, 0.0, z), rng.uniform(0.1, 0.6), 2.4))[rng.integers(3)])
    return tuple(thing for thing in found if gap(np.array([[0.0, 1.0, 0.0]]), thing)[0] > NEAR + SLACK)


def wishes(rng):
    """Straight on at any speed, turning, or aside and back."""
    kind = rng.integers(4)
    if kind == 2:
        return np.array([rng.uniform(-1.0, 1.4), 0.0, rng.uniform(-0.8, 0.8)])
    return np.array([rng.uniform(0.3, 4.2), rng.uniform(-1.0, 1.0) if kind == 1 else 0.0, 0.0])


def walked(who, velocity, things, heeds, heading=0.0, seconds=SECONDS):
    """The ground frames (T, 3) of somebody who wishes for a velocity; heeds: whether what he wishes heeds walls."""
    state, frames = who.start((0.0, 0.0, heading)), []
    for _ in range(round(60 * seconds)):
        intent = Intent(velocity, around=things)
        state, _ = who.step(state, stopped(state, intent, things) if heeds else intent, 1 / 60)
        frames.append(state.ground)
    return np.array(frames)


def least(frames, things):
    """How near [m] the nearest of things came to the middle of the body."""
    at = np.stack([frames[:, 0], np.ones(len(frames)), frames[:, 1]], -1)
    return min(float(gap(at, thing).min()) for thing in things)


@pytest.mark.few(2)
@pytest.mark.parametrize("heeds", [True, False])
@pytest.mark.parametrize("seed", range(12))
def test_nobody_comes_nearer_than_a_body_is_thick(seed, heeds):
    rng = np.random.default_rng(seed)
    things = stage(rng)
    if things:
        frames = walked(somebody(), wishes(rng), things, heeds)
        assert least(frames, things) > NEAR - SLACK
        assert np.linalg.norm(np.diff(frames[:, :2], axis=0), axis=-1).max() < 4.5 / 60  # nobody is put elsewhere


@pytest.mark.few(1)
@pytest.mark.parametrize("height", [1.2, 2.1])
@pytest.mark.parametrize("speed", [1.4, 3.5])
def test_nor_do_small_and_large_bodies(height, speed):
    things = (Box((0.5, 1.2, 2.0), (3.0, 2.4, 0.1), 0.3), Pillar((-1.0, 0.0, 3.0), 0.4, 2.0))
    for velocity in (np.array([speed, 0.0, 0.0]), np.array([speed, -0.4, 0.0])):
        assert least(walked(somebody(height), velocity, things, True, seconds=4.0), things) > NEAR * min(height / 1.75, 1.0) - SLACK


@pytest.mark.few(1)
@pytest.mark.parametrize("speed", [0.7, 1.4, 2.5, 3.5])
def test_who_goes_straight_at_a_wall_stops_before_it_and_brakes_as_people_do(speed):
    wall = (Box((0.0, 1.2, 6.0), (9.0, 2.4, 0.1)),)
    frames = walked(somebody(), np.array([speed, 0.0, 0.0]), wall, True, seconds=12.0)
    pace = np.gradient(frames[:, 1]) * 60
    assert 5.95 - NEAR - 0.15 < frames[-1, 1] < 5.95 - NEAR + SLACK and abs(pace[-60:]).max() < 1e-6
    assert np.gradient(pace).min() * 60 > -6.5  # as hard as the last resort brakes


@pytest.mark.few(1)
@pytest.mark.parametrize("speed", [1.0, 3.0])
def test_who_comes_to_a_wall_at_a_small_angle_goes_on_along_it(speed):
    wall = (Box((0.9, 1.2, 10.0), (0.2, 2.4, 40.0)),)
    frames = walked(somebody(), np.array([speed, 0.0, 0.0]), wall, True, heading=0.25, seconds=6.0)
    assert frames[-1, 1] - frames[120, 1] > 0.9 * 4.0 * speed


def test_who_stands_at_a_wall_and_is_told_to_go_on_stays():
    wall = (Box((0.0, 1.2, 0.8), (3.0, 2.4, 1.0)),)
    frames = walked(somebody(), np.array([1.4, 0.0, 0.0]), wall, True, seconds=3.0)
    assert np.linalg.norm(frames[:, :2], axis=-1).max() < 0.15


@pytest.mark.parametrize("speed", [0.4, 1.4, 3.0])
def test_who_is_about_to_leap_is_held_up_by_what_nobody_leaps_onto(speed):
    things = (Pillar((0.05, 0.0, 1.5), 0.2, 2.2),)
    who = somebody()
    state, frames = who.parts["locomotion"].start(), []
    for _ in range(240):
        state, _ = who.parts["locomotion"].step(state, Intent(np.array([speed, 0.0, 0.0]), around=things, aim=Leap(None, 0.4)), 1 / 60)
        frames.append(state.ground)
    assert least(np.array(frames), things) > NEAR - SLACK


@pytest.mark.parametrize("speed, high", [(1.4, 0.6), (3.0, 1.0)])
def test_who_asks_for_a_leap_onto_a_box_and_can_not_stops_before_it(speed, high):
    """He walked into it, and was lifted onto it or went through it."""
    things = (Box((0.05, 0.5 * high, 2.0), (3.0, high, 1.0)),)
    who = somebody()
    state, frames = who.parts["locomotion"].start(), []
    for _ in range(240):
        state, _ = who.parts["locomotion"].step(state, Intent(np.array([speed, 0.0, 0.0]), around=things, leap=Leap(np.array([0.0, high, 2.0]))), 1 / 60)
        frames.append(state.ground)
    assert 1.5 - NEAR - 0.3 < frames[-1][1] < 1.5 - NEAR + SLACK and float(state.floor) == 0.0
    assert np.diff(np.gradient(np.array(frames)[:, 1]) * 60).min() * 60 > -13.0
