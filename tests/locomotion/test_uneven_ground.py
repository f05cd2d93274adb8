"""Kerbs, stairs and ramps: the ground under a foot, and whoever walks up, along and down."""

import math
from itertools import product
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from gambol.controllers.body import contact_points, forward_kinematics
from gambol.controllers.contract import Intent, Leap
from gambol.controllers.locomotion.memory import ABOUT, ASKS
from gambol.controllers.locomotion.tops import SAME, SEEN, ground_kernel, tops
from gambol.controllers.locomotion.treads import FOOT, NONE, SOLE, TIP, under_kernel
from gambol.controllers.navigation import floor_at, gap
from gambol.controllers.scaled import Scaled

FPS = 60


def box(centre, size, heading=0.0, slope=0.0):
    return SimpleNamespace(centre=centre, size=size, heading=heading, slope=slope)


def flight(steps, rise, tread, start=2.0, width=2.4, landing=2.0):
    """Stairs ahead of one who looks along z, a landing, and down again."""
    end = start + steps * tread
    up = [box((0, 0.5 * h, 0.5 * (a + end)), (width, h, end - a)) for k in range(steps)
          for h, a in [((k + 1) * rise, start + k * tread)]]
    top = [box((0, 0.5 * steps * rise, end + 0.5 * landing), (width, steps * rise, landing))]
    down = [box((0, 0.5 * h, end + landing + 0.5 * b), (width, h, b)) for k in range(steps)
            for h, b in [((steps - k) * rise, (k + 1) * tread)]]
    return tuple(up + top + down)


def ramp(degrees, length, start=2.0, landing=2.0, width=2.4):
    """A ramp, a landing, and down again."""
    slope = math.tan(math.radians(degrees))
    high, far = slope * length, start + length + landing
    return (box((0, 0.5 * high - 0.5, start + 0.5 * length), (width, 1.0, length), slope=slope),
            box((0, 0.5 * high, start + length + 0.5 * landing), (width, high, landing)),
            box((0, 0.5 * high - 0.5, far + 0.5 * length), (width, 1.0, length), slope=-slope))


WAYS = {"a kerb of 15 cm": ((box((0, 0.075, 4.0), (3, 0.15, 2)),), 1.2), "stairs of 12 cm": (flight(5, 0.12, 0.32), 0.9),
        "stairs of 17 cm": (flight(5, 0.17, 0.29), 0.7), "stairs of 20 cm": (flight(4, 0.20, 0.28), 0.6),
        "a ramp of 15 degrees": (ramp(15, 3.0), 1.1), "a ramp, running": (ramp(8, 5.0), 2.8)}


def walked(locomotion, around, speed, seconds):
    """States, and how high heels and balls (T, 4) are over the ground under them [m]."""
    state, states = locomotion.start(), []
    for _ in range(round(seconds * FPS)):
        state, _ = locomotion.step(state, Intent(np.array([speed, 0.0, 0.0]), around=around), 1 / FPS)
        states.append(state)
    points = contact_points(locomotion.skeleton, *forward_kinematics(
        locomotion.skeleton, np.array([s.pose.root for s in states], float), np.array([s.pose.rotations for s in states], float)))
    ground = np.array([[floor_at(x, z, around) for x, _, z in frame] for frame in points])
    return states, points[..., 1] - ground - 0.02


@pytest.mark.few(2)
@pytest.mark.parametrize("name", WAYS)
def test_it_goes_up_along_and_down(locomotion, name):
    """Feet that stand are on the ground, or a heel or toes over an edge; the body is as high over its feet as ever."""
    around, speed = WAYS[name]
    high = max(b.centre[1] + 0.5 * b.size[1] for b in around if b.slope == 0.0)
    states, clear = walked(locomotion, around, speed, {2.8: 6.5, 0.6: 18.0, 0.7: 16.0}.get(speed, 12.0))
    held = np.array([s.memory["grip"] for s in states]) >= 1.0
    floors = np.array([float(s.floor) for s in states])
    assert floors.max() == pytest.approx(high, abs=0.02) and floors[-1] == pytest.approx(0.0, abs=1e-9)
    assert np.mean(clear[held] < -0.02) < 0.025 and np.mean(clear[held] < 0.02) > 0.7
    assert np.mean(clear < -0.05) < 0.02, "swinging feet pass over edges"
    pelvis = np.array([s.pose.root[1] for s in states]) - floors
    assert pelvis.min() > 0.70 and pelvis.max() < 1.25
    assert np.abs(np.diff([s.pose.root[1] for s in states])).max() < 0.03


