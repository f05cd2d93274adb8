"""An adult who jumps, and the states it jumps from: at rest, and a runner whose foot has just struck."""

from dataclasses import replace

import numpy as np
import pytest

from gambol.controllers.contract import Intent, Leap
from gambol.controllers.jump.controller import Jump
from gambol.controllers.locomotion import Locomotion, Settings
from gambol.controllers.supervisor import Supervisor

FPS = 60


@pytest.fixture(scope="session")
def locomotion():
    return Locomotion.load(settings=Settings(idle=0.0))


@pytest.fixture(scope="session")
def jump():
    return Jump()


@pytest.fixture(scope="session")
def person(locomotion, jump):
    """Who walks, runs and jumps."""
    return Supervisor({"locomotion": locomotion, "jump": jump})


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


ASKED = {"up": (0.05, 0.0, 0.5), "far": (0.8, 0.0, None), "onto": (0.6, 0.25, None), "down": (0.8, -0.8, None),
         "on the Moon": (1.0, 0.0, None), "at a run": (2.2, 0.0, None)}
"""How far and how high [m], and for how long [s], jumps of many kinds go."""


@pytest.fixture(scope="session")
def starts(jump, standing, running):
    """Who jumps and from which state, by name."""
    moon = Jump(gravity=(0.0, -1.62, 0.0))
    return {name: (moon if name == "on the Moon" else jump, running if name == "at a run" else standing) for name in ASKED}


@pytest.fixture(scope="session")
def places(starts):
    """Where they shall land (3,) [m]."""
    return {name: ahead(starts[name][1], far, up) for name, (far, up, _) in ASKED.items()}


@pytest.fixture(scope="session")
def plans(starts, places):
    """Name, jumper, start, plan."""
    return {name: (who, state, who.plan(state, Intent(leap=Leap(places[name], ASKED[name][2]))))
            for name, (who, state) in starts.items()}
