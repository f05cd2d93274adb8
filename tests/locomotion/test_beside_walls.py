"""Feet beside what is too high to step on: they come down before it, and swing past it."""

import sys
from pathlib import Path
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from gambol.controllers.body import contact_points, forward_kinematics
from gambol.controllers.contract import Intent
from gambol.controllers.locomotion.beside_walls import BESIDE, MOST, out_of_walls
from gambol.controllers.locomotion.tops import tops
from gambol.controllers.navigation import gap
from gambol.controllers.navigation.passing import STEP

sys.path.insert(0, str(Path(__file__).parents[2] / "scripts" / "measure"))
from _limbs import legs_apart  # noqa: E402

FPS = 60
NEAR = st.floats(-1.0, 1.0)


def box(centre, size, heading=0.0):
    return SimpleNamespace(centre=centre, size=size, heading=heading, slope=0.0)


class Someone(NamedTuple):
    """What is asked of a character's memory."""

    ground: np.ndarray
    base: np.ndarray
    left: np.ndarray


def body(x=0.0, z=0.0):
    return Someone(np.array([x, z, 0.0]), np.zeros(2), np.zeros(2))


def pushed(who, things, line):
    """The centre line (3, 2) of a foot where it goes."""
    out = np.empty(2)
    out_of_walls(who, tops(things), 0.0, 0, line, out)
    return line + out


@settings(max_examples=200, deadline=None)
@given(st.floats(0.2, 2.0), st.floats(0.2, 2.0), st.floats(-3.0, 3.0), NEAR, NEAR, st.floats(-0.3, 0.3), st.floats(-0.3, 0.3), st.floats(-3.0, 3.0))
def test_a_foot_is_led_out_to_its_bodys_side(wide, deep, heading, x, z, aside, ahead, points):
    """No place of it is in the box afterwards, by half a shoe, and the way from the body to it leads through no box."""
    thing = box((0.0, 0.5, 0.0), (wide, 1.0, deep), heading)
    assume(gap(np.array([[x, 0.5, z]]), thing)[0] > 0.15)
    line = np.array([x + aside, z + ahead]) + np.outer([0.0, 0.175, 0.27], [np.sin(points), np.cos(points)])
    led = pushed(body(x, z), (thing,), line)
    at = np.column_stack([led[:, 0], np.full(3, 0.5), led[:, 1]])
    if not np.array_equal(led, line):
        assert gap(at, thing).min() > -1e-9
    c, s = np.cos(heading), np.sin(heading)
    local = np.abs(np.stack([c * led[:, 0] - s * led[:, 1], s * led[:, 0] + c * led[:, 1]], -1))
    assert (local >= 0.5 * np.array([wide, deep]) + BESIDE - 1e-9).any(-1).all()


@settings(max_examples=100, deadline=None)
@given(st.floats(0.02, 0.4), st.floats(4.0, 9.0), st.floats(-3.0, 3.0), st.floats(0.2, 0.5), st.floats(-1.0, 1.0), st.floats(0.05, 0.7), st.floats(-3.0, 3.0))
def test_a_foot_goes_back_from_a_long_wall_and_never_along_it(thick, long, heading, before, along, ahead, points):
    """Wherever it was to come down within the wall or beyond it: to the body's side by no farther than it was over, and not aside."""
    c, s = np.cos(heading), np.sin(heading)
    turned = np.array([[c, -s], [s, c]])  # places in the wall's frame to x, z
    line = (np.array([along, ahead]) + np.outer([0.0, 0.175, 0.27], [np.sin(points), np.cos(points)])) @ turned
    led = pushed(body(*(np.array([along, -before - 0.5 * thick]) @ turned)), (box((0.0, 1.0, 0.0), (long, 2.0, thick), heading),), line)
    moved = (led - line) @ turned.T
    over = (line @ turned.T)[:, 1].max() + 0.5 * thick + BESIDE
    if over < MOST:
        assert (led @ turned.T)[:, 1].max() <= -0.5 * thick - BESIDE + 1e-9
    assert np.abs(moved[:, 0]).max() < 1e-9 and -over - 1e-9 <= moved[0, 1] <= 0.0


