"""A ramp's tall end and what is high of its sides hold people up; its low end, and whoever is over it, they do not."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gambol.controllers.body import Pose, contact_points, forward_kinematics
from gambol.controllers.contract import Intent, Strike
from gambol.controllers.jump import Physique
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.navigation import gap
from gambol.controllers.navigation.passing import HEAD, NEAR, STEP, drawn_in, slow_kernel, walls_of, way_kernel
from gambol.controllers.navigation.passing.walls import wall_kernel
from gambol.controllers.person import person
from gambol.game.scene import Box

FPS, WIDE, CELL = 60, 2.0, 0.25
LEGS = tuple(side + part for side in ("Left", "Right") for part in ("UpLeg", "Leg", "Foot"))
ARMS = tuple(side + part for side in ("Left", "Right") for part in ("ForeArm", "Hand"))
RAMPS = ((1.2, 3.0), (1.0, 1.6), (1.6, 4.0))
"""So high and so long [m]."""
MOST, RUNS = (0.03, 0.07), 2.0
"""So deep legs come into any wall [m], of who walks and, as a knee comes ahead, of who runs faster than this at one that he was not told of [m/s]."""


@pytest.fixture(scope="module")
def locomotion():
    """Who walks."""
    return Locomotion.load()


def ramp(high, length, heading=0.0, place=(0.0, 0.0)):
    """A ramp that rises from the floor along its heading, its middle at a place x, z [m]."""
    return Box((place[0], 0.0, place[1]), (WIDE, high, length), heading, slope=high / length)


def hill(x, z):
    """How high hills are [m]."""
    return 1.5 + 0.6 * np.sin(0.5 * x) * np.cos(0.4 * z)


def hills(x, z):
    """Hills about a place x, z, as ramps of a cell each, turned to where they rise: there are cracks between them."""
    made = []
    for a in x + CELL * np.arange(-6, 7):
        for b in z + CELL * np.arange(-6, 7):
            rise = np.array([0.3 * np.cos(0.5 * a) * np.cos(0.4 * b), -0.24 * np.sin(0.5 * a) * np.sin(0.4 * b)])
            made.append(Box((a, 0.5 * hill(a, b), b), (CELL, hill(a, b), CELL), float(np.arctan2(*rise)), slope=float(np.hypot(*rise))))
    return tuple(made)


def at(thing, across, along):
    """Where x, z something is in the world that is so far across and along from a ramp's middle [m]."""
    c, s = math.cos(thing.heading), math.sin(thing.heading)
    return thing.centre[0] + c * across + s * along, thing.centre[2] - s * across + c * along


def walked(locomotion, start, speed, around, seconds):
    """The states of somebody who wishes to go straight ahead."""
    state, states = locomotion.start(start), []
    for _ in range(round(FPS * seconds)):
        state, _ = locomotion.step(state, Intent(np.array([speed, 0.0, 0.0]), around=around), 1 / FPS)
        states.append(state)
    return states


def deep(skeleton, states, thing):
    """How deep legs' joints and soles are in something at most [m]."""
    placed = forward_kinematics(skeleton, np.array([s.pose.root for s in states], float), np.array([s.pose.rotations for s in states], float))
    legs = placed[0][:, [skeleton.index(name) for name in LEGS]]
    return -min(float(gap(part.reshape(-1, 3), thing).min()) for part in (legs, contact_points(skeleton, *placed)))


def held(thing, x, z, floor=0.0):
    """How far a ramp is from a place, endless where it holds nobody up, and the way out of it (2,)."""
    out = np.empty(3)
    return wall_kernel(walls_of((thing,)), 0, x, z, floor, math.inf, out), out[:2]


@settings(max_examples=100, deadline=None)
@given(st.sampled_from(RAMPS), st.floats(-3.0, 3.0), st.floats(-1.0, 1.0), st.floats(0.01, 2.0), st.floats(0.05, 0.6), st.sampled_from((-1.0, 1.0)))
def test_it_is_as_high_as_where_it_is_nearest(size, heading, part, far, thick, side):
    """Beside its tall end, its low one, its sides, and over it."""
    high, length = size
    thing = ramp(high, length, heading, (0.7, -1.3))
    assert held(thing, *at(thing, 0.5 * WIDE * part, 0.5 * length + far))[0] == pytest.approx(far)
    assert held(thing, *at(thing, 0.5 * WIDE * part, -0.5 * length - far))[0] == math.inf
    assert held(thing, *at(thing, 0.49 * WIDE * part, 0.49 * length * (2.0 * thick - 0.6)))[0] == math.inf
    found, out = held(thing, *at(thing, side * (0.5 * WIDE + far), 0.5 * length * part))
    assert found == (pytest.approx(far) if 0.5 * high * (1.0 + part) > STEP else math.inf)
    if found < math.inf:
        assert out == pytest.approx(side * np.array([math.cos(heading), -math.sin(heading)]))
    plank = Box((0.0, 0.5 * high - 0.5 * thick, 0.0), (WIDE, thick, length), slope=high / length)  # one walks under it where it is high enough
    assert (held(plank, 0.0, 0.5 * length + far)[0] < math.inf) == (high - thick < HEAD)


