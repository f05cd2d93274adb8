"""A foot that swings goes the smoothest way to its foothold, and gives way early to the one that stands."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from gambol.controllers.body.contact import feet_apart
from gambol.controllers.compiled import kernel
from gambol.controllers.locomotion.foothold import plan_footholds
from gambol.controllers.locomotion.foretold_way import room_to_plan
from gambol.controllers.locomotion.minimum_jerk import smoothest
from gambol.controllers.locomotion.swing import _reach
from playing import FPS, hold, play

PLACE, SPEED, PUSH = st.floats(-0.5, 0.5), st.floats(-2, 2), st.floats(-20, 20)
WHOLE, SHARE = st.floats(0.06, 0.8), st.floats(0, 0.95)


def at(x, v, a, whole, s):
    """Place, speed and acceleration on the smoothest way."""
    return tuple(float(smoothest(x, v, a, whole, s, order)) for order in range(3))


@given(x=PLACE, v=SPEED, a=PUSH, whole=WHOLE)
def test_the_smoothest_way_leaves_as_it_is_and_ends_at_rest(x, v, a, whole):
    np.testing.assert_allclose(at(x, v, a, whole, 0.0), (x, v, a), atol=1e-9)
    np.testing.assert_allclose(at(x, v, a, whole, 1.0), 0.0, atol=1e-8 / whole**2)


@given(x=PLACE, v=SPEED, a=PUSH, whole=WHOLE, first=SHARE, then=SHARE)
def test_a_way_planned_anew_on_it_is_the_same(x, v, a, whole, first, then):
    """So that it does not matter how many steps a swing is made in."""
    left = whole * (1.0 - first)
    anew = at(*at(x, v, a, whole, first), left, then)
    once = at(x, v, a, whole, first + then * (1.0 - first))
    np.testing.assert_allclose(anew, once, atol=1e-8 / left**2)


def changing(befores, after, phases=12):
    """Walkers who wish one thing and then, at `phases` moments of a stride, another."""
    wish = np.zeros((round(6.5 * FPS), phases * len(befores), 3))
    for n in range(wish.shape[1]):
        wish[:, n] = befores[n % len(befores)]
        wish[round((3.0 + 0.1 * (n // len(befores))) * FPS):, n] = after
    return wish


def test_swinging_feet_change_neither_speed_nor_acceleration_at_once(locomotion):
    """Their offset from the blend, that is, though the foothold is planned anew in every step."""
    motion = play(locomotion, changing(((1.3, 0, 0), (0.7, 0, 0), (0, 0, 0.45)), (0.6, 0.8, 0)))
    memory = np.array([s.memory for s in motion.states])
    free = memory["grip"].reshape(*memory.shape, 2, 2).max(-1) <= 0.0
    both = free[1:] & free[:-1]
    rate, push = (memory[name].astype(float) for name in ("offset_rate", "offset_push"))
    off = np.abs(np.diff(rate, axis=0) - 0.5 * (push[1:] + push[:-1]) / FPS)[both][:, :2]
    assert both.sum() > 2000 and np.abs(rate).max() > 0.5
    assert np.quantile(off, 0.999) < 0.1, "speeds go as accelerations say [m/s]"


@pytest.mark.few(1)
@pytest.mark.parametrize(("before", "after"), [((0.6, 0, 0.35), (0.6, 0, -0.35)), ((0.6, 0, -0.35), (0, 1.5, 0)), ((0, 0, 0.45), (0, 0, -0.45))],
                         ids=str)
def test_feet_pass_each_other_at_a_distance(locomotion, before, after):
    motion = play(locomotion, changing((before,), after, 24))
    assert feet_apart(locomotion.skeleton, motion.positions, motion.orientations)[2 * FPS:].min() > 0.05


@kernel
def _ways(memory, settings, space, table, turns, body, legs, joints):
    ahead = room_to_plan(memory["weights"].shape[1], joints)
    until, shares = np.empty((len(memory), 2)), np.empty((len(memory),) + ahead.shares.shape)
    way = np.empty((len(memory),) + ahead.way.shape)
    for n in range(len(memory)):
        plan_footholds(memory[n], settings, space, table, turns, body, legs, ahead, True, 1 / FPS)
        until[n], shares[n], way[n] = ahead.until, ahead.shares, ahead.way
    return until, shares, way


def test_in_steady_walks_the_way_of_the_blend_s_foot_is_foretold(locomotion):
    motion = play(locomotion, hold(6, (1.3, 0, 0), (0.7, 0, 0), (0.5, 0, 0.3), (0, 0, 0.4), (0.9, 0.6, 0)))
    now = 4 * FPS
    memory, tables = np.array(motion.states[now].memory), locomotion.tables
    until, shares, way = _ways(memory, locomotion.settings, tables.walk, tables.series, tables.turns, tables.body, tables.legs, len(locomotion.skeleton))
    places = np.array([_on_floor(s.memory) for s in motion.states[now:now + FPS]])
    off = []
    for n, foot, k in zip(*np.nonzero((shares > 0.0) & (shares < 1.0))):
        when = shares[n, foot, k] * until[n, foot] * FPS
        first = int(when)
        between = places[first, n] + (when - first) * (places[first + 1, n] - places[first, n])
        off.append(np.abs(way[n, foot, k, :2][:, [0, 2]] - between[2 * foot:2 * foot + 2]).max())
    assert len(off) > 10 and max(off) < 0.08 and np.median(off) < 0.03


def _on_floor(memory):
    """Where the blend's contact points are (..., 4, 2): x, z in the world."""
    x, z, heading = (memory["ground"][..., i, None] for i in range(3))
    c, s = np.cos(heading), np.sin(heading)
    aside, ahead = memory["points"][..., 0], memory["points"][..., 2]
    return np.stack([x + c * aside + s * ahead, z - s * aside + c * ahead], -1)


@pytest.mark.few(1)
@pytest.mark.parametrize("turning", [2.0, -2.0])
def test_both_feet_keep_as_far_apart_whichever_way_one_turns(locomotion, turning):
    """The left foot gave way to where the right one had been a step ago: as the blend and the place of a foot part, in a run that turns, that was 3 cm off."""
    motion = play(locomotion, changing(((2.4, 0, 0), (3.0, -0.4 * turning, 0)), (1.8, turning, 0), 12))
    assert feet_apart(locomotion.skeleton, motion.positions, motion.orientations)[2 * FPS:].min() > 0.06


def test_the_least_push_leads_as_far_in_time():
    """Falling evenly to nothing, it leads there exactly; where one gets as far anyhow there is none."""
    place, speed, push, later, dt = np.array([0.01, -0.02]), np.array([0.3, 0.1]), np.array([-4.0, 2.0]), 0.15, 1e-4
    _reach(place, speed, push, later, 0.6, 0.8, 0.09)
    before, (x, v) = push.copy(), (place.copy(), speed.copy())
    for k in range(round(later / dt)):
        a = push * (1.0 - (k + 0.5) * dt / later)
        x, v = x + dt * v + 0.5 * dt * dt * a, v + dt * a
    assert x @ [0.6, 0.8] == pytest.approx(0.09, abs=1e-5)
    _reach(place, speed, push, later, 0.6, 0.8, 0.08)
    np.testing.assert_array_equal(push, before)
