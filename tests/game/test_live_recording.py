"""What `gambol reconstruct --stream` does with time: on a clock that the test turns."""

import math
import signal
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gambol.controllers.body import STATURE
from gambol.controllers.reconstruction.control_points import parse
from gambol.controllers.reconstruction.pose_vector import SKELETON
from gambol.game.cli import live, live_clock
from gambol.game.cli.base import Mistake


class Clock:
    """Passes as somebody sleeps."""

    now = 100.0

    def monotonic(self):
        return self.now

    def sleep(self, seconds):
        self.now += seconds


@pytest.fixture(autouse=True)
def clock(monkeypatch):
    turned = Clock()
    monkeypatch.setattr(live_clock, "time", turned)
    return turned


@given(st.lists(st.floats(0.0, 1.5), min_size=60, max_size=60))
def test_frames_of_a_take_are_evenly_apart_however_slow_the_machine_is(works):
    """Each as long as none is ten seconds late."""
    clock, skipped = live_clock.time, []
    sum_, times = 0.0, []
    for now, work in zip(live_clock.ticks(1.0, live_clock.BEHIND, skipped, live_clock.Stop()), works):
        times.append(now)
        sum_ += work
        clock.now += work if sum_ < live_clock.BEHIND else 0.0
    assert len(times) == 60 and not skipped
    np.testing.assert_allclose(np.diff(times), 1 / live_clock.FPS)


def test_frames_that_are_sent_on_are_left_out_where_they_would_come_too_late_and_that_is_counted(clock):
    skipped, late = [], []
    for now in live_clock.ticks(5.0, live_clock.SENDING_BEHIND, skipped, live_clock.Stop()):
        late.append(clock.now - now)
        clock.now += 0.03
    assert max(late) <= live_clock.SENDING_BEHIND and len(late) == 300
    assert sum(skipped) + max(late) + 0.03 >= 300 * (0.03 - 1 / 60)


def test_what_was_heard_until_a_take_is_ended_is_still_worked_through(clock, monkeypatch):
    """A machine three times too slow is 6.7 s behind after ten: it goes on for these, says so, and for no more."""
    said, stop, times = [], live_clock.Stop(), []
    monkeypatch.setattr(live_clock, "say", said.append)
    for now in live_clock.ticks(None, live_clock.BEHIND, skipped := [], stop):
        times.append(now)
        clock.now += 0.05
        if clock.now >= 110.0 and stop.at == math.inf:
            stop.at = clock.now
    assert not skipped and stop.at - 1 / live_clock.FPS < times[-1] <= stop.at
    np.testing.assert_allclose(np.diff(times), 1 / live_clock.FPS)
    assert said == ["7 s of what was heard are still to come; Ctrl-C again leaves them out"]


def test_who_ends_it_twice_ends_it_at_once(clock):
    with live_clock.stoppable() as stop:
        with pytest.raises(KeyboardInterrupt):  # nobody stands yet: there is nothing to keep
            signal.raise_signal(signal.SIGTERM)
        stop.gently = True
        signal.raise_signal(signal.SIGTERM)
        assert stop.at == clock.now
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGTERM)


class Restless:
    """A stream of somebody who never stands still; of nobody, where there is none."""

    host, port, local, heard, unknown, rivals, turns, worn, about = "127.0.0.1", 9000, True, {}, [], (), None, None, ""
    controls = parse("lwrist,rwrist", SKELETON)

    def __init__(self, there=True, rivals=()):
        self.there, self.rivals = there, rivals

    def at(self, time):
        return np.full((2, 3), time) if self.there else np.full((2, 3), np.nan)


@pytest.mark.parametrize("there, rivals, why", [
    (True, (), "stood still for 40 s"), (False, (), "nothing is heard of lwrist, rwrist"),
    (True, ("127.0.0.1:1", "127.0.0.1:2"), "two programs send the same trackers, from 127.0.0.1:1 and 127.0.0.1:2")])
def test_waiting_for_somebody_to_stand_still_ends_where_time_is_limited(clock, there, rivals, why):
    said = []
    with pytest.raises(Mistake, match=why):
        live.stand(Restless(there, rivals), STATURE, say=said.append, wait=40.0)
    assert 140.0 < clock.now < 140.1
    assert ("two programs" in " ".join(said)) == bool(rivals)


