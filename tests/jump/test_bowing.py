"""Who shifts his weight before he goes down waits with trunk and arms, and bows as he crouches, as recorded people do."""

from dataclasses import replace

import numpy as np
import pytest

from gambol.controllers.body import forward_kinematics, heading_of, log
from gambol.controllers.contract import Intent, Leap
from gambol.controllers.locomotion import Locomotion

from conftest import FPS, ahead


@pytest.fixture(scope="module")
def shifting(jump):
    """Far leaps of somebody who has stood for three seconds, his weight on one leg."""
    walk = Locomotion.load()
    state = walk.start()
    for _ in range(200):
        before = state
        state, _ = walk.step(state, Intent(), 1 / FPS)
    state = replace(state, previous=before.pose, elapsed=1 / FPS)
    return [jump.plan(state, Intent(leap=Leap(ahead(state, far)))) for far in (1.3, 1.6)]


def test_a_wind_up_that_takes_longer_than_the_way_down_bows_no_straight_legs(jump, shifting):
    for made in shifting:
        assert made.path.wind_up > made.path.dip + 0.1, "or this is no test"
        times = np.arange(0.0, made.push_off, 1 / FPS)
        shown = [made.at(t) for t in times]
        local = np.stack([pose.rotations for pose in shown])
        _, turned = forward_kinematics(jump.skeleton, np.stack([pose.root for pose in shown]), local)
        chest, facing = turned[:, jump.skeleton.index("Spine2")], heading_of(turned[:, 0, :, 2])
        bowed = np.degrees(np.arctan2(chest[:, 0, 1] * np.sin(facing) + chest[:, 2, 1] * np.cos(facing), chest[:, 1, 1]))
        knee = np.degrees(np.linalg.norm(log(local[:, [jump.skeleton.index(side + "Leg") for side in ("Left", "Right")]]), axis=-1)).mean(1)
        assert bowed.max() > 45.0
        assert knee[int(np.argmax(bowed > 45.0))] > 40.0, "recorded people's are bent by 40 … 68° then"
