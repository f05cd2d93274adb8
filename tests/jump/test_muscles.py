"""Springs: each reading inverts itself, torque is the slope of the energy, and the ground answers what muscles hold."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from gambol.controllers.jump.body.dynamics import Physique, place_kernel
from gambol.controllers.jump.muscles.spring_muscles import (Muscle, moment_arm, muscle, spring_bend, spring_force,
                                                            spring_torque, spring_work, torque_kernel)
from gambol.controllers.jump.muscles.windup import crouch

K, R = 14.1e3, 0.05
SPRINGS = [Muscle(K, R, printed, attached) for printed in (False, True) for attached in (False, True)]
WEDGE, PRINTED = Muscle(K, R), Muscle(K, R, True)


@pytest.mark.parametrize("spring", (WEDGE, PRINTED))
@given(st.floats(0.0, np.radians(178.0)))
def test_bend_and_force_invert_each_other(spring, bend):
    force = spring_force(bend, spring)
    assert spring_bend(force, spring) == pytest.approx(bend, abs=3e-7)
    assert spring_force(spring_bend(force, spring), spring) == pytest.approx(force, rel=1e-12)


def test_the_readings_are_the_printed_formulas_and_meet_at_a_right_angle():
    force = np.array([750.0, 800.0, 1000.0, 1200.0])
    np.testing.assert_allclose(spring_bend(force, PRINTED), np.arccos(2 * K**2 * R**2 / force**2 - 1))
    np.testing.assert_allclose(np.degrees(spring_bend(force, PRINTED)), [39, 56, 90, 108], atol=1)
    np.testing.assert_allclose(spring_bend(force, WEDGE), np.arccos(1 - force**2 / (2 * K**2 * R**2)))
    assert spring_force(np.pi / 2, WEDGE) == pytest.approx(spring_force(np.pi / 2, PRINTED))


@pytest.mark.parametrize("spring", SPRINGS)
def test_outside_its_domain_a_spring_is_held_at_its_edge(spring):
    bends = spring_bend(np.array([-1e9, 0.0, 1.0, 1e9]), spring)
    assert np.isfinite(bends).all() and bends[0] == bends[1] == 0.0 and bends[-1] == pytest.approx(np.pi, abs=0.01)
    assert spring_force(-1.0, spring) == spring_force(0.0, spring)
    assert np.isfinite(spring_force(10.0, spring)) and np.isfinite(spring_work(10.0, spring))


@given(st.floats(0.05, 3.0))
def test_a_wedge_is_a_spring_across_the_gap_between_two_bones(bend):
    """Hooke: a spring of stiffness k between two points r off the joint, drawn apart from where they touched."""
    gap = np.linalg.norm(R * np.array([np.cos(bend), np.sin(bend)]) - [R, 0.0])
    assert spring_force(bend, WEDGE) == pytest.approx(K * gap, rel=1e-9)
    assert spring_work(bend, Muscle(K, R, attached=True)) == pytest.approx(0.5 * K * gap**2, rel=1e-9)


@pytest.mark.parametrize("spring", SPRINGS)
@given(st.floats(0.02, 3.0))
def test_torque_is_the_slope_of_the_springs_energy(spring, bend):
    h = 1e-5
    slope = (spring_work(bend + h, spring) - spring_work(bend - h, spring)) / (2 * h)
    assert spring_torque(bend, spring) == pytest.approx(slope, rel=1e-6)
    assert torque_kernel(bend, spring) == pytest.approx(slope, rel=1e-6)
    whole, _ = quad(lambda t: spring_torque(t, spring), 0.0, bend)
    assert spring_work(bend, spring) == pytest.approx(whole, rel=1e-6)


@given(st.floats(0.0, 3.0))
def test_moment_arms_are_distances_from_the_joint_to_the_line_of_pull(bend):
    """The thesis: the cross product of the attachment, seen from the joint, with the direction of the muscle."""
    a, b = R * np.array([1.0, 0.0]), R * np.array([np.cos(bend), np.sin(bend)])
    if bend > 1e-3:
        along = (b - a) / np.linalg.norm(b - a)
        assert moment_arm(bend, Muscle(K, R, attached=True)) == pytest.approx(abs(a[0] * along[1] - a[1] * along[0]), rel=1e-6)
    assert moment_arm(bend, WEDGE) == R


def test_an_adults_springs_are_as_told():
    spring = muscle(Physique())
    assert spring_torque(math.pi, spring) == pytest.approx(2 * 29.7e3 * 0.05**2)  # [N m] of one joint of one leg
    assert muscle(Physique(), "printed", "attached")[2:] == (True, True)
    for wrong in (("wdge",), ("wedge", "long")):
        with pytest.raises(ValueError, match="must be"):
            muscle(Physique(), *wrong)


def test_alike_bodies_push_with_the_same_share_of_their_weight():
    big, small = Physique(), Physique(73.0 / 8, 1.741 / 2)
    torque = [spring_torque(1.5, muscle(p)) / (p.mass * p.height) for p in (big, small)]
    assert torque[0] == pytest.approx(torque[1])
    assert muscle(Physique(strength=2.0)).stiffness == 2.0 * muscle(big).stiffness


def test_the_ground_answers_what_the_muscles_hold():
    """Jᵀ f = τ in the least-squares sense, with the Jacobian by finite differences of the real body."""
    physique = Physique()
    found = crouch(physique, 2.5, 0.11)
    body, joints = physique.tables, len(physique.skeleton)

    def placed(local):
        positions, turned = np.empty((joints, 3)), np.empty((joints, 3, 3))
        place_kernel(body, found.pelvis, local, positions, turned)
        return positions, turned

    positions, _ = placed(found.rotations)
    total = np.zeros(3)
    for side in range(2):
        hip, rows = body.hip[side], []
        ground = np.array([found.feet[side, 0], 0.0, found.centre[2]])  # level feet along z: below the centre of mass
        for joint, sign in zip(range(hip, hip + 3), (1.0, -1.0, 1.0)):
            arm = ground - positions[joint]
            # a push of the foot f gives the torque (arm × f)·x; the ground pushes the other way
            rows.append(-sign * np.array([-arm[2], arm[1]]))
        torques = found.torques[3 * side:3 * side + 3]
        np.testing.assert_allclose(torques, spring_torque(found.bends[3 * side:3 * side + 3], muscle(physique)))
        total[[1, 2]] += np.linalg.pinv(np.array(rows)) @ torques
    np.testing.assert_allclose(found.force, total, rtol=1e-5, atol=0.5)


@pytest.mark.parametrize("wrong", (dict(mass="70"), dict(mass=True), dict(height=None), dict(strength=float("nan")),
                                   dict(flexibility=0.2), dict(sex="x")), ids=str)
def test_a_body_that_is_none_names_the_field(wrong):
    with pytest.raises(ValueError, match=f"{next(iter(wrong))} must be"):
        Physique(**wrong)
