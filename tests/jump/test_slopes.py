"""Leaps off slopes and onto them: soles lie in the ground's plane, nothing is in it, and who can't says so truly."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gambol.controllers.body import forward_kinematics, sole_corners
from gambol.controllers.contract import Intent, Leap
from gambol.controllers.jump.body import landing_feet, soles, striding_feet
from gambol.controllers.jump.body.planted_pose import foot_kernel, lying_kernel
from gambol.controllers.navigation import floor_at, slope_at
from gambol.game.scene import Box

DT = 1 / 60
GRAZES = 0.006
slopes = st.tuples(st.floats(-0.4, 0.4), st.floats(-0.4, 0.4)).map(np.array)
headings = st.floats(-np.pi, np.pi)


def hill(degrees, heading=0.0):
    """A ramp of 6 m under the origin that rises along a heading."""
    slope = np.tan(np.radians(degrees))
    return (Box((0.0, 3.0 * slope - 0.5, 0.0), (6.0, 1.0, 6.0), heading, slope=slope),)


def on(things, x, z):
    return np.array([x, floor_at(x, z, things), z])


def played(person, things, start, asks, seconds=3.2):
    """The states of one who is asked for something at each time [s], from `start` (x, z, heading)."""
    state, states = person.start(start, floor_at(*start[:2], things)), []
    for k in range(round(seconds / DT)):
        state, _ = person.step(state, Intent(around=things, **asks(k * DT)), DT)
        states.append(state)
    return states


def over_ground(skeleton, states, things):
    """How high (T, 12) the soles' corners are over the ground [m]."""
    placed = forward_kinematics(skeleton, np.stack([s.pose.root for s in states]).astype(float), np.stack([s.pose.rotations for s in states]).astype(float))
    return np.array([[y - floor_at(x, z, things, y + 0.15) for x, y, z in row.reshape(-1, 3)] for row in sole_corners(skeleton, *placed)])


def lands(jump, state, things):
    """Nothing is in the ground, soles lie on it as they land, and nobody floats where he stands: of one who plays a plan from `state`."""
    made = state.memory.memory.plan
    placed = forward_kinematics(jump.skeleton, made.roots, made.local)
    heights = np.array([[y - floor_at(x, z, things, y + 0.15) for x, y, z in row.reshape(-1, 3)] for row in sole_corners(jump.skeleton, *placed)])
    assert heights.min() > -GRAZES
    flat = heights[(made.times > made.touch_down + 0.1) & made.contacts.all(1)]
    assert len(flat) > 3 and np.abs(flat).max() < 0.01
    before = heights[(made.times < made.push_off) & made.contacts.all(1)]
    assert not len(before) or np.abs(before[-1]).max() < 0.01


@given(slopes, headings, st.floats(-0.6, 0.6))
def test_a_foot_lies_in_the_ground_and_turns_with_it(slope, heading, pitch):
    flat, lying, level = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    foot = np.array([0.0, 0.0, 0.0, heading, 0.0, 1.0, *slope])
    normal = np.array([-slope[0], 1.0, -slope[1]]) / np.sqrt(1.0 + slope @ slope)
    lying_kernel(foot, 0.0, flat)
    np.testing.assert_allclose(flat[:, 1], normal, atol=1e-12)
    np.testing.assert_allclose(flat.T @ flat, np.eye(3), atol=1e-12)
    assert np.linalg.det(flat) > 0.0
    lying_kernel(foot, pitch, lying)
    foot_kernel(heading, pitch, level)
    assert np.isclose(lying[:, 2] @ normal, level[1, 2]), "it points as far down from the ground as from a level one"
    lying_kernel(foot[:6], pitch, lying)
    np.testing.assert_array_equal(lying, level)


@given(slopes, headings, st.booleans(), st.tuples(*[st.floats(-5.0, 5.0)] * 3).map(np.array))
def test_soles_that_land_lie_in_the_ground_about_their_place(jump, slope, heading, strides, place):
    body = jump.physique.tables
    feet = striding_feet(place, heading, body, 1, slope) if strides else landing_feet(place, heading, body, slope)
    corners = soles(feet, body, slope)
    np.testing.assert_allclose(corners[:, 1] - place[1], (corners - place)[:, [0, 2]] @ slope, atol=1e-12)
    if not strides:
        np.testing.assert_allclose(corners.mean(0), place, atol=1e-12)