@pytest.mark.parametrize("high", (0.1, STEP))
def test_what_can_be_stepped_on_pushes_no_foot(high):
    line = np.array([[0.3, 0.0], [0.4, 0.0], [0.5, 0.0]])
    assert np.array_equal(pushed(body(), (box((0.8, 0.5 * high, 0.0), (1.0, high, 1.0)),), line), line)


def test_the_next_tread_but_one_is_no_wall_to_who_comes_up_the_stairs():
    """But it is to who comes from the side."""
    stairs = tuple(box((0.0, 0.085 * (n + 1), 1.0 + 0.29 * n), (2.0, 0.17 * (n + 1), 0.29)) for n in range(4))
    line = np.array([[0.0, 1.2], [0.0, 1.375], [0.0, 1.47]])
    assert np.array_equal(pushed(body(0.0, 0.7), stairs, line), line)
    led = pushed(body(1.3, 1.5), stairs, np.array([[1.1, 1.6], [0.95, 1.6], [0.9, 1.6]]))
    assert (led[:, 0] > 1.0 + BESIDE - 1e-9).all()


@settings(max_examples=200, deadline=None)
@given(st.floats(0.05, 0.3), st.floats(2.0, 3.0), st.floats(-0.15, 0.1), st.floats(-0.1, 0.1), st.floats(-3.0, 0.0))
def test_who_stands_beside_stairs_has_no_foot_led_from_one_tread_into_the_next(far, z, aside, ahead, points):
    """Treads are short: out by its end is the shorter way, but there is the next one."""
    stairs = tuple(box((0.0, 0.085 * (n + 1), 1.0 + 0.29 * n), (2.0, 0.17 * (n + 1), 0.29)) for n in range(9))
    line = np.array([1.0 + aside, z + ahead]) + np.outer([0.0, 0.175, 0.27], [np.sin(points), np.cos(points)])
    assert (pushed(body(1.0 + far, z), stairs, line)[:, 0] > 1.0).all()


def test_what_hangs_overhead_pushes_no_foot():
    line = np.array([[0.3, 0.0], [0.4, 0.0], [0.5, 0.0]])
    assert np.array_equal(pushed(body(), (box((0.8, 1.5, 0.0), (1.0, 1.0, 1.0)),), line), line)


@pytest.mark.few(1)
@pytest.mark.parametrize("thing", (box((0.0, 0.3, 2.0), (2.0, 0.6, 2.0)), SimpleNamespace(foot=(0.0, 0.0, 1.3), radius=0.3, height=2.0)), ids=("a box", "a pillar"))
def test_who_turns_and_steps_close_by_keeps_his_feet_out_of_it(locomotion, thing):
    """Restless hands that press a body against it: no heel, ball or tip is in it, and nobody climbs what is too high for a step."""
    rng, state, states = np.random.default_rng(3), locomotion.start((0.0, 0.6, 0.0)), []
    wish = np.zeros(3)
    for n in range(40 * FPS):
        if n % 25 == 0:  # on towards it, mostly, and turning
            way = np.arctan2(-state.ground[0], 1.5 - state.ground[1]) - state.ground[2] + rng.normal(0.0, 1.0)
            wish = np.array([np.cos(way), 0.0, np.sin(way)]) * rng.uniform(0.2, 1.0) + [0.0, rng.uniform(-2.5, 2.5), 0.0]
        state, _ = locomotion.step(state, Intent(wish, around=(thing,)), 1 / FPS)
        assert abs(float(state.floor)) < 0.05
        states.append(state)
    points = contact_points(locomotion.skeleton, *forward_kinematics(
        locomotion.skeleton, np.array([s.pose.root for s in states], float), np.array([s.pose.rotations for s in states], float)))
    deep = -gap(points.reshape(-1, 3), thing).reshape(points.shape[:-1])
    assert deep.max() < 0.03 and np.mean(deep.max(1) > 0.01) < 0.005, (deep.max(), np.mean(deep.max(1) > 0.01))


