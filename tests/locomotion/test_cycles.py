"""Steady frames, warps and stances: what gait cycles are made with."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from gambol.controllers.body import human
from gambol.controllers.body.ground_frame import advance, compose
from gambol.controllers.body.human import CONTACT_HEIGHT
from gambol.controllers.locomotion.cycles import CONTACT_SPEED, EVENTS, RATE, Track, _close, stance, steady_frame, warp
from gambol.controllers.locomotion.mass_centre import _shift

law = settings(max_examples=40, deadline=None)
places = st.tuples(*[st.floats(-20, 20)] * 2, st.floats(-7, 7)).map(np.array)
speeds = st.one_of(st.floats(-4, 4), st.floats(-1e-6, 1e-6), st.just(0.0))
velocities = st.tuples(speeds, speeds, speeds).map(np.array)


@law
@given(places, velocities, st.floats(0.4, 2.0), st.integers(0, 2**32 - 1))
def test_a_steady_frame_sees_through_the_sway(first, velocity, period, seed):
    """Shoulders that sway evenly about a steady walk: the walk comes back, and where it began."""
    velocity = velocity * [1, 0.5, 0.3]
    rng = np.random.default_rng(seed)
    frames = 121
    phase = np.linspace(0, 1, frames)
    sway = sum(rng.normal(size=3) * np.array([0.02, 0.02, 0.08]) / k * np.sin(2 * np.pi * (k * phase[:, None] + rng.random(3)))
               for k in (1, 2, 3))
    sway -= sway[:-1].mean(0)
    path = compose(advance(first, velocity, phase * period), sway)
    found, speed = steady_frame(path, period)
    np.testing.assert_allclose(speed, velocity, atol=1e-3)
    np.testing.assert_allclose(found, first, atol=1e-3)


gaps = st.lists(st.floats(0.05, 1), min_size=4, max_size=4).map(
    lambda parts: np.concatenate([[0.0], np.cumsum(parts)[:3]]) / np.sum(parts))
"""When four events fall in a cycle: from 0, in order, none at once."""


@law
@given(gaps, gaps, st.floats(-1, 0))
def test_a_warp_puts_events_on_the_common_phase_and_never_turns_back(events, canonical, start):
    time, _ = warp(events, canonical, canonical)
    np.testing.assert_allclose(time, events, atol=1e-12)
    phase = np.linspace(start, start + 1, 400)
    time, slope = warp(events, canonical, phase)
    assert np.all(np.diff(time) > 0) and np.all(slope >= 0)
    np.testing.assert_allclose(time[-1], time[0] + 1, atol=1e-9)
    np.testing.assert_allclose(warp(events, canonical, phase + 1)[1], slope, atol=1e-9)
    h = 1e-6
    ahead, behind = (warp(events, canonical, phase + d)[0] for d in (h, -h))
    np.testing.assert_allclose((ahead - behind) / (2 * h), slope, rtol=1e-2, atol=1e-2)  # C1: curvature jumps at events


@law
@given(gaps)
def test_events_already_in_place_are_not_warped(events):
    phase = np.linspace(0, 1, 50)
    time, slope = warp(events, events, phase)
    np.testing.assert_allclose(time, phase, atol=1e-12)
    np.testing.assert_allclose(slope, 1.0, atol=1e-9)


def test_half_a_cycle_on_the_other_foot_does_the_same():
    """The common phases are symmetric, so a mirrored cycle needs no other warp."""
    for phases in EVENTS.values():
        np.testing.assert_allclose(np.sort((phases + 0.5) % 1), phases, atol=1e-12)


def stepping(mask, family):
    """A track whose feet stand still on the floor where `mask` (T, 2) says, and else fly fast and high."""
    points = np.zeros((len(mask), 4, 3))
    stands = np.repeat(mask, 2, axis=1)
    points[..., 1] = np.where(stands, CONTACT_HEIGHT, CONTACT_HEIGHT + 0.2)
    return Track(None, np.zeros((len(mask), 3)), points, np.where(stands, 0.0, 2 * CONTACT_SPEED[family]),
                 np.zeros((0, len(human()))))


def lengths(mask):
    """(value, length) of the inner runs of a mask."""
    edges = np.flatnonzero(np.diff(mask)) + 1
    return [(bool(mask[a]), b - a) for a, b in zip(edges[:-1], edges[1:])]


@law
@given(st.sampled_from(("walk", "run")), st.lists(st.integers(1, 40), min_size=2, max_size=20), st.booleans())
def test_stances_have_no_chatter(family, runs, first):
    """Gaps under 60 ms are closed, then contacts under 100 (running 60) ms dropped; longer ones stay."""
    foot = np.concatenate([np.full(n, first ^ bool(i % 2)) for i, n in enumerate(runs)])
    feet = stance(stepping(np.stack([foot, ~foot], 1), family), family)
    least = {True: (0.06 if family == "run" else 0.10) * RATE - 1, False: 0.06 * RATE - 1}
    for side in feet.T:
        assert all(length >= least[value] for value, length in lengths(side))
    if all(n >= 0.1 * RATE for n in runs):
        np.testing.assert_array_equal(feet, np.stack([foot, ~foot], 1))


def test_a_gap_goes_before_a_contact_does():
    """Two short contacts with a shorter gap between them are one contact."""
    foot = np.zeros(60, bool)
    foot[20:29] = foot[32:41] = True
    feet = stance(stepping(np.stack([foot, foot], 1), "walk"), "walk")
    assert feet[20:41].all() and feet.sum() == 2 * 21


def test_one_point_makes_a_foot_stand():
    """The heel at the strike, the ball at the push-off; height or speed alone do not."""
    mask = np.ones((60, 2), bool)
    one = stepping(mask, "walk")
    one.points[:, 1, 1] = 0.3  # ball up: the heel stands
    one.speeds[:, 2] = 2.0  # heel fast: the ball stands
    assert stance(one, "walk").all()
    one.points[:, 0, 1] = 0.3
    one.speeds[:, 3] = 2.0
    assert not stance(one, "walk").any()


def test_closing_smoothly_leaves_no_jump_of_speed():
    """One who gets faster in a stride: closed, neither place nor speed jumps where it begins again."""
    time = np.linspace(0.0, 1.0, 121)[:, None]
    signal = 0.3 * time + 0.4 * time**2 + 0.02 * np.sin(2 * np.pi * time)
    closed = _close(signal, np.arange(120) / 120, True)[:, 0]
    around = np.concatenate([closed, closed])
    assert np.abs(np.diff(around, 2)).max() < 3e-4 < np.abs(np.diff(np.tile(_close(signal, np.arange(120) / 120)[:, 0], 2), 2)).max()


def test_a_mass_centre_in_the_air_goes_straight():
    """Of a runner whose path is bent all the time, the way is straight where nothing stands, and it turns as much."""
    phase, period, speed, turn = np.arange(96) / 96, 0.7, 3.0, 1.0
    omega = 4 * np.pi / period  # two steps a cycle
    height = -0.08 * np.cos(2 * np.pi * 2 * phase - 1.0)
    centre = np.stack([0 * phase, height, 0 * phase], -1)
    moved = _shift(centre, np.full(96, period), np.array([speed, turn, 0.0]))
    t = phase * period
    way = np.exp(-1j * turn * t) * moved + 1j * speed * (1 - np.exp(-1j * turn * t)) / (1j * turn)
    pull = np.abs(np.diff(way, 2)) / (t[1] - t[0]) ** 2
    load = 9.81 + 0.08 * omega**2 * np.cos(2 * np.pi * 2 * phase - 1.0)
    air = load[1:-1] < 1.0
    assert air.any() and pull[air].max() < 1.6 and np.abs(moved).max() < 0.05
    assert (pull / np.maximum(load[1:-1], 2.0)).max() < 0.6
