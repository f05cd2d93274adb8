"""Taking over a body: its pose, its place, its feet and its motion as they were, then walking."""

from dataclasses import replace

import numpy as np
import pytest

from gambol.controllers.body import Pose, forward_kinematics
from gambol.controllers.body.rotations import exp, yaw
from gambol.controllers.contract import CharacterState, Intent
from playing import FPS


def someone(locomotion, at=(0.0, 0.0, 0.0), floor=0.0, pose=None, speed=0.0, moving=0.0):
    """A body that nobody knows yet, bent and with an arm up or posed as told, moving forward."""
    rest = locomotion.start(at, floor)
    if pose is None:
        local = np.array(rest.pose.rotations, float)
        local[locomotion.skeleton.index("Spine")] = exp(np.array([0.4, 0.0, 0.0])) @ local[locomotion.skeleton.index("Spine")]
        local[locomotion.skeleton.index("LeftArm")] = exp(np.array([-0.8, 0.0, 0.0])) @ local[locomotion.skeleton.index("LeftArm")]
        pose = Pose(np.asarray(rest.pose.root, float), local)
    before = Pose(pose.root - yaw(at[2])[:, 2] * moving / FPS, pose.rotations)
    return CharacterState(np.asarray(at, float), np.array([speed, 0.0, 0.0]), pose, np.ones(4, bool), None, floor, before, 1 / FPS)


def joints(locomotion, pose):
    return forward_kinematics(locomotion.skeleton, np.asarray(pose.root, float), np.asarray(pose.rotations, float))[0]


@pytest.mark.parametrize("at", [(0.0, 0.0, 0.0), (3.0, -2.0, 2.1), (-40.0, 7.0, -3.0)])
@pytest.mark.parametrize("floor", [0.0, 0.6])
def test_the_first_step_goes_on_with_the_pose_as_it_was(locomotion, at, floor):
    state = someone(locomotion, at, floor)
    entered = locomotion.enter(state, Intent())
    _, pose = locomotion.step(entered, Intent(), 1 / FPS)
    assert np.linalg.norm(joints(locomotion, pose) - joints(locomotion, state.pose), axis=-1).max() < 0.03
    assert entered.ground[2] == pytest.approx(at[2]) and entered.floor == floor


def test_hips_stay_where_they_were_as_somebody_is_taken_over_at_rest(locomotion):
    """Breath, which begins somewhere in its sway, moved them 3 mm aside at once."""
    state = someone(locomotion)
    _, pose = locomotion.step(locomotion.enter(state, Intent()), Intent(), 1e-4)
    assert np.abs(pose.root - state.pose.root).max() < 2e-4


def test_what_is_odd_about_the_pose_fades(locomotion):
    state = locomotion.enter(someone(locomotion), Intent())
    for _ in range(120):
        state, pose = locomotion.step(state, Intent(), 1 / FPS)
    rest = locomotion.start(state.ground).pose
    assert np.linalg.norm(joints(locomotion, pose) - joints(locomotion, rest), axis=-1).max() < 0.08


def test_who_moves_walks_on_and_who_stands_stands(locomotion):
    for speed, low, high in ((0.0, -0.1, 0.1), (1.2, 0.6, 1.7), (3.0, 1.8, 4.0)):
        state = locomotion.enter(someone(locomotion, speed=speed, moving=speed), Intent(np.array([speed, 0.0, 0.0])))
        start = state.ground.copy()
        for _ in range(FPS):
            state, pose = locomotion.step(state, Intent(np.array([speed, 0.0, 0.0])), 1 / FPS)
        assert low < state.ground[1] - start[1] < high
        assert np.isfinite(pose.rotations).all()


def test_feet_that_stand_stay_where_they_stand(locomotion):
    state = locomotion.enter(someone(locomotion), Intent())
    ball = [locomotion.skeleton.index(side + "Toe") for side in ("Left", "Right")]
    stood = joints(locomotion, state.pose)[ball][:, [0, 2]]
    for _ in range(30):
        state, pose = locomotion.step(state, Intent(), 1 / FPS)
        assert np.linalg.norm(joints(locomotion, pose)[ball][:, [0, 2]] - stood, axis=-1).max() < 0.03


def test_who_walked_already_is_left_alone_and_a_crowd_begins_anew(locomotion):
    state = locomotion.start()
    assert locomotion.enter(state, Intent()) is state
    crowd = locomotion.start(np.zeros((3, 3)))
    stranger = replace(crowd, memory=None)
    assert locomotion.enter(stranger, Intent()).memory.shape == (3,)


def test_taking_over_changes_nothing_of_what_is_taken_over(locomotion):
    state = someone(locomotion)
    before = state.pose.root.tobytes() + state.pose.rotations.tobytes() + state.ground.tobytes()
    locomotion.step(locomotion.enter(state, Intent()), Intent(), 1 / FPS)
    assert state.pose.root.tobytes() + state.pose.rotations.tobytes() + state.ground.tobytes() == before


def test_arms_of_who_walks_on_go_on_as_fast_as_they_went(locomotion):
    """Whoever is taken over in mid-stride moves as the gait does already: the gait's own movement is not added to that."""
    wish, hands, worst = Intent(np.array([1.3, 0.0, 0.0])), [locomotion.skeleton.index(side + "Hand") for side in ("Left", "Right")], 0.0
    state = locomotion.start()
    for k in range(160):
        before, (state, _) = state, locomotion.step(state, wish, 1 / FPS)
        if k > 100 and k % 6 == 0 and state.contacts.reshape(2, 2).any(1).sum() == 1:
            taken = locomotion.enter(replace(state, memory=None, previous=before.pose, elapsed=1 / FPS), wish)
            _, pose = locomotion.step(taken, wish, 1 / FPS)
            places = [joints(locomotion, one)[hands] - np.asarray(one.root, float) for one in (before.pose, state.pose, pose)]
            worst = max(worst, float(np.linalg.norm(np.diff(places, 2, axis=0), axis=-1).max()) * FPS)
    assert 0.0 < worst < 0.35, "m/s, of arms that swing at 1.3"
