"""Somebody who stands lives: shifts weight, glances, in an order of its own; and heads turn to where one goes."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import BSpline

from gambol.controllers.body import anatomy, centre_of_mass, rotations as rot
from gambol.controllers.contract import Intent, Leap
from gambol.controllers.locomotion import Idle, Library, LibraryError, Locomotion, Settings
from gambol.controllers.locomotion import arms_apart, idle as idling
from gambol.controllers.locomotion.spline import spline_kernel
from playing import FPS, hold, play


@pytest.fixture(scope="module")
def standing(locomotion):
    """Three people in different places who stand for a minute."""
    return play(locomotion, hold(60, (0, 0, 0), (0, 0, 0), (0, 0, 0)), np.array([[0, 0, 0], [3.0, 0, 0], [0, -2.0, 1.0]]))


def test_weight_is_shifted_as_far_as_recorded_while_the_feet_stay(locomotion, standing):
    """The recorded actor's mass centre stays within a quarter of a metre; his feet do not leave the floor."""
    com = centre_of_mass(anatomy(locomotion.skeleton), standing.positions, standing.orientations)
    for half in (slice(0, 30 * FPS), slice(30 * FPS, None)):
        travel = np.ptp(com[half][..., [0, 2]], axis=0).max(-1)
        assert np.all(travel > 0.08) and np.all(travel < 0.30)
    assert np.ptp(standing.points, axis=0).max() < 0.02
    assert all(state.contacts.all() for state in standing.states)
    assert np.abs(np.ptp(standing.ground, axis=0)).max() == 0.0


def test_it_goes_on_without_a_jerk_where_one_moment_follows_another(locomotion, standing):
    moment = np.array([s.memory["moment"] for s in standing.states])
    assert np.sum(np.abs(np.diff(moment, axis=0)) > 1.0) > 6, "it does leap about in the recording"
    step = np.linalg.norm(np.diff(standing.positions, 2, axis=0), axis=-1) * FPS**2
    assert step.max() < 50.0


def test_everybody_idles_in_an_order_of_their_own_that_a_replay_repeats(locomotion, standing):
    again = play(locomotion, hold(20, (0, 0, 0)), np.array([[3.0, 0, 0]]))
    np.testing.assert_array_equal(again.root[:, 0], standing.root[:20 * FPS, 1])
    np.testing.assert_array_equal(again.rotations[:, 0], standing.rotations[:20 * FPS, 1])
    seen = standing.positions - standing.positions[:, :, :1]
    assert np.abs(seen[:, 0] - seen[:, 1]).max() > 0.1
    halves = seen[5 * FPS:30 * FPS, 0], seen[35 * FPS:, 0]
    assert np.abs(halves[0] - halves[1]).max() > 0.1, "and never the same twice"


def test_who_walks_or_aims_does_not_idle(locomotion):
    motion = play(locomotion, np.concatenate([hold(5, (0, 0, 0)), hold(1, (1.0, 0, 0))]))
    presence = np.array([s.memory["presence"][0] for s in motion.states])
    assert presence[50] == 0.0 and presence[299] > 0.9 and presence[-1] < 0.05
    state = motion.states[299]
    for _ in range(72):
        state, _ = locomotion.step(state, Intent(leap=Leap(None)), 1 / FPS)
    assert state.memory["presence"].max() < 0.05


def test_a_spline_is_a_spline(locomotion):
    """Against scipy's own, values and rates."""
    table = locomotion.tables.idle
    whole = BSpline(np.arange(-3.0, len(table.coefficients) + 1), table.coefficients[:, 5].astype(float), 3)
    for at in (0.0, 3.25, 100.9, 412.5):
        value, rate = spline_kernel(table.coefficients, 5, at)
        assert value == pytest.approx(float(whole(at)), abs=1e-6)
        assert rate * idling.PER_SECOND == pytest.approx(float(whole(at, 1)) * idling.PER_SECOND, abs=1e-5)


def test_what_follows_is_alike(locomotion):
    """And whatever must be left can be, to a place that need not."""
    table = locomotion.tables.idle
    leaves = np.flatnonzero(table.follows >= 0)
    assert 0.1 < len(leaves) / len(table.follows) < 0.5 and np.all(table.follows[table.must] >= 0)
    assert not table.must[table.follows[leaves]].any()
    there = np.array([[spline_kernel(table.coefficients, d, float(k))[0] for d in (72, 73, 74)] for k in table.follows[leaves]])
    here = np.array([[spline_kernel(table.coefficients, d, float(k))[0] for d in (72, 73, 74)] for k in leaves])
    assert np.linalg.norm(there - here, axis=-1).max() < 0.15, "hips"


def test_a_library_without_idling_stands_still(library):
    still = Locomotion(replace(library, idle=None), Settings(breath=0.0))
    assert np.ptp(play(still, hold(5, (0, 0, 0))).positions[30:], axis=0).max() < 1e-4


def test_idling_is_kept_with_its_library_and_checked(library, tmp_path):
    library.save(tmp_path / "kept.npz")
    kept = Library.load(tmp_path / "kept.npz").idle
    np.testing.assert_array_equal(kept.coefficients, library.idle.coefficients)
    np.testing.assert_array_equal(kept.ends, library.idle.ends)
    for broken in (Idle(library.idle.coefficients[:, :5], library.idle.ends), Idle(library.idle.coefficients, library.idle.ends + 7),
                   Idle(library.idle.coefficients * np.nan, library.idle.ends)):
        replace(library, idle=broken).save(tmp_path / "broken.npz")
        with pytest.raises(LibraryError, match="idle"):
            Library.load(tmp_path / "broken.npz")