def test_who_sends_centimetres_is_told_so(clock):
    said, source = [], Restless()
    with pytest.raises(Mistake, match="stood still for 40 s: trackers are .* m from their middle"):
        source.at = lambda time: np.array([[0.0, 178.0, 10.0 * time], [12.0, 9.0, 3.0]])
        live.stand(source, STATURE, say=said.append, wait=40.0)
    assert "in metres" in " ".join(said)


class Idler:
    """A controller that could always go on, and is never asked to."""

    skeleton = SKELETON
    enter = step = status = None

    def precondition(self, state, intent):
        return 0.0


@pytest.mark.parametrize("seconds", [0.5, 50.0])
def test_a_recording_of_some_seconds_of_nobody_ends(clock, seconds, monkeypatch):
    monkeypatch.setattr(live, "say", lambda line: None)
    follower = Idler()
    with pytest.raises(Mistake, match="nobody has stood still"):
        live.record(Restless(False), lambda skeleton: follower, None, None, seconds)
    assert clock.now - 100.0 == pytest.approx(max(seconds, 30.0), abs=0.05)


def test_a_take_that_is_ended_before_anybody_stood_still_says_so(clock, monkeypatch):
    """All of its trackers were heard: it is not said that nothing was."""
    def heard(self, time):
        if time > 105.0:
            raise KeyboardInterrupt
        return np.full((2, 3), time)
    monkeypatch.setattr(Restless, "at", heard)
    follower = Idler()
    with pytest.raises(Mistake, match="ended before anybody had stood still"):
        live.record(Restless(), lambda skeleton: follower, None, None, None)


class Late(Restless):
    """One of two trackers is heard from a time on, the other never; another one is on no point."""

    unknown, broken, foreign = ["LHR-1"], 0, 0

    def __init__(self, heard_from):
        super().__init__()
        self.heard_from = heard_from

    def at(self, time):
        return np.array([[time if time >= self.heard_from else np.nan] * 3, [np.nan] * 3])


@pytest.fixture
def worn(monkeypatch, tmp_path):
    """A calibration that is there."""
    monkeypatch.setattr("gambol.controllers.reconstruction.calibration.load", lambda *_: SimpleNamespace(said=lambda names: "worn so"))
    file = tmp_path / "me.toml"
    file.write_text("")
    return file


def test_whoever_is_calibrated_is_waited_for(clock, worn):
    said = []
    live.stand(Late(112.0), STATURE, worn, say=said.append, wait=40.0)
    assert clock.now == pytest.approx(112.0, abs=0.05), "what is recorded begins with the first that is heard"
    assert "listening at 127.0.0.1, port 9000" in said and "on no point: LHR-1; --map says where they are" in said
    with pytest.raises(Mistake, match="nothing is heard of lwrist, rwrist for 40 s; .*on no point: LHR-1"):
        live.stand(Late(1e9), STATURE, worn, say=said.append, wait=40.0)


def test_who_sends_bones_is_told_so_and_not_of_other_machines(clock):
    said, bones = [], Restless(False)
    bones.about = "/VMC/Ext/Bone/Pos"
    with pytest.raises(Mistake, match="what comes is about /VMC/Ext/Bone/Pos, and of no tracker: let the program send /VMC/Ext/Tra/Pos"):
        live.stand(bones, STATURE, say=said.append, wait=40.0)
    assert "--host" not in " ".join(said)


def test_points_that_are_heard_but_not_followed_are_told_how_to_be(clock, worn):
    said, late = [], Late(112.0)
    late.unknown = ["LHR-1", "root"]
    live.stand(late, STATURE, worn, say=said.append, wait=40.0)
    every = ",".join([*late.controls.names, "root"])
    assert f"heard, but left out: root; --points {every} takes them in, or lines in --map" in said
    assert "on no point: LHR-1; --map says where they are" in said


def test_who_was_never_heard_is_told_after_a_take(clock, worn, monkeypatch):
    said = []
    monkeypatch.setattr(live, "say", said.append)
    monkeypatch.setattr(live, "stand", lambda *_, **__: None)
    monkeypatch.setattr(live, "write_take", lambda *_: None)
    follower = Idler()
    live.record(Late(1e9), lambda skeleton: follower, None, None, 1.0)
    assert "nothing was heard of lwrist, rwrist" in said and "on no point: LHR-1; --map says where they are" in said
