"""An adult who jumps, and the states it jumps from: at rest, and a runner whose foot has just struck."""

from dataclasses import replace

import numpy as np
import pytest

from controllers.contract import Intent, Leap
from controllers.jump.controller import Jump
from controllers.locomotion import Locomotion

FPS = 60


@pytest.fixture(scope="session")
def locomotion():
    return Locomotion.load()


@pytest.fixture(scope="session")
def jump():
    return Jump()


@pytest.fixture(scope="session")
def standing(locomotion):
    return replace(locomotion.step(locomotion.start(), Intent(), 1 / FPS)[0], elapsed=0.0)


@pytest.fixture(scope="session")
def running(locomotion, jump):
    wish, state = np.array([2.8, 0.0, 0.0]), locomotion.start()
    for k in range(400):
        before = state
        state, _ = locomotion.step(state, Intent(wish), 1 / FPS)
        state = replace(state, previous=before.pose, elapsed=1 / FPS)
        if k > 150 and jump.precondition(state, Intent(wish, Leap(ahead(state, 2.0)))) > 0.0:
            return state
    raise AssertionError("a runner never came to jump")


def ahead(state, far, up=0.0):
    """The place so far ahead of and above a body [m]."""
    s, c = np.sin(state.ground[2]), np.cos(state.ground[2])
    return np.array([state.ground[0] + far * s, float(state.floor) + up, state.ground[1] + far * c])


@pytest.fixture(scope="session")
def plans(jump, standing, running):
    """Jumps of many kinds: name, jumper, start, plan."""
    moon = Jump(gravity=(0.0, -1.62, 0.0))
    asked = (("up", jump, standing, 0.05, 0.0, 0.5), ("far", jump, standing, 0.8, 0.0, None),
             ("onto", jump, standing, 0.6, 0.25, None), ("down", jump, standing, 0.8, -0.8, None),
             ("on the Moon", moon, standing, 1.0, 0.0, None), ("at a run", jump, running, 2.2, 0.0, None))
    return {name: (who, state, who.plan(state, Intent(leap=Leap(ahead(state, far, up), airtime))))
            for name, who, state, far, up, airtime in asked}
