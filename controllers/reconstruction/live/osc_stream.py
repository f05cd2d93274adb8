"""A live stream of trackers by OSC over UDP, as VR programs send it: VMC protocol and VRChat's OSC trackers.

Understood are /VMC/Ext/Hmd/Pos, /VMC/Ext/Con/Pos and /VMC/Ext/Tra/Pos (a serial number, a position and a quaternion)
and /tracking/trackers/N/position (a position), alone or in bundles. Both come from Unity, whose axes are left-handed:
+X is to the right there. Packets are taken when somebody asks where the points are; there is no thread.
"""

from __future__ import annotations

import errno
import logging
import re
import socket
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from pythonosc import osc_bundle, osc_message
from pythonosc.osc_packet import OscPacket, ParseError

from ...files import printable, reason, tables
from ..control_points import ControlPoints, parse
from ..pose_vector import SKELETON
from .placing import Placement

PORT = 39539
"""The port that VMC programs send to unless told otherwise. VRChat's is 9000."""
HOST = "127.0.0.1"
"""Only programs on this machine are heard unless somebody says so: OSC knows no password. 0.0.0.0 hears any machine."""
STALE = 0.15
"""A tracker that was silent for so long [s] is lost."""
USUAL = {"hmd": "head+0/0.09/0.09", "1": "root", "2": "lankle", "3": "rankle"}
"""Which point a tracker is on unless somebody says so: a head-set is in front of the eyes, and VRChat's first three
trackers are waist, left and right foot."""
_VMC = re.compile(r"/VMC/Ext/(Hmd|Con|Tra)/Pos")
_VRCHAT = re.compile(r"/tracking/trackers/([1-8]|head)/position")
_FROM_UNITY = np.array([-1.0, 1.0, 1.0])
_AT_ONCE = 4096  # packets taken in one go: a flood must not stop a frame
_LONGEST_NAME, _MOST_NAMES = 100, 64  # of trackers: letters, and how many that are on no point are remembered
# the library logs a broken packet whole, for everybody to see: here it is counted
_quiet = logging.getLogger("gambol.osc")
_quiet.disabled = True
for _module in (osc_bundle, osc_message):
    vars(_module)["logging"] = _quiet


class StreamError(ValueError):
    """A stream that can't be had, and what would help."""


class Stream:
    """Points from trackers. A `sources.Source`.

    points: what each tracker is on, a point as `controls.parse` has it by serial number, "hmd" for any head-set.
    A tracker that is called like one of these points is on it, too.
    port, host: where to listen, see HOST. stale: [s] see STALE. placement: into the world; `placing` finds one.
    heard: when each tracker was last heard of [s], by serial number, of those on no point the first 64. broken: how many
    packets were no OSC that we know. StreamError if host or port can't be had. Close it, or use it in a `with`.
    """

    def __init__(self, points: Mapping[str, str], port: int = PORT, host: str = HOST, stale: float = STALE):
        self.controls = controls_of(points)
        named = {name.partition("+")[0]: n for n, name in enumerate(self.controls.names)}
        self._index = named | {serial: n for n, serial in enumerate(points)}
        self.stale, self.placement, self.heard, self.broken = stale, Placement(), {}, 0
        self._places = np.full((len(points), 3), np.nan)
        self._since = np.full(len(points), -np.inf)
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
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
        self._socket.setblocking(False)

    @property
    def port(self) -> int:
        """Where it listens; the one that was found where 0 was asked for."""
        return self._socket.getsockname()[1]

    @property
    def host(self) -> str:
        """The address that it listens at."""
        return self._socket.getsockname()[0]

    @property
    def local(self) -> bool:
        """Whether it hears nobody but this machine."""
        return self.host.startswith("127.")

    @property
    def unknown(self) -> list[str]:
        """Trackers that were heard but are on no point, by their names as they may be shown."""
        return sorted(printable(serial) for serial in self.heard if serial not in self._index)

    def at(self, time: float) -> np.ndarray:
        """See `sources.Source`: all that came since it was asked before counts as of now."""
        for _ in range(_AT_ONCE):
            try:
                packet = self._socket.recv(65535)
            except BlockingIOError:
                break
            except OSError:  # some systems report here that an earlier peer is gone
                continue
            self._take(packet, time)
        fresh = time - self._since <= self.stale
        return self.placement(np.where(fresh[:, None], self._places, np.nan))

    def _take(self, packet: bytes, time: float) -> None:
        found = understood(packet)
        self.broken += found is None
        for serial, kind, place in found or ():
            if serial in self._index or serial in self.heard or len(self.heard) < _MOST_NAMES + len(self._index):
                self.heard[serial] = time
            number = self._index.get(serial, self._index.get("hmd") if kind == "Hmd" else None)
            if number is not None:
                self._places[number], self._since[number] = place, time

    def close(self) -> None:
        """Listen no more."""
        self._socket.close()

    def __enter__(self) -> Stream:
        return self

    def __exit__(self, *_) -> None:
        self.close()


