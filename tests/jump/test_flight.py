"""The flight: the centre of mass on its parabola, angular momentum kept by every step, told by formulas of our own."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gambol.controllers.body import forward_kinematics
from gambol.controllers.body.anatomy import centre_of_mass, segment_centres
from gambol.controllers.body.rotations import exp, log
from gambol.controllers.jump.body.dynamics import Physique
from gambol.controllers.jump.motion.flight import flight_kernel

law = settings(max_examples=12, deadline=None)
PHYSIQUE, STEP = Physique(), 1 / 120


def flown(seed, momentum, moving=1.0, count=40):
    """Roots and local rotations of a body whose joints move at a whim, and the arc it should go along."""
    rng, joints = np.random.default_rng(seed), len(PHYSIQUE.skeleton)
    time = STEP * np.arange(count)
    arc = np.array([0.1, 1.2, 0.0]) + np.outer(time, [0.3, 2.5, 1.5]) + 0.5 * np.outer(time**2, [0.0, -9.81, 0.0])
    swing = 0.5 * moving * rng.normal(size=(joints, 3))
    local = exp(np.sin(2.0 * time + rng.uniform(0.0, 6.0))[:, None, None] * swing)
    local[:, 0] = exp(np.array([0.2, 0.5, 0.1]))
    roots = np.empty((count, 3))
    worst = flight_kernel(PHYSIQUE.tables, arc, local, np.zeros(3), np.asarray(momentum, float), STEP, roots, 1e-9)
    return roots, local, arc, worst


def angular_momenta(roots, local, step=STEP):
    """The angular momentum (N − 1, 3) of each step [s] about the centre of mass."""
    anatomy = PHYSIQUE.anatomy
    positions, turned = forward_kinematics(PHYSIQUE.skeleton, roots, local)
    places = segment_centres(anatomy, positions, turned) - centre_of_mass(anatomy, positions, turned)[:, None]
    turned = turned[:, anatomy.joints]
    rate, middle = np.diff(places, axis=0) / step, 0.5 * (turned[1:] + turned[:-1])
    spin = log(turned[1:] @ np.swapaxes(turned[:-1], -1, -2)) / step
    own = np.einsum("tsij,sjk,tslk,tsl->tsi", middle, anatomy.inertias, middle, spin)
    return (anatomy.masses[:, None] * np.cross(0.5 * (places[1:] + places[:-1]), rate) + own).sum(1)


vector = st.tuples(*[st.floats(-15.0, 15.0)] * 3)


@law
@given(st.integers(0, 2**32 - 1), vector)
def test_every_step_keeps_the_momentum_and_the_parabola(seed, momentum):
    roots, local, arc, worst = flown(seed, momentum)
    assert worst < 1e-8
    np.testing.assert_allclose(angular_momenta(roots, local), np.broadcast_to(momentum, (39, 3)), atol=1e-7)
    centre = centre_of_mass(PHYSIQUE.anatomy, *forward_kinematics(PHYSIQUE.skeleton, roots, local))
    np.testing.assert_allclose(centre, arc, atol=1e-12)


def test_who_moves_no_joint_and_has_no_momentum_doesn_t_turn():
    _, local, _, _ = flown(0, np.zeros(3), moving=0.0)
    np.testing.assert_allclose(local, np.broadcast_to(local[0], local.shape), atol=1e-9)


@pytest.mark.parametrize("name", ["up", "far", "onto", "down", "on the Moon", "at a run"])
def test_energy_of_the_centre_of_mass_is_kept_in_every_jump(plans, name):
    who, _, made = plans[name]
    here = (made.times >= made.take_off - 1e-9) & (made.times <= made.touch_down + 1e-9)
    centre = centre_of_mass(who.physique.anatomy, *forward_kinematics(who.skeleton, made.roots[here], made.local[here]))
    step = np.diff(made.times[here])[0]
    velocity = (centre[2:] - centre[:-2]) / (2.0 * step)  # exact for a parabola
    energy = 0.5 * (velocity**2).sum(-1) - who.gravity[1] * centre[1:-1, 1]
    assert np.ptp(energy) < 1e-6 * energy.mean()
