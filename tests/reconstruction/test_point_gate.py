"""Whatever trackers do, what is followed moves like a body, and what a body does is never taken for a fault."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gambol.controllers.body import exp
from gambol.controllers.reconstruction.following.gate_kernels import BLINK, NEAR, PATIENCE, REACH
from gambol.controllers.reconstruction.following.point_gate import CALM, ENOUGH, EVERY, LISTENED, MARGIN, MOST, SELDOM, Doubts, Gate, rotations

DT = 1 / 60


def passed(seen, body=None):
    """What a gate makes of points seen (T, n, 3), with the body where `body` (T, n, 3) says; it begins as the body is."""
    body = np.zeros_like(seen) if body is None else body
    motion = np.diff(body, axis=0, prepend=2 * body[:1] - body[1:2]) / DT
    gate, goals = Gate.before(body[0] - motion[0] * DT, motion[0]), []
    for now, there, moves in zip(seen, body, motion):
        gate, goal = gate.admit(now, there, moves, DT)
        goals.append(goal)
    return np.stack(goals), gate


def swinging(frames=240, reach=0.5, hertz=1.5):
    """A wrist that swings, (T, 1, 3): 44 m/s² at its ends, as in a run."""
    time = np.arange(frames)[:, None] * DT
    return np.stack([reach * np.sin(2 * np.pi * hertz * time), 0 * time, 0 * time], -1)


def test_what_a_body_does_goes_through_as_it_is():
    seen = swinging()
    goals, _ = passed(seen, seen)
    assert np.allclose(goals, seen, atol=1e-9)


@given(st.floats(0.0, 0.012), st.integers(0, 99))
@settings(max_examples=20)
def test_noise_is_no_fault(deviation, seed):
    seen = swinging()
    noisy = seen + np.random.default_rng(seed).normal(0, deviation, seen.shape)
    goals, _ = passed(noisy, seen)
    assert np.isfinite(goals).all()


@given(st.integers(30, 100), st.integers(1, 60), st.permutations(range(3)), st.sampled_from([1, 2]))
@settings(max_examples=25)
def test_exchanged_points_are_told_apart(first, count, order, step):
    """Two of three that swing, half a metre or more apart, exchange their numbers for a while; at half the rate, too."""
    seen = (swinging() + 0.6 * np.arange(3)[:, None] * [0.0, 1.0, 0.0])[::step]
    torn, (a, b, _) = seen.copy(), order
    torn[first:first + count, [a, b]] = seen[first:first + count, [b, a]]
    gate = Gate.before(2 * seen[0] - seen[1], (seen[1] - seen[0]) / (step * DT))
    for now, truth in zip(torn, seen):
        gate, own = gate.named(now, step * DT)
        assert np.array_equal(own, truth)
        gate, _ = gate.admit(own, truth, np.zeros_like(truth), step * DT)


@given(st.floats(1.5, 50.0), st.integers(0, 5))
def test_an_exchange_is_taken_after_as_much_evidence_as_it_needs(ratio, which):
    """One pair of four whose other assignment always has `ratio` times less energy, the others as much more."""
    doubts, frames, taken = Doubts.of(4), 0, False
    while not taken and frames < 10_000:
        doubts, asked = doubts.heard(np.ones(6, bool), DT).asked()
        frames += 1
        if asked is not None:
            energy = 10.0 * ratio if asked == which else 10.0 / ratio
            doubts, taken = doubts.told(asked, energy, 10.0)
            assert taken is (asked == which and taken)
    gain = min(np.log((10.0 * ratio + CALM) / (10.0 + CALM)) - MARGIN, MOST)
    assert taken and frames <= EVERY * (6 * SELDOM + np.ceil(ENOUGH / gain))


def test_who_is_not_in_doubt_is_not_asked_about():
    """Only two that could have been exchanged are, for some seconds."""
    doubts = Doubts.of(3)
    none, two = np.zeros(3, bool), (doubts.pairs == [0, 2]).all(-1)
    for now, expected in ((none, set()), (two, {(0, 2)})):
        asked, doubts = set(), doubts.heard(now, DT)
        for _ in range(round(LISTENED / DT) + 2):
            doubts, pair = doubts.heard(none, DT).asked()
            asked |= set() if pair is None else {tuple(doubts.pairs[pair])}
        assert asked == expected and not len(doubts.open)


@pytest.mark.parametrize("apart, doubted", [(0.01, True), (0.1, False)])
def test_who_passes_another_in_the_open_is_not_in_doubt(apart, doubted):
    """Two that cross at 2 m/s, some way apart, in steps of 33 mm that they miss by 4."""
    times = DT * np.arange(-20, 21)[:, None, None]
    seen = times * [[2.0, 0.0, 0.0], [-2.0, 0.0, 0.0]] + apart * np.array([[0.0, 0.5, 0.0], [0.0, -0.5, 0.0]])
    seen += 0.002 * (-1.0) ** np.arange(41)[:, None, None] * [0.0, 0.0, 1.0]
    gate, found = Gate.before(seen[0], np.zeros((2, 3))), []
    for k, now in enumerate(seen[1:]):
        if k > 2:
            found.append(gate.confusable(np.array([[0, 1]]), now, DT)[0])
        gate, _ = gate.admit(now, now, np.zeros_like(now), DT)
    assert any(found) is doubted


@given(st.floats(0.02, 0.15), st.integers(0, 99))
def test_two_that_are_exchanged_without_a_leap_are_in_doubt(apart, seed):
    """However they move and shake, as long as they do that by less than they are apart."""
    rng = np.random.default_rng(seed)
    way, off = rng.normal(size=(6, 2, 3)), 0.05 * apart * rng.normal(size=(6, 2, 3))
    seen = 0.3 * apart * np.arange(6)[:, None, None] * way[0] / 3.0 + apart * np.array([[0.0, 0.5, 0.0], [0.0, -0.5, 0.0]]) + off.clip(-0.1 * apart, 0.1 * apart)
    gate = Gate.before(seen[0], seen[1] - seen[0])
    for now in seen[1:5]:
        gate, _ = gate.admit(now, now, np.zeros_like(now), DT)
    assert gate.confusable(np.array([[0, 1]]), seen[5][::-1], DT)[0] or np.linalg.norm(np.diff(seen[5], axis=0)) < 0.5 * apart


def test_two_of_which_none_is_seen_are_in_doubt():
    seen = np.array([[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]])
    gate, pairs = Gate.before(seen, np.zeros_like(seen)), Doubts.of(4).pairs
    for k in range(20):
        now = seen + 0.001 * k * k
        now[2:] = np.nan if k >= 4 else now[2:]
        found = {tuple(pair) for pair in pairs[gate.confusable(pairs, now, DT)]}
        assert k < 3 or found == ({(2, 3)} if k > 4 + BLINK / DT else set())
        gate, _ = gate.admit(now, seen, np.zeros_like(seen), DT)
    other = gate.exchanged(0, 3)
    assert list(other.order) == [3, 1, 2, 0] and np.array_equal(other.raw[0], gate.raw[3], equal_nan=True)


@pytest.mark.parametrize("seed", range(3, 15, 3))
def test_noise_exchanges_no_points(seed):
    """5 cm of it takes points 20 cm apart past each other's places; they keep their numbers."""
    seen = swinging() + 0.2 * np.arange(2)[:, None] * [0.0, 1.0, 0.0]
    noisy = seen + np.random.default_rng(seed).normal(0.0, 0.05, seen.shape)
    gate = Gate.before(2 * seen[0] - seen[1], (seen[1] - seen[0]) / DT)
    for now, truth in zip(noisy, seen):
        gate, own = gate.named(now, DT)
        gate, _ = gate.admit(own, truth, np.zeros_like(truth), DT)
    assert list(gate.order) == [0, 1]


