"""Ours for trackers that turn: where their virtual points are, that turns are met, and that the world may turn."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from trajectories import calm_database

from gambol.controllers.body import exp, forward_kinematics, yaw
from gambol.controllers.reconstruction import SKELETON, parse
from gambol.controllers.reconstruction.baselines.windows import Samples
from gambol.controllers.reconstruction.database.contacts import contacts
from gambol.controllers.reconstruction.following import Starts
from gambol.controllers.reconstruction.neighbours.cells import Cells
from gambol.controllers.reconstruction.neighbours.segments import Segments
from gambol.controllers.reconstruction.ours.combined import LISTENED, Expectation, Ours
from gambol.controllers.reconstruction.ours.lost_points import LostPoints
from gambol.controllers.reconstruction.ours.networks import learn
from gambol.controllers.reconstruction.ours.virtual_points import Turning, carried, virtual
from gambol.controllers.reconstruction.pose_vector import WIDTH, advance, decode
from gambol.controllers.reconstruction.regression.map_solver import Solver
from gambol.controllers.reconstruction.regression.method import SPAN, Fused, Local, LocalRegression, Method

DT = 1 / 60
CONTROLS = parse("head,lwrist,rwrist", SKELETON)


@pytest.fixture(scope="module")
def database(tmp_path_factory):
    return calm_database(tmp_path_factory.mktemp("motion") / "made.gambolmotion")


@pytest.fixture(scope="module")
def method(database):
    """With a small network."""
    points = virtual(CONTROLS)
    solver = Solver(points, DT)
    samples = Samples.of(database, solver)
    networks = learn(samples, seeds=1, batches=600, hidden=(96, 96))
    near = Local(LocalRegression(LISTENED), Cells(Segments.of(database, 2, 2, points.joints, offsets=points.offsets)), 20)
    ours = Ours(Method(Fused((Expectation(networks, LostPoints.of(samples), DT), near)), solver))
    return Turning(ours, Starts.of(database, points), contacts(database))


@pytest.fixture(scope="module")
def performance(database):
    """Frames and tracks of a take somewhere in the world, its joints and their orientations."""
    take = database.takes[2]
    frames = np.asarray(database.frames[take.start:take.stop], float)
    tracks = _tracks(frames, np.array([3.0, -2.0, 1.0]))
    return frames, tracks, *forward_kinematics(SKELETON, *decode(frames, tracks))


def _tracks(frames, first):
    tracks = [first]
    for frame in frames[1:]:
        tracks.append(advance(tracks[-1], frame, DT))
    return np.array(tracks)


def run(method, performance, points, turns, count=60):
    """Poses of so many frames after the half second that is given."""
    memory, poses = method.begin(performance[0][:SPAN], performance[1][:SPAN]), []
    for now in range(SPAN, SPAN + count):
        memory, pose = method.step(memory, points[now], None if turns is None else turns[now])
        poses.append(pose)
    return np.stack([pose.root for pose in poses]), np.stack([pose.rotations for pose in poses])


def trackers(performance):
    return performance[2][:, CONTROLS.joints], performance[3][:, CONTROLS.joints]


def away(found, truth):
    """Angles [rad] between orientations."""
    return Rotation.from_matrix((np.swapaxes(found, -1, -2) @ truth).reshape(-1, 3, 3)).magnitude().reshape(found.shape[:-2])


@settings(max_examples=20)
@given(st.integers(0, 2**32 - 1))
def test_virtual_points_are_where_the_body_has_them(seed):
    """Told by trackers, on their joints or beside them, as by the skeleton; and without a turn, the places alone are known."""
    rng = np.random.default_rng(seed)
    controls = replace(CONTROLS, offsets=rng.normal(size=(3, 3)) * 0.1)
    body = forward_kinematics(SKELETON, rng.normal(size=3), exp(rng.normal(size=(len(SKELETON), 3))))
    points, turns = controls.on(*body), body[1][controls.joints]
    assert np.allclose(carried(points, turns), virtual(controls).on(*body))
    turns[1] = np.nan
    assert np.array_equal(np.isfinite(carried(points, turns)).all(-1).reshape(3, 3).sum(-1), [3, 1, 3])


def test_the_search_looks_for_points_beside_joints_where_they_are(database, performance):
    """A query of a recorded moment is no way from that moment."""
    points = virtual(CONTROLS)
    segments = Segments.of(database, 2, 2, points.joints, offsets=points.offsets)
    frames, tracks, positions, orientations = performance
    places, at = points.on(positions, orientations), 40
    query = segments.query(frames[[at, at - 2]], places[at + 1], places[at], tracks[at])
    which = np.flatnonzero(segments.last == database.takes[2].start + at)
    assert segments.squared_distances(query, which)[0] < 1e-6


def test_turns_are_met(method, performance):
    """Head and hands within 4° on the average; told nothing of turns, they are farther off."""
    points, turns = trackers(performance)
    there = turns[SPAN:SPAN + 60]
    told, untold = (away(forward_kinematics(SKELETON, *run(method, performance, points, some))[1][:, CONTROLS.joints], there).mean()
                    for some in (turns, None))
    assert told < np.radians(4.0) and told < 0.7 * untold


def test_trackers_that_turn_on_turn_the_body(method, performance):
    """By 20° more about the head's own axis of nodding: so does the head, most of the way."""
    points, turns = trackers(performance)
    more = turns.copy()
    more[:, 0] = turns[:, 0] @ exp(np.array([np.radians(20.0), 0.0, 0.0]))
    found = [forward_kinematics(SKELETON, *run(method, performance, points, some))[1][20:, CONTROLS.joints[0]] for some in (turns, more)]
    turned = away(*found)
    assert np.radians(12.0) < turned.mean() < np.radians(24.0)


