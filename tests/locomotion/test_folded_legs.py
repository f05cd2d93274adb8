"""A leg folds up no farther than people's do, wherever its foot is asked to be."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gambol.controllers.body import forward_kinematics, human
from gambol.controllers.locomotion.legs import FOLDED, REACH, leg_kernel

SKELETON = human()
HIP = SKELETON.index("LeftUpLeg")
LENGTH = float(np.linalg.norm(SKELETON.offsets[HIP + 1]) + np.linalg.norm(SKELETON.offsets[HIP + 2]))


def ankle_at(target):
    """Where the ankle (3,) comes to be, from its hip, of a leg that is to bring it to a target (3,) from there [m]."""
    local = np.tile(np.eye(3), (len(SKELETON), 1, 1))
    positions, turned = forward_kinematics(SKELETON, np.array([0.0, 1.0, 0.0]), local)
    positions, turned = positions.astype(float), turned.astype(float)
    leg_kernel(positions, turned, HIP, positions[HIP] + target, np.zeros((5, 3, 3)))
    return positions[HIP + 2] - positions[HIP]


@given(st.floats(-0.3, 0.3), st.floats(-0.7, 0.2), st.floats(-0.3, 0.3))
def test_no_ankle_comes_nearer_to_its_hip_than_a_knee_lets_it(x, y, z):
    """Asked nearer, a knee was thrown up over the hip."""
    found, target = ankle_at(np.array([x, y, z])), np.array([x, y, z])
    assert np.linalg.norm(found) > FOLDED * LENGTH * 0.999
    if FOLDED * LENGTH < np.linalg.norm(target) < REACH * LENGTH and (y < 0.0 or np.hypot(x, z) > FOLDED * LENGTH):
        assert found == pytest.approx(target, abs=1e-4), "else it is where it shall be"
    else:
        assert found[[0, 2]] == pytest.approx(target[[0, 2]], abs=1e-4) and found[1] < y + 1e-6 or np.linalg.norm(target) >= REACH * LENGTH