@pytest.mark.parametrize("size", RAMPS)
def test_what_it_leads_up_to_holds_up_nobody_who_walks_up(size):
    """Neither the landing nor a ramp down behind it, nor one that goes on up; they do who comes from beside."""
    high, length = size
    ahead = 0.5 * length
    landing, down = Box((0.0, 0.5 * high, ahead + 0.5), (WIDE, high, 1.0)), Box((0.0, 0.0, 2.0 * ahead + 1.0), (WIDE, high, length), slope=-high / length)
    walls, out, velocity = walls_of((ramp(high, length), landing, down)), np.empty(3), np.array([0.0, 3.0])
    for z in np.linspace(-ahead - 0.5, ahead - 0.01, 20):
        floor = max((z + ahead) * high / length, 0.0)
        assert not slow_kernel(walls, 0.0, z, floor, 0.0, velocity, NEAR, 0.1, 6.0, 0.3)
        assert way_kernel(walls, 0.0, z, floor, np.array([0.0, 1.0]), NEAR, 6.0, out) == 6.0
    assert slow_kernel(walls, 0.5 * WIDE + 0.3, ahead + 0.5, 0.0, 0.0, np.array([-3.0, 0.0]), NEAR, 0.1, 6.0, 0.3)


@settings(max_examples=100, deadline=None)
@given(st.sampled_from(RAMPS), st.floats(-3.0, 3.0), st.floats(-1.0, 1.0), st.floats(0.3, 3.0), st.floats(-1.2, 1.2))
def test_a_straight_way_ends_where_it_comes_too_near_to_what_is_high(size, heading, part, far, aslant):
    """Wherever it begins and leads: a walk along it in small steps says the same."""
    high, length = size
    thing = ramp(high, length, heading)
    walls, out = walls_of((thing,)), np.empty(3)
    for start, inwards in ((at(thing, 0.5 * WIDE * part, 0.5 * length + far), heading + math.pi), (at(thing, 0.5 * WIDE + far, 0.5 * length * part), heading - 0.5 * math.pi),
                           (at(thing, 0.5 * WIDE * part, -0.5 * length - far), heading)):
        ahead = np.array([math.sin(inwards + aslant), math.cos(inwards + aslant)])
        steps = np.arange(0.0, 5.0, 0.01)
        ways = [held(thing, *(start + gone * ahead)) for gone in steps]
        met = np.flatnonzero([room < NEAR and out @ ahead <= 0.0 for room, out in ways])
        got = way_kernel(walls, *start, 0.0, ahead, NEAR, 5.0, out)
        if not len(met):
            assert got > 4.9 or held(thing, *(start + got * ahead))[0] < NEAR + 0.02
        else:  # where it only just comes to be too high it is found a pace later
            assert steps[met[0]] - 0.03 < got < steps[met[0]] + 0.11 or len(met) < 12


APPROACHES = {"the tall end": (0.1, 1.8, math.pi), "the tall end, aslant": (1.3, 1.5, math.pi + 0.6), "its corner": (1.0, 1.2, math.pi)}


@pytest.mark.few(7)
@pytest.mark.parametrize("speed", (0.8, 1.4, 2.8))
@pytest.mark.parametrize("size", RAMPS)
@pytest.mark.parametrize("name", APPROACHES)
def test_nobody_walks_into_its_tall_end(locomotion, size, speed, name):
    across, before, heading = APPROACHES[name]
    thing = ramp(*size)
    states = walked(locomotion, (across, 0.5 * size[1] + before, heading), speed, (thing,), 3.0)
    assert deep(locomotion.skeleton, states, thing) < MOST[speed > RUNS]
    assert np.linalg.norm(np.diff([s.ground[:2] for s in states], axis=0), axis=-1).max() < 1.3 * speed / FPS


@pytest.mark.few(7)
@pytest.mark.parametrize("speed", (0.8, 1.4, 2.8))
@pytest.mark.parametrize("size", RAMPS)
@pytest.mark.parametrize(("along", "beside", "heading"), ((0.3, 1.6, -0.5 * math.pi), (0.1, 0.9, -0.6), (0.5, 1.2, -2.0)), ids=("at it", "and up", "and down"))
def test_nobody_walks_into_its_high_side(locomotion, size, speed, along, beside, heading):
    thing = ramp(*size)
    states = walked(locomotion, (0.5 * WIDE + beside, along * size[1], heading), speed, (thing,), 3.0)
    assert deep(locomotion.skeleton, states, thing) < MOST[speed > RUNS]


