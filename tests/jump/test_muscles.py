"""Springs: each reading inverts itself, work is the integral of torque, and the ground answers what muscles hold."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from controllers.jump.dynamics import Physique, place_kernel
from controllers.jump.muscles import (CALF, Muscle, moment_arm, muscle, spring_bend, spring_force, spring_torque,
                                      spring_work)
from controllers.jump.windup import crouch

SPRING = Muscle(14.1e3, 0.05)
READINGS = ("wedge", "printed")


@pytest.mark.parametrize("reading", READINGS)
@given(st.floats(0.0, np.radians(178.0)))
def test_bend_and_force_invert_each_other(reading, bend):
    force = spring_force(bend, SPRING, reading)
    assert spring_bend(force, SPRING, reading) == pytest.approx(bend, abs=3e-7)
    assert spring_force(spring_bend(force, SPRING, reading), SPRING, reading) == pytest.approx(force, rel=1e-12)


def test_the_readings_are_the_printed_formulas_and_meet_at_a_right_angle():
    k, r = SPRING
    force = np.array([750.0, 800.0, 1000.0, 1200.0])
    np.testing.assert_allclose(spring_bend(force, SPRING, "printed"), np.arccos(2 * k**2 * r**2 / force**2 - 1))
    np.testing.assert_allclose(np.degrees(spring_bend(force, SPRING, "printed")), [39, 56, 90, 108], atol=1)
    np.testing.assert_allclose(spring_bend(force, SPRING), np.arccos(1 - force**2 / (2 * k**2 * r**2)))
    assert spring_force(np.pi / 2, SPRING) == pytest.approx(spring_force(np.pi / 2, SPRING, "printed"))


@pytest.mark.parametrize("reading", READINGS)
def test_outside_its_domain_a_spring_is_held_at_its_edge(reading):
    bends = spring_bend(np.array([-1e9, 0.0, 1.0, 1e9]), SPRING, reading)
    assert np.isfinite(bends).all() and bends[0] == bends[1] == 0.0 and bends[-1] == pytest.approx(np.pi, abs=0.01)
    assert spring_force(-1.0, SPRING, reading) == spring_force(0.0, SPRING, reading)
    assert np.isfinite(spring_force(10.0, SPRING, reading))


@pytest.mark.parametrize("reading", READINGS)
@given(st.floats(0.01, 3.0))
def test_work_is_the_integral_of_torque(reading, bend):
    expected, _ = quad(lambda t: spring_torque(t, SPRING, reading), 0.0, bend)
    assert spring_work(bend, SPRING, reading) == pytest.approx(expected, rel=1e-6)


def test_moment_arms_are_distances_from_the_joint_to_the_line_of_pull():
    assert moment_arm([0.0, 0.3, 0.05], [0.0, 0.0, 0.0], [0.0, -2.0, 0.0]) == pytest.approx(0.05)
    bend = np.radians(80.0)  # between the corners of two bones of width r the arm is r cos(θ/2)
    a, b = np.array([0.0, 0.0, 0.05]), 0.05 * np.array([0.0, -np.sin(bend), np.cos(bend)])
    assert moment_arm(a, np.zeros(3), b - a) == pytest.approx(0.05 * np.cos(bend / 2))


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
        np.testing.assert_allclose(torques, spring_torque(found.bends[3 * side:3 * side + 3], muscle(physique)) * [1, 1, CALF])
        total[[1, 2]] += np.linalg.pinv(np.array(rows)) @ torques
    np.testing.assert_allclose(found.force, total, rtol=1e-5, atol=0.5)
