"""The thesis's thrust: what the springs held becomes motion and height, and it leaves as fast as was asked."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gambol.controllers.jump.body.dynamics import Physique
from gambol.controllers.jump.muscles.extension import LONGEST_STEP, extend, shoot
from gambol.controllers.jump.muscles.spring_muscles import spring_work
from gambol.controllers.jump.muscles.strength import strongest
from gambol.controllers.jump.muscles.windup import crouch

ADULT = Physique()
RISE = 0.109


@pytest.fixture(scope="module")
def low():
    return crouch(ADULT, 2.5, RISE)


def held(bends, spring):
    """What the springs of both legs hold [J]."""
    return 2.0 * spring_work(bends, spring).sum()


@pytest.mark.parametrize("reading, arm", (("wedge", "constant"), ("wedge", "attached")))
def test_the_work_is_what_the_springs_lose(reading, arm):
    """All at once and fully active, nothing holds back: springs, motion and height share one energy."""
    found = crouch(ADULT, 0.6 * strongest(ADULT, RISE, 9.81, reading, arm), RISE, reading=reading, arm=arm)
    run = extend(ADULT, found, delays=(0, 0, 0), integration="runge-kutta")
    lost = held(run.bends[0], found.spring) - held(run.bends[-1], found.spring)
    assert run.work == pytest.approx(lost, rel=2e-3)
    assert run.energy == pytest.approx(lost, rel=2e-3)
    half = extend(ADULT, found, delays=(0, 0, 0), integration="runge-kutta", activation=0.9)
    lost = held(half.bends[0], found.spring) - held(half.bends[-1], found.spring)
    assert half.energy == pytest.approx(0.9 * lost, rel=2e-3)


def test_steps_of_first_order_lose_energy_by_their_length_alone(low):
    coarse, fine = (extend(ADULT, low, dt=dt) for dt in (1 / 480, 1 / 7680))
    assert fine.extended and fine.energy == pytest.approx(fine.work, rel=5e-3)
    assert abs(coarse.energy - coarse.work) > 2 * abs(fine.energy - fine.work)
    exact = extend(ADULT, low, dt=1 / 240, integration="runge-kutta")
    assert exact.energy == pytest.approx(exact.work, rel=2e-3)
    for integration in ("explicit", "semi-implicit"):
        np.testing.assert_allclose(extend(ADULT, low, dt=1 / 15360, integration=integration).velocity[-1], exact.velocity[-1], atol=0.03)


def test_the_ground_force_is_what_moves_the_centre_of_mass(low):
    """Newton's second law, from the centre of mass alone."""
    dt = 1 / 30720
    found = extend(ADULT, low, dt=dt)
    acceleration = np.diff(found.velocity[:-1], axis=0) / dt
    np.testing.assert_allclose(found.force[:-2] / ADULT.mass + [0.0, -9.81], acceleration, atol=0.3)
    np.testing.assert_allclose(np.diff(found.centre[:-1], axis=0) / dt, found.velocity[1:-1], atol=0.02)


@pytest.mark.parametrize("speed", (1.4, 1.98, 2.43, 2.62, 2.8))
def test_a_crouch_is_as_deep_as_the_thrust_needs(speed):
    """As people jump: push-off 0.22 … 0.30 s and 2.0 … 2.6 body weights at 0.3 … 0.4 m; joints no faster than people's."""
    found = crouch(ADULT, speed, RISE)
    full = extend(ADULT, found)
    assert found.converged and 0.97 * speed <= full.velocity[-1, 1] <= 1.03 * speed
    rates = np.abs(np.diff(full.bends, axis=0)[:-1] * 3840.0).max(0)
    assert (rates < [20.0, 25.0, 35.0]).all()
    if speed > 2.4:
        assert 0.26 < full.duration < 0.34 and 2.0 < full.force[:, 1].max() / (73.0 * 9.81) < 2.6


