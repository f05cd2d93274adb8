"""Arms are drawn in where they would brush what is passed closely, and only there."""

import numpy as np
import pytest

from gambol.controllers.body import Pose, end_positions, exp, forward_kinematics
from gambol.controllers.contract import Intent
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.navigation import gap
from gambol.controllers.navigation.passing import drawn_in, drawn_on
from gambol.controllers.supervisor import Supervisor
from gambol.game.scene import Box, Pillar
from gambol.game.world import stopped

@pytest.fixture(scope="module")
def locomotion():
    """Who walks."""
    return Locomotion.load()


BESIDE = 0.30
"""So far from a wall [m] hands swing into it."""
BONES = ("LeftArm", "LeftForeArm", "LeftHand", "RightArm", "RightForeArm", "RightHand")


def arms(skeleton, pose):
    """Shoulders, elbows and wrists (6, 3) [m]."""
    return forward_kinematics(skeleton, pose.root, pose.rotations)[0][[skeleton.index(name) for name in BONES]]


def walk(locomotion, velocity, around, seconds=5.0):
    """Poses and ground frames of somebody who walks so, with what he is told that stands about."""
    someone = Supervisor({"locomotion": locomotion})
    state, made = someone.start(), []
    for _ in range(round(60 * seconds)):
        state, pose = someone.step(state, Intent(np.array(velocity), around=around), 1 / 60)
        made.append((pose, state.ground))
    return made


def by_a_wall(locomotion, velocity):
    """Places of arms and how far they are from a wall beside somebody who walks on his way so (T, 6, 3), (T, 6), where he knows of it and where he does
    not: along the wall if he goes straight, turning beside it if he turns on the spot."""
    wall = Box((-BESIDE - 0.1, 1.0, 0.0), (0.2, 2.0, 40.0))
    places = [np.array([arms(locomotion.skeleton, pose) for pose, _ in walk(locomotion, velocity, around)]) for around in ((wall,), ())]
    return [(one, gap(one.reshape(-1, 3), wall).reshape(one.shape[:2])) for one in places]


@pytest.mark.few(1)
@pytest.mark.parametrize("velocity", [(1.3, 0.0, 0.0), (0.0, 2.5, 0.0), (0.0, -2.5, 0.0)])
def test_arms_keep_out_of_a_wall(locomotion, velocity):
    (_, kept), (_, brushed) = by_a_wall(locomotion, velocity)
    assert kept[:, [1, 2, 4, 5]].min() > 0.045
    assert brushed.min() < 0.035  # a forearm is as thick


def test_they_come_in_smoothly(locomotion):
    (near, _), (free, _) = by_a_wall(locomotion, (0.0, 2.5, 0.0))
    jerk, own = (np.abs(np.diff(one, n=2, axis=0)).max() * 3600.0 for one in (near, free))
    assert np.abs(near - free).max() > 0.03
    assert jerk < 1.5 * own


def test_an_arm_turns_farther_back_from_a_table_ahead_than_to_the_trunk(locomotion):
    """Hands swing ahead of who comes up to a table."""
    most = 0.0
    for pose, ground in walk(locomotion, (1.8, 0.0, 0.0), (), 2.5)[90:]:
        drawn = drawn_in(locomotion.skeleton, pose, ground, [Box((float(ground[0]), 0.5, float(ground[1]) + 0.6), (4.0, 1.0, 0.8))])
        turn = np.einsum("jik,jil->jkl", pose.rotations, drawn.rotations)
        most = max(most, float(np.arccos(np.clip((np.trace(turn, axis1=1, axis2=2) - 1.0) / 2.0, -1.0, 1.0)).max()))
    assert 0.37 < most < 0.9


def test_forearms_keep_out_where_an_elbow_is_right_over_a_table(locomotion):
    table = Box((-0.25 - 0.4, 0.5, 0.0), (0.8, 1.0, 40.0))
    places = np.array([arms(locomotion.skeleton, pose) for pose, _ in walk(locomotion, (1.8, 0.0, 0.0), (table,))])
    forearms = places[:, [4]] + np.linspace(0.0, 1.0, 5)[:, None] * (places[:, [5]] - places[:, [4]])
    assert gap(forearms.reshape(-1, 3), table).min() > 0.035


@pytest.mark.few(1)
@pytest.mark.parametrize("velocity, table", [((1.8, 0.0, 0.0), Box((-0.25 - 0.4, 0.55, 0.0), (0.8, 1.1, 40.0))), ((0.7, 0.0, 0.0), Box((0.0, 0.35, 2.4), (4.0, 0.7, 0.8)))])
def test_hands_keep_out_to_their_finger_tips(locomotion, velocity, table):
    """Past a table and up to one: hands hang bent, not straight on from forearms."""
    skeleton, someone = locomotion.skeleton, Supervisor({"locomotion": locomotion})
    state, deep = someone.start(), []
    for _ in range(5 * 60):
        intent = stopped(state, Intent(np.array(velocity), around=(table,)), (table,))
        state, pose = someone.step(state, intent, 1 / 60)
        placed = forward_kinematics(skeleton, pose.root, pose.rotations)
        tips = end_positions(skeleton, *placed)[[skeleton.end_index[name] for name in ("LeftHand", "RightHand")]]
        deep.append(0.03 - gap(tips, table).min())
    assert max(deep) < 0.01


