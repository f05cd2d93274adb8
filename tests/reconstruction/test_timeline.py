"""A tracker's packets in time: what a network makes uneven comes out even, one packet late and no later."""

import numpy as np
import pytest

from gambol.controllers.reconstruction.live.timeline import ANEW, Timeline

SECONDS, LATENCY = 12.0, 0.004


def hand(t):
    """Where a hand is (..., 3) [m] that is as fast and as restless as recorded ones, 1 m/s and 1200 m/s³."""
    t = np.asarray(t)[..., None]
    return np.sin(t * [5.1, 3.3, 7.0] + [0.0, 1.0, 2.0]) * [0.3, 0.2, 0.1] + 0.1 * np.sin(t * [11.0, 9.0, 13.0]) + 0.02 * np.sin(t * [33.0, 29.0, 37.0])


def played(rate, unrest, loss, clock, seed=1, hold=0.0, start=1.0):
    """What is seen at 60 frames a second of packets that are late by |normal| of `unrest` [s], lost by a share, and about once a second held up for `hold` [s] and handed over at once; and when."""
    rng = np.random.default_rng(seed)
    sent = np.arange(0.0, SECONDS, 1.0 / rate)
    sent = sent[rng.random(len(sent)) >= loss]
    arrived = sent + LATENCY + np.abs(rng.normal(0.0, unrest, len(sent)))
    moment = 1.0
    while hold and moment < SECONDS:
        moment += rng.uniform(0.7, 1.3)
        held = (arrived >= moment) & (arrived < moment + hold)
        arrived[held] = moment + hold + 2e-4 * np.arange(held.sum())
    if clock and not hold:  # they may overtake each other
        order = np.argsort(arrived, kind="stable")
        sent, arrived = sent[order], arrived[order]
    else:
        arrived = np.maximum.accumulate(arrived)
    line, times, seen, k = Timeline(), np.arange(start, SECONDS - 0.1, 1 / 60), [], 0
    for now in times:
        while k < len(sent) and arrived[k] <= now:
            line.heard(arrived[k], hand(sent[k]), sent[k] if clock else None)
            k += 1
        seen.append(line.at(now))
    return times, np.array(seen), line.period


def restless(places):
    return float(np.linalg.norm(np.diff(places, 3, axis=0), axis=-1).mean() * 60**3)


@pytest.mark.few(2)
@pytest.mark.parametrize("clock", [False, True])
@pytest.mark.parametrize("rate", [50, 60, 72, 90, 120, 144])
def test_a_stream_of_any_pace_is_seen_as_calmly_as_its_tracker_moved(rate, clock):
    unrest = 0.003
    times, seen, period = played(rate, unrest, 0.02, clock)
    delay = LATENCY + unrest * np.sqrt(2 / np.pi) + 1.0 / rate  # by a packet, and by what the network is late on the average
    late = min(np.arange(0.0, 0.06, 5e-4), key=lambda d: np.linalg.norm(seen - hand(times - d)))
    assert late < delay + 0.002
    assert restless(seen) < (1.1 if clock else 1.4) * restless(hand(times - late))
    assert np.linalg.norm(seen - hand(times - late), axis=-1).mean() < 0.004
    assert period == pytest.approx(1.0 / rate, rel=0.03)


@pytest.mark.parametrize("rate", [60, 90, 144])
def test_packets_that_come_evenly_are_met_exactly(rate):
    times, seen, period = played(rate, 0.0, 0.0, False)
    assert np.abs(seen - hand(times - LATENCY - 1.0 / rate)).max() < 3e-3 * (60 / rate) ** 2
    assert period == pytest.approx(1.0 / rate, rel=1e-6)


def test_a_packet_that_is_late_is_waited_for_along_the_motion_and_not_for_ever():
    line = Timeline()
    for k in range(60):
        line.heard(k / 60, np.array([k / 60, 0.0, 0.0]))
    for ahead in (1, 2, 4):  # so many steps after the newest: up to three packets have not come
        assert line.at((59 + ahead) / 60)[0] == pytest.approx((58 + ahead) / 60, abs=1e-6)
    assert line.at(5.0)[0] == pytest.approx(62 / 60, abs=1e-6)


def test_after_a_silence_it_begins_anew():
    line = Timeline()
    for k in range(60):
        line.heard(k / 60, np.array([k / 60, 0.0, 0.0]))
    line.heard(1.0 + ANEW + 1.0, np.array([9.0, 0.0, 0.0]))
    assert line.at(1.0 + ANEW + 1.0)[0] == 9.0


def test_nothing_heard_is_nowhere():
    assert np.isnan(Timeline().at(0.0)).all()