def test_feet_on_a_slope_lie_along_it(locomotion):
    states, clear = walked(locomotion, ramp(12, 4.0), 1.0, 5.0)
    on = np.array([2.6 < s.ground[1] < 5.4 for s in states])
    both = (np.array([s.memory["grip"] for s in states]) >= 1.0)[:, 2:].all(-1) & on
    assert both.sum() > 10 and np.median(np.abs(clear[both][:, 2:])) < 0.004 and clear[both][:, 2:].min() > -0.01


@pytest.mark.parametrize("degrees", (10, -15))
def test_feet_across_a_slope_lie_on_it(locomotion, degrees):
    """Soles that stand whole are level with the slope sideways, too."""
    slope = math.tan(math.radians(degrees))
    around = (box((0, 4.5, 3.0), (20, 1.0, 20), heading=0.5 * math.pi, slope=slope),)
    state, states = locomotion.start((0, 0, 0), 5.0), []
    for _ in range(4 * FPS):
        state, _ = locomotion.step(state, Intent(np.array([1.0, 0.0, 0.0]), around=around), 1 / FPS)
        states.append(state)
    local = np.array([s.pose.rotations for s in states], float)
    turned = forward_kinematics(locomotion.skeleton, np.array([s.pose.root for s in states], float), local)[1]
    normal = np.array([-slope, 1.0, 0.0]) / math.hypot(slope, 1.0)
    for foot, side in enumerate(("Left", "Right")):
        whole = (np.array([s.memory["grip"] for s in states])[:, 2 * foot:2 * foot + 2] >= 1.0).all(-1)
        off = np.degrees(np.arccos(np.clip(turned[whole, locomotion.skeleton.index(side + "Foot"), :, 1] @ normal, -1, 1)))
        assert whole.sum() > 30 and np.median(off) < 4.0


@pytest.mark.few(2)
@pytest.mark.parametrize("degrees", (6, 12, 15))
@pytest.mark.parametrize("facing", (0.0, 0.8, 0.5 * math.pi, math.pi))
def test_who_stands_on_a_slope_has_both_heels_down(locomotion, degrees, facing):
    """From where he is put, and where he has come to rest: he stands lower, and his knees are bent."""
    around = (box((0.0, 0.0, 0.0), (9.0, 4.0, 9.0), slope=math.tan(math.radians(degrees))),)
    for walks in (0.0, 0.8):
        state = locomotion.start((0.0, 0.0, facing), floor_at(0.0, 0.0, around))
        for k in range(270):
            state, pose = locomotion.step(state, Intent(np.array([walks if k < 60 else 0.0, 0.0, 0.0]), around=around), 1 / FPS)
        points = contact_points(locomotion.skeleton, *forward_kinematics(locomotion.skeleton, pose.root.astype(float), pose.rotations.astype(float)))
        high = [y - floor_at(x, z, around) for x, y, z in points]
        assert max(high) < 0.025 and min(high) > 0.015 and state.contacts.all()


def test_a_body_waits_for_feet_that_take_short_steps(locomotion):
    """On narrow treads it goes slower than asked, and no foot is dragged from one tread onto the next."""
    states, clear = walked(locomotion, flight(5, 0.17, 0.30), 0.8, 9.0)
    pace = np.array([s.memory["pace"] for s in states])
    assert pace.min() < 0.8 and pace[-1] > pace.min()
    roots = np.array([s.pose.root[1] for s in states], float)
    assert np.abs(np.diff(roots[::2], 2)).max() * 900 < 18.0
    assert np.mean(clear < -0.01) < 0.01, "feet pass over edges"


@pytest.mark.parametrize("high", (0.3, 0.5))
def test_nobody_sinks_much_faster_than_they_fall(locomotion, high):
    state, states = locomotion.start((0, 0, 0), high), []
    for _ in range(300):
        state, _ = locomotion.step(state, Intent(np.array([1.1, 0.0, 0.0]), around=(box((0, 0.5 * high, 0), (4, high, 6)),)), 1 / FPS)
        states.append(state)
    assert float(state.floor) == pytest.approx(0.0, abs=1e-9)
    level = np.array([s.memory["level"] + float(s.floor) for s in states])
    assert np.diff(level, 2).min() * FPS**2 > -10.5


