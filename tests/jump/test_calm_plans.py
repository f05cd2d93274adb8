"""No plan throws a body about: neighbouring leaps move alike, and long flights do not carry the push's swing on."""

from dataclasses import replace

import numpy as np
import pytest

from gambol.controllers.body import forward_kinematics
from gambol.controllers.contract import Intent, Leap
from gambol.controllers.jump import Jump, Jumping
from gambol.controllers.locomotion import Locomotion

from conftest import ahead


def fastest(jump, made, *parts):
    """How fast [m/s] one of these joints moves at most."""
    times = np.arange(0.0, made.duration, 1 / 120)
    poses = [made.at(t) for t in times]
    places = forward_kinematics(jump.skeleton, np.stack([p.root for p in poses]), np.stack([p.rotations for p in poses]))[0]
    return float(np.linalg.norm(np.diff(places[:, [jump.skeleton.index(part) for part in parts]], axis=0), axis=-1).max() * 120)


@pytest.mark.few(1)
@pytest.mark.parametrize("aside", [0, 30, 60, 120, 180])
def test_a_standing_leap_a_little_farther_moves_hardly_otherwise(jump, standing, aside):
    way, found = np.radians(aside), []
    for far in np.arange(0.1, 1.0, 0.04):
        place = np.array([standing.ground[0] + far * np.sin(way), standing.floor, standing.ground[1] + far * np.cos(way)])
        made = jump.plan(standing, Intent(leap=Leap(place)))
        found.append((fastest(jump, made, "Head"), fastest(jump, made, "LeftLeg", "RightLeg", "LeftFoot", "RightFoot")))
    steps = np.array(found)
    assert (np.maximum(steps[1:] / steps[:-1], steps[:-1] / steps[1:]) < 1.25).all()
    assert steps[:, 0].max() < 3.2, "heads"


@pytest.mark.parametrize("airtime", [1.5, 2.2, 3.0])
def test_legs_hang_below_who_flies_long(standing, airtime):
    """On the Moon, where one leaves the floor as fast as ever and has the time to keep on swinging."""
    jump = Jump(gravity=(0.0, -1.62, 0.0))
    made = jump.plan(standing, Intent(leap=Leap(None, airtime)))
    for time in np.arange(made.take_off, made.take_off + 0.5 * airtime, 1 / 30):
        pose = made.at(time)
        places = forward_kinematics(jump.skeleton, pose.root, pose.rotations)[0]
        toes = places[[jump.skeleton.index(side + "Toe") for side in ("Left", "Right")]] - places[0]
        assert (np.abs(toes[:, 2]) < 0.3).all()


def test_who_idles_on_the_moon_does_not_hop_as_he_winds_up():
    """Weight comes over both feet for seconds before he goes down, and his soles stay on the floor."""
    jump, locomotion = Jump(gravity=(0.0, -1.62, 0.0)), Locomotion.load()
    state = locomotion.start()
    toes = [jump.skeleton.index(side + "Toe") for side in ("Left", "Right")]
    for n in range(18 * 60):
        before = state.pose
        state, _ = locomotion.step(state, Intent(), 1 / 60)
        state = replace(state, previous=before, elapsed=1 / 60)
        if n % 180 == 90 or n == 1050:
            for airtime in (1.5, 3.0):
                made = jump.plan(state, Intent(leap=Leap(None, airtime)))
                poses = [made.at(time) for time in np.arange(0.0, made.push_off, 1 / 15)]
                high = [forward_kinematics(jump.skeleton, pose.root, pose.rotations)[0][toes, 1].max() for pose in poses]
                assert max(high) < 0.04


def test_who_walks_pushes_off_no_harder_than_legs_can(jump):
    """Where feet are far apart one behind the other, and carry him past them: the next moments of the step are better."""
    locomotion, wish = Locomotion.load(), np.array([0.8, 0.0, 0.0])
    state, made = locomotion.start(), []
    for n in range(220):
        before = state.pose
        state, _ = locomotion.step(state, Intent(wish), 1 / 60)
        state = replace(state, previous=before, elapsed=1 / 60)
        start = jump.start_of(state)
        if n > 150 and n % 6 == 0 and start.single is None:
            made += [jump.attempt(start, ahead(state, far), 0.0, None, ())[0] for far in (0.6, 0.8)]
    made = [plan for plan in made if plan is not None]
    assert made
    for plan in made:
        assert np.linalg.norm(plan.forces, axis=1).max() < 3.6 * 9.81 * jump.physique.mass, "times its weight"
        times = np.arange(0.0, plan.touch_down, 1 / 60)
        poses = [plan.at(t) for t in times]
        places = forward_kinematics(jump.skeleton, np.stack([p.root for p in poses]), np.stack([p.rotations for p in poses]))[0]
        assert np.linalg.norm(places[4:] - 2.0 * places[2:-2] + places[:-4], axis=-1).max() * 30**2 < 250.0, "m/s²"


@pytest.mark.parametrize("pace, far", [(1.4, 0.6), (1.8, 0.6), (1.8, 1.4), (2.7, 2.1), (3.2, 2.3)])
def test_hands_of_who_has_little_time_are_not_thrown_as_he_leaps_off_one_foot(person, pace, far):
    """Recorded ones, of runners, are pulled by 50 … 105 m/s²; a swing that was recorded over 0.25 s pulled them by up to 335 in a tenth of that."""
    wish, state, poses, made = np.array([pace, 0.0, 0.0]), person.start(), [], None
    for n in range(260):
        leap = Leap(ahead(state, far)) if n > 150 and made is None else None
        state, _ = person.step(state, Intent(wish, leap), 1 / 60)
        poses.append(state.pose)
        if made is None and isinstance(state.memory.memory, Jumping):
            made, poses = state.memory.memory.plan, poses[-8:]
            steps = len(poses) + int(made.take_off * 60)
        if made is not None and len(poses) > steps + 2:
            break
    assert made is not None and made.path.single
    hands = [person.skeleton.index(side + "Hand") for side in ("Left", "Right")]
    placed = forward_kinematics(person.skeleton, np.stack([p.root for p in poses]), np.stack([p.rotations for p in poses]))[0][:, hands]
    assert np.linalg.norm(placed[4:] - 2.0 * placed[2:-2] + placed[:-4], axis=-1).max() * 900.0 < 160.0
