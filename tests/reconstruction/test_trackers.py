"""The network for trackers: what it sees, and the bodies that come of it."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gambol.controllers.body import Skeleton, forward_kinematics, yaw
from gambol.controllers.contract import Intent, Unable
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.mocap import load, retarget
from gambol.controllers.reconstruction import SKELETON, Reconstruction, parse
from gambol.controllers.reconstruction.following.point_gate import ENOUGH, LISTENED
from gambol.controllers.reconstruction.footing import Footing
from gambol.controllers.reconstruction.pose_vector import JOINTS, REFERENCE, WIDTH
from gambol.controllers.reconstruction.regression import kinematics_kernel
from gambol.controllers.reconstruction.trackers import INPUTS, LAGS, SLOTS, Trackers, bodies
from gambol.controllers.reconstruction.trackers.samples import FIRST
from gambol.controllers.reconstruction.trackers.slots import view_kernel
from gambol.controllers.reconstruction.trackers.solver import misfit_kernel, slopes_kernel
from dolls import shipped, strides
from walks import walked

DT = 1 / 60
HEAD_AND_HANDS = "head,lwrist,rwrist"
SHARED = Path(__file__).parents[3] / "shared" / "mocap" / "cmu" / "16"


@pytest.fixture(scope="module")
def walk():
    """Root, rotations, positions and orientations of a walk that is no recording."""
    root, rotations = strides()
    return root, rotations, *forward_kinematics(SKELETON, root, rotations)


def seen(rng, shape=(len(LAGS), len(SLOTS))):
    places = rng.normal(size=(*shape, 3)) + [0.0, 1.0, 0.0]
    turns = np.linalg.qr(rng.normal(size=(*shape, 3, 3)))[0]
    return places, turns * np.linalg.det(turns)[..., None, None], rng.random(shape) < 0.7, rng.random(shape) < 0.5


def viewed(places, turns, placed, turned, given=np.zeros(3), body=SKELETON.offsets):
    inputs, ground = np.empty(INPUTS, np.float32), np.empty(3)
    view_kernel(places, turns, placed, turned, body, SKELETON.offsets, LAGS, DT, given, inputs, ground)
    return inputs, ground


def played(method, seen, turns=None, start=0):
    """Root and rotations of a method from nothing."""
    memory = method.begin(*method.find(seen[start], None, None if turns is None else turns[start]))
    poses = []
    for now in range(start, len(seen)):
        memory, pose = method.step(memory, seen[now], None if turns is None else turns[now])
        poses.append(pose)
    return np.stack([pose.root for pose in poses]), np.stack([pose.rotations for pose in poses])


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 10_000))
def test_what_a_lost_tracker_says_changes_no_bit(seed):
    rng = np.random.default_rng(seed)
    places, turns, placed, turned = seen(rng)
    told = viewed(places, turns, placed, turned)
    places[~placed], turns[~turned] = rng.choice([np.nan, np.inf, 1e9]), np.nan
    again = viewed(places, turns, placed, turned)
    assert np.array_equal(told[0], again[0]) and np.array_equal(told[1], again[1])
    assert np.isfinite(told[0]).all()


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 10_000), st.floats(-3.0, 3.0), st.floats(-50.0, 50.0))
def test_wherever_one_stands_and_faces_the_network_sees_the_same(seed, angle, aside):
    rng = np.random.default_rng(seed)
    places, turns, placed, turned = seen(rng)
    given = np.array([0.3, -0.2, 0.4])
    told, ground = viewed(places, turns, placed, turned, given)
    turn = yaw(angle)
    spot = turn @ [given[0], 0.0, given[1]] + [aside, 0.0, -aside]
    again, there = viewed(places @ turn.T + [aside, 0.0, -aside], turn @ turns, placed, turned, np.array([spot[0], spot[2], given[2] + angle]))
    assert np.allclose(told, again, atol=2e-4)
    assert np.cos(there[2] - ground[2] - angle) > 1.0 - 1e-9


def test_poses_turn_with_the_world(walk):
    points = walk[2][:20, parse("6", SKELETON).joints]
    method, turn = Trackers(shipped(), parse("6", SKELETON), DT), yaw(1.0)
    root, rotations = played(method, points)
    there, turned = played(method, points @ turn.T + [3.0, 0.0, -2.0])
    assert np.abs(there[-1] - (turn @ root[-1] + [3.0, 0.0, -2.0])).max() < 0.005
    assert np.abs(turned[-1, 1:] - rotations[-1, 1:]).max() < 0.05


def energy(frame, pieces):
    mean, precision, lower, upper, body, joints, beside, goals, hold, turns, keep = pieces
    positions, orientations = np.empty((len(SKELETON), 3)), np.empty((len(SKELETON), 3, 3))
    axes, points, angles = np.empty((len(SKELETON), 3, 3)), np.empty((len(joints), 3)), np.zeros((len(joints), 3))
    kinematics_kernel(frame, 1.0, SKELETON.parents, body, REFERENCE, FIRST, positions, orientations, axes, np.empty((3, 3, 3)))
    total = misfit_kernel(frame, mean, precision, lower, upper, joints, beside, goals, hold, turns, keep, positions, orientations, points, angles)
    normal, fall = np.zeros((WIDTH, WIDTH)), np.empty(WIDTH)
    slopes_kernel(frame, mean, precision, lower, upper, SKELETON.parents, FIRST, joints, goals, hold, keep, positions, axes, points, angles, normal, fall)
    return total, fall


@settings(max_examples=5, deadline=None)
@given(st.integers(0, 10_000))
def test_the_solver_falls_along_its_energy(seed):
    rng = np.random.default_rng(seed)
    spread = rng.normal(size=(WIDTH, WIDTH))
    joints = np.array([0, 5, 9, 13, 17])
    places, turns, *_ = seen(rng, (1, len(joints)))
    body = bodies(4, rng)[3]
    pieces = (0.2 * rng.normal(size=WIDTH), spread @ spread.T, np.full(57, -0.1), np.full(57, 0.1), body, joints,
              0.1 * rng.normal(size=(5, 3)), places[0], np.array([9.0, 0.0, 40.0, 3.0, 1.0]), turns[0], np.array([2.0, 5.0, 0.0, 1.0, 7.0]))
    frame = 0.3 * rng.normal(size=WIDTH)
    _, fall = energy(frame, pieces)
    for d in range(WIDTH):
        step = np.zeros(WIDTH)
        step[d] = 1e-6
        slope = (energy(frame + step, pieces)[0] - energy(frame - step, pieces)[0]) / 2e-6
        assert abs(-0.5 * slope - fall[d]) <= 2e-4 * max(1.0, abs(fall).max())


@pytest.mark.few(2)
@pytest.mark.parametrize(("points", "turning", "bound"), [("6", False, 0.05), ("6", True, 0.04), ("4", False, 0.12), (HEAD_AND_HANDS, True, 0.2)])
def test_a_walk_is_found_from_nothing(walk, points, turning, bound):
    _, _, positions, orientations = walk
    controls = parse(points, SKELETON)
    root, rotations = played(Trackers(shipped(), controls, DT), positions[:120, controls.joints], orientations[:120, controls.joints] if turning else None)
    away = np.linalg.norm(forward_kinematics(SKELETON, root, rotations)[0] - positions[:120], axis=-1)[:, JOINTS].mean(-1)
    assert away.mean() < bound and away[0] < 2.0 * bound


def test_feet_that_stand_carry_nobody_along(walk, monkeypatch):
    """Head and hands alone, so nobody knows where feet came down: hips, trunk and arms are where they are without soles that are held."""
    controls = parse(HEAD_AND_HANDS, SKELETON)
    points, turns = walk[2][:240, controls.joints], walk[3][:240, controls.joints]
    held = forward_kinematics(SKELETON, *played(Trackers(shipped(), controls, DT), points, turns))
    monkeypatch.setattr(Footing, "step", lambda footing, feet, pose, standing, told, dt: (feet, pose))
    loose = forward_kinematics(SKELETON, *played(Trackers(shipped(), controls, DT), points, turns))
    above = [j for j, name in enumerate(SKELETON.names) if not name.endswith(("Leg", "Foot", "Toe"))]
    assert np.linalg.norm(held[0] - loose[0], axis=-1)[:, above].max() < 0.03


class Wavering:
    """A network whose expectations of legs waver by `by` [rad] from one frame to the next."""

    legs = np.array([3 * k + i for k, joint in enumerate(JOINTS) if SKELETON.names[joint].endswith("Leg") for i in range(3)])

    def __init__(self, network, by):
        self.network, self.by = network, by

    def __getattr__(self, name):
        return getattr(self.network, name)

    def predict(self, inputs):
        expected, standing = self.network.predict(inputs)
        self.by = -self.by
        expected = expected.copy()
        expected[self.legs] += self.by
        return expected, standing


def test_what_the_network_expects_may_waver(walk):
    """Of what alternates from frame to frame, in legs that no tracker tells of, half does not reach the solve."""
    _, _, positions, orientations = walk
    controls = parse(HEAD_AND_HANDS, SKELETON)
    solved = []
    for by in (0.0, 0.02):
        method = Trackers(Wavering(shipped(), by), controls)
        memory = method.begin(*method.find(positions[0, controls.joints], None, orientations[0, controls.joints]))
        poses = []
        for now in range(90):
            memory, _ = method.step(memory, positions[now, controls.joints], orientations[now, controls.joints])
            poses.append(memory.pose)
        solved.append(np.array(poses)[30:])
    off = (solved[1] - solved[0])[:, Wavering.legs]
    assert np.abs(off).max() < 0.5 * 0.02


def test_lost_trackers_leave_no_bit_and_no_leap(walk):
    points = walk[2][:90, parse("6", SKELETON).joints].copy()
    points[40:70, 2] = np.nan
    points[50:60] = np.nan
    root, rotations = played(Trackers(shipped(), parse("6", SKELETON), DT), points)
    assert np.isfinite(root).all() and np.isfinite(rotations).all()
    joints = forward_kinematics(SKELETON, root, rotations)[0]
    assert np.linalg.norm(np.diff(joints, axis=0), axis=-1).max() < 0.3


def test_who_was_lost_altogether_comes_back_without_a_pop(walk):
    """Nearly a second without a tracker, in a walk that the body stands half a metre behind: it comes there on the way that fading has it, and no
    joint goes much farther in a frame; soon all is as it was."""
    controls = parse("6", SKELETON)
    method = Trackers(shipped(), controls, DT)
    controller = Reconstruction(method, controls, starts=method)
    points, turns, bodies = walk[2][:, controls.joints].copy(), walk[3][:, controls.joints].copy(), []
    points[90:140], turns[90:140] = np.nan, np.nan
    state = controller.begin(points[0], turns=turns[0])
    for now in range(1, 200):
        state, pose = controller.step(state, Intent(points=points[now], turns=turns[now]), DT)
        bodies.append(forward_kinematics(SKELETON, pose.root, pose.rotations)[0])
    steps, own = (np.linalg.norm(np.diff(some, axis=0), axis=-1) for some in (bodies, walk[2][1:200]))
    away = np.linalg.norm(bodies - walk[2][1:200], axis=-1)[:, JOINTS].mean(-1)
    assert (steps - own)[85:].max() < 0.08
    assert away[138] > 0.5 and away[175:].mean() < 0.04


@pytest.mark.parametrize("turning", [False, True])
def test_who_begins_in_the_middle_of_a_stride_is_there_at_once(walk, turning):
    """A body that begins with how fast its points go needs no half second to catch up with them."""
    controls = parse("6", SKELETON)
    method = Trackers(shipped(), controls, DT)
    controller = Reconstruction(method, controls, starts=method)
    quick = 4.0 * walk[2][:, :1] * [0.0, 0.0, 1.0]  # as who runs: the walk, carried along at four more times its speed
    positions, turns = walk[2] + quick, walk[3][:, controls.joints]
    points = positions[:, controls.joints]
    state, off = controller.begin(points[60], (points[61] - points[60]) / DT, turns=turns[60] if turning else None), []
    for now in range(61, 100):
        state, pose = controller.step(state, Intent(points=points[now], turns=turns[now] if turning else None), DT)
        joints = forward_kinematics(SKELETON, pose.root, pose.rotations)[0]
        off.append(np.linalg.norm(joints[controls.joints] - points[now], axis=-1).max())
    assert max(off) < 0.12


def test_a_larger_body_is_met_on_its_own_skeleton(walk):
    body = SKELETON.scaled(1.12)
    points = 1.12 * walk[2][:60, parse("6", SKELETON).joints]
    root, rotations = played(Trackers(shipped(), parse("6", SKELETON), DT, body), points)
    away = np.linalg.norm(forward_kinematics(body, root, rotations)[0] - 1.12 * walk[2][:60], axis=-1)[:, JOINTS].mean(-1)
    assert away.mean() < 0.05
    with pytest.raises(ValueError, match="the chart's joints"):
        Trackers(shipped(), parse("6", SKELETON), DT, Skeleton(("Hips",), np.array([-1]), np.zeros((1, 3)), np.empty(0, int), np.empty((0, 3))))


def test_a_controller_hears_turns_and_begins_from_nothing(walk):
    controls = parse(HEAD_AND_HANDS, SKELETON)
    method = Trackers(shipped(), controls, DT)
    controller = Reconstruction(method, controls, starts=method, skeleton=SKELETON)
    points, turns = walk[2][:, controls.joints], walk[3][:, controls.joints]
    state = controller.begin(points[0], turns=turns[0])
    for now in range(1, 40):
        state, pose = controller.step(state, Intent(points=points[now], turns=turns[now]), DT)
    assert controller.status(state).kind == "running"
    _, orientations = forward_kinematics(SKELETON, pose.root, pose.rotations)
    assert np.abs(orientations[controls.joints] - turns[39]).max() < 0.2
    with pytest.raises(Unable, match=r"turns of shape \(2, 3, 3\)"):
        controller.begin(points[0], turns=turns[0, :2])


@pytest.mark.skipif(not SHARED.is_dir(), reason="needs recorded motion beside the project")
def test_a_recorded_walk_that_it_never_saw():
    """16_14 is held out of what the network is learnt from."""
    clip = retarget(load(SHARED / "16_14.amc")).resample(60.0)
    positions, _ = clip.kinematics()
    controls = parse("6", SKELETON)
    root, rotations = played(Trackers(shipped(), controls, DT), positions[:200, controls.joints])
    away = np.linalg.norm(forward_kinematics(SKELETON, root, rotations)[0] - positions[:200], axis=-1)[:, JOINTS].mean(-1)
    assert away.mean() < 0.03 and away[0] < 0.05


@pytest.mark.few(1)
@pytest.mark.parametrize("points, two, turning", [("6", ("lwrist", "rwrist"), True), ("6", ("lankle", "rankle"), True), ("4", ("rwrist", "lankle"), False)])
def test_two_trackers_that_come_back_under_each_others_number_are_found_out(points, two, turning):
    """Neither was seen for 0.3 s, as they do on; it is told, and the body is soon as if nothing had been."""
    controls = parse(points, SKELETON)
    positions, orientations = forward_kinematics(SKELETON, *strides())
    seen, turns = positions[:, controls.joints].copy(), orientations[:, controls.joints].copy()
    pair = [controls.names.index(name) for name in two]
    seen[60:78, pair] = turns[60:78, pair] = np.nan
    seen[78:, pair], turns[78:, pair] = seen[78:, pair[::-1]], turns[78:, pair[::-1]]
    method = Trackers(shipped(), controls, DT)
    follower = Reconstruction(method, controls, starts=method)
    state, off = follower.begin(seen[0], turns=turns[0] if turning else None), []
    for point, turn, true in zip(seen[1:], turns[1:], positions[1:]):
        if len(off) == 60:
            assert follower.status(state).reason == ""
        state, pose = follower.step(state, Intent(points=point, turns=turn if turning else None), DT)
        off.append(np.linalg.norm(forward_kinematics(SKELETON, pose.root, pose.rotations)[0] - true, axis=-1).mean())
    assert follower.status(state).reason == f"{controls.names[min(pair)]} and {controls.names[max(pair)]} have exchanged their numbers"
    assert np.mean(off[-20:]) < np.mean(off[30:55]) + 0.02


@pytest.mark.few(1)
@pytest.mark.parametrize("points", ["4", "6"])
@pytest.mark.parametrize("walk", ["doll", "Gambol's"])
def test_in_walks_nothing_speaks_for_an_exchange(points, walk):
    """Not half as much as it takes, though any two are in doubt all the time."""
    controls = parse(points, SKELETON)
    if walk == "doll":
        positions = forward_kinematics(SKELETON, *strides())[0]
    else:
        clip = walked(Locomotion.load(), [(0.5, 0, 0, 0), (1.5, 1.3, 0.4, 0), (1, 2.5, 0, 0), (1, 0, 0, 0)])
        positions = clip.kinematics()[0]
    method = Trackers(shipped(), controls, DT)
    follower = Reconstruction(method, controls, starts=method)
    state, most = follower.begin(positions[0, controls.joints]), 0.0
    for now in positions[1:, controls.joints]:
        doubts = state.memory.doubts
        state = replace(state, memory=replace(state.memory, doubts=replace(doubts, left=np.full(len(doubts.pairs), LISTENED))))
        state, _ = follower.step(state, Intent(points=now), DT)
        most = max(most, state.memory.doubts.evidence.max())
    assert most < 0.5 * ENOUGH and follower.status(state).reason == ""