@settings(max_examples=12, deadline=None)
@given(st.floats(0.45, 0.97), st.sampled_from((9.81, 3.7, 1.62)), st.sampled_from((ADULT, Physique(25.0, 1.25, 0.9), Physique(110.0, 1.78, 0.85))))
def test_a_shot_meets_the_wish(share, g, physique):
    rise = RISE * physique.height / ADULT.height
    wish = share * strongest(physique, rise, g)
    run = shoot(physique, crouch(physique, wish, rise, g), wish, g)
    assert run.velocity[-1, 1] == pytest.approx(wish, rel=0.012)
    assert abs(run.velocity[-1, 0]) < 0.02 * wish
    assert 0.0 < run.activation <= 1.0


def test_a_shot_goes_a_little_forward_where_the_feet_point():
    found = crouch(ADULT, [0.0, 2.3, 0.1], RISE)
    ahead, back = (shoot(ADULT, found, [0.0, 2.2, z]).velocity[-1] for z in (0.1, -0.1))
    np.testing.assert_allclose(ahead, [0.1, 2.2], atol=0.01)
    np.testing.assert_allclose(back, [-0.1, 2.2], atol=0.01)


def test_held_muscles_hold():
    """Before any joint starts to push, muscles bear the body and nothing moves."""
    found = extend(ADULT, crouch(ADULT, 2.0, RISE), delays=(np.inf,) * 3, longest=0.1)
    assert not found.extended
    np.testing.assert_allclose(found.centre, np.broadcast_to(found.centre[0], found.centre.shape), atol=1e-6)
    np.testing.assert_allclose(found.force[:, 1], ADULT.mass * 9.81, rtol=1e-6)


def test_the_first_push_is_what_the_springs_give(low):
    """The torques lift the body by the virtual work of its joints: F · dx = Σ τ dθ, at rest, feet flat."""
    run = extend(ADULT, low, delays=(0, 0, 0), dt=1 / 15360)
    moved, turned = run.centre[40] - run.centre[0], run.bends[40] - run.bends[0]
    kinetic = run.work - ADULT.mass * 9.81 * (run.centre[-1, 1] - run.centre[0, 1])
    assert kinetic > 0 and moved[1] > 0
    first = -2.0 * np.dot(low.torques[:3], turned)
    assert first == pytest.approx(held(run.bends[0], low.spring) - held(run.bends[40], low.spring), rel=0.01)


def test_readings_other_than_the_whole_chain_never_leave_the_floor_upright(low):
    for inertia in ("moved", "printed"):
        found = extend(ADULT, low, inertia=inertia)
        assert not found.extended and found.velocity[-1, 1] < 0.5 and found.velocity[-1, 0] < -1.0


def test_a_heel_that_comes_down_again_costs_energy(low):
    """All at once the body falls back on its heels; a blow only ever takes."""
    run = extend(ADULT, low, delays=(0, 0, 0), integration="runge-kutta")
    assert run.energy <= run.work + 1.0


def test_the_printed_spring_pushes_otherwise():
    found = crouch(ADULT, 2.2, RISE, reading="printed")
    assert found.converged and extend(ADULT, found).velocity[-1, 1] != pytest.approx(
        extend(ADULT, crouch(ADULT, 2.2, RISE)).velocity[-1, 1], rel=1e-3)


@pytest.mark.parametrize("wrong", (*(dict(dt=dt) for dt in (1 / 239, 0.0, -1.0, np.nan)), dict(activation=1.1), dict(delays=(0, 1)),
                                   dict(delays=(0, np.nan, 0)), dict(inertia="none"), dict(integration="heun")), ids=str)
def test_bad_options_are_refused(low, wrong):
    with pytest.raises(ValueError, match="must be"):
        extend(ADULT, low, **wrong)
    assert extend(ADULT, low, dt=LONGEST_STEP).duration > 0
    with pytest.raises(ValueError, match="finite"):
        shoot(ADULT, low, np.nan)
