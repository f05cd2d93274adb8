"""A body whose method climbs, hops, shakes or comes to no pose: it stays a body, and near."""

from dataclasses import replace

import numpy as np
import pytest

from followed import DT, bodies, clip, follower, known, person, played, points, pulls  # noqa: F401, fixtures among them
from gambol.controllers.body import Pose
from gambol.controllers.body.rotations import exp
from gambol.controllers.contract import Intent
from gambol.controllers.reconstruction.controller import Reconstruction
from gambol.controllers.reconstruction.evaluation.metrics import position_error
from gambol.controllers.reconstruction.pose_vector import SKELETON


class Climbing:
    """A method that knows how far up (T, 3) [m] the points have come since it began, and how a body moves on the flat."""

    def __init__(self, method, climb):
        self.method, self.climb = method, climb

    def begin(self, frames, tracks):
        return self.method.begin(frames, tracks), 1

    def step(self, memory, points):
        inner, pose = self.method.step(memory[0], points - self.climb[memory[1]])
        return (inner, memory[1] + 1), Pose(pose.root + self.climb[memory[1]], pose.rotations)


def test_contacts_follow_a_platform_and_points_do_not(follower, clip, points):
    """The points climb 0.3 m, and then the floor is said to be there: contacts and errors are those of the flat."""
    climb = 0.3 * np.clip((np.arange(len(points)) - 60) / 60, 0.0, 1.0)[:, None] * [0.0, 1.0, 0.0]
    up = points + climb[:, None]
    climber = Reconstruction(Climbing(follower.method, climb), follower.controls, starts=follower.starts)

    def on(floors):
        state, states = climber.begin(points[0]), []
        for now, floor in zip(up[1:], floors):
            state, _ = climber.step(replace(state, floor=floor), Intent(points=now), DT)
            states.append(state)
        return states
    top = np.where(np.arange(1, len(points)) < 120, 0.0, 0.3)
    told, flat, never = on(top), played(follower, follower.begin(points[0]), points[1:]), on(0.0 * top)
    after, truth = slice(130, None), clip.kinematics()[0][1:]
    assert np.mean([np.array_equal(a.contacts, b.contacts) for a, b in zip(told[after], flat[after])]) > 0.97
    assert not any(state.contacts.any() for state in never[after])
    off, level = (position_error(bodies(SKELETON, states), where) for states, where in
                  ((told, truth + climb[1:, None]), (flat, truth)))
    assert np.abs(off - level).max() < 0.002
    again = climber.enter(replace(told[-1], memory=None), Intent(points=up[-1]))
    assert again.memory.level == 0.3, "begun there, points are told from there"


def test_a_method_that_comes_to_no_pose_is_a_failure_and_not_a_broken_body(follower, points):
    class Broken:
        def begin(self, frames, tracks):
            return follower.method.begin(frames, tracks)

        def step(self, memory, points):
            memory, pose = follower.method.step(memory, points)
            return memory, Pose(pose.root * np.nan, pose.rotations)
    broken = Reconstruction(Broken(), follower.controls, starts=follower.starts)
    someone = person(broken)
    states = played(someone, someone.enter(follower.begin(points[0]), Intent()), points[1:4])
    assert np.isfinite(bodies(SKELETON, states)).all()
    assert "no pose" in broken.status(replace(states[0], memory=states[0].memory.memory)).reason


class Hopping:
    """A method that changes its mind every few frames: it hops aside and back by `far` metres."""

    def __init__(self, method, far, every):
        self.method, self.far, self.every = method, far, every

    def begin(self, frames, tracks):
        return self.method.begin(frames, tracks), 0

    def step(self, memory, points):
        inner, pose = self.method.step(memory[0], points)
        aside = self.far if memory[1] // self.every % 2 else 0.0
        return (inner, memory[1] + 1), Pose(pose.root + [aside, 0.0, 0.0], pose.rotations)


@pytest.mark.few(1)
@pytest.mark.parametrize("every", [1, 2, 60])
def test_a_method_that_hops_makes_no_body_hop_and_keeps_it_near(follower, clip, points, every):
    hopping = Reconstruction(Hopping(follower.method, 0.4, every), follower.controls, starts=follower.starts)
    positions = bodies(SKELETON, played(hopping, hopping.begin(points[0]), points[1:]))
    truth = clip.kinematics()[0][1:]
    assert 0.4 / DT**2 > 1400 and pulls(positions).max() < 200
    assert position_error(positions, truth).max() < 0.45


class Shaking(Hopping):
    """A method that shakes all joints, by chance and so hard that it leaps every other frame."""

    def step(self, memory, points):
        inner, pose = self.method.step(memory[0], points)
        rng = np.random.default_rng(memory[1])
        return (inner, memory[1] + 1), Pose(pose.root + self.far * rng.normal(size=3),
                                            pose.rotations @ exp(0.1 * rng.normal(size=(len(SKELETON), 3))))


def test_leaps_upon_leaps_carry_no_body_away(follower, clip, points):
    shaking = Reconstruction(Shaking(follower.method, 0.1, 1), follower.controls, starts=follower.starts)
    positions = bodies(SKELETON, played(shaking, shaking.begin(points[0]), points[1:]))
    assert position_error(positions, clip.kinematics()[0][1:]).max() < 0.6


@pytest.mark.few(1)
@pytest.mark.parametrize(("angle", "rate", "high"), [(1.5, 9.0, 0.0), (1.0, 12.0, 0.0), (2.0, 6.0, 0.2)])
def test_who_dances_is_shown_near_his_own_points(follower, clip, points, angle, rate, high):
    """Who turns about and back, faster than a method's body goes on evenly, makes no leaps: he is shown hardly farther from his points than the method has him."""
    time = np.arange(len(points)) * DT
    turn, hips = exp(angle * np.sin(rate * time)[:, None] * [0.0, 1.0, 0.0]), clip.root[:, None]
    danced = np.einsum("tij,tnj->tni", turn, points - hips) + hips + (high * np.sin(rate * time) ** 2)[:, None, None] * [0.0, 1.0, 0.0]
    states = played(follower, follower.begin(danced[0], (danced[1] - danced[0]) / DT), danced[1:])
    shown, known = (np.array([np.linalg.norm(follower.follower.points(pose) - now, axis=-1) for pose, now in zip(poses, danced[1:])])
                    for poses in ([state.pose for state in states], [state.memory.pose for state in states]))
    assert shown.max() < known.max() + 0.05 and shown.mean() < 0.032
