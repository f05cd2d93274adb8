"""Features: the same wherever a motion happens, and of a recording what they are of a performance."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gambol.controllers.body import forward_kinematics
from gambol.controllers.body.rotations import yaw
from gambol.controllers.reconstruction import pose_vector as chart
from gambol.controllers.reconstruction.database.database import DatabaseError
from gambol.controllers.reconstruction.neighbours.features import Weights, of_points, places
from gambol.controllers.reconstruction.neighbours.segments import Segments
from trajectories import database

JOINTS = tuple(chart.SKELETON.index(name) for name in ("Hips", "Head", "LeftHand", "RightHand", "LeftFoot", "RightToe"))
seeds = st.integers(0, 2**32 - 1)


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    return database(tmp_path_factory.mktemp("db") / "a", takes=6, count=60)


@settings(max_examples=30)
@given(seeds, st.floats(-3, 3), st.floats(-1e4, 1e4))
def test_points_know_neither_place_nor_heading(seed, turn, away):
    rng = np.random.default_rng(seed)
    now, before, track = rng.normal(0, 1, (3, 2, 3)), rng.normal(0, 1, (3, 2, 3)), rng.normal(0, 1, (3, 3))
    aside = np.array([away, 0.0, -2 * away])
    moved = track.copy()
    moved[:, [0, 1]] = (np.stack([track[:, 0], np.zeros(3), track[:, 1]], -1) @ yaw(turn).T + aside)[:, [0, 2]]
    moved[:, 2] += turn
    here = of_points(now, before, track, 1 / 60)
    there = of_points(now @ yaw(turn).T + aside, before @ yaw(turn).T + aside, moved, 1 / 60)
    assert np.allclose(here, there, atol=1e-4)


def test_places_are_those_of_forward_kinematics(made):
    frames = np.array(made.frames[::7])
    positions, _ = forward_kinematics(chart.SKELETON, *chart.decode(frames, np.zeros((len(frames), 3))))
    assert np.allclose(places(frames, JOINTS), positions[:, JOINTS], atol=1e-5)
    assert places(frames, ()).shape == (len(frames), 0, 3)


@settings(max_examples=20, deadline=None)
@given(seed=seeds)
def test_a_recording_played_anywhere_finds_itself(made, seed):
    """The query made of world positions equals the features that the database has of the same segment."""
    rng = np.random.default_rng(seed)
    segments = Segments.of(made, 3, 2, JOINTS)
    which = int(rng.integers(len(segments)))
    last = segments.last[which]
    track = np.array([*rng.uniform(-100, 100, 2), rng.uniform(-3, 3)])
    ahead = chart.advance(track, made.frames[last + 1], 1 / made.fps)
    before, _ = forward_kinematics(chart.SKELETON, *chart.decode(made.frames[last], track))
    now, _ = forward_kinematics(chart.SKELETON, *chart.decode(made.frames[last + 1], ahead))
    query = segments.query(made.frames[last - 2 * np.arange(3)], now[list(JOINTS)], before[list(JOINTS)], track)
    assert query.shape == (segments.width,) and query.dtype == np.float32
    assert np.allclose(query, segments.features(np.array([which]))[0], atol=2e-4)
    assert np.array_equal(segments.targets(np.array([which]))[0], made.frames[last + 1])
    with pytest.raises(ValueError, match="6 control points"):
        segments.query(made.frames[last - 2 * np.arange(3)])


def test_every_weight_weighs_what_it_says(made):
    """A difference of one unit in a column counts as much as that column's weight."""
    weights = Weights(angles=1.0, height=2.0, tilt=3.0, yaw_rate=4.0, velocity=5.0)
    expected = dict.fromkeys(range(chart.ANGLES), 1.0) | {
        chart.HEIGHT: 2.0, chart.PITCH: 3.0, chart.ROLL: 3.0, chart.YAW_RATE: 4.0, chart.FORWARD: 5.0, chart.LEFTWARD: 5.0}
    assert dict(enumerate(weights.columns)) == expected
    segments = Segments.of(made, 2, 1, (), weights)
    past = made.frames[segments.last[5] - np.arange(2)]
    for column in (0, *range(chart.ANGLES, chart.WIDTH)):
        off = np.array(past)
        off[1, column] += 1.0
        squared = segments.squared_distances(segments.query(off), np.array([5]))[0]
        assert squared == pytest.approx(expected[column] ** 2, rel=1e-4)


def test_a_database_of_nothing_long_enough(tmp_path):
    with pytest.raises(DatabaseError, match="no sound take of 22 frames or more"):
        Segments.of(database(tmp_path / "a", takes=2, count=20), 3, 10)
