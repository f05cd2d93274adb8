"""Friction: a body speeds up, brakes and goes round curves as hard as the ground can push it, and makes up for the rest."""

from dataclasses import replace

import numpy as np
import pytest

from gambol.controllers.body import Pose, anatomy, centre_of_mass
from gambol.controllers.contract import CharacterState, Intent
from gambol.controllers.locomotion.pushed import pushed
from playing import FPS, hold, play


def centre(locomotion, motion):
    """The mass centre (T, N, 3) [m]."""
    return centre_of_mass(anatomy(locomotion.skeleton), motion.positions, motion.orientations)


@pytest.fixture(scope="module")
def sprinter(locomotion):
    """Somebody at rest who is told to run at 3.5 m/s, and to stop."""
    return play(locomotion, np.concatenate([hold(0.5, (0, 0, 0)), hold(2.0, (3.5, 0, 0)), hold(2.5, (0, 0, 0))]))


def test_who_sets_off_into_a_run_pushes_no_harder_than_he_bears(locomotion, sprinter):
    """He was pushed ahead by 8.3 m/s² as he bore half of his weight."""
    com = centre(locomotion, sprinter)
    a = (com[4:] - 2 * com[2:-2] + com[:-4]) * (FPS / 2) ** 2
    assert np.linalg.norm(a[:round(2.2 * FPS), 0][:, [0, 2]], axis=-1).max() < 7.5


def test_who_lags_makes_up_for_it(locomotion, sprinter):
    lag = np.array([np.linalg.norm(s.memory["lag"][0]) for s in sprinter.states])
    assert 0.001 < lag.max() < 0.05 and lag[round(2.4 * FPS)] < 0.01 and lag[-1] == 0.0
    assert sprinter.states[-1].memory["settled"][0]


def test_it_is_felt_where_the_mass_centre_is(locomotion, sprinter):
    com, ground = centre(locomotion, sprinter), sprinter.ground[..., :2]
    felt = np.array([s.memory["mass"] for s in sprinter.states])
    felt[..., [0, 2]] += ground
    assert np.abs(felt - com).max() < 0.003


def test_who_is_taken_over_as_he_runs_goes_on_as_fast(locomotion):
    """He was not at rest before: legs need not have sped him up."""
    runner = play(locomotion, hold(3.0, (3.0, 0, 0))).states[-1]
    state = CharacterState(runner.ground[0], np.array([3.0, 0.0, 0.0]), Pose(runner.pose.root[0], runner.pose.rotations[0]), runner.contacts[0])
    wish = Intent(np.array([3.0, 0.0, 0.0]))
    state = locomotion.enter(state, wish)
    ways = []
    for _ in range(12):
        before = state.ground
        state, _ = locomotion.step(state, wish, 1 / FPS)
        ways.append(FPS * np.hypot(*(state.ground - before)[:2]))
    assert min(ways) > 2.5


def test_a_push_is_no_push_of_legs(locomotion):
    """What somebody else gives a body in a moment is not taken from it again."""
    state = play(locomotion, hold(2.0, (1.3, 0, 0))).states[-1]
    one = replace(state, ground=state.ground[0], velocity=state.velocity[0], memory=state.memory[0])
    struck = pushed(one, np.array([0.0, 0.6]))
    assert struck is not None
    assert np.allclose(struck.memory["went"] - one.memory["went"], [0.0, 0.6])
