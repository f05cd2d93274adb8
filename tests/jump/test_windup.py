"""The wind-up: muscles give what the jump asks for, over planted feet, in balance and within every limit."""

import numpy as np
import pytest

from gambol.controllers.body.support_polygon import centroid, hull, margin, sole_corners, standing_corners
from gambol.controllers.jump.body.balance import flat_feet, frame
from gambol.controllers.jump.body.dynamics import Physique, centre_kernel, place_kernel
from gambol.controllers.jump.muscles.extension import extend
from gambol.controllers.jump.muscles.spring_muscles import spring_work
from gambol.controllers.jump.muscles.strength import crouch_depth, strength, strongest
from gambol.controllers.jump.muscles.windup import GAINS, crouch

ADULT = Physique()
BODIES = (ADULT, Physique(25.0, 1.25), Physique(110.0, 1.8), Physique(60.0, 1.65, 1.3, 1.2, "female"))
RISE = 0.063  # of the centre of mass from standing to take-off, over height


def speed(height, g=9.81):
    return float(np.sqrt(2 * g * height))


def placed(physique, found):
    joints = len(physique.skeleton)
    positions, turned, centre = np.empty((joints, 3)), np.empty((joints, 3, 3)), np.empty(3)
    place_kernel(physique.tables, found.pelvis, found.rotations, positions, turned)
    centre_kernel(physique.tables, positions, turned, centre)
    return positions, turned, centre


@pytest.mark.parametrize("physique", BODIES, ids=str)
def test_the_crouch_is_a_pose_of_the_body_balanced_and_strong_enough(physique):
    found = crouch(physique, 0.9 * strongest(physique, RISE * physique.height), RISE * physique.height)
    assert found.converged
    positions, turned, centre = placed(physique, found)
    np.testing.assert_allclose(centre, found.centre, atol=1e-9)
    force, required = np.linalg.norm(found.force), np.linalg.norm(found.required)
    work, needed = found.history.work[-1], found.history.needed[-1]
    tight = max((required - force) / required, (needed - work) / needed)
    assert abs(tight) <= GAINS.muscle_error
    assert work == pytest.approx(spring_work(found.bends, found.spring).sum())
    # feet: balls where they were, soles level, what stands carries
    balls = positions[physique.tables.hip + 3]
    np.testing.assert_allclose(balls, flat_feet(physique)[:, :3], atol=2e-3)
    heels = found.feet[:, 4] < 0.02
    corners = sole_corners(physique.skeleton, positions, turned)
    polygon = hull(corners[standing_corners([heels[0], True, heels[1], True])][:, [0, 2]])
    assert np.linalg.norm(centroid(polygon) - centre[[0, 2]]) < GAINS.balance_error + 2e-3
    assert margin(polygon, centre[[0, 2]]) > 0
    # limits of hips, knees, ankles
    fixed = frame(physique)
    bends = found.bends.reshape(2, 3)
    assert (bends[:, 0] <= -fixed.lower[:, 0, 0] + 1e-6).all() and (bends[:, 1] <= fixed.upper[:, 1, 0] + 1e-6).all()


@pytest.mark.parametrize("height", (0.3, 0.35, 0.4))
def test_an_adult_crouches_as_adults_do(height):
    """As people crouch: 0.28 … 0.38 m deep for jumps of 0.3 … 0.4 m."""
    found = crouch(ADULT, speed(height), 0.109)
    assert found.converged and 0.275 < found.depth < 0.385 and (found.feet[:, 4] < 0.02).all()
    assert found.margin > 0.05


def test_strength_one_is_an_adult_who_jumps_a_good_forty_centimetres():
    assert 0.40 < strongest(ADULT, 0.109) ** 2 / (2 * 9.81) < 0.46
    weaker, child = strongest(Physique(strength=0.8), 0.109), strongest(Physique(25.0, 1.25), 0.078)
    assert weaker < strongest(ADULT, 0.109) and child < strongest(ADULT, 0.109)
    heavy = strongest(Physique(mass=110.0, strength=0.8), 0.109)
    assert heavy == pytest.approx(weaker, rel=0.02)  # strength counts per kilogram


@pytest.mark.parametrize("g", (9.81, 3.7, 1.62))
@pytest.mark.parametrize("reading, arm", (("wedge", "constant"), ("printed", "constant"), ("wedge", "attached")))
def test_control_ends_where_the_strength_says(g, reading, arm):
    for share in (0.6, 0.8, 0.95):
        wish = share * strongest(ADULT, 0.109, g, reading, arm)
        found = crouch(ADULT, wish, 0.109, g, reading=reading, arm=arm)
        assert found.depth == pytest.approx(crouch_depth(ADULT, wish, 0.109, g, reading, arm), abs=0.02)


