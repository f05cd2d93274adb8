"""A live stream of trackers by OSC over UDP, as VR programs send it (`osc_packets`).

Packets are taken when somebody asks where the points are; with a clock, a thread takes them as they come and notes when, and
points are told one packet late, so that the network's unrest is not seen (`timeline`).
"""

from __future__ import annotations

import errno
import socket
from collections import deque
from collections.abc import Callable, Mapping
from pathlib import Path
from threading import Thread

import numpy as np
from scipy.spatial.transform import Rotation

from ...files import printable, reason
from .osc_packets import understood
from .packet_log import PacketLog, packets_of
from .placing import Placement
from .timeline import Timeline
from .tracker_map import StreamError, controls_of

PORT = 39539
"""The port that VMC programs send to unless told otherwise. VRChat's is 9000."""
HOST = "127.0.0.1"
"""Only programs on this machine are heard unless somebody says so: OSC knows no password. 0.0.0.0 hears any machine."""
STALE = 0.15
"""A tracker that was silent for so long [s] is lost."""
PINNED = 1.0
"""Whoever sends first is heard alone until silent for so long [s]."""
_AT_ONCE = 4096  # packets taken in one go: a flood must not stop a frame
_MOST_NAMES = 64  # of trackers that are on no point: how many are remembered
_LAGGING = 0.02  # the share by which the time that is asked for is brought to the clock, a question …
_FAR_BEHIND = 1.0  # … unless it is so far off [s] that it leaps there
_BUFFER = 4 << 20  # bytes that may wait while this program is kept from listening, as far as the system grants them


class Trackers:
    """Points from trackers whose packets somebody takes. A `sources.Source`, but for when packets come.

    points: what each tracker is on, a point as `controls.parse` has it by serial number, "hmd" for any head-set.
    A tracker that is called like the joint of one of these points, as "head" is, is on that joint. stale: [s] see STALE. placement: into the world; `placing`
    finds one. heard: when each tracker was last heard of [s], by serial number, of those on no point the first 64. broken: how
    many packets were no OSC that we know. about: what the last one was about that told of no tracker, "" if there was none. foreign: how many came from another machine than the one that is listened to. rivals: addresses of two programs on it that lately sent the same tracker in turns, if there are.
    turns: (n, 3, 3) how the joints below the trackers are turned, as of when the points were told last; NaN where not known; the
    trackers' own turns until a placement knows how they are mounted. worn: who makes joints of what trackers say, places (n, 3) [m] and turns
    (n, 3, 3) of the room, instead of the placement (`calibration.Wearer`).
    """

    def __init__(self, points: Mapping[str, str], stale: float = STALE):
        self.controls = controls_of(points)
        named = {name.partition("+")[0]: n for n, name in enumerate(self.controls.names)}
        self._index = named | {serial: n for n, serial in enumerate(points)}
        self._on_joints = set(named) - set(points)
        self.stale, self.placement, self.heard, self.broken, self.foreign, self.about = stale, Placement(), {}, 0, 0, ""
        self.worn: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]] | None = None
        self._lines = [Timeline() for _ in points]
        self.turns = np.full((len(points), 3, 3), np.nan)
        self._from = "", -np.inf
        self.rivals: tuple[str, ...] = ()
        self._by: list[dict[str, float]] = [{} for _ in points]  # when [s] each point's tracker was heard from which address

    @property
    def unknown(self) -> list[str]:
        """Trackers that were heard but are on no point, by their names as they may be shown."""
        return sorted(printable(serial) for serial in self.heard if serial not in self._index)

    def take(self, time: float, sender: str, packet: bytes) -> None:
        """Take a packet that came at a time [s] from a sender: a machine's address, with or without ":port"."""
        machine = sender.partition(":")[0] if sender.count(":") == 1 else sender
        if machine != self._from[0] and time - self._from[1] <= PINNED:
            self.foreign += 1
            return
        seen = understood(packet)
        if seen is None:
            self.broken += 1
            return
        if seen.trackers:
            self._from = machine, time
        elif seen.about:
            self.about = printable(seen.about)
        for serial, kind, place, turn in seen.trackers:
            if serial in self._index or serial in self.heard or len(self.heard) < _MOST_NAMES + len(self._index):
                self.heard[serial] = time
            number = self._index.get(serial, self._index.get("hmd") if kind == "Hmd" else None)
            if number is None:
                continue
            self._watch(time, sender, number)
            if serial in self._on_joints and kind != "Hmd" and np.isfinite(turn).all():  # the point may be beside the joint that the tracker is on
                place = place + matrices(turn[None])[0] @ self.controls.offsets[number]
            if np.isnan(place).any():
                self._lines[number].turned(time, turn)
            else:
                self._lines[number].heard(time, place, seen.sent, turn)

    def _watch(self, time: float, sender: str, number: int) -> None:
        """See whether another program told of this tracker since this one did; one that was started anew tells no more from its old port."""
        known = {one: when for one, when in self._by[number].items() if time - when <= PINNED}
        between = [one for one, when in known.items() if when > known.get(sender, np.inf)]
        if between:
            self.rivals = tuple(sorted((sender, between[0])))
        self._by[number] = known | {sender: time}

    def told(self, now: float, evenly: bool = True) -> np.ndarray:
        """Where the points are (n, 3) [m] at a time: evenly, one packet late, or as the newest packets say. Sets `turns`."""
        places, quaternions = np.full((len(self._lines), 3), np.nan), np.full((len(self._lines), 4), np.nan)
        for n, line in enumerate(self._lines):
            if now - line.last <= self.stale:
                places[n], quaternions[n] = (line.at(now), line.turned_at(now)) if evenly else (line.newest, line.newest_turn)
        if self.worn is not None:
            told, self.turns = self.worn(places, matrices(quaternions))
            return told
        self.turns = self.placement.turned(matrices(quaternions))
        return self.placement(places)