@pytest.mark.parametrize("ago", [0.02, 0.05, 0.08, 0.11, 0.14])
def test_a_moment_before_the_last_packet_may_be_asked_for(ago):
    """As whoever draws may be late: what a late packet mends fades, and never grows into the past."""
    rng, line = np.random.default_rng(3), Timeline()
    sent = np.arange(120) / 60
    arrived = np.maximum.accumulate(sent + rng.uniform(0.0, 0.004, 120) + np.where(np.arange(120) % 30 == 29, 0.04, 0.0))
    for k, time in enumerate(arrived):
        line.heard(time, hand(sent[k]))
        if k > 40:
            assert np.linalg.norm(line.at(time - ago) - hand(time - ago - 1 / 60)) < 0.12


@pytest.mark.parametrize("jump", [-100.0, -0.5, 0.5, 100.0])
def test_a_senders_clock_may_be_set(jump):
    line = Timeline()
    for k in range(240):
        time = k / 60
        line.heard(time, np.array([time, 0.0, 0.0]), 5.0 + time + (jump if k >= 120 else 0.0))
        if k > 30 and not 120 <= k < 140:
            assert line.at(time)[0] == pytest.approx(time - 1 / 60, abs=0.02)


@pytest.mark.few(1)
@pytest.mark.parametrize("seed", range(6))
def test_packets_that_are_late_by_as_much_as_they_are_apart_are_never_flown_off_from(seed):
    """Two that seem to be from almost the same moment made a slope without bounds."""
    rng, rate = np.random.default_rng(seed), 90.0
    sent = np.arange(0.0, 20.0, 1.0 / rate)
    sent = sent[rng.random(len(sent)) >= 0.1]
    arrived = sent + np.abs(rng.normal(0.0, 0.008, len(sent)))
    line, off, k = Timeline(), 0.0, 0
    order = np.argsort(arrived, kind="stable")
    for now in np.arange(1.0, 19.0, 1.0 / 60.0):
        while arrived[order[k]] <= now:
            line.heard(arrived[order[k]], 3.0 * sent[order[k]] + hand(sent[order[k]]))  # of a runner
            k += 1
        off = max(off, float(np.linalg.norm(line.at(now) - 3.0 * now - hand(now))))
    assert 0.03 < off < 0.8


@pytest.mark.few(3)
@pytest.mark.parametrize("clock", [False, True])
@pytest.mark.parametrize("rate", [60, 90, 144])
@pytest.mark.parametrize("hold", [0.08, 0.14, 0.3])
def test_packets_that_were_held_up_and_come_at_once_are_told_apart(hold, rate, clock):
    """Counted as so many that were lost, they would be from times to come: the pace is kept, and most moments are met."""
    unrest = 0.002
    times, seen, period = played(rate, unrest, 0.02, clock, 2, hold, 3.0)
    off = np.linalg.norm(seen - hand(times - LATENCY - unrest * np.sqrt(2 / np.pi) - 1.0 / rate), axis=-1)
    assert period == pytest.approx(1.0 / rate, rel=0.02)
    assert np.quantile(off, 0.5 if hold < 0.2 else 0.3) < 0.004


@pytest.mark.few(2)
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("rate", [60, 90, 144])
def test_late_packets_are_not_taken_for_missing_ones(rate, seed):
    """Late by as much as they are apart, of the first ones, too: 144 a second were thought to be 185, a fifth of which was lost."""
    _, _, period = played(rate, 0.008, 0.02, False, seed)
    assert period == pytest.approx(1.0 / rate, rel=0.05)


def test_packets_that_came_twice_or_by_a_clock_that_is_too_coarse_are_harmless():
    line = Timeline()
    for k in range(120):
        for again in range(max(k - 12, 0), k + 1, 6):  # the same one once more, and older ones
            line.heard(k / 60, np.array([again / 60, 0.0, 0.0]), 3.0 + again / 60)
    assert line.at(2.0)[0] == pytest.approx(2.0 - 1 / 60, abs=5e-3)
    coarse = Timeline()
    for k in range(60):
        coarse.heard(k / 60, np.array([k / 60, 0.0, 0.0]), 1e6 + k // 8 / 10)
        assert coarse.at(k / 60)[0] == pytest.approx(k / 60, abs=0.05)


def test_a_sender_may_begin_to_tell_its_clock_and_cease():
    line = Timeline()
    for k in range(360):
        line.heard(k / 60, np.array([k / 60, 0.0, 0.0]), 1000.0 + k / 60 if 120 <= k < 240 else None)
        if k > 30:
            assert line.at(k / 60)[0] == pytest.approx((k - 1) / 60, abs=0.02)