def test_the_readings_are_different_bodies():
    depths = [crouch_depth(ADULT, 1.3, 0.109, 9.81, reading, arm) for reading in ("wedge", "printed") for arm in ("constant", "attached")]
    assert np.isfinite(depths).all() and np.abs(np.subtract.outer(depths, depths) + np.eye(4)).min() > 2e-3


def test_strength_is_what_the_thrust_does():
    able = strength(ADULT)
    assert (np.diff(able.depth) > 0).all() and (np.diff(able.work) > 0).all()
    for n in (2, 6, 10):
        found = crouch(ADULT, able.speed[n], 0.109)
        assert found.depth == pytest.approx(able.depth[n], abs=0.01)
        assert extend(ADULT, found, integration="runge-kutta", dt=1 / 240).velocity[-1, 1] == pytest.approx(able.speed[n], rel=0.015)
    np.testing.assert_allclose(able.work - able.spent, 0.5 * ADULT.mass * able.speed**2)


@pytest.mark.parametrize("flexibility", (0.3, 0.35, 0.45))
def test_a_body_too_stiff_to_crouch_is_weak_and_no_more(flexibility):
    stiff = Physique(flexibility=flexibility)
    able = strength(stiff)
    assert len(able.depth) >= 1 and np.isfinite(able).all()
    assert 0.0 <= strongest(stiff, 0.109) < 1.2 and np.isnan(crouch_depth(stiff, 2.0, 0.109))
    assert not crouch(stiff, 2.0, 0.109).converged


def test_a_take_off_beyond_its_strength_is_told():
    most = strongest(ADULT, 0.109)
    assert not crouch(ADULT, 1.15 * most, 0.109).converged
    assert np.isnan(crouch_depth(ADULT, 1.15 * most, 0.109))
    assert strongest(Physique(strength=0.3), 0.1) == 0.0
    stiff = crouch(Physique(flexibility=0.5), 2.6, 0.109)
    assert not stiff.converged and np.isfinite(stiff.pelvis).all()


def test_heels_rise_only_past_the_ankles_limit():
    limber, stiff = (crouch(Physique(flexibility=f), speed(0.2), 0.109) for f in (1.0, 0.72))
    assert (limber.feet[:, 4] == 0).all()
    assert (stiff.feet[:, 4] > 0.02).all()
    assert stiff.bends[2] == pytest.approx(limber.bends[2], abs=0.5)


def test_feet_apart_and_turned_stand_where_they_are():
    feet = flat_feet(ADULT)
    feet[0, 2] += 0.12
    feet[:, 3] = 0.9, 0.7
    turned = feet.copy()
    found = crouch(ADULT, 2.2, 0.109, feet=feet)
    assert crouch(ADULT, 2.2, 0.109, feet=feet[:, :5]).depth == found.depth
    assert found.converged and found.margin > 0.03
    np.testing.assert_allclose(placed(ADULT, found)[0][ADULT.tables.hip + 3], turned[:, :3], atol=2e-3)
    np.testing.assert_array_equal(feet, turned)  # what was handed in is left alone


def test_steps_are_bounded_and_the_history_is_whole():
    found = crouch(ADULT, 2.6, 0.109)
    history = found.history
    assert found.iterations == len(history) - 1 < GAINS.most
    assert np.linalg.norm(np.diff(history.pelvis, axis=0), axis=-1).max() <= GAINS.longest + 1e-9
    np.testing.assert_allclose(history.force[-1], np.linalg.norm(found.force))
    assert np.isfinite(strength(ADULT).force).all()


@pytest.mark.parametrize("wish", (dict(velocity=np.nan), dict(rise=np.inf), dict(gravity=np.nan),
                                  dict(feet=np.zeros((1, 6))), dict(feet=np.full((2, 6), np.nan))), ids=str)
def test_bad_wishes_are_refused(wish):
    with pytest.raises(ValueError, match="must be"):
        crouch(ADULT, **{"velocity": 2.0, "rise": 0.1, **wish})


def test_no_force_gives_what_a_body_that_falls_ahead_has_already():
    wish = np.array([0.0, 1.9, 2.0])
    depths = [crouch_depth(ADULT, wish, -0.05, passing=np.array([0.0, 0.0, passing])) for passing in (0.0, 0.4, 0.8)]
    assert depths[0] > depths[1] + 0.01 > depths[2] + 0.02
    # but the springs have to hold as much as before
    fast = np.array([0.0, 2.7, 3.0])
    assert np.isnan(crouch_depth(ADULT, fast, -0.05, passing=fast * [1.0, 0.0, 1.0]))
