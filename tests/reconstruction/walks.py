"""A small database of Gambol's own walking, and a method that is learnt from it in a moment."""

import numpy as np
from scipy.spatial.transform import Rotation

from controllers.body import Clip
from controllers.contract import Intent
from controllers.locomotion import Locomotion
from controllers.reconstruction.chart import encode
from controllers.reconstruction.database import Database, Writer
from controllers.reconstruction.method import Local, LocalRegression, Method
from controllers.reconstruction.neighbours import Exact
from controllers.reconstruction.prior import Regression
from controllers.reconstruction.segments import Segments
from controllers.reconstruction.solver import Solver

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
