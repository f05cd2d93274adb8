"""Legs of who is pushed as he walks: a foot gets to the other's far side and back with room, on the way on which legs are not through each other."""

import numpy as np
import pytest

from gambol.controllers.body import forward_kinematics
from gambol.controllers.contract import Intent, Strike
from gambol.controllers.jump import Physique
from gambol.controllers.person import person
from gambol.controllers.struck import STEPS
from gambol.controllers.struck.passing import legs_apart, length_kernel, out_of_way, past_kernel

DT, WISH = 1 / 60, np.array([1.4, 0.0, 0.0])
BODY = Physique()


@pytest.fixture(scope="module")
def walks():
    """Somebody, and eight moments of his stride."""
    somebody = person()
    state, moments = somebody.start(), []
    for n in range(214):
        if n >= 150 and (n - 150) % 8 == 0:
            moments.append(state)
        state, _ = somebody.step(state, Intent(WISH), DT)
    return somebody, moments


@pytest.mark.few(1)
@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("gained", [0.85, 1.1])
def test_no_leg_goes_through_the_other_of_who_is_pushed_aside(walks, side, gained):
    somebody, moments = walks
    for state in moments:
        poses = []
        for n in range(75):
            state, pose = somebody.step(state, Intent(WISH, strike=None if n else Strike((side * gained * BODY.mass, 0.0))), DT)
            poses.append(pose)
        roots, turns = np.stack([pose.root for pose in poses]), np.stack([pose.rotations for pose in poses])
        assert legs_apart(somebody.skeleton, roots, turns) > 0.04
        ankles = forward_kinematics(somebody.skeleton, roots, turns)[0][:, [somebody.skeleton.index(name) for name in ("LeftFoot", "RightFoot")]]
        assert np.linalg.norm(np.diff(ankles, axis=0), axis=-1).max() / DT < 13.0


def test_thighs_of_who_crosses_his_feet_keep_out_of_each_other():
    """Pelvis and trunk turn where he goes; thighs' axes came within 2 mm of each other, and within 3 cm in one push of six."""
    somebody, wish = person(), np.array([0.8, 0.0, 0.0])
    struck, state, near = somebody.parts["struck"], somebody.start(), []
    for n in range(214):
        state, _ = somebody.step(state, Intent(wish), DT)
        if n < 150 or n % 8:
            continue
        for towards in (90.0, 120.0, 240.0, 270.0):
            way = np.radians(towards)
            made = struck.recovery(somebody.active(state)[1], Intent(wish), Strike((120.0 * np.sin(way), 120.0 * np.cos(way))))
            if made.fate == STEPS:
                near.append(legs_apart(somebody.skeleton, made.roots, made.local))
    assert len(near) > 12 and min(near) > 0.05


def test_nobody_who_is_pushed_aside_has_turned_at_once(walks):
    """Pelvis and trunk begin to turn from how they were as he is struck; hands were thrown at 450 m/s²."""
    somebody, _ = walks
    state, wish = somebody.start(), np.array([1.6, 0.0, 0.0])
    for n in range(214):
        state, _ = somebody.step(state, Intent(wish), DT)
        if n < 150 or n % 8:
            continue
        for towards in (90.0, 120.0, 240.0, 270.0):
            way, now, poses = np.radians(towards), state, [state.previous, state.pose]
            for k in range(2):
                now, pose = somebody.step(now, Intent(wish, strike=None if k else Strike((120.0 * np.sin(way), 120.0 * np.cos(way)))), DT)
                poses.append(pose)
            joints = forward_kinematics(somebody.skeleton, np.stack([pose.root for pose in poses]), np.stack([pose.rotations for pose in poses]))[0]
            assert np.linalg.norm(np.diff(joints - joints[:, :1], 2, axis=0), axis=-1).max() / DT**2 < 250.0


@pytest.mark.few(1)
@pytest.mark.parametrize("towards", [180.0, 150.0, 90.0])
def test_who_walks_on_is_on_his_way_and_his_ground_frame_goes_on_with_him(walks, towards):
    """He who was stopped falls ahead over his feet until he goes again: he stood on his toes' tips, and beyond them, for 0.4 s, and the ground frame leapt by up to 0.28 m."""
    somebody, moments = walks
    way, on = np.array([np.sin(np.radians(towards)), np.cos(np.radians(towards))]), 0
    for state in moments:
        for hard in (90.0, 120.0, 150.0):
            now = state
            for n in range(120):
                before, now = now, somebody.step(now, Intent(WISH, strike=None if n else Strike(tuple(hard * way))), DT)[0]
                if before.active == "struck" and now.active == "locomotion":
                    on += 1
                    v_f, _, v_l = before.velocity
                    c, s = np.cos(before.ground[2]), np.sin(before.ground[2])
                    assert v_f > 0.3
                    assert np.hypot(*(now.ground[:2] - before.ground[:2] - DT * np.array([s * v_f + c * v_l, c * v_f - s * v_l]))) < 0.06
                    break
    assert on > 10


