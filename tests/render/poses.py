"""Figures and cameras for the drawing tests."""

import numpy as np

from gambol.controllers.body import forward_kinematics, human
from gambol.controllers.body.rotations import exp, yaw
from gambol.game.scene.scene import Camera, Figure

HUMAN = human()


def camera(eye=(2.2, 1.5, 3.2), target=(0.0, 0.9, 0.0), fov=0.7):
    return Camera(np.array(eye, float), np.array(target, float), fov=fov)


def figure(heading=0.0, at=(0.0, 0.0), lift=0.0, skeleton=HUMAN, options=None, **turns):
    """A figure whose joints turn by rotation vectors in degrees; its lower foot stands on the floor."""
    rotvecs = np.zeros((len(skeleton), 3))
    for name, value in turns.items():
        rotvecs[skeleton.index(name)] = np.radians(value)
    rotations = exp(rotvecs)
    rotations[0] = yaw(heading) @ rotations[0]
    positions, orientations = forward_kinematics(skeleton, np.array([at[0], 1.0, at[1]]), rotations)
    toes = positions[[skeleton.index("LeftToe"), skeleton.index("RightToe")], 1]
    positions[:, 1] += 0.02 * skeleton.offsets[0, 1] / HUMAN.offsets[0, 1] - toes.min() + lift
    return Figure(positions, orientations, **(options or {}))


STAND = dict(LeftArm=(0, 0, -75), RightArm=(0, 0, 75), LeftForeArm=(0, -15, 0), RightForeArm=(0, 15, 0))
STRIDE = dict(STAND, LeftUpLeg=(-28, 0, 0), LeftLeg=(12, 0, 0), LeftFoot=(14, 0, 0), RightUpLeg=(16, 0, 0),
              RightLeg=(32, 0, 0), RightToe=(-20, 0, 0), Spine2=(0, -8, 0), RightForeArm=(0, 45, 0))
CROUCH = dict(LeftUpLeg=(-110, 0, 10), RightUpLeg=(-110, 0, -10), LeftLeg=(135, 0, 0), RightLeg=(135, 0, 0),
              LeftFoot=(-25, 0, 0), RightFoot=(-25, 0, 0), Spine=(25, 0, 0), Spine1=(15, 0, 0),
              LeftArm=(0, -60, -30), RightArm=(0, 60, 30), LeftForeArm=(0, -60, 0), RightForeArm=(0, 60, 0))
