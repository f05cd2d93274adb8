"""Points by OSC over a real socket: whoever sends, whatever comes, and however somebody stands at first."""

import logging
import socket
from time import sleep

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pythonosc.osc_bundle_builder import IMMEDIATELY, OscBundleBuilder
from pythonosc.osc_message_builder import OscMessageBuilder
from scipy.spatial.transform import Rotation

from gambol.controllers.body.rotations import yaw
from gambol.controllers.reconstruction.control_points import SETS, parse
from gambol.controllers.reconstruction.live.osc_packets import understood
from gambol.controllers.reconstruction.live.placing import SECONDS, Placement, Standing, placed, stances
from gambol.controllers.reconstruction.live.sources import Recorded
from gambol.controllers.reconstruction.live.osc_stream import PINNED, STALE, Stream
from gambol.controllers.reconstruction.live.tracker_map import StreamError, read_map, usual_map
from gambol.controllers.reconstruction.pose_vector import SKELETON

WORN = {"LHR-1": "lwrist", "LHR-2": "rwrist", "LHR-3": "lankle"}


def message(address, *values):
    builder = OscMessageBuilder(address)
    for value in values:
        builder.add_arg(value)
    return builder.build()


def tracker(serial, place, kind="Tra"):
    """As a VMC program sends it: a Unity place and no turn."""
    return message(f"/VMC/Ext/{kind}/Pos", serial, *map(float, place), 0.0, 0.0, 0.0, 1.0)


def bundle(*messages):
    builder = OscBundleBuilder(IMMEDIATELY)
    for one in messages:
        builder.add_content(one)
    return builder.build().dgram


class Sender:
    """A program with trackers, on this machine."""

    def __init__(self, stream):
        self.to = "127.0.0.1", stream.port
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)

    def __call__(self, *packets):
        for packet in packets:
            self.socket.sendto(packet if isinstance(packet, bytes) else packet.dgram, self.to)


@pytest.fixture
def stream():
    with Stream(WORN, 0, "127.0.0.1") as one:
        yield one


@pytest.fixture
def send(stream):
    sender = Sender(stream)
    yield sender
    sender.socket.close()


def test_places_come_in_the_order_of_the_points_and_right_handed(stream, send):
    send(tracker("LHR-2", (0.5, 1.0, 0.2)), tracker("LHR-1", (-0.5, 1.1, 0.3)), tracker("LHR-3", (-0.1, 0.1, 0.0)))
    assert np.allclose(stream.at(0.0), [[0.5, 1.1, 0.3], [-0.5, 1.0, 0.2], [0.1, 0.1, 0.0]])


def test_a_packet_of_bones_says_what_it_is_about():
    bones = bundle(message("/VMC/Ext/OK", 1), message("/VMC/Ext/Bone/Pos", "Hips", 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0), message("/VMC/Ext/T", 1.0))
    assert understood(bones).about == "/VMC/Ext/Bone/Pos" and not understood(bones).trackers
    assert not understood(bundle(message("/VMC/Ext/OK", 1), message("/VMC/Ext/T", 1.0))).about


def test_all_that_programs_send_is_understood():
    with Stream({"hmd": "head", "1": "root", "con": "lwrist"}, 0, "127.0.0.1") as stream:
        send = Sender(stream)
        inner = OscBundleBuilder(IMMEDIATELY)
        inner.add_content(message("/tracking/trackers/1/position", 1.0, 2.0, 3.0))
        inner.add_content(message("/tracking/trackers/1/rotation", 1.0, 2.0, 3.0))
        send(bundle(inner.build(), tracker("headset 7", (0, 1.7, 0), "Hmd")), tracker("con", (4, 5, 6), "Con"),
             message("/VMC/Ext/OK", 1), message("/VMC/Ext/Tra/Pos/Local", "con", *[9.0] * 7))
        assert np.allclose(stream.at(0.0), [[0, 1.7, 0], [-1, 2, 3], [-4, 5, 6]])
        send(message("/tracking/trackers/head/position", 0.0, 1.6, 0.0), tracker("lwrist", (1, 1, 1)))
        assert np.allclose(stream.at(0.1), [[0, 1.6, 0], [-1, 2, 3], [-1, 1, 1]])
        assert stream.broken == 0