# heads

def turned(locomotion, state):
    """How far the head is turned to the left of the ground frame, and how far it nods [rad]."""
    from gambol.controllers.body import forward_kinematics
    _, orientations = forward_kinematics(locomotion.skeleton, np.asarray(state.pose.root, float), np.asarray(state.pose.rotations, float))
    ahead = rot.yaw(-state.ground[2]) @ orientations[locomotion.skeleton.index("Head")][:, 2]
    return np.arctan2(ahead[0], ahead[2]), -np.arcsin(ahead[1])


def looking(locomotion, look, heading=0.0, seconds=2.0):
    state = locomotion.start((0.0, 0.0, heading))
    for _ in range(round(seconds * FPS)):
        state, _ = locomotion.step(state, Intent(look=look), 1 / FPS)
    return turned(locomotion, state)


@pytest.fixture(scope="module")
def calm(library):
    return Locomotion(library, Settings(idle=0.0, breath=0.0))


def test_a_head_turns_to_a_place_and_nods(calm):
    straight = looking(calm, None)
    left, right = (looking(calm, np.array([x, 1.6, 3.0])) for x in (3.0, -3.0))
    assert left[0] - straight[0] == pytest.approx(np.pi / 4, abs=0.12) and right[0] - straight[0] == pytest.approx(-np.pi / 4, abs=0.12)
    low = looking(calm, np.array([0.0, 0.0, 4.0]))
    assert low[1] - straight[1] == pytest.approx(np.arctan2(1.6, 4.0), abs=0.12)
    assert looking(calm, np.array([0.0, 1.6, -5.0]))[0] == pytest.approx(straight[0], abs=0.05), "nobody looks behind himself"
    there = looking(calm, np.array([3.0, 1.6, 3.0]), heading=np.pi / 4)
    assert there[0] == pytest.approx(straight[0], abs=0.12)


def test_a_look_at_nothing_is_none(calm):
    straight = looking(calm, None)
    for nothing in (np.full(3, np.nan), np.array([1.0, np.inf, 0.0])):
        assert looking(calm, nothing) == straight


def test_a_head_goes_before_its_body(calm):
    """Round a curve it looks in, and as one begins to turn it turns before the shoulders do."""
    state = calm.start()
    for _ in range(round(0.3 * FPS)):
        state, _ = calm.step(state, Intent(np.array([0.0, 1.5, 0.0])), 1 / FPS)
    assert turned(calm, state)[0] - turned(calm, calm.start())[0] > 0.15


def test_a_crowd_looks_where_each_is_told(calm):
    state = calm.start(np.zeros((2, 3)))
    for _ in range(FPS):
        state, _ = calm.step(state, Intent(look=np.array([[3.0, 1.6, 3.0], [np.nan, 0, 0]])), 1 / FPS)
    assert state.memory["gaze"][0, 0] > 0.5 and state.memory["gaze"][1, 0] == 0.0


def test_arms_that_lie_in_each_other_are_taken_apart(locomotion):
    """One forearm crosses before the trunk and the other is turned through it: apart afterwards by their thickness, neither is in the trunk, and nothing else moves."""
    skeleton = locomotion.skeleton
    local = np.tile(np.eye(3), (60, len(skeleton), 1, 1))
    time = np.sin(np.linspace(0.0, np.pi, 60))
    for side, name in ((1.0, "Left"), (-1.0, "Right")):
        raised = rot.exp(np.array([-0.4 - 0.03 * side, 0.0, 0.0])) @ rot.exp(np.array([0.0, 0.0, -1.3 * side]))
        local[:, skeleton.index(name + "Arm")] = raised @ rot.exp(time[:, None] * [1.4, 0.0, 0.0])
        local[:, skeleton.index(name + "ForeArm")] = rot.exp(time[:, None] * [0.0, -1.9 * side, 0.0])
    root = np.tile([0.0, 1.0, 0.0], (60, 1))
    made = arms_apart.apart(skeleton, root, local, 60.0)
    def nearest(poses):
        (left, right), trunk = arms_apart._bones(skeleton, root, poses)
        return arms_apart.between_bones(left[1][0], right[1][0])[0].min(), min(arms_apart.between_bones(arm[1][0], trunk)[0].min() for arm in (left, right))
    assert nearest(local)[0] < 0.02
    assert nearest(made)[0] > 0.06 and nearest(made)[1] > 0.12
    others = [k for k, name in enumerate(skeleton.names) if name not in ("LeftArm", "RightArm")]
    assert np.abs(made[:, others] - local[:, others]).max() < 1e-9
    assert np.linalg.norm(rot.log(np.swapaxes(made[:-1], -1, -2) @ made[1:]), axis=-1).max() < 0.25


def test_nobody_who_stands_about_has_one_arm_in_the_other(locomotion):
    """Of eight people in 40 s: hands touch, forearms do not go through each other."""
    state, roots, poses = locomotion.start(np.array([(2.3 * k, -1.7 * k, 0.7 * k) for k in range(8)])), [], []
    for tick in range(40 * 60):
        state, pose = locomotion.step(state, Intent(np.zeros((8, 3))), 1 / 60)
        if tick % 6 == 0:
            roots.append(pose.root)
            poses.append(pose.rotations)
    joints, skeleton = len(locomotion.skeleton), locomotion.skeleton
    (left, right), _ = arms_apart._bones(skeleton, np.array(roots, float).reshape(-1, 3), np.array(poses, float).reshape(-1, joints, 3, 3))
    assert arms_apart.between_bones(left[1][0], right[1][0])[0].min() > 0.05