@given(st.integers(60, 120), st.integers(1, 30), st.floats(0.3, 1.4))
@settings(max_examples=25)
def test_a_point_that_comes_back_elsewhere_comes_there_without_a_pop(lost, count, away):
    """From where the body has it, at no more acceleration than a critically damped spring has from rest."""
    seen = np.zeros((300, 1, 3))
    seen[lost:lost + count] = np.nan
    seen[lost + count:, :, 1] = away
    goals, _ = passed(seen)
    goes_on = int(BLINK / DT + 1e-6)
    assert np.allclose(goals[lost:lost + min(count, goes_on)], 0.0) and np.isnan(goals[lost + goes_on:lost + count]).all()
    back = int(np.nonzero(np.isfinite(goals[lost + count:]).all((1, 2)))[0][0]) + lost + count
    assert (back - lost - count) * DT <= (0.02 if away <= NEAR else PATIENCE + 0.05)
    path = np.concatenate([np.zeros((2, 3)), goals[back:, 0]])
    assert np.abs(np.diff(path, 2, axis=0)).max() / DT**2 < 210 * away
    assert np.allclose(goals[-1], seen[-1], atol=1e-3)


def test_after_all_were_lost_points_are_where_they_are_seen_and_as_far_as_somebody_goes():
    """The body's own place tells nothing then, and its pose is what is eased."""
    gate = Gate.before(np.zeros((1, 3)), np.zeros((1, 3)))
    seen = np.array([[0.0, 0.0, NEAR + 0.3]])
    for lost, followed in ((0.0, False), (0.25, True)):
        after = gate
        for _ in range(2):
            after, goals = after.admit(seen, np.zeros((1, 3)), np.zeros((1, 3)), DT, lost)
        assert bool(np.isfinite(goals).all()) is followed
    assert np.array_equal(goals, seen)


