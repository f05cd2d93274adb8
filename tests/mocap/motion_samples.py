"""Skeletons, clips and files made up for the tests of the readers."""

import numpy as np
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from gambol.controllers.body import Clip, Skeleton, end_positions, human

seeds = st.integers(0, 2**32 - 1)
"""Seeds of generators: the arrays are drawn by numpy, what a failure needs to be found again is one number."""


def random_clip(seed: int, joints: int = 6, frames: int = 3) -> Clip:
    """Any tree, in any order that puts parents before children, in any pose, a few metres large."""
    rng = np.random.default_rng(seed)
    parents = np.array([-1] + [rng.integers(0, j) for j in range(1, joints)])
    ends = rng.integers(0, joints, rng.integers(0, joints + 1))
    skeleton = Skeleton(tuple(f"joint{j}" for j in range(joints)), parents,
                        rng.uniform(-0.5, 0.5, (joints, 3)), ends, rng.uniform(-0.2, 0.2, (len(ends), 3)))
    quaternions = Rotation.random(frames * joints, rng=rng).as_quat().reshape(frames, joints, 4)
    quaternions[:, 0] = Rotation.from_euler("ZXY", [0.3, np.pi / 2, 0.2]).as_quat()  # gimbal lock
    return Clip("random", skeleton, rng.uniform(0.001, 0.1), rng.uniform(-3, 3, (frames, 3)), quaternions)


def named_points(clip: Clip) -> tuple[dict, list]:
    """World positions (T, 3) of the joints by name, and of the end sites in a settled order."""
    positions, orientations = clip.kinematics()
    ends = end_positions(clip.skeleton, positions, orientations)
    order = sorted(range(ends.shape[1]), key=lambda e: tuple(np.round(ends[0, e], 3)))
    return {name: positions[:, j] for j, name in enumerate(clip.skeleton.names)}, [ends[:, e] for e in order]


def standing(frames: int = 40, seed: int = 0) -> Clip:
    """The standard human standing with its arms down, swaying a little."""
    rng = np.random.default_rng(seed)
    body = human()
    sway = np.cumsum(rng.normal(0, 0.002, (frames, len(body), 3)), axis=0)
    sway[:, body.index("LeftArm"), 2] -= 1.4
    sway[:, body.index("RightArm"), 2] += 1.4
    root = np.tile(body.offsets[0], (frames, 1))
    root[:, 2] += np.linspace(0, 0.1, frames)
    return Clip("standing", body, 1 / 60, root, Rotation.from_rotvec(sway).as_quat())


BVH = """HIERARCHY
ROOT Hips
{
\tOFFSET 0 0 0
\tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
\tJOINT LeftFoot
\t{
\t\tOFFSET 1 -2 3
\t\tCHANNELS 3 Zrotation Xrotation Yrotation
\t\tEnd Site
\t\t{
\t\t\tOFFSET 0 -1 0.5
\t\t}
\t}
}
MOTION
Frames: 2
Frame Time: 0.01
1 2 3 10 20 30 40 50 60
1.5 2 3 1e1 -20 3.0E+1 -4e-1 .5 60.
"""

ASF = """# a chain of three bones
:version 1.10
:name chain
:units
  mass 1.0
  length 0.5
  angle deg
:root
   order TX TY TZ RX RY RZ
   axis XYZ
   position 0 0 0
   orientation 0 0 0
:bonedata
  begin
     id 1
     name thigh
     direction 0 -1 0
     length 8
     axis 10 20 30 XYZ
     dof rx ry rz
     limits (-160.0 20.0)
            (-70.0 70.0)
            (-60.0 70.0)
  end
  begin
     id 2
     name shin
     direction 0.6 -0.8 0
     length 7
     axis 0 0 20 ZYX
     dof rx
  end
  begin
     id 3
     name toe
     direction 0 0 1
     length 2
     axis 0 0 0 XYZ
  end
:hierarchy
  begin
    root thigh
    thigh shin
    shin toe
  end
"""

AMC = """#!OML:ASF
:FULLY-SPECIFIED
:DEGREES
1
root 1 2 3 10 20 30
thigh 40 -50 60
shin 25
2
root 1.5 2 3 1e1 20 30
thigh 41 -51 6.1e-015
shin -2.5
"""
