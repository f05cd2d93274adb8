"""Control points: the paper's sets, any others, and what is said of wrong ones."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from gambol.controllers.body import Clip, forward_kinematics, human
from gambol.controllers.reconstruction.control_points import NAMES, SETS, parse

BODY = human()
JOINTS_OF_SETS = {
    "2": "LeftHand RightFoot",
    "3": "LeftHand LeftFoot RightFoot",
    "4": "LeftHand RightHand LeftFoot RightFoot",
    "5": "Hips LeftHand RightHand LeftFoot RightFoot",
    "6": "Head Hips LeftHand RightHand LeftFoot RightFoot",
    "liu": "Head Spine1 LeftHand RightHand LeftFoot RightFoot",
}


@pytest.mark.parametrize("name", JOINTS_OF_SETS)
def test_sets_are_the_papers(name):
    points = parse(name, BODY)
    assert " ".join(BODY.names[j] for j in points.joints) == JOINTS_OF_SETS[name]
    assert points.names == SETS[name] and not points.offsets.any()
    assert len(points) == len(SETS[name])


def test_every_name_is_a_joint_and_joints_serve_as_names():
    assert set(NAMES.values()) <= set(BODY.names)
    assert parse(",".join(NAMES), BODY).joints.tolist() == [BODY.index(joint) for joint in NAMES.values()]
    assert parse(",".join(BODY.names), BODY).joints.tolist() == list(range(len(BODY)))
    assert parse(" LWRIST , lefthand+0/0.1/0", BODY).joints.tolist() == [BODY.index("LeftHand")] * 2


def test_points_move_with_their_joints():
    rng = np.random.default_rng(5)
    quaternions = Rotation.random((4 * len(BODY)), rng=rng).as_quat().reshape(4, -1, 4)
    clip = Clip("any", BODY, 1 / 60, rng.normal(size=(4, 3)), quaternions)
    points = parse("head+0.1/-0.2/0.3,root", BODY)
    positions, orientations = forward_kinematics(BODY, clip.root, clip.rotations)
    head = BODY.index("Head")
    at = points.extract(clip)
    assert at.shape == (4, 2, 3)
    assert np.allclose(at[:, 0], positions[:, head] + orientations[:, head] @ [0.1, -0.2, 0.3])
    assert np.allclose(at[:, 1], clip.root)


@pytest.mark.parametrize("text, complaint", [
    ("lwrist,lfinger", "no control point 'lfinger': there are root, torso"),
    ("7", "or a set of the paper: 2, 3"),
    ("", "no control points"),
    ("lwrist,", "no control point ''"),
    ("lwrist+1/2", r"'lwrist\+1/2': after the plus"),
    ("head+0/x/0", "three numbers in metres"),
    ("head+0/nan/0", "three numbers in metres"),
    ("lwrist,rwrist,lwrist", "'lwrist' is given twice"),
    ("lwrist,LeftHand", "'lwrist' and 'LeftHand' are one place"),
])
def test_wrong_points_are_named(text, complaint):
    with pytest.raises(ValueError, match=complaint):
        parse(text, BODY)
