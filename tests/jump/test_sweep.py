"""No plan that a body could not play: none touches what stands about, none tumbles, and each is a plan or a reason."""

import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from conftest import ahead
from gambol.controllers.body import end_positions, forward_kinematics, sole_corners
from gambol.controllers.contract import Intent, Leap, Unable
from gambol.controllers.jump import Jump, Physique
from gambol.controllers.jump.reach.feasibility import Refused
from gambol.controllers.jump.planner import drafted
from gambol.controllers.jump.reach import reach
from gambol.controllers.jump.reach.arcs import How
from gambol.controllers.jump.reach.sweep import surely, touch
from gambol.controllers.navigation import gap
from gambol.game.scene.scene import Box

BODIES = (Physique(), Physique(30.0, 1.3, 0.9, 1.1), Physique(110.0, 1.75, 0.75, 0.8))


def deepest(jump, made, around):
    """How deep bones and soles are in things [m], from the whole plan's poses, 0 if nowhere."""
    shown = [made.at(t) for t in np.arange(0.0, min(made.duration, made.through), 1 / 120)]
    positions, turned = forward_kinematics(jump.skeleton, np.stack([p.root for p in shown]), np.stack([p.rotations for p in shown]))
    parents = jump.skeleton.parents
    bones = [positions[:, parents[j]] + part * (positions[:, j] - positions[:, parents[j]]) for j in range(1, len(parents))
             for part in (0.25, 0.5, 0.75, 1.0) if jump.skeleton.names[j][-3:] not in ("Toe", "oot")]
    points = np.concatenate([np.stack(bones, 1), end_positions(jump.skeleton, positions, turned)[
        :, [jump.skeleton.end_index[n] for n in ("Head", "LeftHand", "RightHand")]],
        sole_corners(jump.skeleton, positions, turned).reshape(len(shown), -1, 3) + [0.0, 0.02, 0.0]], 1)
    return max(0.0, *(-gap(points.reshape(-1, 3), thing).min() for thing in around))


@pytest.mark.few(3)
@pytest.mark.parametrize(("far", "up", "thing"), [
    (1.0, 0.0, Box((0.0, 0.1, 0.5), (2.0, 0.2, 0.2))), (1.0, 0.0, Box((0.0, 0.15, 0.6), (2.0, 0.3, 0.1))),
    (0.9, 0.3, Box((0.0, 0.15, 1.65), (3.0, 0.3, 2.0))), (0.7, 0.45, Box((0.0, 0.225, 1.45), (3.0, 0.45, 2.0))),
    (0.9, 0.0, Box((0.0, 1.5, 1.3), (4.0, 3.0, 0.2))), (1.0, 0.0, Box((0.0, 2.4, 0.5), (4.0, 1.0, 1.0)))])
def test_no_plan_touches_what_stands_about_and_neither_does_what_is_offered_instead(jump, standing, far, up, thing):
    place = ahead(standing, far, up)
    try:
        made = jump.plan(standing, Intent(leap=Leap(place), around=(thing,)))
    except Refused as reason:
        assert reason.nearest is None or np.linalg.norm(reason.nearest - place) > 0.01
        if reason.nearest is None:
            return
        made = jump.plan(standing, Intent(leap=Leap(reason.nearest), around=(thing,)))
    assert deepest(jump, made, (thing,)) == 0.0 and touch(jump.physique, made, (thing,)) is None


@pytest.mark.parametrize(("part", "joint"), [("head", "Head"), ("trunk", "Spine1"), ("hands", "LeftHand"), ("legs", "RightLeg")])
def test_the_sweep_tells_what_is_touched(jump, standing, part, joint):
    made = jump.plan(standing, Intent(leap=Leap(ahead(standing, 0.8))))
    pose = made.at(0.5 * (made.take_off + made.touch_down))
    at = forward_kinematics(jump.skeleton, pose.root, pose.rotations)[0][jump.skeleton.index(joint)]
    found = touch(jump.physique, made, (Box(tuple(at), (0.06, 0.06, 0.06)),))
    said = re.fullmatch(r"its (\w+) would hit something (\d\.\d) m ahead", found.reason)
    assert 0.0 < found.deep < 0.2 and said is not None and said[1] == part and float(said[2]) == pytest.approx(float(np.hypot(*(at - made.centres[0])[[0, 2]])), abs=0.15), "so far ahead of the body"
    assert touch(jump.physique, made, (Box((3.0, 0.5, 0.0), (0.1, 1.0, 0.1)), Box((0.0, -0.5, 0.0), (9.0, 1.0, 9.0)))) is None


