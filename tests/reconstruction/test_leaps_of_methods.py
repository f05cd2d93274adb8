"""What a method leaps is shown as what fades, by a follower alone: no world, no other controller."""

from dataclasses import replace

import numpy as np
import pytest

from followed import DT
from gambol.controllers.body import Pose, exp, log, settle
from gambol.controllers.reconstruction.control_points import parse
from gambol.controllers.reconstruction.controller import Reconstruction
from gambol.controllers.reconstruction.follower import HURRY, Following
from gambol.controllers.reconstruction.following.hand_over import difference, moved, unbroken
from gambol.controllers.reconstruction.following.leaps import LEAP, TAKEN
from gambol.controllers.reconstruction.following.point_gate import Doubts, Gate
from gambol.controllers.reconstruction.pose_vector import SKELETON


class Leaper:
    """A method whose body stands at its first point and whose left knee is bent by what its second one says."""

    def begin(self, frames, tracks):
        return None

    def step(self, memory, points):
        rotations = np.tile(np.eye(3), (len(SKELETON), 1, 1))
        rotations[SKELETON.index("LeftLeg")] = exp(np.array([points[1, 0], 0.0, 0.0]))
        return None, Pose(points[0] + [0.0, 0.9, 0.0], rotations)


def going(controller, frames):
    """What is remembered after the first two of frames (T, n, 3) that go evenly."""
    before, pose = (controller.method.step(None, frame)[1] for frame in frames[:2])
    zero = np.zeros((1 + len(SKELETON), 3))
    return Following(None, Gate.before(frames[0], frames[1] - frames[0]), frames[0], pose, before, 0.0, zero, zero,
                     (np.full((2, 3), np.nan), np.full((2, 3, 3), np.nan)), Doubts.of(2))


@pytest.mark.parametrize("bent", [0.0, 1.0])
@pytest.mark.parametrize("noise", [0.05, 0.1])
def test_one_frame_of_noise_is_no_motion_that_a_body_is_thrown_on_with(noise, bent):
    """Poses shake by `noise`, one is off by nearly as much; the next one, back where it belongs, is a leap, but from no such pace, a knee that nobody sees leaping or not."""
    controls = parse("root,lwrist", SKELETON)
    controller = Reconstruction(Leaper(), controls)
    frames = np.zeros((90, 2, 3))
    following, off = going(controller, frames), []
    for k in range(2, len(frames)):
        pose = controller.method.step(None, frames[k] + (k == 40) * np.array([[0.9 * noise, 0.0, 0.0], [bent, 0.0, 0.0]]))[1]
        controller.method.step = lambda memory, points, pose=pose: (None, pose)
        following = replace(following, gate=replace(following.gate, rough=np.full(2, noise), heard=np.ones(2)))
        following = controller.follower.frame(following, frames[k], np.full((2, 3, 3), np.nan))
        del controller.method.step
        offset, rate = settle(following.offset, following.rate, following.fade, DT)
        following = replace(following, offset=offset, rate=rate)
        off.append(np.abs(moved(following.pose, offset).root[0]))
    assert max(off) < 1.4 * noise and off[-1] < 0.01  # thrown on it is 1.5 to 1.6 times as far off


def shown(controller, following, seen, made):
    """Poses as they are shown for points seen (T, n, 3), where the method makes its body of others, made (T, n, 3)."""
    poses = []
    for point, other in zip(seen, made):
        pose = controller.method.step(None, other)[1]
        controller.method.step = lambda memory, points, pose=pose: (None, pose)
        following = controller.follower.frame(following, point, np.full((2, 3, 3), np.nan))
        del controller.method.step
        offset, rate = settle(following.offset, following.rate, following.fade, DT)
        following = replace(following, offset=offset, rate=rate)
        poses.append(moved(following.pose, offset))
    return poses


def minimum_jerk(share):
    share = np.clip(share, 0.0, 1.0)
    return share**3 * (10.0 - 15.0 * share + 6.0 * share**2)


