"""Who runs up or down a slope and lets go stops there as on level ground: no foot whips ahead, none is held in the air, and nobody falls."""

from types import SimpleNamespace
from typing import NamedTuple

import numpy as np
import pytest

from gambol.controllers.body import contact_points, forward_kinematics
from gambol.controllers.contract import Intent
from gambol.controllers.locomotion.treads import steps_kernel

FPS, PEOPLE = 60, 12


class Standing(NamedTuple):
    """What is told of how high the ground lies under both feet, and how it is inclined there."""

    base: np.ndarray
    tilt: np.ndarray


def stopped(locomotion, slope, run=3.0):
    """Heels and balls (T, N, 4, 3) of runners, each in another phase, over the slope, from when they let go on, and their last state."""
    hill = (SimpleNamespace(centre=(0.0, 29.5, 0.0), size=(60.0, 1.0, 200.0), heading=0.0, slope=slope),)
    begin = np.stack([np.linspace(-20.0, 20.0, PEOPLE), np.linspace(0.0, 1.3, PEOPLE), np.zeros(PEOPLE)], -1)
    state, points = locomotion.start(begin, 30.0 + slope * begin[:, 1]), []
    for k in range(270):
        goes = np.array([run, 0.0, 0.0]) * (k < 90 + 4 * np.arange(PEOPLE) % 40)[:, None]
        state, pose = locomotion.step(state, Intent(goes, around=hill), 1 / FPS)
        if k >= 90:
            points.append(contact_points(locomotion.skeleton, *forward_kinematics(locomotion.skeleton, pose.root, pose.rotations)))
    found = np.array(points, float)
    found[..., 1] -= 30.02 + slope * found[..., 2]
    return found, state


@pytest.mark.few(1)
@pytest.mark.parametrize("slope", [-0.27, -0.2, 0.2])
def test_who_lets_go_of_a_run_on_a_slope_stops_there(locomotion, slope):
    """Downhill feet came down after the stop's last strike, and were led to their places in 0.06 s, by up to 20 m/s; soles stayed 5 cm over the slope."""
    points, state = stopped(locomotion, slope)
    assert np.linalg.norm(np.diff(points, axis=0), axis=-1).max() * FPS < 9.5
    assert np.abs(state.velocity).max() < 0.05 and state.memory["settled"].mean() > 0.9
    moves = np.linalg.norm(np.gradient(points, 1 / FPS, axis=0), axis=-1).reshape(*points.shape[:2], 2, 2).max(-1)
    high = points[..., 1].reshape(*points.shape[:2], 2, 2).min(-1)
    assert (high[moves < 0.1] < 0.02).mean() > 0.99, "a foot that is still stands on the ground"


def test_a_slope_is_no_step_however_long_the_stride():
    """A runner's stride down 15° leads down by more than a step: his foot was held up in the air in place of coming down."""
    one = Standing(np.zeros(2), np.zeros((2, 2)))
    ground, stride = np.array([-0.35, 0.0, -0.27]), 1.3
    assert abs(steps_kernel(one, 0, ground, 0.0, stride)) < 0.01
    one.tilt[1, 1] = -0.27
    assert abs(steps_kernel(one, 0, np.array([-0.35, 0.0, 0.0]), 0.0, stride)) < 0.01, "nor is the floor that a slope leads down to"
    one.tilt[1, 1] = 0.0
    assert steps_kernel(one, 0, np.array([-0.35, 0.0, 0.0]), 0.0, stride) == pytest.approx(-0.35), "but a box's edge is"


def hills(x, z):
    """How high hills are at a place [m], and how they rise there (2,)."""
    rise = np.array([0.3 * np.cos(0.5 * x) * np.cos(0.4 * z), -0.24 * np.sin(0.5 * x) * np.sin(0.4 * z)])
    return 0.6 + 0.6 * np.sin(0.5 * x) * np.cos(0.4 * z), rise


def ramps(x, z):
    """The hills about a place, as ramps of 25 cm."""
    made = []
    for a in 0.25 * (round(4.0 * x) + np.arange(-6, 7)):
        for b in 0.25 * (round(4.0 * z) + np.arange(-6, 7)):
            high, rise = hills(a, b)
            made.append(SimpleNamespace(centre=(a, 0.5 * high, b), size=(0.25, high, 0.25), heading=float(np.arctan2(*rise)), slope=float(np.hypot(*rise))))
    return tuple(made)


def test_a_foot_that_lets_go_on_a_hill_is_not_pulled_up_by_as_much_as_the_pelvis_was_lowered(locomotion):
    """It was, within a frame, by 3.7 cm, and its knee whipped by 6.5 m/s."""
    state, knees, cell = locomotion.start((0.0, 0.0, 0.3), float(hills(0.0, 0.0)[0])), [], None
    bones = [locomotion.skeleton.index(name) for name in ("LeftLeg", "RightLeg")]
    for k in range(645):
        if cell != (cell := tuple(np.round(4.0 * state.ground[:2]))):
            around = ramps(*state.ground[:2])
        goes = np.array([1.2, 0.15, 0.0]) * (k % 240 < 120)
        state, pose = locomotion.step(state, Intent(goes, around=around), 1 / FPS)
        knees.append(forward_kinematics(locomotion.skeleton, pose.root, pose.rotations)[0][bones])
    assert FPS * np.linalg.norm(np.diff(knees, 2, axis=0), axis=-1).max() < 5.5
