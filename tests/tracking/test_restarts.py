"""Arms that were lost are looked for as people hold them: an elbow folded into its own upper arm, a forearm in the trunk."""

from dataclasses import replace

import numpy as np
import pytest
from bodies import cameras, masks, stick_body

from gambol.controllers.body import forward_kinematics
from gambol.controllers.contract import CharacterState, Intent, Sighting
from gambol.controllers.tracking import Tracker, TrackerSettings, Tracking
from gambol.controllers.tracking.pose import Doubt, held
from gambol.controllers.tracking.pose.restarts import BOTH, FOLDED, HANGING, RESTS, WAYS
from gambol.controllers.tracking.twists import Configuration, local_turns, posed

BODY = stick_body("full")
CHAIN = BODY.chain
RATE = 30.0
HANDS = [CHAIN.skeleton.index(name) for name in ("LeftHand", "RightHand")]


def lost(where):
    """Both forearms folded into upper arms that lie across the trunk: what silhouettes show least."""
    angles = held(CHAIN, where, WAYS.index((BOTH, FOLDED))).angles.copy()
    for side, sign in (("Left", -1.0), ("Right", 1.0)):
        angles[CHAIN.names.index(f"{side}ForeArm.y")] = 2.9 * sign
    return Configuration(where.root, angles)


def off(where, truth):
    """How far hands are off [m]."""
    return np.linalg.norm((posed(CHAIN, where)[0] - posed(CHAIN, truth)[0])[HANDS], axis=-1)


def hands_of(pose):
    """Where a pose's hands are (2, 3) [m]."""
    return forward_kinematics(CHAIN.skeleton, pose.root, np.asarray(pose.rotations, float))[0][HANDS]


@pytest.fixture(scope="module")
def standing():
    """Somebody who stands with arms that hang a little off the trunk, in silhouettes."""
    pose = held(CHAIN, CHAIN.rest(), WAYS.index((BOTH, HANGING)))
    angles = pose.angles.copy()
    for side, sign in (("Left", 1.0), ("Right", -1.0)):
        angles[CHAIN.names.index(f"{side}Arm.z")] += 0.1 * sign
        angles[CHAIN.names.index(f"{side}ForeArm.y")] -= 0.2 * sign
    pose = Configuration(pose.root, angles)
    return pose, masks(BODY, pose, cameras())


def followed(standing, settings, frames):
    """Tracks of so many frames after arms were lost, as after being folded."""
    pose, seen = standing
    tracker, tracks = Tracker(BODY, cameras(), RATE, settings), []
    track = tracker.start(pose)
    for _ in range(4):
        track = tracker.step(track, seen)
    assert off(track.now, pose).max() < 0.03
    track = replace(track, now=lost(track.now), before=lost(track.now))
    for _ in range(frames):
        tracks.append(track := tracker.step(track, seen))
    return tracks


def test_lost_arms_are_found(standing):
    """In half a second, where without that they are not."""
    without, found = (followed(standing, TrackerSettings(carriage=100.0, restarts=again), 15) for again in (False, True))
    assert off(without[-1].now, standing[0]).min() > 0.2 and not any(track.restarted for track in without)
    assert off(found[-1].now, standing[0]).max() < 0.05 and any(track.restarted for track in found)


def test_who_is_followed_well_is_not_looked_for(standing):
    pose, seen = standing
    tracker = Tracker(BODY, cameras(), RATE, TrackerSettings(restarts=True))
    track = tracker.start(pose)
    for _ in range(4):
        track = tracker.step(track, seen)
        assert track.doubt.way is None and not track.restarted


def test_found_arms_do_not_jump(standing):
    """The body that is moved takes its arms to where they were found; a track's own pose is there at once."""
    pose, seen = standing
    controller = Tracking(Tracker(BODY, cameras(), RATE, TrackerSettings(carriage=100.0, restarts=True)))
    shown = local_turns(CHAIN, pose)
    state = controller.enter(CharacterState(np.zeros(3), np.zeros(3), shown, np.zeros(4, bool), None, 0.0, shown, 1 / RATE), Intent())
    for _ in range(4):
        state, _ = controller.step(state, Intent(sighting=Sighting(seen, np.zeros(3))), 1 / RATE)
    track = state.memory.track
    state = replace(state, memory=replace(state.memory, track=replace(track, now=lost(track.now), before=lost(track.now))))
    state, before = controller.step(state, Intent(), 1 / RATE)
    found = []
    for _ in range(30):
        state, after = controller.step(state, Intent(sighting=Sighting(seen, np.zeros(3))), 1 / RATE)
        if state.memory.track.restarted:
            found.append(np.linalg.norm(hands_of(before) - hands_of(after), axis=-1).max())
        before = after
    assert found and max(found) < 0.03
    assert np.linalg.norm(hands_of(before) - posed(CHAIN, pose)[0][HANDS], axis=-1).max() < 0.06


def test_doubt_tries_each_way_once_and_rests():
    doubt = Doubt()
    for _ in range(10):
        doubt = doubt.after(0.8, RATE)
        assert doubt.way is None
    ways = []
    for _ in range(20 + len(WAYS)):
        doubt = doubt.after(1.6, RATE)
        ways.append(doubt.way)
    first = ways.index(0)
    assert ways[first:first + len(WAYS)] == list(range(len(WAYS))) and first > 0
    assert ways[first + len(WAYS):first + len(WAYS) + round(RESTS * RATE)] == [None] * round(RESTS * RATE)
    for _ in range(30):
        doubt = doubt.after(0.8, RATE)
    assert doubt.way is None and doubt.mended(0.5).now == 0.5


def test_arms_are_held_alike_on_both_sides():
    where = CHAIN.rest()
    for way, (sides, _) in enumerate(WAYS):
        positions = posed(CHAIN, held(CHAIN, where, way))[0]
        if sides == BOTH:
            np.testing.assert_allclose(positions[HANDS[0]], positions[HANDS[1]] * (-1, 1, 1), atol=1e-6)
        assert (np.linalg.norm(positions - posed(CHAIN, where)[0], axis=-1)[HANDS] > 0.2).sum() == len(sides)
