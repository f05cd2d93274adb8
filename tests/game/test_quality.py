"""The quality meter against motions whose faults are known."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gambol.controllers.body import forward_kinematics, human
from gambol.controllers.body.rotations import yaw
from gambol.controllers.contract import Intent
from gambol.controllers.locomotion import Locomotion
from gambol.game.explain.quality import Quality, measure, running
from gambol.game.world.world import DT

HUMAN = human()
NATURAL = {"walk": np.full(len(HUMAN), 10.0), "run": np.full(len(HUMAN), 40.0)}


def standing(moved):
    """A T-pose that stands on the floor and is moved as a whole by (N, 3) [m]."""
    moved = np.asarray(moved, float)
    rotations = np.broadcast_to(np.eye(3), (len(moved), len(HUMAN), 3, 3))
    return forward_kinematics(HUMAN, moved + [0.0, HUMAN.offsets[0, 1], 0.0], rotations)


def slide(speed, frames=61):
    return np.arange(frames)[:, None] * DT * np.array([speed, 0.0, 0.0])


def test_who_stands_still_is_faultless():
    q = measure(HUMAN, *standing(np.zeros((60, 3))), DT, NATURAL)
    assert q.stances == 4 and q.drift == q.worst_drift == q.skate == 0.0 and q.acceleration == 0.0
    assert q.sunk < 1e-9 and q.contacts == 4 * 59 and q.seconds == pytest.approx(1.0)


def test_a_slide_is_measured_as_far_as_it_goes():
    q = measure(HUMAN, *standing(slide(0.3)), DT)
    assert q.skate == 1.0 and q.drift == pytest.approx(0.3 * 59 * DT) and q.worst_drift == pytest.approx(q.drift)
    assert measure(HUMAN, *standing(slide(0.15)), DT).skate == 0.0


def test_feet_in_the_floor_are_measured_as_deep_as_they_are():
    assert measure(HUMAN, *standing(np.full((9, 3), [0.0, -0.013, 0.0])), DT).sunk == pytest.approx(0.013)


def test_what_is_in_the_air_stands_on_nothing():
    q = measure(HUMAN, *standing(slide(0.3) + [0.0, 0.1, 0.0]), DT)
    assert q.contacts == q.stances == 0 and q.skate == q.drift == q.sunk == 0.0


def test_accelerations_are_those_of_the_path_over_the_natural_ones():
    """A parabola has one acceleration, at whatever frames it is looked at."""
    times = np.arange(31) * DT
    q = measure(HUMAN, *standing(0.5 * 6.0 * times[:, None] ** 2 * [1.0, 0.0, 0.0] * 0.5), DT, NATURAL)
    assert q.acceleration == pytest.approx(3.0 / 10.0, rel=1e-6) and q.joint in HUMAN.names
    assert math.isnan(measure(HUMAN, *standing(slide(0.1)), DT).acceleration)


def test_a_single_joints_jerk_is_found():
    positions, orientations = standing(np.zeros((40, 3)))
    positions[20, HUMAN.index("Head")] += [0.0, 0.02, 0.0]
    q = measure(HUMAN, positions, orientations, DT, NATURAL)
    assert q.joint == "Head" and q.acceleration == pytest.approx(2 * 0.02 * 30**2 / 10.0)


def test_a_runner_is_told_by_speed_alone():
    assert not running(slide(1.5), DT).any() and running(slide(2.5), DT).all()


@settings(max_examples=15, deadline=None)
@given(st.floats(-math.pi, math.pi), st.floats(-50, 50), st.floats(-50, 50))
def test_where_and_which_way_one_walks_changes_nothing(heading, x, z):
    positions, orientations = WALK
    turn = yaw(np.array(heading))
    there = measure(HUMAN, positions @ turn.T + [x, 0.0, z], turn @ orientations, DT, NATURAL)
    here = measure(HUMAN, positions, orientations, DT, NATURAL)
    assert there.contacts == here.contacts and there.stances == here.stances and there.joint == here.joint
    for name in ("drift", "worst_drift", "skate", "sunk", "acceleration"):
        assert getattr(there, name) == pytest.approx(getattr(here, name), abs=1e-6)


def walked(seconds=4.0):
    """The shipped library walking: positions and orientations."""
    locomotion = Locomotion.load()
    state, poses = locomotion.start(), []
    for _ in range(round(seconds / DT)):
        state, pose = locomotion.step(state, Intent(np.array([1.2, 0.0, 0.0])), DT)
        poses.append(pose)
    return forward_kinematics(HUMAN, np.array([p.root for p in poses], float), np.array([p.rotations for p in poses], float))


WALK = walked()


def test_a_held_foot_is_better_than_the_same_walk_sliding():
    """A treadmill that pulls everything along by 0.25 m/s makes every stance drift."""
    positions, orientations = WALK
    good = measure(HUMAN, positions, orientations, DT)
    bad = measure(HUMAN, positions + slide(0.25, len(positions))[:, None], orientations, DT)
    assert good.stances >= 10 and good.drift < 0.005 and good.skate < 0.02
    assert bad.skate > 0.9 and bad.drift > 5 * good.drift


def test_two_halves_make_a_whole():
    positions, orientations = WALK
    half = len(positions) // 2
    parts = [measure(HUMAN, positions[s], orientations[s], DT, NATURAL) for s in (slice(half), slice(half, None))]
    both = parts[0].merged(parts[1])
    assert both.stances == sum(p.stances for p in parts) and both.seconds == pytest.approx(len(positions) * DT)
    assert both.worst_drift == max(p.worst_drift for p in parts)
    assert both.drift * both.stances == pytest.approx(sum(p.drift * p.stances for p in parts))
    assert both.acceleration == max(p.acceleration for p in parts)
    for one in parts:
        for sum_ in (Quality().merged(one), one.merged(Quality())):
            assert dataclasses.astuple(sum_) == pytest.approx(dataclasses.astuple(one))


@pytest.mark.parametrize("frames", range(5))
def test_clips_too_short_to_tell_give_no_nonsense(frames):
    q = measure(HUMAN, *standing(np.zeros((frames, 3))), DT, NATURAL)
    assert q.drift == q.skate == 0.0 and (math.isnan(q.acceleration) or q.acceleration == 0.0)


def test_what_does_not_fit_is_refused():
    positions, orientations = standing(np.zeros((9, 3)))
    for wrong in ((positions[:, :5], orientations, DT), (positions, orientations[..., 0], DT), (positions, orientations, 0.0)):
        with pytest.raises(ValueError, match="22 joints"):
            measure(HUMAN, *wrong)