def test_far_things_change_nothing(locomotion):
    """Who walks on the floor walks as where nothing stands about."""
    ends = [walked(locomotion, around, 1.1, 3.0)[0][-1] for around in ((), (box((50.0, 0.5, 50.0), (1, 1, 1)),))]
    np.testing.assert_allclose(ends[0].pose.root, ends[1].pose.root, atol=1e-5)
    np.testing.assert_allclose(ends[0].pose.rotations, ends[1].pose.rotations, atol=1e-4)


def test_what_is_too_high_for_a_step_is_no_ground(locomotion):
    """Feet stay below a table's edge that steering would never lead one into."""
    states, _ = walked(locomotion, (box((0, 0.35, 3.0), (3, 0.7, 2)),), 0.8, 3.0)
    assert max(float(s.floor) for s in states) == 0.0


def test_a_child_climbs_in_its_own_size(locomotion):
    child = Scaled(locomotion, 0.7)
    state, around = child.start(), (box((0, 0.06, 3.0), (3, 0.12, 3)),)
    for _ in range(150):
        state, _ = child.step(state, Intent(np.array([0.9, 0.0, 0.0]), around=around), 1 / FPS)
    assert float(state.floor) == pytest.approx(0.12, abs=1e-6) and 1.6 < state.ground[1] < 4.2


def test_a_child_that_aims_stops_idling(locomotion):
    """What another controller is wanted for is known to a walker in another size, too."""
    child = Scaled(locomotion, 0.7)
    for intent, alert in ((Intent(aim=Leap(np.zeros(3))), ABOUT), (Intent(leap=Leap(np.zeros(3))), ASKS)):
        state, _ = child.step(child.start(), intent, 1 / FPS)
        assert state.memory.memory["alert"] == alert
    assert child.step(state, Intent(), 1 / FPS)[0].memory.memory["alert"] == 0


coordinate = st.floats(-3.0, 3.0, allow_subnormal=False)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(coordinate, coordinate, st.floats(0.0, 0.4), st.floats(0.3, 3.0), st.floats(0.3, 3.0), st.floats(-3.0, 3.0),
                          st.sampled_from((0.0, 0.0, 0.1, -0.2))), max_size=5), coordinate, coordinate)
def test_ground_is_what_navigation_says_it_is(boxes, x, z):
    """The highest top within reach, as `floor_at` finds it."""
    around = [box((a, 0.5 * h, b), (w, h, d), turn, slope) for a, b, h, w, d, turn, slope in boxes]
    out = np.empty(3)
    found = ground_kernel(tops(around), x, z, 0.0, 0.0, out)
    expected = floor_at(x, z, around, SEEN)
    assert found and out[0] == pytest.approx(max(expected, 0.0), abs=1e-9)


def test_who_turns_beside_a_kerb_lifts_his_feet_over_it(locomotion):
    """In a turn feet swing round, over what the straight way between two steps misses."""
    kerb, count = box((0.0, 0.07, 1.2), (1.2, 0.14, 0.8)), 48
    rng = np.random.default_rng(1)
    ground = np.stack([rng.uniform(-1.2, 1.2, count), rng.uniform(0.0, 0.6, count), rng.uniform(-np.pi, np.pi, count)], -1)
    wish = np.stack([rng.uniform(0.3, 1.0, count), rng.choice([-2.0, 2.0], count), np.zeros(count)], -1)
    state, deepest = locomotion.start(ground), np.zeros(count)
    for _ in range(4 * FPS):
        state, pose = locomotion.step(state, Intent(wish, around=(kerb,)), 1 / FPS)
        points = contact_points(locomotion.skeleton, *forward_kinematics(locomotion.skeleton, np.asarray(pose.root, float), np.asarray(pose.rotations, float)))
        deepest = np.maximum(deepest, -gap(points.reshape(-1, 3), kerb).reshape(count, -1).min(1))
    assert deepest.max() < 0.03, deepest.max()


class Level(NamedTuple):
    """What is asked of a character's memory."""

    level: float


@settings(max_examples=300, deadline=None)
@given(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5), st.floats(-3.2, 3.2), st.floats(0.06, 0.2))
@example(-0.095, 0.07, -2.234, 0.17)
def test_a_foot_that_stands_has_no_side_in_a_tread(x, z, points, high):
    """By the corner of stairs, whichever way it points: looked at along its middle alone, toes stood in the riser beside it."""
    steps = tops([box((-2.0, 0.5 * high * (n + 1), 0.29 * n), (4.0, high * (n + 1), 0.29)) for n in range(3)])
    under, ground, c, s = np.empty(3), np.empty(3), np.cos(points), np.sin(points)
    if under_kernel(Level(0.0), steps, 0.0, x, z, c, s, under) > NONE:
        for along, left in product((-FOOT, -0.5 * FOOT, 0.0, TIP), (-SOLE, SOLE)):
            ground_kernel(steps, x + along * s + left * c, z + along * c - left * s, 0.0, 0.0, ground)
            assert ground[0] < under[0] + SAME