def test_a_tracker_called_like_a_joint_is_on_it_and_not_where_a_head_set_is():
    """Whichever of them is heard, the point that is told of is the one that is followed, in front of the eyes."""
    with Stream(usual_map(("head", "root")), 0, "127.0.0.1") as stream:
        point, turn = stream.controls.offsets[0], Rotation.from_euler("yx", (90.0, 20.0), degrees=True)
        assert np.linalg.norm(point) > 0.1
        x, y, z, w = turn.as_quat()  # as Unity has it: X the other way round
        stream.take(0.0, "127.0.0.1", message("/VMC/Ext/Tra/Pos", "head", -0.3, 1.5, 0.2, x, -y, -z, w).dgram)
        assert np.allclose(stream.told(0.0)[0], turn.as_matrix() @ point + [0.3, 1.5, 0.2], atol=1e-6)
        stream.take(0.1, "127.0.0.1", tracker("any", (-0.3, 1.5, 0.2), "Hmd").dgram)
        assert np.allclose(stream.told(0.1, evenly=False)[0], [0.3, 1.5, 0.2])


def test_the_newest_place_counts_and_silence_is_loss(stream, send):
    send(*(tracker("LHR-1", (0, k, 0)) for k in range(50)))
    assert stream.at(0.0)[0, 1] == 49
    assert np.isnan(stream.at(0.0)[1:]).all()
    assert np.isfinite(stream.at(STALE - 1e-3)[0]).all()
    assert np.isnan(stream.at(STALE + 1e-3)).all()


def test_a_sender_may_stop_and_another_may_go_on(stream, send):
    send(tracker("LHR-1", (0, 1, 0)))
    stream.at(0.0)
    send.socket.close()
    assert np.isnan(stream.at(5.0)).all()
    again = Sender(stream)
    again(tracker("LHR-1", (0, 2, 0)))
    assert stream.at(5.1)[0, 1] == 2
    again.socket.close()


def test_whoever_sends_first_is_heard_alone(stream):
    stream.take(0.0, "10.0.0.1", tracker("LHR-1", (0, 1, 0)).dgram)
    stream.take(0.5, "10.0.0.2", tracker("LHR-1", (0, 9, 0)).dgram)
    assert stream.foreign == 1 and stream.at(0.1)[0, 1] == 1
    stream.take(0.5 + PINNED + 0.01, "10.0.0.2", tracker("LHR-1", (0, 2, 0)).dgram)  # the first is silent now
    assert stream.at(0.5 + PINNED + 0.02)[0, 1] == 2


def test_a_thread_times_packets_as_they_come_and_places_are_told_one_packet_late():
    """Over a real socket, by a clock that the test turns: an even motion comes out even, at 90 packets a second seen at 60."""
    now, rate = [0.0], 90.0
    with Stream({"LHR-1": "lwrist"}, 0, "127.0.0.1", clock=lambda: now[0]) as stream:
        send, sent, seen = Sender(stream), 0, []
        for k in range(180):
            asked = k / 60
            while sent / rate <= asked:
                now[0] = sent / rate
                arrived = len(stream._arrived)
                send(tracker("LHR-1", (0.0, np.sin(3.0 * sent / rate), 0.0)))
                while len(stream._arrived) == arrived:
                    sleep(0.0)
                sent += 1
            now[0] = asked
            seen.append(stream.at(asked)[0, 1])
        send.socket.close()
    truth = np.sin(3.0 * (np.arange(60, 180) / 60 - 1 / rate))
    assert np.abs(np.array(seen[60:]) - truth).max() < 1e-4


def test_one_tracker_that_drops_out_takes_no_other_along(stream, send):
    for k in range(30):
        send(tracker("LHR-1", (0, 1, 0)), *([] if k >= 10 else [tracker("LHR-2", (0, 1, 0))]))
        seen = stream.at(k / 30)
    assert np.isfinite(seen[0]).all() and np.isnan(seen[1]).all()


@pytest.mark.parametrize("packet", [
    b"", b"\0", b"hello", b"#bundle\0", b"#bundle\0" + b"\xff" * 40, tracker("LHR-1", (0, 1, 0)).dgram[:-5],
    message("/VMC/Ext/Tra/Pos", "LHR-1", 1.0).dgram, message("/VMC/Ext/Tra/Pos", 3, *[0.0] * 7).dgram,
    message("/VMC/Ext/Tra/Pos", "LHR-1", "x", "y", "z").dgram, tracker("LHR-1", (float("nan"), 1, 0)).dgram,
    tracker("LHR-1", (1e30, 1, 0)).dgram, message("/tracking/trackers/1/position").dgram])
def test_broken_packets_are_left_out_and_counted(stream, send, packet):
    send(tracker("LHR-1", (0, 1, 0)), packet, tracker("LHR-2", (0, 2, 0)))
    seen = stream.at(0.0)
    assert seen[0, 1] == 1 and seen[1, 1] == 2 and stream.broken == 1


