"""Tracking under the contract: a body goes where pictures show somebody go, wherever cameras are, frame by frame and between them."""

from dataclasses import replace

import numpy as np
import pytest
from bodies import cameras, masks, stick_body, stride

from gambol.controllers.body import Pose, human
from gambol.controllers.contract import CharacterState, Intent, Sighting
from gambol.controllers.tracking import Tracker, Tracking, Watching
from gambol.controllers.tracking.twists import local_turns, posed

BODY = stick_body()
STEP = 1 / 60


def pose(time):
    return stride(BODY.chain, time)


def standing(time, beside=(0.0, 0.0, 0.0)):
    made, before = (local_turns(BODY.chain, pose(t)) for t in (time, time - STEP))
    moved = Pose(made.root + beside, made.rotations)
    return CharacterState(np.zeros(3), np.zeros(3), moved, np.zeros(4, bool), None, 0.0, Pose(before.root + beside, before.rotations), STEP)


def seen(time, place=(0.0, 0.0, 0.0)):
    return Sighting(masks(BODY, pose(time), cameras()), np.array(place))


def off(state, time, beside=(0.0, 0.0, 0.0)):
    now = local_turns(BODY.chain, pose(time))
    from gambol.controllers.body import forward_kinematics

    one, other = (forward_kinematics(BODY.chain.skeleton, p.root, np.asarray(p.rotations, float))[0] for p in (state.pose, now))
    return np.linalg.norm(one - other - beside, axis=-1)


@pytest.mark.parametrize("beside, place", [((0, 0, 0), (0, 0, 0)), ((1.5, 0, -0.5), (20.0, 0, 7.0))])
def test_a_body_goes_where_it_is_seen_to_go(beside, place):
    """Beside whom it is like, and with cameras that have gone along to somewhere else."""
    controller = Tracking(Tracker(BODY, cameras(), 60.0), beside)
    away = np.array(beside, float) + place
    state = controller.enter(standing(0.0, away), Intent())
    if np.any(place):
        assert controller.precondition(standing(0.0), Intent(sighting=seen(0.0))) == 1.0 and controller.precondition(standing(0.0), Intent()) == 0.0
    for k in range(1, 7):
        state, made = controller.step(state, Intent(sighting=seen(k * STEP, place)), STEP)
        assert made is state.pose
    assert off(state, 6 * STEP, away).mean() < 0.02 < off(state, 0.0, away).max()
    assert controller.status(state).kind == "running" and controller.precondition(state, Intent()) > 1.0


def test_between_two_frames_it_is_on_its_way():
    """At half the world's rate the body is a step late at most, and halfway at the step that sees."""
    controller = Tracking(Tracker(BODY, cameras(), 30.0))
    state = controller.enter(standing(0.0), Intent())
    for k in range(1, 9):
        state, _ = controller.step(state, Intent(sighting=seen(k * STEP) if k % 2 == 0 else None), STEP)
        if k == 7:
            assert off(state, 6 * STEP).mean() < 0.02
    watching = state.memory
    before, now = (posed(BODY.chain, one)[0][0] for one in (watching.track.before, watching.track.now))
    np.testing.assert_allclose(state.pose.root, 0.5 * (before + now), atol=1e-9)


def test_without_pictures_it_stays_and_is_done_after_a_while():
    controller = Tracking(Tracker(BODY, cameras(), 60.0))
    state = controller.enter(standing(0.0), Intent())
    for _ in range(28):
        state, _ = controller.step(state, Intent(), STEP)
    assert controller.status(state).kind == "running"
    for _ in range(2):
        state, _ = controller.step(state, Intent(), STEP)
    assert controller.status(state).kind == "done" and off(state, 0.0).max() < 1e-6
    assert controller.enter(state, Intent()) is state


def test_taking_over_does_not_jump():
    """A pose that the chain can't have: the difference fades."""
    state = standing(0.0)
    bent = state.pose.rotations.copy()
    spine = human().index("Spine")
    bent[spine] = bent[spine] @ np.array([[1, 0, 0], [0, np.cos(0.3), -np.sin(0.3)], [0, np.sin(0.3), np.cos(0.3)]])
    state = replace(state, pose=Pose(state.pose.root, bent))
    controller = Tracking(Tracker(BODY, cameras(), 60.0))
    entered = controller.enter(state, Intent())
    after, _ = controller.step(entered, Intent(), 1e-4)
    np.testing.assert_allclose(after.pose.rotations, bent, atol=0.01)
    for _ in range(60):
        after, _ = controller.step(after, Intent(), STEP)
    assert np.abs(after.pose.rotations - bent).max() > 0.2


def test_settings_and_misuse():
    controller = Tracking(Tracker(BODY, cameras(), 60.0))
    other = controller.tuned(replace(controller.settings, penalty=False))
    assert controller.settings.penalty and not other.settings.penalty and controller.kind != other.kind
    with pytest.raises(ValueError, match="enter it first"):
        controller.step(standing(0.0), Intent(), STEP)
    assert isinstance(controller.enter(standing(0.0), Intent()).memory, Watching)