def understood(packet: bytes) -> list[tuple[str, str, np.ndarray]] | None:
    """What a packet says: trackers' serial numbers, their kinds ("Hmd", "Con", "Tra") and places (3,) [m], Y up and
    +X to the left of +Z. Empty for messages about something else, None for a packet that is broken."""
    try:
        messages = [timed.message for timed in OscPacket(packet).messages]
    except (ParseError, ValueError, IndexError, RecursionError):
        return None
    found = []
    for message in messages:
        values = message.params
        if match := _VMC.fullmatch(message.address):
            serial, kind, numbers = (values[0] if values else None), match[1], values[1:4]
        elif match := _VRCHAT.fullmatch(message.address):
            serial, kind, numbers = match[1], "Hmd" if match[1] == "head" else "Tra", values[:3]
        else:
            continue
        if not isinstance(serial, str) or len(serial) > _LONGEST_NAME or len(numbers) != 3 or not all(type(number) in (int, float) for number in numbers):
            return None
        place = np.array(numbers, float)
        if not np.all(np.abs(place) < 1e3):  # NaN is not, either
            return None
        found.append((serial, kind, place * _FROM_UNITY))
    return found


def controls_of(points: Mapping[str, str]) -> ControlPoints:
    """The control points that trackers are on. StreamError for a point that there is not, or two trackers on one."""
    try:
        controls = parse(",".join(points.values()), SKELETON)
    except ValueError as error:
        raise StreamError(str(error)) from None
    if len(controls) != len(points):
        raise StreamError(f"each tracker is on one point: {', '.join(points.values())}")
    return controls


def read_map(path: str | Path) -> dict[str, str]:
    """Which point each tracker is on, from a TOML file's table [trackers]: "LHR-1A2B3C4D" = "lwrist".

    StreamError, naming file and field, for anything else.
    """
    path = Path(path)
    try:
        table = tables(path)
    except OSError as error:
        raise StreamError(f"{path}: can't be read: {reason(error)}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise StreamError(f"{path}: {error}") from None
    trackers = table.get("trackers")
    if not isinstance(trackers, dict) or not trackers:
        raise StreamError(f'{path}: needs a table [trackers] with lines such as "LHR-1A2B3C4D" = "lwrist"')
    for serial, point in trackers.items():
        if not isinstance(point, str):
            raise StreamError(f'{path}: trackers.{printable(serial)}: needs a point in quotes, such as "lwrist"')
    try:
        controls_of(trackers)
    except StreamError as error:
        raise StreamError(f"{path}: trackers: {error}") from None
    return trackers


def usual_map(names: Sequence[str] = ()) -> dict[str, str]:
    """Which tracker is on each of some points where nobody says so, see USUAL; the usual four where none is named."""
    usual = {point.partition("+")[0]: (serial, point) for serial, point in USUAL.items()}
    return dict(usual.get(name, (name, name)) for name in names or usual)
