"""A planned jump from its poses: it begins as the body was, leaves as the arc asks, lands where it should, and nothing pops."""

import numpy as np
import pytest

from gambol.controllers.body import forward_kinematics
from gambol.controllers.body.anatomy import centre_of_mass, joint_limits
from gambol.controllers.body.rotations import log
from gambol.controllers.body.support_polygon import hull, margin, sole_corners

NAMES = ("up", "far", "onto", "down", "on the Moon", "at a run")
every = pytest.mark.parametrize("name", NAMES)
two_feet = pytest.mark.parametrize("name", NAMES[:-1])


def poses(who, made, times=None):
    """Positions, orientations, local rotations and centre of mass of a plan, at its own times or others."""
    shown = [made.at(t) for t in (made.times if times is None else times)]
    local = np.stack([p.rotations for p in shown])
    positions, turned = forward_kinematics(who.skeleton, np.stack([p.root for p in shown]), local)
    return positions, turned, local, centre_of_mass(who.physique.anatomy, positions, turned)


@every
def test_it_begins_as_the_body_was(plans, name):
    """Pose and motion: what the first sixtieth of a second goes on with."""
    who, state, made = plans[name]
    begins = forward_kinematics(who.skeleton, *(np.asarray(a, float) for a in (state.pose.root, state.pose.rotations)))[0]
    positions = poses(who, made, [0.0, 1 / 60])[0]
    assert np.linalg.norm(positions[0] - begins, axis=-1).max() < 0.03
    if state.elapsed:
        before = forward_kinematics(who.skeleton, *(np.asarray(a, float) for a in (state.previous.root, state.previous.rotations)))[0]
        went, goes = (begins - before) / state.elapsed, (positions[1] - positions[0]) * 60.0
        far = np.linalg.norm(goes - went, axis=-1)
        assert far[:6].max() < 0.4 and far.max() < 3.0  # trunk and head; hands and feet [m/s]


@every
def test_the_centre_of_mass_leaves_and_flies_as_the_arc_asks(plans, name):
    who, _, made = plans[name]
    *_, centre = poses(who, made)
    np.testing.assert_allclose(centre, made.centres, atol=1e-8)
    off = int(np.searchsorted(made.times, made.take_off - 1e-9))
    before = (3 * centre[off] - 4 * centre[off - 1] + centre[off - 2]) / (2 * (made.times[off] - made.times[off - 1]))
    wanted = made.path.velocity
    assert np.linalg.norm(before - wanted) < 0.01 * np.linalg.norm(wanted)
    air = (made.times >= made.take_off - 1e-9) & (made.times <= made.touch_down + 1e-9)
    t = (made.times[air] - made.take_off)[:, None]
    np.testing.assert_allclose(centre[air], made.path.leave + wanted * t + 0.5 * who.gravity * t**2, atol=1e-8)


@every
def test_feet_that_are_planted_stay(plans, name):
    """From the poses: balls before take-off once settled, and balls and heels after landing."""
    who, state, made = plans[name]
    positions = poses(who, made)[0]
    single = who.start_of(state).single
    for side, foot in enumerate(("Left", "Right")):
        ball = positions[:, who.skeleton.index(foot + "Toe")]
        if single is None or side == single:
            here = (made.times > 0.35 * made.take_off) & (made.times <= made.take_off)
            assert np.ptp(ball[here], axis=0).max() < (1e-3 if single is None else 0.02)
        if made.path.lands not in (None, side):
            continue  # it swings
        on = (made.times >= made.touch_down + 0.02) & (made.times < min(made.through, made.touch_down + 0.5))
        np.testing.assert_allclose(ball[on], np.broadcast_to(made.feet[side, :3], ball[on].shape), atol=1e-4)


@every
def test_nothing_sinks_into_the_floor(plans, name):
    who, state, made = plans[name]
    positions, turned, *_ = poses(who, made)
    low = sole_corners(who.skeleton, positions, turned)[..., 1].min(-1)
    before, after = made.times <= made.take_off, (made.times >= made.touch_down) & (made.times < made.through)
    assert low[before].min() > float(state.floor) - 0.003
    assert low[after].min() > made.feet[0, 1] - who.physique.tables.sole - 0.003


@every
def test_it_moves_without_a_jerk_everywhere(plans, name):
    """No joint and no bone is anywhere at once, at take-off, touch-down and between: speeds a human has, or nearly."""
    who, _, made = plans[name]
    positions, _, local, _ = poses(who, made)
    assert np.isfinite(positions).all()
    shown = made.times < min(made.through, np.inf)
    step = np.diff(made.times)[:, None]
    turning = np.linalg.norm(log(np.swapaxes(local[:-1], -1, -2) @ local[1:]), axis=-1) / step
    moving = np.linalg.norm(np.diff(positions, axis=0), axis=-1) / step
    assert turning[shown[1:]].max() < 45.0
    fall = np.linalg.norm(made.path.falling) + np.linalg.norm(made.path.velocity)
    assert moving[shown[1:]].max() < 14.0 + fall