@given(headings, st.floats(-0.4, 0.4), st.tuples(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0)))
def test_slopes_are_how_the_ground_rises(heading, slope, place):
    things, step = (Box((0.0, 1.0, 0.0), (9.0, 3.0, 9.0), heading, slope=slope),), 1e-5
    x, z = place
    rises = [(floor_at(x + step * a, z + step * b, things) - floor_at(x - step * a, z - step * b, things)) / (2.0 * step) for a, b in ((1, 0), (0, 1))]
    np.testing.assert_allclose(slope_at(x, z, things), rises, atol=1e-6)
    assert not slope_at(x, z, things, -5.0).any() and not slope_at(50.0, 0.0, things).any()


@pytest.mark.few(6)
@pytest.mark.parametrize("degrees", [6.0, 15.0])
@pytest.mark.parametrize("facing", [0.0, np.pi, 0.5 * np.pi, 0.8])
@pytest.mark.parametrize("way", [None, (0.7, 0.0), (0.5, 0.5 * np.pi), (0.4, np.pi)], ids=["up", "ahead", "aside", "back"])
def test_whoever_stands_on_a_slope_leaps_on_it(jump, locomotion, person, degrees, facing, way):
    things = hill(degrees)
    state = played(person, things, (0.0, 0.0, facing), lambda t: {}, 0.5)[-1]
    x, z, heading = state.ground
    place = None if way is None else on(things, x + way[0] * np.sin(heading + way[1]), z + way[0] * np.cos(heading + way[1]))
    state, _ = person.step(state, Intent(leap=Leap(place), around=things), DT)
    assert state.active == "jump", state.refused
    lands(jump, state, things)


@pytest.mark.parametrize("up", [True, False])
def test_whoever_stands_before_a_slope_leaps_onto_it_and_off_it(jump, person, up):
    things = hill(10.0)
    foot, beyond = -2.6, -3.7
    start, end, facing = (beyond, foot, 0.0) if up else (foot, beyond, np.pi)
    state = played(person, things, (0.0, start, facing), lambda t: {}, 0.5)[-1]
    state, _ = person.step(state, Intent(leap=Leap(on(things, 0.0, end)), around=things), DT)
    assert state.active == "jump", state.refused
    lands(jump, state, things)


def test_whoever_aims_on_a_slope_crouches_and_leaps_and_stands_there(person):
    things = hill(12.0)
    leap = Leap(on(things, 0.3, 0.5))
    states = played(person, things, (0.0, 0.0, 0.5), lambda t: {} if t < 0.3 or t > 1.6 else {"aim": leap} if t < 1.4 else {"leap": leap}, 4.5)
    high, jumps = over_ground(person.skeleton, states, things), np.array([s.active == "jump" for s in states])
    assert high.min() > -GRAZES and jumps[40] and not jumps[-1]
    stands = np.array([s.contacts for s in states])[60:80]
    soles = high[60:80].reshape(20, 2, 3, 2)  # heel, ball, tip
    assert np.abs(soles[:, :, 1:]).max() < 0.005 and not stands.all(), "he waits on the balls of his feet: ankles bend no farther uphill"
    assert (np.abs(soles[:, :, 0]).max(-1)[stands[:, ::2]] < 0.03).all()
    assert np.hypot(*(states[-1].ground[:2] - leap.place[[0, 2]])) < 0.1


def test_what_is_too_steep_is_refused_and_told(jump, person):
    things = hill(28.0)
    state = person.start((0.0, 0.0, 0.0), floor_at(0.0, 0.0, things))
    assert jump.refusal(state, Intent(leap=Leap(None), around=things)) == "too steep to leap off: 28°, where 22° can be"
    below = person.start((0.0, -3.6, 0.0))
    assert jump.refusal(below, Intent(leap=Leap(on(things, 0.0, -2.6)), around=things)).startswith("too steep to leap onto: 28°")
    brink = person.start((0.0, -3.6, 0.0))
    assert "edge" in jump.refusal(brink, Intent(leap=Leap(on(hill(15.0), 2.98, -2.4)), around=hill(15.0))), "half a foot beside it is over an edge still"
