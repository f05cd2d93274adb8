"""The thesis's thrust: the work of the muscles becomes motion and height, and the printed one does not."""

import numpy as np
import pytest

from controllers.jump.dynamics import Physique
from controllers.jump.extension import LONGEST_STEP, capacity, extend
from controllers.jump.muscles import BURST
from controllers.jump.windup import crouch

ADULT = Physique()


@pytest.fixture(scope="module")
def low():
    return crouch(ADULT, 2.5, 0.109)


def test_work_becomes_motion_and_height(low):
    coarse, fine = (extend(ADULT, low, dt=dt) for dt in (1 / 480, 1 / 7680))
    assert fine.extended and fine.velocity[-1, 1] > 1.5
    assert fine.energy == pytest.approx(fine.work, rel=5e-3)
    assert abs(coarse.energy - coarse.work) > 2 * abs(fine.energy - fine.work)  # rounding of steps, not a leak


def test_the_ground_force_is_what_moves_the_centre_of_mass(low):
    """Newton's second law, from the centre of mass alone."""
    dt = 1 / 15360
    found = extend(ADULT, low, dt=dt, delays=(0, 0, 0))
    acceleration = np.diff(found.velocity, axis=0) / dt
    np.testing.assert_allclose(found.force[:-1] / ADULT.mass + [0.0, -9.81], acceleration, atol=0.3)
    np.testing.assert_allclose(np.diff(found.centre, axis=0) / dt, found.velocity[1:], atol=0.02)


def test_steps_agree_and_longer_ones_are_refused(low):
    explicit, implicit = (extend(ADULT, low, dt=1 / 7680, integration=i).velocity[-1] for i in ("explicit", "semi-implicit"))
    np.testing.assert_allclose(explicit, implicit, atol=0.05)
    for dt in (1 / 239, 0.0, -1.0, np.nan):
        with pytest.raises(ValueError, match="1/240"):
            extend(ADULT, low, dt=dt)
    assert extend(ADULT, low, dt=LONGEST_STEP).duration > 0


def test_held_muscles_hold():
    """Before any joint starts to push, muscles bear the body and nothing moves."""
    found = extend(ADULT, crouch(ADULT, 2.0, 0.109), delays=(9, 9, 9), longest=0.1)
    assert not found.extended
    np.testing.assert_allclose(found.centre, np.broadcast_to(found.centre[0], found.centre.shape), atol=1e-6)
    np.testing.assert_allclose(found.force[:, 1], ADULT.mass * 9.81, rtol=1e-6)


def test_readings_other_than_the_whole_chain_do_not_keep_energy(low):
    for inertia in ("moved", "printed"):
        found = extend(ADULT, low, inertia=inertia)
        assert abs(found.energy - found.work) > 0.1 * abs(found.work)


def test_capacity_at_the_crouch_is_a_burst_of_what_its_muscles_hold(low):
    able = capacity(ADULT, np.stack([low.pelvis] * 2), np.stack([low.rotations] * 2), np.stack([low.feet] * 2))
    np.testing.assert_allclose(able, BURST * np.linalg.norm(low.force), rtol=1e-9)
