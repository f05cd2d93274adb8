"""A posture keeps its promises: the centre of mass where it is wanted, feet where they stand, bones as long as they are."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from gambol.controllers.body import forward_kinematics
from gambol.controllers.body.anatomy import centre_of_mass
from gambol.controllers.jump.body import carriage as style
from gambol.controllers.jump.body.balance import FLEX
from gambol.controllers.jump.body.dynamics import Physique
from gambol.controllers.jump.body.planted_pose import STRAIGHT, ankle_kernel, heel_kernel, lying_kernel, nearest_kernel, stand_kernel
from gambol.controllers.jump.body import landing_feet, measures

BODIES = (Physique(), Physique(30.0, 1.25), Physique(110.0, 1.85, 0.8, 0.8, "female"))


def stood(physique, down, ahead, lean, swing, flex=1.0):
    """Local rotations, root and feet of a crouch, and the centre of mass that was wanted."""
    body, skeleton = physique.tables, physique.skeleton
    feet = np.column_stack([landing_feet(np.zeros(3), 0.0, body), np.ones(2)])
    centre = np.array([0.0, measures(physique).stand - down * physique.height / 1.741, ahead])
    local = np.tile(np.eye(3), (len(skeleton), 1, 1))
    style.carry_kernel(style.posture(*np.degrees([lean, 0.3, 0.0, swing, 0.2, 0.3])), style.joints_of(skeleton), local)
    local[0] = [[1, 0, 0], [0, np.cos(lean), -np.sin(lean)], [0, np.sin(lean), np.cos(lean)]]
    root = centre.copy()
    left = stand_kernel(body, centre, feet, flex * FLEX, root, local, np.empty((len(skeleton), 3)), np.empty((len(skeleton), 3, 3)))
    return local, root, feet, centre, left


@settings(max_examples=40, deadline=None)
@example(Physique(), 0.03125, 0.0, 0.875, -1.0)
@given(st.sampled_from(BODIES), st.floats(0.03, 0.40), st.floats(-0.02, 0.08), st.floats(0.1, 0.9), st.floats(-2.0, 0.8))
def test_centre_of_mass_and_feet_are_where_they_should_be(physique, down, ahead, lean, swing):
    local, root, feet, centre, left = stood(physique, down, ahead, lean, swing)
    positions, turned = forward_kinematics(physique.skeleton, root, local)
    tiptoe = [nearest_kernel(physique.tables, positions[hip], foot) for hip, foot in zip(physique.tables.hip, feet)]
    if (feet[:, 4] > np.minimum(tiptoe, 1.25) - 0.01).all():  # bent far forward and yet high up: more than straight legs on tiptoe reach
        hips, ankles = positions[physique.tables.hip], positions[physique.tables.hip + 2]
        straight = STRAIGHT * (physique.tables.thigh + physique.tables.shank)
        np.testing.assert_allclose(np.linalg.norm(hips - ankles, axis=-1), straight, rtol=1e-3)
        return
    assert left < 1e-6
    np.testing.assert_allclose(centre_of_mass(physique.anatomy, positions, turned), centre, atol=1e-8)
    for side, name in enumerate(("Left", "Right")):
        np.testing.assert_allclose(positions[physique.skeleton.index(name + "Toe")], feet[side, :3], atol=1e-7)
    np.testing.assert_allclose(local @ np.swapaxes(local, -1, -2), np.broadcast_to(np.eye(3), local.shape), atol=1e-9)


def test_an_ankle_bends_no_further_than_it_can_and_then_the_heel_rises():
    physique = Physique()
    stiff, free = (stood(physique, 0.33, 0.06, 0.5, 0.0, flex)[2][:, 4] for flex in (0.4, 1.3))
    assert (stiff > 0.1).all() and (free < stiff - 0.1).all()


def test_knees_bend_backward_only_and_don_t_cross():
    physique, skeleton = Physique(), Physique().skeleton
    for down in np.linspace(0.02, 0.42, 9):
        local, root, *_ = stood(physique, down, 0.02, 0.6, 0.5)
        positions, _ = forward_kinematics(skeleton, root, local)
        for name in ("Left", "Right"):
            knee = local[skeleton.index(name + "Leg")]
            assert np.arctan2(knee[2, 1], knee[1, 1]) > 0.0
        assert positions[skeleton.index("LeftLeg"), 0] - positions[skeleton.index("RightLeg"), 0] > 0.1


@given(yaw=st.floats(-3.0, 3.0), pitch=st.floats(-0.1, 0.6), ahead=st.floats(-0.4, 0.4), aside=st.floats(-0.2, 0.2), high=st.floats(0.6, 1.05), reach=st.floats(0.7, 0.95),
       slope=st.tuples(st.floats(-0.3, 0.3), st.floats(-0.3, 0.3)))
def test_a_heel_rises_as_little_as_it_must(yaw, pitch, ahead, aside, high, reach, slope):
    """Looked for in small steps: the first pitch with which the ankle is as near to the hip as the leg reaches."""
    body = Physique().tables
    foot, hip = np.array([0.0, 0.1, 0.0, yaw, pitch, 1.0, *slope, 0.0]), np.array([aside, high, ahead])

    def apart(pitch):
        turned, ankle = np.empty((3, 3)), np.empty(3)
        lying_kernel(foot, pitch, turned)
        ankle_kernel(body, foot, turned, ankle)
        return np.linalg.norm(ankle - hip)
    most = max(pitch, min(nearest_kernel(body, hip, foot), 1.25))
    if apart(pitch) <= reach:
        return
    found = heel_kernel(body, hip, foot, reach, most)
    assert pitch <= found <= most
    assert found == most or apart(found) == pytest.approx(reach, abs=1e-9)
    assert all(apart(low) > reach - 1e-9 for low in np.linspace(pitch, found, 9)[:-1])
