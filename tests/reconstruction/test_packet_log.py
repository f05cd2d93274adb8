"""Packets that are kept: all of them, whenever the program ends, and heard again as they came."""

import errno

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gambol.controllers.reconstruction.live import SUFFIX, PacketLog, PacketLogError, Replayed, Stream
from gambol.controllers.reconstruction.live.packet_log import MAGIC, packets_of
from gambol.game.cli import live
from test_stream import WORN, Sender, tracker

PACKETS = [(3.0, "127.0.0.1", b"one"), (3.011, "10.0.0.2", b""), (3.5, "::1", bytes(range(256)) * 9)]


@pytest.fixture
def kept(tmp_path):
    log = PacketLog(tmp_path / "a.packets")
    for packet in PACKETS:
        log.add(*packet)
    log.close()
    return log.path


def test_what_is_kept_is_read(kept):
    found = packets_of(kept)
    assert [packet[1:] for packet in found] == [packet[1:] for packet in PACKETS]
    assert np.allclose([packet[0] for packet in found], [0.0, 0.011, 0.5])


def test_wherever_a_file_ends_what_was_whole_is_read(kept, tmp_path):
    data, torn = kept.read_bytes(), tmp_path / "torn.packets"
    for size in range(len(MAGIC) + 30, len(data), 7):
        torn.write_bytes(data[:size])
        found = packets_of(torn)
        assert [packet[1:] for packet in found] == [packet[1:] for packet in PACKETS][:len(found)] and found


@given(st.binary(max_size=200))
def test_damage_is_told_of_or_read_and_nothing_else(tmp_path_factory, noise):
    path = tmp_path_factory.getbasetemp() / "noise.packets"
    path.write_bytes(MAGIC + noise)
    try:
        assert all(np.isfinite(time) for time, _, _ in packets_of(path))
    except PacketLogError as error:
        assert str(path) in str(error)


def test_other_files_and_names_that_are_taken_are_told_of(kept, tmp_path):
    (tmp_path / "b.packets").write_text("hello")
    for path, why in ((tmp_path / "b.packets", "is no file of packets"), (tmp_path / "none.packets", "can't be read")):
        with pytest.raises(PacketLogError, match=why):
            packets_of(path)
    with pytest.raises(PacketLogError, match="there is such a file already"):
        PacketLog(kept)
    with pytest.raises(PacketLogError, match="can't be written"):
        PacketLog(tmp_path / "no folder" / "c.packets")
    assert live.SUFFIX == SUFFIX


def test_a_stream_that_was_kept_is_heard_again_as_it_was(tmp_path):
    log, now = PacketLog(tmp_path / "a.packets"), 5.0
    with Stream(WORN, 0, "127.0.0.1", log=log) as stream:
        send = Sender(stream)
        for k in range(30):
            send(tracker("LHR-1", (0.1 * k, 1.0, 0.0)), *([b"broken"] if k == 7 else []))
            stream.at(now + k / 60)
        send.socket.close()
    log.close()
    again = Replayed(WORN, log.path)
    assert again.duration == pytest.approx(29 / 60)
    last = [again.at(k / 60)[0, 0] for k in range(30)][-1]
    assert last == pytest.approx(-2.8, abs=0.02)  # one packet late
    assert again.broken == 1


def test_a_disk_that_takes_half_of_a_packet_leaves_the_others_whole(tmp_path):
    """Whatever came after is not kept; what came before is heard again."""
    log, room = PacketLog(tmp_path / "a.packets"), [len(MAGIC) + 200]

    class Full:
        def __init__(self, file):
            self.file = file

        def write(self, data):
            if not (left := room[0] - self.file.tell()):
                raise OSError(errno.ENOSPC, "No space left on device")
            return self.file.write(data[:left])

        def __getattr__(self, name):
            return getattr(self.file, name)

    log._file = Full(log._file)
    for k in range(9):
        log.add(k / 60, "127.0.0.1", bytes([k]) * 40)
        room[0] += 1000 * (k == 3)
    assert "No space left" in log.fault
    log.close()
    log.add(1.0, "127.0.0.1", b"late")
    assert [packet[2] for packet in packets_of(log.path)] == [bytes([k]) * 40 for k in range(3)]


def test_whoever_still_listens_as_a_log_is_closed_is_not_stopped(tmp_path):
    log = PacketLog(tmp_path / "a.packets")
    log.close()
    log.add(0.0, "127.0.0.1", b"late")
    assert "is closed" in log.fault