@pytest.mark.parametrize("frames", [1, 5, 600])
def test_a_point_that_leaps_three_metres_is_not_followed(frames):
    seen = swinging(frames + 240)
    body = seen.copy()
    seen[120:120 + frames] += [3.0, 0.0, 0.0]
    goals, gate = passed(seen, body)
    assert np.isnan(goals[120:120 + frames]).all()
    assert gate.trusted.all() and np.allclose(goals[-30:], body[-30:], atol=2e-3)


def test_two_points_that_are_exchanged_for_a_moment_are_lost_for_that_moment():
    seen = np.zeros((60, 2, 3))
    seen[:, 0, 0], seen[:, 1, 0] = 0.35, -0.35
    body = seen.copy()
    seen[30:36] = seen[30:36, ::-1]
    goals, _ = passed(seen, body)
    assert np.isnan(goals[30:36]).all() and np.allclose(goals[40:], body[40:], atol=1e-3)


@given(st.floats(0.05, 0.5), st.integers(0, 99))
@settings(max_examples=20)
def test_points_that_blink_are_followed(share, seed):
    """At random, on a wrist that swings by half a metre: always, and nearly where they are."""
    seen = swinging()
    torn = seen.copy()
    torn[2:][np.random.default_rng(seed).random((238, 1)) < share] = np.nan
    goals, _ = passed(torn, seen)
    assert np.isfinite(goals).all(-1).mean() > 0.95
    assert np.nanmean(np.linalg.norm(goals - seen, axis=-1)) < 0.08


@pytest.mark.parametrize("step", [2, 3])
def test_points_that_come_in_every_other_frame_are_followed(step):
    seen = swinging()
    torn = np.full_like(seen, np.nan)
    torn[::step] = seen[::step]
    goals, _ = passed(torn, seen)
    assert np.isfinite(goals[step:]).all()
    assert np.linalg.norm(goals - seen, axis=-1)[60:].max() < 0.05 * step


@given(st.integers(0, 99))
@settings(max_examples=10)
def test_noise_of_three_centimetres_is_borne_and_a_jump_in_it_is_not(seed):
    seen = swinging()
    noisy = seen + np.random.default_rng(seed).normal(0, 0.03, seen.shape)
    noisy[150:160] += [1.2, 0.0, 0.0]
    goals, _ = passed(noisy, seen)
    refused = np.isnan(goals).reshape(len(goals), -1).any(-1)
    assert refused[150:160].all() and refused[30:150].mean() < 0.02


@given(st.integers(0, 99))
@settings(max_examples=10)
def test_noise_that_is_there_from_the_first_frame_is_borne_soon(seed):
    """5 cm on points that stand: from the fifth frame on nearly all of it is followed."""
    seen = np.random.default_rng(seed).normal(0.0, 0.05, (20, 6, 3))
    goals, _ = passed(seen, np.zeros_like(seen))
    assert np.isfinite(goals[4:]).all(-1).mean() > 0.93


def test_a_turn_that_blinks_goes_on_and_one_that_is_none_is_not_known():
    turns = exp(np.arange(60)[:, None, None] * [0.0, 5.0 * DT, 0.0])
    gate = Gate.before(np.zeros((1, 3)), np.zeros((1, 3)))
    for k, turn in enumerate(turns):
        told = turn if k < 50 else np.full((1, 3, 3), np.nan)
        gate, found = gate.told(told, DT)
        if k < 50 + int(BLINK / DT + 1e-6):
            assert np.allclose(found, turn, atol=0.02)
        else:
            assert np.isnan(found).all()
    odd = np.stack([-turns[7, 0], np.zeros((3, 3)), 3.0 * turns[7, 0], turns[7, 0]])
    assert np.array_equal(np.isfinite(rotations(odd)).all((-1, -2)), [False, False, False, True])


def test_a_point_out_of_reach_is_never_followed():
    seen = np.full((600, 1, 3), REACH)
    goals, gate = passed(seen)
    assert np.isnan(goals).all() and not gate.trusted.any()


@given(st.data())
@settings(max_examples=40)
def test_no_pattern_of_faults_gives_anything_but_places_within_reach(data):
    seed = data.draw(st.integers(0, 10**6))
    rng = np.random.default_rng(seed)
    seen = swinging(120) + np.zeros((120, 3, 3))
    body = seen.copy()
    seen[rng.random((120, 3)) < data.draw(st.floats(0, 0.9))] = np.nan
    wild = rng.random((120, 3)) < data.draw(st.floats(0, 0.5))
    seen[wild] += rng.normal(0, 5, (int(wild.sum()), 3))
    goals, gate = passed(seen, body)
    followed = np.isfinite(goals).all(-1)
    assert np.array_equal(followed, np.isfinite(goals).any(-1))
    assert np.linalg.norm(goals - body, axis=-1)[followed].max(initial=0.0) <= REACH + 1e-9
    assert all(np.isfinite(value).all() for value in (gate.offset, gate.slip, gate.rate, gate.smooth))
