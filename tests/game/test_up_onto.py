"""Hands that walk up to a box and leap onto it: they make room for the leap first, and rings lie where both feet fit."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gambol.controllers.jump import Jumping
from gambol.controllers.navigation import floor_at, gap
from gambol.controllers.person import person
from gambol.controllers.struck import flesh
from gambol.controllers.body import forward_kinematics
from gambol.game.input.on_top import ASIDE, SOLES, on_top, past_edge
from gambol.game.input.straight_ahead import before, clear_of, cramped
from gambol.game.input.wish import Wish
from gambol.game.scene.scene import Box
from gambol.game.session.state import begin
from gambol.game.session.tick import Timeline, refused
from gambol.game.world.world import DT, Character, World


@pytest.fixture(scope="module")
def somebody():
    return person()


def box(high, far=1.4):
    return Box((0.0, 0.5 * high, far + 1.0), (3.0, high, 2.0))


def led(who, things, hands, start=(0.0, 0.0, 0.0)):
    """The states of somebody led by hands, (seconds, how far the stick is ahead, whether the key is held), and where he aimed in each."""
    line, states, aims = Timeline(begin(World((Character("A", who, who.start(start)),), things), 1)), [], []
    for seconds, ahead, held in hands:
        for _ in range(round(seconds / DT)):
            line.advance((Wish(move=(0.0, ahead), jump=held).rounded(),))
            states.append(line.now.after.characters[0].state)
            aims.append(line.now.players[0].aim)
    return states, aims


def deepest(who, states, thing):
    body = who.parts["jump"].physique
    placed = forward_kinematics(body.skeleton, np.stack([s.pose.root for s in states]).astype(float), np.stack([s.pose.rotations for s in states]).astype(float))
    points, thick = flesh(body, *placed)
    return float((thick - gap(points.reshape(-1, 3), thing).reshape(points.shape[:2])).max())


def leaps(states):
    """The number of the state in which a leap begins."""
    return next(k for k, state in enumerate(states) if isinstance(getattr(state.memory, "memory", None), Jumping))


@pytest.mark.few(1)
@pytest.mark.parametrize("high", [0.3, 0.42, 0.53])
def test_who_has_walked_up_to_a_box_leaps_onto_it_from_where_he_rests(somebody, high):
    """He took a step back first, and was on top of it a second later for that."""
    thing = box(high)
    states, _ = led(somebody, (thing,), [(2.6, 1.0, False), (0.6, 0.0, False), (0.1, 1.0, True), (3.0, 0.0, False)])
    rested, off = states[round(3.2 / DT) - 1], leaps(states)
    assert states[off].ground[1] > rested.ground[1] - 0.02 and off * DT - 3.3 < 0.15
    assert states[-1].floor == pytest.approx(high, abs=0.01) and deepest(somebody, states, thing) < 0.03


@pytest.mark.few(1)
@pytest.mark.parametrize(("high", "far"), [(0.3, 0.2), (0.42, 0.25), (0.53, 0.3)])
def test_who_stands_too_near_to_a_box_goes_back_and_leaps_onto_it(somebody, high, far):
    thing = box(high, far)
    states, aims = led(somebody, (thing,), [(0.2, 0.0, False), (0.1, 1.0, True), (4.0, 0.0, False)])
    assert states[leaps(states)].ground[1] < -0.05
    assert states[-1].floor == pytest.approx(high, abs=0.01) and deepest(somebody, states, thing) < 0.03
    held = [aim.place for aim in aims if aim.place is not None and not aim.aiming]
    assert held and np.ptp(np.array(held), axis=0).max() < 0.02, "the ring stays where hands left it as he goes back"


@pytest.mark.few(1)
@pytest.mark.parametrize(("far", "askew"), [(0.45, 0.0), (0.6, 0.0), (0.4, 0.5)])
def test_who_stands_near_a_box_and_taps_with_the_stick_at_it_leaps_onto_it(somebody, far, askew):
    """His ring lay 0.15 m before him, and he hopped against the box."""
    thing = box(0.3, far)
    states, _ = led(somebody, (thing,), [(0.2, 0.0, False), (0.1, 1.0, True), (2.0, 0.0, False)], (0.0, 0.0, askew))
    assert states[-1].floor == pytest.approx(0.3, abs=0.01) and deepest(somebody, states, thing) < 0.03
    away, _ = led(somebody, (thing,), [(0.2, 0.0, False), (0.1, 0.0, True), (2.0, 0.0, False)], (0.0, 0.0, askew))
    assert away[-1].floor == 0.0, "who holds no stick leaps where he stands"


@pytest.mark.few(1)
@pytest.mark.parametrize("near", [0.35, 0.65, 0.8, 1.1])
def test_who_walks_at_a_box_and_taps_is_soon_on_it(somebody, near):
    """Wherever he taps: who was slow enough to aim from a stand first came to a stop, and 2.5 s went by."""
    thing = box(0.3, 2.4)
    line, states, tapped = Timeline(begin(World((Character("A", somebody, somebody.start()),), (thing,)), 1)), [], 0
    while len(states) < 4.5 / DT:
        tapped += bool(tapped) or 2.4 - line.now.after.characters[0].state.ground[1] < near
        line.advance((Wish(move=(0.0, float(tapped < 60)), jump=0 < tapped <= 6).rounded(),))
        states.append(line.now.after.characters[0].state)
        if tapped == 1:
            since = len(states)
    there = next(k for k, state in enumerate(states) if abs(state.floor - 0.3) < 0.01 and np.any(state.contacts))
    assert (there - since) * DT < 1.6
    assert deepest(somebody, states[:there + 12], thing) < 0.03


def test_who_holds_the_leap_as_he_walks_comes_to_rest_with_room_for_it(somebody):
    state = somebody.start((0.0, 0.0, 0.0))
    rests = {high: 0.9 - before(somebody, state, (0.0, 1.3), (box(high, 0.9),))[1] for high in (1.6, 0.5, 0.3)}
    assert rests[1.6] < clear_of(0.5) - 0.01 and rests[0.5] == pytest.approx(clear_of(0.5), abs=0.02) and rests[0.3] == pytest.approx(clear_of(0.3), abs=0.02)


@pytest.mark.parametrize(("high", "far", "lacks"), [(0.2, 0.2, 0.0), (0.26, 0.2, 0.08), (0.26, 0.3, 0.0), (0.35, 0.3, 0.14), (0.5, 0.3, 0.18), (0.5, 0.5, 0.0), (1.2, 0.3, 0.0)])
def test_how_much_room_is_wanting(somebody, high, far, lacks):
    """Onto treads, and where nothing can be leapt onto, none is needed."""
    things = (box(high, far),)
    state = somebody.start((0.0, 0.0, 0.0))
    assert cramped(somebody, state, (0.0, far + 0.4), things) == pytest.approx(lacks, abs=0.011)
    behind = (*things, Box((0.0, 1.0, -0.4), (3.0, 2.0, 0.2)))
    assert cramped(somebody, state, (0.0, far + 0.4), behind) == 0.0, "there is no room to go back"
    assert cramped(somebody, state, (0.0, -1.0), things) == 0.0, "it lies behind him"


def test_who_goes_askew_at_a_box_needs_more_room(somebody):
    """One of his legs is nearer to it."""
    askew = somebody.start((0.0, 0.0, 0.6))
    assert cramped(somebody, askew, (0.9 * np.sin(0.6), 0.9 * np.cos(0.6)), (box(0.5, 0.38),)) > 0.03
    assert cramped(somebody, askew, (0.0, 0.9), (box(0.5, 0.49),)) == 0.0


@given(st.floats(-2.2, 2.2), st.floats(0.8, 4.0), st.floats(0.1, 0.9))
def test_a_ring_lies_where_both_feet_fit_and_near_to_where_hands_left_it(x, z, high):
    things = (box(high),)
    place = on_top((x, z), 0.0, things)
    assert np.hypot(place[0] - x, place[1] - z) <= ASIDE + 1e-6
    turned = np.linspace(0.0, 2.0 * np.pi, 8, endpoint=False)
    heights = [floor_at(place[0] + SOLES * np.sin(a), place[1] + SOLES * np.cos(a), things) for a in turned]
    assert np.ptp(heights) < 1e-9
    if all(abs(floor_at(x + SOLES * np.sin(a), z + SOLES * np.cos(a), things) - floor_at(x, z, things)) < 1e-9 for a in turned):
        assert place == (x, z)
    assert on_top((x, z), 0.0, ()) == (x, z)


def test_who_brakes_as_he_taps_at_a_box_keeps_facing_it_and_leaps_onto_it(somebody):
    thing = Box((0.0, 0.2, 5.4), (2.0, 0.4, 0.74))
    line, tapped, states, aims = Timeline(begin(World((Character("A", somebody, somebody.start()),), (thing,)), 1)), 0, [], []
    while len(states) < 7.0 / DT:
        state = line.now.after.characters[0].state
        tapped += bool(tapped) or state.ground[1] + 0.7 + 0.52 * state.velocity[0] > 5.38
        on = tapped < 41
        line.advance((Wish(move=(0.0, float(on)), run=0.475 * on, jump=0 < tapped <= 4).rounded(),))
        states.append(state)
        aims.append(line.now.players[0].aim)
    assert max(abs(float(state.ground[2])) for state in states) < 0.3, "he does not turn his back"
    assert states[-1].floor == pytest.approx(0.4, abs=0.01)
    held = [aim.place for aim in aims if aim.waiting > 0.0]
    assert held and None not in held and np.ptp(np.array(held), axis=0).max() < 0.02, "the ring stays where it was let go"


def tapped(who, thing, run, press, ring, later):
    """The states of somebody who goes at a box, presses the leap's key once his ring is beyond a place along z [m], lets go of it once it is beyond another, and of all `later` [s]; where he aimed, and what he was told."""
    line, held, tapped, states, aims, told = Timeline(begin(World((Character("A", who, who.start()),), (thing,)), 1)), False, 0, [], [], []
    while len(states) < 7.0 / DT:
        state = line.now.after.characters[0].state
        lies = state.ground[1] + 0.7 + 0.52 * state.velocity[0]
        held, tapped = held or lies > press, tapped + (tapped > 0 or lies > ring)
        on, before = tapped <= 4 + round(later / DT), line.now
        line.advance((Wish(move=(0.0, float(on)), run=run * on, jump=held and tapped <= 4).rounded(),))
        states.append(state)
        aims.append(line.now.players[0].aim)
        told += refused(before, line.now)
    return states, aims, told


