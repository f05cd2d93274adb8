"""Who goes slowly, aside, askew or backward leaps on the way that he goes, off one foot onto the other, and keeps his speed."""

import numpy as np
import pytest

from gambol.controllers.body import forward_kinematics, sole_corners
from gambol.controllers.contract import Intent, Leap
from gambol.controllers.jump import Jumping, goes

FPS, ALONG = 60, Leap(None, along=True)
WAYS = {"left": (0.0, 0.6), "right": (0.0, -0.6), "backward": (-0.8, 0.0), "ahead and left": (0.55, 0.55), "backward and right": (-0.4, -0.4), "slowly ahead": (0.65, 0.0)}


@pytest.fixture(scope="module", params=WAYS)
def leapt(request, person):
    """The states from where a leap was asked on, when it begins, and its plan."""
    ahead, left = WAYS[request.param]
    wish, state, begun = np.array([ahead, 0.0, left]), person.start(), None
    for _ in range(150):
        state, _ = person.step(state, Intent(wish), 1 / FPS)
    states = [state]
    while begun is None or len(states) < begun[0] + 90:
        state, _ = person.step(state, Intent(wish, ALONG if begun is None else None), 1 / FPS)
        states.append(state)
        memory = state.memory.memory
        if begun is None and isinstance(memory, Jumping):
            begun = len(states) - 2, memory.plan
        assert begun or len(states) < 1.2 * FPS, state.refused
    return states, *begun


def times(begun, made):
    """The steps at which he leaves the floor and comes down."""
    return begun + int(made.take_off * FPS), begun + int(np.ceil(made.touch_down * FPS))


def test_he_leaps_off_one_foot_onto_the_other_the_way_that_he_goes(leapt):
    states, begun, made = leapt
    way, flown = goes(states[begun]), made.path.velocity * [1.0, 0.0, 1.0]
    assert made.path.lands is not None and made.path.single and not states[-1].refused
    assert way @ flown > 0.85 * np.linalg.norm(way) * np.linalg.norm(flown)
    assert made.path.course.outside < 0.02 and made.path.course.lean < 1.0, "from within the sole, without slipping"


def test_he_keeps_his_speed_and_goes_on(leapt):
    states, begun, made = leapt
    (_, down), hips = times(begun, made), np.array([s.pose.root for s in states])[:, [0, 2]]
    before = np.linalg.norm(goes(states[begun]))
    gone = np.linalg.norm(hips[down + 36] - hips[begun]) * FPS / (down + 36 - begun)
    assert gone > 0.75 * before
    assert not states[begun + int(made.through * FPS) + 3].active == "jump", "no stop after it"
    assert np.linalg.norm(goes(states[-1])) > 0.85 * before


def test_feet_stand_still_and_clear_the_floor_and_each_other(leapt, person):
    states, begun, made = leapt
    off, down = times(begun, made)
    shown = states[begun:down + 40]
    joints, turned = forward_kinematics(person.skeleton, np.array([s.pose.root for s in shown], float), np.array([s.pose.rotations for s in shown], float))
    assert sole_corners(person.skeleton, joints, turned)[..., 1].min() > -0.03
    for part in "Leg", "Foot":
        one, other = (joints[:, person.skeleton.index(side + part)] for side in ("Left", "Right"))
        assert np.linalg.norm(one - other, axis=-1).min() > 0.1
    pushes = np.array([s.contacts for s in shown]).reshape(len(shown), 2, 2)[1:off - begun, :, 1]
    balls = joints[1:off - begun, [person.skeleton.index(side + "Toe") for side in ("Left", "Right")]]
    for side in range(2):
        stood = balls[pushes[:, side], side]
        assert not len(stood) or np.ptp(stood, axis=0)[[0, 2]].max() < 0.02


@pytest.mark.few(2)
@pytest.mark.parametrize(("way", "most"), [((-0.4, 0.4), 0.45), ((-0.4, -0.4), 0.45), ((-0.8, 0.0), 0.45), ((0.55, 0.55), 0.5), ((0.8, 0.0), 0.5)])
def test_nobody_waits_long_for_a_foot_that_carries_him_on(person, way, most):
    wish, state = np.array([way[0], 0.0, way[1]]), person.start()
    for _ in range(150):
        state, _ = person.step(state, Intent(wish), 1 / FPS)
    for _ in range(6):
        asked = state
        for step in range(round(most * FPS)):
            asked, _ = person.step(asked, Intent(wish, Leap(None, along=True, waited=step / FPS)), 1 / FPS)
            if isinstance(asked.memory.memory, Jumping):
                break
        assert isinstance(asked.memory.memory, Jumping), asked.refused
        for _ in range(11):
            state, _ = person.step(state, Intent(wish), 1 / FPS)