@pytest.mark.few(4)
@pytest.mark.parametrize(("size", "speed"), (((1.2, 3.0), 0.8), ((1.2, 3.0), 1.4), ((1.0, 1.6), 1.4), ((1.2, 3.0), 2.8), ((1.0, 1.6), 2.8)))
@pytest.mark.parametrize("heading", (0.0, 2.0))
def test_who_walks_up_is_not_held(locomotion, size, speed, heading):
    """Nor on the way down the other side."""
    high, length = size
    up = ramp(high, length, heading)
    landing, down = (at(up, 0.0, 0.5 * length + far) for far in (0.5, 1.0 + 0.5 * length))
    around = (up, Box((landing[0], 0.5 * high, landing[1]), (WIDE, high, 1.0), heading), Box((down[0], 0.0, down[1]), (WIDE, high, length), heading, slope=-high / length))
    states = walked(locomotion, (*at(up, 0.0, -0.5 * length - 1.5), heading), speed, around, (2.0 * length + 3.0) / speed + 2.0)
    gone = np.array([s.ground[:2] for s in states]) @ np.array([math.sin(heading), math.cos(heading)]) + 0.5 * length
    assert max(float(s.floor) for s in states) > high - 0.02 and float(states[-1].floor) == pytest.approx(0.0, abs=0.03) and gone[-1] > 2.0 * length + 1.2
    assert np.diff(gone)[gone[1:] > -0.3].min() * FPS > 0.7 * speed


def test_arms_come_in_beside_what_is_high_of_it_only(locomotion):
    thing, state = ramp(1.6, 4.0), locomotion.start()

    def drawn(across, along, floor=0.0):
        pose = Pose(state.pose.root + np.array([across, floor, along], np.float32), state.pose.rotations)
        return drawn_in(locomotion.skeleton, pose, np.array([across, along, 0.0]), (thing,)) is not pose

    assert drawn(0.5 * WIDE + 0.25, 1.2) and not drawn(0.5 * WIDE + 0.25, -1.4)
    assert not drawn(0.0, 1.2, 1.28) and not drawn(0.5, -2.2)


@pytest.mark.few(1)
@pytest.mark.parametrize("heading", (0.3, 1.6, -1.0))
def test_hills_of_many_small_ramps_hold_up_nobody(locomotion, heading):
    """Each is the floor before the next, across the cracks between them, too: a runner keeps his speed."""
    state, speed, cell, around = locomotion.start((0.0, 0.0, heading), hill(0.0, 0.0)), [], None, ()
    for _ in range(5 * FPS):
        before = state.ground[:2]
        if cell != (cell := tuple(np.round(before / CELL))):
            around = hills(*(CELL * np.array(cell)))
        state, _ = locomotion.step(state, Intent(np.array([2.5, 0.0, 0.0]), around=around), 1 / FPS)
        speed.append(np.linalg.norm(state.ground[:2] - before) * FPS)
    assert min(speed[2 * FPS:]) > 0.95 * 2.5


PUSHES = {"its tall end": ((0.1, 2.1, math.pi), -1.0, (0.8, 1.5)), "its high side": ((1.7, 1.0, -0.5 * math.pi), None, (0.8, 1.5)),
          "its low end": ((0.0, -2.0, 0.0), 1.0, (1.5,)), "it, over its edge": ((0.0, 0.7, 0.0), 1.0, (0.8,))}


@pytest.mark.few(1)
@pytest.mark.parametrize("name", PUSHES)
def test_who_is_pushed_at_it_stays_out(name):
    """Of it, or on top of it, and gets up there."""
    (x, z, heading), ahead, pushes = PUSHES[name]
    who, body, thing = person(), Physique(), ramp(1.2, 3.0)
    way = np.array([-1.0, 0.0]) if ahead is None else np.array([0.0, ahead])
    for hard in pushes:
        state, states = who.start((x, z, heading), 0.6 + 0.4 * z if name.endswith("edge") else 0.0), []
        for n in range(240):
            state, _ = who.step(state, Intent(around=(thing,), strike=Strike(tuple(hard * body.mass * way)) if n == 5 else None), 1 / FPS)
            states.append(state)
        joints = forward_kinematics(body.skeleton, np.array([s.pose.root for s in states], float), np.array([s.pose.rotations for s in states], float))[0]
        assert -gap(joints.reshape(-1, 3), thing).min() < 0.1