def test_the_ground_frame_of_who_has_stumbled_or_got_up_is_where_it_is_of_who_stands(walks):
    somebody, _ = walks
    for impulse in ((0.0, 110.0), (70.0, 0.0), (0.0, 300.0)):
        now, ends = somebody.start((0.0, 0.0, 0.5)), 0
        for n in range(360):
            before, now = now, somebody.step(now, Intent(strike=None if n else Strike(impulse)), DT)[0]
            if before.active == "struck" and now.active == "locomotion":
                ends += 1
                assert np.hypot(*(now.ground - before.ground)[:2]) < 0.02
        assert ends == 1


def test_no_knee_leaps_as_runners_are_struck():
    """From any moment of a stride, heels behind the buttocks, too, joints go on from where they are; seen from the hips, and no harder than in the steps that follow."""
    somebody, run = person(), np.array([3.2, 0.0, 0.0])
    state, stepped = somebody.start(), 0
    for n in range(212):
        state, _ = somebody.step(state, Intent(run), DT)
        if n < 170 or n % 2:
            continue
        for change in ((0.0, -1.4), (1.0, -1.0), (-1.0, -1.0)):
            now, poses = state, [state.previous, state.pose]
            for after in range(5):
                now, pose = somebody.step(now, Intent(run, strike=None if after else Strike(tuple(BODY.mass * np.array(change)))), DT)
                poses.append(pose)
            if now.active != "struck":
                continue
            stepped += now.memory.memory.made.fate == STEPS
            joints = forward_kinematics(somebody.skeleton, np.stack([pose.root for pose in poses]), np.stack([pose.rotations for pose in poses]))[0]
            joints = joints - joints[:, :1]
            assert np.linalg.norm(np.diff(joints, axis=0), axis=-1).max() < 0.17
            assert np.linalg.norm(np.diff(joints, 2, axis=0), axis=-1).max() / DT**2 < 320.0
    assert stepped > 8


@pytest.mark.parametrize(("speed", "moment", "change"), [(1.0, 0, (0.0, -2.0)), (3.0, 30, (1.4, -1.4))])
def test_no_knee_is_thrown_as_its_leg_stretches_in_its_swing(speed, moment, change):
    somebody, wish = person(), np.array([speed, 0.0, 0.0])
    state = somebody.start()
    for _ in range(180 + moment):
        state, _ = somebody.step(state, Intent(wish), DT)
    poses = []
    for n in range(30):
        state, pose = somebody.step(state, Intent(wish, strike=None if n else Strike(tuple(BODY.mass * np.array(change)))), DT)
        poses.append(pose)
    joints = forward_kinematics(somebody.skeleton, np.stack([pose.root for pose in poses]), np.stack([pose.rotations for pose in poses]))[0]
    assert np.linalg.norm(np.diff(joints - joints[:, :1], 2, axis=0), axis=-1).max() / DT**2 < 400.0


def way(begin, end, own, shares):
    """A foot's way (K, 2) left, ahead [m] past a foot at 0 of a body that faces along z."""
    out, begin, end = np.empty(2), np.array(begin), np.array(end)
    most = past_kernel(begin, end, np.zeros(2), own, 0.0, 1.0, out)
    return begin + np.outer(shares, end - begin) + np.outer(out_of_way(shares, most), out)


@pytest.mark.parametrize("own", [1.0, -1.0])
@pytest.mark.parametrize(("begin", "end", "before"), [((0.14, -0.67), (-0.42, 0.3), True), ((-0.42, -0.74), (0.11, 0.38), False), ((-0.3, 0.4), (0.2, -0.1), True),
                                                      ((0.2, -0.3), (-0.3, -0.4), False)])
def test_a_foot_crosses_before_the_other_or_behind_it_and_goes_back_as_it_came(own, begin, end, before):
    """It passes the other's long line on the side on which its leg is, with room."""
    line = way((own * begin[0], begin[1]), (own * end[0], end[1]), own, np.linspace(0.0, 1.0, 200)) * [own, 1.0]
    passes = line[:-1, 0] * line[1:, 0] <= 0.0
    assert (line[:-1, 1][passes] > 0.2).all() if before else (line[:-1, 1][passes] < -0.2).all()


def test_who_walks_straight_on_goes_straight_and_a_way_round_is_longer():
    shares = np.linspace(0.0, 1.0, 50)
    line = way((0.2, -0.6), (0.2, 0.6), 1.0, shares)
    assert np.allclose(line[:, 0], 0.2)
    begin, end, other = np.array([-0.42, -0.74]), np.array([0.11, 0.38]), np.zeros(2)
    assert length_kernel(begin, end, other, 1.0, 0.0, 1.0) > np.hypot(*(end - begin)) + 0.05