def test_poses_turn_with_the_world(method, performance):
    points, turns = trackers(performance)
    turn, aside = yaw(1.2), np.array([4.0, 0.0, -1.0])
    root, rotations = run(method, performance, points, turns, 20)
    moved = performance[1].copy()
    x, z = (performance[1][:, [0]], performance[1][:, [1]])
    spot = np.concatenate([x, 0 * x, z], -1) @ turn.T + aside
    moved[:, 0], moved[:, 1], moved[:, 2] = spot[:, 0], spot[:, 2], moved[:, 2] + 1.2
    there, turned = run(method, (performance[0], moved), points @ turn.T + aside, turn @ turns, 20)
    assert np.abs(there - (root @ turn.T + aside)).max() < 1e-3
    assert np.abs(turned[:, 1:] - rotations[:, 1:]).max() < 1e-3


def test_it_begins_from_nothing(method, performance):
    """From the recorded moment that is placed and turned so, wherever in the world."""
    points, turns = trackers(performance)
    frames, tracks = method.find(points[50], None, turns[50])
    assert frames.shape[-1] == WIDTH and np.allclose(decode(frames[-1], tracks[-1])[0], performance[2][50, 0], atol=0.05)


def test_soles_stand_where_those_of_most_neighbours_do(method, performance):
    """All neighbours' soles said to stand, no held sole moves while the body goes on; none said to, nothing is held."""
    points, turns = trackers(performance)
    soles = []
    for stands in (True, False):
        told, held = replace(method, contacts=np.full_like(method.contacts, stands)), []
        memory, shown = told.begin(performance[0][:SPAN], performance[1][:SPAN]), []
        for now in range(SPAN, SPAN + 40):
            memory, _ = told.step(memory, points[now], turns[now])
            held.append(memory.feet.held)
            shown.append(memory.feet.points)
        moved = np.linalg.norm(np.diff(np.array(shown)[..., [0, 2]], axis=0), axis=-1)
        soles.append((np.array(held), moved))
    (held, moved), (free, _) = soles
    assert held.any() and not free.any()
    both = (held[1:] & held[:-1])[:, 1::2]
    assert np.median(moved[:, 1::2][both]) < 0.001