@pytest.mark.parametrize("slope", [0.15, 0.3, -0.3])
def test_runners_hips_rise_and_sink_with_the_slope(locomotion, slope):
    """They followed the feet, a fifth of a metre too late: uphill knees were thrown backwards, downhill legs did not reach the ground."""
    long, high = 8.0, 8.0 * abs(slope)
    hill, start = (box((0.0, 0.5 * high - 0.5, 3.0 + 0.5 * long), (2.0, 1.0, long), slope=slope),), 3.2 if slope < 0.0 else 0.0
    state, joints, over = locomotion.start((0.0, start, 0.0), floor_at(0.0, start, hill)), [], []
    while state.ground[1] < 3.0 + long - 1.0:
        state, pose = locomotion.step(state, Intent(np.array([3.2, 0.0, 0.0]), around=hill), 1 / FPS)
        joints.append(forward_kinematics(locomotion.skeleton, pose.root, pose.rotations)[0])
        if state.ground[1] > 5.5 and state.velocity[0] > 2.5:
            over.append(pose.root[1] - floor_at(0.0, state.ground[1], hill))
    assert len(over) > 30 and 0.88 < min(over) and max(over) < 1.2
    assert np.linalg.norm(np.diff(joints, 2, axis=0), axis=-1).max() * FPS**2 < 450


def test_what_comes_about_in_mid_swing_is_passed_over_from_where_the_foot_left(locomotion):
    """And not from where somebody was when he last had anything about him: a kerb that lies behind him by then raises no foot."""
    for late in range(0, 40, 4):
        for speed in (1.2, 2.8):
            state, lifted = locomotion.start(), []
            for _ in range(240 + late):
                state, _ = locomotion.step(state, Intent(np.array([speed, 0.0, 0.0])), 1 / FPS)
            for around in ((), (box((0.0, 0.075, 2.0), (4.0, 0.15, 1.0)),)):
                now, heights = state, []
                for _ in range(12):
                    now, pose = locomotion.step(now, Intent(np.array([speed, 0.0, 0.0]), around=around), 1 / FPS)
                    heights.append(contact_points(locomotion.skeleton, *forward_kinematics(locomotion.skeleton, pose.root, pose.rotations))[:, 1])
                lifted.append(np.array(heights))
            assert np.abs(lifted[1] - lifted[0]).max() < 2e-3


@pytest.mark.few(1)
@pytest.mark.parametrize(("wish", "longest"), [((0.0, 0.0, 0.0), 10), ((0.4, 0.0, 0.0), 10), ((1.3, -1.5, 0.0), 10), ((-0.5, 0.0, 0.0), 24)], ids=str)
def test_who_thinks_better_of_it_half_down_a_ledge_brings_his_other_foot_down_to_the_first(locomotion, wish, longest):
    """Set down again on the ledge behind him, a step higher, it pulled the first off the ground and was thrown up as high as the hips behind its body."""
    hips, ankles = ([locomotion.skeleton.index(side + part) for side in ("Left", "Right")] for part in ("UpLeg", "Foot"))
    for when in range(40, 100, 6):
        state, states = locomotion.start((0.0, -0.75, 0.0), 0.29), []
        for frame in range(180):
            now = np.array(wish) if when <= frame < when + 35 else np.array([1.3, 0.0, 0.0])
            state, _ = locomotion.step(state, Intent(now, around=(box((0.0, 0.145, -2.0), (3.0, 0.29, 4.0)),)), 1 / FPS)
            states.append(state)
        joints, _ = forward_kinematics(locomotion.skeleton, np.array([s.pose.root for s in states], float), np.array([s.pose.rotations for s in states], float))
        heading = np.array([s.ground[2] for s in states])
        way = joints[:, hips] - joints[:, ankles]
        behind = way[..., 0] * np.sin(heading)[:, None] + way[..., 2] * np.cos(heading)[:, None]
        assert np.degrees(np.arctan2(behind, way[..., 1])).max() < 50.0, when
        off = np.array([not s.contacts.any() for s in states])
        edges = np.flatnonzero(np.diff(np.concatenate([[False], off, [False]]).astype(int)))
        assert np.max(edges[1::2] - edges[::2], initial=0) <= longest, when
