"""A small database of Gambol's own walking, and a method that is learnt from it in a moment."""

import numpy as np
from scipy.spatial.transform import Rotation

from gambol.controllers.body import Clip
from gambol.controllers.contract import Intent
from gambol.controllers.locomotion import Locomotion
from gambol.controllers.reconstruction.database.database import Database, Writer
from gambol.controllers.reconstruction.neighbours.search import Exact
from gambol.controllers.reconstruction.neighbours.segments import Segments
from gambol.controllers.reconstruction.pose_vector import encode
from gambol.controllers.reconstruction.regression.local_regression import Regression
from gambol.controllers.reconstruction.regression.map_solver import Solver
from gambol.controllers.reconstruction.regression.method import Local, LocalRegression, Method

FPS = 60
WISHES = ([(1, 0, 0, 0), (2, 1.2, 0, 0), (2, 1.0, 0.6, 0), (1.5, 0, 0, 0)], [(0.5, 0, 0, 0), (2, 0.7, 0, 0.3), (1, 0, 0, 0)])


def walked(walker, wishes):
    """A clip of a walk after wishes: seconds, forward [m/s], yaw [rad/s] and leftward velocity [m/s]."""
    state, poses = walker.start(), []
    for seconds, *velocity in wishes:
        for _ in range(round(seconds * FPS)):
            state, pose = walker.step(state, Intent(np.array(velocity, float)), 1 / FPS)
            poses.append(pose)
    rotations = np.stack([pose.rotations for pose in poses]).astype(float)
    return Clip("walk", walker.skeleton, 1 / FPS, np.stack([pose.root for pose in poses]).astype(float),
                Rotation.from_matrix(rotations).as_quat())


def database(path):
    """A database of two walks, and the walks."""
    clips = [walked(Locomotion.load(), wishes) for wishes in WISHES]
    with Writer(path) as writer:
        for number, clip in enumerate(clips):
            frames, _ = encode(clip.root, clip.rotations, clip.frame_time)
            writer.add(f"walk {number}", "Gambol", "walk", frames, np.ones(len(frames), bool))
    return Database.open(path), clips


def method(known, controls):
    """Local regression on a database's nearest segments."""
    segments = Segments.of(known, 3, 4, controls.joints)
    model = LocalRegression(Regression(covariance="full", loosening=1000.0))
    return Method(Local(model, Exact(segments), 50), Solver(controls, 1 / known.fps))
