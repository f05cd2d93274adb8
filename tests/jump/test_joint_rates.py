"""How fast knees and ankles turn: no faster than people's, wherever a leap leads."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gambol.controllers.body import forward_kinematics, log, sole_corners
from gambol.controllers.contract import Intent, Leap, Unable
from gambol.controllers.jump import Jump
from gambol.controllers.jump.body import Physique, airtime_up, nearest_kernel, turns
from gambol.controllers.jump.body.dynamics import place_kernel
from gambol.controllers.jump.body.planted_pose import ankle_kernel, foot_kernel, leg_kernel
from gambol.controllers.jump.motion.rounds import SOFT, softened

BODY = Physique().tables
ROUND = [(far * np.sin(way), up, far * np.cos(way)) for way in np.radians([0, 50, 90, 140, 180, -75]) for far, up in ((0.3, 0.0), (0.9, 0.0), (0.8, -0.5))]
WALK = np.array([1.4, 0.0, 0.0])
HIGH = [(0.9, 0.0, 0.2), (-0.5, 0.0, -0.5), (0.0, 0.0, 0.1)]


def fastest(who, made, part):
    """How fast [rad/s] a knee or an ankle turns at most, looked at 60 times a second."""
    times = np.arange(0.0, min(made.duration, made.through), 1 / 60)
    local = np.stack([made.at(t).rotations for t in times])[:, [who.skeleton.index(side + part) for side in ("Left", "Right")]]
    return float(np.linalg.norm(log(np.swapaxes(local[:-1], -1, -2) @ local[1:]), axis=-1).max() * 60)


@pytest.mark.few(8)
@pytest.mark.parametrize("place, airtime", [(place, None) for place in ROUND] + [(place, 0.5) for place in HIGH])
def test_knees_and_ankles_turn_no_faster_than_peoples(jump, standing, place, airtime):
    made = jump.plan(standing, Intent(leap=Leap(np.array(place) + np.array([standing.ground[0], standing.floor, standing.ground[1]]), airtime)))
    assert fastest(jump, made, "Leg") < 18.0 and fastest(jump, made, "Foot") < 20.0


@pytest.mark.parametrize("way, far", [(-155, 0.2), (0, 0.2), (90, 0.05), (90, 0.4)])
def test_who_drops_past_the_edge_that_he_left_draws_no_leg_up_over_it(jump, standing, way, far):
    """Told a short airtime: knees turned at up to 33 rad/s in the air where feet were kept over the floor that was left."""
    place = np.array([standing.ground[0] + far * np.sin(np.radians(way)), standing.floor - 0.6, standing.ground[1] + far * np.cos(np.radians(way))])
    made = jump.plan(standing, Intent(leap=Leap(place, 0.28)))
    assert fastest(jump, made, "Leg") < 15.0 and fastest(jump, made, "Foot") < 21.5


@pytest.mark.parametrize("way", [-170, 160])
@pytest.mark.parametrize("up", [-0.7, -0.4])
def test_who_drops_backward_comes_down_on_knees_that_give(jump, standing, way, up):
    """Along legs that reach back he comes down faster than he falls."""
    place = np.array([standing.ground[0] + 1.3 * np.sin(np.radians(way)), standing.floor + up, standing.ground[1] + 1.3 * np.cos(np.radians(way))])
    assert fastest(jump, jump.plan(standing, Intent(leap=Leap(place))), "Leg") < 17.0


def knees_and_pitches(soft):
    """How far a knee is bent and its foot points down [rad] as the hip rises over a planted foot, a millimetre at a time."""
    skeleton, out = Jump().skeleton, []
    for high in np.arange(0.75, 1.05, 1e-3):
        local = np.tile(np.eye(3), (len(skeleton), 1, 1))
        positions, turned = np.empty((len(skeleton), 3)), np.empty((len(skeleton), 3, 3))
        place_kernel(BODY, np.array([0.0, high, 0.0]), local, positions, turned)
        foot = np.array([positions[BODY.hip[0], 0], BODY.sole, 0.12, 0.0, 0.0, 1.0 + soft])
        leg_kernel(BODY, 0, foot, 1.0, local, positions, turned)
        out.append((float(np.linalg.norm(log(local[BODY.hip[0] + 1]))), foot[4]))
    return np.array(out).T


def test_a_leg_that_pushes_straightens_softly_and_its_heel_rises_meanwhile():
    (hard, hard_pitch), (soft, soft_pitch) = knees_and_pitches(0.0), knees_and_pitches(1.0)
    assert (np.diff(soft) < 1e-9).all() and (np.diff(soft_pitch) > -1e-9).all()
    assert np.abs(np.diff(soft, 2)).max() < 0.5 * np.abs(np.diff(hard, 2)).max(), "no knee stops at once"
    assert soft.min() == pytest.approx(hard.min(), abs=0.02) and soft[0] == pytest.approx(hard[0])
    assert (soft_pitch >= hard_pitch - 1e-9).all()


@given(st.floats(-0.5, 0.3), st.floats(0.5, 0.9), st.floats(-3.0, 3.0))
def test_an_ankle_is_nearest_to_its_hip_where_it_is_said_to_be(back, high, yaw):
    """The distance has no slope there, and grows to either side."""
    foot = np.array([0.3, BODY.sole, -0.2, yaw, 0.0, 0.0])
    hip = foot[:3] + turns(np.array([0.0, yaw, 0.0])) @ [0.0, high, back]
    least, away = nearest_kernel(BODY, hip, foot), []
    for pitch in (least - 1e-3, least, least + 1e-3):
        turned, at = np.empty((3, 3)), np.empty(3)
        foot_kernel(yaw, pitch, turned)
        ankle_kernel(BODY, foot, turned, at)
        away.append(float(np.linalg.norm(hip - at)))
    assert away[1] < away[0] and away[1] < away[2] and away[0] == pytest.approx(away[2], abs=1e-7)


@given(st.floats(0.0, 8.0), st.floats(0.6, 1.3))
def test_whoever_falls_fast_touches_down_on_knees_bent_so_that_they_need_not_fly(fall, size):
    body = Physique(60.0, 1.74 * size).tables
    bone, lower = 0.5 * (body.thigh + body.shank), softened(fall, body)
    assert 0.0 <= lower <= SOFT[2] * body.size + 1e-12 and softened(fall + 0.1, body) >= lower
    if 0.0 < lower < SOFT[2] * body.size:  # a leg of two such bones is 2 a cos θ/2 long
        half = np.arccos(0.93 - lower / (2.0 * bone))
        assert SOFT[0] * fall / (bone * np.sin(half)) == pytest.approx(SOFT[1], rel=1e-6)


@pytest.fixture(scope="module")
def walkers(locomotion):
    """Moments of a stride at a walk."""
    state, states = locomotion.start(), []
    for _ in range(216):
        before = state
        state, _ = locomotion.step(state, Intent(WALK), 1 / 60)
        states.append(replace(state, previous=before.pose, elapsed=1 / 60))
    return states[150::6]


def test_a_walkers_free_leg_swings_no_faster_than_peoples_and_clears_the_floor(jump, walkers):
    found = []
    for state in walkers:
        intent = Intent(WALK, Leap(np.array([state.ground[0], 0.0, state.ground[1] + 1.4])))
        if not jump.precondition(state, intent):
            continue
        try:
            made = jump.plan(state, intent)
        except Unable:
            continue
        if made.path.single:
            off = made.times <= made.take_off
            soles = sole_corners(jump.skeleton, *forward_kinematics(jump.skeleton, made.roots[off], made.local[off]))
            found.append((soles[..., 1].min(), fastest(jump, made, "Leg")))
    deepest, knees = np.array(found).T
    assert deepest.min() > -0.01 and knees.max() < 19.0


@pytest.mark.parametrize("place, high", [((0.0, 0.0, 0.0), 0.40), ((1.45, 0.0, 0.0), None), ((0.0, 0.0, -1.45), None)])
def test_no_leap_is_refused_for_its_knees(jump, standing, place, high):
    """The highest and the farthest, which take all of the push's way, are leapt on straight legs."""
    airtime = None if high is None else airtime_up(jump.physique, high, jump.gravity)
    assert not jump.refusal(standing, Intent(leap=Leap(np.array(place) + np.array([standing.ground[0], standing.floor, standing.ground[1]]), airtime)))
