"""Whoever follows a plan is where it says, and stands at the goal at its end."""

import numpy as np
import pytest

from gambol.controllers.body.rotations import wrap
from gambol.controllers.body.springs import spring_kernel
from gambol.controllers.contract import Intent
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.navigation import Following, arrived, wish
from gambol.controllers.navigation.planning import Plan, plan


@pytest.fixture(scope="module")
def walker():
    return Locomotion.load()


@pytest.mark.few(2)
@pytest.mark.parametrize("goal", [(0.0, 2.5, 0.0), (1.5, 1.0, -1.0), (-1.0, -2.0, 2.0), (0.6, 0.0, 0.0)])
def test_a_walker_follows_a_plan_to_its_goal(walker, goal):
    made = plan(np.zeros(3), goal, limits=walker.walk.half_spaces(0.9))
    state, off, time = walker.start(), [], 0.0
    while time < made.seconds + 3.0:
        ready = walker.readiness(state)
        state, _ = walker.step(state, Intent(wish(made, time, state.ground, state.velocity)), 1 / 60)
        time += ready / 60
        where, _ = made.at(time)
        if time < made.seconds:
            off.append((np.hypot(*(where - state.ground)[:2]), abs(wrap(where[2] - state.ground[2]))))
    assert np.mean(off, 0)[0] < 0.015 and np.degrees(np.mean(off, 0)[1]) < 2.2
    assert np.hypot(*(made.goal - state.ground)[:2]) < 0.03 and abs(wrap(made.goal[2] - state.ground[2])) < np.radians(3)
    assert arrived(made, time, state.ground) and np.abs(state.velocity).max() < 1e-6, "and he stands"


def test_the_springs_that_take_up_wishes_are_inverted():
    """Without feedback, springs of the same half-lives move as planned."""
    made, follow = plan(np.zeros(3), (1.0, 2.0, 0.7)), Following(place=0.0, heading=0.0, speed=0.0)
    dt = 1 / 240
    halflives = follow.halflife, follow.turning_halflife, follow.halflife
    velocity, rate = made.at(0.0)[1], made.acceleration(0.0)
    for tick in range(int(made.seconds / dt) - 1):
        wanted = wish(made, (tick + 0.5) * dt, np.zeros(3), velocity, follow)
        for i in range(3):
            velocity[i], rate[i] = spring_kernel(velocity[i], rate[i], wanted[i], halflives[i], dt)
        assert np.abs(velocity - made.at((tick + 1) * dt)[1]).max() < 0.02


def test_whoever_is_off_is_led_back():
    made = plan(np.zeros(3), (0.0, 3.0, 0.0))
    ground, velocity = made.at(1.0)
    at_it = wish(made, 1.0, ground, velocity)
    assert wish(made, 1.0, ground - [0, 0.1, 0], velocity)[0] > at_it[0], "faster who is behind"
    assert wish(made, 1.0, ground - [0.1, 0, 0], velocity)[2] > at_it[2], "to the left who is too far right"
    assert wish(made, 1.0, ground - [0, 0, 0.1], velocity)[1] > at_it[1], "to the left who looks too far right"
    assert wish(made, 1.0, ground + [0, 0, 2 * np.pi], velocity) == pytest.approx(at_it), "whole turns are no turns"


def test_whoever_has_arrived_or_has_no_plan_wishes_nothing():
    made = plan(np.zeros(3), (0.0, 1.0, 0.0))
    assert not arrived(made, 0.5 * made.seconds, made.goal) and arrived(made, made.seconds, made.goal)
    assert not wish(made, made.seconds + 1, made.goal, np.zeros(3)).any()
    assert wish(made, made.seconds + 1, made.goal - [0, 0.1, 0], np.zeros(3))[0] > 0.1
    assert not wish(Plan.none(np.zeros(3), made.goal, "no way"), 0.3, np.zeros(3), np.zeros(3)).any()
