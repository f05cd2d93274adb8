"""The way along the floor: a convex programme whose solution a general solver finds, too, and that holds in what is played."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize

from gambol.controllers.body import forward_kinematics, hull, margin, sole_corners
from gambol.controllers.contract import Intent, Leap
from gambol.controllers.jump import Jump
from gambol.controllers.jump.motion import grounded
from gambol.controllers.jump.motion.centroidal import CALM, EXACT, LOOSE, course_kernel
from gambol.controllers.jump.motion.footing import heels_down, settling, standing_soles

FPS = 60
KNOTS, STEP, RATE, FLIGHT = 9, 0.06, 10.0, 0.4
SOLES = np.array([[-0.15, -0.17], [0.15, -0.17], [0.15, 0.07], [-0.15, 0.07]])
law = settings(max_examples=40, deadline=None)


def course(start, land, leave=(0.0, 0.1), near=0.05, soles=SOLES):
    """Place, velocity, pressure, how far outside, of a body that stands on the same soles until it leaves."""
    hulls, counts = np.zeros((KNOTS, 13, 2)), np.full(KNOTS, len(soles))
    hulls[:, :len(soles)] = soles
    out = [np.empty((KNOTS, 2)) for _ in range(3)]
    outside = course_kernel(STEP, np.full(2 * KNOTS - 1, RATE), np.array(start, float), FLIGHT, np.array(land, float), np.array(leave, float),
                            np.zeros((KNOTS, 2)), np.full(KNOTS, near), hulls, counts, *out)
    return *out, outside


def ends(p, x, v):
    """Where and how fast it is in the end that is pressed at p (N,): ẍ = r (x − p), p linear between knots, in closed form."""
    for before, after in zip(p[:-1], p[1:]):
        w, slope = np.sqrt(RATE), (after - before) / STEP
        x, v = (before + slope * STEP + (x - before) * np.cosh(w * STEP) + (v - slope) / w * np.sinh(w * STEP),
                slope + (x - before) * w * np.sinh(w * STEP) + (v - slope) * np.cosh(w * STEP))
    return x, v


def test_a_general_solver_finds_the_same():
    """One axis, the very cost that is written, within the same bounds."""
    land, leave, near = 0.8, 0.1, 0.05
    _, _, pressed, outside = course(((0.0, 0.0), (0.0, 0.3)), (0.0, land), (0.0, leave), near)

    def arrives(p):
        x, v = ends(p, 0.0, 0.3)
        return x + FLIGHT * v - land

    def cost(p):
        return near * p @ p + CALM * np.diff(p) @ np.diff(p) + (ends(p, 0.0, 0.3)[0] - leave) ** 2 / LOOSE
    found = minimize(cost, np.zeros(KNOTS), method="SLSQP", bounds=[(-0.17, 0.07)] * KNOTS, tol=1e-12,
                     constraints={"type": "eq", "fun": arrives})
    assert found.success and outside < EXACT
    assert cost(pressed[:, 1]) == pytest.approx(found.fun, rel=0.02)
    np.testing.assert_allclose(pressed[:, 1], found.x, atol=0.01)
    assert found.x.min() < -0.1  # the bounds' part of the cost counts


@law
@given(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(-1.5, 1.5), st.floats(-1.5, 1.5))
def test_the_arc_ends_over_the_target_whatever_the_soles_allow(vx, vz, x, z):
    place, velocity, _, outside = course(((0.0, 0.0), (vx, vz)), (x, z))
    np.testing.assert_allclose(place[-1] + FLIGHT * velocity[-1], (x, z), atol=1e-9)
    assert np.isfinite(outside) and outside >= 0.0


@law
@given(st.floats(-0.1, 0.1), st.floats(-0.1, 0.0), st.integers(0, 2**31 - 1))
def test_what_soles_can_give_is_found(x, z, seed):
    """Ends that come from some pressure within the soles."""
    pressed = SOLES.mean(0) + np.random.default_rng(seed).uniform(-0.09, 0.09, (KNOTS, 2))
    left, fast = np.transpose([ends(pressed[:, 0], x, 0.0), ends(pressed[:, 1], z, 0.2)])
    assert course(((x, z), (0.0, 0.2)), left + FLIGHT * fast, left)[3] < 2e-3


@pytest.fixture(scope="module")
def strollers(locomotion):
    """Somebody who strolls at 0.6 m/s, at four moments of the stride, facing +Z from the origin."""
    state, wish, out = locomotion.start(), np.array([0.6, 0.0, 0.0]), []
    for k in range(190):
        before = state
        state, _ = locomotion.step(state, Intent(wish), 1 / FPS)
        if k >= 150 and k % 12 == 6:
            out.append(replace(state, previous=before.pose, elapsed=1 / FPS))
    return out


def pressures(jump, state, made):
    """Where (N, 2) the played centre of mass says that the ground presses until take-off while it carries a third of the weight, how far (N,)
    [m] within what of the soles is no more than 3 cm high."""
    n = np.flatnonzero(made.times < made.take_off - 1e-9)
    positions, turned = forward_kinematics(jump.skeleton, made.roots[n], made.local[n])
    force, out = made.forces[n], []
    held = force[:, 1] > 0.33 * jump.physique.mass * 9.81
    pressed = made.centres[n] - force / np.maximum(force[:, 1:2], 1.0) * (made.centres[n, 1:2] - float(state.floor))
    for corners, at in zip(sole_corners(jump.skeleton, positions, turned)[held], pressed[held]):
        on = corners[corners[:, 1] < float(state.floor) + 0.03]
        out.append(float(margin(hull(on[:, [0, 2]]), at[[0, 2]])))
    return np.array(out)


def test_who_strolls_is_pushed_from_under_its_soles(jump, strollers):
    """In what is played; where the estimate alone was played, most of it was pushed from beside them."""
    for state in strollers:
        for far in (0.3, 0.7, 1.0):
            made = jump.plan(state, Intent(leap=Leap(np.array([state.ground[0], 0.0, state.ground[1] + far]))))
            assert pressures(jump, state, made).min() > -0.05, far


def test_who_can_t_be_stopped_is_not_asked_to_leap_back(jump, strollers):
    """A leap is refused that would take more sole than there is; how long it winds up is part of what is looked for."""
    longer = 0
    for state in strollers:
        start = jump.start_of(state)
        for far in (-0.6, -0.3, 0.0):
            place = np.array([state.ground[0], 0.0, state.ground[1] + far])
            usual = jump.path(start, place, 0.0)
            way = grounded(jump.physique, start, usual, 0.0)
            longer += way.wind_up > usual.wind_up
            refused = jump.refusal(state, Intent(leap=Leap(place)))
            assert (way.course.outside > 0.03) == ("no foot" in refused)
    assert longer


def test_what_stands_is_what_is_down(jump, strollers):
    """A foot counts from when it has come down; heels not once they may rise, nor where legs or ankles can't reach."""
    body, times, high = jump.physique.tables, np.linspace(0.0, 0.4, 5), 0
    for state in strollers:
        start = jump.start_of(state)
        planted = start.planted(0.0, body)
        feet = settling(start, planted, body, times, 0.4, 0.2)
        hulls, counts = standing_soles(feet, body.sole, np.repeat(times < 0.3, 2).reshape(-1, 2), None, body)
        shapes = [h[:n] for h, n in zip(hulls, counts)]
        areas = [0.5 * abs(np.sum(c[:, 0] * np.roll(c[:, 1], -1) - c[:, 1] * np.roll(c[:, 0], -1))) for c in shapes]
        assert areas[3] < areas[2]
        if feet[0, :, 1].max() > body.sole + 0.03:
            high += 1
            assert areas[0] < areas[2]
    assert high
    ahead, up = np.meshgrid(np.linspace(-0.15, 0.6, 19), [0.8, 0.87, 0.94])
    feet = np.tile([[0.1, body.sole, 0.0, 0.0, 0.0], [-0.1, body.sole, 0.0, 0.0, 0.0]], (19, 1, 1))
    down = [heels_down(row, feet, body, 0.7).all(-1) for row in np.stack([0.0 * ahead, up, ahead], -1)]
    assert all(row[0] and not row[-1] for row in down)
    assert down[0].sum() < down[1].sum() < down[2].sum()  # a deep crouch bends ankles


def test_a_slower_wind_up_never_pulls(jump, strollers):
    for state in strollers:
        for far in (-0.3, 0.0):
            try:
                made = jump.plan(state, Intent(leap=Leap(np.array([state.ground[0], 0.0, state.ground[1] + far]))))
            except ValueError:
                continue
            assert made.forces[made.times < made.take_off - 1e-9, 1].min() > 0.0


def test_the_moon_has_a_course_too(standing):
    who = Jump(gravity=(0.0, -1.62, 0.0))
    start = who.start_of(standing)
    way = grounded(who.physique, start, who.path(start, np.array([0.0, 0.0, 1.0]), 0.0), 0.0)
    assert way.course is not None and way.course.outside < 0.01
    np.testing.assert_allclose(way.leave + way.velocity * way.airtime + 0.5 * who.gravity * way.airtime**2, way.land, atol=1e-9)