@settings(max_examples=40, deadline=None)
@given(st.sampled_from(BODIES), st.floats(0.2, 60.0), st.floats(-np.pi, np.pi), st.floats(0.0, 4.0), st.floats(-2.0, 1.0),
       st.one_of(st.none(), st.floats(0.05, 10.0)), st.booleans())
def test_every_leap_of_every_body_under_every_gravity_is_a_plan_or_unable(standing, running, body, pull, way, far, up, airtime, runs):
    """And a plan is one: finite, and upright enough all along."""
    state = running if runs else standing
    heading = float(state.ground[2]) + way
    place = np.array([state.ground[0] + far * np.sin(heading), up, state.ground[1] + far * np.cos(heading)])
    try:
        made = Jump(body, (0.0, -pull, 0.0)).plan(state, Intent(leap=Leap(place, airtime)))
    except Unable as reason:
        assert str(reason)
        return
    assert np.isfinite(made.roots).all() and np.isfinite(made.local).all() and (np.diff(made.times) > 0.0).all()
    air = (made.times >= made.take_off) & (made.times <= made.touch_down)
    assert made.local[air, 0, 1, 1].min() > 0.0, "never upside down"


@pytest.mark.parametrize("way", np.linspace(-np.pi, np.pi, 9))
def test_nobody_is_tilted_much_whichever_way_it_jumps(jump, standing, way):
    """Off axis, too; those that were let somersaulted."""
    for far, airtime in ((0.3, 0.5), (0.6, 0.4), (0.8, 0.35)):
        heading = float(standing.ground[2]) + way
        place = np.array([standing.ground[0] + far * np.sin(heading), 0.0, standing.ground[1] + far * np.cos(heading)])
        made = jump.plan(standing, Intent(leap=Leap(place, airtime)))
        air = (made.times >= made.take_off) & (made.times <= made.touch_down)
        assert np.degrees(np.arccos(made.local[air, 0, 1, 1].min())) < 35.0
        assert np.degrees(np.arccos(made.local[air, 0, 1, 1][-1])) < 35.0


@pytest.mark.parametrize("far, high, at, deep", [(1.0, 0.6, 0.5, 0.2), (1.2, 0.9, 0.6, 0.3), (1.0, 0.25, 0.5, 0.2), (1.0, 1.2, 0.5, 0.2), (0.9, 0.3, 0.45, 0.05), (1.0, 0.1, 0.5, 0.1)])
def test_what_a_flight_surely_touches_its_plan_touches(jump, standing, far, high, at, deep):
    start, place, box = jump.start_of(standing), ahead(standing, far), Box((0.0, high / 2, at), (2.0, high, deep))
    draft = drafted(jump.physique, start, jump.arc(start, place, 0.0, (), How(None, False, False, 0)).path, place, 0.0)
    sure, found = surely(jump.physique, start, draft.turning, (box,)), touch(jump.physique, draft.plan(), (box,))
    assert (sure is not None) == (deep >= 0.2), "what is thick is seen before the plan is finished"
    if sure is not None:
        assert found.reason == sure.reason and found.deep == pytest.approx(sure.deep, abs=0.01)


@pytest.mark.parametrize("at, once", [(1.2, True), (1.3, True), (0.3, False), (0.55, False)])
def test_who_would_land_with_his_legs_in_something_is_not_asked_to_come_another_way(jump, standing, monkeypatch, at, once):
    """Whatever way he came, his knees would be in the box as he bends them; of what he would touch in the air that is not said."""
    made, draft = [], reach.drafted
    monkeypatch.setattr(reach, "drafted", lambda *given: made.append(1) or draft(*given))
    found, why = jump.attempt(jump.start_of(standing), ahead(standing, 1.0), 0.0, None, (Box((0.0, 0.25, at), (2.0, 0.5, 0.1)),))
    assert found is None and why.startswith("its legs would hit something")
    assert (len(made) == 1) == once