def test_who_skips_ahead_swings_his_arms_by_turns_and_low(person):
    wish, state = np.array([1.0, 0.0, 0.0]), person.start()
    for _ in range(150):
        state, _ = person.step(state, Intent(wish), 1 / FPS)
    while not isinstance(state.memory.memory, Jumping):
        state, _ = person.step(state, Intent(wish, ALONG), 1 / FPS)
    made = state.memory.memory.plan
    assert made.path.airtime < 0.36
    lands = made.at(made.touch_down)
    joints, _ = forward_kinematics(person.skeleton, lands.root, lands.rotations)
    left, right = (joints[person.skeleton.index(side + "Hand"), 2] - joints[0, 2] for side in ("Left", "Right"))
    ahead, behind = (right, left) if made.path.lands == 0 else (left, right)
    assert ahead > behind + 0.15, "beside the foot that pushed his hand is ahead"


def test_a_hair_more_of_stick_makes_no_other_leap(person):
    """From a hop on the spot by skips to a runner's leap: below 0.35 m/s he stopped and hopped 25 cm high, and at 1.2 m/s he flew twice as high as at 1.1."""
    risen = []
    for speed in (0.2, 0.25, 0.3, 0.4, 0.6, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7, 1.8):
        wish, state, some = np.array([speed, 0.0, 0.0]), person.start(), []
        for _ in range(150):
            state, _ = person.step(state, Intent(wish), 1 / FPS)
        for _ in range(3):
            asked, step, along = state, 0, speed < 1.75
            while not isinstance(asked.memory.memory, Jumping):
                place = None if along else np.array([asked.ground[0], 0.0, asked.ground[1] + 0.7 + 0.52 * speed])
                asked, _ = person.step(asked, Intent(wish, Leap(place, along=along, waited=step / FPS, slack=0.3 * (not along))), 1 / FPS)
                step += 1
                assert step < 1.0 * FPS, (speed, asked.refused)
            made = asked.memory.memory.plan
            air = (made.times > made.take_off) & (made.times < made.touch_down)
            joints, turned = forward_kinematics(person.skeleton, made.roots[air], made.local[air])
            some.append(float(sole_corners(person.skeleton, joints, turned)[..., 1].min(-1).max()))
            assert made.path.lands is not None
            for _ in range(8):
                state, _ = person.step(state, Intent(wish), 1 / FPS)
        risen.append(float(np.median(some)))
    assert 0.17 < risen[0] < 0.22 and min(risen) < 0.13 and risen[-1] > 0.29  # [m]
    assert np.abs(np.diff(risen)).max() < 0.055, risen


@pytest.mark.few(2)
@pytest.mark.parametrize("speed", [0.25, 1.3, 1.6])
def test_who_creeps_and_who_walks_briskly_keeps_his_speed(person, speed):
    """Off a foot that is under him: a walker's that has just struck brakes him for half a second, to 70 % of it."""
    wish, state, step = np.array([speed, 0.0, 0.0]), person.start(), 0
    for _ in range(150):
        state, _ = person.step(state, Intent(wish), 1 / FPS)
    for _ in range(5):
        asked, step = state, 0
        while not isinstance(asked.memory.memory, Jumping):
            asked, _ = person.step(asked, Intent(wish, Leap(None, along=True, waited=step / FPS)), 1 / FPS)
            step += 1
            assert step < 0.9 * FPS, asked.refused
        made = asked.memory.memory.plan
        leaves = float(made.path.velocity[[0, 2]] @ goes(asked)[[0, 2]]) / float(np.linalg.norm(goes(asked)))
        assert 0.85 * speed < leaves < max(1.4 * speed, 0.45) and made.take_off < 0.3
        for _ in range(7):
            state, _ = person.step(state, Intent(wish), 1 / FPS)


def test_a_foot_that_stands_is_lifted_and_not_drawn_away(leapt, person):
    states, begun, made = leapt
    free = made.path.lands
    if not np.reshape(states[begun].contacts, (2, 2))[free].all():
        return  # it is in the air already
    shown = [made.at(time) for time in (0.0, 1 / FPS)]
    joints, turned = forward_kinematics(person.skeleton, np.array([one.root for one in shown]), np.array([one.rotations for one in shown]))
    moved = np.diff(sole_corners(person.skeleton, joints, turned).reshape(2, 2, -1, 3)[:, free].mean(1)[:, [0, 2]], axis=0)
    assert np.linalg.norm(moved) * FPS < 1.2


def test_a_leap_along_the_way_has_no_place_and_who_stands_leaps_up(person):
    with pytest.raises(ValueError, match="no place"):
        Leap(np.zeros(3), along=True)
    state, _ = person.step(person.start(), Intent(leap=ALONG), 1 / FPS)
    made = state.memory.memory.plan
    assert np.linalg.norm((made.path.land - made.path.leave)[[0, 2]]) < 0.1