def test_between_two_walls_both_do(locomotion):
    walls = [Box((side * 0.42, 1.0, 0.0), (0.2, 2.0, 40.0)) for side in (-1.0, 1.0)]
    places = np.array([arms(locomotion.skeleton, pose) for pose, _ in walk(locomotion, (1.2, 0.0, 0.0), walls)])
    assert min(gap(places[:, [1, 2, 4, 5]].reshape(-1, 3), wall).min() for wall in walls) > 0.04


def test_where_nothing_is_near_a_pose_stays_itself(locomotion):
    state = locomotion.start()
    low, far, high = Box((0.4, 0.1, 0.0), (0.2, 0.2, 2.0)), Pillar((3.0, 0.0, 0.0), 0.3, 2.0), Box((0.4, 2.6, 0.0), (0.2, 0.4, 2.0))
    assert drawn_in(locomotion.skeleton, state.pose, state.ground, [low, far, high]) is state.pose
    inside = Box((0.0, 1.0, 0.0), (2.0, 2.0, 2.0))
    assert drawn_in(locomotion.skeleton, state.pose, state.ground, [inside]) is state.pose


def test_no_farther_than_to_the_trunk(locomotion):
    """However near something is an arm turns no more than a shoulder lets it, and stays a rotation."""
    state = locomotion.start()
    for far in np.linspace(0.01, 0.4, 20):
        pose = drawn_in(locomotion.skeleton, state.pose, state.ground, [Box((far + 0.1, 1.0, 0.0), (0.2, 2.0, 2.0))])
        turn = np.einsum("jik,jil->jkl", state.pose.rotations, pose.rotations)
        assert np.arccos(np.clip((np.trace(turn, axis1=1, axis2=2) - 1.0) / 2.0, -1.0, 1.0)).max() < 0.36
        assert np.abs(np.einsum("jik,jil->jkl", pose.rotations, pose.rotations) - np.eye(3)).max() < 1e-5


@pytest.mark.few(1)
@pytest.mark.parametrize("velocity, most", [((1.3, 0.0, 0.0), 60.0), ((0.0, 2.5, 0.0), 160.0)])
def test_no_arm_jumps_where_a_wall_comes_and_goes(locomotion, velocity, most):
    """Wherever arms are as he walks, or turns on the spot."""
    someone, wall = Supervisor({"locomotion": locomotion}), Box((-BESIDE - 0.05, 1.0, 0.0), (0.2, 2.0, 40.0))
    state, places = someone.start(), []
    for n in range(400):
        around = (wall,) if n > 90 and n // 11 % 2 else ()
        state, pose = someone.step(state, Intent(np.array(velocity), around=around), 1 / 60)
        places.append(arms(locomotion.skeleton, pose))
    free = np.array([arms(locomotion.skeleton, pose) for pose, _ in walk(locomotion, velocity, (), 400 / 60)])
    assert np.abs(np.array(places) - free).max() > 0.03
    assert np.linalg.norm(np.diff(places, n=2, axis=0), axis=-1)[90:].max() * 3600.0 < most


def test_arms_stay_calm_before_a_wall(locomotion):
    """Recorded idling lifts hands, for which there is no room; it goes on where there is."""
    someone = Supervisor({"locomotion": locomotion})
    lifted = []
    for around in ((Box((0.0, 1.0, 0.37), (8.0, 2.0, 0.2)),), ()):
        state, places = someone.start(), []
        for _ in range(60 * 25):
            state, pose = someone.step(state, Intent(np.zeros(3), around=around), 1 / 60)
            places.append(arms(locomotion.skeleton, pose))
        places = np.array(places)[60:]
        lifted.append(np.ptp(places[..., 1], axis=0).max())
        assert np.linalg.norm(np.diff(places, n=2, axis=0), axis=-1).max() * 3600.0 < 60.0
    assert 0.005 < lifted[0] < 0.5 * lifted[1]


def test_arms_come_in_as_fast_as_a_runner_comes_to_a_wall(locomotion):
    """Who landed right before a wall at a run had his fingers up to 14 cm in it: arms came in as slowly as beside what has just come about."""
    wall, start = Box((0.0, 1.0, 0.75), (4.0, 2.0, 0.3)), locomotion.start().pose
    skeleton, rotations = locomotion.skeleton, start.rotations.copy()
    for side in ("Left", "Right"):
        rotations[skeleton.index(side + "Arm")] = exp(np.array([-0.7, 0.0, 0.0])) @ rotations[skeleton.index(side + "Arm")]
    deep = {}
    for speed in (0.0, 3.0):
        arms, found = None, []
        for far in np.arange(0.0, 0.4, 0.05):
            ahead = Pose(start.root + np.array([0.0, 0.0, far], np.float32), rotations)
            shown, arms = drawn_on(skeleton, ahead, np.array([0.0, far, 0.0]), [wall], arms, speed, 1 / 60)
            tips = end_positions(skeleton, *forward_kinematics(skeleton, shown.root, shown.rotations))
            found.append(max(tips[skeleton.end_index[side + "Hand"], 2] - 0.6 for side in ("Left", "Right")))
        deep[speed] = max(found)
    assert max(deep.values()) < 0.0, deep