@pytest.mark.few(1)
@pytest.mark.parametrize(("run", "far", "deep", "high", "press", "ring", "later"), [
    (0.463, 4.551, 0.848, 0.581, 4.799, 4.799, 0.6), (0.822, 5.12, 0.902, 0.57, 5.432, 5.432, 0.0), (0.359, 4.88, 1.975, 0.59, 4.483, 5.384, 0.0)])
def test_who_stops_before_a_box_as_he_waits_leaps_onto_it_from_where_he_rests(somebody, run, far, deep, high, press, ring, later):
    """He comes to rest later than a leap on the move is waited for, and then looks for one that can be made."""
    states, aims, told = tapped(somebody, Box((0.0, 0.5 * high, far + 0.5 * deep), (2.0, high, deep)), run, press, ring, later)
    assert not told
    assert states[-1].floor == pytest.approx(high, abs=0.01)
    assert any(aim.moving and aim.waiting > 0.0 for aim in aims) and any(aim.stands and aim.waiting > 0.0 for aim in aims)


@pytest.mark.few(1)
@pytest.mark.parametrize(("high", "far"), [(0.5, 0.5), (0.57, 0.5), (0.57, 0.62)])
def test_a_ring_pushed_over_a_high_box_stops_where_legs_still_clear_its_edge(somebody, high, far):
    """From near by legs would come against the edge of who leaps far over it."""
    states, _ = led(somebody, (box(high, far),), [(0.2, 0.0, False), (0.9, 1.0, True), (3.0, 0.0, False)])
    assert states[-1].floor == pytest.approx(high, abs=0.01)


@pytest.mark.few(1)
@pytest.mark.parametrize(("high", "far"), [(0.47, 1.32), (0.4, 1.62), (0.3, 1.66)])
def test_who_aims_far_over_a_box_from_near_by_is_off_soon_after_he_lets_go(somebody, high, far):
    """1.7 s went by: each millimetre that he still glided, another leap was asked, and looked for anew, and none of them could be made."""
    hands = [(2.4, 1.0, False), (0.6, 0.0, False), (0.85, 1.0, True), (2.5, 0.0, False)]
    states, _ = led(somebody, (box(high, far),), hands)
    assert leaps(states) * DT - sum(seconds for seconds, *_ in hands[:3]) < 0.9
    assert states[-1].floor == pytest.approx(high, abs=0.01)


@given(st.floats(0.05, 1.4), st.floats(0.3, 0.9))
def test_how_far_a_ring_lies_past_an_edge(past, high):
    assert past_edge((0.0, 1.4 + past), (0.0, 0.6), high, (box(high),)) == pytest.approx(past, abs=0.013)
