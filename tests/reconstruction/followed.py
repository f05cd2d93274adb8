"""A small database of walks, somebody who follows points by it, and how such a body is looked at."""

from dataclasses import replace

import numpy as np
import pytest

import walks
from gambol.controllers.body import forward_kinematics
from gambol.controllers.body.human import STATURE
from gambol.controllers.contract import Intent
from gambol.controllers.jump import Jump, Physique
from gambol.controllers.locomotion import Locomotion, Settings
from gambol.controllers.reconstruction.control_points import parse
from gambol.controllers.reconstruction.controller import Reconstruction
from gambol.controllers.reconstruction.following.initial_pose import Starts
from gambol.controllers.reconstruction.pose_vector import SKELETON
from gambol.controllers.scaled import Scaled
from gambol.controllers.supervisor import Supervisor

DT = 1 / 60


@pytest.fixture(scope="module")
def known(tmp_path_factory):
    return walks.database(tmp_path_factory.mktemp("walks") / "walks.gambolmotion")


def build(known, points="4", height=STATURE):
    controls = parse(points, SKELETON)
    return Reconstruction(walks.method(known[0], controls), controls, height, starts=Starts.of(known[0], controls))


@pytest.fixture(scope="module")
def follower(known):
    return build(known)


@pytest.fixture(scope="module")
def clip(known):
    """Four seconds of a walk: it sets off, goes straight on and into a bend."""
    whole = known[1][0]
    return replace(whole, root=whole.root[:240], quaternions=whole.quaternions[:240])


@pytest.fixture(scope="module")
def points(follower, clip):
    return follower.controls.extract(clip)


def played(controller, state, points, dt=DT, jump=None):
    """States after each of some points; None for those that nobody wants."""
    states = []
    for now in points:
        state, _ = controller.step(state, Intent(points=now), dt)
        states.append(state)
    return states


def bodies(skeleton, states):
    """Positions (T, J, 3) [m]."""
    return forward_kinematics(skeleton, np.stack([np.asarray(s.pose.root, float) for s in states]),
                              np.stack([np.asarray(s.pose.rotations, float) for s in states]))[0]


def pulls(positions, dt=DT):
    """The largest acceleration of any joint at each moment [m/s²]."""
    return np.linalg.norm(np.diff(positions, 2, axis=0), axis=-1).max(-1) / dt**2


def person(follower, height=STATURE):
    walker = Locomotion.load(settings=Settings(idle=0.0))
    walker = walker if height == STATURE else Scaled(walker, height / STATURE)
    return Supervisor({"locomotion": walker, "jump": Jump(Physique(height=height)), "reconstruction": follower})
