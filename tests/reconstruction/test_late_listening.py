"""Trackers heard by a program that is kept from its work now and then: what it makes of them does not depend on when it gets to it."""

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from followed import DT, bodies, follower, known  # noqa: F401
from gambol.controllers.contract import Intent
from gambol.controllers.locomotion import Locomotion, Settings
from gambol.controllers.reconstruction import Reconstruction
from gambol.controllers.reconstruction.follower import GLIDE
from gambol.controllers.reconstruction.live.osc_packets import MOST_PARTS, understood
from gambol.controllers.reconstruction.live.osc_stream import PINNED, Stream
from gambol.controllers.supervisor import Supervisor
from test_stream import bundle, message, tracker

SECONDS = 3.0


@pytest.fixture(scope="module")
def points(follower, known):  # noqa: F811
    return follower.controls.extract(known[1][0])


def told(stalls, own_time):
    """Where a hand is said to be (T, 3), asked 60 times a second by somebody who is kept from it for so long [s] before some frames."""
    now, sent, places, asked = [0.0], 0, [], 0.0
    with Stream({"LHR-1": "lwrist"}, 0, clock=lambda: now[0], own_time=own_time) as stream:
        for k in range(round(SECONDS * 60)):
            asked = k / 60
            now[0] = max(now[0], asked) + stalls.get(k, 0.0)
            while sent / 90 <= now[0]:
                stream._arrived.append((sent / 90, "127.0.0.1:9", tracker("LHR-1", (np.sin(3.0 * sent / 90), 1.0, 0.0)).dgram))
                sent += 1
            places.append(stream.at(asked)[0])
    return np.array(places)


@cache
def told_at_once():
    """The same to somebody who is never kept from it."""
    return told({}, True)


@given(st.dictionaries(st.integers(0, 150), st.floats(0.0, 2.0), max_size=5))
@settings(max_examples=15, deadline=None)
def test_who_asks_for_each_moment_in_the_end_is_told_the_same_however_late(stalls):
    np.testing.assert_array_equal(told(stalls, True), told_at_once())


def test_who_asks_by_another_clock_is_led_to_the_present_without_a_leap():
    places = told({90: 0.5}, False)
    assert np.linalg.norm(np.diff(places[30:], axis=0), axis=-1).max() < 2.0 * 3.0 / 60, "no more than at twice the pace"


@pytest.mark.parametrize("junk", [b"#bundle\0" + bytes(60000), b"#bundle\0" + bytes(8) + (bytes([0, 0, 0, 16]) + b"#bundle\0" + bytes(8)) * (MOST_PARTS + 1)])
def test_a_packet_of_more_parts_than_any_program_sends_is_broken(junk):
    assert understood(junk) is None


def test_a_bundle_of_many_messages_is_understood():
    seen = understood(bundle(*(message("/VMC/Ext/Blend/Val", f"blend {n}", 0.5) for n in range(MOST_PARTS - 1)), tracker("LHR-1", (0, 1, 0))))
    assert [one.serial for one in seen.trackers] == ["LHR-1"]


def test_two_programs_that_send_the_same_tracker_in_turns_are_told_of_and_one_that_starts_anew_is_not():
    with Stream({"LHR-1": "lwrist"}, 0) as stream:
        for k, port in enumerate([7, 7, 7, 8, 8, 8, 9, 9]):  # started anew, twice
            stream.take(k * 0.1, f"127.0.0.1:{port}", tracker("LHR-1", (0, 1, 0)).dgram)
        assert not stream.rivals
        stream.take(0.9, "127.0.0.1:8", tracker("LHR-2", (0, 1, 0)).dgram)  # of another tracker
        stream.take(1.7 + PINNED, "127.0.0.1:8", tracker("LHR-1", (0, 1, 0)).dgram)  # the other one is long silent
        assert not stream.rivals and stream.foreign == 0
        for k, port in enumerate([8, 9, 8]):
            stream.take(4.0 + k * 0.1, f"127.0.0.1:{port}", tracker("LHR-1", (0, 1, 0)).dgram)
        assert stream.rivals == ("127.0.0.1:8", "127.0.0.1:9")


@pytest.mark.few(1)
@pytest.mark.parametrize("away", [2.0, 4.0, 8.0])
def test_a_performer_who_was_lost_is_found_again_however_far_and_no_joint_flies(follower, points, away):  # noqa: F811
    wide = Reconstruction(follower.method, follower.controls, starts=follower.starts, far=np.inf)
    someone = Supervisor({"locomotion": Locomotion.load(settings=Settings(idle=0.0)), "reconstruction": wide})
    state, states, seen = someone.enter(wide.begin(points[0]), Intent()), [], []
    for k in range(min(len(points), 360)):
        here = np.full_like(points[k], np.nan) if 60 <= k < 180 else points[k] + ([away, 0.0, 0.0] if k >= 180 else 0.0)
        state, _ = someone.step(state, Intent(points=here), DT)
        states.append(state)
        seen.append(here)
    joints = bodies(wide.skeleton, states)
    assert (np.linalg.norm(np.diff(joints, axis=0), axis=-1) / DT).max() < GLIDE + 3.0  # a toe swings, too
    assert someone.active(states[-1])[0] == "reconstruction"
    late = 180 + round((0.8 + away / 4.0) / DT)
    off = np.linalg.norm(np.array([wide.follower.points(one.pose) for one in states[late:]]) - np.array(seen[late:]), axis=-1)
    assert off.mean() < 0.05