@every
def test_knees_elbows_and_trunk_stay_within_their_limits(plans, name):
    """Hinges and what turns about one axis; a box of rotation vectors says little of shoulders."""
    who, _, made = plans[name]
    limits, vectors = joint_limits(who.skeleton), log(made.local[made.times < made.through])
    for part in ("LeftLeg", "RightLeg", "LeftUpLeg", "RightUpLeg", "Spine", "Spine1", "Spine2", "Neck", "Head"):
        j = who.skeleton.index(part)
        x = vectors[:, j, 0]
        assert x.min() > limits.lower[j, 0] - np.radians(8.0), part
        assert x.max() < limits.upper[j, 0] + np.radians(8.0), part
    for part in ("LeftFoot", "RightFoot"):
        x = vectors[:, who.skeleton.index(part), 0]
        assert x.min() > np.radians(-50.0) and x.max() < np.radians(75.0), part


@every
def test_it_lands_on_its_soles_about_the_place_that_was_asked(plans, places, name):
    """As soon as they are flat, whether it stops there or walks on; a runner on one."""
    who, _, made = plans[name]
    positions, turned, *_ = poses(who, made, [made.touch_down + (0.1 if made.path.lands is None else 0.03)])
    on = [0, 1] if made.path.lands is None else [made.path.lands]
    corners = sole_corners(who.skeleton, positions, turned)[0].reshape(2, 6, 3)[on][:, [0, 1, 4, 5]]
    rises = 0.05 if np.isfinite(made.through) else 0.02  # who walks on is past his feet by then, and his heels rise
    assert np.linalg.norm((corners.mean((0, 1)) - places[name])[[0, 2]]) < 0.02
    assert np.ptp(corners[..., 1]) < rises and abs(corners[..., 1].min() - places[name][1]) < 0.01


@two_feet
def test_balance_is_kept_as_it_winds_up(plans, name):
    """Until the body falls ahead of its feet, which is what brings it forward: see the next law."""
    who, state, made = plans[name]
    times = np.linspace(0.2 * made.push_off, 0.7 * made.push_off, 12)
    positions, turned, _, centre = poses(who, made, times)
    for corners, over in zip(sole_corners(who.skeleton, positions, turned), centre):
        on = corners[corners[:, 1] < float(state.floor) + 0.012]
        assert margin(hull(on[:, [0, 2]]), over[[0, 2]]) > 0.0


@every
def test_the_ground_gives_what_moves_the_body(plans, name):
    """F = m (c̈ − g) of the played centre of mass, and it never pulls, slips or pushes from where no foot is."""
    who, state, made = plans[name]
    mass, g = who.physique.mass, who.gravity
    centre = poses(who, made)[3]
    ends = (0.0, made.take_off, float(state.floor)), (made.touch_down, min(made.through, made.duration), 0.0)
    for first, last, floor in ends:
        n = np.flatnonzero((made.times > first + 1e-9) & (made.times < last - 1e-9))[1:-1]
        before, after = (made.times[n] - made.times[n - 1])[:, None], (made.times[n + 1] - made.times[n])[:, None]
        bent = 2.0 * (after * centre[n - 1] - (before + after) * centre[n] + before * centre[n + 1]) / (before * after * (before + after))
        even = (np.abs(before - after) < 1e-9)[:, 0]  # where steps change, the quotient is only roughly the derivative
        force = made.forces[n]
        np.testing.assert_allclose(force[even], mass * (bent - g)[even], atol=(0.06 if made.path.lands is None else 0.1) * mass * 9.81)
        assert force[:, 1].min() > 0.0
        held = force[:, 1] > -0.3 * mass * g[1]
        assert np.linalg.norm(force[held][:, [0, 2]], axis=1).max() < np.max(force[held, 1])
        if first == 0.0:
            pressed = centre[n] - force / force[:, 1:2] * (centre[n, 1:2] - floor)
            positions, turned, *_ = poses(who, made, [0.5 * made.push_off])
            feet = sole_corners(who.skeleton, positions, turned)[0].reshape(2, 6, 3)
            single = who.start_of(state).single
            on = feet.reshape(-1, 3) if single is None else feet[single]
            assert min(margin(hull(on[:, [0, 2]]), one[[0, 2]]) for one in pressed[held]) > -0.04


@every
def test_nothing_pushes_in_the_air(plans, name):
    _, _, made = plans[name]
    air = (made.times > made.take_off + 1e-9) & (made.times < made.touch_down)
    assert not made.forces[air].any() and not made.contacts[air].any()


def test_two_plans_of_one_jump_are_the_same_to_the_bit(plans):
    from gambol.controllers.contract import Intent, Leap
    who, state, made = plans["far"]
    again = who.plan(state, Intent(leap=Leap(np.array([state.ground[0] + 0.8 * np.sin(state.ground[2]), 0.0,
                                                       state.ground[1] + 0.8 * np.cos(state.ground[2])]))))
    assert again.roots.tobytes() == made.roots.tobytes() and again.local.tobytes() == made.local.tobytes()


@pytest.mark.parametrize("strength", [0.9, 0.95, 1.0])
def test_a_high_jump_goes_as_deep_as_the_spring_muscles_need(jump, standing, strength):
    """The thesis's control loop, muscles and balance and all, ends where the played crouch does; other springs, another depth."""
    from gambol.controllers.contract import Intent, Leap
    from gambol.controllers.jump import Jump, Physique
    from gambol.controllers.jump.body import airtime_up, measures
    from gambol.controllers.jump.muscles import crouch
    body = Physique(strength=strength)
    made = Jump(body).plan(standing, Intent(leap=Leap(None, airtime_up(body, 0.33 * strength, jump.gravity))))
    stand = measures(body).stand
    wound = crouch(body, made.path.velocity, float(made.path.leave[1] - stand))
    assert wound.converged and wound.depth == pytest.approx(stand - made.path.low[1], abs=0.015)