@given(st.binary(max_size=200), st.sampled_from([b"", b"/VMC/Ext/Tra/Pos\0\0\0\0,sfff\0\0\0", b"#bundle\0" + b"\0" * 7 + b"\1"]))
@settings(max_examples=300)
def test_no_packet_does_harm(noise, head):
    seen = understood(head + noise)
    for _, _, place, turn in seen.trackers if seen else ():
        assert np.isfinite(place).all() or np.isnan(place).all() and np.isfinite(turn).all()


def test_trackers_on_no_point_are_told_of(stream, send):
    send(tracker("LHR-9", (0, 1, 0)), tracker("LHR-1", (0, 1, 0)))
    stream.at(0.0)
    assert stream.unknown == ["LHR-9"]


def test_only_this_machine_is_heard_unless_somebody_says_so():
    with Stream(WORN, 0) as stream, Stream(WORN, 0, "0.0.0.0") as open_:
        assert stream.host == "127.0.0.1" and stream.local and open_.host == "0.0.0.0" and not open_.local


@pytest.mark.parametrize("host", ["", "::1", "203.0.113.7", "a\0b", "..", "x" * 300])
def test_an_address_that_is_none_of_this_machine_is_told_of(host):
    with pytest.raises(StreamError, match="^host '.*' is no address of this machine .*127.0.0.1 .* 0.0.0.0") as error:
        Stream(WORN, 0, host)
    assert str(error.value).isprintable()


def test_names_of_trackers_are_bounded_in_length_and_number_and_command_no_terminal(stream, send):
    named = {*WORN, *WORN.values()}
    send(tracker("x" * 101, (0, 1, 0)))
    stream.at(0.0)
    assert stream.broken == 1 and not stream.heard
    for k in range(500):
        send(tracker(f"\x1b]0;owned\x07\n[bold]{k}", (0, 1, 0)))
        stream.at(0.1)
    send(tracker("LHR-1", (0, 2, 0)))
    assert stream.at(0.2)[0, 1] == 2 and "LHR-1" in stream.heard
    assert len(stream.heard) <= 64 + 2 * len(named) and len(stream.unknown) >= 64
    assert all(name.isprintable() and len(name) < 300 for name in stream.unknown)


def test_a_broken_bundle_is_not_logged(caplog, capfd):
    """The library shows all of it to whoever listens to any log."""
    before = list(logging.getLogger().handlers)
    good, nonsense = tracker("LHR-1", (0, 1, 0)).dgram, b"secret\x1b[2J" * 400
    parts = b"".join(len(part).to_bytes(4, "big") + part for part in (good, nonsense))
    understood(b"#bundle\0" + b"\0" * 7 + b"\1" + parts)
    understood(b"/VMC/Ext/Tra/Pos\0\0\0\0,\x1bq\0")
    assert not caplog.records and "secret" not in "".join(capfd.readouterr()) and logging.getLogger().handlers == before


def test_a_port_that_is_in_use_is_told_of(stream):
    with pytest.raises(StreamError, match=f"port {stream.port} can't be listened at .*: close the program"):
        Stream(WORN, stream.port, "127.0.0.1")