@pytest.mark.parametrize("far, lasts", [(0.35, 0.12), (0.8, 0.2)])
def test_what_points_do_themselves_is_no_leap(far, lasts):
    """A blow, up to 140 m/s²: whoever is seen to move so is shown so. Taken for leaps it was up to a metre behind."""
    controller = Reconstruction(Leaper(), parse("root,lwrist", SKELETON))
    frames = np.zeros((60, 2, 3))
    frames[:, :, 2] = (far * minimum_jerk((DT * np.arange(60) - 0.3) / lasts))[:, None]
    poses = shown(controller, going(controller, frames), frames[2:], frames[2:])
    behind = np.abs([pose.root[2] for pose in poses] - frames[2:, 0, 2])
    assert behind.max() < 0.08 and behind[30:].max() < 0.03


def test_another_pace_is_taken_over_as_soon_as_it_is_one():
    """A method's body, not its points, suddenly goes at 5 m/s: it leaps once, by what one frame is; never is its pace caught up with by a little each frame."""
    controller = Reconstruction(Leaper(), parse("root,lwrist", SKELETON))
    seen, made = np.zeros((2, 60, 2, 3))
    made[:, 0, 2] = np.maximum(np.arange(60) - 20, 0) * 5.0 * DT
    places = np.array([pose.root[2] for pose in shown(controller, going(controller, seen), seen[2:], made[2:])])
    assert np.abs(places - made[2:, 0, 2]).max() < 0.14 and abs(places[-1] - made[-1, 0, 2]) < 0.01
    assert np.abs(np.diff(places, 2)).max() < 0.5 * 5.0 * DT


def test_a_limb_on_which_nothing_is_seen_leaps_alone():
    """The knee leaps to where it is bent while hips sway: these are shown where they are, the knee fades."""
    controller = Reconstruction(Leaper(), parse("root,lwrist", SKELETON))
    frames = np.zeros((60, 2, 3))
    frames[:, 0, 2], frames[30:, 1, 0] = 0.2 * np.sin(4.0 * DT * np.arange(60)), 1.0
    poses, knee = shown(controller, going(controller, frames), frames[2:], frames[2:]), SKELETON.index("LeftLeg")
    bent = np.array([np.linalg.norm(log(pose.rotations[knee])) for pose in poses])
    assert np.allclose([pose.root[2] for pose in poses], frames[2:, 0, 2], atol=1e-9)
    assert np.abs(np.diff(bent)).max() < 0.3 and bent[-1] > 0.95


@pytest.mark.parametrize("away", [0.1, 0.5, 0.7])
def test_what_a_method_leaps_fades_and_no_joint_is_hurried(away):
    """It goes at 1.2 m/s, leaps, and goes on: nothing pops, soon it is there, and how fast it goes is never lost."""
    controls = parse("root,lwrist", SKELETON)
    controller = Reconstruction(Leaper(), controls)
    frames = np.zeros((120, 2, 3))
    frames[:, 0, 2] = 0.02 * np.arange(120)
    following = going(controller, frames)
    frames[40:, 0, 0] = away
    places = np.array([pose.root for pose in shown(controller, following, frames[2:], frames[2:])])
    pace = np.diff(places, axis=0) / DT
    assert np.abs(pace[:, 2] - 1.2).max() < 0.02
    assert np.abs(pace[:, 0]).max() < HURRY + TAKEN / DT
    assert np.abs(np.diff(pace, axis=0)).max() * DT < LEAP
    assert abs(places[-1][0] - away) < 0.01


def test_no_knee_is_shown_bent_back_where_what_fades_leads_beyond_straight():
    straight, bent = (Leaper().step(None, np.array([[0.0] * 3, [angle, 0.0, 0.0]]))[1] for angle in (0.0, 1.2))
    offset = difference(straight, bent)  # shown straight as it leapt to bent; then the leg straightens
    knee = SKELETON.index("LeftLeg")
    assert np.allclose(unbroken(moved(straight, offset), straight).rotations[knee], np.eye(3), atol=1e-9)
    assert np.array_equal(unbroken(moved(bent, offset), bent).rotations, moved(bent, offset).rotations)
