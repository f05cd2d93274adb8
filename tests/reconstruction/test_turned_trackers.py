"""How trackers are turned: from Unity's axes into ours, through packets and time, by whatever protocol."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from gambol.controllers.body.rotations import yaw
from gambol.controllers.reconstruction.live.osc_packets import understood
from gambol.controllers.reconstruction.live.osc_stream import Trackers
from gambol.controllers.reconstruction.control_points import parse
from gambol.controllers.reconstruction.live.placing import Placement, Standing, placed, stances
from gambol.controllers.reconstruction.live.sources import Recorded
from gambol.controllers.reconstruction.live.timeline import Timeline
from gambol.controllers.reconstruction.pose_vector import SKELETON
from test_stream import bundle, message

UNITY = np.array([-1.0, 1.0, 1.0])


def quaternion_product(a, b):
    """Hamilton's, of (x, y, z, w), by its definition: as Unity multiplies them."""
    return np.append(a[3] * b[:3] + b[3] * a[:3] + np.cross(a[:3], b[:3]), a[3] * b[3] - a[:3] @ b[:3])


def turned_in_unity(quaternion, vector):
    """`Quaternion * Vector3`, as Unity has it."""
    return quaternion_product(quaternion_product(quaternion, np.append(vector, 0.0)), quaternion * [-1, -1, -1, 1])[:3]


def unity_euler(x, y, z):
    """`Quaternion.Euler`, in degrees: about Z, then X, then Y."""
    def about(axis, degrees):
        return np.append(np.sin(np.radians(degrees) / 2) * np.eye(3)[axis], np.cos(np.radians(degrees) / 2))
    return quaternion_product(quaternion_product(about(1, y), about(0, x)), about(2, z))


def on(controls):
    """Where a standing body has points, and how their joints are turned, in both stances."""
    stood = stances()
    return controls.on(*stood), stood[1][:, controls.joints]


def vmc(serial, place, quaternion, kind="Tra"):
    return message(f"/VMC/Ext/{kind}/Pos", serial, *map(float, place), *map(float, quaternion))


def vrchat(number, place=None, degrees=None):
    parts = [] if place is None else [message(f"/tracking/trackers/{number}/position", *map(float, place))]
    return parts + ([] if degrees is None else [message(f"/tracking/trackers/{number}/rotation", *map(float, degrees))])


@given(st.integers(0, 2**32 - 1))
def test_what_is_fixed_to_a_tracker_is_where_unity_has_it(seed):
    """Whatever its axes: a point that is carried along is seen in the same place of the room."""
    rng = np.random.default_rng(seed)
    place, beside, quaternion = rng.normal(size=3), rng.normal(size=3), Rotation.random(random_state=rng).as_quat()
    there = place + turned_in_unity(quaternion, beside)
    reading, = understood(vmc("a", place, quaternion).dgram).trackers
    found = reading.place + Rotation.from_quat(reading.turn).apply(beside * UNITY)
    assert np.allclose(found, there * UNITY, atol=1e-5)
    degrees = rng.uniform(-180, 180, 3)
    reading, = understood(bundle(*vrchat(1, place, degrees))).trackers
    found = reading.place + Rotation.from_quat(reading.turn).apply(beside * UNITY)
    assert np.allclose(found, (place + turned_in_unity(unity_euler(*degrees), beside)) * UNITY, atol=1e-4)


@pytest.mark.parametrize("degrees, ahead", [((90, 0, 0), (0, -1, 0)), ((0, 90, 0), (-1, 0, 0)), ((-90, 0, 0), (0, 1, 0)), ((0, 0, 90), (0, 0, 1))])
def test_a_head_that_nods_looks_down_and_one_that_turns_right_looks_right(degrees, ahead):
    """By Unity's Euler angles, as its manual says; right is −X here."""
    reading, = understood(bundle(*vrchat("head", (0, 0, 0), degrees))).trackers
    assert reading.kind == "Hmd" and np.allclose(Rotation.from_quat(reading.turn).apply([0, 0, 1]), ahead, atol=1e-6)


def test_place_and_turn_may_come_in_packets_of_their_own():
    turn = (10.0, 20.0, 30.0)
    truth = (Rotation.from_quat(unity_euler(*turn) * [1, -1, -1, 1])).as_matrix()
    trackers = Trackers({"1": "root"})
    for k in range(60):
        now = k / 60
        trackers.take(now, "a", vrchat(1, (0, 1, 0))[0].dgram)
        trackers.take(now + 1e-3, "a", vrchat(1, None, turn)[0].dgram)
    assert np.allclose(trackers.told(1.0), [[0, 1, 0]], atol=1e-6) and np.allclose(trackers.turns, truth, atol=1e-6)