def test_a_map_says_which_tracker_is_where(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text('[trackers]\n"LHR-1" = "lwrist"\nhmd = "head+0/0.09/0.09"\n')
    assert read_map(file) == {"LHR-1": "lwrist", "hmd": "head+0/0.09/0.09"}


@pytest.mark.parametrize(("text", "why"), [
    ("", "needs a table"), ("[trackers]\n", "needs a table"), ("trackers = 3", "needs a table"), ("[tra", "mine.toml"),
    ('[trackers]\nA = "elbw"', "no control point 'elbw'"), ("[trackers]\nA = 3", "trackers.A: needs a point in quotes"),
    ('[trackers]\nA = "head"\nB = "head"', "given twice"), ('[trackers]\nA = "lwrist,rwrist"', "each tracker is on one"),
    ('[trackers]\nA = ""', "mine.toml")])
def test_a_map_with_a_mistake_is_answered_with_file_and_fault(tmp_path, text, why):
    file = tmp_path / "mine.toml"
    file.write_text(text)
    with pytest.raises(StreamError, match=why) as fault:
        read_map(file)
    assert "mine.toml" in str(fault.value)
    with pytest.raises(StreamError, match="can't be read"):
        read_map(tmp_path / "none.toml")


def test_usual_trackers_are_on_usual_points():
    assert usual_map(["lwrist", "root", "lankle"]) == {"lwrist": "lwrist", "1": "root", "2": "lankle"}
    assert [p.partition("+")[0] for p in usual_map().values()] == ["head", "root", "lankle", "rankle"]


@given(st.sampled_from(sorted(set(SETS) - {"2"})), st.integers(0, 1), st.floats(-3.1, 3.1), st.floats(0.7, 1.25), st.floats(-2, 2),
       st.floats(-1, 1))
@settings(max_examples=60)
def test_a_standing_performer_is_placed(name, arms, heading, size, aside, floor):
    """Any heading, size, place and height of the tracker's floor, in T-pose or with the arms down, comes out right."""
    controls = parse(name, SKELETON)
    stance = controls.on(*stances())[arms]
    seen = size * stance @ yaw(heading).T + [aside, floor, 1.0]
    assert np.allclose(placed(seen, controls)(seen), stance, atol=1e-6)
    assert np.allclose(placed(seen, controls, height=1.741 * size)(seen), stance, atol=1e-6)


@pytest.mark.parametrize("wrong", [lambda p: 3.0 * p, lambda p: p[[2, 1, 0, 3]], lambda p: 0.0 * p])
def test_points_of_nobody_who_stands_are_refused(wrong):
    controls = parse("4", SKELETON)
    with pytest.raises(ValueError, match="no standing body's"):
        placed(wrong(controls.on(*stances())[0]), controls)


@pytest.mark.parametrize("mirrored", [1.0, -1.0])
def test_who_is_sent_with_z_up_is_told_so(mirrored):
    controls = parse("root,head,lwrist,rwrist,lankle,rankle", SKELETON)
    stood = controls.on(*stances())[1] @ yaw(0.8).T
    with pytest.raises(ValueError, match="Z points up"):
        placed(stood[:, [0, 2, 1]] * [mirrored, -1.0, 1.0], controls)


WORN_ANYHOW = "head", "root", "lwrist", "rwrist", "lankle", "rankle"


@pytest.mark.parametrize("count", [3, 6])
def test_whoever_stands_is_taken_as_he_wears_them_and_whoever_sits_is_not(count):
    """Head and hands, or hips and feet, too: 8 cm off either way and with bones of other lengths; who sits has his hands in his lap."""
    controls, rng = parse(",".join(WORN_ANYHOW[:1] + WORN_ANYHOW[2:4] if count == 3 else WORN_ANYHOW), SKELETON), np.random.default_rng(count)
    for stance in controls.on(*stances()):
        for _ in range(20):
            away = rng.normal(size=stance.shape)
            worn = stance * np.exp(rng.normal(0.0, 0.04)) + 0.08 * away / np.linalg.norm(away, axis=-1, keepdims=True)
            assert placed(worn, controls).scale == pytest.approx(1.0, abs=0.25)
    joints = stances()[0][1].copy()
    joints[:, 1] -= 0.45
    for side in ("Left", "Right"):
        hip = joints[SKELETON.index(side + "UpLeg")]
        joints[SKELETON.index(side + "Hand")] = hip + [0.0, 0.1, 0.35]
        joints[SKELETON.index(side + "Foot")] = [hip[0], 0.08, 0.4]
    with pytest.raises(ValueError, match="stand upright"):
        placed(joints[controls.joints], controls)


def test_standing_needs_a_second_without_moving_or_losing_a_point():
    here, moved = np.zeros((2, 3)), np.full((2, 3), 0.2)
    standing = Standing()
    for k in range(50):
        standing = standing.watch(k / 60, here)
    assert standing.place is None
    for fault in (np.full((2, 3), np.nan), moved):
        after = standing.watch(50 / 60, fault)
        for k in range(51, 51 + round(0.8 * SECONDS * 60)):
            after = after.watch(k / 60, moved)
        assert after.place is None
        for k in range(100, 170):
            after = after.watch(k / 60, moved)
        assert np.allclose(after.place, moved)


def test_placed_points_leave_the_stream_in_the_world(stream, send):
    stream.placement = Placement(np.pi / 2, 2.0, np.array([0.0, 1.0, 0.0]))
    send(tracker("LHR-1", (-1.0, 0.5, 0.0)))
    assert np.allclose(stream.at(0.0)[0], [0.0, 2.0, -2.0])


def test_a_recording_is_read_between_its_frames_and_nowhere_else():
    points = np.arange(12, dtype=float).reshape(4, 1, 3)
    points[3] = np.nan
    source = Recorded(parse("head", SKELETON), points, 0.5)
    assert source.duration == 1.5
    assert np.allclose(source.at(0.25), [[1.5, 2.5, 3.5]]) and np.allclose(source.at(1.0), [[6, 7, 8]])
    for time in (-0.1, 1.2, 1.5, 1.6):
        assert np.isnan(source.at(time)).all()
    noisy = source.noisy(0.01, np.random.default_rng(1))
    assert 0 < np.nanstd(noisy.points - points) < 0.02
