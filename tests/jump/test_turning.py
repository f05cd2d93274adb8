"""Turning in the air, and jumps aside and backward: where the body faces, what turns it, where it looks."""

import math

import numpy as np
import pytest

from conftest import FPS, ahead
from gambol.controllers.body import forward_kinematics
from gambol.controllers.contract import Intent, Leap
from gambol.controllers.jump import Refused
from test_flight import angular_momenta

RNG = np.random.default_rng(16)
ASKED = [(float(way), float(far), float(turn)) for way, far, turn in zip(
    RNG.uniform(-math.pi, math.pi, 10), RNG.uniform(0.0, 0.9, 10), [*RNG.uniform(-math.pi, math.pi, 8), math.pi, -3.1])]
"""Where to, how far [m] and how far round."""


def facing(orientation):
    """Headings (...) [rad] of what is turned so (..., 3, 3)."""
    return np.arctan2(orientation[..., 0, 2], orientation[..., 2, 2])


def apart(a, b):
    """How far (...) [°] headings lie from each other."""
    return np.degrees(np.abs((np.asarray(a) - b + math.pi) % math.tau - math.pi))


@pytest.fixture(scope="module")
def turned(jump, standing):
    """Heading asked for, turn, plan."""
    heading, made = float(standing.ground[2]), []
    for way, far, turn in ASKED:
        place = standing.ground[[0, 0, 1]] * [1.0, 0.0, 1.0] + far * np.array([np.sin(heading + way), 0.0, np.cos(heading + way)])
        made.append((heading + turn, turn, jump.plan(standing, Intent(leap=Leap(place, heading=heading + turn)))))
    return made


def test_it_lands_on_its_soles_in_the_heading_that_was_asked(jump, turned):
    for asked, _, made in turned:
        poses = [made.at(made.touch_down + 0.1), made.at(made.duration)]
        _, orientation = forward_kinematics(jump.skeleton, np.stack([p.root for p in poses]), np.stack([p.rotations for p in poses]))
        feet = orientation[:, [jump.skeleton.index(side + "Foot") for side in ("Left", "Right")]]
        both = feet.sum(1)  # toes point a little out, both alike
        assert apart(facing(both), asked).max() < 3.0 and apart(facing(feet), asked).max() < 5.0
        assert apart(facing(orientation[1, 0]), asked) < 0.5, "standing"
        rises = np.abs(feet[:, :, 1, 2]).max(1)
        assert rises[0] < 0.3 and rises[1] < 0.01, "toes first, heels last where it came backward"


def test_the_pelvis_comes_down_nearly_round_and_ends_there(turned):
    for asked, turn, made in turned:
        down = int(np.searchsorted(made.times, made.touch_down - 1e-9))
        assert apart(facing(made.local[down, 0]), asked - 0.08 * turn) < 3.0


def test_nothing_but_its_momentum_turns_it_in_the_air(turned):
    for _, turn, made in turned:
        air = (made.times >= made.take_off - 1e-9) & (made.times <= made.touch_down + 1e-9)
        step = np.diff(made.times[air])[0]
        found = angular_momenta(made.roots[air], made.local[air], step)
        np.testing.assert_allclose(found, np.broadcast_to(made.momentum, found.shape), atol=1e-7)
        if abs(turn) > 1.0:  # round the way that was meant, not by the limbs alone
            assert made.momentum[1] * turn > 0.0
        gone = np.diff(np.unwrap(facing(made.local[air, 0])))
        assert gone.sum() == pytest.approx(0.72 * turn, abs=0.1)