class Replayed(Trackers):
    """The trackers of a file of packets (`packet_log`), heard again as they came. PacketLogError if it can't be read.

    duration: [s] from the first packet to the last. told_until: when it was asked last.
    """

    def __init__(self, points: Mapping[str, str], path: str | Path, stale: float = STALE):
        super().__init__(points, stale)
        self._packets = deque(packets_of(path))
        self.duration, self.told_until = self._packets[-1][0], 0.0

    def at(self, time: float) -> np.ndarray:
        """See `sources.Source`; time 0 is when the first packet came."""
        while self._packets and self._packets[0][0] <= time:
            self.take(*self._packets.popleft())
        self.told_until = time
        return self.told(time)


class Stream(Trackers):
    """Points from trackers as they are sent.

    port, host: where to listen, see HOST. clock: tells the time [s], such as `time.monotonic`; with it packets are timed as
    they arrive, and points told one packet late, evenly. own_time: whether that is also the clock by which it is asked: then each moment is
    told as it was, however late somebody asks, as long as no more than 4096 packets wait; else the times that it is asked for are brought to
    the clock little by little. log: keeps them. For the rest see `Trackers`.
    StreamError if host or port can't be had. Close it, or use it in a `with`.
    """

    def __init__(self, points: Mapping[str, str], port: int = PORT, host: str = HOST, stale: float = STALE,
                 clock: Callable[[], float] | None = None, log: PacketLog | None = None, own_time: bool = False):
        super().__init__(points, stale)
        self._clock, self._lag, self._own_time, self.log = clock, 0.0 if own_time else np.nan, own_time, log
        self._arrived: deque[tuple[float, str, bytes]] = deque(maxlen=_AT_ONCE)
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _BUFFER)
        try:
            if not host:
                raise ValueError("it is empty")
            self._socket.bind((host, port))
        except (OSError, OverflowError, ValueError, TypeError) as error:
            self._socket.close()
            if isinstance(error, (socket.gaierror, ValueError, TypeError)) or getattr(error, "errno", None) == errno.EADDRNOTAVAIL:
                raise StreamError(f"host {printable(host)!r} is no address of this machine ({reason(error)}): "
                                  f"{HOST} hears programs on it, 0.0.0.0 those on other machines, too") from None
            raise StreamError(f"port {port} can't be listened at ({reason(error)}): "
                              "close the program that does, or choose another port") from None
        self._address = self._socket.getsockname()[:2]
        self._socket.settimeout(0.0 if clock is None else 0.2)
        self._closed, self._thread = False, None
        if clock is not None:
            self._thread = Thread(target=self._listen, args=(clock,), name="trackers", daemon=True)
            self._thread.start()

    @property
    def port(self) -> int:
        """Where it listens; the one that was found where 0 was asked for."""
        return self._address[1]

    @property
    def host(self) -> str:
        """The address that it listens at."""
        return self._address[0]

    @property
    def local(self) -> bool:
        """Whether it hears nobody but this machine."""
        return self.host.startswith("127.")

    def at(self, time: float) -> np.ndarray:
        """See `sources.Source`: without a clock all that came since it was asked before counts as of now."""
        if self._clock is None:
            for _ in range(_AT_ONCE):
                if (packet := self._receive()) is None:
                    break
                if packet[1]:
                    self._keep(time, *packet)
                    self.take(time, *packet)
            return self.told(time, evenly=False)
        if not self._own_time:
            late = self._clock() - time
            self._lag = self._lag + (late - self._lag) * _LAGGING if abs(late - self._lag) < _FAR_BEHIND else late
        moment = time + self._lag
        while self._arrived and self._arrived[0][0] <= moment:  # of what came later nothing is known yet, or a slow frame would see ahead
            self.take(*self._arrived.popleft())
        return self.told(moment)

    def _listen(self, clock: Callable[[], float]) -> None:
        while not self._closed:
            if (packet := self._receive()) is not None and packet[1]:
                now = clock()
                self._keep(now, *packet)
                self._arrived.append((now, *packet))

    def _keep(self, time: float, sender: str, packet: bytes) -> None:
        if self.log is not None:
            self.log.add(time, sender, packet)

    def _receive(self) -> tuple[str, bytes] | None:
        """Who sent the next packet, and what; None where there is none, an empty one where some system reports that an earlier
        peer is gone."""
        try:
            packet, sender = self._socket.recvfrom(65535)
        except (BlockingIOError, TimeoutError):
            return None
        except OSError:
            return None if self._closed else ("", b"")
        return f"{sender[0]}:{sender[1]}", packet or b"\0"

    def close(self) -> None:
        """Listen no more."""
        self._closed = True
        if self._thread is not None:
            self._thread.join(1.0)
        self._socket.close()

    def __enter__(self) -> Stream:
        return self

    def __exit__(self, *_) -> None:
        self.close()


def matrices(quaternions: np.ndarray) -> np.ndarray:
    """Rotation matrices (n, 3, 3) of unit quaternions (n, 4), NaN of NaN."""
    turns = np.full((len(quaternions), 3, 3), np.nan)
    known = np.isfinite(quaternions).all(-1)
    if known.any():
        turns[known] = Rotation.from_quat(quaternions[known]).as_matrix()
    return turns
