"""Feet that stand do not slide, whatever the method believes; none pops as it lets go; legs alone hold them."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gambol.controllers.body import Pose, contact_height, contact_points, exp, forward_kinematics
from gambol.controllers.reconstruction import SKELETON
from gambol.controllers.reconstruction.footing import Feet, Footing

DT, HEIGHT = 1 / 60, contact_height(SKELETON)
FOOTING = Footing(SKELETON)
FREE, BOTH, NOBODY = np.zeros(4), np.ones(4), np.zeros(2, bool)
LEGS = [SKELETON.index(side + name) for side in ("Left", "Right") for name in ("UpLeg", "Leg", "Foot", "Toe")]
KNEES = [SKELETON.index(side + "Leg") for side in ("Left", "Right")]


def body(way=(0.0, 0.0, 0.0), heading=0.0, bend=0.35, turns=None):
    """Somebody with bent knees whose soles stand, moved by a way [m] and turned by a heading [rad]. turns: (J, 3) rotation vectors more."""
    bent = np.zeros((len(SKELETON), 3)) if turns is None else turns.copy()
    bent[0, 1] += heading
    for side in ("Left", "Right"):
        for name, share in (("UpLeg", -1.0), ("Leg", 2.0), ("Foot", -1.0)):
            bent[SKELETON.index(side + name), 0] += share * bend
    rotations = exp(bent)
    low = contact_points(SKELETON, *forward_kinematics(SKELETON, np.zeros(3), rotations))[:, 1].min()
    return Pose(np.array(way) + [0.0, HEIGHT - low, 0.0], rotations)


def played(poses, standing, dt=DT, told=NOBODY):
    """Joints (T, J, 3), orientations and soles (T, 4, 3) of what is shown of poses, whose points stand as standing (T, 4) has it; and the feet (T)."""
    feet, shown, states = Feet.none(), [], []
    for pose, stands in zip(poses, standing, strict=True):
        feet, after = FOOTING.step(feet, pose, stands, told, dt)
        shown.append(forward_kinematics(SKELETON, after.root, after.rotations))
        states.append(feet)
    positions, orientations = (np.array(part) for part in zip(*shown, strict=True))
    return positions, orientations, contact_points(SKELETON, positions, orientations), states


def along(points):
    """How far points (T, ..., 3) go along the floor from frame to frame [m]."""
    return np.linalg.norm(np.diff(points[..., [0, 2]], axis=0), axis=-1)


@settings(max_examples=15, deadline=None)
@given(st.floats(-0.4, 0.4), st.floats(-0.4, 0.4), st.floats(-0.6, 0.6), st.sampled_from([30, 60, 144]))
def test_a_foot_that_stands_does_not_slide_whatever_the_method_believes(ahead, aside, spin, rate):
    """The believed body slides and turns on for a third of a second: both soles stay within 2 mm of where they came down."""
    count = rate // 3
    share = np.linspace(0.0, 0.3, count)
    poses = [body((aside * s, 0.0, ahead * s), spin * s) for s in share]
    _, _, points, _ = played(poses, [BOTH] * count, 1 / rate)
    assert np.linalg.norm((points - points[0])[..., [0, 2]], axis=-1).max() < 0.002


def test_only_legs_hold_feet(rng=np.random.default_rng(1)):
    turns = rng.normal(0.0, 0.1, (len(SKELETON), 3))
    poses = [body((0.0, 0.0, 0.004 * t), turns=turns) for t in range(30)]
    positions, orientations, _, _ = played(poses, [BOTH] * 30)
    own = [forward_kinematics(SKELETON, pose.root, pose.rotations) for pose in poses]
    rest = np.setdiff1d(np.arange(len(SKELETON)), LEGS)
    assert np.array_equal(positions[:, rest], np.array([some[0] for some in own])[:, rest])
    assert np.array_equal(orientations[:, rest], np.array([some[1] for some in own])[:, rest])


def test_who_stands_where_he_is_believed_is_shown_as_believed():
    poses = [body()] * 20
    positions, _, _, _ = played(poses, [BOTH] * 10 + [FREE] * 10)
    assert np.abs(positions - forward_kinematics(SKELETON, poses[0].root, poses[0].rotations)[0]).max() < 1e-6


@pytest.mark.parametrize("rate", [30, 60, 144])
def test_a_foot_lets_go_without_a_pop_and_comes_where_it_is_believed(rate):
    """Held 10 cm behind a body that went on: let go, no joint of the legs changes its pace by more than 0.9 m/s within a sixtieth of a second; half a second later
    it is as believed."""
    count = rate // 2
    poses = [body((0.0, 0.0, 0.2 * min(t / rate, 0.5))) for t in range(3 * count)]
    positions, _, _, _ = played(poses, [BOTH] * count + [FREE] * 2 * count, 1 / rate)
    paces = np.diff(positions[:, LEGS], axis=0) * rate
    assert np.linalg.norm(np.diff(paces[count // 2:], axis=0), axis=-1).max() < 0.9 * max(60 / rate, 1.0)
    own = forward_kinematics(SKELETON, poses[-1].root, poses[-1].rotations)[0]
    assert np.linalg.norm(positions[-1] - own, axis=-1).max() < 0.005


def test_who_is_carried_off_steps_with_one_foot_after_the_other():
    """The believed body skates 1.5 m ahead at half a metre a second, its soles said to stand all the time: feet follow by steps, lifted, one standing
    while the other one steps."""
    poses = [body((0.0, 0.0, 0.5 * DT * t)) for t in range(180)]
    positions, _, points, states = played(poses, [BOTH] * 180)
    steps, held = np.array([feet.steps for feet in states]), np.array([feet.held for feet in states]).reshape(-1, 2, 2).any(-1)
    assert steps.any(0).all() and (steps & ~np.roll(steps, 1, 0)).sum() >= 4
    assert not steps.all(-1).any() and (steps.any(-1) <= held.any(-1)).all()
    gone = along(points).reshape(-1, 2, 2).min(-1)
    assert gone[~steps[1:] & held[1:] & held[:-1]].max() < 0.002
    soles = points[..., 1].reshape(-1, 2, 2).min(-1)
    middle = np.array([feet.away for feet in states]) > 0.1
    assert all(soles[steps[:, f] & middle[:, f], f].max() > HEIGHT + 0.03 for f in range(2))
    assert np.linalg.norm(positions[-1, LEGS] - forward_kinematics(SKELETON, poses[-1].root, poses[-1].rotations)[0][LEGS], axis=-1).max() < 0.45


def test_a_leg_that_is_too_short_lifts_its_heel_and_no_knee_leaps():
    """Ball held, the body walks away from it at 1 m/s: the heel rises, the ball stays, and the knee never turns back."""
    poses = [body((0.0, 0.0, 0.017 * t), bend=0.2) for t in range(22)]
    stands = np.array([0.0, 1.0, 0.0, 0.0])
    positions, _, points, states = played(poses, [stands] * 22)
    held = np.array([feet.held[1] for feet in states])
    assert held[:18].all() and along(points)[:17, 1].max() < 0.003
    assert points[17, 0, 1] > HEIGHT + 0.03
    knee = positions[:, KNEES[0]] - positions[:, 0]
    assert np.linalg.norm(np.diff(knee, 2, axis=0), axis=-1).max() < 0.02


def test_a_foot_that_a_tracker_tells_of_is_soon_where_it_is_told():
    poses = [body((0.0, 0.0, 0.04 * min(t / 30, 1.0))) for t in range(60)]
    _, _, points, _ = played(poses, [BOTH] * 60, told=np.ones(2, bool))
    own = contact_points(SKELETON, *forward_kinematics(SKELETON, poses[-1].root, poses[-1].rotations))
    assert np.linalg.norm(points[-1] - own, axis=-1).max() < 0.003


def test_a_body_that_leaps_elsewhere_is_begun_anew():
    poses = [body()] * 5 + [body((3.0, 0.0, -2.0))] * 5
    positions, _, _, _ = played(poses, [BOTH] * 10)
    assert np.abs(positions[5:] - forward_kinematics(SKELETON, poses[-1].root, poses[-1].rotations)[0]).max() < 1e-6


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_no_pose_breaks_a_leg(seed):
    """Random poses and contacts, straight legs among them: rotations stay rotations, and states go in as they were."""
    rng = np.random.default_rng(seed)
    feet, ankles = Feet.none(), 0.0
    for t in range(12):
        pose = body(rng.normal(0.0, 0.2, 3), rng.normal(), rng.choice([0.0, 0.3]), rng.normal(0.0, 0.5 * (t % 3), (len(SKELETON), 3)))
        before = feet.points.copy(), feet.held.copy()
        after, shown = FOOTING.step(feet, pose, rng.random(4), rng.random(2) < 0.3, DT)
        assert np.array_equal(feet.points, before[0]) and np.array_equal(feet.held, before[1])
        feet = after
        assert np.abs(shown.rotations @ np.swapaxes(shown.rotations, -1, -2) - np.eye(3)).max() < 1e-6
        ankles = max(ankles, np.abs(contact_points(SKELETON, *forward_kinematics(SKELETON, shown.root, shown.rotations)) - feet.points).max())
    assert ankles < 1e-4