@pytest.mark.parametrize(("angle", "speed"), [(85, 0.8), (70, 0.8), (55, 1.4), (40, 0.8), (25, 1.4)])
def test_who_comes_to_a_wall_askew_keeps_his_legs_apart(locomotion, angle, speed):
    """They went through each other, and one was thrown across the other, as high as the hips."""
    wall, turned = (box((0.0, 1.0, 3.0), (8.0, 2.0, 0.3)),), np.radians(90.0 - angle)
    state, poses = locomotion.start((-1.6 * np.sin(turned), 2.7 - 1.6 * np.cos(turned), turned)), []
    for _ in range(200):
        state, pose = locomotion.step(state, Intent(np.array([speed, 0.0, 0.0]), around=wall), 1 / FPS)
        poses.append(pose)
    roots, rotations = np.stack([pose.root for pose in poses]), np.stack([pose.rotations for pose in poses])
    assert legs_apart(locomotion.skeleton, roots, rotations).min() > 0.03
    joints, _ = forward_kinematics(locomotion.skeleton, roots, rotations)
    assert np.linalg.norm(np.diff(joints, 2, axis=0), axis=-1).max() * FPS**2 < 300
    assert joints[:, [locomotion.skeleton.index(side + "Foot") for side in ("Left", "Right")], 1].max() < 0.35


def test_a_foot_in_mid_swing_beside_a_ramp_is_not_led_over_it(locomotion):
    """What it was led aside for, and how fast it went there, said where it was to go out next: to the ramp's far side, half a metre off and as high as the knee."""
    slope = SimpleNamespace(centre=(-0.0696, -0.1783, 1.3867), size=(1.3208, 1.0, 1.8005), heading=2.9333, slope=0.3573)
    block = box((-0.6415, 0.2575, 2.5508), (1.033, 0.5149, 0.6724), 1.8408)
    wishes = (24, (-0.5, 0.0, -0.5)), (69, (2.8, 0.8828, 0.0)), (55, (1.3, 0.0, 0.0)), (66, (0.0, 0.0, -0.5)), (54, (1.3, 0.0, 0.5))
    state, lifts, asides = locomotion.start((0.1347, -1.5, -0.4354)), [], []
    for frames, wish in wishes:
        for _ in range(frames):
            state, _ = locomotion.step(state, Intent(np.array(wish), around=(slope, block)), 1 / FPS)
            lifts.append(state.memory["base"].max())
            asides.append(np.linalg.norm(state.memory["aside"], axis=-1).max())
    assert max(lifts) < 0.05 and max(asides) < 0.25, (max(lifts), max(asides))


WALLS = {"a wall": (box((0.0, 1.0, 1.25), (6.0, 2.0, 0.5)), 0.0), "its corner": (box((-1.0, 1.0, 1.25), (2.0, 2.0, 0.5)), 0.0),
         "a wall met askew": (box((0.0, 1.0, 1.25), (6.0, 2.0, 0.5), 0.2), 0.0), "a low box": (box((0.0, 0.3, 1.25), (1.0, 0.6, 0.5)), 0.1),
         "a pillar": (SimpleNamespace(foot=(0.0, 0.0, 1.3), radius=0.3, height=2.0), 0.02)}


@pytest.mark.few(4)
@pytest.mark.parametrize("speed", (0.7, 1.3, 2.8))
@pytest.mark.parametrize("name", WALLS)
def test_who_walks_on_at_a_wall_comes_to_rest_before_it(locomotion, name, speed):
    """He stands on both feet and treads no longer on the spot; he goes as soon as he wishes to go back."""
    thing, x = WALLS[name]
    state, settled, ways = locomotion.start((x, -0.2, 0.0)), [], []
    for _ in range(6 * FPS):
        state, _ = locomotion.step(state, Intent(np.array([speed, 0.0, 0.0]), around=(thing,)), 1 / FPS)
        settled.append(bool(state.memory["settled"]))
        ways.append(state.ground[:2].copy())
    rests = settled.index(True, 30)
    assert all(settled[rests:]) and rests < 4.5 * FPS and state.contacts.all()
    assert ways[-1][1] > 0.6, "he came up to it"
    for _ in range(FPS):
        state, _ = locomotion.step(state, Intent(np.array([-0.5, 0.0, 0.0]), around=(thing,)), 1 / FPS)
    assert state.ground[1] < ways[-1][1] - 0.2


def test_who_runs_along_a_wall_that_he_meets_askew_goes_on(locomotion):
    state = locomotion.start()
    for _ in range(4 * FPS):
        state, _ = locomotion.step(state, Intent(np.array([2.8, 0.0, 0.0]), around=(box((0.0, 1.0, 2.25), (12.0, 2.0, 0.5), 0.5),)), 1 / FPS)
    assert not state.memory["settled"] and np.hypot(*state.ground[:2]) > 3.0
