"""Packets as they came, in a file that loses nothing when the program is killed, to be heard again with another method.

A file begins with a line that says what it is; each packet follows with its time, its sender and its length. The last one may
be torn; whatever else is damaged is told of.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from pathlib import Path

from ...files import append, reason

MAGIC = b"gambol packets 1\n"
SUFFIX = ".packets"
"""How the name of such a file ends."""
_HEAD = struct.Struct("<dBH")  # time [s], letters of the sender, bytes of the packet
_LONGEST = 24 * 3600.0  # s


class PacketLogError(ValueError):
    """A file of packets that can't be read or written, and why."""


class PacketLog:
    """Writes packets to a new file, each at once. PacketLogError if it can't be made. fault: why it was ended early."""

    def __init__(self, path: str | Path):
        self.path, self.fault = Path(path), ""
        try:
            self._file = self.path.open("xb", buffering=0)
            append(self._file, MAGIC)
        except FileExistsError:
            raise PacketLogError(f"{path}: there is such a file already; choose another name") from None
        except OSError as error:
            raise PacketLogError(f"{path}: can't be written: {reason(error)}") from None

    def add(self, time: float, sender: str, packet: bytes) -> None:
        """Write a packet; what can't be written ends the log, never what it is a log of."""
        if self.fault:
            return
        name = sender.encode()[:255]
        try:
            append(self._file, _HEAD.pack(time, len(name), len(packet)) + name + packet)
        except OSError as error:
            self.fault = f"{self.path}: ends early: {reason(error)}"
        except ValueError:  # closed, while whoever listens still does
            self.fault = f"{self.path}: is closed"

    def close(self) -> None:
        """Write no more."""
        self._file.close()


def packets_of(path: str | Path) -> list[tuple[float, str, bytes]]:
    """The packets of a file: times [s] from the first one on, senders, bytes. PacketLogError for anything else."""
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        raise PacketLogError(f"{path}: can't be read: {reason(error)}") from None
    if not data.startswith(MAGIC):
        raise PacketLogError(f"{path}: is no file of packets; gambol reconstruct --stream osc --keep FILE{SUFFIX} makes one")
    found = list(_records(path, data))
    if not found:
        raise PacketLogError(f"{path}: holds no packet")
    first = found[0][0]
    return [(time - first, sender, packet) for time, sender, packet in found]


def _records(path, data) -> Iterator[tuple[float, str, bytes]]:
    at, last = len(MAGIC), None
    while at + _HEAD.size <= len(data):
        time, letters, size = _HEAD.unpack_from(data, at)
        if not (last is None or last - 1.0 <= time <= last + _LONGEST):  # NaN is not, either
            raise PacketLogError(f"{path}: is damaged at byte {at}: packets go back in time")
        start = at + _HEAD.size
        at = start + letters + size
        if at > len(data):  # torn
            return
        last = time
        yield time, data[start:start + letters].decode(errors="replace"), data[start + letters:at]