@pytest.mark.parametrize("quaternion", [(0, 0, 0, 0), (np.nan, 0, 0, 1), (5, 0, 0, 0), ()])
def test_a_quaternion_that_is_none_leaves_the_place_alone(quaternion):
    reading, = understood(vmc("a", (1, 2, 3), quaternion).dgram).trackers
    assert np.allclose(reading.place, [-1, 2, 3]) and np.isnan(reading.turn).all()


@pytest.mark.parametrize("rate", [50, 90, 144])
def test_turns_are_told_one_packet_late_on_the_shortest_way(rate):
    line, spin = Timeline(), np.array([0.3, 2.0, -1.0])
    for k in range(2 * rate):
        turn = Rotation.from_rotvec(spin * k / rate).as_quat() * (-1) ** k  # either sign is the same turn
        line.heard(k / rate, np.zeros(3), turn=turn)
        seen = Rotation.from_quat(line.turned_at(k / rate + 0.3 / rate))
        if k > 40:
            assert (seen * Rotation.from_rotvec(spin * (k - 0.7) / rate).inv()).magnitude() < 1e-3
    unknown = Timeline()
    unknown.heard(0.0, np.zeros(3))
    assert np.isnan(unknown.turned_at(0.0)).all()


def test_turns_are_placed_as_points_are():
    trackers = Trackers({"a": "lwrist"})
    trackers.take(0.0, "x", vmc("a", (0, 1, 0), (0, 0, 0, 1)).dgram)
    trackers.placement = Placement(0.7, 1.2)
    trackers.told(0.0)
    assert np.allclose(trackers.turns, yaw(0.7))
    assert np.isnan(trackers.told(9.0)).all() and np.isnan(trackers.turns).all()


@given(st.integers(0, 2**32 - 1), st.integers(0, 1))
def test_however_trackers_sit_joints_are_turned_as_they_stand_and_go_on_from_there(seed, arms):
    rng = np.random.default_rng(seed)
    controls, heading = parse("6", SKELETON), rng.uniform(-3.0, 3.0)
    points, joints = (some[arms] for some in on(controls))
    mounts = Rotation.random(len(controls), random_state=rng).as_matrix()
    placement = placed(points @ yaw(heading).T + [0.3, 0.1, -2.0], controls, turns=yaw(heading) @ joints @ mounts)
    later = Rotation.random(len(controls), random_state=rng).as_matrix()
    assert np.allclose(placement.turned(yaw(heading) @ joints @ mounts), joints, atol=1e-6)
    assert np.allclose(placement.turned(yaw(heading) @ later @ mounts), later, atol=1e-6)


def test_what_stands_still_without_a_turn_has_none_later():
    """NaN, and the bit-exact identity that programs send for a tracker that knows no turn; others are told on the average."""
    controls, standing = parse("3", SKELETON), Standing()
    assert standing.turn is None
    for k in range(70):
        turns = np.stack([yaw(0.5 + 0.01 * (-1) ** k), np.eye(3), np.full((3, 3), np.nan)])
        standing = standing.watch(k / 60, on(controls)[0][0], turns)
    assert np.allclose(standing.turn[0], yaw(0.5), atol=1e-3) and np.isnan(standing.turn[1:]).all()
    told = placed(standing.place, controls, turns=standing.turn).turned(np.tile(yaw(0.5), (3, 1, 1)))
    assert np.allclose(told[0], np.eye(3), atol=1e-3) and np.isnan(told[1:]).all()


def test_a_recorded_performance_tells_turns_between_its_frames():
    turns = np.stack([yaw(0.0), yaw(1.0)])[:, None]
    recorded = Recorded(parse("head", SKELETON), np.zeros((2, 1, 3)), 0.1, turns)
    assert np.allclose(recorded.turned_at(0.025)[0], yaw(0.25)) and np.allclose(recorded.turned_at(0.1)[0], yaw(1.0))
    assert np.isnan(recorded.turned_at(0.2)).all()
    assert Recorded(recorded.controls, recorded.points, 0.1).turned_at(0.0) is None