def test_the_head_goes_before(jump, turned):
    for _, turn, made in turned:
        if abs(turn) < 1.6:
            continue
        pose = made.at(made.take_off)
        _, orientation = forward_kinematics(jump.skeleton, pose.root, pose.rotations)
        lead = facing(orientation[jump.skeleton.index("Head")]) - facing(orientation[0])
        assert math.remainder(lead, math.tau) * turn > 1.2 * abs(turn)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_who_jumps_aside_looks_there_and_then_ahead(jump, standing, side):
    heading = float(standing.ground[2])
    place = ahead(standing, 0.0) + 0.8 * side * np.array([np.cos(heading), 0.0, -np.sin(heading)])
    made = jump.plan(standing, Intent(leap=Leap(place, heading=heading)))
    looks = []
    for time in (made.take_off, made.duration):
        pose = made.at(time)
        _, orientation = forward_kinematics(jump.skeleton, pose.root, pose.rotations)
        looks.append(math.remainder(float(facing(orientation[jump.skeleton.index("Head")])) - heading, math.tau))
    assert side * looks[0] > 1.0 and abs(looks[1]) < 0.02


def test_who_shall_face_on_leaps_ahead_as_if_nobody_had_said_so(jump, standing):
    place = ahead(standing, 0.8)
    told, plain = (jump.plan(standing, Intent(leap=Leap(place, heading=heading))) for heading in (float(standing.ground[2]), None))
    np.testing.assert_allclose(told.local, plain.local, atol=0.01)  # feet stand nearly even: the place is a little aside
    np.testing.assert_allclose(told.roots, plain.roots, atol=1e-3)


def test_the_ground_frame_turns_with_the_body_and_the_next_leap_starts_from_there(jump, person, standing):
    state = person.start(standing.ground)
    asked = float(standing.ground[2]) + 2.5
    for _ in range(150):
        before = state
        state, _ = person.step(state, Intent(leap=Leap(None, heading=asked)), 1 / FPS)
        assert abs(math.remainder(float(state.ground[2] - before.ground[2]), math.tau)) < 8.5 / FPS
        if state.active == "jump" and state.memory.memory.time > state.memory.memory.plan.touch_down + 0.3:
            break
    assert apart(state.ground[2], asked) < 1e-3


@pytest.mark.parametrize("leap, why", [
    (dict(heading=math.nan), "the heading must be a finite number"), (dict(heading=math.pi, airtime=0.2), "the jump takes 0.38 s"),
])
def test_what_can_t_be_turned_is_refused_with_a_reason(jump, standing, leap, why):
    leap = {**leap, "heading": leap["heading"] + float(standing.ground[2])}
    with pytest.raises(Refused, match=why):
        jump.plan(standing, Intent(leap=Leap(None, **leap)))


def test_who_runs_turns_a_little_only(jump, running):
    with pytest.raises(Refused, match="who runs turns by 46° at most"):
        jump.plan(running, Intent(leap=Leap(ahead(running, 2.2), heading=float(running.ground[2]) + 1.5)))


def test_another_heading_is_another_wish():
    assert Leap(None).same(Leap(None)) and not Leap(None).same(Leap(None, heading=0.0))
    assert Leap(None, heading=1.0).same(Leap(None, heading=1.0)) and not Leap(None, heading=1.0).same(Leap(None, heading=1.001))


@pytest.mark.parametrize("place", [None, np.array([0.0, 0.0, 1.0])])
def test_one_that_turns_a_little_is_near(place):
    """Also past half a turn."""
    assert Leap(place, heading=np.pi - 0.01).near(Leap(place, heading=-np.pi + 0.01)) and not Leap(place, heading=1.0).near(Leap(place, heading=1.4))
    assert not Leap(place, heading=1.0).near(Leap(place)) and not Leap(place, heading=1.0).near(Leap(np.array([0.0, 0.0, 1.4]), heading=1.0))


@pytest.mark.parametrize("heading", [np.inf, -np.inf, np.nan])
def test_a_heading_that_is_none_is_near_no_other(heading):
    """It is refused in words, also where another was asked before."""
    assert not Leap(None, heading=1.0).near(Leap(None, heading=heading)) and not Leap(None, heading=heading).near(Leap(None, heading=1.0))
